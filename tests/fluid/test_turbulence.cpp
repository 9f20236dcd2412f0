// Wall distance and the transport of the turbulent quantities in a flow that is given.
#include <array>
#include <catch2/catch.hpp>
#include <tuple>

#include "base/error.hpp"
#include "base/nodal_matrix.hpp"
#include "flow_case.hpp"
#include "fluid/turbulence/realizable_k_epsilon.hpp"
#include "fluid/turbulence/sst_k_omega.hpp"
#include "fluid/turbulence/turbulence.hpp"
#include "fluid/turbulence/wall_distance.hpp"

using namespace silt;
using namespace silt::test;

namespace {

constexpr double pi = M_PI;

Mesh box(const std::string& cell, std::vector<int> cells, const Vec3& upper, std::vector<int> periodic = {0, 0, 0}) {
  MeshOptions options;
  options.cell = cell, options.cells = cells, options.upper = upper, options.periodic = periodic;
  return Mesh(options);
}

/// A flow at the nodes and its turbulence, without a scheme.
struct Given {
  Options options;
  std::unique_ptr<Mesh> mesh;
  std::unique_ptr<BoundaryConditions> boundaries;
  std::unique_ptr<Turbulence> turbulence;
  std::vector<double> velocity, density, viscosity, void_fraction;
  double time = 0;

