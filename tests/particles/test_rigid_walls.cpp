#include <catch2/catch.hpp>
#include <numbers>

#include "base/error.hpp"
#include "gas_box.hpp"
#include "particles/wall_contacts.hpp"
#include "stl_writer.hpp"
#include "wall_probe.hpp"

using namespace silt;
using test::box_triangles;
using test::shell_triangles;
using test::write_stl;

namespace {

using Given = std::vector<std::pair<std::string, std::string>>;

/// One ball of 5 mm radius in a box of +-0.1 m with extra options.
BoxCase ball_case(const Given& given) {
  BoxCase setup;
  setup.box({-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1});
  setup.gravity = Vec3(0, 0, -9.81);
  setup.set("material_bead_young_modulus", "1e8").set("material_bead_restitution", "0.6");
  setup.set("material_bead_friction", "0.4").set("particles_speed", "1");
  for (const auto& [name, value] : given) setup.set(name, value);
  return setup;
}

State run(const Given& given, const Seed& seed, double time, const Given& more = {}) {
  BoxCase setup = ball_case(given);
  for (const auto& [name, value] : more) setup.set(name, value);
  BoxRun box(setup);
  box.particles.add({seed});
  for (int k = 0; k < 10; ++k) box.particles.advance(0.1 * k * time, 0.1 * time);
  return gather(box.particles).at(0);
}

double apart(const State& a, const State& b) { return (vec3(a.x) - vec3(b.x)).norm(); }

struct StlFile {
  StlFile(const std::string& file, const std::vector<test::Triangle>& triangles, bool binary = false) : name(file) {
    write_stl(file, triangles, binary);
  }
  ~StlFile() {
    MPI_Barrier(PETSC_COMM_WORLD);
    if (mpi_rank() == 0) std::remove(name.c_str());
  }
  std::string name;
};

}  // namespace

TEST_CASE("A ball bounces, slides and rolls alike on a floor of mesh faces, a plane, a box and STL facets",
          "[walls][mpi]") {
  const StlFile ascii("silt_floor.stl", box_triangles({-0.2, -0.2, -0.1}, {0.2, 0.2, 0.2}));
  const StlFile binary("silt_floor_b.stl", box_triangles({-0.125, -0.125, -0.25}, {0.125, 0.125, -0.0625}), true);
  const Seed seed = sphere(Vec3(-0.05, -0.02, -0.08), Vec3(0.4, 0.3, -0.2), 0.005);
  const double time = 0.15;
  const State mesh = run({}, seed, time);
  // The others stand in a mesh that reaches further down.
  const auto deeper = [&](const Given& wall, double floor) {
    BoxCase setup = ball_case(wall);
    setup.box({-0.11, -0.11, -0.2}, {0.11, 0.11, 0.1});
    BoxRun box(setup);
    Seed moved = seed;
    moved.position[2] += floor + 0.1;
    box.particles.add({moved});
    for (int k = 0; k < 10; ++k) box.particles.advance(0.1 * k * time, 0.1 * time);
    State state = gather(box.particles).at(0);
    state.x[2] -= floor + 0.1;
    return state;
  };
  const State plane =
      deeper({{"wall_a_type", "plane"}, {"wall_a_point", "0, 0, -0.1"}, {"wall_a_normal", "0, 0, 2"}}, -0.1);
  const State box =
      deeper({{"wall_a_type", "box"}, {"wall_a_lower", "-0.3, -0.3, -0.1"}, {"wall_a_upper", "0.3, 0.3, 0.3"}}, -0.1);
  const State inside = deeper({{"wall_a_type", "stl"}, {"wall_a_file", ascii.name}}, -0.1);
  const State outside =
      deeper({{"wall_a_type", "stl"}, {"wall_a_file", binary.name}, {"wall_a_side", "outside"}}, -0.0625);
  const State both = deeper({{"wall_a_type", "stl"}, {"wall_a_file", binary.name}, {"wall_a_side", "both"}}, -0.0625);
  CHECK(mesh.x[0] > -0.03);
  for (const State& other : {plane, box, inside, outside, both}) {
    CHECK(apart(mesh, other) < 1e-8);
    CHECK((vec3(mesh.w) - vec3(other.w)).norm() < 1e-5);
  }
}

