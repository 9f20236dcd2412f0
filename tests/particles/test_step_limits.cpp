// The automatic time step takes every force that acts: each in turn is made the stiffest and has its closed form.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "base/physical_constants.hpp"
#include "gas_box.hpp"

using namespace silt;

namespace {

constexpr double pi = std::numbers::pi, radius = 0.5e-3, density = 2500, share = 0.05;
const double mass = density * 4 / 3 * pi * radius * radius * radius;
const double pair_mass = mass / 2, pair_radius = radius / 2;

using Given = std::vector<std::pair<std::string, std::string>>;

/// The step and its reason for two beads of 1 mm in a box without weight; the contact soft unless `given` says more.
std::pair<double, std::string> step_of(const Given& given) {
  BoxCase setup;
  setup.box(Vec3::Constant(-5e-3), Vec3::Constant(5e-3));
  setup.set("normal_type", "linear").set("normal_stiffness", "1e-6").set("particles_speed", "1e-3");
  setup.set("material_bead_restitution", "1");
  for (const auto& [name, value] : given) setup.set(name, value);
  BoxRun run(setup);
  run.particles.add({sphere(Vec3(-1e-3, 0, 0), Vec3::Zero(), radius), sphere(Vec3(1e-3, 0, 0), Vec3::Zero(), radius)});
  return {run.particles.time_step(), run.particles.time_step_reason()};
}

/// Half an oscillation of the pair with the stiffness k.
double half_oscillation(double stiffness) { return pi * std::sqrt(pair_mass / stiffness); }

void check(const Given& given, double duration, const std::string& reason, double tolerance = 1e-9) {
  const auto [step, told] = step_of(given);
  INFO(told << ", step " << step << ", expected " << share * duration);
  CHECK(step == Approx(share * duration).epsilon(tolerance));
  CHECK(told.find(reason) != std::string::npos);
}

}  // namespace

TEST_CASE("The step is a twentieth of the collision: linear, and Hertz at the largest speed", "[particles]") {
  check({{"normal_stiffness", "1e4"}}, half_oscillation(1e4), "collision time");
  // A wall is a partner of infinite mass: half an oscillation of the bead alone is longer, and does not limit.
  const double young = 1e7 / (2 * (1 - 0.09)), stiffness = 4.0 / 3 * young * std::sqrt(pair_radius), speed = 20;
  const double overlap = std::pow(1.25 * pair_mass * speed * speed / stiffness, 0.4);
  check({{"normal_type", "tsuji"},
         {"material_bead_young_modulus", "1e7"},
         {"material_bead_poisson_ratio", "0.3"},
         {"particles_rayleigh_fraction", "1"},
         {"particles_speed", "20"}},
        2.943275 * overlap / speed, "collision time", 1e-6);
}

TEST_CASE("The step is a fifth of the Rayleigh time where waves in the particles are the fastest", "[particles]") {
  const auto [step, told] = step_of({{"normal_type", "tsuji"},
                                     {"material_bead_young_modulus", "1e7"},
                                     {"material_bead_poisson_ratio", "0.3"},
                                     {"particles_speed", "1e-6"}});
  const double shear = 1e7 / 2.6;
  CHECK(step == Approx(0.2 * pi * radius * std::sqrt(density / shear) / (0.1631 * 0.3 + 0.8766)).epsilon(1e-9));
  CHECK(told.find("Rayleigh") != std::string::npos);
}

TEST_CASE("The step takes a JKR neck at rest, 6/5 E_eff a0", "[particles]") {
  const double young = 1e6 / (2 * (1 - 0.09)), energy = 2;
  const double neck = std::cbrt(9 * pi * energy * pair_radius * pair_radius / young);
  check({{"normal_type", "tsuji"},
         {"material_bead_young_modulus", "1e6"},
         {"material_bead_poisson_ratio", "0.3"},
         {"material_bead_surface_energy", "2"},
         {"adhesion_type", "jkr"},
         {"particles_rayleigh_fraction", "1"},
         {"particles_speed", "1e-9"}},
        half_oscillation(1.2 * young * neck), "adhesion jkr", 0.01);
}

