#include "fluid/turbulence/initial_turbulence.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"
#include "base/field_file.hpp"
#include "fluid/initial_state.hpp"
#include "fluid/turbulence/wall_law.hpp"

namespace silt {
namespace {

constexpr const char* energy_field = "turbulent_energy";
constexpr const char* second_field[2] = {"specific_dissipation", "turbulent_dissipation"};
constexpr double least_energy = 1e-30;  // m2/s2, where omega = epsilon / (C_mu k)

}  // namespace

InitialTurbulence::InitialTurbulence(const Mesh& mesh, Options& options, const TurbulenceOptions& read,
                                     bool dissipation)
    : energy_("fluid_initial_turbulent_energy", read.initial_energy),
      ratio_("fluid_initial_viscosity_ratio", read.initial_viscosity_ratio) {
  const bool formula = options.given("fluid_initial_turbulent_energy");
  InitialStateOptions start;  // where the file lies may be said relative to the case
  options.read("fluid", start);
  const bool path = !start.file.empty();
  if (path && options.given("restart")) return;
  if (path) {
    const FieldFile file("fluid_initial_file", start.file);
    if (file.has(energy_field)) {
      for (const char* name : {"fluid_initial_turbulent_energy", "fluid_initial_viscosity_ratio"})
        if (options.given(name))
          throw UserError(
              fmt::format("-{} and -fluid_initial_file exclude each other: the file has the turbulence", name));
      std::vector<Vec3> places(mesh.nodes);
      for (std::size_t i = 0; i < places.size(); ++i) places[i] = vec3(&mesh.node_coordinates[3 * i]);
      k_ = file.sample(energy_field, 1, places);
      const bool same = file.has(second_field[dissipation]);
      second_ = file.sample(second_field[same == dissipation], 1, places);
      for (std::size_t i = 0; !same && i < second_.size(); ++i)
        second_[i] *= dissipation ? wall_law::C_mu * k_[i] : 1 / (wall_law::C_mu * std::max(k_[i], least_energy));
      return;
    }
  }
  if (!formula)
    throw UserError(fmt::format("-fluid_initial_turbulent_energy is missing: -fluid_turbulence {} needs it{}",
                                read.turbulence, path ? ", and -fluid_initial_file has no turbulence" : ""));
}

double InitialTurbulence::energy(const Vec3& x) const { return std::max(0.0, energy_(x, 0)); }
double InitialTurbulence::viscosity_ratio(const Vec3& x) const { return std::max(ratio_(x, 0), 1e-10); }

}  // namespace silt