TEST_CASE("A small ball without friction swings in a cylinder as a pendulum does", "[walls]") {
  // Length R - r, small amplitude: period 2 pi sqrt((R - r)/g) (1 + a^2/16).
  const double radius = 0.08, ball = 0.005, length = radius - ball, amplitude = 0.1;
  const double period = 2 * std::numbers::pi * std::sqrt(length / 9.81) * (1 + amplitude * amplitude / 16);
  const Seed seed = sphere(length * Vec3(std::sin(amplitude), 0, -std::cos(amplitude)), Vec3::Zero(), ball);
  const Given smooth = {{"material_bead_friction", "0"}, {"particles_speed", "0.1"}};
  const Given cylinder = {
      {"wall_a_type", "cylinder"}, {"wall_a_point", "0, 0, 0"}, {"wall_a_axis", "0, 1, 0"}, {"wall_a_radius", "0.08"}};
  const State exact = run(cylinder, seed, period / 4, smooth);
  CHECK(std::abs(exact.x[0]) < 2e-3 * length * amplitude);
  CHECK(exact.v[0] == Approx(-std::sqrt(2 * 9.81 * length * (1 - std::cos(amplitude)))).epsilon(2e-3));
  const StlFile coarse("silt_shell_1.stl", shell_triangles(radius, -0.11, 0.11, 360));
  const StlFile fine("silt_shell_2.stl", shell_triangles(radius, -0.11, 0.11, 1440));
  double error[2];
  int k = 0;
  for (const StlFile* file : {&coarse, &fine})
    error[k++] = apart(exact, run({{"wall_a_type", "stl"}, {"wall_a_file", file->name}, {"wall_a_side", "both"}}, seed,
                                  period / 4, smooth));
  CHECK(error[0] < 5e-4 * length);
  CHECK(error[1] < 0.5 * error[0]);
}

TEST_CASE("A belt takes a ball along at 2/7 of its speed, a rotating disc of the same speed too", "[walls]") {
  // Angular momentum about the line of contact stays zero: v R = 2/5 R^2 w, v + w R = V.
  const Seed seed = sphere(Vec3(0, 0, -0.005 - 2e-8), Vec3::Zero(), 0.005);
  const Given plane = {{"wall_a_type", "plane"}, {"wall_a_point", "0, 0, -0.01"}, {"wall_a_normal", "0, 0, 1"}};
  const State belt = run(plane, seed, 0.1, {{"wall_a_velocity", "0.3, 0, 0"}});
  CHECK(belt.v[0] == Approx(0.3 * 2 / 7).epsilon(1e-3));
  // Far from its axis a disc is a belt.
  const State disc = run(plane, seed, 0.1,
                         {{"wall_a_rotation_rate", "0.003"},
                          {"wall_a_rotation_axis", "0, 0, 1"},
                          {"wall_a_rotation_centre", "0, 100, 0"}});
  CHECK(disc.v[0] == Approx(0.3 * 2 / 7).epsilon(2e-3));
}

TEST_CASE("A piston gives an elastic ball twice its speed", "[walls]") {
  for (const char* type : {"plane", "box"}) {
    BoxCase setup = ball_case({{"material_bead_restitution", "1"}});
    setup.gravity.setZero();
    if (std::string(type) == "plane")
      setup.set("wall_a_type", "plane").set("wall_a_point", "0, 0, -0.05").set("wall_a_normal", "0, 0, 1");
    else
      setup.set("wall_a_type", "box")
          .set("wall_a_lower", "-0.02, -0.02, -0.09")
          .set("wall_a_upper", "0.02, 0.02, -0.05")
          .set("wall_a_side", "outside");
    setup.set("wall_a_velocity", "0, 0, 0.5");
    BoxRun box(setup);
    box.particles.add({sphere(Vec3(0, 0, 0), Vec3::Zero(), 0.005)});
    for (int k = 0; k < 20; ++k) box.particles.advance(0.005 * k, 0.005);
    CHECK(box.particles.velocity(0)[2] == Approx(1.0).epsilon(1e-3));
    const auto load = box.particles.wall_loads().back();
    CHECK(load.name == "a");
    CHECK(load.displacement[2] == Approx(0.05));
  }
}

