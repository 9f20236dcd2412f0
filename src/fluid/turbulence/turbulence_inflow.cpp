#include "fluid/turbulence/turbulence_inflow.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"

namespace silt {

TurbulenceInflow::TurbulenceInflow(const Mesh& mesh, Options& options, const BoundaryConditions& boundaries) {
  for (std::size_t b = 0; b < mesh.boundaries.size(); ++b) {
    const std::string prefix = "boundary_" + mesh.boundaries[b] + "_turbulence";
    TurbulenceInflowOptions read;
    options.read(prefix, read);
    const auto type = boundaries.type(static_cast<int>(b));
    const bool closed = type == BoundaryType::no_slip || type == BoundaryType::slip;
    const bool needed = !closed && type != BoundaryType::pressure && type != BoundaryType::supersonic_outflow;
    const bool intensity = options.given(prefix + "_intensity"), energy = options.given(prefix + "_energy"),
               length = options.given(prefix + "_length"), ratio = options.given(prefix + "_viscosity_ratio");
    Condition c;
    c.given = intensity || energy || length || ratio;
    if (c.given && closed) throw UserError(fmt::format("-{}_...: nothing enters through a wall", prefix));
    if ((needed || c.given) && intensity == energy)
      throw UserError(
          fmt::format("boundary {}: the turbulence of what enters needs one of -{}_intensity and -{}_energy",
                      mesh.boundaries[b], prefix, prefix));
    if ((needed || c.given) && length == ratio)
      throw UserError(
          fmt::format("boundary {}: the turbulence of what enters needs one of -{}_length and -{}_viscosity_ratio",
                      mesh.boundaries[b], prefix, prefix));
    c.by_energy = energy, c.by_length = length;
    c.intensity = std::make_unique<Expression>(prefix + "_intensity", read.intensity);
    c.energy = std::make_unique<Expression>(prefix + "_energy", read.energy);
    c.length = std::make_unique<Expression>(prefix + "_length", read.length);
    c.viscosity_ratio = std::make_unique<Expression>(prefix + "_viscosity_ratio", read.viscosity_ratio);
    for (const auto& [name, expression] : {std::pair{"length", &c.length},
                                           {"viscosity_ratio", &c.viscosity_ratio},
                                           {"intensity", &c.intensity},
                                           {"energy", &c.energy}})
      if (options.given(prefix + "_" + name) && (*expression)->constant() && !((**expression)(Vec3::Zero(), 0) > 0))
        throw UserError(fmt::format("option -{}_{}: it must be above 0", prefix, name));
    conditions_.push_back(std::move(c));
  }
}

double TurbulenceInflow::energy(int boundary, const Vec3& x, double t, double speed) const {
  const Condition& c = conditions_[boundary];
  if (c.by_energy) return std::max(0.0, (*c.energy)(x, t));
  const double fluctuation = (*c.intensity)(x, t) * speed;
  return 1.5 * fluctuation * fluctuation;
}

TurbulenceInflow::Scale TurbulenceInflow::scale(int boundary, const Vec3& x, double t) const {
  const Condition& c = conditions_[boundary];
  constexpr double least = 1e-30;
  return c.by_length ? Scale{std::max((*c.length)(x, t), least), 0}
                     : Scale{0, std::max((*c.viscosity_ratio)(x, t), least)};
}

}  // namespace silt
