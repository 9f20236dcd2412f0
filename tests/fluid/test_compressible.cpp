// Compressible flow of an ideal gas: consistency, exact solutions, orders.
#include <catch2/catch.hpp>
#include <random>

#include "gas_case.hpp"

using namespace silt;
using namespace silt::test;

namespace {

constexpr double pi = M_PI;

double mean_error(const FlowCase& flow, std::span<const double> field,
                  const std::function<double(const Vec3&)>& exact) {
  double sum = 0, count = 0;
  for (int i = 0; i < flow.mesh->owned_nodes; ++i, ++count)
    sum += std::abs(field[static_cast<size_t>(i)] - exact(flow.position(i)));
  return mpi_sum(sum) / mpi_sum(count);
}

/// Exact density of Sod's tube at time t after the diaphragm at x = 0.5 broke.
double sod(double x, double t) {
  const double xi = (x - 0.5) / t, c = std::sqrt(1.4);
  if (xi < -c) return 1;
  const double u = (c + xi) / 1.2;
  if (u < 0.927452620) return std::pow((c - 0.2 * u) / c, 5.0);
  if (xi < 0.927452620) return 0.426319428;
  return xi < 1.752155732 ? 0.265573712 : 0.125;
}

double sod_error(int cells) {
  auto settings = gas("quadrilateral", std::to_string(cells) + ", 1");
  set(settings, "x_min x_max y_min y_max", "type", "slip");
  settings[1].second = "1, " + std::to_string(1.0 / cells) + ", 0";
  settings.push_back({"fluid_initial_pressure", "x < 0.5 ? 1 : 0.1"});
  settings.push_back({"fluid_initial_temperature", "x < 0.5 ? 1 : 0.8"});
  FlowCase flow(settings);
  const int steps = cells;
  for (int k = 0; k < steps; ++k) flow.advance(0.2 / steps);
  for (double p : flow.fluid->pressure()) REQUIRE(p > 0.0999);
  return mean_error(flow, flow.fluid->scalars()[1].values, [](const Vec3& x) { return sod(x.x(), 0.2); });
}

/// A smooth steady solution of the viscous equations with sources.
struct Manufactured {
  double mu = 0.02, gamma = 1.4, prandtl = 0.71;
  bool three = false;
  static double p(const Vec3& x) { return 1 + 0.1 * std::sin(pi * x.x()) * std::cos(pi * x.y()); }
  /// 0 with its first derivatives on the boundary, where the viscous flux is of first order only.
  static double hump(const Vec3& x) { return std::pow(std::sin(pi * x.x()) * std::sin(pi * x.y()), 2); }
  static double T(const Vec3& x) { return 1 + 0.1 * hump(x); }
  static Vec3 u(const Vec3& x) { return {0.4 + 0.1 * hump(x), 0.2 - 0.1 * hump(x), 0}; }
  static constexpr double h = 2e-3;
  template <class F>
  static auto slope(F&& f) {
    const decltype(f(h)) result = (8.0 * (f(h) - f(-h)) - (f(2 * h) - f(-2 * h))) / (12 * h);
    return result;
  }
  using Five = Eigen::Matrix<double, 5, 1>;
  Five flux(const Vec3& x, int j) const {
    const double rho = p(x) / T(x), H = gamma / (gamma - 1) * p(x) + 0.5 * rho * u(x).squaredNorm();
    Mat3 g = Mat3::Zero();
    Vec3 gT = Vec3::Zero();
    for (int k = 0; k < 2; ++k) {
      g.col(k) = slope([&](double e) -> Vec3 { return u(x + e * Vec3::Unit(k)); });
      gT[k] = slope([&](double e) { return T(x + e * Vec3::Unit(k)); });
    }
    const Mat3 tau = mu * (g + g.transpose() - 2.0 / 3 * g.trace() * Mat3::Identity());
    Five F;
    F[0] = rho * u(x)[j];
    F.segment<3>(1) = rho * u(x)[j] * u(x) + p(x) * Vec3::Unit(j) - tau.col(j);
    F[4] = H * u(x)[j] - u(x).dot(tau.col(j)) - mu * gamma / (gamma - 1) / prandtl * gT[j];
    return F;
  }
  Five source(const Vec3& x) const {
    Five s = Five::Zero();
    for (int j = 0; j < 2; ++j) s += slope([&](double e) -> Five { return flux(x + e * Vec3::Unit(j), j); });
    return s;
  }
};

Vec3 manufactured(const std::string& cell, int n) {
  const std::string k = std::to_string(n);
  auto settings = gas(cell, flat(cell) ? k + ", " + k : k + ", " + k + ", 2");
  settings[1].second = flat(cell) ? "1, 1, 0" : "1, 1, " + std::to_string(2.0 / n);
  settings[5].second = "0.02";
  const std::string hump = "0.1*(sin(pi*x)*sin(pi*y))^2", p = "1 + 0.1*sin(pi*x)*cos(pi*y)";
  const std::string u = "0.4 + " + hump + ", 0.2 - " + hump + ", 0", T = "1 + " + hump;
  set(settings, "x_min x_max y_min y_max", "type", "far_field");
  set(settings, "x_min x_max y_min y_max", "pressure", p);
  set(settings, "x_min x_max y_min y_max", "velocity", u);
  set(settings, "x_min x_max y_min y_max", "temperature_value", T);
  if (!flat(cell)) set(settings, "z_min z_max", "type", "slip");
  settings.push_back({"fluid_initial_velocity", u});
  settings.push_back({"fluid_initial_pressure", p});
  settings.push_back({"fluid_initial_temperature", T});
  FlowCase flow(settings);
  const Manufactured exact;
  gas_of(flow).set_source([&](const Vec3& x, double, double& mass, Vec3& momentum, double& heat) {
    const auto s = exact.source(x);
    mass = s[0], momentum = s.segment<3>(1), heat = s[4] - momentum.dot(Manufactured::u(x));
  });
  for (int s = 0; s < 4; ++s) flow.advance(0.5);
  return {flow.error(flow.fluid->pressure(), 1, [](const Vec3& x) { return Vec3(Manufactured::p(x), 0, 0); }),
          flow.error(flow.fluid->velocity(), 3, Manufactured::u),
          flow.error(flow.fluid->temperature(), 1, [](const Vec3& x) { return Vec3(Manufactured::T(x), 0, 0); })};
}

double vortex_error(int n) {
  const std::string k = std::to_string(n);
  auto settings = gas("quadrilateral", k + ", " + k);
  settings[1].second = "10, 10, 0";
  settings.push_back({"mesh_periodic", "1, 1"});
  const std::string r2 = "((x-5)^2 + (y-5)^2)", b = "(3/(2*pi))";
  const std::string T = "(1 - 0.4*" + b + "^2/(2*1.4)*exp(1 - " + r2 + "))";
  settings.push_back({"fluid_initial_velocity",
                      "0.5 - " + b + "*exp(0.5*(1 - " + r2 + "))*(y-5), " + b + "*exp(0.5*(1 - " + r2 + "))*(x-5), 0"});
  settings.push_back({"fluid_initial_temperature", T});
  settings.push_back({"fluid_initial_pressure", T + "^3.5"});
  FlowCase flow(settings);
  const int steps = n / 2;
  for (int s = 0; s < steps; ++s) flow.advance(1.5 / steps);
  return flow.error(flow.fluid->scalars()[1].values, 1, [](const Vec3& x) {
    const double beta = 3 / (2 * pi), square = std::pow(x.x() - 5.75, 2) + std::pow(x.y() - 5, 2);
    return Vec3(std::pow(1 - 0.4 * beta * beta / 2.8 * std::exp(1 - square), 2.5), 0, 0);
  });
}

}  // namespace