TEST_CASE("A drum of STL facets turns a ball as the analytic drum does", "[walls][mpi]") {
  const StlFile shell("silt_drum.stl", shell_triangles(0.08, -0.11, 0.11, 720));
  const Seed seed = sphere(Vec3(0, 0, -0.0749), Vec3::Zero(), 0.005);
  const Given turning = {{"wall_drum_rotation_rate", "2*min(t/0.05, 1)"},
                         {"wall_drum_rotation_axis", "0, 1, 0"},
                         {"wall_drum_rotation_centre", "0, 0, 0"}};
  const State analytic = run({{"wall_drum_type", "cylinder"},
                              {"wall_drum_point", "0, 0, 0"},
                              {"wall_drum_axis", "0, 1, 0"},
                              {"wall_drum_radius", "0.08"}},
                             seed, 0.15, turning);
  const State stl =
      run({{"wall_drum_type", "stl"}, {"wall_drum_file", shell.name}, {"wall_drum_side", "both"}}, seed, 0.15, turning);
  CHECK(std::abs(analytic.x[0]) > 1e-3);
  CHECK(apart(analytic, stl) < 0.02 * std::abs(analytic.x[0]));
}

TEST_CASE("A wall turns about the axis of its image where it is touched across a periodic side", "[walls][mpi]") {
  // Two balls roll on a turning roller, opposite each other: in the middle of the box, and on its periodic sides.
  std::vector<State> ball[2];
  Vec3 torque[2] = {Vec3::Zero(), Vec3::Zero()};
  for (int k = 0; k < 2; ++k) {
    const double x = k ? -0.1 : 0;
    BoxCase setup = ball_case({{"wall_a_type", "cylinder"},
                               {"wall_a_side", "outside"},
                               {"wall_a_point", k ? "-0.1, 0, 0" : "0, 0, 0"},
                               {"wall_a_axis", "0, 1, 0"},
                               {"wall_a_radius", "0.02"},
                               {"wall_a_rotation_axis", "0, 1, 0"},
                               {"wall_a_rotation_rate", "20"}});
    setup.gravity.setZero();
    setup.mesh.periodic = {1, 0, 0};
    BoxRun box(setup);
    box.particles.add({sphere(Vec3(x + 0.0252037, 0, 0), Vec3(-0.2, 0, 0), 0.005),
                       sphere(Vec3(k ? 0.1 - 0.0252037 : -0.0252037, 0, 0), Vec3(0.2, 0, 0), 0.005)});
    for (int step = 0; step < 4; ++step) {
      box.particles.advance(0.0005 * step, 0.0005);
      torque[k] += box.particles.wall_loads().back().torque;
    }
    for (const auto& [id, state] : gather(box.particles)) ball[k].push_back(state);
  }
  CHECK(std::abs(torque[0][1]) > 1e-4);
  CHECK((torque[1] - torque[0]).norm() < 1e-6 * torque[0].norm());
  for (int i = 0; i < 2; ++i) {
    CHECK(std::abs(ball[0][i].v[2]) > 0.05);
    CHECK((vec3(ball[1][i].v) - vec3(ball[0][i].v)).norm() < 1e-9);
    CHECK((vec3(ball[1][i].w) - vec3(ball[0][i].w)).norm() < 1e-6);
  }
}

TEST_CASE("A servo wall presses with its force, an oscillating one is where its sine says", "[walls][mpi]") {
  BoxCase setup = ball_case({{"wall_lid_type", "plane"},
                             {"wall_lid_point", "0, 0, 0.02"},
                             {"wall_lid_normal", "0, 0, -1"},
                             {"wall_lid_servo_force", "2"},
                             {"wall_lid_servo_direction", "0, 0, -1"},
                             {"wall_lid_servo_speed", "0.1"},
                             {"wall_shaker_type", "sphere"},
                             {"wall_shaker_point", "0.07, 0.07, 0.07"},
                             {"wall_shaker_radius", "0.01"},
                             {"wall_shaker_side", "outside"},
                             {"wall_shaker_oscillation_amplitude", "0, 0.01, 0"},
                             {"wall_shaker_oscillation_frequency", "2"}});
  setup.box({-0.1, -0.1, 0}, {0.1, 0.1, 0.1});
  BoxRun box(setup);
  std::vector<Seed> seeds;
  for (int i = -1; i <= 1; ++i)
    for (int j = -1; j <= 1; ++j) seeds.push_back(sphere(Vec3(0.03 * i, 0.03 * j, 0.005), Vec3::Zero(), 0.005));
  box.particles.add(seeds);
  for (int k = 0; k < 30; ++k) box.particles.advance(0.01 * k, 0.01);
  const auto loads = box.particles.wall_loads();
  const auto& lid = loads[loads.size() - 2];
  CHECK(lid.name == "lid");
  CHECK(lid.force[2] == Approx(2).epsilon(1e-3));
  CHECK(loads.back().displacement[1] == Approx(0.01 * std::sin(2 * std::numbers::pi * 2 * 0.3)));
  double floor = 0;
  for (const auto& load : loads)
    if (load.name == "z_min") floor = load.force[2];
  CHECK(floor == Approx(-2 - box.particles.total_mass() * 9.81).epsilon(2e-3));
}

