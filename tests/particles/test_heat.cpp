#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "gas_box.hpp"

using namespace silt;

namespace {

constexpr double pi = std::numbers::pi;

BoxCase warm(const std::string& temperature) {
  BoxCase setup;
  setup.box(Vec3::Constant(-5e-3), Vec3::Constant(5e-3));
  setup.set("heat_particles", "yes").set("heat_initial_temperature", temperature);
  setup.set("material_bead_heat_capacity", "800").set("material_bead_conductivity", "2").set("particles_speed", "0.1");
  return setup;
}

double* column(Particles& particles, const char* name, int p) {
  return particles.columns().row(particles.columns().find(name), p);
}

/// Temperatures by id on every rank.
std::map<std::int64_t, double> temperatures(Particles& particles, int count) {
  std::vector<double> all(count, 0.0);
  for (int p = 0; p < particles.owned(); ++p) all[particles.id(p)] = *column(particles, "temperature", p);
  MPI_Allreduce(MPI_IN_PLACE, all.data(), count, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  std::map<std::int64_t, double> result;
  for (int k = 0; k < count; ++k) result[k] = all[k];
  return result;
}

}  // namespace

TEST_CASE("Two spheres pressed together even out their temperatures as MFiX's case and its closed form say",
          "[heat][mpi]") {
  // Radii 1.5 and 1.8 mm, centres 3.299868 mm apart; 298.15 and 453.15 K.
  // Where the stiffness of 1e7 Pa was softened from 3.2e8 Pa, the radius is half of it.
  for (const std::string radius : {"lens", "hertz", "softened"}) {
    BoxCase setup = warm("z < 0 ? 298.15 : 453.15");
    setup.set("material_bead_heat_capacity", "800.53")
        .set("material_bead_conductivity", "55")
        .set("material_bead_density", "420");
    setup.set("material_cap_density", "8850")
        .set("material_cap_heat_capacity", "55.04")
        .set("material_cap_conductivity", "0.84");
    setup.set("heat_conduction", "yes")
        .set("heat_contact_radius", radius == "lens" ? "lens" : "hertz")
        .set("particles_fixed", "yes");
    if (radius == "softened") setup.set("heat_real_young_modulus", "3.2e8");
    BoxRun run(setup);
    const double r1 = 1.5e-3, r2 = 1.8e-3, distance = (0.4799731 - 0.1499864) * 1e-2;
    Seed low = sphere(Vec3(0, 0, -0.5 * distance), Vec3::Zero(), r1),
         high = sphere(Vec3(0, 0, 0.5 * distance), Vec3::Zero(), r2);
    high.material = 1;
    run.particles.add({low, high});
    for (int n = 0; n < 10; ++n) run.particles.advance(0.1 * n, 0.1);
    const double overlap = r1 + r2 - distance, plane = (r1 * r1 - r2 * r2 + distance * distance) / (2 * distance);
    const double a = radius == "lens" ? std::sqrt(r1 * r1 - plane * plane) : std::sqrt(r1 * r2 / (r1 + r2) * overlap);
    const double k = (radius == "softened" ? 0.5 : 1) * 4 * a / (1 / 55.0 + 1 / 0.84);
    const double c1 = 420 * 4.0 / 3 * pi * r1 * r1 * r1 * 800.53, c2 = 8850 * 4.0 / 3 * pi * r2 * r2 * r2 * 55.04;
    const double mean = (c1 * 298.15 + c2 * 453.15) / (c1 + c2), decay = std::exp(-k * (1 / c1 + 1 / c2));
    const auto T = temperatures(run.particles, 2);
    CHECK(T.at(0) == Approx(mean + (298.15 - mean) * decay).epsilon(1e-6));
    CHECK(T.at(1) == Approx(mean + (453.15 - mean) * decay).epsilon(1e-6));
    CHECK(c1 * (T.at(0) - 298.15) + c2 * (T.at(1) - 453.15) == Approx(0).margin(1e-13 * c1 * 298));
    if (radius == "lens") {
      CHECK(T.at(0) == Approx(299.7320).margin(2e-3));
      CHECK(T.at(1) == Approx(452.5180).margin(2e-3));
    }
  }
}

TEST_CASE("Walls with a temperature warm the particles that touch them, the others do not, and what each gives is told",
          "[heat][mpi]") {
  constexpr double dt = 1e-3;  // the temperature of a step's start counts for all of it
  const double r = 1.5e-3, low = 1.49e-3, side = 1.48e-3, capacity = 2500 * 4.0 / 3 * pi * r * r * r * 800;
  for (const std::string radius : {"hertz", "lens"}) {
    BoxCase setup = warm("300");
    setup.set("material_paint_density", "1000").set("material_paint_conductivity", "0.05");
    setup.set("heat_conduction", "yes").set("heat_contact_radius", radius).set("particles_fixed", "yes");
    setup.set("boundary_z_min_wall_temperature", "z < -4e-3 ? 400 : 1").set("boundary_z_min_material", "paint");
    setup.set("wall_plate_type", "plane").set("wall_plate_point", "0, 0, 0").set("wall_plate_normal", "1, 0, 0");
    setup.set("wall_plate_material", "paint").set("wall_plate_temperature", "250");
    setup.set("wall_cold_type", "plane").set("wall_cold_point", "0, -1.48e-3, 0").set("wall_cold_normal", "0, 1, 0");
    BoxRun run(setup);
    run.particles.add({sphere(Vec3(side, 0, -5e-3 + low), Vec3::Zero(), r)});
    for (int n = 0; n < 10; ++n) run.particles.advance(dt * n, dt);
    const auto through = [&](double distance) {
      const double a = std::sqrt(radius == "lens" ? r * r - distance * distance : r * (r - distance));
      return 4 * a / (1 / 2.0 + 1 / 0.05);
    };
    const double floor = through(low), plate = through(side), both = floor + plate;
    const double rest = (floor * 400 + plate * 250) / both;
    const auto at = [&](double t) { return rest + (300 - rest) * std::exp(-both * t / capacity); };
    const double T = temperatures(run.particles, 1).at(0);
    CHECK(T - 300 == Approx(at(10 * dt) - 300).epsilon(1e-5));
    double given = 0;
    for (const auto& wall : run.particles.wall_loads()) {
      given += dt * wall.heat;
      const double T_mean = rest + (at(9 * dt) - at(10 * dt)) * capacity / (dt * both);  // over the last step
      const double expected = wall.name == "z_min"   ? floor * (400 - T_mean)
                              : wall.name == "plate" ? plate * (250 - T_mean)
                                                     : 0;
      INFO(wall.name);
      CHECK(wall.heat == Approx(expected).epsilon(1e-4));
    }
    CHECK(given == Approx(capacity * (at(10 * dt) - at(9 * dt))).epsilon(1e-4));
  }
}

TEST_CASE("A wall with a temperature that cannot act is refused", "[heat]") {
  const auto fails = [](BoxCase setup, const std::string& words) {
    CHECK_THROWS_WITH(BoxRun(setup), Catch::Contains(words));
  };
  fails(warm("300").set("boundary_z_min_wall_temperature", "400"), "-boundary_z_min_wall_temperature");
  fails(warm("300")
            .set("heat_conduction", "yes")
            .set("boundary_z_min_wall_temperature", "400")
            .set("boundary_z_min_particles", "outlet"),
        "no wall");
  fails(warm("300")
            .set("heat_conduction", "yes")
            .set("material_zinc_density", "7000")
            .set("boundary_z_min_material", "zinc")
            .set("boundary_z_min_wall_temperature", "400"),
        "-material_zinc_conductivity");
}

TEST_CASE("A particle cools in a fluid as exp(-h A t/(m c_p)) whatever the step, and the heat it gave is counted",
          "[heat][mpi]") {
  BoxRun run(warm("400").set("heat_source", "1e6*t*0 + 2e6"));
  run.particles.add({sphere(Vec3::Zero(), Vec3::Zero(), 1e-3)});
  const double volume = 4.0 / 3 * pi * 1e-9, capacity = 2500 * volume * 800, exchange = 3e-2, made = 2e6 * volume;
  double end = 0;
  for (const double dt : {0.01, 2.0}) {
    for (int p = 0; p < run.particles.owned(); ++p) {
      *column(run.particles, "fluid_temperature", p) = 300;
      *column(run.particles, "heat_exchange", p) = exchange;
    }
    run.particles.advance(end, dt);
    end += dt;
  }
  const double rest = 300 + made / exchange, left = std::exp(-exchange * end / capacity);
  for (int p = 0; p < run.particles.owned(); ++p) {
    const double T = *column(run.particles, "temperature", p);
    CHECK(T == Approx(rest + (400 - rest) * left).epsilon(1e-10));
    CHECK(*column(run.particles, "heat_received", p) == Approx(capacity * (T - 400) - made * end).epsilon(1e-9));
    CHECK(run.particles.heat_capacity(p) == Approx(capacity));
  }
}

TEST_CASE("A hot particle radiates to its environment as e sigma A (T_env^4 - T^4)", "[heat]") {
  BoxRun run(warm("1200").set("heat_emissivity", "0.8").set("heat_environment", "300"));
  run.particles.add({sphere(Vec3::Zero(), Vec3::Zero(), 1e-4)});
  run.particles.advance(0, 1e-3);
  const double rate = 0.8 * 5.670374419e-8 * 3 / (1e-4 * 2500 * 800) * (std::pow(300.0, 4) - std::pow(1200.0, 4));
  CHECK(*column(run.particles, "temperature", 0) - 1200 == Approx(rate * 1e-3).epsilon(1e-2));
}

TEST_CASE("Heat of colliding particles is kept to round-off and evens out, on any ranks", "[heat][mpi]") {
  BoxCase setup = warm("300 + 1e4*x").periodic();
  setup.set("heat_conduction", "yes").set("material_bead_young_modulus", "1e6");
  BoxRun run(setup);
  run.particles.add(gas(6, Vec3::Constant(-5e-3), Vec3::Constant(5e-3), 0.75e-3, 0.5));
  const auto heat = [&] {
    double sum = 0, spread = 0;
    for (const auto& [id, T] : temperatures(run.particles, 216)) sum += T, spread += (T - 300) * (T - 300);
    return std::pair(sum, spread);
  };
  const auto before = heat();
  for (int n = 0; n < 4; ++n) run.particles.advance(n * 5e-3, 5e-3);
  const auto after = heat();
  CHECK(after.first == Approx(before.first).epsilon(1e-13));
  CHECK(after.second < before.second * (1 - 1e-7));
}

TEST_CASE("Particles with a temperature need a heat capacity, and a conductivity to conduct", "[heat]") {
  BoxCase none;
  none.set("heat_particles", "yes");
  const auto add_one = [](const BoxCase& setup) {
    BoxRun run(setup);
    run.particles.add({sphere(Vec3::Constant(0.5), Vec3::Zero(), 0.01)});
  };
  CHECK_THROWS_AS(add_one(none), UserError);
  none.set("material_bead_heat_capacity", "100").set("heat_conduction", "yes");
  CHECK_THROWS_AS(add_one(none), UserError);
  // A stream's material is asked for at the start, not when it comes.
  BoxCase later;
  later.set("heat_particles", "yes").set("insertion_rain_type", "stream").set("insertion_rain_diameter", "0.01");
  later.set("insertion_rain_number_rate", "1").set("insertion_rain_start", "10");
  later.set("insertion_rain_lower", "0.1, 0.1, 0.1").set("insertion_rain_upper", "0.9, 0.9, 0.9");
  CHECK_THROWS_WITH(BoxRun(later), Catch::Contains("heat_capacity is missing"));
  CHECK_NOTHROW(BoxRun(later.set("material_bead_heat_capacity", "100")));
  // The material of a wall alone needs neither.
  none.set("material_bead_conductivity", "1").set("material_wall_density", "8000");
  none.set("boundary_x_min_material", "wall");
  CHECK_NOTHROW(add_one(none));
}
