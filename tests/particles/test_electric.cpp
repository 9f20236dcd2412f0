#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "base/error.hpp"
#include "base/physical_constants.hpp"
#include "gas_box.hpp"
#include "particles/engine.hpp"
#include "particles/field/electric.hpp"

using namespace silt;

namespace {

constexpr double pi = std::numbers::pi, radius = 5e-6, cube = 8 * radius * radius * radius;

BoxCase electric(const std::string& type) {
  BoxCase setup;
  setup.box(Vec3::Constant(-1e-4), Vec3::Constant(1e-4));
  setup.set("electric_type", type).set("particles_speed", "0.1");
  return setup;
}

struct Charges {
  explicit Charges(BoxCase setup) : mesh(setup.mesh), engine(mesh, setup.options, Vec3::Zero()) {}
  Mesh mesh;
  Engine engine;
  Vec3 force(int p) const { return vec3(engine.store.present[p].force); }
  Vec3 torque(int p) const { return vec3(engine.store.present[p].torque); }
};

}  // namespace

TEST_CASE("Clausius and Mossotti's factor has its published values, and both its limits in frequency", "[electric]") {
  for (const auto& [ratio, factor] : std::vector<std::pair<double, double>>{{4, 0.5}, {10, 0.75}, {80, 0.963415}})
    CHECK(Dielectric{ratio, 1}.insulating() == Approx(factor).epsilon(1e-5));
  const double e0 = vacuum_permittivity;
  const Dielectric cell{60 * e0, 80 * e0, 0.5, 0.01};
  CHECK(cell.at(1e-3 / cell.relaxation()).real() == Approx(cell.conducting()).epsilon(1e-4));
  CHECK(cell.at(1e3 / cell.relaxation()).real() == Approx(cell.insulating()).epsilon(1e-4));
  // At the relaxation frequency Re K is half way and |Im K| is largest, half the difference.
  CHECK(cell.at(1 / cell.relaxation()).real() == Approx(0.5 * (cell.insulating() + cell.conducting())));
  CHECK(std::abs(cell.at(1 / cell.relaxation()).imag()) ==
        Approx(0.5 * std::abs(cell.insulating() - cell.conducting())));
}

TEST_CASE("A charge feels Q E, a dielectric sphere (pi/2) eps K d^3 E grad E, a permanent dipole p x E",
          "[electric][mpi]") {
  // E = (1e6 (1 + x/a), -1e6 y/a, 0) is free of curl and divergence.
  Charges run(electric("dc")
                  .set("electric_field", "1e6 + 1e10*x, -1e10*y, 0")
                  .set("electric_charge", "2e-15")
                  .set("electric_particle_permittivity", "10")
                  .set("electric_fluid_permittivity", "2.5")
                  .set("electric_dipole", "0, 0, 3e-22"));
  run.engine.add({sphere(Vec3(1e-5, 2e-5, 0), Vec3::Zero(), radius)});
  run.engine.advance(0, 1e-15);
  const Vec3 field(1.1e6, -2e5, 0);
  const double induced = pi / 2 * 2.5 * vacuum_permittivity * 0.5 * cube;
  const Vec3 expected = 2e-15 * field + induced * Vec3(1.1e6 * 1e10, -2e5 * -1e10, 0);
  for (int p = 0; p < run.engine.store.owned; ++p) {
    CHECK((run.force(p) - expected).norm() < 1e-9 * expected.norm());
    CHECK((run.torque(p) - Vec3(0, 0, 3e-22).cross(field)).norm() < 1e-9 * 3e-22 * 1e6);
  }
}

TEST_CASE("Dielectrophoresis draws to strong fields where Re K > 0, pushes away where Re K < 0, and turns by Im K",
          "[electric]") {
  for (const double frequency : {1e3, 1e8}) {
    Charges run(electric("ac")
                    .set("electric_field", "1e5 + 1e9*x, -1e9*y, 0")
                    .set("electric_frequency", std::to_string(frequency))
                    .set("electric_particle_permittivity", "2.5")
                    .set("electric_fluid_permittivity", "78")
                    .set("electric_particle_conductivity", "0.01")
                    .set("electric_fluid_conductivity", "0.001")
                    .set("electric_rotation", "0, 0, 1"));
    run.engine.add({sphere(Vec3::Zero(), Vec3::Zero(), radius)});
    run.engine.advance(0, 1e-15);
    const double e0 = vacuum_permittivity;
    const auto K = Dielectric{2.5 * e0, 78 * e0, 0.01, 0.001}.at(2 * pi * frequency);
    CHECK((K.real() > 0) == (frequency < 1e6));
    // grad E^2 = 2 E dE/dx.
    CHECK(run.force(0)[0] == Approx(pi / 4 * 78 * e0 * cube * K.real() * 2 * 1e5 * 1e9));
    CHECK(run.torque(0)[2] == Approx(-pi / 2 * 78 * e0 * cube * K.imag() * 1e10));
  }
}

