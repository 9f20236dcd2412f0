// What the particles' arrays take, counted by their containers, and what may be left out of them without a change.
#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <random>

#include "gas_box.hpp"
#include "particles/aligned.hpp"
#include "particles/huge_pages.hpp"
#include "particles/packed_state.hpp"
#include "particles/rearrange.hpp"
#include "particles/sweep.hpp"

using namespace silt;

namespace {

/// A simple cubic lattice of touching spheres in a periodic box: six contacts each.
std::unique_ptr<BoxRun> cubic_pack(int n, double overlap) {
  const double side = n * 1e-3 * (1 - overlap);
  BoxCase setup;
  setup.box(Vec3::Zero(), Vec3::Constant(side)).periodic();
  setup.set("particles_speed", "0.1").set("particles_skin", "1e-4");
  auto run = std::make_unique<BoxRun>(setup);
  std::vector<Seed> seeds;
  for (int k = 0; k < n * n * n; ++k)
    seeds.push_back(sphere(side / n * Vec3(k % n + 0.5, k / n % n + 0.5, k / n / n + 0.5), Vec3::Zero(), 0.5e-3));
  run->particles.add(seeds);
  return run;
}

}  // namespace

TEST_CASE("Arrays share regions of huge pages without touching each other, and give them back", "[particles]") {
  HugePages pages;
  struct Piece {
    unsigned char* start;
    std::size_t bytes;
    unsigned char mark;
  };
  std::vector<Piece> taken;
  std::mt19937 draw(7);
  std::size_t shared = 0;
  bool whole = true;
  const auto in_region = [](std::size_t bytes) {
    const std::size_t lines = (bytes + 63) / 64 * 64;
    return lines >= HugePages::least && lines < HugePages::region ? lines : 0;
  };
  const auto give = [&](std::size_t k) {
    const Piece piece = taken[k];
    whole = whole && std::all_of(piece.start, piece.start + piece.bytes, [&](auto byte) { return byte == piece.mark; });
    pages.give(piece.start, piece.bytes);
    shared -= in_region(piece.bytes);
    taken.erase(taken.begin() + static_cast<std::ptrdiff_t>(k));
  };
  for (int n = 0; n < 600; ++n) {
    if (taken.size() > 20) give(draw() % taken.size());
    // From a few bytes to more than a region.
    const std::size_t bytes = n % 100 == 99 ? HugePages::region + 100 : std::size_t(1) << draw() % 23 | draw() % 5000;
    auto* start = static_cast<unsigned char*>(pages.take(bytes));
    REQUIRE(reinterpret_cast<std::uintptr_t>(start) % 64 == 0);
    taken.push_back({start, bytes, static_cast<unsigned char>(n)});
    std::fill_n(start, bytes, taken.back().mark);
    shared += in_region(bytes);
    REQUIRE(pages.regions() * HugePages::region == shared + pages.idle());
  }
  CHECK(pages.regions() > 0);
  while (!taken.empty()) give(taken.size() - 1);
  CHECK(whole);
  CHECK(pages.regions() == 0);
  pages.give(nullptr, 0);
}

TEST_CASE("An array that grows keeps its entries, and new ones are zero where others were before", "[particles]") {
  {
    Aligned<double> before;
    before.reserve(100000);
    std::fill_n(before.data(), before.capacity(), 1.0);
  }
  Aligned<double> array;
  array.reserve(3);
  for (std::size_t count = 3; count < 6000000; count *= 3) {
    std::iota(array.data(), array.data() + array.capacity(), 1.0);
    const std::size_t kept = array.capacity();
    array.reserve(3 * count);
    const double* values = array.data();
    REQUIRE(array.capacity() >= 3 * count);
    REQUIRE(std::reduce(values, values + kept) == 0.5 * static_cast<double>(kept) * static_cast<double>(kept + 1));
    REQUIRE(std::all_of(values + kept, values + array.capacity(), [](double x) { return x == 0; }));
  }
}

TEST_CASE("Spheres with six contacts take less than 600 bytes each, the last good state included", "[particles]") {
  const auto pack = cubic_pack(30, 1e-3);
  Particles& particles = pack->particles;
  const double count = 27000;
  const ParticleStep step = particles.advance(0, 20 * particles.time_step());
  REQUIRE(step.contacts == 3 * count);
  const auto kept = particles.snapshot(false);
  INFO(particles.memory(kept.get()));
  CHECK(particles.bytes() < 400 * count);
  CHECK(particles.bytes(kept.get()) < 600 * count);
  // What a fluid does to the particles has its room once somebody asks for it.
  particles.fluid_action(0);
  CHECK(particles.bytes() > 600 * count);
}

