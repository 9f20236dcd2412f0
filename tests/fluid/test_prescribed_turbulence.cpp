// Turbulence in a flow that is given by formulas (-fluid_type prescribed).
#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "flow_case.hpp"

using namespace silt;
using namespace silt::test;

namespace {

FlowCase::Settings stirred() {
  return {{"mesh_cell", "hexahedron"},
          {"mesh_cells", "3, 3, 3"},
          {"mesh_upper", "1, 1, 1"},
          {"mesh_periodic", "1, 1, 1"},
          {"fluid_type", "prescribed"},
          {"fluid_density", "1.5"},
          {"fluid_viscosity", "1e-4"},
          {"fluid_velocity", "1, 0, 0"},
          {"fluid_turbulence", "realizable_k_epsilon"},
          {"fluid_initial_turbulent_energy", "0.5"},
          {"fluid_initial_viscosity_ratio", "1000"}};
}

FlowCase::Settings channel() {
  return {{"mesh_cell", "quadrilateral"},
          {"mesh_cells", "4, 4"},
          {"mesh_upper", "1, 1, 0"},
          {"fluid_type", "prescribed"},
          {"fluid_density", "1"},
          {"fluid_viscosity", "1e-3"},
          {"fluid_velocity", "1, 0, 0"},
          {"fluid_turbulence", "sst_k_omega"},
          {"fluid_initial_turbulent_energy", "1"},
          {"boundary_x_min_type", "velocity"},
          {"boundary_x_max_type", "pressure"},
          {"boundary_y_min_type", "slip"},
          {"boundary_y_max_type", "slip"},
          {"boundary_x_min_turbulence_intensity", "0.05"},
          {"boundary_x_min_turbulence_length", "0.1"}};
}

std::string message(FlowCase::Settings settings) {
  try {
    FlowCase flow(settings);
  } catch (const UserError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a source of k and epsilon that makes up for their decay keeps the turbulence of a prescribed flow as it is",
          "[fluid][turbulence][mpi]") {
  auto settings = stirred();
  FlowCase decaying(settings);
  const double k = 0.5, epsilon = decaying.fluid->turbulent_dissipation()[0];
  CHECK(epsilon == Approx(1.5 * 0.09 * k * k / (1000 * 1e-4)).epsilon(1e-10));
  // rho epsilon and rho C2 epsilon^2/(k + sqrt(nu epsilon)) per volume of fluid are what decay takes; C1 S = 0.
  const double taken = 1.5 * epsilon, second = 1.5 * 1.9 * epsilon * epsilon / (k + std::sqrt(1e-4 / 1.5 * epsilon));
  settings.push_back({"fluid_turbulent_energy_source", std::to_string(taken)});
  settings.push_back({"fluid_turbulent_dissipation_source", std::to_string(second)});
  FlowCase kept(settings);
  for (int n = 0; n < 20; ++n) {
    decaying.advance(0.1);
    kept.advance(0.1);
  }
  for (int i = 0; i < kept.mesh->nodes; ++i) {
    CHECK(kept.fluid->turbulent_energy()[i] == Approx(k).epsilon(1e-5));
    CHECK(kept.fluid->turbulent_dissipation()[i] == Approx(epsilon).epsilon(1e-5));
    CHECK(decaying.fluid->turbulent_energy()[i] < 0.5 * k);
  }
}

TEST_CASE("the turbulence of a prescribed flow goes on from its saved state with the same bits",
          "[fluid][turbulence]") {
  FlowCase whole(channel()), first(channel()), second(channel());
  for (int n = 0; n < 8; ++n) whole.advance(0.05 + 0.01 * n);
  for (int n = 0; n < 5; ++n) first.advance(0.05 + 0.01 * n);
  const auto from = first.fluid->state();
  const auto to = second.fluid->state();
  REQUIRE(from.size() == to.size());
  for (size_t a = 0; a < from.size(); ++a) *to[a].values = *from[a].values;
  second.fluid->restored();
  second.time = first.time;
  for (int n = 5; n < 8; ++n) second.advance(0.05 + 0.01 * n);
  for (int i = 0; i < whole.mesh->nodes; ++i) {
    CHECK(second.fluid->turbulent_energy()[i] == whole.fluid->turbulent_energy()[i]);
    CHECK(second.fluid->turbulent_dissipation()[i] == whole.fluid->turbulent_dissipation()[i]);
  }
}

TEST_CASE("Kato & Launder's production is mu_t S W: that of strain in pure shear, none in a flow that does not turn",
          "[fluid][turbulence]") {
  struct Gradient {
    double strain, turn;  // u = (strain x + turn y, -strain y)
  };
  for (const std::string production : {"strain", "kato_launder"})
    for (const bool epsilon : {true, false})
      for (const Gradient g : {Gradient{0.6, 0}, Gradient{0, 0.8}, Gradient{0.6, 0.8}}) {  // SST: within its bound of P
        const double k = 0.5, nu = 1e-3, ratio = 200, dt = 0.05;
        const std::string strain = std::to_string(g.strain), turn = std::to_string(g.turn);
        FlowCase::Settings settings = {{"mesh_cell", "quadrilateral"},
                                       {"mesh_cells", "4, 4"},
                                       {"mesh_upper", "1, 1, 0"},
                                       {"fluid_type", "prescribed"},
                                       {"fluid_density", "1"},
                                       {"fluid_viscosity", "1e-3"},
                                       {"fluid_velocity", strain + "*x + " + turn + "*y, -" + strain + "*y, 0"},
                                       {"fluid_turbulence", epsilon ? "realizable_k_epsilon" : "sst_k_omega"},
                                       {"fluid_turbulence_production", production},
                                       {"fluid_initial_turbulent_energy", "0.5"},
                                       {"fluid_initial_viscosity_ratio", "200"}};
        for (const char* side : {"x_min", "x_max", "y_min", "y_max"})
          settings.push_back({std::string("boundary_") + side + "_type", "slip"});
        FlowCase flow(settings);
        flow.advance(dt);
        const double S = std::hypot(2 * g.strain, g.turn), W = g.turn;
        const double omega = k / (ratio * nu), eps = 0.09 * k * (epsilon ? k / (ratio * nu) : omega);
        const double A_s = std::sqrt(6.0) * std::cos(M_PI / 6);
        const double C_mu = 1 / (4.04 + A_s * std::hypot(S, W) / std::sqrt(2.0) * k / eps);
        const double nu_t = epsilon ? C_mu * k * k / eps : k / omega;  // no walls: F2 = 0
        const double P = nu_t * S * (production == "strain" ? S : W);
        // (k' - k)/dt = P - eps (2 k'/k - 1), with omega P - eps k'/k
        const double next = epsilon ? (k / dt + P + eps) / (1 / dt + 2 * eps / k) : (k / dt + P) / (1 / dt + eps / k);
        for (int i = 0; i < flow.mesh->nodes; ++i)
          CHECK(flow.fluid->turbulent_energy()[i] == Approx(next).epsilon(1e-8));
      }
}

TEST_CASE("what makes no sense with the turbulence of a prescribed flow is refused", "[fluid][turbulence]") {
  using Catch::Contains;
  const auto with = [](const std::string& name, const std::string& value) {
    auto settings = channel();
    settings.push_back({name, value});
    return message(settings);
  };
  CHECK(message(channel()) == "");
  CHECK_THAT(with("boundary_x_min_velocity", "1, 0, 0"), Contains("-boundary_x_min_velocity has no meaning"));
  CHECK_THAT(with("boundary_x_min_type", "mass_flow"), Contains("-boundary_x_min_type mass_flow has no meaning"));
  auto both = channel();
  both.push_back({"fluid_turbulent_energy", "1"});
  both.push_back({"fluid_turbulent_dissipation", "1"});
  CHECK_THAT(message(both), Contains("exclude each other"));
  auto none = channel();
  none[7].second = "none";
  none.erase(none.begin() + 8);
  CHECK_THAT(message(none), Contains("turbulence_intensity"));
  auto missing = channel();
  missing.erase(missing.begin() + 9);
  CHECK_THAT(message(missing), Contains("no condition on boundary x_min"));
}
