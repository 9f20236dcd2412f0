// k-epsilon and k-omega in compressible flow: what they take from the gas and give back, dilatation, walls.
#include <catch2/catch.hpp>
#include <random>

#include "base/error.hpp"
#include "fluid/turbulence/dilatation_dissipation.hpp"
#include "fluid/turbulence/turbulence.hpp"
#include "gas_case.hpp"

using namespace silt;
using namespace silt::test;

namespace {

constexpr double pi = M_PI;

/// Solves so far that what is left counts as round-off.
struct Tight {
  const std::vector<std::pair<const char*, const char*>> options = {
      {"-fluid_snes_rtol", "1e-12"}, {"-fluid_ksp_rtol", "1e-10"}, {"-fluid_turbulent_energy_ksp_rtol", "1e-13"}};
  Tight() {
    for (const auto& [name, value] : options) SILT_PETSC(PetscOptionsSetValue(nullptr, name, value));
  }
  ~Tight() {
    for (const auto& option : options) PetscOptionsClearValue(nullptr, option.first);
  }
};

double sum_over(const FlowCase& flow, const std::function<double(size_t)>& value, bool around = false) {
  const auto& weights = gas_of(const_cast<FlowCase&>(flow)).system().weights();
  double sum = 0;
  for (int i = 0; i < flow.mesh->owned_nodes; ++i) sum += weights[i] * value(static_cast<size_t>(i));
  return mpi_sum(sum) * (around ? 2 * pi : 1);
}

double turbulent_energy(const FlowCase& flow, bool around = false) {
  const auto rho = flow.fluid->scalars()[1].values, k = flow.fluid->turbulent_energy();
  return sum_over(
      flow, [&](size_t i) { return rho[i] * k[i]; }, around);
}

}  // namespace

TEST_CASE("what decaying turbulence loses heats the gas: total energy is kept to round-off",
          "[fluid][compressible][turbulence][mpi]") {
  for (const std::string model : {"realizable_k_epsilon", "sst_k_omega"})
    for (const std::string cell : {"triangle", "axisymmetric"}) {
      const bool around = cell == "axisymmetric", epsilon = model != "sst_k_omega";
      auto settings = gas(around ? "quadrilateral" : cell, "3, 3");
      settings[5].second = "1e-9";
      set(settings, "x_min x_max y_min y_max", "type", "slip");
      if (around) settings.push_back({"fluid_symmetry", "axisymmetric"});
      settings.push_back({"fluid_order", "1"});
      settings.push_back({"fluid_turbulence", model});
      settings.push_back({"fluid_turbulence_largest_ratio", "1e20"});
      settings.push_back({"fluid_initial_pressure", "1"});
      settings.push_back({"fluid_initial_temperature", "1"});
      settings.push_back({"fluid_initial_turbulent_energy", "0.2"});
      // epsilon = 0.3, omega = 5
      settings.push_back({"fluid_initial_viscosity_ratio", epsilon ? "0.09*0.04/0.3/1e-9" : "0.04/1e-9"});
      const Tight tight;
      FlowCase flow(settings);
      const double before = 2.5 * sum_over(
                                      flow, [](size_t) { return 1; }, around) +
                            turbulent_energy(flow, around);
      const int steps = 200;
      double gas_energy = 0;
      for (int s = 0; s < steps; ++s) {
        const FluidStep step = flow.advance(2.0 / steps);
        if (s > 0) {
          CHECK(step.heat - gas_energy == Approx(step.energy_supply * 2.0 / steps).epsilon(1e-9));
        }
        gas_energy = step.heat;
      }
      INFO(model << " " << cell);
      // Newton leaves up to 1e-11 in each of the steps.
      CHECK(gas_energy + turbulent_energy(flow, around) == Approx(before).epsilon(1e-11 * steps));
      const double k = flow.fluid->turbulent_energy()[0], start = 2.0 / 3;
      const double exact =
          epsilon ? 0.2 * std::pow(1 + 0.9 * 2 / start, -1 / 0.9) : 0.2 * std::pow(1 + 0.0828 * 5 * 2, -0.09 / 0.0828);
      CHECK(k == Approx(exact).epsilon(0.02));
      CHECK(flow.fluid->temperature()[0] == Approx(1 + (0.2 - k) / 2.5).epsilon(1e-4));
    }
}