TEST_CASE("Charges repel each other by Coulomb's law, in opposite directions to round-off, on any ranks",
          "[electric][mpi]") {
  Charges run(electric("dc")
                  .set("electric_coulomb", "yes")
                  .set("electric_charge", "x > 0 ? 1e-15 : -2e-15")
                  .set("electric_fluid_permittivity", "2"));
  run.engine.add({sphere(Vec3(-2e-5, 0, 0), Vec3::Zero(), radius), sphere(Vec3(2e-5, 3e-5, 0), Vec3::Zero(), radius)});
  run.engine.advance(0, 1e-15);
  const double size = 2e-30 / (4 * pi * 2 * vacuum_permittivity * 25e-10);
  Vec3 sum = Vec3::Zero();
  for (int p = 0; p < run.engine.store.owned; ++p) {
    const double sign = run.engine.store.id[p] == 0 ? 1 : -1;  // they attract
    CHECK((run.force(p) - sign * size * Vec3(0.8, 0.6, 0)).norm() < 1e-12 * size);
    sum += run.force(p);
  }
  MPI_Allreduce(MPI_IN_PLACE, sum.data(), 3, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  CHECK(sum.norm() < 1e-15 * size);
}

TEST_CASE("In a constant field conductivities decide the induced dipole if asked", "[electric]") {
  for (const auto& [inside, factor] : {std::pair{"0.04", 3.0 / 6}, {"0", -0.5}}) {
    Charges run(electric("dc")
                    .set("electric_field", "1e6 + 1e10*x, -1e10*y, 0")
                    .set("electric_particle_permittivity", "10")
                    .set("electric_fluid_permittivity", "2.5")
                    .set("electric_polarisation", "conductivity")
                    .set("electric_particle_conductivity", inside)
                    .set("electric_fluid_conductivity", "0.01"));
    run.engine.add({sphere(Vec3::Zero(), Vec3::Zero(), radius)});
    run.engine.advance(0, 1e-15);
    CHECK(run.force(0)[0] == Approx(pi / 2 * 2.5 * vacuum_permittivity * factor * cube * 1e6 * 1e10));
  }
}

TEST_CASE("A permanent dipole swings in a field with omega^2 = p E/I, of second order in the step", "[electric]") {
  const double mass = 2500 * pi / 6 * cube, inertia = 0.4 * mass * radius * radius;
  const double omega = std::sqrt(1e-18 * 1e6 / inertia), end = 2 / omega, angle = 1e-3;
  double error[2];
  for (int k = 0; k < 2; ++k) {
    BoxCase setup = electric("dc").set("electric_field", "0, 0, 1e6").set("particles_step_override", "yes");
    setup.set("electric_dipole", fmt::format("{:.17g}, 0, {:.17g}", 1e-18 * std::sin(angle), 1e-18 * std::cos(angle)));
    setup.set("particles_step", fmt::format("{:.17g}", end / (k == 0 ? 40 : 80)));
    Charges run(setup);
    run.engine.add({sphere(Vec3::Zero(), Vec3::Zero(), radius)});
    run.engine.advance(0, end);
    const double found = run.engine.store.columns.row(run.engine.store.columns.find("electric_moment"), 0)[0] / 1e-18;
    // The period of a pendulum of this amplitude: 1 + angle^2/16.
    error[k] = std::abs(found - angle * std::cos(omega * end / (1 + angle * angle / 16))) / angle;
  }
  CHECK(error[1] < 1e-3);
  CHECK(error[0] / error[1] == Approx(4).epsilon(0.25));
}

TEST_CASE("Magnetic and electric forces act at once and add up", "[electric][mpi]") {
  Charges run(electric("dc")
                  .set("electric_coulomb", "yes")
                  .set("electric_charge", "1e-15")
                  .set("magnetic_type", "fixed")
                  .set("magnetic_magnetisation", "1e4")
                  .set("magnetic_direction", "0, 0, 1"));
  run.engine.add({sphere(Vec3(-1e-5, 0, 0), Vec3::Zero(), radius), sphere(Vec3(1e-5, 0, 0), Vec3::Zero(), radius)});
  run.engine.advance(0, 1e-15);
  const double r = 2e-5, moment = 1e4 * pi / 6 * cube;
  const double charges = 1e-30 / (4 * pi * vacuum_permittivity * r * r);
  const double dipoles = 3 * vacuum_permeability * moment * moment / (4 * pi * r * r * r * r);  // side by side
  CHECK(dipoles > 0.1 * charges);
  CHECK(charges > 0.1 * dipoles);
  for (int p = 0; p < run.engine.store.owned; ++p) {
    const double sign = run.engine.store.id[p] == 0 ? -1 : 1;
    CHECK((run.force(p) - sign * (charges + dipoles) * Vec3::UnitX()).norm() < 1e-9 * charges);
  }
}

TEST_CASE("Electric options that lack something are refused", "[electric]") {
  CHECK_THROWS_AS(Charges(electric("ac")), UserError);
  CHECK_THROWS_AS(Charges(electric("dc").set("electric_polarisation", "conductivity")), UserError);
}

TEST_CASE("The field between charged cylinders is solved on the mesh with second order", "[electric][mpi]") {
  // phi = ln(r) around a point outside the box, with its values on all sides: E = -x/r^2, grad E known.
  double error[2], slope_error[2];
  for (int k = 0; k < 2; ++k) {
    MeshOptions box;
    box.lower = Vec3(1, 1, 0), box.upper = Vec3(2, 2, 0.5);
    box.cells = k == 0 ? std::vector<int>{8, 8, 4} : std::vector<int>{16, 16, 8};
    Mesh mesh(box);
    Options options;
    for (const char* side : {"x_min", "x_max", "y_min", "y_max"})
      options.set(std::string("boundary_") + side + "_potential", "0.5*ln(x^2 + y^2)");
    const ElectricPotential potential(mesh, options, 2, "0");
    error[k] = slope_error[k] = 0;
    const Locator locator(mesh);
    Random random(3);
    for (int n = 0; n < 200; ++n) {  // well inside: at the sides the nodal gradient is of first order
      const Vec3 x = Vec3(1.5, 1.5, 0.25) + random.vector(0.15).cwiseProduct(Vec3(1, 1, 0.5));
      const Place place = locator.find(x);
      if (!place.inside()) continue;
      Vec3 field;
      Mat3 gradient;
      potential.at(x.data(), place.cell, field, gradient);
      const double r2 = x[0] * x[0] + x[1] * x[1];
      error[k] = std::max(error[k], (field - Vec3(-x[0] / r2, -x[1] / r2, 0)).norm());
      slope_error[k] = std::max(slope_error[k], std::abs(gradient(0, 1) - 2 * x[0] * x[1] / (r2 * r2)));
    }
    error[k] = mpi_max(error[k]);
    slope_error[k] = mpi_max(slope_error[k]);
  }
  CHECK(error[1] < 1e-3);
  CHECK(error[0] / error[1] > 3);
  CHECK(slope_error[0] / slope_error[1] > 3);
}

TEST_CASE("Between plates with a space charge the potential is a parabola", "[electric][mpi]") {
  MeshOptions box;
  box.upper = Vec3(1, 1, 1);
  box.cells = {10, 3, 3};
  Mesh mesh(box);
  Options options;
  options.set("boundary_x_min_potential", "0");
  options.set("boundary_x_max_potential", "3");
  const ElectricPotential potential(mesh, options, 2, "8");
  double error = 0;
  for (int i = 0; i < mesh.nodes; ++i) {
    const double x = mesh.node_coordinates[3 * static_cast<std::size_t>(i)];
    error = std::max(error, std::abs(potential.values()[i] - (3 * x + 2 * x * (1 - x))));
  }
  CHECK(mpi_max(error) < 1e-8);
  Options none;
  CHECK_THROWS_AS(ElectricPotential(mesh, none, 1, "0"), UserError);
}
