// The element loops, written once for vectors of SILT_LANES doubles (one lane a cell). Included by one unit for each
// instruction set, which defines SILT_LANES; everything here has internal linkage so that no unit's code is used by
// another. Formulas: docs/theory/pressure_correction.md; equation numbers of that page stand in the comments.
#include "fluid/pressure_correction/cell_batch.hpp"
#include "fluid/pressure_correction/cell_loop_arguments.hpp"

namespace silt {
namespace {

/// The cells' viscosity, with that of the turbulence.
inline Lanes viscosity_of(double molecular, const double* eddy, long at) {
  return eddy ? molecular + load(eddy + at) : constant(molecular);
}

template <int kind>
void coefficients(const CellBatches& mesh, const CoefficientTerms& in, const CellCoefficients& out) {
  constexpr int D = Shape<kind>::D, nodes = Shape<kind>::nodes;
  const double rho_rate = in.density * in.rate;
  for (int batch = 0; batch < mesh.batches; ++batch) {
    const int* node = batch_nodes<kind>(mesh, batch);
    const long at = static_cast<long>(batch) * W;
    Lanes w[nodes][D], speed2 = {}, alpha = constant(1), beta = {}, mobility = constant(1 / rho_rate), follows = {};
    gather(w, in.velocity, 3, node);
    for (int a = 0; a < nodes; ++a)
      for (int d = 0; d < D; ++d) speed2 += w[a][d] * w[a][d] * (1.0 / nodes);
    if (in.void_fraction) {
      Lanes alphas[nodes][1], betas[nodes][1];
      gather(alphas, in.void_fraction, 1, node);
      gather(betas, in.drag, 1, node);
      // The response acts at the nodes, so a cell's mobility is the mean of its nodes': with a mean of the drag instead
      // the pressure equation is stiffer than the momentum equation where a bed ends, and the splitting unstable.
      Lanes kappa = {};
      alpha = mobility = Lanes{};
      for (int a = 0; a < nodes; ++a) {
        alpha += alphas[a][0] * (1.0 / nodes);
        kappa += betas[a][0] / (alphas[a][0] * alphas[a][0]) * (1.0 / nodes);
        mobility += alphas[a][0] / (alphas[a][0] * rho_rate + betas[a][0]) * (1.0 / nodes);
      }
      beta = alpha * alpha * kappa;
      mobility /= alpha;
      if (in.following && in.model_a) {
        Lanes s[nodes][1];
        gather(s, in.following, 1, node);
        for (int a = 0; a < nodes; ++a) follows += s[a][0] * (1.0 / nodes);
      }
    }
    const Lanes share = in.model_a ? alpha : constant(1);
    const Lanes inertia = alpha * rho_rate + beta, h = load(mesh.size + at);
    const Lanes mu = viscosity_of(in.viscosity, in.eddy_viscosity, at);
    const Lanes convection = alpha * (2 * in.density) / h, diffusion = alpha * (12 * mu) / (h * h);
    store(out.void_fraction + at, alpha);
    store(out.pressure_share + at, share);
    store(out.drag + at, beta);
    store(out.mobility + at, (share + follows) * mobility);
    store(out.following + at, follows);
    store(out.stabilisation + at,
          alpha * share / square_root(convection * convection * speed2 + diffusion * diffusion + inertia * inertia));
  }
}

/// The nodal loads of the particles and the fluid's weight as densities constant in each cell. A node's load is shared
/// among its cells by their drag coefficient alpha_e kappa_e (and by volume where there is none): a bed in equilibrium
/// then has grad p + s = 0 in every cell, also where it ends.
template <int kind>
void cell_forces(const CellBatches& mesh, const ForceTerms& in, const CellCoefficients& out) {
  constexpr int D = Shape<kind>::D, nodes = Shape<kind>::nodes;
  for (int batch = 0; batch < mesh.batches; ++batch) {
    const int* node = batch_nodes<kind>(mesh, batch);
    const long at = static_cast<long>(batch) * W;
    Lanes force[D] = {}, total[D] = {};
    if (in.load_per_drag) {
      Lanes f[nodes][D];
      gather(f, in.load_per_drag, 3, node);
      const Lanes drag = load(in.drag + at);
      for (int a = 0; a < nodes; ++a)
        for (int d = 0; d < D; ++d) force[d] += drag * f[a][d];
    }
    for (int d = 0; d < D; ++d) total[d] = force[d];
    if (in.weight) {
      Lanes f[nodes][D];
      gather(f, in.weight, 3, node);
      for (int a = 0; a < nodes; ++a)
        for (int d = 0; d < D; ++d) total[d] += f[a][d] * (1.0 / nodes);
    }
    const Lanes share = load(out.pressure_share + at);
    for (int d = 0; d < D; ++d) {
      store(out.force[d] + at, force[d]);
      store(out.balance[d] + at, -total[d] / share);
    }
  }
}

template <int kind, bool porous>
void momentum(const CellBatches& mesh, const MomentumTerms& in, double* values, double* right) {
  constexpr int D = Shape<kind>::D, nodes = Shape<kind>::nodes;
  const double rho = in.density;
  for (int batch = 0; batch < mesh.batches; ++batch) {
    const int* node = batch_nodes<kind>(mesh, batch);
    const long at = static_cast<long>(batch) * W;
    Geometry<kind> geometry(mesh, batch);
    const auto& G = geometry.gradient;
    Lanes w[nodes][D], history[nodes][D], p[nodes][1];
    gather(w, in.velocity, 3, node);
    gather(history, in.history, 3, node);
    gather(p, in.pressure, 1, node);
    Lanes alphas[porous ? nodes : 1][1], rates[porous ? nodes : 1][1], phi[porous ? nodes : 1][1],
        old_phi[porous ? nodes : 1][1], returned[porous ? nodes : 1][1];
    Lanes share = constant(1), drag = {}, factor = {}, old_factor = {}, lent = {}, cell_force[D] = {};
    if constexpr (porous) {
      gather(alphas, in.void_fraction, 1, node);
      gather(rates, in.void_fraction_rate, 1, node);
      gather(phi, in.increment, 1, node);
      gather(old_phi, in.old_increment, 1, node);
      gather(returned, in.lent_pressure, 1, node);
      share = load(in.cell_pressure_share + at) + load(in.cell_following + at);
      lent = load(in.cell_lent + at);
      drag = load(in.cell_drag + at);
      factor = load(in.increment_factor + at);
      old_factor = load(in.old_increment_factor + at);
      if (in.force[0])
        for (int d = 0; d < D; ++d) cell_force[d] = load(in.force[d] + at);
    }
    Lanes body[nodes][D];
    if (in.body_force) gather(body, in.body_force, 3, node);
    const Lanes h = load(mesh.size + at), mu = viscosity_of(in.viscosity, in.eddy_viscosity, at);
    Lanes K[nodes][nodes] = {}, r[nodes][D] = {};
    for (int q = 0; q < Shape<kind>::points; ++q) {
      geometry.at(*mesh.reference, q);
      const double* N = mesh.reference->shape[q];
      const Lanes dV = geometry.volume;
      Lanes wq[D] = {}, f[D] = {}, gp[D] = {}, alpha = constant(1), grad_alpha[D] = {};
      if constexpr (porous) {
        alpha = Lanes{};
        for (int a = 0; a < nodes; ++a) {
          alpha += N[a] * alphas[a][0];
          for (int d = 0; d < D; ++d) grad_alpha[d] += G[a][d] * alphas[a][0];
        }
      }
      for (int a = 0; a < nodes; ++a) {
        Lanes effective;
        if constexpr (porous)
          effective = share * p[a][0] - lent * returned[a][0] + factor * phi[a][0] - old_factor * old_phi[a][0];
        else
          effective = p[a][0];
        for (int d = 0; d < D; ++d) {
          wq[d] += N[a] * w[a][d];
          f[d] += N[a] * history[a][d];
          gp[d] += G[a][d] * effective;
        }
      }
      for (int d = 0; d < D; ++d) f[d] = alpha * rho * f[d] - gp[d];
      if (in.body_force)
        for (int a = 0; a < nodes; ++a)
          for (int d = 0; d < D; ++d) f[d] += N[a] * body[a][d];
      Lanes speed2 = {};
      for (int d = 0; d < D; ++d) speed2 += wq[d] * wq[d];
      const Lanes convection = alpha * (2 * rho) / h, diffusion = alpha * (12 * mu) / (h * h);
      const Lanes tau = in.supg / square_root(convection * convection * speed2 + diffusion * diffusion + drag * drag);
      Lanes transport[nodes];  // alpha rho w.grad N
      for (int a = 0; a < nodes; ++a) {
        transport[a] = wq[0] * G[a][0];
        for (int d = 1; d < D; ++d) transport[a] += wq[d] * G[a][d];
        transport[a] *= alpha * rho;
      }
      // The particles' force acts at the nodes (Galerkin part); the streamline part sees its cell mean.
      Lanes stream[D], extra[D] = {}, dilation = {};
      for (int d = 0; d < D; ++d) stream[d] = f[d] + cell_force[d];
      if constexpr (porous) {
        // Explicit rest of the deviatoric stress, with w: mu grad w.grad alpha - mu div w grad alpha in the volume and
        // mu/3 alpha div w against div N, div w = -(d(alpha)/dt + w.grad alpha)/alpha by continuity; zero for alpha
        // = 1.
        Lanes gradient[D][D] = {};
        for (int a = 0; a < nodes; ++a)
          for (int i = 0; i < D; ++i)
            for (int j = 0; j < D; ++j) gradient[i][j] += G[a][i] * w[a][j];
        for (int a = 0; a < nodes; ++a) dilation -= N[a] * rates[a][0];
        for (int d = 0; d < D; ++d) dilation -= wq[d] * grad_alpha[d];
        dilation /= alpha;
        for (int i = 0; i < D; ++i) {
          for (int j = 0; j < D; ++j) extra[i] += mu * gradient[i][j] * grad_alpha[j];
          extra[i] -= mu * dilation * grad_alpha[i];
        }
        dilation *= alpha * (mu / 3) * dV;
      }
      const Lanes inertia = alpha * (rho * in.rate), viscous = alpha * mu * dV;
      Lanes operator_[nodes];
      for (int b = 0; b < nodes; ++b) operator_[b] = inertia * N[b] + transport[b];
      for (int a = 0; a < nodes; ++a) {
        const Lanes galerkin = dV * N[a], streamline = dV * tau * transport[a], test = galerkin + streamline;
        for (int d = 0; d < D; ++d) {
          if constexpr (porous)
            r[a][d] += galerkin * (f[d] + extra[d]) + streamline * stream[d] - dilation * G[a][d];
          else
            r[a][d] += test * f[d];
        }
        for (int b = 0; b < nodes; ++b) {
          Lanes product = G[a][0] * G[b][0];
          for (int d = 1; d < D; ++d) product += G[a][d] * G[b][d];
          K[a][b] += test * operator_[b] + viscous * product;
        }
      }
    }
    const int lanes = lanes_of(mesh, batch);
    scatter(r, right, 3, node, lanes);
    scatter_matrix(K, values, mesh.entry + at * nodes * nodes, lanes);
  }
}

/// int P_e (N + tau alpha rho w.grad N): a uniform pressure gradient, as momentum() treats the pressure's own.
template <int kind>
void drive(const CellBatches& mesh, const MomentumTerms& in, double* sums) {
  constexpr int D = Shape<kind>::D, nodes = Shape<kind>::nodes;
  for (int batch = 0; batch < mesh.batches; ++batch) {
    const int* node = batch_nodes<kind>(mesh, batch);
    const long at = static_cast<long>(batch) * W;
    Geometry<kind> geometry(mesh, batch);
    const auto& G = geometry.gradient;
    Lanes w[nodes][D], alphas[nodes][1], r[nodes][1] = {}, share = constant(1), drag = {};
    gather(w, in.velocity, 3, node);
    for (int a = 0; a < nodes; ++a) alphas[a][0] = constant(1);
    if (in.void_fraction) {
      gather(alphas, in.void_fraction, 1, node);
      share = load(in.cell_pressure_share + at);
      drag = load(in.cell_drag + at);
    }
    const Lanes h = load(mesh.size + at), mu = viscosity_of(in.viscosity, in.eddy_viscosity, at);
    for (int q = 0; q < Shape<kind>::points; ++q) {
      geometry.at(*mesh.reference, q);
      const double* N = mesh.reference->shape[q];
      Lanes wq[D] = {}, alpha = {}, speed2 = {};
      for (int a = 0; a < nodes; ++a) {
        alpha += N[a] * alphas[a][0];
        for (int d = 0; d < D; ++d) wq[d] += N[a] * w[a][d];
      }
      for (int d = 0; d < D; ++d) speed2 += wq[d] * wq[d];
      const Lanes convection = alpha * (2 * in.density) / h, diffusion = alpha * (12 * mu) / (h * h);
      const Lanes tau = in.supg / square_root(convection * convection * speed2 + diffusion * diffusion + drag * drag);
      for (int a = 0; a < nodes; ++a) {
        Lanes transport = wq[0] * G[a][0];
        for (int d = 1; d < D; ++d) transport += wq[d] * G[a][d];
        r[a][0] += geometry.volume * share * (N[a] + tau * alpha * in.density * transport);
      }
    }
    scatter(r, sums, 1, node, lanes_of(mesh, batch));
  }
}

template <int kind>
void projection(const CellBatches& mesh, const ContinuityTerms& in, double* sums) {
  constexpr int D = Shape<kind>::D, nodes = Shape<kind>::nodes;
  for (int batch = 0; batch < mesh.batches; ++batch) {
    const int* node = batch_nodes<kind>(mesh, batch);
    const long at = static_cast<long>(batch) * W;
    Geometry<kind> geometry(mesh, batch);
    const auto& G = geometry.gradient;
    Lanes p[nodes][1], balance[D] = {}, r[nodes][4] = {};
    gather(p, in.pressure, 1, node);
    if (in.balance[0])
      for (int d = 0; d < D; ++d) balance[d] = load(in.balance[d] + at);
    const Lanes tau = load(in.stabilisation + at);
    for (int q = 0; q < Shape<kind>::points; ++q) {
      geometry.at(*mesh.reference, q);
      const double* N = mesh.reference->shape[q];
      Lanes g[D];
      for (int d = 0; d < D; ++d) g[d] = balance[d];
      for (int a = 0; a < nodes; ++a)
        for (int d = 0; d < D; ++d) g[d] += G[a][d] * p[a][0];
      const Lanes weight = geometry.volume * tau;
      for (int a = 0; a < nodes; ++a) {
        for (int d = 0; d < D; ++d) r[a][d] += N[a] * weight * g[d];
        r[a][3] += N[a] * weight;
      }
    }
    scatter(r, sums, 4, node, lanes_of(mesh, batch));
  }
}

template <int kind>
void continuity(const CellBatches& mesh, const ContinuityTerms& in, double* sums) {
  constexpr int D = Shape<kind>::D, nodes = Shape<kind>::nodes;
  for (int batch = 0; batch < mesh.batches; ++batch) {
    const int* node = batch_nodes<kind>(mesh, batch);
    const long at = static_cast<long>(batch) * W;
    Geometry<kind> geometry(mesh, batch);
    const auto& G = geometry.gradient;
    Lanes p[nodes][1], U[nodes][D], pi[nodes][D], balance[D] = {}, r[nodes][2] = {};
    gather(p, in.pressure, 1, node);
    gather(U, in.flux, 3, node);
    gather(pi, in.projection, 3, node);
    if (in.balance[0])
      for (int d = 0; d < D; ++d) balance[d] = load(in.balance[d] + at);
    const Lanes tau = load(in.stabilisation + at);
    for (int q = 0; q < Shape<kind>::points; ++q) {
      geometry.at(*mesh.reference, q);
      const double* N = mesh.reference->shape[q];
      Lanes flux[D] = {}, residual[D], divergence = {};
      for (int d = 0; d < D; ++d) residual[d] = balance[d];
      for (int a = 0; a < nodes; ++a)
        for (int d = 0; d < D; ++d) {
          flux[d] += N[a] * U[a][d];
          residual[d] += G[a][d] * p[a][0] - N[a] * pi[a][d];
          divergence += G[a][d] * U[a][d];
        }
      for (int d = 0; d < D; ++d) flux[d] = geometry.volume * (flux[d] - tau * residual[d]);
      divergence *= geometry.volume;
      for (int a = 0; a < nodes; ++a) {
        for (int d = 0; d < D; ++d) r[a][0] += G[a][d] * flux[d];
        r[a][1] += N[a] * divergence;
      }
    }
    scatter(r, sums, 2, node, lanes_of(mesh, batch));
  }
}

template <int kind>
void diffusion(const CellBatches& mesh, const double* coefficient, double* values) {
  constexpr int D = Shape<kind>::D, nodes = Shape<kind>::nodes;
  for (int batch = 0; batch < mesh.batches; ++batch) {
    const long at = static_cast<long>(batch) * W;
    Geometry<kind> geometry(mesh, batch);
    const auto& G = geometry.gradient;
    const Lanes c = load(coefficient + at);
    Lanes K[nodes][nodes] = {};
    constexpr int points = Shape<kind>::simplex ? 1 : Shape<kind>::points;
    for (int q = 0; q < points; ++q) {
      geometry.at(*mesh.reference, q);
      const Lanes weight = c * geometry.volume * (Shape<kind>::simplex ? double(Shape<kind>::points) : 1.0);
      for (int a = 0; a < nodes; ++a)
        for (int b = 0; b < nodes; ++b) {
          Lanes product = G[a][0] * G[b][0];
          for (int d = 1; d < D; ++d) product += G[a][d] * G[b][d];
          K[a][b] += weight * product;
        }
    }
    scatter_matrix(K, values, mesh.entry + at * nodes * nodes, lanes_of(mesh, batch));
  }
}

template <int kind>
void mean_gradient(const CellBatches& mesh, const double* field, const double* factor, double* sums) {
  constexpr int D = Shape<kind>::D, nodes = Shape<kind>::nodes;
  for (int batch = 0; batch < mesh.batches; ++batch) {
    const int* node = batch_nodes<kind>(mesh, batch);
    Geometry<kind> geometry(mesh, batch);
    Lanes p[nodes][1], total[D] = {};
    gather(p, field, 1, node);
    for (int q = 0; q < Shape<kind>::points; ++q) {
      geometry.at(*mesh.reference, q);
      for (int a = 0; a < nodes; ++a)
        for (int d = 0; d < D; ++d) total[d] += geometry.volume * geometry.gradient[a][d] * p[a][0];
    }
    const Lanes share = (factor ? load(factor + static_cast<long>(batch) * W) : constant(1)) * (1.0 / nodes);
    Lanes r[nodes][D];
    for (int a = 0; a < nodes; ++a)
      for (int d = 0; d < D; ++d) r[a][d] = total[d] * share;
    scatter(r, sums, 3, node, lanes_of(mesh, batch));
  }
}

template <int kind>
constexpr CellLoopTable table = {W,
                                 coefficients<kind>,
                                 cell_forces<kind>,
                                 momentum<kind, false>,
                                 momentum<kind, true>,
                                 projection<kind>,
                                 continuity<kind>,
                                 diffusion<kind>,
                                 drive<kind>,
                                 mean_gradient<kind>};

constexpr const CellLoopTable* tables[4] = {&table<0>, &table<1>, &table<2>, &table<3>};

}  // namespace
}  // namespace silt
