// The rigid walls in the substeps, and what the particles feel of all walls.
#include <fmt/format.h>

#include "base/error.hpp"
#include "base/petsc.hpp"
#include "particles/engine.hpp"

namespace silt {

void Engine::move_walls(double time, double h) {
  if (walls_.rigid().empty()) return;
  std::vector<Vec3> force = wall_force;
  if (walls_.servo())
    MPI_Allreduce(MPI_IN_PLACE, force[0].data(), 3 * static_cast<int>(force.size()), MPI_DOUBLE, MPI_SUM,
                  communicator_);
  walls_.advance(time, h, force);
}

void Engine::check_warm_walls() const {
  const int boundaries = static_cast<int>(walls_.boundaries().size());
  for (int w = 0; w < walls_.count(); ++w)
    if (walls_.temperature(w) && !(heat_ && heat_->conducts()))
      throw UserError(
          fmt::format("option -{}: the wall warms particles by conduction, which needs -heat_particles yes "
                      "and -heat_conduction yes",
                      w < boundaries ? fmt::format("boundary_{}_wall_temperature", walls_.name(w))
                                     : fmt::format("wall_{}_temperature", walls_.name(w))));
  if (heat_) heat_->check(walls_);
}

void Engine::add_wall_impulses(double h) {
  for (std::size_t w = 0; w < wall_force.size(); ++w) {
    wall_impulse[w] += h * wall_force[w];
    wall_turning[w] += h * wall_torque[w];
  }
}

}  // namespace silt
