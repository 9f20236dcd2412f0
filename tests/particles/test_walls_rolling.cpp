#include <fmt/format.h>

#include <catch2/catch.hpp>

#include "grid_file.hpp"
#include "particles/particles.hpp"

using namespace silt;
using namespace silt::test;

namespace {

Options ball(const std::string& friction) {
  Options options;
  for (const auto& [name, value] :
       std::vector<std::pair<std::string, std::string>>{{"material_ball_density", "2500"},
                                                        {"material_ball_friction", friction},
                                                        {"material_ball_restitution", "0.5"},
                                                        {"particles_speed", "0.5"}})
    options.set(name, value);
  return options;
}

}  // namespace

TEST_CASE("A ball sliding over a meshed floor ends rolling at 5/7 of its speed", "[walls]") {
  // Angular momentum about the line of contact: m v0 R = (m + 2/5 m) v R, whatever the friction.
  for (const char* cell : {"hexahedron", "tetrahedron"}) {
    const Mesh mesh = box_mesh(cell, {0, 0, 0}, {0.08, 0.04, 0.04}, {27, 13, 5});
    Options options = ball("0.5");
    Particles particles(mesh, options, Vec3(0, 0, -9.81));
    Seed seed;
    seed.position = Vec3(0.011, 0.0201, 0.005 - 2e-8);
    seed.velocity = Vec3(0.5, 0.01, 0);
    seed.radius = 0.005;
    particles.add({seed});
    particles.advance(0, 0.08);
    CHECK(particles.position(0)[0] > 0.03);
    CHECK(particles.velocity(0)[0] == Approx(0.5 * 5 / 7).epsilon(2e-3));
    CHECK(particles.velocity(0)[1] == Approx(0.01 * 5 / 7).epsilon(2e-3));
    CHECK(particles.spin(0)[1] == Approx(0.5 * 5 / 7 / 0.005).epsilon(2e-3));
    CHECK(std::abs(particles.velocity(0)[2]) < 1e-3);
  }
}

TEST_CASE("Two meshes of one floor give the same motion", "[walls]") {
  Vec3 end[2], spin[2];
  int run = 0;
  for (const char* cell : {"hexahedron", "tetrahedron"}) {
    const Mesh mesh = box_mesh(cell, {0, 0, 0}, {0.08, 0.04, 0.04}, run ? std::vector{9, 7, 6} : std::vector{2, 2, 2});
    Options options = ball("0.3");
    Particles particles(mesh, options, Vec3(0, 0, -9.81));
    Seed seed;
    seed.position = Vec3(0.01, 0.02, 0.007);
    seed.velocity = Vec3(0.4, 0.3, -0.2);
    seed.radius = 0.005;
    particles.add({seed});
    particles.advance(0, 0.15);  // bounces, slides, rolls, meets a side wall
    end[run] = particles.position(0);
    spin[run++] = particles.spin(0);
  }
  CHECK((end[0] - end[1]).norm() < 1e-9);
  CHECK((spin[0] - spin[1]).norm() < 1e-5);
}