TEST_CASE("the Jacobian is the derivative of the residual, for every cell, boundary and source",
          "[fluid][compressible]") {
  for (const std::string cell :
       {"triangle", "quadrilateral", "tetrahedron", "hexahedron", "axisymmetric", "turbulent"}) {
    const bool around = cell == "axisymmetric" || cell == "turbulent";
    const std::string kind = around ? "quadrilateral" : cell;
    auto settings = gas(kind, flat(kind) ? "3, 2" : "2, 2, 2");
    settings[5].second = "0.05";
    if (around) settings.push_back({"fluid_symmetry", "axisymmetric"});
    if (cell == "turbulent") {
      settings.push_back({"fluid_turbulence", "realizable_k_epsilon"});
      settings.push_back({"fluid_initial_turbulent_energy", "0.1"});
      set(settings, "x_min y_max", "turbulence_energy", "0.1");
      set(settings, "x_min y_max", "turbulence_viscosity_ratio", "3");
    }
    settings.push_back({"fluid_viscosity_law", "sutherland"});
    settings.push_back({"fluid_viscosity_temperature", "1"});
    settings.push_back({"fluid_sutherland_temperature", "0.4"});
    set(settings, "x_min", "type", "total_pressure");
    set(settings, "x_min", "pressure", "1.3");
    set(settings, "x_min", "temperature_value", "1.1");
    set(settings, "x_max", "type", "pressure");
    set(settings, "x_max", "pressure", "0.95");
    set(settings, "y_min", "type", around ? "slip" : "no_slip");
    if (!around) set(settings, "y_min", "velocity", "0.2, 0, 0");
    set(settings, "y_max", "type", "far_field");
    set(settings, "y_max", "velocity", "0.3, 0.1, 0");
    set(settings, "y_max", "pressure", "0.9");
    set(settings, "y_max", "temperature_value", "1.05");
    if (!flat(kind)) {
      set(settings, "z_min", "type", "mass_flow");
      set(settings, "z_min", "mass_flow", "0.2");
      set(settings, "z_min", "temperature_value", "1.2");
      set(settings, "z_max", "type", "no_slip");
      set(settings, "z_max", "temperature_type", "heat_transfer");
      set(settings, "z_max", "temperature_coefficient", "2");
      set(settings, "z_max", "temperature_value", "0.9");
    }
    settings.push_back({"fluid_initial_velocity", "0.3 + 0.1*y, 0.1*x, 0.05*x"});
    settings.push_back({"fluid_initial_pressure", "1 + 0.2*x*y"});
    settings.push_back({"fluid_initial_temperature", "1 + 0.1*y"});
    settings.push_back({"fluid_body_force", "0.3 + x, 0.2*y, -0.1"});
    settings.push_back({"fluid_heat_source", "0.4*x"});
    FlowCase flow(settings, Vec3(0.2, -0.3, 0));
    auto& load = flow.fluid->load();
    for (int i = 0; i < flow.mesh->nodes; ++i) {
      const Vec3 x = flow.position(i);
      load.void_fraction[i] = 0.7 + 0.2 * x.x() * x.y();
      load.void_fraction_rate[i] = 0.1 * x.x();
      load.response[i] = 0.1 + 0.1 * x.y();
      load.heat_response[i] = 0.2;
      vec3(&load.force[3 * static_cast<size_t>(i)]) = Vec3(0.01, 0.02 * x.x(), 0);
    }
    flow.advance(0.05);
    const Compressible& fluid = gas_of(flow);
    const GasSystem& system = fluid.system();
    const size_t m = system.size(), n = flow.mesh->nodes;
    std::mt19937 random(5);
    std::uniform_real_distribution<double> noise(-1, 1);
    GasStep step = fluid.last_step();
    for (double& v : step.frozen.normal) v = 0.1 * noise(random);  // as at shocks
    std::vector<double> at(n * m), up(n * m), down(n * m);
    for (size_t i = 0; i < n; ++i)
      for (size_t k = 0; k < m; ++k) {
        at[i * m + k] = (k == 0 || k == m - 1 ? 1 : 0.3) + 0.1 * noise(random);
        const double d = 1e-5 * noise(random);
        up[i * m + k] = at[i * m + k] + d;
        down[i * m + k] = at[i * m + k] - d;
      }
    for (auto* s : {&at, &up, &down}) system.impose(step, *s);
    const VecHandle x = system.create_vector(), a = system.create_vector(), b = system.create_vector(),
                    product = system.create_vector(), r = system.create_vector();
    system.to_vector(at, x), system.to_vector(up, a), system.to_vector(down, b);
    const MatHandle matrix = system.create_matrix();
    SILT_PETSC(system.jacobian(step, x, matrix));
    const VecHandle ra = system.create_vector(), rb = system.create_vector();
    SILT_PETSC(system.residual(step, a, ra));
    SILT_PETSC(system.residual(step, b, rb));
    SILT_PETSC(VecAXPY(ra, -1, rb));
    SILT_PETSC(VecAXPY(a, -1, b));
    SILT_PETSC(MatMult(matrix, a, product));
    PetscReal size, difference;
    SILT_PETSC(VecNorm(ra, NORM_2, &size));
    SILT_PETSC(VecAXPY(ra, -1, product));
    SILT_PETSC(VecNorm(ra, NORM_2, &difference));
    INFO(cell);
    CHECK(difference < 1e-7 * size);
  }
}

