#pragma once
#include <array>
#include <memory>
#include <string>

#include "base/vector.hpp"

namespace mu {
class Parser;
}

namespace silt {

/// A formula in x, y, z (m) and t (s), evaluated by muParser: numbers, + - * / ^, sin cos exp sqrt min max if pi ...
/// A malformed formula throws UserError naming the option it came from. One that gives no finite number somewhere is
/// remembered, and Expression::check() tells: an exception would stop one rank alone.
class Expression {
 public:
  Expression(const std::string& option, const std::string& text);
  ~Expression();
  Expression(Expression&&) noexcept;
  Expression& operator=(Expression&&) noexcept;
  double operator()(const Vec3& x, double t) const;
  /// The first formula of any rank that gave no finite number since the last call, with place and time; empty when all
  /// did. Collective, the same text on all ranks.
  static std::string check();
  /// While one lives formulas are asked about places and times that the run may never come to: nothing is remembered.
  struct Trial {
    Trial();
    ~Trial();
  };
  /// True when the value depends on none of x, y, z, t.
  bool constant() const { return constant_; }
  /// True when the value depends on none of x, y, z.
  bool uniform() const { return uniform_; }

 private:
  void remember(double t) const;
  std::string option_, text_;
  std::unique_ptr<mu::Parser> parser_;
  std::unique_ptr<std::array<double, 4>> variables_;
  bool constant_ = false, uniform_ = false;
};

/// The three formulas of a text "0, 0, 0.6*min(t/0.1, 1)"; throws UserError naming the option when there are not three.
std::array<std::string, 3> split_formulas(const std::string& option, const std::string& text);

/// Three formulas separated by commas: "0, 0, 0.6*min(t/0.1, 1)".
class VectorExpression {
 public:
  VectorExpression(const std::string& option, const std::string& text);
  Vec3 operator()(const Vec3& x, double t) const;
  bool constant() const;
  bool uniform() const;

 private:
  std::array<std::unique_ptr<Expression>, 3> components_;
};

}  // namespace silt
