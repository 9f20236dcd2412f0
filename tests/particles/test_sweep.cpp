#include <catch2/catch.hpp>
#include <cmath>
#include <tuple>

#include "gas_box.hpp"
#include "law_cases.hpp"
#include "particles/contact_lists.hpp"
#include "reference_path.hpp"

using namespace silt;

namespace {

bool can_run(const std::string& name) {
  __builtin_cpu_init();
  return name == "plain" || (name == "avx2" && __builtin_cpu_supports("avx2")) ||
         (name == "avx512" && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"));
}

/// Random pairs through the blocks, against the same pairs one at a time.
void compare(const LawCase& setup, const char* instructions, bool several, unsigned seed, bool slip_at_radius = false) {
  LawCase all = setup;
  if (several) {
    all.set("material_rock_density", "3000").set("material_rock_young_modulus", "3e8");
    all.set("pair_bead_rock_friction", "0.7");
  }
  LawRun run(all, 0.4e-3, 1.2e-3);
  run.laws.take_slip_at_radius(slip_at_radius);
  constexpr int count = 203;  // not a multiple of the block or of any pack
  const int components = run.laws.history_components();
  Store store;
  store.owned = 2 * count;
  store.reserve(store.owned);
  store.id.resize(store.owned);
  Random random(seed);
  for (int p = 0; p < store.owned; ++p) {
    Body m{};
    m.radius = random(0.4e-3, 1.2e-3);
    m.material = several ? std::floor(random(0, 2)) : 0;
    m.inverse_mass = 1 / (*run.materials[static_cast<int>(m.material)].density * 4.18879 * std::pow(m.radius, 3));
    vec3(m.velocity) = random.vector(0.5);
    vec3(m.spin) = random.vector(500);
    vec3(m.position) = random.vector(1e-2);
    if (p % 2) {
      const Motion& other = store.motion[p - 1];
      const Vec3 n = random.vector(1).normalized();
      const double overlap = random(-0.05, 0.2) * std::min(m.radius, other.radius);  // some do not touch
      vec3(m.position) = vec3(other.position) + (m.radius + other.radius - overlap) * n;
    }
    store.set_body(p, m);
  }
  store.place_padding();
  ContactLists lists(components);
  std::vector<std::vector<double>> history(count, std::vector<double>(components + 1));
  for (int k = 0; k < count; ++k) {
    for (double& h : history[k]) h = random(-1e-6, 1e-6);
    lists.add_contact(2 * k, 2 * k + 1, history[k].data(), 1);
  }
  lists.pad(store.padding(), store.owned);
  PairSweep sweep;
  sweep.motion = store.motion.data();
  sweep.rotation = store.rotation.data();
  sweep.load = store.present.data();
  sweep.pairs = lists.pairs();
  sweep.laws = run.laws.setup();
  sweep.dt = 1e-6;
  sweep.leaving = lists.leaving();
  choose_kernels(instructions).pairs(sweep);

  int apart = 0;
  double largest = 0, difference = 0;
  std::vector<double> longest(components), drift(components);
  for (int k = 0; k < count; ++k) {
    const Body a = store.body(2 * k), b = store.body(2 * k + 1);
    const Loads expected = one_contact(run.laws, a, b, sweep.dt, history[k].data());
    const Load &on_i = store.present[2 * k], &on_j = store.present[2 * k + 1];
    largest = std::max({largest, expected.force.norm(), expected.torque_i.norm() / a.radius});
    difference = std::max(difference, (vec3(on_i.force) - expected.force).norm());
    difference = std::max(difference, (vec3(on_j.force) + expected.force).norm());
    difference = std::max(difference, (vec3(on_i.torque) - expected.torque_i).norm() / a.radius);
    difference = std::max(difference, (vec3(on_j.torque) - expected.torque_j).norm() / b.radius);
    for (int c = 0; c < components; ++c) {
      longest[c] = std::max(longest[c], std::abs(history[k][c]));
      drift[c] = std::max(drift[c], std::abs(lists.history(c, k) - history[k][c]));
    }
    apart += (vec3(a.position) - vec3(b.position)).norm() >= a.radius + b.radius + run.laws.setup().leave_gap;
  }
  CHECK(largest > 0);
  CHECK(std::isfinite(largest));
  CHECK(difference < 2e-12 * largest);
  for (int c = 0; c < components; ++c) CHECK(drift[c] <= 1e-11 * longest[c]);
  CHECK(sweep.leaving_count == apart);
}

}  // namespace

TEST_CASE("The blocks of packed contacts give the forces of each law taken one contact at a time", "[particles]") {
  for (const char* instructions : {"plain", "avx2", "avx512"}) {
    if (!can_run(instructions)) continue;
    each_law([&](const char* slot, const std::string& name) {
      for (const bool several : {false, true}) {
        INFO(slot << " " << name << " " << instructions << " several " << several);
        compare(LawCase().choose(slot, name), instructions, several, 7);
      }
    });
  }
}

TEST_CASE("Adhesions, double layers and friction share a contact as they do one at a time", "[particles]") {
  const char* instructions = can_run("avx512") ? "avx512" : can_run("avx2") ? "avx2" : "plain";
  unsigned seed = 3;
  for (const auto& adhesion : AdhesionModels::names())
    for (const auto& dlvo : DlvoModels::names())
      for (const auto& rolling : RollingModels::names()) {
        INFO(adhesion << " " << dlvo << " " << rolling);
        LawCase setup;
        setup.choose("adhesion", adhesion).choose("dlvo", dlvo).choose("rolling", rolling);
        setup.choose("interfacial", seed % 2 ? "none" : "nicolson").choose("twisting", "twisting");
        compare(setup, instructions, seed % 3 == 0, seed);
        ++seed;
      }
}

TEST_CASE("The blocks take the slip at the radius as one contact does", "[particles]") {
  for (const char* instructions : {"plain", "avx2", "avx512"})
    if (can_run(instructions))
      for (const bool several : {false, true})
        compare(LawCase().choose("tangential", "mindlin"), instructions, several, 19, true);
}

TEST_CASE("Any normal law goes with any tangential, rolling and twisting law in the blocks", "[particles]") {
  const char* instructions = can_run("avx512") ? "avx512" : can_run("avx2") ? "avx2" : "plain";
  unsigned seed = 11;
  for (const auto& normal : NormalModels::names())
    for (const auto& tangential : TangentialModels::names())
      for (const auto& rolling : RollingModels::names()) {
        const std::string twisting = TwistingModels::names()[seed % TwistingModels::count];
        INFO(normal << " " << tangential << " " << rolling << " " << twisting);
        LawCase setup;
        setup.choose("normal", normal).choose("tangential", tangential).choose("rolling", rolling);
        compare(setup.choose("twisting", twisting), instructions, seed % 2 == 0, seed);
        ++seed;
      }
}

TEST_CASE("Touching pairs, the deepest overlap and the fabric are those of the pairs looked at one at a time",
          "[particles]") {
  constexpr int owned = 90, ghosts = 30, pairs = 203;
  Store store;
  store.owned = owned;
  store.reserve(owned + ghosts);
  Random random(23);
  for (int p = 0; p < owned + ghosts; ++p) {
    Body m{};
    m.radius = random(0.4e-3, 1.2e-3);
    m.inverse_mass = 1e6;
    vec3(m.position) = Vec3::Constant(2e-3) + random.vector(2e-3);
    store.set_body(p, m);
  }
  store.ghosts = ghosts;
  store.place_padding();
  ContactLists lists(0);
  for (int k = 0; k < pairs; ++k) {
    const int i = static_cast<int>(random(0, owned + ghosts)), j = (i + 1 + k % 50) % (owned + ghosts);
    lists.add_contact(i, j, nullptr, 1);
  }
  lists.pad(store.padding(), store.owned);
  for (const bool periodic : {false, true}) {
    ContactCensus census;
    if (periodic) {
      census.periods.any = true;
      for (int d : {0, 2}) census.periods.length[d] = 4.5e-3, census.periods.inverse[d] = 1 / 4.5e-3;
    }
    int touching = 0;
    double largest = 0;
    Vec3 fabric = Vec3::Zero();
    REQUIRE(lists.contacts() == pairs);
    for (int k = 0; k < pairs; ++k) {
      const int i = lists.contact_i()[k], j = lists.contact_j()[k];
      const Motion &a = store.motion[i], &b = store.motion[j];
      Vec3 apart = vec3(a.position) - vec3(b.position);
      for (int d = 0; d < 3; ++d)
        apart[d] -= census.periods.length[d] * std::round(apart[d] * census.periods.inverse[d]);
      const double overlap = a.radius + b.radius - apart.norm();
      if (i >= owned || overlap <= 0) continue;
      ++touching;
      largest = std::max(largest, overlap / std::min(a.radius, b.radius));
      fabric += apart.normalized().cwiseAbs2();
    }
    REQUIRE(touching > 20);
    REQUIRE(touching < pairs - 20);
    for (const char* instructions : {"plain", "avx2", "avx512"}) {
      if (!can_run(instructions)) continue;
      INFO(instructions << " periodic " << periodic);
      census.motion = store.motion.data();
      census.owned = owned;
      census.count = lists.contacts();
      census.i = lists.contact_i(), census.j = lists.contact_j();
      choose_kernels(instructions).census(census);
      CHECK(census.touching == touching);
      CHECK(census.largest == Approx(largest).epsilon(1e-12));
      for (int d = 0; d < 3; ++d) CHECK(census.fabric[d] == Approx(fabric[d]).epsilon(1e-12));
    }
  }
}
