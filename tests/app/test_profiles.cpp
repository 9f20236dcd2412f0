#include <catch2/catch.hpp>
#include <cmath>

#include "app/output.hpp"
#include "app/profiles.hpp"
#include "app/progress.hpp"
#include "base/error.hpp"
#include "support/temporary_directory.hpp"

using namespace silt;

TEST_CASE("a sphere's share of a box: whole, half, quarter, cap, none", "[app]") {
  const Vec3 lower(0, 0, 0), upper(10, 10, 10), middle(5, 5, 5);
  CHECK(share_in_box(middle, 1, lower, upper) == 1);
  CHECK(share_in_box(Vec3(-1.5, 5, 5), 1, lower, upper) == 0);
  CHECK(share_in_box(Vec3(5, 5, 0), 1, lower, upper) == Approx(0.5).margin(0.01));
  CHECK(share_in_box(Vec3(0, 5, 0), 1, lower, upper) == Approx(0.25).margin(0.01));
  CHECK(share_in_box(Vec3(0, 0, 0), 1, lower, upper) == Approx(0.125).margin(0.01));
  // A cap of height h of the unit sphere: h^2 (3 - h)/4 of its volume.
  for (double h : {0.3, 0.7, 1.4})
    CHECK(share_in_box(Vec3(5, 5, h - 1), 1, lower, upper) == Approx(h * h * (3 - h) / 4).margin(0.012));
}

TEST_CASE("boxes that tile space share every sphere out completely", "[app]") {
  const double cut[] = {0, 0.37, 0.61, 1};
  double sum = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k)
        sum += share_in_box(Vec3(0.4, 0.5, 0.6), 0.3, Vec3(cut[i], cut[j], cut[k]),
                            Vec3(cut[i + 1], cut[j + 1], cut[k + 1]));
  CHECK(sum == Approx(1).epsilon(1e-12));
}

TEST_CASE("a sphere's part of a ring: whole, cut in height, cut by its radii, drilled through", "[app]") {
  const double sphere = 4.0 / 3.0 * M_PI;
  CHECK(volume_in_ring(10, 0, 1, {8, 12, -2, 2}) == Approx(sphere).epsilon(1e-3));
  CHECK(volume_in_ring(10, 0, 1, {8, 12, 0, 2}) == Approx(sphere / 2).epsilon(1e-3));
  CHECK(volume_in_ring(10, 0, 1, {8, 12, 0.5, 2}) == Approx(M_PI * 0.25 * 2.5 / 3).epsilon(1e-3));
  CHECK(volume_in_ring(10, 0, 1, {0, 9, -2, 2}) == 0);
  CHECK(volume_in_ring(10, 0, 1, {8, 12, 1.5, 2}) == 0);
  // About an axis far away a ring is a slab: a share of 3/2 w - w^3/2 of the sphere between +-w.
  CHECK(volume_in_ring(1e5, 0, 1, {1e5 - 0.1, 1e5 + 0.1, -2, 2}) == Approx(sphere * (0.15 - 0.0005)).epsilon(1e-3));
  // A hole of radius 0.6 through the middle takes all but a ring of height 2 * 0.8: 4/3 pi 0.8^3.
  CHECK(sphere - volume_in_ring(0, 0, 1, {0, 0.6, -2, 2}) == Approx(sphere * 0.512).epsilon(1e-3));
  // Rings that fill space share the sphere out completely.
  double sum = 0;
  for (int k = 0; k < 20; ++k) sum += volume_in_ring(1.3, 0.2, 1, {0.15 * k, 0.15 * (k + 1), -1, 2});
  CHECK(sum == Approx(sphere).epsilon(1e-3));
}