TEST_CASE("a uniform stream stays uniform, and Newton converges quadratically where it is disturbed",
          "[fluid][compressible][mpi]") {
  for (const std::string cell : {"triangle", "quadrilateral", "tetrahedron", "hexahedron", "axisymmetric"}) {
    const bool around = cell == "axisymmetric";
    const std::string kind = around ? "quadrilateral" : cell;
    auto settings = gas(kind, flat(kind) ? "4, 4" : "3, 3, 3");
    const std::string sides = flat(kind) ? "x_min x_max y_max y_min" : "x_min x_max y_max y_min z_min z_max";
    const std::string u = around ? "0.7, 0, 0" : flat(kind) ? "0.7, 0.4, 0" : "0.7, 0.4, 0.2";
    set(settings, sides, "type", "far_field");
    set(settings, sides, "pressure", "1");
    set(settings, sides, "velocity", u);
    set(settings, sides, "temperature_value", "0.9");
    settings[5].second = "0.01";
    if (around) settings.push_back({"fluid_symmetry", "axisymmetric"});
    settings.push_back({"fluid_initial_velocity", u});
    settings.push_back({"fluid_initial_pressure", "1"});
    settings.push_back({"fluid_initial_temperature", "0.9"});
    FlowCase flow(settings);
    flow.advance(0.1);
    INFO(cell);
    CHECK(mean_error(flow, flow.fluid->pressure(), [](const Vec3&) { return 1.0; }) < 1e-12);
    CHECK(mean_error(flow, flow.fluid->temperature(), [](const Vec3&) { return 0.9; }) < 1e-12);
    auto disturbed = settings;
    disturbed[disturbed.size() - 2] = {"fluid_initial_pressure", "1 + 0.3*exp(-20*((x-0.5)^2 + (y-0.5)^2))"};
    // The linear solves must not limit what an iteration gains.
    SILT_PETSC(PetscOptionsSetValue(nullptr, "-fluid_snes_rtol", "1e-9"));
    SILT_PETSC(PetscOptionsSetValue(nullptr, "-fluid_ksp_rtol", "1e-8"));
    FlowCase hit(disturbed);
    SILT_PETSC(PetscOptionsClearValue(nullptr, "-fluid_snes_rtol"));
    SILT_PETSC(PetscOptionsClearValue(nullptr, "-fluid_ksp_rtol"));
    hit.advance(0.2);
    const auto& norms = gas_of(hit).newton_norms();
    REQUIRE(norms.size() >= 3);
    CHECK(norms.back() < 1e-3 * norms[norms.size() - 2]);
  }
}

