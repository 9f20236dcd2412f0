#include <catch2/catch.hpp>
#include <map>

#include "base/dual.hpp"
#include "monolithic_case.hpp"

using namespace silt;
using silt::test::MonolithicCase;

namespace {

/// Numbers with first and second derivatives in x, y, z, t.
using First = Dual<4>;
using Second = Dual<4, First>;

/// Fields of a manufactured solution, written once for any scalar: U = alpha u superficial velocity.
struct Fields {
  Second U[3], alpha, p;
};

/// The body force that makes (u, p) a solution of the model A equations, and the values at a point.
struct Manufactured {
  double density = 1, viscosity = 1;
  int dimension = 2;
  Fields (*fields)(const Second (&x)[4], int dimension);
  bool unsteady = true;  ///< du/dt is part of the equations

  struct Values {
    Vec3 velocity = Vec3::Zero(), force = Vec3::Zero();
    double alpha, alpha_rate, pressure, divergence;
  };
  Values at(const Vec3& place, double time) const {
    Second x[4];
    for (int d = 0; d < 4; ++d) {
      const double value = d < 3 ? place[d] : time;
      x[d] = Second::variable(First::variable(value, d), d);
    }
    const Fields f = fields(x, dimension);
    Second u[3];
    Values v;
    v.alpha = f.alpha.value.value;
    v.alpha_rate = f.alpha.derivative[3].value;
    v.pressure = f.p.value.value;
    v.divergence = v.alpha_rate;
    for (int i = 0; i < dimension; ++i) {
      u[i] = f.U[i] / f.alpha;
      v.velocity[i] = u[i].value.value;
      v.divergence += f.U[i].derivative[i].value;
    }
    for (int i = 0; i < dimension; ++i) {
      double acceleration = unsteady ? u[i].derivative[3].value : 0.0, viscous = 0;
      for (int j = 0; j < dimension; ++j) {
        acceleration += v.velocity[j] * u[i].derivative[j].value;
        First stress = f.alpha.value * (u[i].derivative[j] + u[j].derivative[i]);
        if (i == j)
          for (int k = 0; k < dimension; ++k) stress = stress - f.alpha.value * u[k].derivative[k] * (2.0 / 3);
        viscous += stress.derivative[j];
      }
      v.force[i] = v.alpha * density * acceleration - viscosity * viscous + v.alpha * f.p.derivative[i].value;
    }
    return v;
  }
};

/// alpha linear in space, so that its vertex values represent it exactly also for the quadratic velocity.
Fields space_fields(const Second (&x)[4], int dimension) {
  Fields f;
  f.alpha = 0.6 + 0.2 * x[0] * x[3];
  f.U[0] = sin(2.0 * x[0]) * cos(2.0 * x[1]) + x[1] - 0.1 * x[0] * x[0];
  f.U[1] = -(cos(2.0 * x[0]) * sin(2.0 * x[1]));
  if (dimension == 3) {
    f.U[0] += sin(x[2]);
    f.U[1] += x[0] * cos(x[2]);
    f.U[2] = sin(x[0] + x[1]);
  }
  f.p = sin(3.0 * x[0]) * cos(2.0 * x[1]);
  return f;
}
const char* space_velocity(int dimension) {
  return dimension == 2 ? "sin(2*x)*cos(2*y) + y - 0.1*x^2, -cos(2*x)*sin(2*y), 0"
                        : "sin(2*x)*cos(2*y) + y - 0.1*x^2 + sin(z), -cos(2*x)*sin(2*y) + x*cos(z), sin(x + y)";
}

/// Errors of velocity and pressure on n cells a side for the void fraction and its rate at t = 1.
std::pair<double, double> spatial_errors(const std::string& cell, const std::string& element, int n) {
  MonolithicCase flow(cell, {n, n, n}, element);
  flow.options.set("fluid_viscosity", "0.1");
  flow.options.set("fluid_density", "1.5");
  flow.options.set("fluid_ksp_rtol", "1e-7");
  const int dimension = flow.three() ? 3 : 2;
  flow.all_boundaries("type", "velocity");
  flow.all_boundaries("velocity", space_velocity(dimension));
  flow.start();
  const Manufactured exact{1.5, 0.1, dimension, space_fields, false};
  flow.fluid->set_body_force([&](const Vec3& x, double) { return exact.at(x, 1).force; });
  for (int i = 0; i < flow.mesh->nodes; ++i) {
    const auto v = exact.at(vec3(&flow.mesh->node_coordinates[3 * static_cast<size_t>(i)]), 1);
    REQUIRE(std::abs(v.divergence) < 1e-13);
    flow.fluid->load().void_fraction[i] = v.alpha;
    flow.fluid->load().void_fraction_rate[i] = v.alpha_rate;
  }
  // One step so long that only the steady terms remain.
  flow.fluid->advance(0, 1e8);
  PetscOptionsClearValue(nullptr, "-fluid_ksp_rtol");
  return flow.errors([&](const Vec3& x) { return exact.at(x, 1).velocity; },
                     [&](const Vec3& x) { return exact.at(x, 1).pressure; });
}

void check_spatial_order(const std::string& cell, const std::string& element, int n) {
  const auto [u1, p1] = spatial_errors(cell, element, n);
  const auto [u2, p2] = spatial_errors(cell, element, 2 * n);
  const double order = std::log2(u1 / u2), pressure_order = std::log2(p1 / p2);
  WARN(cell << " " << element << ": velocity " << u1 << " -> " << u2 << " order " << order << ", pressure " << p1
            << " -> " << p2 << " order " << pressure_order);
  CHECK(order > (element == "taylor_hood" ? 2.8 : 1.85));
  CHECK(pressure_order > (element == "taylor_hood" ? 1.8 : 1.2));
}

/// Fields that are exact in space (alpha uniform, u linear, p linear), so that only the time error is left.
Fields time_fields(const Second (&x)[4], int) {
  Fields f;
  const Second rate = 0.2 * cos(x[3]);
  f.alpha = 0.6 + 0.2 * sin(x[3]);
  f.U[0] = sin(2.0 * x[3]) * x[1] - rate * x[0];
  f.U[1] = cos(3.0 * x[3]) * x[0];
  f.p = x[0] * cos(x[3]);
  return f;
}

double temporal_error(const std::string& element, int steps, bool uneven) {
  MonolithicCase flow("triangle", {3, 3}, element);
  flow.options.set("fluid_viscosity", "0.05");
  flow.options.set("fluid_initial_velocity", "-0.3333333333333333*x, x/0.6, 0");
  flow.options.set("fluid_ksp_rtol", "1e-7");
  flow.all_boundaries("type", "velocity");
  flow.all_boundaries("velocity", "sin(2*t)*y - 0.2*cos(t)*x, cos(3*t)*x, 0");
  flow.start();
  const Manufactured exact{1, 0.05, 2, time_fields};
  flow.fluid->set_body_force([&](const Vec3& x, double t) { return exact.at(x, t).force; });
  double time = 0;
  for (int s = 0; s < steps; ++s) {
    const double dt = (uneven ? (s % 2 ? 1.4 : 0.6) : 1.0) / steps;
    const auto v = exact.at(Vec3::Zero(), time + dt);
    std::fill(flow.fluid->load().void_fraction.begin(), flow.fluid->load().void_fraction.end(), v.alpha);
    std::fill(flow.fluid->load().void_fraction_rate.begin(), flow.fluid->load().void_fraction_rate.end(), v.alpha_rate);
    flow.fluid->advance(time, dt);
    time += dt;
  }
  PetscOptionsClearValue(nullptr, "-fluid_ksp_rtol");
  return flow
      .errors([&](const Vec3& x) { return exact.at(x, time).velocity; },
              [&](const Vec3& x) { return exact.at(x, time).pressure; })
      .first;
}

}  // namespace

