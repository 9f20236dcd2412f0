// Orders of convergence against manufactured and exact solutions.
#include <catch2/catch.hpp>

#include "base/nodal_matrix.hpp"
#include "flow_case.hpp"

using namespace silt;
using namespace silt::test;

namespace {

constexpr double pi = M_PI;

std::string cells_of(const std::string& cell, int n) {
  const std::string k = std::to_string(n);
  return cell == "quadrilateral" || cell == "triangle" ? k + ", " + k : k + ", " + k + ", " + std::to_string(3 * n / 8);
}

bool flat(const std::string& cell) { return cell == "quadrilateral" || cell == "triangle"; }

/// Decaying Taylor-Green vortex on a periodic unit box (tensor cells) or with its velocity given around one
/// (simplices): error of the velocity at t = 0.25.
double taylor_green(const std::string& cell, int n) {
  FlowCase::Settings settings = {{"mesh_cell", cell},
                                 {"mesh_upper", flat(cell) ? "1, 1, 0" : "1, 1, 0.375"},
                                 {"mesh_cells", cells_of(cell, n)},
                                 {"fluid_density", "2"},
                                 {"fluid_viscosity", "0.04"},
                                 {"fluid_initial_velocity", "sin(2*pi*x)*cos(2*pi*y), -cos(2*pi*x)*sin(2*pi*y), 0"},
                                 {"fluid_initial_pressure", "0.5*(cos(4*pi*x) + cos(4*pi*y))"}};
  if (cell == "quadrilateral" || cell == "hexahedron") {
    settings.push_back({"mesh_periodic", flat(cell) ? "1, 1" : "1, 1, 1"});
  } else {
    for (const char* name : {"x_min", "x_max", "y_min", "y_max"}) {
      settings.push_back({"boundary_" + std::string(name) + "_type", "velocity"});
      settings.push_back(
          {"boundary_" + std::string(name) + "_velocity",
           "exp(-8*pi^2*0.02*t)*sin(2*pi*x)*cos(2*pi*y), -exp(-8*pi^2*0.02*t)*cos(2*pi*x)*sin(2*pi*y), 0"});
    }
    if (!flat(cell))
      for (const char* name : {"z_min", "z_max"})
        settings.push_back({"boundary_" + std::string(name) + "_type", "slip"});
  }
  FlowCase flow(settings);
  const int steps = n;
  for (int k = 0; k < steps; ++k) flow.advance(0.25 / steps);
  const double decay = std::exp(-8 * pi * pi * 0.02 * flow.time);
  return flow.error(flow.fluid->velocity(), 3, [&](const Vec3& x) {
    return Vec3(decay * std::sin(2 * pi * x.x()) * std::cos(2 * pi * x.y()),
                -decay * std::cos(2 * pi * x.x()) * std::sin(2 * pi * x.y()), 0);
  });
}

/// A porous flow with drag whose void fraction varies in space and time; U = alpha u has the divergence -d(alpha)/dt.
struct PorousFlow {
  double viscosity = 0.05, drag = 3;
  bool model_a = true;
  static double S(const Vec3& x) { return std::sin(pi * x.x()) * std::sin(pi * x.y()); }
  static double alpha(const Vec3& x, double t) { return 0.7 + 0.2 * S(x) * std::cos(t); }
  static double rate(const Vec3& x, double t) { return -0.2 * S(x) * std::sin(t); }
  double beta(const Vec3& x, double t) const { return drag * (1 - alpha(x, t)); }
  static Vec3 flux(const Vec3& x, double t) {
    const double sx = std::sin(pi * x.x()), sy = std::sin(pi * x.y()), cx = std::cos(pi * x.x()),
                 cy = std::cos(pi * x.y());
    return {sx * cy * std::cos(2 * t) - 0.1 / pi * std::sin(t) * cx * sy,
            -cx * sy * std::cos(2 * t) - 0.1 / pi * std::sin(t) * sx * cy, 0};
  }
  static Vec3 velocity(const Vec3& x, double t) { return flux(x, t) / alpha(x, t); }
  static double pressure(const Vec3& x, double t) { return std::cos(pi * x.x()) * std::cos(pi * x.y()) * std::cos(t); }
  static constexpr double h = 1e-3;
  /// Fourth-order differences of a field.
  template <class F>
  static auto slope(F&& f) {
    const decltype(f(h)) result = (8.0 * (f(h) - f(-h)) - (f(2 * h) - f(-2 * h))) / (12 * h);
    return result;
  }
  static Mat3 gradient(const Vec3& x, double t) {  // (i, j) = d u_i / d x_j
    Mat3 g = Mat3::Zero();
    for (int j = 0; j < 2; ++j) g.col(j) = slope([&](double e) -> Vec3 { return velocity(x + e * Vec3::Unit(j), t); });
    return g;
  }
  Mat3 stress(const Vec3& x, double t) const {
    const Mat3 g = gradient(x, t);
    return alpha(x, t) * viscosity * (g + g.transpose() - 2.0 / 3 * g.trace() * Mat3::Identity());
  }
  /// Force per volume that makes it a solution for density 1, without the drag.
  Vec3 source(const Vec3& x, double t) const {
    Vec3 f =
        alpha(x, t) * (slope([&](double e) -> Vec3 { return velocity(x, t + e); }) + gradient(x, t) * velocity(x, t));
    for (int j = 0; j < 2; ++j) {
      f[j] += (model_a ? alpha(x, t) : 1.0) * slope([&](double e) { return pressure(x + e * Vec3::Unit(j), t); });
      f -= slope([&](double e) -> Vec3 { return stress(x + e * Vec3::Unit(j), t).col(j); });
    }
    f.z() = 0;
    return f + beta(x, t) * velocity(x, t);
  }
};

struct Errors {
  double velocity, pressure;
};

Errors porous(const std::string& cell, int n, bool model_a) {
  PorousFlow exact;
  exact.model_a = model_a;
  const std::string flux =
      "sin(pi*x)*cos(pi*y)*cos(2*t) - 0.1/pi*sin(t)*cos(pi*x)*sin(pi*y), "
      "-cos(pi*x)*sin(pi*y)*cos(2*t) - 0.1/pi*sin(t)*sin(pi*x)*cos(pi*y), 0";
  FlowCase::Settings settings = {{"mesh_cell", cell},
                                 {"mesh_lower", "0, 0, 0"},
                                 {"mesh_upper", flat(cell) ? "1, 1.25, 0" : "1, 1.25, 0.375"},
                                 {"mesh_cells", cells_of(cell, n)},
                                 {"fluid_density", "1"},
                                 {"fluid_viscosity", "0.05"},
                                 {"fluid_model", model_a ? "a" : "b"},
                                 {"fluid_initial_velocity",
                                  "sin(pi*x)*cos(pi*y)/(0.7 + 0.2*sin(pi*x)*sin(pi*y)), "
                                  "-cos(pi*x)*sin(pi*y)/(0.7 + 0.2*sin(pi*x)*sin(pi*y)), 0"},
                                 {"fluid_initial_pressure", "cos(pi*x)*cos(pi*y)"}};
  for (const char* name : {"x_min", "x_max", "y_min"}) {
    settings.push_back({"boundary_" + std::string(name) + "_type", "velocity"});
    settings.push_back({"boundary_" + std::string(name) + "_velocity", flux});
  }
  // The pressure is pinned on a boundary where the velocity is given too: only p and its increment need it.
  settings.push_back({"boundary_y_max_type", "velocity"});
  settings.push_back({"boundary_y_max_velocity", flux});
  if (!flat(cell))
    for (const char* name : {"z_min", "z_max"}) settings.push_back({"boundary_" + std::string(name) + "_type", "slip"});
  FlowCase flow(settings);
  const auto mass = lumped_mass(*flow.mesh);
  const int steps = n / 2;
  const double dt = 0.3 / steps;
  for (int k = 0; k < steps; ++k) {
    auto& load = flow.fluid->load();
    const double t = flow.time + dt;
    for (int i = 0; i < flow.mesh->nodes; ++i) {
      const Vec3 x = flow.position(i);
      load.void_fraction[i] = exact.alpha(x, t);
      load.void_fraction_rate[i] = exact.rate(x, t);
      load.response[i] = mass[i] * exact.beta(x, t);
      vec3(&load.force[3 * i]) =
          mass[i] * exact.source(x, t) - load.response[i] * vec3(flow.fluid->carrying_velocity().data() + 3 * i);
    }
    flow.advance(dt);
  }
  const auto p = flow.fluid->pressure();
  double shift = 0;  // a closed domain: the pressure is known up to a constant
  for (int i = 0; i < flow.mesh->owned_nodes; ++i)
    shift += mass[i] * (p[i] - exact.pressure(flow.position(i), flow.time));
  shift = mpi_sum(shift) / flow.mesh->volume;
  return {flow.error(flow.fluid->velocity(), 3, [&](const Vec3& x) { return exact.velocity(x, flow.time); }),
          flow.error(p, 1, [&](const Vec3& x) { return Vec3(exact.pressure(x, flow.time) + shift, 0, 0); })};
}

}  // namespace

TEST_CASE("The Taylor-Green vortex converges with order 2 on every cell", "[fluid][convergence]") {
  const std::string cell = GENERATE("quadrilateral", "triangle", "hexahedron", "tetrahedron");
  CAPTURE(cell);
  const int n = flat(cell) ? 16 : 8;
  const double coarse = taylor_green(cell, n), fine = taylor_green(cell, 2 * n);
  const double order = std::log2(coarse / fine);
  CAPTURE(coarse, fine);
  CHECK(order > 1.8);
}

TEST_CASE("A porous flow with moving void fraction and drag converges with order 2", "[fluid][convergence]") {
  const std::string cell = GENERATE("quadrilateral", "triangle", "hexahedron", "tetrahedron");
  const bool model_a = GENERATE(true, false);
  CAPTURE(cell, model_a);
  const int n = flat(cell) ? 16 : 8;
  const Errors coarse = porous(cell, n, model_a), fine = porous(cell, 2 * n, model_a);
  const double order = std::log2(coarse.velocity / fine.velocity);
  CAPTURE(coarse.velocity, fine.velocity);
  CHECK(order > 1.8);
  CHECK(std::log2(coarse.pressure / fine.pressure) > 1.5);
}