TEST_CASE("a smooth solution is found with order 2 for every cell", "[fluid][compressible]") {
  for (const char* cell : {"triangle", "quadrilateral", "tetrahedron", "hexahedron"}) {
    const int n = flat(cell) ? 20 : 8;
    const Vec3 coarse = manufactured(cell, n / 2), fine = manufactured(cell, n);
    const Vec3 order = (coarse.array() / fine.array()).log() / std::log(2.0);
    INFO(cell << ": p " << coarse[0] << " " << fine[0] << ", u " << coarse[1] << " " << fine[1] << ", T " << coarse[2]
              << " " << fine[2] << "; orders " << order.transpose());
    CHECK(order[1] > (flat(cell) ? 1.7 : 1.6));
    CHECK(order[2] > (flat(cell) ? 1.7 : 1.6));
    CHECK(order[0] > 1);
  }
}

TEST_CASE("Sod's tube: the error in density falls with an order above 0.6", "[fluid][compressible]") {
  const double coarse = sod_error(50), fine = sod_error(100);
  INFO(coarse << ", " << fine);
  CHECK(fine < 0.012);
  CHECK(std::log2(coarse / fine) > 0.6);
}

TEST_CASE("an isentropic vortex is carried along with order 2", "[fluid][compressible][slow]") {
  const double coarse = vortex_error(32), fine = vortex_error(64);
  INFO(coarse << ", " << fine);
  CHECK(std::log2(coarse / fine) > 1.8);
}

