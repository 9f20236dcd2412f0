#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "app/moment.hpp"

namespace silt {

/// Single particles as quantities of the expectations: `particle.<id>.<column>` with the columns position_x ...
/// velocity_z ... spin_z. Only those asked for are measured.
class TrackedParticles {
 public:
  /// Of the quantities asked for, those that are of particles; throws UserError for an unknown column.
  explicit TrackedParticles(const std::vector<std::string>& asked);
  /// The names, for checking.
  const std::vector<std::string>& names() const { return names_; }
  /// A particle that has left gives no value. Collective.
  void sample(const Moment& moment, Quantities& quantities) const;

 private:
  struct Item {
    std::int64_t id;
    int kind, axis;  ///< 0 position, 1 velocity, 2 spin
  };
  std::vector<std::string> names_;
  std::vector<Item> items_;
};

}  // namespace silt