TEST_CASE("the dilatation dissipation is that of Sarkar, Zeman and Wilcox", "[fluid][turbulence]") {
  const auto at = [](const char* law, double mach) {  // c = 300 m/s, k = (M_t c)^2/2
    return DilatationDissipation(law).ratio(0.5 * mach * mach * 9e4, 300, 1.4);
  };
  for (const double mach : {0.0, 0.05, 0.3, 0.7}) {
    CAPTURE(mach);
    CHECK(at("none", mach) == 0);
    CHECK(at("sarkar", mach) == Approx(mach * mach));
    CHECK(at("wilcox", mach) == Approx(mach > 0.25 ? 1.5 * (mach * mach - 0.0625) : 0.0));
    const double over = mach - 0.0912870929;  // 0.1 sqrt(2/2.4)
    CHECK(at("zeman", mach) == Approx(over > 0 ? 0.75 * (1 - std::exp(-1.2 * over * over / 0.36)) : 0.0));
  }
}

TEST_CASE("turbulence that decays with dilatation dissipation follows its equations and heats the gas by what it loses",
          "[fluid][compressible][turbulence][mpi]") {
  for (const std::string model : {"realizable_k_epsilon", "sst_k_omega"}) {
    const bool epsilon = model != "sst_k_omega";
    auto settings = gas("quadrilateral", "3, 3");
    settings[5].second = "1e-9";
    set(settings, "x_min x_max y_min y_max", "type", "slip");
    for (const auto& [name, value] :
         FlowCase::Settings{{"order", "1"},
                            {"turbulence", model},
                            {"compressibility_correction", "sarkar"},
                            {"turbulence_largest_ratio", "1e20"},
                            {"initial_pressure", "1"},
                            {"initial_temperature", "1"},
                            {"initial_turbulent_energy", "0.2"},
                            {"initial_viscosity_ratio", epsilon ? "0.09*0.04/0.3/1e-9" : "0.04/1e-9"}})
      settings.push_back({"fluid_" + name, value});
    const Tight tight;
    FlowCase flow(settings);
    const double before = 2.5 * sum_over(flow, [](size_t) { return 1; }) + turbulent_energy(flow);
    // k' = -epsilon (1 + M_t^2), M_t^2 = 2 k/(1.4 T), 2.5 T + k constant; epsilon' = -1.9 epsilon^2/k, and for
    // omega = epsilon/(0.09 k): omega' = -0.0828 omega^2 + 0.09 M_t^2 omega^2. By the midpoint rule.
    double k = 0.2, second = epsilon ? 0.3 : 5;
    const auto slope = [&](double k1, double s) {
      const double mach2 = 2 * k1 / (1.4 * (1 + (0.2 - k1) / 2.5));
      return epsilon ? std::pair{-s * (1 + mach2), -1.9 * s * s / k1}
                     : std::pair{-0.09 * k1 * s * (1 + mach2), (-0.0828 + 0.09 * mach2) * s * s};
    };
    const int steps = 800;
    for (int i = 0; i < 20000; ++i) {
      const double h = 2.0 / 20000;
      const auto [dk, ds] = slope(k, second);
      const auto [mk, ms] = slope(k + 0.5 * h * dk, second + 0.5 * h * ds);
      k += h * mk, second += h * ms;
    }
    for (int i = 0; i < steps; ++i) flow.advance(2.0 / steps);
    INFO(model);
    CHECK(flow.fluid->turbulent_energy()[0] == Approx(k).epsilon(0.005));
    CHECK(flow.fluid->temperature()[0] == Approx(1 + (0.2 - k) / 2.5).epsilon(1e-3));
    const double after =
        2.5 * sum_over(flow, [&](size_t i) { return flow.fluid->pressure()[i]; }) + turbulent_energy(flow);
    CHECK(after == Approx(before).epsilon(1e-11 * steps));
  }
}

