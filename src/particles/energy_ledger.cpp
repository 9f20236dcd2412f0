#include "particles/energy_ledger.hpp"

#include <algorithm>
#include <cmath>

namespace silt {
namespace {

using Account = Particles::EnergyAccount;

/// What an entry of a trace says of one contact.
struct Exerted {
  double normal;       ///< N, of the normal law
  Vec3 force, couple;  ///< N, N m, all that acts on i
  Exerted(const double* trace, std::size_t stride, int k)
      : normal(trace[k]),
        force(trace[stride + k], trace[2 * stride + k], trace[3 * stride + k]),
        couple(trace[4 * stride + k], trace[5 * stride + k], trace[6 * stride + k]) {}
};

/// Adds the power on one body: `at_centre` moves with the force along the normal, `at_contact` with that across it,
/// `spin` with the couple.
void add_power(const Exerted& on, const Vec3& normal, double elastic, const Vec3& at_centre, const Vec3& at_contact,
               const Vec3& spin, bool extended, Account::Work& power) {
  const double total = on.force.dot(normal), along = at_centre.dot(normal);
  power[Account::elastic] += elastic * along;
  power[Account::damping] += (on.normal - elastic) * along;
  power[Account::adhesion] += (total - on.normal) * along;
  power[Account::friction] += (on.force - total * normal).dot(at_contact);
  if (!extended) return;
  const double twist = on.couple.dot(normal);
  power[Account::twisting] += twist * spin.dot(normal);
  power[Account::rolling] += (on.couple - twist * normal).dot(spin);
}

// Gauss-Legendre points and weights on [0, 1]; exact for t^11.
constexpr double gauss_at[6] = {0.0337652428984240, 0.1693953067668677, 0.3806904069584015,
                                0.6193095930415985, 0.8306046932331323, 0.9662347571015760};
constexpr double gauss_weight[6] = {0.0856622461895852, 0.1803807865240693, 0.2339569672863455,
                                    0.2339569672863455, 0.1803807865240693, 0.0856622461895852};

/// Whether the force at rest is one of the overlap alone: the law remembers nothing but whether the surfaces meet.
template <class Model>
constexpr bool has_spring = std::is_empty_v<typename Model::template History<double>> || requires {
  Model::jumps;
};

}  // namespace

EnergyLedger::EnergyLedger(Columns& columns)
    : column_(columns.add({.name = "energy_before", .width = 6, .output = false, .needed = false})) {}

double EnergyLedger::energy(const Body& body) {
  const double inertia = 0.4 * body.radius * body.radius;
  return 0.5 / body.inverse_mass * (vec3(body.velocity).squaredNorm() + inertia * vec3(body.spin).squaredNorm());
}

void EnergyLedger::trace(PairSweep& sweep) {
  pair_stride_ = sweep.pairs.stride;
  pair_trace_.reserve(trace_width * pair_stride_);
  sweep.trace = pair_trace_.data();
  sweep.laws.traced = true;
}

void EnergyLedger::trace(WallSweep& sweep) {
  wall_stride_ = sweep.stride;
  wall_trace_.reserve(trace_width * wall_stride_);
  sweep.trace = wall_trace_.data();
  sweep.laws.traced = true;
}

void EnergyLedger::before_fields(const Store& store) {
  field_.assign(store.present.data(), store.present.data() + store.owned);
}

void EnergyLedger::after_fields(const Store& store) {
  for (int p = 0; p < store.owned; ++p)
    for (int d = 0; d < 3; ++d) {
      field_[p].force[d] = store.present[p].force[d] - field_[p].force[d];
      field_[p].torque[d] = store.present[p].torque[d] - field_[p].torque[d];
    }
}

void EnergyLedger::begin(Store& store) {
  for (int p = 0; p < store.owned; ++p) {
    double* before = store.columns.row(column_, p);
    for (int d = 0; d < 3; ++d) {
      before[d] = store.motion[p].velocity[d];
      before[3 + d] = store.rotation[p].spin[d];
    }
  }
}

void EnergyLedger::went_from(const Body& body, const std::vector<double>& columns, const Columns& where) {
  Body before = body;
  const double* row = columns.data() + where.offset(column_);
  for (int d = 0; d < 3; ++d) {
    before.velocity[d] = row[d];
    before.spin[d] = row[3 + d];
  }
  went(before);
}

void EnergyLedger::kicked(const Motion& motion, const Vec3& impulse) {
  work_[Account::fluid] += impulse.dot(vec3(motion.velocity)) + 0.5 * motion.inverse_mass * impulse.squaredNorm();
}

void EnergyLedger::restart(const Store& store) {
  work_ = {};
  for (int p = 0; p < store.owned; ++p) came(store.body(p));
  work_[Account::added] += stored_;
}

void EnergyLedger::add_state(const State& state) {
  for (std::size_t m = 0; m < work_.size(); ++m) {
    work_[m] += state.work[m];
    power_[m] += state.power[m];
  }
  stored_ += state.stored;
}

void EnergyLedger::working_motion(const EnergyStep& step, int p, Vec3& velocity, Vec3& spin) const {
  const Motion& motion = step.store.motion[p];
  velocity = vec3(motion.velocity), spin = vec3(step.store.rotation[p].spin);
  if (step.pass.late_share > 0) return;
  const Load& load = step.store.present[p];
  const double inverse_inertia = 2.5 * motion.inverse_mass / (motion.radius * motion.radius);
  for (int d = 0; d < 3; ++d) {
    velocity[d] += 0.5 * step.h * step.pass.move[d] * (load.force[d] * motion.inverse_mass + step.pass.gravity[d]);
    spin[d] += 0.5 * step.h * step.pass.turn[d] * inverse_inertia * load.torque[d];
  }
}

template <class ContactAt>
void EnergyLedger::find_elastic(const ContactLaws& laws, int count, ContactAt&& contact_at, Elastic& elastic) const {
  elastic.force.assign(count, 0);
  elastic.energy.assign(count, 0);
  elastic.damped.assign(count, 1);
  const int materials = laws.setup().materials;
  std::visit(
      [&](const auto& model) {
        using Model = std::decay_t<decltype(model)>;
        using Constants = typename Model::template Constants<double>;
        using History = typename Model::template History<double>;
        elastic.potential = has_spring<Model> && !requires(const Constants& c, const Encounter& e) {
          model.reach(c, e);
        };
        std::vector<Constants> constants;
        for (int a = 0; a < materials; ++a)
          for (int b = 0; b < materials; ++b) constants.push_back(model.constants(laws.pair(a, b)));
        for (int k = 0; k < count; ++k) {
          int pair = 0;
          Contact<double> contact = contact_at(k, pair);
          if constexpr (has_spring<Model>) {
            History none{};
            const auto at_speed = [&](double approach) {
              contact.approach = approach;
              return Model::template load<double>(contact, constants[pair], none).force;
            };
            elastic.damped[k] = at_speed(1) != at_speed(-1);
            elastic.force[k] = at_speed(0);
            if (!elastic.potential || contact.overlap <= 0) continue;
            // With the overlap x t^2 the forces of the laws are smooth in t.
            const double x = contact.overlap, distance = contact.distance + x;
            for (int q = 0; q < 6; ++q) {
              contact.overlap = x * gauss_at[q] * gauss_at[q];
              contact.distance = distance - contact.overlap;
              elastic.energy[k] += gauss_weight[q] * 2 * x * gauss_at[q] *
                                   Model::template load<double>(contact, constants[pair], none).force;
            }
          }
        }
      },
      laws.normal());
}

void EnergyLedger::add_pairs(const EnergyStep& step, Work& power, double& stored) {
  const Store& store = step.store;
  const int count = step.contacts.contacts(), materials = step.laws.setup().materials;
  std::vector<Vec3> normals(count);
  std::vector<double> distances(count);
  find_elastic(
      step.laws, count,
      [&](int k, int& pair) {
        const int i = step.contacts.contact_i()[k], j = step.contacts.contact_j()[k];
        const Motion &a = store.motion[i], &b = store.motion[j];
        Vec3 apart = vec3(a.position) - vec3(b.position);
        for (int d = 0; d < 3; ++d)
          apart[d] -= step.periods.length[d] * std::nearbyint(apart[d] * step.periods.inverse[d]);
        Contact<double> contact{};
        contact.distance = distances[k] = apart.norm();
        normals[k] = apart / contact.distance;
        contact.overlap = a.radius + b.radius - contact.distance;
        contact.effective_radius = a.radius * b.radius / (a.radius + b.radius);
        contact.effective_mass = 1 / (a.inverse_mass + b.inverse_mass);
        contact.radius = a.radius;
        pair = static_cast<int>(store.rotation[i].material) * materials + static_cast<int>(store.rotation[j].material);
        return contact;
      },
      elastic_);
  const bool extended = step.laws.setup().extended;
  for (int k = 0; k < count; ++k) {
    const Exerted on_i(pair_trace_.data(), pair_stride_, k);
    Exerted on_j = on_i;
    on_j.force = -on_i.force, on_j.couple = -on_i.couple;
    const Vec3& n = normals[k];
    const int i = step.contacts.contact_i()[k], j = step.contacts.contact_j()[k];
    const bool both[2] = {i < store.owned, j < store.owned};
    const double elastic = elastic_.of(k, on_i.normal);
    const double give = 0.5 * (store.motion[i].radius + store.motion[j].radius - distances[k]);
    for (int side = 0; side < 2; ++side) {
      if (!both[side]) continue;
      const int p = side == 0 ? i : j;
      Vec3 velocity, spin;
      working_motion(step, p, velocity, spin);
      // The normal of each side points to its own centre, and its arm from there to the contact is -arm n.
      const Vec3 out = side == 0 ? n : Vec3(-n);
      const Vec3 at_contact = velocity - (store.motion[p].radius - give) * spin.cross(out);
      add_power(side == 0 ? on_i : on_j, out, elastic, velocity, at_contact, spin, extended, power);
      stored += 0.5 * elastic_.energy[k];
    }
  }
}

void EnergyLedger::add_walls(const EnergyStep& step, Work& power, double& stored) {
  const Store& store = step.store;
  const auto& points = step.walls.points();
  const int count = step.walls.count(), materials = step.laws.setup().materials;
  find_elastic(
      step.laws, count,
      [&](int k, int& pair) {
        const Body body = store.body(points[k].particle);
        pair = static_cast<int>(body.material) * materials + points[k].material;
        return wall_contact(body, points[k]);
      },
      elastic_);
  const bool extended = step.laws.setup().extended;
  for (int k = 0; k < count; ++k) {
    const WallPoint& point = points[k];
    const Exerted on(wall_trace_.data(), wall_stride_, k);
    const double elastic = elastic_.of(k, on.normal);
    const Vec3 n = vec3(point.normal), wall = vec3(point.velocity);
    Vec3 velocity, spin;
    working_motion(step, point.particle, velocity, spin);
    const Vec3 at_contact = velocity - point.distance * spin.cross(n);
    add_power(on, n, elastic, velocity - wall, at_contact - wall, spin, extended, power);
    power[Account::walls] += on.force.dot(wall);
    stored += elastic_.energy[k];
  }
}

void EnergyLedger::add_singles(const EnergyStep& step, Work& power) {
  const Store& store = step.store;
  const Vec3 gravity(step.pass.gravity[0], step.pass.gravity[1], step.pass.gravity[2]);
  for (int p = 0; p < store.owned; ++p) {
    Vec3 velocity, spin;
    working_motion(step, p, velocity, spin);
    power[Account::gravity] += gravity.dot(velocity) / store.motion[p].inverse_mass;
    if (!field_.empty())
      power[Account::fields] += vec3(field_[p].force).dot(velocity) + vec3(field_[p].torque).dot(spin);
  }
}

void EnergyLedger::add_fluid(const EnergyStep& step) {
  const Store& store = step.store;
  const double late = step.pass.late_share, h = step.h;
  for (int p = 0; p < store.owned; ++p) {
    const Motion& motion = store.motion[p];
    const double *before = store.columns.row(column_, p), *now = store.rotation[p].spin;
    const double mass = 1 / motion.inverse_mass, inertia = 0.4 * mass * motion.radius * motion.radius;
    double work = 0;
    for (int d = 0; d < 3; ++d) {
      const double force = (1 - late) * store.previous[p].force[d] + late * store.present[p].force[d];
      const double torque = (1 - late) * store.previous[p].torque[d] + late * store.present[p].torque[d];
      const double impulse =
          mass * (motion.velocity[d] - before[d]) - h * step.pass.move[d] * (force + mass * step.pass.gravity[d]);
      const double turn = inertia * (now[d] - before[3 + d]) - h * step.pass.turn[d] * torque;
      work += 0.5 * impulse * (motion.velocity[d] + before[d]) + 0.5 * turn * (now[d] + before[3 + d]);
    }
    work_[Account::fluid] += work;
  }
}

void EnergyLedger::account(const EnergyStep& step) {
  if (static_cast<int>(field_.size()) != step.store.owned) field_.clear();
  Work power{};
  double stored = 0;
  add_pairs(step, power, stored);
  const bool potential = elastic_.potential;
  add_walls(step, power, stored);
  add_singles(step, power);
  if (step.fluid && step.h > 0) add_fluid(step);
  const double late = step.pass.late_share;
  if (step.h > 0)
    for (std::size_t m = 0; m < work_.size(); ++m) work_[m] += step.h * ((1 - late) * power_[m] + late * power[m]);
  // Without a potential: what the springs took and have not given back.
  if (!potential) stored = -work_[Account::elastic];
  if (step.h == 0) work_[Account::added] += stored - stored_;
  stored_ = stored;
  power_ = power;
  begin(step.store);
}

}  // namespace silt