  Given(const std::string& cell, int n, const std::vector<std::pair<std::string, std::string>>& settings, double rho,
        double mu) {
    for (const auto& [name, value] : settings) options.set(name, value);
    const bool flat = cell == "quadrilateral" || cell == "triangle";
    mesh = std::make_unique<Mesh>(box(cell, {n, n, n / 2}, flat ? Vec3(1, 1, 0) : Vec3(1, 1, 0.5)));
    for (const auto& name : mesh->boundaries) {
      if (!options.given("boundary_" + name + "_type")) options.set("boundary_" + name + "_type", "velocity");
      if (options.find("boundary_" + name + "_type") == "velocity") {
        options.set("boundary_" + name + "_velocity", "1, 0, 0");
        for (const char* property : {"energy", "viscosity_ratio"})
          if (auto text = options.find(std::string("inflow_") + property))
            options.set("boundary_" + name + "_turbulence_" + property, *text);
      }
    }
    boundaries = std::make_unique<BoundaryConditions>(*mesh, options, rho);
    turbulence = Turbulence::create(*mesh, options, *boundaries);
    velocity.assign(3 * mesh->nodes, 0.0);
    density.assign(mesh->nodes, rho), viscosity.assign(mesh->nodes, mu), void_fraction.assign(mesh->nodes, 1.0);
  }
  Vec3 position(int i) const { return vec3(&mesh->node_coordinates[3 * i]); }
  Turbulence::Flow flow() const { return {velocity, density, viscosity, void_fraction}; }
  void advance(double dt) {
    turbulence->solve(time, Bdf::first(dt), dt, flow());
    turbulence->accept();
    time += dt;
  }
};

// The manufactured fields: plane flow without divergence, k and epsilon or omega smooth and positive.
constexpr double rho = 1.3, mu = 0.02;
Vec3 wind(const Vec3& x) { return {1 + 0.5 * std::sin(pi * x.y()), 0.6 + 0.4 * std::cos(pi * x.x()), 0}; }
double exact_k(const Vec3& x) { return 0.5 + 0.2 * std::sin(pi * x.x()) * std::cos(pi * x.y()); }
double exact_second(const Vec3& x) { return 0.8 + 0.2 * std::cos(pi * x.x()) * std::sin(pi * x.y()); }
const char* text_k = "(0.5 + 0.2*sin(pi*x)*cos(pi*y))";
const char* text_second = "(0.8 + 0.2*cos(pi*x)*sin(pi*y))";

template <class F>
Vec3 slope(F f, const Vec3& x) {
  Vec3 result = Vec3::Zero();
  const double h = 1e-3;
  for (int d = 0; d < 2; ++d) {
    const Vec3 e = h * Vec3::Unit(d);
    result[d] = (8 * (f(x + e) - f(x - e)) - (f(x + 2 * e) - f(x - 2 * e))) / (12 * h);
  }
  return result;
}

template <class Model>
TurbulentPoint exact_point(const Vec3& x) {
  Mat3 gradient = Mat3::Zero();
  for (int i = 0; i < 2; ++i) gradient.row(i) = slope([&](const Vec3& y) { return wind(y)[i]; }, x);
  TurbulentPoint p{rho, mu, exact_k(x), exact_second(x), infinity, 0, 0, strain(gradient)};
  p.cross = slope(exact_k, x).dot(slope(exact_second, x));
  p.production = Model::eddy_viscosity(p) * p.strain.shear * p.strain.shear;
  return p;
}

/// rho u.grad phi - div(Gamma grad phi) - production + destruction phi of k (true) or the second quantity.
template <class Model>
double exact_source(const Vec3& x, bool k) {
  const auto phi = [k](const Vec3& y) { return k ? exact_k(y) : exact_second(y); };
  const auto terms = [](const Vec3& y) {
    const auto p = exact_point<Model>(y);
    return Model::terms(p, Model::eddy_viscosity(p));
  };
  double divergence = 0;
  const double h = 1e-3;
  for (int d = 0; d < 2; ++d) {
    const auto flux = [&](const Vec3& y) {
      const auto t = terms(y);
      return (k ? t.k_diffusivity : t.second_diffusivity) * slope(phi, y)[d];
    };
    const Vec3 e = h * Vec3::Unit(d);
    divergence += (8 * (flux(x + e) - flux(x - e)) - (flux(x + 2 * e) - flux(x - 2 * e))) / (12 * h);
  }
  const auto t = terms(x);
  return rho * wind(x).dot(slope(phi, x)) - divergence - (k ? t.k_production : t.second_production) +
         (k ? t.k_destruction : t.second_destruction) * phi(x);
}

template <class Model>
std::array<double, 2> manufactured(const std::string& cell, int n) {
  const bool epsilon = std::string(Model::name) == "realizable_k_epsilon";
  const std::string ratio =
      (epsilon ? "1.3*0.09*" + std::string(text_k) + "^2/(0.02*" : "1.3*" + std::string(text_k) + "/(0.02*") +
      text_second + ")";
  Given given(cell, n,
              {{"fluid_turbulence", Model::name},
               {"fluid_initial_turbulent_energy", text_k},
               {"fluid_initial_viscosity_ratio", ratio},
               {"inflow_energy", text_k},
               {"inflow_viscosity_ratio", ratio},
               {"boundary_z_min_type", "slip"},
               {"boundary_z_max_type", "slip"}},
              rho, mu);
  for (int i = 0; i < given.mesh->nodes; ++i) vec3(&given.velocity[3 * i]) = wind(given.position(i));
  std::vector<std::array<double, 2>> source(given.mesh->nodes);
  given.turbulence->energy_source = [](const Vec3& x, double) { return exact_source<Model>(x, true); };
  given.turbulence->second_source = [](const Vec3& x, double) { return exact_source<Model>(x, false); };
  given.turbulence->start(given.flow());
  for (int k = 0; k < 30; ++k) given.advance(0.3);
  std::vector<Fluid::Scalar> scalars;
  given.turbulence->add_scalars(scalars);
  std::array<double, 2> sum{};
  const auto mass = lumped_mass(*given.mesh);
  for (int i = 0; i < given.mesh->owned_nodes; ++i) {
    const Vec3 x = given.position(i);
    sum[0] += mass[i] * std::pow(scalars[0].values[i] - exact_k(x), 2);
    sum[1] += mass[i] * std::pow(scalars[1].values[i] - exact_second(x), 2);
  }
  return {std::sqrt(mpi_sum(sum[0])), std::sqrt(mpi_sum(sum[1]))};
}

template <class Model>
void check_order(const std::string& cell, int n) {
  const auto coarse = manufactured<Model>(cell, n / 2), fine = manufactured<Model>(cell, n);
  for (int q = 0; q < 2; ++q) {
    INFO(Model::name << ", " << cell << ", equation " << q << ": " << coarse[q] << ", " << fine[q]);
    CHECK(std::log2(coarse[q] / fine[q]) > 1.7);
  }
}

}  // namespace