TEST_CASE("walls heat the gas between them by friction as in Couette flow", "[fluid][compressible]") {
  // Upper wall at speed 1, lower at rest and T = 1; the upper one adiabatic: T = 1 + Pr U^2/c_p (y - y^2/2).
  auto settings = gas("quadrilateral", "3, 16");
  settings.push_back({"mesh_periodic", "1, 0"});
  settings[5].second = "0.5";
  set(settings, "y_min y_max", "type", "no_slip");
  set(settings, "y_max", "velocity", "1, 0, 0");
  set(settings, "y_min", "temperature_type", "given");
  set(settings, "y_min", "temperature_value", "1");
  settings.push_back({"fluid_march", "steady"});
  settings.push_back({"fluid_order", "1"});
  settings.push_back({"fluid_initial_pressure", "1"});
  settings.push_back({"fluid_initial_temperature", "1"});
  FlowCase flow(settings);
  for (int k = 0; k < 30; ++k) flow.advance(0.1 * std::pow(1.4, k));
  const double rise = 0.71 / 3.5;
  for (double y : {0.25, 0.5, 1.0}) {
    CHECK(flow.value(flow.fluid->velocity(), 3, 0, Vec3(0, y, 0)) == Approx(y).epsilon(1e-3).margin(1e-6));
    CHECK(flow.value(flow.fluid->temperature(), 1, 0, Vec3(0, y, 0)) ==
          Approx(1 + rise * (y - y * y / 2)).epsilon(2e-4));
  }
  // The work of the wall leaves as heat below.
  const auto flows = flow.fluid->boundary_flow();
  double sum = 0, largest = 0;
  for (const auto& f : flows) sum += f.heat_flow, largest = std::max(largest, std::abs(f.heat_flow));
  CHECK(largest == Approx(0.5).epsilon(1e-3));
  CHECK(std::abs(sum) < 1e-6);
}

TEST_CASE("in a steady nozzle flow mass, momentum and energy leave as they enter", "[fluid][compressible][mpi]") {
  auto settings = gas("triangle", "12, 6");
  set(settings, "x_min", "type", "total_pressure");
  set(settings, "x_min", "pressure", "1");
  set(settings, "x_min", "temperature_value", "1");
  set(settings, "x_max", "type", "pressure");
  set(settings, "x_max", "pressure", "0.85");
  set(settings, "y_min y_max", "type", "slip");
  settings.push_back({"fluid_march", "steady"});
  settings.push_back({"fluid_order", "1"});
  settings.push_back({"fluid_initial_pressure", "0.85"});
  settings.push_back({"fluid_initial_temperature", "1"});
  FlowCase flow(settings);
  for (int k = 0; k < 25; ++k) flow.advance(0.1 * std::pow(1.6, k));
  double mass = 0, energy = 0, through = 0;
  Vec3 momentum = Vec3::Zero();
  for (const auto& f : flow.fluid->boundary_flow()) {
    mass += f.mass_flow, energy += f.heat_flow, momentum += f.force;
    through = std::max(through, f.mass_flow);
  }
  // Isentropic: M^2 = 5 (0.85^(-2/7) - 1).
  const double mach = std::sqrt(5 * (std::pow(0.85, -2.0 / 7) - 1)), T = std::pow(0.85, 2.0 / 7);
  CHECK(through == Approx(0.85 / T * mach * std::sqrt(1.4 * T)).epsilon(1e-5));
  CHECK(std::abs(mass) < 1e-7 * through);
  CHECK(std::abs(energy) < 1e-6 * through);
  CHECK(momentum.norm() < 1e-6);
}