TEST_CASE("A state kept without forces is the same state, and the way from it differs by the forces of one step",
          "[particles]") {
  BoxCase setup;
  setup.box(Vec3::Zero(), Vec3::Constant(8e-3));
  setup.set("material_bead_young_modulus", "1e6").set("material_bead_friction", "0").set("particles_speed", "1");
  BoxRun run(setup);
  run.particles.add(gas(7, Vec3::Zero(), Vec3::Constant(8e-3), 0.5e-3, 0.3, 0.1));
  run.particles.advance(0, 3e-3);
  const auto start = gather(run.particles);
  const auto whole = run.particles.snapshot(), lean = run.particles.snapshot(false);
  CHECK(run.particles.bytes(lean.get()) < run.particles.bytes(whole.get()) - 48 * run.particles.total() + 1);
  run.particles.restore(*whole);
  run.particles.advance(3e-3, 1e-3);
  const auto first = gather(run.particles);
  run.particles.restore(*lean);
  const auto back = gather(run.particles);
  for (const auto& [id, s] : start)
    for (int d = 0; d < 3; ++d) {
      CHECK(s.x[d] == back.at(id).x[d]);
      CHECK(s.v[d] == back.at(id).v[d]);
      CHECK(s.w[d] == back.at(id).w[d]);
    }
  run.particles.advance(3e-3, 1e-3);
  const auto second = gather(run.particles);
  double largest = 0;
  for (const auto& [id, s] : first)
    for (int d = 0; d < 3; ++d) largest = std::max(largest, std::abs(s.v[d] - second.at(id).v[d]));
  // Dashpots now see the velocities of this state, in the run they saw those predicted for it.
  CHECK(largest < 1e-3 * 0.3);
}

TEST_CASE(
    "A kept state has every bit, with few and many kinds of particles, ids of any size and any number of contacts",
    "[particles]") {
  Random random(4);
  constexpr int count = 3000;
  const auto bits = [](double a) { return std::bit_cast<std::uint64_t>(a); };
  for (const int kinds : {1, 3, 40, count}) {
    std::vector<Motion> motion(count), back(count);
    std::vector<Rotation> rotation(count), turned_back(count);
    std::vector<Load> load(count), load_back(count, Load{{1, 1, 1, 1}, {1, 1, 1, 1}});
    for (int p = 0; p < count; ++p) {
      const int kind = kinds == count ? p : static_cast<int>(random(0, kinds));
      for (int d = 0; d < 3; ++d) {
        motion[p].position[d] = random(-1, 1), motion[p].velocity[d] = -0.0 * d,
        rotation[p].spin[d] = random(-1e3, 1e3);
        load[p].force[d] = random(-1, 1), load[p].torque[d] = random(-1e-9, 1e-9);
      }
      load[p].force[3] = load[p].torque[3] = 0;
      motion[p].radius = 1e-3 * (1 + kind / 2), motion[p].inverse_mass = 1 / (1e-3 + kind),
      rotation[p].material = kind % 2;
    }
    const PackedMotions packed(motion.data(), rotation.data(), count);
    packed.unpack(back.data(), turned_back.data());
    const PackedLoads packed_load(load.data(), count);
    packed_load.unpack(load_back.data());
    int different = 0;
    for (int p = 0; p < count; ++p) {
      const auto *a = reinterpret_cast<const double*>(&motion[p]), *b = reinterpret_cast<const double*>(&back[p]);
      for (int k = 0; k < 8; ++k) different += bits(a[k]) != bits(b[k]);
      for (int d = 0; d < 3; ++d) different += bits(rotation[p].spin[d]) != bits(turned_back[p].spin[d]);
      different += bits(rotation[p].material) != bits(turned_back[p].material);
      const auto *c = reinterpret_cast<const double*>(&load[p]), *e = reinterpret_cast<const double*>(&load_back[p]);
      for (int k = 0; k < 8; ++k) different += bits(c[k]) != bits(e[k]);
    }
    CHECK(different == 0);
    CHECK(packed_load.bytes() == 48 * count);
    if (kinds <= 40)
      CHECK(packed.bytes() < 75.5 * count);
    else
      CHECK(packed.bytes() == 96 * count);
  }
  for (const std::int64_t widest : {std::int64_t(0), std::int64_t(1) << 31, std::int64_t(1) << 40}) {
    std::vector<std::int64_t> id(count);
    for (auto& one : id) one = static_cast<std::int64_t>(random(0, 1) * static_cast<double>(widest)) - 7;
    const PackedIds packed(count, [&](std::size_t k) { return id[k]; });
    int different = packed.size() != count;
    for (int k = 0; k < count; ++k) different += packed[k] != id[k];
    CHECK(different == 0);
    CHECK(packed.bytes() == (widest >> 32 ? 8 : 4) * count);
    for (const int most : {3, 400})
      for (const bool ids : {true, false}) {
        ParticleRows rows(4);
        for (int p = 0; p < count; ++p) {
          std::vector<double> row;
          const int each = p % 100 == 7 ? most : p % 3;
          for (int k = 0; k < each; ++k)
            row.insert(row.end(), {std::bit_cast<double>(id[(p + k) % count]), random(-1, 1), -0.0, random(-1, 1)});
          rows.append(row.data(), each);
        }
        const PackedRows kept(rows, ids);
        const ParticleRows same = kept.unpack();
        CHECK(same.width == rows.width);
        CHECK(same.start == rows.start);
        REQUIRE(same.entries.size() == rows.entries.size());
        different = 0;
        for (std::size_t k = 0; k < rows.entries.size(); ++k)
          different += bits(rows.entries[k]) != bits(same.entries[k]);
        CHECK(different == 0);
      }
  }
  const PackedRows none(ParticleRows(4), true);
  CHECK(none.unpack().start == std::vector<int>{0});
}

