#include "particles/liquid_exchange.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <variant>

#include "particles/force_jump.hpp"

namespace silt {
namespace {
constexpr int given_i = 0, given_j = 1, asked = 2, jump = 3;  // CapillaryBridge::History
}

LiquidExchange::LiquidExchange(const ContactLaws& laws, Columns& columns) : setup_(&laws.setup()) {
  law_ = std::get_if<CapillaryBridge>(&laws.bridge());
  if (!law_) return;
  first_ = laws.setup().bridge.first_history;
  const CapillaryBridge* law = law_;
  film_ = columns.add({"film", 1, GhostValues::every_step, true,
                       [law](const Seed& seed, double* row) { row[0] = law->full_film(seed.radius); }});
  demand_ = columns.add({"film_demand", 1, GhostValues::every_step, false});
}

void LiquidExchange::exchange(Store& store, ContactLists& contacts, WallContacts& walls, const Periods& periods,
                              double dt) {
  if (!law_) return;
  double* film = store.columns.values(film_);
  double* demand = store.columns.values(demand_);
  change_.assign(store.owned, 0.0);
  asked_.assign(store.owned, 0.0);
  // What a particle can give to one who asked for `share` of its film: less when others ask for all the rest.
  const auto gift = [&](int p, double share) { return film[p] * share / std::max(1.0, demand[p]); };
  const auto furthest = setup_->leave_gap;
  const CapillaryBridge::Constants<double> constants = law_->constants({});
  const auto force = [&](double gap, double approach, double radius, double from_i, double from_j) {
    Contact<double> contact{};
    contact.overlap = -gap, contact.approach = approach, contact.effective_radius = radius;
    return CapillaryBridge::force<double>(contact, constants, {from_i, from_j, 0, 0});
  };
  const auto since = [&](double past, double speed) { return dt > 0 ? step_share(past, std::abs(speed), dt) : 0; };
  // What the readings before a bridge forms, `waited` steps after touching, and after it breaks have not given.
  const auto formed = [&](double waited, double now) { return dt > 0 ? (waited - 0.5) * now : 0; };
  const auto broken = [&](double past, double speed, double last) {
    return made_good(-last, past, std::abs(speed), dt);
  };

  for (int k = 0; k < contacts.contacts(); ++k) {
    const int i = contacts.contact_i()[k], j = contacts.contact_j()[k];
    double &from_i = contacts.history(first_ + given_i, k), &from_j = contacts.history(first_ + given_j, k);
    double &waiting = contacts.history(first_ + asked, k), &extra = contacts.history(first_ + jump, k);
    extra = 0;
    const Motion &a = store.motion[i], &b = store.motion[j];
    const bool wet = from_i + from_j > 0;
    double apart[3], square = 0;
    for (int d = 0; d < 3; ++d) {
      apart[d] = a.position[d] - b.position[d];
      apart[d] -= periods.length[d] * std::nearbyint(apart[d] * periods.inverse[d]);
      square += apart[d] * apart[d];
    }
    const double distance = std::sqrt(square), gap = distance - a.radius - b.radius;
    const double share_i = CapillaryBridge::film_share(a.radius, b.radius);
    const double share_j = CapillaryBridge::film_share(b.radius, a.radius);
    const double radius = a.radius * b.radius / (a.radius + b.radius);
    double speed = 0;  // of separation
    for (int d = 0; d < 3; ++d) speed += (a.velocity[d] - b.velocity[d]) * apart[d] / distance;
    if (wet) {
      const double end = law_->rupture_distance(from_i + from_j, radius, law_->capillary_number(speed));
      if (gap <= std::min(end, furthest)) continue;
      extra = broken(gap - end, speed, force(end, -speed, radius, from_i, from_j));
      if (i < store.owned) change_[i] += from_i;
      if (j < store.owned) change_[j] += from_j;
      from_i = from_j = 0;
    } else if (waiting > 0) {
      from_i = gift(i, share_i), from_j = gift(j, share_j);
      if (from_i + from_j > 0) extra = formed(waiting, force(gap, -speed, radius, from_i, from_j));
      waiting = 0;
      if (i < store.owned) change_[i] -= from_i;
      if (j < store.owned) change_[j] -= from_j;
    } else if (gap < 0) {
      waiting = 1 + since(-gap, speed);
      if (i < store.owned) asked_[i] += share_i;
      if (j < store.owned) asked_[j] += share_j;
    }
  }

  const double share = CapillaryBridge::film_share(1, 0);
  for (const auto& lost : walls.lost()) change_[lost.particle] += lost.history[first_ + given_i];
  for (int k = 0; k < walls.count(); ++k) {
    const WallPoint& point = walls.points()[k];
    const int p = point.particle;
    double &from = walls.history(first_ + given_i, k), &waiting = walls.history(first_ + asked, k);
    double& extra = walls.history(first_ + jump, k);
    extra = 0;
    const Motion& motion = store.motion[p];
    const double gap = point.distance - motion.radius;
    double speed = 0;
    for (int d = 0; d < 3; ++d) speed += (motion.velocity[d] - point.velocity[d]) * point.normal[d];
    if (from > 0) {
      const double end = law_->rupture_distance(from, motion.radius, law_->capillary_number(speed));
      if (gap <= std::min(end, furthest)) continue;
      extra = broken(gap - end, speed, force(end, -speed, motion.radius, from, 0));
      change_[p] += from;
      from = 0;
    } else if (waiting > 0) {
      from = gift(p, share);
      if (from > 0) extra = formed(waiting, force(gap, -speed, motion.radius, from, 0));
      waiting = 0;
      change_[p] -= from;
    } else if (gap < 0) {
      waiting = 1 + since(-gap, speed);
      asked_[p] += share;
    }
  }
  for (int p = 0; p < store.owned; ++p) {
    film[p] += change_[p];
    demand[p] = asked_[p];
  }
}

void LiquidExchange::forget(Store& store, ContactMemory& memory, const std::vector<Gone>& gone,
                            MPI_Comm communicator) const {
  if (!law_) return;
  std::vector<std::int64_t> mine;
  for (const Gone& one : gone) mine.push_back(one.id);
  int size = 1;
  MPI_Comm_size(communicator, &size);
  const int here = static_cast<int>(mine.size());
  std::vector<int> count(size), start(size, 0);
  MPI_Allgather(&here, 1, MPI_INT, count.data(), 1, MPI_INT, communicator);
  for (int rank = 1; rank < size; ++rank) start[rank] = start[rank - 1] + count[rank - 1];
  std::vector<std::int64_t> departed(start.back() + count.back());
  MPI_Allgatherv(mine.data(), here, MPI_INT64_T, departed.data(), count.data(), start.data(), MPI_INT64_T,
                 communicator);
  double* film = store.columns.values(film_);
  for (int p = 0; p < store.owned; ++p)
    for (int k = memory.rows.start[p]; k < memory.rows.start[p + 1]; ++k) {
      double* row = memory.rows.row(k);
      const auto partner = std::bit_cast<std::int64_t>(row[0]);
      if (std::find(departed.begin(), departed.end(), partner) == departed.end()) continue;
      double* bridge = row + 1 + first_;
      film[p] += bridge[store.id[p] < partner ? given_i : given_j];
      bridge[given_i] = bridge[given_j] = bridge[asked] = bridge[jump] = 0;
    }
}

double LiquidExchange::volume(const Store& store, const ContactLists& contacts, const WallContacts& walls) const {
  if (!law_) return 0;
  double sum = 0;
  const double* film = store.columns.values(film_);
  for (int p = 0; p < store.owned; ++p) sum += film[p];
  for (int k = 0; k < contacts.contacts(); ++k) {
    if (contacts.contact_i()[k] < store.owned) sum += contacts.history(first_ + given_i, k);
    if (contacts.contact_j()[k] < store.owned) sum += contacts.history(first_ + given_j, k);
  }
  for (int k = 0; k < walls.count(); ++k) sum += walls.history(first_ + given_i, k);
  return sum;
}

}  // namespace silt