TEST_CASE("a force speeds the gas up and a source of heat warms it; the work and the heat are what its energy gains",
          "[fluid][compressible][mpi]") {
  auto settings = gas("hexahedron", "3, 3, 3");
  settings.push_back({"mesh_periodic", "1, 1, 1"});
  settings.push_back({"fluid_order", "1"});
  settings.push_back({"fluid_initial_pressure", "1.2"});
  settings.push_back({"fluid_initial_temperature", "0.8"});
  settings.push_back({"fluid_body_force", "0.3, 0, 0.6*t"});
  settings.push_back({"fluid_heat_source", "0.5 + t"});
  FlowCase flow(settings);
  const double density = 1.2 / 0.8, capacity = 1 / 0.4, dt = 0.01;
  double energy = density * capacity * 0.8;
  for (int k = 0; k < 40; ++k) {
    const FluidStep step = flow.advance(dt);
    CHECK(step.heat - energy == Approx(dt * step.energy_supply).epsilon(1e-9));
    energy = step.heat;
  }
  const double t = 0.4;
  for (int i = 0; i < flow.mesh->nodes; ++i) {
    const double* u = &flow.fluid->velocity()[3 * static_cast<size_t>(i)];
    CHECK(u[0] == Approx(0.3 * t / density).epsilon(1e-8));
    CHECK(u[2] == Approx(0.3 * t * (t + dt) / density).epsilon(1e-8));  // the sum of backward Euler
    CHECK(flow.fluid->temperature()[static_cast<size_t>(i)] ==
          Approx(0.8 + (0.5 * t + 0.5 * t * t) / (density * capacity)).epsilon(2e-3));
  }
}

TEST_CASE("options that do not belong to compressible flow are refused", "[fluid][compressible]") {
  auto settings = gas("quadrilateral", "3, 3");
  set(settings, "x_min x_max y_min y_max", "type", "slip");
  CHECK_THROWS_WITH(FlowCase(settings), Catch::Contains("-fluid_initial_pressure is missing"));
  settings.push_back({"fluid_initial_pressure", "1"});
  settings.push_back({"fluid_initial_temperature", "0"});
  CHECK_THROWS_WITH(FlowCase(settings), Catch::Contains("must be above 0"));
  settings.back().second = "1";
  settings.push_back({"fluid_density", "1"});
  CHECK_THROWS_WITH(FlowCase(settings), Catch::Contains("-fluid_density has no meaning"));
  settings.back() = {"fluid_scheme", "pressure_correction"};
  CHECK_THROWS_WITH(FlowCase(settings), Catch::Contains("-fluid_scheme pressure_correction is not available"));
  settings.back() = {"boundary_x_min_type", "far_field"};
  CHECK_THROWS_WITH(FlowCase(settings), Catch::Contains("-boundary_x_min_pressure is missing"));
  FlowCase::Settings water = {
      {"mesh_cell", "quadrilateral"}, {"mesh_cells", "3, 3"}, {"fluid_density", "1"}, {"fluid_viscosity", "1"}};
  set(water, "x_max y_min y_max", "type", "slip");
  set(water, "x_min", "type", "far_field");
  CHECK_THROWS_WITH(FlowCase(water), Catch::Contains("needs -fluid_type compressible"));
}
