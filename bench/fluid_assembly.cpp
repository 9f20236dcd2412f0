// Times the assembly of the monolithic flow, microseconds of one core an element, beside PetscDS on the same mesh.
#include <fmt/format.h>
#include <petscds.h>
#include <petscfe.h>
#include <petscsnes.h>

#include <chrono>
#include <string>

#include "base/error.hpp"
#include "fluid/assembly/flow_system.hpp"

using namespace silt;

namespace {

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// Best of several rounds, seconds.
template <class F>
double best(int rounds, F f) {
  double least = 1e300;
  for (int k = 0; k < rounds; ++k) {
    const double start = now();
    f();
    least = std::min(least, now() - start);
  }
  return least;
}

// Navier-Stokes with a pressure Laplacian, for PetscDS: fields velocity and pressure, Galerkin.
constexpr double viscosity = 0.01, rate = 100;
#define POINT_ARGUMENTS                                                                                     \
  PetscInt dim, PetscInt, PetscInt, const PetscInt *uOff, const PetscInt *uOff_x, const PetscScalar *u,     \
      const PetscScalar *, const PetscScalar *u_x, const PetscInt *, const PetscInt *, const PetscScalar *, \
      const PetscScalar *, const PetscScalar *, PetscReal
#define RESIDUAL_ARGUMENTS POINT_ARGUMENTS, const PetscReal*, PetscInt, const PetscScalar*, PetscScalar* f
#define JACOBIAN_ARGUMENTS POINT_ARGUMENTS, PetscReal, const PetscReal*, PetscInt, const PetscScalar*, PetscScalar* g

void momentum(RESIDUAL_ARGUMENTS) {
  (void)uOff, (void)uOff_x;
  for (PetscInt i = 0; i < dim; ++i) {
    f[i] = rate * u[i];
    for (PetscInt j = 0; j < dim; ++j) f[i] += u[j] * u_x[i * dim + j];
  }
}
void stress(RESIDUAL_ARGUMENTS) {
  (void)uOff_x;
  for (PetscInt i = 0; i < dim; ++i)
    for (PetscInt j = 0; j < dim; ++j)
      f[i * dim + j] = viscosity * (u_x[i * dim + j] + u_x[j * dim + i]) - (i == j ? u[uOff[1]] : 0);
}
void continuity(RESIDUAL_ARGUMENTS) {
  (void)uOff, (void)uOff_x, (void)u;
  f[0] = 0;
  for (PetscInt i = 0; i < dim; ++i) f[0] += u_x[i * dim + i];
}
void pressure_flux(RESIDUAL_ARGUMENTS) {
  (void)uOff, (void)u;
  for (PetscInt j = 0; j < dim; ++j) f[j] = 0.01 * u_x[uOff_x[1] + j];
}
void momentum_velocity(JACOBIAN_ARGUMENTS) {
  (void)uOff, (void)uOff_x, (void)u;
  for (PetscInt i = 0; i < dim; ++i)
    for (PetscInt j = 0; j < dim; ++j) g[i * dim + j] = (i == j ? rate : 0) + u_x[i * dim + j];
}
void momentum_gradient(JACOBIAN_ARGUMENTS) {
  (void)uOff, (void)uOff_x, (void)u_x;
  for (PetscInt i = 0; i < dim; ++i)
    for (PetscInt j = 0; j < dim; ++j) g[(i * dim + i) * dim + j] = u[j];
}
void stress_gradient(JACOBIAN_ARGUMENTS) {
  (void)uOff, (void)uOff_x, (void)u, (void)u_x;
  for (PetscInt i = 0; i < dim; ++i)
    for (PetscInt j = 0; j < dim; ++j) {
      g[((i * dim + i) * dim + j) * dim + j] += viscosity;
      g[((i * dim + j) * dim + j) * dim + i] += viscosity;
    }
}
void stress_pressure(JACOBIAN_ARGUMENTS) {
  (void)uOff, (void)uOff_x, (void)u, (void)u_x;
  for (PetscInt i = 0; i < dim; ++i) g[i * dim + i] = -1;
}
void continuity_gradient(JACOBIAN_ARGUMENTS) {
  (void)uOff, (void)uOff_x, (void)u, (void)u_x;
  for (PetscInt i = 0; i < dim; ++i) g[i * dim + i] = 1;
}
void pressure_gradient(JACOBIAN_ARGUMENTS) {
  (void)uOff, (void)uOff_x, (void)u, (void)u_x;
  for (PetscInt i = 0; i < dim; ++i) g[i * dim + i] = 0.01;
}

struct Seconds {
  double residual = 0, jacobian = 0;
};

Seconds petsc(DM plex, bool simplex, int order, int rounds) {
  DmHandle dm;
  SILT_PETSC(DMClone(plex, dm.out()));
  PetscFE velocity, pressure;
  PetscInt dimension;
  SILT_PETSC(DMGetDimension(dm, &dimension));
  const PetscBool kind = simplex ? PETSC_TRUE : PETSC_FALSE;
  SILT_PETSC(PetscFECreateLagrange(PETSC_COMM_SELF, dimension, dimension, kind, order, PETSC_DETERMINE, &velocity));
  SILT_PETSC(PetscFECreateLagrange(PETSC_COMM_SELF, dimension, 1, kind, 1, PETSC_DETERMINE, &pressure));
  SILT_PETSC(PetscFECopyQuadrature(velocity, pressure));
  SILT_PETSC(DMSetField(dm, 0, nullptr, reinterpret_cast<PetscObject>(velocity)));
  SILT_PETSC(DMSetField(dm, 1, nullptr, reinterpret_cast<PetscObject>(pressure)));
  SILT_PETSC(DMCreateDS(dm));
  PetscDS ds;
  SILT_PETSC(DMGetDS(dm, &ds));
  SILT_PETSC(PetscDSSetResidual(ds, 0, momentum, stress));
  SILT_PETSC(PetscDSSetResidual(ds, 1, continuity, pressure_flux));
  SILT_PETSC(PetscDSSetJacobian(ds, 0, 0, momentum_velocity, momentum_gradient, nullptr, stress_gradient));
  SILT_PETSC(PetscDSSetJacobian(ds, 0, 1, nullptr, nullptr, stress_pressure, nullptr));
  SILT_PETSC(PetscDSSetJacobian(ds, 1, 0, nullptr, continuity_gradient, nullptr, nullptr));
  SILT_PETSC(PetscDSSetJacobian(ds, 1, 1, nullptr, nullptr, nullptr, pressure_gradient));
  SILT_PETSC(DMPlexSetClosurePermutationTensor(dm, PETSC_DETERMINE, nullptr));
  MatHandle matrix;
  SILT_PETSC(DMCreateMatrix(dm, matrix.out()));
  VecHandle x, r;
  SILT_PETSC(DMCreateLocalVector(dm, x.out()));
  SILT_PETSC(DMCreateLocalVector(dm, r.out()));
  SILT_PETSC(VecSet(x, 0.3));
  Seconds seconds;
  seconds.residual = best(rounds, [&] { SILT_PETSC(DMPlexSNESComputeResidualFEM(dm, x, r, nullptr)); });
  seconds.jacobian = best(rounds, [&] { SILT_PETSC(DMPlexSNESComputeJacobianFEM(dm, x, matrix, matrix, nullptr)); });
  SILT_PETSC(PetscFEDestroy(&velocity));
  SILT_PETSC(PetscFEDestroy(&pressure));
  return seconds;
}

void measure(const std::string& cell, int order, int n, int lanes, double goal_jacobian, double goal_residual,
             bool compare) {
  Options options;
  MeshOptions mesh_options;
  mesh_options.cell = cell;
  mesh_options.cells = {n, n, n};
  for (const char* side : {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"})
    options.set(fmt::format("boundary_{}_type", side), "no_slip");
  const Mesh mesh(mesh_options);
  const BoundaryConditions boundary(mesh, options, 1);
  const FlowSystem system(mesh, boundary, order, lanes);
  const size_t v = system.space().nodes, p = mesh.nodes;
  StepFields fields;
  fields.alpha.assign(v, 1.0);
  for (auto* field : {&fields.history, &fields.velocity_old, &fields.body, &fields.prescribed_velocity})
    field->assign(3 * v, 0.0);
  for (auto* field : {&fields.load, &fields.nodal_load}) field->assign(3 * p, 0.0);
  for (auto* field : {&fields.alpha_rate, &fields.response, &fields.nodal_response, &fields.prescribed_flow,
                      &fields.boundary_pressure})
    field->assign(p, 0.0);
  fields.parameters.viscosity = viscosity;
  fields.parameters.time_coefficient = rate;
  if (order == 2) fields.parameters.supg = fields.parameters.pspg = fields.parameters.grad_div = 0;
  std::vector<double> u(3 * v), pressure(p);
  for (size_t i = 0; i < u.size(); ++i) u[i] = std::sin(0.1 * static_cast<double>(i));
  const VecHandle x = system.create_vector(), r = system.create_vector();
  const MatHandle matrix = system.create_matrix();
  system.to_vector(u.data(), pressure.data(), x);
  // In turn, over a few seconds: the least of a few moments is that of a busy one.
  const double scale = 1e6 / mesh.cells;
  double residual = 1e300, jacobian = 1e300;
  for (int round = 0; round < 60; ++round) {
    residual = std::min(residual, scale * best(5, [&] { SILT_PETSC(system.residual(fields, x, r)); }));
    jacobian = std::min(jacobian, scale * best(1, [&] { SILT_PETSC(system.jacobian(fields, x, matrix)); }));
  }
  std::string line = fmt::format("assembly {} {} jacobian {:.3g} us (goal {}) residual {:.3g} us",
                                 order == 1 ? "equal_order" : "taylor_hood", cell, jacobian, goal_jacobian, residual);
  if (goal_residual > 0) line += fmt::format(" (goal {})", goal_residual);
  if (compare) {
    const Seconds other = petsc(mesh.plex(), cell == "tetrahedron", order, 1);
    line +=
        fmt::format("; PetscDS jacobian {:.3g} us residual {:.3g} us, {:.3g} and {:.3g} times", scale * other.jacobian,
                    scale * other.residual, scale * other.jacobian / jacobian, scale * other.residual / residual);
  }
  fmt::print("{}\n", line);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  if (PetscInitialize(&argc, &argv, nullptr, nullptr)) return 1;
  PetscBool alone = PETSC_FALSE;
  PetscInt lanes = 4;
  int code = 0;
  try {
    SILT_PETSC(PetscOptionsGetInt(nullptr, nullptr, "-lanes", &lanes, nullptr));
    SILT_PETSC(PetscOptionsGetBool(nullptr, nullptr, "-alone", &alone, nullptr));
    fmt::print("one core, {} cells at a time\n", lanes);
    measure("tetrahedron", 1, 18, lanes, 1, 0.15, !alone);
    measure("hexahedron", 1, 20, lanes, 8, 0, !alone);
    measure("tetrahedron", 2, 8, lanes, 15, 0, !alone);
  } catch (const std::exception& error) {
    fmt::print(stderr, "bench/fluid_assembly: {}\n", error.what());
    code = 1;
  }
  PetscFinalize();
  return code;
}
