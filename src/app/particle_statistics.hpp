#pragma once
#include <string>
#include <vector>

#include "app/moment.hpp"

namespace silt {

/// All particles as quantities of the expectations: `particles.<statistic>` with
/// - diameter_mean, diameter_deviation: m, over the number of particles (deviation: root of the mean square about the
///   mean);
/// - diameter_number_<percent>, diameter_mass_<percent>: m, least diameter up to which that share of the number, of the
///   mass of the particles goes (diameter_mass_50 is the d50 of a sieve analysis);
/// - velocity_mean_<x|y|z>, velocity_deviation_<x|y|z>: m/s, over the number of particles;
/// - share_<material>: share of the number of particles that is of this material.
/// Only those asked for are measured.
class ParticleStatistics {
 public:
  /// Of the quantities asked for, those that are of all particles; throws UserError for an unknown one. Without
  /// particles there are none.
  ParticleStatistics(const std::vector<std::string>& asked, const Particles* particles);
  /// The names, for checking.
  const std::vector<std::string>& names() const { return names_; }
  /// Without a particle there is no value. Collective.
  void sample(const Moment& moment, Quantities& quantities) const;

 private:
  enum class Kind { mean, deviation, number_quantile, mass_quantile, share };
  struct Item {
    Kind kind;
    int which;     ///< of what: -1 diameter, 0 to 2 velocity; the material of a share
    double level;  ///< share up to a quantile
  };
  Item parse(const std::string& name, const Particles& particles) const;
  std::vector<std::string> names_;
  std::vector<Item> items_;
};

}  // namespace silt