TEST_CASE("Particles without load move by the same bits whether their loads are read or not", "[particles]") {
  Random random(9);
  constexpr int count = 203;
  __builtin_cpu_init();
  for (const char* name : {"plain", "avx2", "avx512"}) {
    if (std::string(name) == "avx2" && !__builtin_cpu_supports("avx2")) continue;
    if (std::string(name) == "avx512" && !__builtin_cpu_supports("avx512dq")) continue;
    for (const auto& [drift, falls] : {std::pair{true, true}, std::pair{true, false}, std::pair{false, true}}) {
      INFO(name << " drift " << drift << " falls " << falls);
      struct Copy {
        Aligned<Motion> motion;
        Aligned<Rotation> rotation;
        Aligned<Load> present, previous;
        Aligned<double> turned;
      } with, without;
      std::vector<unsigned char> now(count), before(count);
      with.motion.reserve(count), with.rotation.reserve(count), with.present.reserve(count),
          with.previous.reserve(count);
      with.turned.reserve(4 * count);
      for (int p = 0; p < count; ++p) {
        Motion& m = with.motion[p];
        vec3(m.position) = random.vector(1), vec3(m.velocity) = random.vector(1);
        vec3(with.rotation[p].spin) = random.vector(100);
        m.radius = random(1e-3, 2e-3), m.inverse_mass = random(1e3, 1e5);
        now[p] = random(0, 1) < 0.2, before[p] = random(0, 1) < 0.2;
        with.turned[4 * p] = 1;
        for (int d = 0; d < 3; ++d) {
          if (now[p]) with.present[p].force[d] = random(-1, 1), with.present[p].torque[d] = random(-1e-3, 1e-3);
          if (before[p]) with.previous[p].force[d] = random(-1, 1), with.previous[p].torque[d] = random(-1e-3, 1e-3);
        }
      }
      without.motion = Aligned<Motion>(with.motion), without.rotation = Aligned<Rotation>(with.rotation);
      without.present = Aligned<Load>(with.present), without.previous = Aligned<Load>(with.previous);
      without.turned = Aligned<double>(with.turned);
      double largest[2];
      for (Copy* copy : {&with, &without}) {
        Integration step;
        step.motion = copy->motion.data(), step.rotation = copy->rotation.data();
        step.present = copy->present.data(), step.previous = copy->previous.data();
        step.count = count, step.dt = 1e-5, step.second = 0.5e-10, step.correct = true, step.drift = drift;
        step.orientation = reinterpret_cast<double(*)[4]>(copy->turned.data());
        if (falls) step.gravity[2] = -9.81, step.gravity[0] = 0.3;
        if (copy == &without) step.loaded = now.data(), step.loaded_before = before.data();
        choose_kernels(name).integrate(step);
        largest[copy == &without] = step.largest_square;
      }
      CHECK(largest[0] == largest[1]);
      int different = 0;
      for (int p = 0; p < count; ++p) {
        const Motion &a = with.motion[p], &b = without.motion[p];
        for (int d = 0; d < 3; ++d)
          different += a.position[d] != b.position[d] || a.velocity[d] != b.velocity[d] ||
                       with.rotation[p].spin[d] != without.rotation[p].spin[d] ||
                       (drift && without.previous[p].force[d] != 0);
        for (int d = 0; d < 4; ++d) different += with.turned[4 * p + d] != without.turned[4 * p + d];
      }
      CHECK(different == 0);
    }
  }
}

TEST_CASE("Arrays are rearranged in place as by a copy", "[particles]") {
  Random random(2);
  constexpr int count = 1000;
  std::vector<int> order(count), kept;
  std::iota(order.begin(), order.end(), 0);
  for (int k = 0; k < 300; ++k)
    std::swap(order[static_cast<int>(random(0, count))], order[static_cast<int>(random(0, count))]);
  for (int k = 0; k < count; k += 1 + k % 3) kept.push_back(k);
  for (const auto& wanted : {order, kept}) {
    std::vector<double> values(3 * count);
    std::iota(values.begin(), values.end(), 0.0);
    Rearrangement(wanted, count).apply(values.data(), 3);
    int wrong = 0;
    for (std::size_t k = 0; k < wanted.size(); ++k)
      for (int c = 0; c < 3; ++c) wrong += values[3 * k + c] != 3 * wanted[k] + c;
    CHECK(wrong == 0);
  }
  std::iota(order.begin(), order.end(), 0);
  CHECK(Rearrangement(order, count).nothing_moves());
}
