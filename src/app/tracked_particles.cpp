#include "app/tracked_particles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "base/error.hpp"
#include "base/petsc.hpp"

namespace silt {

TrackedParticles::TrackedParticles(const std::vector<std::string>& asked) {
  const std::string prefix = "particle.";
  for (const auto& name : asked) {
    if (name.rfind(prefix, 0) != 0 || std::find(names_.begin(), names_.end(), name) != names_.end()) continue;
    Item item{-1, -1, -1};
    const char* last = name.data() + name.size();
    const auto [end, error] = std::from_chars(name.data() + prefix.size(), last, item.id);
    const std::string column = error == std::errc() && end < last && *end == '.' ? std::string(end + 1, last) : "";
    const std::string kinds[] = {"position", "velocity", "spin"};
    for (int kind = 0; kind < 3; ++kind)
      for (int axis = 0; axis < 3; ++axis)
        if (column == kinds[kind] + "_" + "xyz"[axis]) item.kind = kind, item.axis = axis;
    if (item.kind < 0 || item.id < 0)
      throw UserError(
          fmt::format("quantity '{}': of a particle there are particle.<id>.position_x, velocity_x, spin_x and "
                      "the same for y and z",
                      name));
    names_.push_back(name);
    items_.push_back(item);
  }
}

void TrackedParticles::sample(const Moment& moment, Quantities& quantities) const {
  if (items_.empty() || !moment.particles) return;
  const Particles& particles = *moment.particles;
  std::vector<double> found(2 * items_.size(), 0.0);  // how many have it, and the value
  for (int i = 0; i < particles.owned(); ++i)
    for (size_t k = 0; k < items_.size(); ++k) {
      const Item& item = items_[k];
      if (particles.id(i) != item.id) continue;
      found[2 * k] = 1;
      found[2 * k + 1] = item.kind == 0   ? particles.position(i)[item.axis]
                         : item.kind == 1 ? particles.velocity(i)[item.axis]
                                          : particles.spin(i)[item.axis];
    }
  MPI_Allreduce(MPI_IN_PLACE, found.data(), static_cast<int>(found.size()), MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  for (size_t k = 0; k < items_.size(); ++k)
    if (found[2 * k] > 0) quantities.set(names_[k], found[2 * k + 1]);
}

}  // namespace silt