TEST_CASE("the wall distance in a box is exact, on every cell and over ranks and periodic images",
          "[fluid][turbulence][mpi]") {
  for (const char* cell : {"triangle", "quadrilateral", "tetrahedron", "hexahedron"}) {
    const bool flat = std::string(cell) == "triangle" || std::string(cell) == "quadrilateral";
    const Mesh mesh = box(cell, {6, 5, 4}, flat ? Vec3(1.2, 0.7, 0) : Vec3(1.2, 0.7, 0.5), {0, 0, 0});
    std::vector<char> wall(mesh.boundaries.size(), 1);
    const auto all = wall_distance(mesh, wall);
    std::vector<char> one(mesh.boundaries.size(), 0);
    for (std::size_t b = 0; b < one.size(); ++b) one[b] = mesh.boundaries[b] == "y_max";
    const auto above = wall_distance(mesh, one);
    double error = 0;
    for (int i = 0; i < mesh.nodes; ++i) {
      const Vec3 x = vec3(&mesh.node_coordinates[3 * static_cast<std::size_t>(i)]);
      double exact = std::min(x.x(), 1.2 - x.x());
      exact = std::min({exact, x.y(), 0.7 - x.y()});
      if (!flat) exact = std::min({exact, x.z(), 0.5 - x.z()});
      error = std::max({error, std::abs(all[i] - exact), std::abs(above[i] - (0.7 - x.y()))});
    }
    CHECK(mpi_max(error) < 1e-14);
  }
}

TEST_CASE("k and epsilon, k and omega converge with order 2 in a given flow", "[fluid][turbulence]") {
  check_order<RealizableKEpsilon>("quadrilateral", 32);
  check_order<RealizableKEpsilon>("triangle", 32);
  check_order<SstKOmega>("quadrilateral", 32);
  check_order<SstKOmega>("triangle", 32);
}

TEST_CASE("k and epsilon or omega stay positive behind a jump of the inflow by 10^6, at steps from 0.01 to 100 cells",
          "[fluid][turbulence][mpi]") {
  for (const char* model : {"realizable_k_epsilon", "sst_k_omega"})
    for (const char* cell : {"quadrilateral", "tetrahedron"})
      for (const double courant : {0.01, 1.0, 100.0}) {
        Given given(cell, 12,
                    {{"fluid_turbulence", model},
                     {"fluid_initial_turbulent_energy", "1e-6"},
                     {"fluid_initial_viscosity_ratio", "0.01"},
                     {"inflow_energy", "(y > 0.4 && y < 0.6) ? 1 : 1e-6"},
                     {"inflow_viscosity_ratio", "(y > 0.4 && y < 0.6) ? 1000 : 0.001"},
                     {"boundary_x_max_type", "pressure"},
                     {"boundary_y_min_type", "no_slip"}},
                    1, 1e-4);
        for (int i = 0; i < given.mesh->nodes; ++i) given.velocity[3 * i] = given.position(i).y();
        given.turbulence->start(given.flow());
        double least = 1, most = 0;
        for (int k = 0; k < 12; ++k) {
          given.advance(courant / 12);
          for (const double value : given.turbulence->energy()) {
            least = std::min(least, value), most = std::max(most, value);
          }
          for (const double value : given.turbulence->dissipation()) least = std::min(least, value);
          for (const double value : given.turbulence->eddy_viscosity()) least = std::min(least, value);
        }
        INFO(model << " " << cell << " " << courant);
        CHECK(mpi_min(least) >= 0);
        CHECK(mpi_max(most) > 0.5);
        CHECK(mpi_max(most) < 10);
      }
}

TEST_CASE("decaying turbulence follows the exact power law", "[fluid][turbulence]") {
  // Uniform k and epsilon: k = k0 (1 + (C2 - 1) t/t0)^(-1/(C2 - 1)), t0 = k0/eps0, up to the viscous part of C2.
  for (const bool epsilon : {true, false}) {
    Given given("quadrilateral", 3,
                {{"fluid_turbulence", epsilon ? "realizable_k_epsilon" : "sst_k_omega"},
                 {"fluid_initial_turbulent_energy", "2"},
                 {"fluid_initial_viscosity_ratio", epsilon ? "0.36/3e-9" : "2/5e-9"},
                 {"fluid_turbulence_largest_ratio", "1e20"},
                 {"boundary_x_min_type", "slip"},
                 {"boundary_x_max_type", "slip"},
                 {"boundary_y_min_type", "slip"},
                 {"boundary_y_max_type", "slip"}},
                1, 1e-9);
    given.turbulence->start(given.flow());
    const double end = 2, start = epsilon ? 2.0 / 3 : 0;
    for (int k = 0; k < 1000; ++k) given.advance(end / 1000);
    // omega = omega0/(1 + beta omega0 t), k = k0 (1 + beta omega0 t)^(-beta*/beta); far from walls beta = beta_2
    const double exact =
        epsilon ? 2 * std::pow(1 + 0.9 * end / start, -1 / 0.9) : 2 * std::pow(1 + 0.0828 * 5 * end, -0.09 / 0.0828);
    CHECK(given.turbulence->energy()[0] == Approx(exact).epsilon(0.005));
  }
}