TEST_CASE("Walls move before the first particle comes and after the last has gone", "[walls][mpi]") {
  BoxCase setup = ball_case({{"wall_belt_type", "plane"},
                             {"wall_belt_point", "0, 0, -0.09"},
                             {"wall_belt_normal", "0, 0, 1"},
                             {"wall_belt_velocity", "0, 0.01, 0"},
                             {"wall_drum_type", "cylinder"},
                             {"wall_drum_point", "0, 0, 0"},
                             {"wall_drum_axis", "1, 0, 0"},
                             {"wall_drum_radius", "0.09"},
                             {"wall_drum_rotation_rate", "2"},
                             {"wall_drum_rotation_axis", "1, 0, 0"}});
  BoxRun box(setup);
  const auto check = [&](double time) {
    for (const auto& load : box.particles.wall_loads()) {
      INFO(load.name << " at " << time);
      if (load.name == "belt") CHECK(load.displacement[1] == Approx(0.01 * time));
      if (load.name == "drum") CHECK(load.angle == Approx(2 * time));
      CHECK(load.force.norm() == 0);
    }
  };
  CHECK(box.particles.total() == 0);
  for (int k = 0; k < 5; ++k) box.particles.advance(0.01 * k, 0.01);
  check(0.05);
  box.particles.add({sphere(Vec3(0, 0, 0), Vec3::Zero(), 0.005)});
  box.particles.advance(0.05, 0.01);
  check(0.06);
}

TEST_CASE("Where a cylinder meets a cone a sphere feels each once, and the rim of the outlet", "[walls]") {
  const Mesh mesh = [] {
    MeshOptions options;
    options.lower = Vec3(-2, -2, -2), options.upper = Vec3(2, 2, 2), options.cells = {2, 2, 2};
    return Mesh(options);
  }();
  // A hopper: radius 1 above z = 0, a cone of 45 degrees below to radius 0.4.
  const auto hopper = [&](bool one) {
    Options options;
    const auto set = [&](const Given& given) {
      for (const auto& [name, value] : given) options.set(name, value);
    };
    if (one)
      set({{"wall_h_type", "revolution"},
           {"wall_h_point", "0, 0, 0"},
           {"wall_h_axis", "0, 0, 1"},
           {"wall_h_profile", "-0.6, 0.4, 0, 1, 1, 1"}});
    else
      set({{"wall_a_type", "cone"},
           {"wall_a_point", "0, 0, -0.6"},
           {"wall_a_axis", "0, 0, 1"},
           {"wall_a_radius", "0.4"},
           {"wall_a_end_radius", "1"},
           {"wall_a_length", "0.6"},
           {"wall_b_type", "cylinder"},
           {"wall_b_point", "0, 0, 0"},
           {"wall_b_axis", "0, 0, 1"},
           {"wall_b_radius", "1"},
           {"wall_b_length", "1"}});
    return Walls(mesh, options, {"steel"});
  };
  for (bool one : {true, false}) {
    Walls walls = hopper(one);
    CHECK(test::touches(walls, {0.9, 0, 0.5}, 0.2).size() == 1);
    CHECK(test::touches(walls, {0.85, 0, 0.1}, 0.2).size() == 2);   // in the corner
    const auto cone = test::touches(walls, {0.8, 0, -0.05}, 0.25);  // beside the end of the cylinder
    REQUIRE(cone.size() == 1);
    CHECK((vec3(cone[0].normal) - Vec3(-1, 0, 1).normalized()).norm() < 1e-12);
    CHECK(cone[0].distance == Approx(0.15 / std::sqrt(2.0)));
    const auto rim = test::touches(walls, {0.3, 0, -0.7}, 0.2);
    REQUIRE(rim.size() == 1);
    CHECK(rim[0].distance == Approx(0.1 * std::sqrt(2.0)));
    CHECK((vec3(rim[0].normal) - Vec3(-1, 0, -1).normalized()).norm() < 1e-12);
    CHECK(test::touches(walls, {0, 0, -0.6}, 0.3).empty());
  }
}