TEST_CASE("a compressibility correction needs the speed of sound and a model with k", "[fluid][turbulence]") {
  const auto start = [](const char* type, const char* model) {
    FlowCase::Settings settings = {{"mesh_cell", "quadrilateral"},
                                   {"mesh_cells", "3, 3"},
                                   {"fluid_type", type},
                                   {"fluid_density", "1"},
                                   {"fluid_viscosity", "1"},
                                   {"fluid_turbulence", model},
                                   {"fluid_compressibility_correction", "sarkar"},
                                   {"fluid_initial_turbulent_energy", "1"}};
    set(settings, "x_min x_max y_min y_max", "type", "slip");
    FlowCase flow(settings);
  };
  CHECK_THROWS_WITH(start("incompressible", "sst_k_omega"), Catch::Contains("needs -fluid_type compressible"));
  CHECK_THROWS_WITH(start("incompressible", "wale"), Catch::Contains("has no meaning with -fluid_turbulence wale"));
}

TEST_CASE("an isotropic compression or expansion changes k as the density to 2/3, in space and around an axis",
          "[fluid][compressible][turbulence][mpi]") {
  for (const std::string cell : {"hexahedron", "axisymmetric"})
    for (const double rate : {1.0, -1.0}) {
      Options options;
      MeshOptions box;
      box.cell = cell == "axisymmetric" ? "quadrilateral" : cell;
      box.cells = {3, 3, 3};
      if (cell == "axisymmetric") box.upper = Vec3(1, 1, 0);
      const Mesh mesh(box);
      for (const auto& name : mesh.boundaries) options.set("boundary_" + name + "_type", "slip");
      options.set("fluid_turbulence", "realizable_k_epsilon");
      options.set("fluid_initial_turbulent_energy", "2");
      options.set("fluid_initial_viscosity_ratio", "1e6");
      options.set("fluid_turbulence_largest_ratio", "1e20");
      const BoundaryConditions boundaries(mesh, options, 1, true);
      const auto turbulence = Turbulence::create(mesh, options, boundaries, cell == "axisymmetric");
      // u = -a x/(1 - a t): uniform density rho = (1 - a t)^-3. mu_t/mu = 1e6 makes the decay negligible.
      const size_t n = mesh.nodes;
      std::vector<double> velocity(3 * n), density(n, 1.0), viscosity(n, 1.0), alpha(n, 1.0);
      const Turbulence::Flow flow{velocity, density, viscosity, alpha, {}, true};
      const int steps = 400;
      const double end = 0.5, dt = end / steps;
      turbulence->start(flow);
      for (int s = 0; s < steps; ++s) {
        const double t = (s + 0.5) * dt;  // the rate at the middle of the step
        for (size_t i = 0; i < n; ++i)
          for (int d = 0; d < mesh.dimension; ++d)
            velocity[3 * i + static_cast<size_t>(d)] =
                -rate / (1 - rate * t) * mesh.node_coordinates[3 * i + static_cast<size_t>(d)];
        density.assign(n, std::pow(1 - rate * t, -3));
        turbulence->solve(s * dt, Bdf::first(dt), dt, flow);
        turbulence->accept();
      }
      const double exact = 2 * std::pow(1 - rate * end, -2);
      double least = 1e300, most = 0;
      for (const double k : turbulence->energy()) least = std::min(least, k), most = std::max(most, k);
      INFO(cell << " " << rate);
      CHECK(mpi_min(least) == Approx(exact).epsilon(0.005));
      CHECK(mpi_max(most) == Approx(exact).epsilon(0.005));
    }
}