TEST_CASE("In the logarithmic layer realizable k-epsilon has C_mu = 0.09", "[fluid][turbulence]") {
  // Pure shear with production in balance with dissipation: S k/epsilon = 1/sqrt(C_mu) = 10/3.
  Mat3 shear = Mat3::Zero();
  shear(0, 1) = 7;
  const double k = 2, epsilon = 7 * k * 0.3;
  CHECK(RealizableKEpsilon::coefficient(strain(shear), k, epsilon) == Approx(0.09).epsilon(1e-4));
}

TEST_CASE("Smagorinsky and WALE give the exact eddy viscosity of linear flows; WALE none in pure shear",
          "[fluid][turbulence][mpi]") {
  Mat3 shear = Mat3::Zero(), rotation = Mat3::Zero(), strained = Mat3::Zero();
  shear(0, 1) = 3;
  rotation(0, 1) = 2, rotation(1, 0) = -2;
  strained(0, 0) = 1, strained(1, 1) = -1;
  // nu_t over (constant times width)^2. Pure strain: S:S = 2, Sd = diag(1, 1, -2)/3, Sd:Sd = 2/3. Rotation: S = 0, Sd =
  // (-4) diag(1, 1, -2)/3, Sd:Sd = 32/3.
  const double d = 2.0 / 3, r = 32.0 / 3;
  const std::vector<std::tuple<const char*, Mat3, double>> cases = {
      {"smagorinsky", shear, 3},
      {"smagorinsky", rotation, 0},
      {"smagorinsky", strained, 2},
      {"wale", shear, 0},
      {"wale", rotation, std::pow(r, 1.5) / std::pow(r, 1.25)},
      {"wale", strained, std::pow(d, 1.5) / (std::pow(2.0, 2.5) + std::pow(d, 1.25))}};
  for (const auto& [model, gradient, rate] : cases)
    for (const char* cell : {"hexahedron", "tetrahedron"}) {
      Given given(cell, 4, {{"fluid_turbulence", model}}, 1.5, 1e-3);
      for (int i = 0; i < given.mesh->nodes; ++i) vec3(&given.velocity[3 * i]) = gradient * given.position(i);
      given.turbulence->start(given.flow());
      const double constant = std::string(model) == "wale" ? 0.325 : 0.1;
      double error = 0;
      for (int c = 0; c < given.mesh->cells; ++c) {
        const double width = std::cbrt(given.mesh->cell_volumes[c]);
        const double exact = 1.5 * std::pow(constant * width, 2) * rate;
        error = std::max(error, std::abs(given.turbulence->cell_eddy_viscosity()[c] - exact));
      }
      INFO(model << " " << cell << " " << rate);
      CHECK(mpi_max(error) < 1e-13);
    }
}

namespace {

/// Lower half of a channel at Re_tau = 2000 in wall units: velocity at three heights, and the wall's drag.
std::array<double, 4> channel(const std::string& scheme) {
  FlowCase flow({{"mesh_cell", "quadrilateral"},
                 {"mesh_upper", "0.3, 1, 0"},
                 {"mesh_cells", "3, 20"},
                 {"mesh_periodic", "1, 0, 0"},
                 {"fluid_scheme", scheme},
                 {"fluid_density", "1"},
                 {"fluid_viscosity", "5e-4"},
                 {"fluid_body_force", "1, 0, 0"},
                 {"fluid_initial_velocity", "22, 0, 0"},
                 {"fluid_turbulence", "realizable_k_epsilon"},
                 {"fluid_initial_turbulent_energy", "3"},
                 {"fluid_initial_viscosity_ratio", "100"},
                 {"boundary_y_min_type", "no_slip"},
                 {"boundary_y_max_type", "symmetry"}});
  for (int k = 0; k < 400; ++k) flow.advance(0.25);
  std::array<double, 4> result{};
  for (const auto& boundary : flow.fluid->boundary_flow()) result[3] = std::max(result[3], boundary.force.x());
  int at = 0;
  for (const double y : {0.05, 0.1, 0.2}) result[at++] = flow.value(flow.fluid->velocity(), 3, 0, Vec3(0.1, y, 0));
  return result;
}

}  // namespace

