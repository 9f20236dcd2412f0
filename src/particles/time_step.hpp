#pragma once
#include <string>
#include <vector>

#include "particles/contact_laws.hpp"
#include "particles/particle_options.hpp"

namespace silt {

/// The smallest particle of each material, on all ranks; no radius where there is none.
struct SmallestRadii {
  std::vector<double> radius;  ///< m, infinity where the material has no particle
};

/// The longest time step allowed and what limits it.
struct StepLimit {
  double step = infinity;
  std::string reason = "no particles";
};

/// Another duration that the step must resolve like a collision.
struct StepBound {
  double duration;  ///< s
  std::string reason;
};

/// Smallest of: a share of the shortest collision (of the chosen normal law, at `speed`, over all pairs of materials,
/// walls included), the same share of the oscillation with the steepest slope of every other force along the line of
/// centres (adhesion, double layers), twice that share of the swing of springs that are given to friction, rolling and
/// twisting, and for the Hertz family a share of the Rayleigh time t_R = pi R sqrt(rho/G) /
/// (0.1631 s + 0.8766), Li et al. 2005.
StepLimit limit_step(const ParticleOptions& options, const Materials& materials, const ContactLaws& laws,
                     const SmallestRadii& smallest, double speed, const std::vector<StepBound>& others = {});

}  // namespace silt