TEST_CASE(
    "an eddy viscosity acts in momentum and energy as the same viscosity of the gas, inside and on open boundaries",
    "[fluid][compressible][turbulence]") {
  for (const std::string cell : {"triangle", "axisymmetric", "hexahedron"}) {
    const bool around = cell == "axisymmetric";
    const std::string kind = around ? "quadrilateral" : cell;
    auto settings = gas(kind, flat(kind) ? "3, 2" : "2, 2, 2");
    settings[5].second = "0.05";
    if (around) settings.push_back({"fluid_symmetry", "axisymmetric"});
    set(settings, flat(kind) ? "x_min x_max" : "x_min x_max z_min z_max", "type", "pressure");
    set(settings, flat(kind) ? "x_min x_max" : "x_min x_max z_min z_max", "pressure", "1");
    set(settings, "y_min", "type", "slip");
    set(settings, "y_max", "type", "no_slip");
    settings.push_back({"fluid_initial_velocity", "0.3 + 0.1*y, 0.1*x, 0.05*x"});
    settings.push_back({"fluid_initial_pressure", "1 + 0.2*x*y"});
    settings.push_back({"fluid_initial_temperature", "1 + 0.1*y"});
    FlowCase flow(settings);
    flow.advance(0.05);
    const GasSystem& system = gas_of(flow).system();
    GasStep molecular = gas_of(flow).last_step(), turbulent = molecular;
    molecular.law.viscosity *= 3;
    turbulent.eddy_viscosity.assign(flow.mesh->cells, 2 * turbulent.law.viscosity);
    turbulent.eddy_conductivity.assign(flow.mesh->cells,
                                       2 * turbulent.law.viscosity * turbulent.law.cp() / turbulent.law.prandtl);
    const size_t m = system.size(), n = flow.mesh->nodes;
    std::mt19937 random(5);
    std::uniform_real_distribution<double> noise(-1, 1);
    std::vector<double> at(n * m);
    for (size_t i = 0; i < n; ++i)
      for (size_t k = 0; k < m; ++k) at[i * m + k] = (k == 0 || k == m - 1 ? 1 : 0.3) + 0.1 * noise(random);
    system.impose(molecular, at);
    const VecHandle x = system.create_vector(), a = system.create_vector(), b = system.create_vector();
    system.to_vector(at, x);
    SILT_PETSC(system.residual(molecular, x, a));
    SILT_PETSC(system.residual(turbulent, x, b));
    PetscReal size, difference;
    SILT_PETSC(VecNorm(a, NORM_2, &size));
    SILT_PETSC(VecAXPY(b, -1, a));
    SILT_PETSC(VecNorm(b, NORM_2, &difference));
    INFO(cell);
    CHECK(difference < 1e-13 * size);
  }
}

TEST_CASE("turbulence in a shear flow takes from the gas what the ledger says, and k and epsilon stay positive",
          "[fluid][compressible][turbulence][mpi]") {
  for (const std::string model : {"realizable_k_epsilon", "sst_k_omega"}) {
    auto settings = gas("quadrilateral", "8, 16");
    settings[5].second = "1e-4";
    settings.push_back({"mesh_periodic", "1, 1"});
    settings.push_back({"fluid_order", "1"});
    settings.push_back({"fluid_turbulence", model});
    settings.push_back({"fluid_initial_velocity", "0.5*sin(2*pi*y), 0.1*sin(2*pi*x), 0"});
    settings.push_back({"fluid_initial_pressure", "1"});
    settings.push_back({"fluid_initial_temperature", "1"});
    settings.push_back({"fluid_initial_turbulent_energy", "1e-3"});
    const Tight tight;
    FlowCase flow(settings);
    double energy = flow.advance(0.02).heat, least = 1, k = 0;
    for (int s = 0; s < 30; ++s) {
      const FluidStep step = flow.advance(0.05);
      CHECK(std::abs(step.heat - energy - 0.05 * step.energy_supply) < 1e-11 * energy);
      energy = step.heat;
      for (const auto field : {flow.fluid->turbulent_energy(), flow.fluid->turbulent_dissipation()})
        for (const double value : field) least = std::min(least, value);
    }
    for (const double value : flow.fluid->turbulent_energy()) k = std::max(k, value);
    INFO(model);
    CHECK(mpi_min(least) >= 0);
    CHECK(mpi_max(k) > 2e-3);  // the shear makes turbulence
  }
}