TEST_CASE("A tangential spring goes on where one wall continues as another", "[walls]") {
  WallContacts contacts(1);
  const Motion ball = [] {
    Motion motion{};
    motion.radius = 1;
    return motion;
  }();
  WallPoint point{};
  point.normal[2] = 1;
  contacts.next() = {point};
  contacts.adopt(&ball, 0);
  WallSweep sweep;
  contacts.fill(sweep);
  sweep.history[0] = 0.25;
  point.boundary = 3;
  contacts.next() = {point};
  contacts.adopt(&ball, 0);
  contacts.fill(sweep);
  CHECK(sweep.history[0] == 0.25);
  point.normal[2] = 0;
  point.normal[0] = 1;
  contacts.next() = {point};
  contacts.adopt(&ball, 0);
  contacts.fill(sweep);
  CHECK(sweep.history[0] == 0);
}

TEST_CASE("Insertions keep to the side of a wall where particles are", "[walls][insertion]") {
  BoxCase setup = ball_case({{"wall_pipe_type", "cylinder"},
                             {"wall_pipe_point", "0, 0, 0"},
                             {"wall_pipe_axis", "0, 1, 0"},
                             {"wall_pipe_radius", "0.06"},
                             {"wall_core_type", "sphere"},
                             {"wall_core_point", "0, 0, 0"},
                             {"wall_core_radius", "0.03"},
                             {"wall_core_side", "outside"},
                             {"insertion_a_diameter", "0.01"},
                             {"insertion_a_count", "200"}});
  BoxRun box(setup);
  REQUIRE(box.particles.total() == 200);
  for (int p = 0; p < box.particles.owned(); ++p) {
    const Vec3 x = box.particles.position(p);
    CHECK(std::hypot(x[0], x[2]) <= 0.055);
    CHECK(x.norm() >= 0.035);
  }
}

TEST_CASE("A wall with too few or too many options is refused by name", "[walls]") {
  MeshOptions box;
  const Mesh mesh(box);
  const auto refused = [&](const Given& given) -> std::string {
    Options options;
    for (const auto& [name, value] : given) options.set(name, value);
    try {
      Walls(mesh, options, {"steel"});
    } catch (const UserError& error) {
      return error.what();
    }
    return "accepted";
  };
  using Catch::Contains;
  const Given plane = {{"wall_a_type", "plane"}, {"wall_a_point", "0, 0, 0"}, {"wall_a_normal", "0, 0, 1"}};
  const auto with = [&](Given more) {
    more.insert(more.begin(), plane.begin(), plane.end());
    return more;
  };
  CHECK(refused(plane) == "accepted");
  CHECK_THAT(refused({{"wall_a_type", "plane"}, {"wall_a_point", "0, 0, 0"}}), Contains("-wall_a_normal is missing"));
  CHECK_THAT(refused(with({{"wall_a_radius", "1"}})), Contains("-wall_a_radius: a wall of type plane has no radius"));
  CHECK_THAT(refused(with({{"wall_a_material", "stel"}})), Contains("did you mean steel"));
  CHECK_THAT(refused(with({{"wall_a_servo_force", "1"}})), Contains("servo needs all of"));
  CHECK_THAT(refused(with({{"wall_a_rotation_rate", "1"}})), Contains("-wall_a_rotation_axis is missing"));
  CHECK_THAT(refused(with({{"wall_a_velocity", "x, 0, 0"}})),
             Contains("-wall_a_velocity: 'x, 0, 0' depends on the place"));
  CHECK_THAT(refused(with({{"wall_a_rotation_rate", "1 + y"}, {"wall_a_rotation_axis", "0, 0, 1"}})),
             Contains("-wall_a_rotation_rate: '1 + y' depends on the place"));
  CHECK_THAT(refused({{"wall_x_min_type", "plane"}, {"wall_x_min_point", "0, 0, 0"}, {"wall_x_min_normal", "0, 0, 1"}}),
             Contains("is a boundary of the mesh"));
  CHECK_THAT(refused({{"wall_a_type", "stl"}, {"wall_a_file", "nowhere.stl"}}), Contains("does not exist"));
}