TEST_CASE("The step takes the steepest slope of DLVO's forces, at the least gap", "[particles]") {
  // Van der Waals, near: F = A R_eff/(6 h^2), slope A R_eff/(3 h^3), which is found between samples of the gap: to 5 %.
  check({{"dlvo_type", "vdw"}, {"material_bead_hamaker", "1e-15"}, {"dlvo_least_gap", "1e-7"}},
        half_oscillation(1e-15 * pair_radius / (3 * 1e-21)), "dlvo vdw", 0.025);
  // Double layers: F = 4 pi eps R_eff kappa psi^2 e/(1 + e), slope kappa F/(1 + e), e = exp(-kappa h).
  const double eps = 78.4 * vacuum_permittivity, kappa = 1e7, e = std::exp(-kappa * 1e-9), psi = 10;
  check({{"dlvo_type", "electrostatic"},
         {"material_bead_surface_potential", "10"},
         {"dlvo_debye_length", "1e-7"},
         {"dlvo_least_gap", "1e-9"}},
        half_oscillation(4 * pi * eps * pair_radius * kappa * kappa * psi * psi * e / ((1 + e) * (1 + e))),
        "dlvo electrostatic", 0.01);
}

TEST_CASE("The step takes capillary and viscous force of a bridge", "[particles]") {
  const double volume = 2 * 0.5 * (1 - std::sqrt(0.75)) * 0.01 * 4.0 / 3 * pi * radius * radius * radius;
  const Given wet = {
      {"bridge_type", "capillary"}, {"bridge_surface_tension", "0.07"}, {"bridge_liquid_content", "0.01"}};
  check(wet, half_oscillation(4 * pi * 0.07 * pair_radius * std::sqrt(pi * pair_radius / volume)), "bridge capillary");
  Given thick = wet;
  thick.insert(thick.end(), {{"bridge_viscosity", "10"}, {"bridge_roughness", "1e-7"}});
  check(thick, pi * pair_mass / (6 * pi * 10 * pair_radius * pair_radius / 1e-7), "bridge capillary (viscous)");
}

TEST_CASE("The step takes the attraction at an interface and lubrication", "[particles]") {
  // Small Bond number: F = 2 pi sigma Q^2/r, Q = d/2 sin(beta) tan(theta - beta); in contact the slope is F/d.
  const double degree = pi / 180, charge = radius * std::sin(100 * degree) * std::tan(20 * degree);
  const double slope = 2 * pi * 0.07 * charge * charge / (4 * radius * radius);
  check({{"interfacial_type", "nicolson"},
         {"interfacial_surface_tension", "0.07"},
         {"interfacial_contact_angle", "120"},
         {"interfacial_filling_angle", "100"},
         {"interfacial_small_bond", "yes"},
         {"interfacial_cutoff", "4e-3"}},
        half_oscillation(slope), "interfacial nicolson", 0.01);
  check({{"lubrication_type", "squeeze"}, {"lubrication_viscosity", "1e-3"}, {"lubrication_least_gap", "1e-7"}},
        pi * pair_mass / (6 * pi * 1e-3 * pair_radius * pair_radius / 1e-7), "lubrication squeeze", 1e-2);
}

TEST_CASE("The step takes given springs and dashpots of friction, rolling and twisting, a tenth of half their swing",
          "[particles]") {
  const double slip_mass = pair_mass / 3.5, rolling_inertia = 0.7 * mass * radius * radius;
  const double twisting_inertia = 0.2 * mass * radius * radius;
  const auto swing = [](double inertia, double stiffness) { return 2 * pi * std::sqrt(inertia / stiffness); };
  const auto brake = [](double inertia, double damping) { return 2 * pi * inertia / damping; };
  for (const std::string friction : {"spring", "spring_dashpot"})
    check({{"tangential_type", friction}, {"tangential_stiffness", "1e4"}}, swing(slip_mass, 1e4),
          "tangential " + friction);
  check({{"tangential_type", "spring_dashpot"}, {"tangential_stiffness", "1"}, {"tangential_damping", "1"}},
        brake(slip_mass, 1), "tangential spring_dashpot");
  check({{"tangential_type", "viscous"}, {"tangential_damping", "1"}}, brake(slip_mass, 1), "tangential viscous");
  check({{"rolling_type", "spring"}, {"rolling_stiffness", "1e4"}}, swing(rolling_inertia, 1e4 * pair_radius),
        "rolling spring");
  check({{"rolling_type", "spring"}, {"rolling_stiffness", "1e-3"}, {"rolling_damping", "1"}},
        brake(rolling_inertia, pair_radius), "rolling spring");
  check({{"twisting_type", "twisting"}, {"twisting_stiffness", "1"}}, swing(twisting_inertia, 1), "twisting twisting");
  check({{"twisting_type", "twisting"}, {"twisting_stiffness", "1e-6"}, {"twisting_damping", "1e-4"}},
        brake(twisting_inertia, 1e-4), "twisting twisting");
  // A spring of friction no stiffer than the normal one leaves the step to the collision.
  check({{"normal_stiffness", "1e4"}, {"tangential_type", "spring"}, {"tangential_stiffness", "1e4"}},
        half_oscillation(1e4), "collision time");
}