TEST_CASE("k-epsilon with wall functions gives the law of the wall in a gas", "[fluid][compressible][turbulence]") {
  // Lower half of a channel at Re_tau = 2000, Mach number 0.05; gravity drives it.
  FlowCase flow({{"mesh_cell", "quadrilateral"},
                 {"mesh_upper", "0.3, 1, 0"},
                 {"mesh_cells", "3, 20"},
                 {"mesh_periodic", "1, 0, 0"},
                 {"fluid_type", "compressible"},
                 {"fluid_gas_constant", "1"},
                 {"fluid_viscosity", "5e-4"},
                 {"fluid_march", "steady"},
                 {"fluid_order", "1"},
                 {"fluid_initial_velocity", "22, 0, 0"},
                 {"fluid_initial_pressure", "1.6e5"},
                 {"fluid_initial_temperature", "1.6e5"},
                 {"fluid_turbulence", "realizable_k_epsilon"},
                 {"fluid_initial_turbulent_energy", "3"},
                 {"fluid_initial_viscosity_ratio", "100"},
                 {"boundary_y_min_type", "no_slip"},
                 {"boundary_y_min_temperature_type", "given"},
                 {"boundary_y_min_temperature_value", "1.6e5"},
                 {"boundary_y_max_type", "symmetry"}},
                Vec3(1, 0, 0));
  for (int k = 0; k < 400; ++k) flow.advance(0.25);
  double shear = 0;
  for (const auto& boundary : flow.fluid->boundary_flow()) shear = std::max(shear, boundary.force.x());
  CHECK(shear == Approx(0.3).epsilon(2e-3));
  for (const double y : {0.05, 0.1, 0.2})
    CHECK(flow.value(flow.fluid->velocity(), 3, 0, Vec3(0.1, y, 0)) ==
          Approx(std::log(2000 * y) / 0.41 + 5.2).epsilon(0.03));
}

TEST_CASE("turbulence that does not fit the gas is refused", "[fluid][compressible][turbulence]") {
  auto base = gas("quadrilateral", "3, 3");
  set(base, "x_min y_min y_max", "type", "slip");
  set(base, "x_max", "type", "far_field");
  set(base, "x_max", "pressure", "1");
  set(base, "x_max", "temperature_value", "1");
  base.push_back({"fluid_initial_pressure", "1"});
  base.push_back({"fluid_initial_temperature", "1"});
  const auto message = [&](FlowCase::Settings more) -> std::string {
    auto settings = base;
    settings.insert(settings.end(), more.begin(), more.end());
    try {
      FlowCase flow(settings);
    } catch (const UserError& error) {
      return error.what();
    }
    return "";
  };
  using Catch::Contains;
  CHECK_THAT(message({{"fluid_turbulence", "wale"}, {"fluid_symmetry", "axisymmetric"}}), Contains("eddies in space"));
  CHECK_THAT(message({{"fluid_turbulence", "wale"}}), Contains("-fluid_viscosity above 0"));
  base[5].second = "1e-3";
  CHECK_THAT(message({{"fluid_turbulence", "realizable_k_epsilon"}}),
             Contains("boundary x_max") && Contains("turbulence_intensity"));
  set(base, "x_max", "turbulence_energy", "1");
  set(base, "x_max", "turbulence_viscosity_ratio", "1");
  CHECK_THAT(message({{"fluid_turbulence", "realizable_k_epsilon"}}),
             Contains("-fluid_initial_turbulent_energy is missing"));
  CHECK(message({{"fluid_turbulence", "realizable_k_epsilon"}, {"fluid_initial_turbulent_energy", "1"}}) == "");
}
