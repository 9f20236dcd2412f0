#pragma once
#include <span>
#include <vector>

#include "base/mesh.hpp"
#include "fluid/boundary/boundary_conditions.hpp"

namespace silt {

/// Makes a given velocity meet continuity among particles, div(alpha u + j) = 0 with the flow that the boundaries
/// prescribe, by the gradient of a potential: the nearest such velocity in the norm int alpha |u|^2, and what an
/// impulsive start makes of it. `solids_flux`: [nodes][3] m/s, j, volume of particles that moves through an area in a
/// time (-div j = d(1 - alpha)/dt); `velocity`: [nodes][3] m/s, interstitial. `boundary` has been evaluated at the
/// start. Returns the largest change of the velocity, m/s. Collective.
double project_onto_continuity(const Mesh& mesh, const BoundaryConditions& boundary,
                               std::span<const double> void_fraction, std::span<const double> solids_flux,
                               std::vector<double>& velocity);

}  // namespace silt