TEST_CASE("The step takes the swing of an electric dipole and fields that turn or alternate, whatever their frequency",
          "[particles]") {
  check({{"electric_type", "dc"}, {"electric_dipole", "0, 0, 1e-9"}, {"electric_field", "0, 0, 1e9"}},
        pi * std::sqrt(0.4 * mass * radius * radius / (1e-9 * 1e9)), "electric swing");
  for (const double frequency : {50.0, 1e5, 3.7e8}) {
    // 40 steps a period.
    const std::string phase = "2*pi*" + std::to_string(frequency) + "*t";
    const std::string turning = "1e4*cos(" + phase + "), 1e4*sin(" + phase + "), 0";
    const std::string swinging = "0, 1e4*cos(" + phase + "), 0", late = "0, 0, 1e4*sin(" + phase + ")";
    for (const std::string& field : {turning, swinging, late}) {
      INFO(field);
      check({{"magnetic_type", "fixed"}, {"magnetic_magnetisation", "1e-3"}, {"magnetic_field", field}},
            0.5 / frequency, "change of the magnetic field", field == turning ? 1e-3 : 0.1);
      check({{"electric_type", "dc"}, {"electric_field", field}}, 0.5 / frequency, "change of the electric field",
            field == turning ? 1e-3 : 0.1);
    }
  }
}

TEST_CASE("The step takes dipoles and charges in contact, and the swing of a magnet", "[particles]") {
  const double volume = 4.0 / 3 * pi * radius * radius * radius, moment = 1e6 * volume, d = 2 * radius;
  check({{"magnetic_type", "fixed"}, {"magnetic_magnetisation", "1e6"}},
        half_oscillation(6 * vacuum_permeability * moment * moment / (pi * std::pow(d, 5))), "magnetic attraction");
  const double field = 1e9 + 2 * moment / (4 * pi * d * d * d);
  check({{"magnetic_type", "permanent"}, {"magnetic_magnetisation", "1e6"}, {"magnetic_field", "0, 0, 1e9"}},
        pi * std::sqrt(0.4 * mass * radius * radius / (vacuum_permeability * moment * field)), "magnetic swing");
  for (const char* charge : {"1e-9", "x > 1e-3 ? -1e-9 : 0"})
    check({{"electric_type", "dc"}, {"electric_coulomb", "yes"}, {"electric_charge", charge}},
          half_oscillation(2 * 1e-18 / (4 * pi * vacuum_permittivity * d * d * d)), "electric force");
}

TEST_CASE("Brownian motion counts with three times its thermal speed, and conduction of heat limits the step",
          "[particles]") {
  // Hertz's collision at 3 (3 k_B T/m)^1/2; hot enough that it is the largest speed.
  const double speed = 3 * std::sqrt(3 * boltzmann_constant * 1e20 / mass);
  const double young = 1e7 / (2 * (1 - 0.09)), stiffness = 4.0 / 3 * young * std::sqrt(pair_radius);
  const double overlap = std::pow(1.25 * pair_mass * speed * speed / stiffness, 0.4);
  BoxCase setup;
  setup.box(Vec3::Constant(-5e-3), Vec3::Constant(5e-3)).set("normal_type", "tsuji");
  setup.set("material_bead_young_modulus", "1e7").set("material_bead_poisson_ratio", "0.3");
  setup.set("brownian_temperature", "1e20").set("particles_rayleigh_fraction", "1");
  BoxRun run(setup);
  run.particles.add({sphere(Vec3(-1e-3, 0, 0), Vec3::Zero(), radius), sphere(Vec3(1e-3, 0, 0), Vec3::Zero(), radius)});
  CHECK(run.particles.time_step() == Approx(share * 2.943275 * overlap / speed).epsilon(1e-6));
  check({{"heat_particles", "yes"},
         {"heat_conduction", "yes"},
         {"material_bead_heat_capacity", "1e-6"},
         {"material_bead_conductivity", "100"}},
        mass * 1e-6 / (12 * radius * 100), "heat conduction");
}
