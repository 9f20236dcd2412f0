#pragma once
#include <cstring>

#include "gas_box.hpp"
#include "particles/contact_laws.hpp"

namespace silt {

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

/// Calls act(model, constants, history) for the law of a slot and keeps the history.
template <class Any, class Act>
void with_law(const Any& law, const LawStage& stage, const PairProperties& pair, double* history, Act&& act) {
  std::visit(
      [&](const auto& model) {
        using Model = std::decay_t<decltype(model)>;
        using History = typename Model::template History<double>;
        const auto constants = model.constants(pair);
        History memory = unpack<History>(history + stage.first_history);
        act(model, constants, memory);
        pack(memory, history + stage.first_history);
      },
      law);
}

struct Loads {
  Vec3 force, torque_i, torque_j;
  NormalLoad<double> normal;
  double pull = 0;  ///< N, normal force that does not press the surfaces together
};

/// The laws in plain numbers on one contact: the formulas of the headers, without blocks, packs or lists.
inline Loads loads_of(const ContactLaws& laws, Contact<double> contact, const PairProperties& pair, double arm_i,
                      double arm_j, double dt, double* history) {
  contact.dt = dt;
  const LawSetup& setup = laws.setup();
  const Vec3 n = vec3(contact.normal);
  Loads result;
  double tangent[3] = {}, torque[3] = {};
  with_law(laws.normal(), setup.normal, pair, history, [&](const auto& model, const auto& c, auto& memory) {
    result.normal = std::decay_t<decltype(model)>::template load<double>(contact, c, memory);
    result.normal.pull_off = 0;
  });
  if (setup.cohesive) {
    with_law(laws.adhesion(), setup.adhesion, pair, history, [&](const auto& model, const auto& c, auto& memory) {
      std::decay_t<decltype(model)>::template adhere<double>(contact, c, memory, result.normal, result.pull);
    });
    const auto add = [&](const auto& model, const auto& c, const auto& memory) {
      result.pull += std::decay_t<decltype(model)>::template force<double>(contact, c, memory);
    };
    with_law(laws.dlvo(), setup.dlvo, pair, history, add);
    with_law(laws.bridge(), setup.bridge, pair, history, add);
    with_law(laws.interfacial(), setup.interfacial, pair, history, add);
    with_law(laws.lubrication(), setup.lubrication, pair, history, add);
    if (!(result.normal.contact_radius > 0)) {
      result.pull += result.normal.force;
      result.normal.force = result.normal.damping = 0;
      for (int h = setup.tangential.first_history; h < setup.history_components; ++h) history[h] = 0;
    }
  }
  with_law(laws.tangential(), setup.tangential, pair, history, [&](const auto& model, const auto& c, auto& memory) {
    using Model = std::decay_t<decltype(model)>;
    if constexpr (requires { Model::template law<double>(result.normal, c); }) {
      const SpringLaw<double> law = Model::template law<double>(result.normal, c);
      const double rest = grow_spring(contact, law.stiffness, c.least_share, dt, memory.spring);
      limit_spring(contact, result.normal.force, c.friction, law, rest, memory.spring, tangent);
    } else {
      Model::template force<double>(contact, result.normal, c, dt, memory, tangent);
    }
  });
  with_law(laws.rolling(), setup.rolling, pair, history, [&](const auto& model, const auto& c, auto& memory) {
    std::decay_t<decltype(model)>::template torque<double>(contact, result.normal, c, dt, memory, torque);
  });
  with_law(laws.twisting(), setup.twisting, pair, history, [&](const auto& model, const auto& c, auto& memory) {
    const double twist = std::decay_t<decltype(model)>::template torque<double>(contact, result.normal, c, dt, memory);
    for (int d = 0; d < 3; ++d) torque[d] += twist * contact.normal[d];
  });
  result.force = (result.normal.force + result.normal.jump + result.pull) * n + vec3(tangent);
  result.torque_i = (-arm_i * n).cross(result.force) + vec3(torque);
  result.torque_j = (arm_j * n).cross(-result.force) - vec3(torque);
  return result;
}

/// The contact of two spheres, from their motion.
inline Contact<double> contact_of(const Body& a, const Body& b, bool slip_at_radius, double& arm_i, double& arm_j) {
  Contact<double> contact;
  const Vec3 apart = vec3(a.position) - vec3(b.position);
  const double r = apart.norm();
  const Vec3 n = apart / r, relative = vec3(a.velocity) - vec3(b.velocity);
  vec3(contact.normal) = n;
  contact.overlap = a.radius + b.radius - r;
  contact.effective_radius = a.radius * b.radius / (a.radius + b.radius);
  contact.effective_mass = 1 / (a.inverse_mass + b.inverse_mass);
  contact.dt = 0;
  contact.radius = a.radius;
  contact.distance = r;
  const auto inertia = [](const Motion& m) { return 1.4 * m.radius * m.radius / m.inverse_mass; };
  contact.rolling_inertia = 1 / (1 / inertia(a) + 1 / inertia(b));
  arm_i = a.radius - contact.overlap / 2, arm_j = b.radius - contact.overlap / 2;
  contact.approach = -relative.dot(n);
  // Velocities of the two material points at the contact.
  const double from_i = slip_at_radius ? a.radius : arm_i, from_j = slip_at_radius ? b.radius : arm_j;
  const Vec3 at_i = vec3(a.velocity) + Vec3(vec3(a.spin)).cross(-from_i * n);
  const Vec3 at_j = vec3(b.velocity) + Vec3(vec3(b.spin)).cross(from_j * n);
  vec3(contact.slip) = (at_i - at_j) - (at_i - at_j).dot(n) * n;
  vec3(contact.spin) = vec3(a.spin) - vec3(b.spin);
  return contact;
}

inline Loads one_contact(const ContactLaws& laws, const Body& a, const Body& b, double dt, double* history) {
  double arm_i, arm_j;
  const Contact<double> contact = contact_of(a, b, laws.setup().slip_at_radius, arm_i, arm_j);
  const PairProperties pair = laws.pair(static_cast<int>(a.material), static_cast<int>(b.material));
  return loads_of(laws, contact, pair, arm_i, arm_j, dt, history);
}

}  // namespace silt