TEST_CASE("In 2D the velocity converges with order p + 1 where the void fraction varies in space and time",
          "[monolithic][convergence]") {
  const std::string element = GENERATE("equal_order", "taylor_hood");
  const std::string cell = GENERATE("triangle", "quadrilateral");
  check_spatial_order(cell, element, element == "equal_order" ? 16 : 8);
}

TEST_CASE("In 3D the velocity converges with order p + 1 where the void fraction varies in space and time",
          "[monolithic][convergence][slow]") {
  const std::string element = GENERATE("equal_order", "taylor_hood");
  const std::string cell = GENERATE("tetrahedron", "hexahedron");
  check_spatial_order(cell, element, element == "equal_order" ? 6 : 3);
}

TEST_CASE("The backward difference formula is of second order in time, also with uneven steps",
          "[monolithic][convergence]") {
  const std::string element = GENERATE("equal_order", "taylor_hood");
  const bool uneven = GENERATE(false, true);
  const double coarse = temporal_error(element, 16, uneven), fine = temporal_error(element, 32, uneven);
  WARN(element << (uneven ? " uneven" : " even") << ": " << coarse << " -> " << fine << " order "
               << std::log2(coarse / fine));
  CHECK(std::log2(coarse / fine) > 1.8);
}

TEST_CASE("Kovasznay flow at Reynolds 40 converges with order p + 1", "[monolithic][convergence]") {
  const std::string element = GENERATE("equal_order", "taylor_hood");
  const double l = 20 - std::sqrt(400 + 4 * M_PI * M_PI);
  const auto u = [l](const Vec3& x) {
    const double e = std::exp(l * x.x());
    return Vec3(1 - e * std::cos(2 * M_PI * x.y()), l / (2 * M_PI) * e * std::sin(2 * M_PI * x.y()), 0);
  };
  const auto p = [l](const Vec3& x) { return -0.5 * std::exp(2 * l * x.x()); };
  const auto solve = [&](int n) {
    MonolithicCase flow("triangle", {n, n}, element);
    flow.mesh_options.lower = Vec3(-0.5, -0.5, 0);
    flow.mesh_options.upper = Vec3(1, 0.5, 0);
    flow.options.set("fluid_viscosity", "0.025");
    flow.options.set("fluid_initial_velocity", "1, 0, 0");
    flow.all_boundaries("type", "velocity");
    char factor[40];
    std::snprintf(factor, sizeof factor, "%.17g", l);
    const std::string grow = "exp((" + std::string(factor) + ")*x)";
    flow.all_boundaries("velocity", "1 - " + grow + "*cos(6.283185307179586*y), (" + factor + ")/6.283185307179586*" +
                                        grow + "*sin(6.283185307179586*y), 0");
    flow.start();
    flow.fluid->advance(0, 1e8);
    return flow.errors(u, p);
  };
  const int n = element == "equal_order" ? 24 : 10;
  const auto coarse = solve(n), fine = solve(2 * n);
  WARN(element << " Kovasznay: " << coarse.first << " -> " << fine.first << " order "
               << std::log2(coarse.first / fine.first));
  CHECK(std::log2(coarse.first / fine.first) > (element == "equal_order" ? 1.85 : 2.8));
}
