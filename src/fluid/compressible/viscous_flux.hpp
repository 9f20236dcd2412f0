#pragma once
#include "fluid/compressible/gas.hpp"
#include "fluid/compressible/open_boundary.hpp"

namespace silt {

/// The viscous and turbulent flux through an open boundary with unit normal n where velocity and temperature do not
/// change along n (docs/theory/compressible.md, C13): of tau n only mu grad_t(u).n is left, which acts along the
/// boundary, and its work; `gradient` [i][j] = du_i/dx_j. Normal derivatives would leave the boundary without a
/// condition (of order 1, and unstable where viscosity rules); leaving this out, as the form with the symmetric stress
/// does by itself, bends every profile before it leaves.
template <class S, int dim>
void open_viscous_flux(const GasLaw& gas, const GasState<S, dim>& at, const S (&gradient)[dim][dim],
                       double eddy_viscosity, const double* n, S (&F)[dim + 2]) {
  const S mu = gas.mu(at.T) + S(eddy_viscosity);
  S slope[dim], along_normal = S(0.0);  // of the normal velocity
  for (int i = 0; i < dim; ++i) {
    slope[i] = gradient[0][i] * n[0];
    for (int j = 1; j < dim; ++j) slope[i] += gradient[j][i] * n[j];
    along_normal += slope[i] * n[i];
  }
  F[0] = S(0.0), F[dim + 1] = S(0.0);
  for (int i = 0; i < dim; ++i) {
    F[1 + i] = mu * (slope[i] - along_normal * n[i]);
    F[dim + 1] += at.u[i] * F[1 + i];
  }
}

/// Whether it passes: not where the state outside is given entirely (gas enters at sonic speed or more), nor where
/// velocity and temperature are given at the nodes.
inline bool viscous_flux_passes(const GasLaw& gas, const OpenBoundary& outside, const double* n, int dim) {
  if (outside.kind == OpenBoundary::supersonic_inflow || outside.kind == OpenBoundary::velocity) return false;
  return outside.kind != OpenBoundary::far_field || !outside.enters_sonic(gas, n, dim);
}

}  // namespace silt
