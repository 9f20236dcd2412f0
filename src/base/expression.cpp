#include "base/expression.hpp"

#include <fmt/format.h>
#include <muParser.h>

#include <cmath>
#include <utility>

#include "base/error.hpp"
#include "base/petsc.hpp"

namespace silt {
namespace {

/// What check() tells; one formula is enough.
std::string complaint;
int trials = 0;

}  // namespace

Expression::Expression(const std::string& option, const std::string& text)
    : option_(option),
      text_(text),
      parser_(std::make_unique<mu::Parser>()),
      variables_(std::make_unique<std::array<double, 4>>()) {
  try {
    const char* names[4] = {"x", "y", "z", "t"};
    for (int k = 0; k < 4; ++k) parser_->DefineVar(names[k], variables_->data() + k);
    parser_->DefineConst("pi", 3.14159265358979323846);
    parser_->SetExpr(text);
    parser_->Eval();
    const auto& used = parser_->GetUsedVar();
    constant_ = used.empty();
    uniform_ = !used.count("x") && !used.count("y") && !used.count("z");
  } catch (const mu::Parser::exception_type& e) {
    throw UserError(fmt::format("option -{}: '{}' is not a formula in x, y, z, t: {}", option, text, e.GetMsg()));
  }
}

Expression::~Expression() = default;
Expression::Expression(Expression&&) noexcept = default;
Expression& Expression::operator=(Expression&&) noexcept = default;

double Expression::operator()(const Vec3& x, double t) const {
  *variables_ = {x[0], x[1], x[2], t};
  const double value = parser_->Eval();
  if (!std::isfinite(value)) remember(t);
  return value;
}

void Expression::remember(double t) const {
  if (!complaint.empty() || trials > 0) return;
  const auto& x = *variables_;
  complaint = uniform_ ? fmt::format("option -{}: '{}' is no finite number at t = {:g} s", option_, text_, t)
                       : fmt::format("option -{}: '{}' is no finite number at ({:g}, {:g}, {:g}) m, t = {:g} s",
                                     option_, text_, x[0], x[1], x[2], t);
}

Expression::Trial::Trial() { ++trials; }
Expression::Trial::~Trial() { --trials; }

std::string Expression::check() {
  const int first = static_cast<int>(mpi_min(complaint.empty() ? mpi_size() : mpi_rank()));
  if (first == mpi_size()) return {};
  int length = static_cast<int>(complaint.size());
  MPI_Bcast(&length, 1, MPI_INT, first, PETSC_COMM_WORLD);
  complaint.resize(length);
  MPI_Bcast(complaint.data(), length, MPI_CHAR, first, PETSC_COMM_WORLD);
  return std::exchange(complaint, {});
}

std::array<std::string, 3> split_formulas(const std::string& option, const std::string& text) {
  std::array<std::string, 3> parts;
  size_t part = 0;
  int depth = 0;
  for (char c : text) {
    depth += c == '(' ? 1 : c == ')' ? -1 : 0;
    if (c == ',' && depth == 0) {
      if (++part > 2) break;
    } else if (c != '[' && c != ']') {
      parts[part] += c;
    }
  }
  if (part != 2)
    throw UserError(fmt::format("option -{}: '{}' must be three formulas separated by commas", option, text));
  return parts;
}

VectorExpression::VectorExpression(const std::string& option, const std::string& text) {
  const auto parts = split_formulas(option, text);
  for (int d = 0; d < 3; ++d) components_[d] = std::make_unique<Expression>(option, parts[d]);
}

Vec3 VectorExpression::operator()(const Vec3& x, double t) const {
  return {(*components_[0])(x, t), (*components_[1])(x, t), (*components_[2])(x, t)};
}

bool VectorExpression::constant() const {
  return components_[0]->constant() && components_[1]->constant() && components_[2]->constant();
}

bool VectorExpression::uniform() const {
  return components_[0]->uniform() && components_[1]->uniform() && components_[2]->uniform();
}

}  // namespace silt
