#pragma once
#include <string>
#include <vector>

#include "particles/insertion/insertion_options.hpp"
#include "particles/insertion/random.hpp"

namespace silt {

/// The diameters of an insertion, as numbers are drawn: one diameter, a uniform, normal or lognormal spread, a list of
/// diameters with their shares, or a sieve curve.
class SizeDistribution {
 public:
  /// Throws UserError naming `-<prefix>_...` for what is missing or contradicts itself.
  SizeDistribution(const InsertionOptions& options, const std::string& prefix);
  double radius(RandomStream& random) const;
  /// m, largest radius that can be drawn.
  double largest_radius() const { return 0.5 * largest_; }

 private:
  double diameter(RandomStream& random) const;
  std::string kind_;
  double mean_ = 0, deviation_ = 0, largest_ = 0;
  bool by_mass_ = false;
  std::vector<double> diameters_;
  std::vector<double> up_to_;  ///< share of the number of particles up to entry (discrete) or interval k (sieve)
};

/// The materials of an insertion: one, or several drawn by their share of the number of particles.
class MaterialChoice {
 public:
  /// `materials`: the names of all. Throws UserError.
  MaterialChoice(const InsertionOptions& options, const std::string& prefix, const std::vector<std::string>& materials);
  int draw(RandomStream& random) const;
  /// Those that may be drawn.
  const std::vector<int>& all() const { return index_; }

 private:
  std::vector<int> index_;
  std::vector<double> up_to_;
};

}  // namespace silt
