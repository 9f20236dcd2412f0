#pragma once
#include <optional>
#include <string>
#include <vector>

#include "base/expression.hpp"
#include "base/mesh.hpp"
#include "base/options.hpp"

namespace silt {

/// What a boundary of the mesh is to the particles.
enum class BoundaryRole {
  wall,    ///< they collide with it
  outlet,  ///< a particle whose centre passes it leaves the run and is counted
  open     ///< no wall and no outlet: a particle whose centre passes it is lost, which `-particles_lost` judges
};

/// The options `-boundary_<name>_...` of the particles.
struct WallBoundaryOptions {
  std::string role = "wall", material, temperature;
  void options(OptionGroup& option) {
    option("particles", role, {"wall", "outlet", "open"},
           "what the boundary is to particles: a wall (default of every fluid type but pressure), an outlet where they "
           "leave, or open (no wall; a particle that passes is lost: -particles_lost)");
    option("material", material, "material of the wall; default: the first material in alphabetical order");
    option("wall_temperature", temperature,
           "K, formula in x, y, z, t: temperature of the wall, which particles that touch it are warmed by "
           "(-heat_conduction); default: it conducts no heat to them");
  }
};

/// One boundary of the mesh for the particles, by the options `-boundary_<name>_particles`, `_material`, and
/// `_velocity` and `_rotation_...` where the boundary is `no_slip` (or has no fluid type): the velocity of the wall's
/// material, the shape staying where it is (a conveyor, a lid, a rotating drum's shell).
struct WallBoundary {
  BoundaryRole role = BoundaryRole::wall;
  int material = 0;                        ///< index into the materials
  Vec3 velocity = Vec3::Zero();            ///< m/s, when `motion` is empty
  std::optional<VectorExpression> motion;  ///< velocity that varies in space or time
  std::optional<Expression> temperature;   ///< K; none: no heat is conducted

  Vec3 velocity_at(const Vec3& point, double time) const { return motion ? (*motion)(point, time) : velocity; }
};

/// Index of the material that `-<prefix>_material` names; of the first in alphabetical order when it names none. Throws
/// UserError for an unknown one.
int wall_material(const std::string& chosen, const std::string& prefix, const Options& options,
                  const std::vector<std::string>& materials);

/// Reads the options of every boundary of the mesh. A boundary is a wall unless its fluid type is `pressure` (outlet);
/// its material is the first of `materials` in alphabetical order unless given.
std::vector<WallBoundary> read_wall_boundaries(const Mesh& mesh, Options& options,
                                               const std::vector<std::string>& materials);

}  // namespace silt
