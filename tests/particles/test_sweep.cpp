#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#include "gas_box.hpp"
#include "particles/contact_laws.hpp"
#include "particles/contact_lists.hpp"

using namespace silt;

namespace {

/// The model's record of doubles (constants, history) from an array, and back.
template <class Struct>
Struct unpack(const double* from) {
  Struct object{};
  if constexpr (!std::is_empty_v<Struct>) std::memcpy(&object, from, sizeof object);
  return object;
}
template <class Struct>
void pack(const Struct& object, double* to) {
  if constexpr (!std::is_empty_v<Struct>) std::memcpy(to, &object, sizeof object);
}

struct Reference {
  Vec3 force, torque_i, torque_j;
};

/// One contact by the laws in plain numbers: the formulas of the headers, without blocks, packs or lists.
Reference one_contact(const ContactLaws& laws, const Materials& materials, const Motion& a, const Motion& b, double dt,
                      double* history) {
  Contact<double> contact;
  const Vec3 apart = vec3(a.position) - vec3(b.position);
  const double r = apart.norm();
  vec3(contact.normal) = apart / r;
  contact.overlap = a.radius + b.radius - r;
  contact.effective_radius = a.radius * b.radius / (a.radius + b.radius);
  contact.effective_mass = 1 / (a.inverse_mass + b.inverse_mass);
  const double arm_i = a.radius - contact.overlap / 2, arm_j = b.radius - contact.overlap / 2;
  const Vec3 n = apart / r, relative = vec3(a.velocity) - vec3(b.velocity);
  contact.approach = -relative.dot(n);
  // Velocities of the two material points at the contact.
  const Vec3 at_i = vec3(a.velocity) + Vec3(vec3(a.spin)).cross(-arm_i * n);
  const Vec3 at_j = vec3(b.velocity) + Vec3(vec3(b.spin)).cross(arm_j * n);
  const Vec3 slip = (at_i - at_j) - (at_i - at_j).dot(n) * n;
  vec3(contact.slip) = slip;
  vec3(contact.spin) = vec3(a.spin) - vec3(b.spin);
  const PairProperties& pair = materials.pair(static_cast<int>(a.material), static_cast<int>(b.material));
  return std::visit(
      [&](const auto& normal, const auto& tangential, const auto& rolling) {
        using N = std::decay_t<decltype(normal)>;
        using T = std::decay_t<decltype(tangential)>;
        using R = std::decay_t<decltype(rolling)>;
        using NH = typename N::template History<double>;
        using TH = typename T::template History<double>;
        using RH = typename R::template History<double>;
        const LawSetup& setup = laws.setup();
        NH nh = unpack<NH>(history);
        TH th = unpack<TH>(history + setup.tangential.first_history);
        RH rh = unpack<RH>(history + setup.rolling.first_history);
        const auto load = N::template load<double>(contact, normal.constants(pair), nh);
        double tangent[3], torque[3];
        T::template force<double>(contact, load, tangential.constants(pair), dt, th, tangent);
        R::template torque<double>(contact, load, rolling.constants(pair), dt, rh, torque);
        pack(nh, history);
        pack(th, history + setup.tangential.first_history);
        pack(rh, history + setup.rolling.first_history);
        const Vec3 force = load.force * n + vec3(tangent);
        return Reference{force, (-arm_i * n).cross(force) + vec3(torque), (arm_j * n).cross(-force) - vec3(torque)};
      },
      laws.normal(), laws.tangential(), laws.rolling());
}

bool can_run(const std::string& name) {
  __builtin_cpu_init();
  return name == "plain" || (name == "avx2" && __builtin_cpu_supports("avx2")) ||
         (name == "avx512" && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"));
}

}  // namespace

TEST_CASE("The blocks of packed contacts give the forces of the laws taken one contact at a time", "[particles]") {
  for (const char* normal : {"tsuji", "linear"})
    for (const char* tangential : {"mindlin", "spring_dashpot"})
      for (const char* rolling : {"none", "constant"})
        for (const bool several : {false, true})
          for (const char* instructions : {"plain", "avx2", "avx512"}) {
            if (!can_run(instructions)) continue;
            Options options;
            options.set("material_bead_density", "2500");
            options.set("material_bead_rolling_friction", "0.1");
            if (several) {
              options.set("material_rock_density", "3000");
              options.set("material_rock_young_modulus", "3e8");
              options.set("pair_bead_rock_friction", "0.7");
            }
            options.set("normal_type", normal);
            options.set("tangential_type", tangential);
            options.set("rolling_type", rolling);
            if (std::string(normal) == "linear") options.set("normal_stiffness", "1e4");
            if (std::string(tangential) == "spring_dashpot") options.set("tangential_stiffness", "3e3");
            const Materials materials(options);
            const ContactLaws laws(options, materials);

            constexpr int count = 203;  // not a multiple of the block or of any pack
            const int components = laws.history_components();
            Store store;
            store.owned = 2 * count;
            store.reserve(store.owned);
            store.id.resize(store.owned);
            Random random(7);
            for (int p = 0; p < store.owned; ++p) {
              Motion& m = store.motion[p];
              m = Motion{};
              m.radius = random(0.4e-3, 1.2e-3);
              m.material = several ? std::floor(random(0, 2)) : 0;
              m.inverse_mass = 1 / (*materials[static_cast<int>(m.material)].density * 4.18879 * std::pow(m.radius, 3));
              vec3(m.velocity) = random.vector(0.5);
              vec3(m.spin) = random.vector(500);
              vec3(m.position) = random.vector(1e-2);
              if (p % 2) {
                const Motion& other = store.motion[p - 1];
                const Vec3 n = random.vector(1).normalized();
                const double overlap = random(-0.05, 0.2) * std::min(m.radius, other.radius);  // some do not touch
                vec3(m.position) = vec3(other.position) + (m.radius + other.radius - overlap) * n;
              }
            }
            store.place_dummies();
            ContactLists lists(components);
            std::vector<std::vector<double>> history(count, std::vector<double>(components + 1));
            for (int k = 0; k < count; ++k) {
              for (double& h : history[k]) h = random(-1e-6, 1e-6);
              lists.add_contact(2 * k, 2 * k + 1, history[k].data(), 1);
            }
            lists.pad(store.dummy());
            PairSweep sweep;
            sweep.motion = store.motion.data();
            sweep.load = store.present.data();
            sweep.pairs = lists.pairs();
            sweep.laws = laws.setup();
            sweep.dt = 1e-6;
            sweep.leaving = lists.leaving();
            choose_kernels(instructions).pairs(sweep);

            INFO(normal << " " << tangential << " " << rolling << " " << instructions << " several " << several);
            int apart = 0;
            double largest = 0, difference = 0, longest = 0, spring_difference = 0;
            for (int k = 0; k < count; ++k) {
              const Motion &a = store.motion[2 * k], &b = store.motion[2 * k + 1];
              const Reference expected = one_contact(laws, materials, a, b, sweep.dt, history[k].data());
              const Load &on_i = store.present[2 * k], &on_j = store.present[2 * k + 1];
              const double scale = expected.force.norm();
              largest = std::max(largest, scale);
              difference = std::max(difference, (vec3(on_i.force) - expected.force).norm());
              difference = std::max(difference, (vec3(on_j.force) + expected.force).norm());
              difference = std::max(difference, (vec3(on_i.torque) - expected.torque_i).norm() / a.radius);
              difference = std::max(difference, (vec3(on_j.torque) - expected.torque_j).norm() / b.radius);
              for (int c = 0; c < components; ++c) longest = std::max(longest, std::abs(history[k][c]));
              for (int c = 0; c < components; ++c)
                spring_difference = std::max(spring_difference, std::abs(lists.history(c, k) - history[k][c]));
              apart += (vec3(a.position) - vec3(b.position)).norm() >= a.radius + b.radius;
            }
            CHECK(largest > 0);
            CHECK(difference < 1e-12 * largest);
            CHECK(spring_difference < 1e-12 * longest);
            CHECK(longest < 1e-2);
            CHECK(sweep.leaving_count == apart);
          }
}

TEST_CASE("A contact law never adds energy over a loading and unloading, and vanishes when the spheres part",
          "[particles]") {
  for (const char* normal : {"tsuji", "linear"}) {
    Options options;
    options.set("material_bead_density", "2500");
    options.set("normal_type", normal);
    if (std::string(normal) == "linear") options.set("normal_stiffness", "1e4");
    const Materials materials(options);
    const ContactLaws laws(options, materials);
    std::visit(
        [&](const auto& model) {
          using Model = std::decay_t<decltype(model)>;
          const auto constants = model.constants(materials.pair(0, 0));
          typename Model::template History<double> history{};
          Contact<double> contact{};
          contact.effective_radius = 0.5e-3, contact.effective_mass = 1e-6;
          double work = 0;
          const double depth = 1e-5;
          const int steps = 2000;
          for (int k = 0; k < 2 * steps; ++k) {
            const bool loading = k < steps;
            contact.overlap = depth * (loading ? k + 0.5 : 2 * steps - k - 0.5) / steps;
            contact.approach = loading ? 0.1 : -0.1;
            work +=
                Model::template load<double>(contact, constants, history).force * (loading ? 1 : -1) * depth / steps;
          }
          CHECK(work > 0);
          contact.overlap = 0;
          CHECK(Model::template load<double>(contact, constants, history).force == 0);
          contact.overlap = -1e-6;
          CHECK(Model::template load<double>(contact, constants, history).force == 0);
        },
        laws.normal());
  }
}