TEST_CASE("k-epsilon with wall functions carries the wall shear of a channel and meets the log law, on any ranks",
          "[fluid][turbulence][mpi]") {
  const auto result = channel("pressure_correction");
  CHECK(result[3] == Approx(0.3).epsilon(1e-3));
  int at = 0;
  for (const double y : {0.05, 0.1, 0.2}) CHECK(result[at++] == Approx(std::log(2000 * y) / 0.41 + 5.2).epsilon(0.03));
}

TEST_CASE("the monolithic scheme gives the turbulent channel of the pressure correction", "[fluid][turbulence]") {
  const auto split = channel("pressure_correction"), whole = channel("monolithic");
  for (int k = 0; k < 4; ++k) CHECK(whole[k] == Approx(split[k]).epsilon(2e-3));
}

TEMPLATE_TEST_CASE("an inlet that is still shut leaves the turbulence to itself", "[fluid][turbulence]", SstKOmega,
                   RealizableKEpsilon) {
  const bool omega = std::is_same_v<TestType, SstKOmega>;
  Given given("quadrilateral", 6,
              {{"fluid_turbulence", omega ? "sst_k_omega" : "realizable_k_epsilon"},
               {"fluid_initial_turbulent_energy", "1e-4"},
               {"boundary_y_min_type", "slip"},
               {"boundary_y_max_type", "slip"},
               {"boundary_x_max_type", "pressure"},
               {"boundary_x_min_turbulence_intensity", "0.05"},
               {"boundary_x_min_turbulence_length", "0.1"}},
              1000, 1e-3);
  given.turbulence->start(given.flow());
  for (int step = 0; step < 50; ++step) given.advance(0.1);
  for (const double ratio : given.turbulence->eddy_viscosity()) {
    CHECK(ratio / 1e-3 < 10 * (omega ? 1 : 1 / (4.04 * 0.09)));  // it decays from 10 (C_mu 1/A0 without shear)
    CHECK(ratio / 1e-3 > 0.1);
  }
}

TEST_CASE("turbulence of an inflow is asked for and may not be given twice or on a wall", "[fluid][turbulence]") {
  const std::vector<std::pair<std::string, std::string>> base = {
      {"fluid_turbulence", "sst_k_omega"},   {"fluid_initial_turbulent_energy", "1"},
      {"boundary_y_min_type", "no_slip"},    {"boundary_x_max_type", "pressure"},
      {"boundary_y_max_type", "slip"},       {"boundary_x_min_type", "velocity"},
      {"boundary_x_min_velocity", "1, 0, 0"}};
  const auto message = [&](std::vector<std::pair<std::string, std::string>> more) -> std::string {
    more.insert(more.begin(), base.begin(), base.end());
    try {
      Given given("quadrilateral", 3, more, 1, 1);
    } catch (const UserError& error) {
      return error.what();
    }
    return "";
  };
  using Catch::Contains;
  CHECK_THAT(message({}), Contains("boundary x_min") && Contains("turbulence_intensity"));
  CHECK_THAT(message({{"boundary_x_min_turbulence_intensity", "0.05"}}), Contains("turbulence_length"));
  CHECK_THAT(message({{"boundary_x_min_turbulence_intensity", "0.05"}, {"boundary_x_min_turbulence_energy", "1"}}),
             Contains("one of -boundary_x_min_turbulence_intensity and -boundary_x_min_turbulence_energy"));
  CHECK_THAT(message({{"boundary_x_min_turbulence_intensity", "0.05"},
                      {"boundary_x_min_turbulence_length", "0.1"},
                      {"boundary_y_min_turbulence_length", "0.1"}}),
             Contains("through a wall"));
  CHECK_THAT(message({{"boundary_x_min_turbulence_intensity", "0"}, {"boundary_x_min_turbulence_length", "0.1"}}),
             Contains("turbulence_intensity: it must be above 0"));
  CHECK(message({{"boundary_x_min_turbulence_intensity", "0.05"}, {"boundary_x_min_turbulence_length", "0.1"}}) == "");
}
