#pragma once
#include "fluid/turbulence/strain.hpp"

namespace silt {

/// What a two-equation model sees at a node.
struct TurbulentPoint {
  double density, viscosity;  ///< kg/m3, Pa s
  double k;                   ///< m2/s2, turbulent kinetic energy
  double second;              ///< epsilon (m2/s3) or omega (1/s)
  double distance;            ///< m, to the nearest wall
  double cross;               ///< grad k . grad(second)
  double production;          ///< W/m3 of fluid, mu_t S^2 or mu_t S W, or that of the law of the wall
  Strain strain;
};

/// The terms of both equations there, densities; destruction is the coefficient of the unknown. Sources that are
/// quadratic in the unknown are linearised so that both parts are positive.
struct TurbulentTerms {
  double eddy_viscosity;                     ///< Pa s
  double k_diffusivity, second_diffusivity;  ///< kg/(m s), molecular part included
  double k_production, k_destruction;
  double second_production, second_destruction;
  double free = 1;  ///< share of the model of free shear layers; less near walls (SST: 1 - F1)
};

}  // namespace silt