TEST_CASE("a sphere across a periodic side counts on both, in boxes and in rings about the other axis", "[app][mpi]") {
  MeshOptions box;
  box.cells = {4, 4, 4};
  box.periodic = {1, 1, 0};
  const Mesh mesh(box);
  Options options;
  options.set("material_bead_density", "1000");
  options.set("material_bead_young_modulus", "1e6");
  options.set("profile_all_size", "1,1,1");
  options.set("profile_all_from", "0.5,0.5,0.5");
  options.set("profile_all_points", "1");
  options.set("profile_half_size", "0.5,1,1");
  options.set("profile_half_from", "0.25,0.5,0.5");
  options.set("profile_half_to", "0.75,0.5,0.5");
  options.set("profile_half_points", "2");
  options.set("profile_round_axis", "x");  // all of a ring that is as long as the period
  options.set("profile_round_centre", "0,0.5,0.5");
  options.set("profile_round_size", "1,0.4,0.4");
  options.set("profile_round_from", "0.5,0.5,0.7");
  options.set("profile_round_points", "1");
  Particles particles(mesh, options, Vec3::Zero(), true);
  constexpr double radius = 0.1;
  std::vector<Seed> seeds(3);
  seeds[0].position = Vec3(0.02, 0.5, 0.7);   // across one side
  seeds[1].position = Vec3(0.97, 0.99, 0.4);  // across an edge
  seeds[2].position = Vec3(0.5, 0.5, 0.3);    // across no side
  for (auto& seed : seeds) seed.radius = radius;
  particles.add(seeds);
  Profiles profiles(mesh, options, true);
  Moment moment;
  moment.time = moment.dt = 1;
  moment.particles = &particles;
  profiles.sample(moment);
  TemporaryDirectory folder;
  OutputOptions output;
  output.directory = folder / "run";
  OutputDirectory directory(output);
  directory.prepare("");
  profiles.write(directory);
  const double volume = 4.0 / 3 * M_PI * radius * radius * radius;
  CHECK(profiles.values("all.void_fraction")[0] == Approx(1 - 3 * volume).epsilon(1e-12));
  const auto halves = profiles.values("half.void_fraction");
  CHECK(halves[0] + halves[1] == Approx(2 - 6 * volume).epsilon(1e-12));
  // A cap 0.08 high of the first lies across x = 0, one 0.07 high of the second within x > 0, half of the third is
  // here.
  const auto cap = [&](double h) { return M_PI * h * h * (3 * radius - h) / 3; };
  CHECK(halves[0] == Approx(1 - 2 * (volume - cap(0.08) + cap(0.07) + 0.5 * volume)).epsilon(1e-3));
  // The ring, 0 to 0.4 about the middle, holds the first and the third.
  CHECK(profiles.values("round.void_fraction")[0] == Approx(1 - 2 * volume / (M_PI * 0.16)).epsilon(1e-4));
}

TEST_CASE("a profile outside the mesh or without extent is refused", "[app]") {
  MeshOptions box;
  box.cells = {2, 2, 2};
  const Mesh mesh(box);
  const auto make = [&](const std::string& size, const std::string& to, bool particles) {
    Options options;
    options.set("profile_a_from", "0.5,0.5,0.1");
    options.set("profile_a_to", to);
    if (!size.empty()) options.set("profile_a_size", size);
    Profiles(mesh, options, particles);
  };
  CHECK_NOTHROW(make("0.1,0.1,0.1", "0.5,0.5,0.9", true));
  CHECK_THROWS_AS(make("", "0.5,0.5,0.9", true), UserError);
  CHECK_THROWS_AS(make("0.1,0.1,0.1", "0.5,0.5,1.9", true), UserError);
  CHECK_THROWS_AS(make("0.1,0.1,0.1", "0.5,0.5,0.9", false), UserError);
}

TEST_CASE("time left is written as a clock", "[app]") {
  CHECK(clock_text(12.4) == "12 s");
  CHECK(clock_text(187) == "3:07");
  CHECK(clock_text(7509) == "2:05:09");
  CHECK(clock_text(1e9) == "days");
  CHECK(clock_text(std::nan("")) == "days");
}

TEST_CASE("the record of a run gives every option back, defaults as comments", "[app]") {
  Options options;
  options.set("output_directory", "it's here");
  options.set("output_interval", "0.5");
  options.set("fluid_pressure_ksp_rtol", "1e-9");  // PETSc's
  OutputOptions output;
  options.read("output", output);
  const std::string text = record_of(options);
  CHECK(text.find("output_directory: 'it''s here'\n") != std::string::npos);
  CHECK(text.find("output_interval: 0.5\n") != std::string::npos);
  CHECK(text.find("\n# output_overwrite: yes\n") != std::string::npos);
  CHECK(text.find("\nfluid_pressure_ksp_rtol: '1e-9'\n") != std::string::npos);
}
