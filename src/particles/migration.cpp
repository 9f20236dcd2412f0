#include "particles/migration.hpp"

#include <algorithm>
#include <cstring>

#include "base/error.hpp"
#include "base/petsc.hpp"

namespace silt {

/// The fixed part of a travelling particle; its fluid action (where there is one), its columns and its rows of contact
/// memory follow it.
struct Migration::Packet {
  std::int64_t id;
  Body body;
  Load carried;
  int cell, actions, contact_rows, wall_rows;
};

namespace {

/// Adds the periods that bring the particle back into the box.
void wrap(const Locator& locator, const Place& place, Motion& motion) {
  for (int d = 0; d < 3; ++d)
    if (place.wrap[d] != 0) motion.position[d] += place.wrap[d] * locator.period()[d];
}

/// Fills `values`, which may be empty, from bytes.
void take(const char* bytes, std::vector<double>& values) {
  std::copy_n(bytes, values.size() * sizeof(double), reinterpret_cast<char*>(values.data()));
}

template <class T>
void put(std::vector<char>& buffer, const T* from, std::size_t count) {
  const auto* bytes = reinterpret_cast<const char*>(from);
  buffer.insert(buffer.end(), bytes, bytes + count * sizeof(T));
}

}  // namespace

void Migration::exchange(std::vector<std::vector<char>>& outgoing, std::vector<char>& incoming) {
  const int size = static_cast<int>(outgoing.size());
  std::vector<int> sends(size), receives(size);
  for (int rank = 0; rank < size; ++rank) sends[rank] = static_cast<int>(outgoing[rank].size());
  MPI_Alltoall(sends.data(), 1, MPI_INT, receives.data(), 1, MPI_INT, communicator_);
  std::size_t total = 0;
  for (const int bytes : receives) total += bytes;
  incoming.resize(total);
  std::vector<MPI_Request> requests;
  constexpr int tag = 73;
  std::size_t at = 0;
  for (int rank = 0; rank < size; ++rank)
    if (receives[rank] > 0) {
      MPI_Irecv(incoming.data() + at, receives[rank], MPI_BYTE, rank, tag, communicator_, &requests.emplace_back());
      at += receives[rank];
    }
  for (int rank = 0; rank < size; ++rank)
    if (sends[rank] > 0)
      MPI_Isend(outgoing[rank].data(), sends[rank], MPI_BYTE, rank, tag, communicator_, &requests.emplace_back());
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  for (auto& buffer : outgoing) buffer.clear();
}

/// Calls act(particle, its place) for those not well inside the cell they were in.
template <class Act>
void Migration::each_on_the_move(const Store& store, Act&& act) const {
  constexpr int block = 256, stride = sizeof(Motion) / sizeof(double);
  unsigned char inside[block];
  for (int first = 0; first < store.owned; first += block) {
    const int count = std::min(block, store.owned - first);
    locator_.well_inside(store.motion[first].position, stride, &store.cell[first], count, inside);
    for (int k = 0; k < count; ++k)
      if (!inside[k]) act(first + k, locator_.find(store.motion[first + k].position, store.cell[first + k]));
  }
}

bool Migration::within_periods(const double* x) const {
  for (int d = 0; d < 3; ++d)
    if (mesh_.periodic[d] && !(x[d] >= mesh_.lower[d] && x[d] <= mesh_.upper[d])) return false;
  return true;
}

bool Migration::all_at_home(Store& store, bool strays) {
  std::vector<std::pair<int, int>> moved;  // who came into which cell
  bool away = false;
  each_on_the_move(store, [&](int p, const Place& place) {
    if (strays && place.state == Place::State::remote && within_periods(store.motion[p].position)) return;
    // A wrap moves the particle by a period, and with it the frame its neighbours' lists were built in.
    away = away || !place.inside() || place.wrap != std::array<int, 3>{0, 0, 0};
    moved.emplace_back(p, place.cell);
  });
  if (mpi_any(away)) return false;
  for (const auto& [p, cell] : moved) store.cell[p] = cell;
  return true;
}

bool Migration::any_away(Store& store) {
  away_.clear();
  each_on_the_move(store, [&](int p, const Place& place) {
    if (place.inside()) {
      store.cell[p] = place.cell;
      wrap(locator_, place, store.motion[p]);
    } else {
      away_.push_back({p, place});
    }
  });
  return mpi_any(!away_.empty());
}

std::vector<Gone> Migration::run(Store& store, Aligned<Load>& carried, ParticleRows& contacts, ParticleRows& walls) {
  const int size = mpi_size();
  store.ghosts = 0;
  store.id.resize(store.owned);

  struct Traveller {
    std::vector<char> bytes;  ///< packet and rows
    Place place;
    Packet packet() const {
      Packet packet;
      std::memcpy(&packet, bytes.data(), sizeof packet);
      return packet;
    }
  };
  std::vector<Traveller> lost_sight;  // neither here nor surely on one other rank
  std::vector<std::vector<char>> outgoing(size);
  std::vector<double> row(store.columns.width());
  for (const auto& [p, place] : away_) {
    Traveller traveller{{}, place};
    const Packet packet{store.id[p],    store.body(p),    carried[p],   store.cell[p],
                        store.acted_on, contacts.rows(p), walls.rows(p)};
    put(traveller.bytes, &packet, 1);
    if (store.acted_on) put(traveller.bytes, &store.action[p], 1);
    store.columns.gather(p, row.data());
    put(traveller.bytes, row.data(), row.size());
    put(traveller.bytes, contacts.row(contacts.start[p]),
        static_cast<std::size_t>(packet.contact_rows) * contacts.width);
    put(traveller.bytes, walls.row(walls.start[p]), static_cast<std::size_t>(packet.wall_rows) * walls.width);
    if (place.state == Place::State::remote)
      put(outgoing[place.rank], traveller.bytes.data(), traveller.bytes.size());
    else
      lost_sight.push_back(std::move(traveller));
  }
  if (!away_.empty()) {
    std::vector<int> staying;
    staying.reserve(store.owned);
    auto next = away_.begin();
    for (int p = 0; p < store.owned; ++p)
      if (next != away_.end() && next->particle == p)
        ++next;
      else
        staying.push_back(p);
    store.reorder(staying, carried);
    contacts.reorder(staying);
    walls.reorder(staying);
    away_.clear();
  }

  std::vector<char> incoming;
  bool vanished = false;
  const auto receive = [&](bool settled) {
    exchange(outgoing, incoming);
    for (std::size_t at = 0; at < incoming.size();) {
      Packet packet;
      std::memcpy(&packet, incoming.data() + at, sizeof packet);
      const std::size_t head = sizeof packet + packet.actions * sizeof(FluidAction);
      const std::size_t bytes =
          head + sizeof(double) * (row.size() + static_cast<std::size_t>(packet.contact_rows) * contacts.width +
                                   static_cast<std::size_t>(packet.wall_rows) * walls.width);
      // What settle() said is final, also where a tie would send the particle on.
      const Place place = settled ? locator_.held(vec3(packet.body.position)) : locator_.find(packet.body.position);
      if (place.inside()) {
        wrap(locator_, place, packet.body);
        const int p = store.owned++;
        store.reserve(store.owned);
        store.set_body(p, packet.body);
        store.present[p] = store.previous[p] = Load{};
        carried[p] = packet.carried;
        store.id.push_back(packet.id);
        store.cell.push_back(place.cell);
        if (packet.actions) store.want_actions();
        if (store.acted_on) store.action.resize(store.owned);
        if (packet.actions) std::memcpy(&store.action[p], incoming.data() + at + sizeof packet, sizeof(FluidAction));
        std::vector<double> rows((bytes - head) / sizeof(double));
        take(incoming.data() + at + head, rows);
        store.columns.scatter(p, rows.data());
        contacts.append(rows.data() + row.size(), packet.contact_rows);
        walls.append(rows.data() + row.size() + static_cast<std::size_t>(packet.contact_rows) * contacts.width,
                     packet.wall_rows);
      } else {
        vanished |= settled;
        Traveller traveller;
        traveller.bytes.assign(incoming.begin() + at, incoming.begin() + at + bytes);
        traveller.place = place;
        lost_sight.push_back(std::move(traveller));
      }
      at += bytes;
    }
  };
  receive(false);

  std::vector<Gone> gone;
  if (!mpi_any(!lost_sight.empty())) return gone;
  std::vector<Vec3> points;
  points.reserve(lost_sight.size());
  for (const auto& traveller : lost_sight) points.push_back(vec3(traveller.packet().body.position));
  const std::vector<Place> places = locator_.settle(points);
  for (std::size_t k = 0; k < places.size(); ++k) {
    if (places[k].state == Place::State::boundary) {
      const Packet packet = lost_sight[k].packet();
      const Place& first = lost_sight[k].place;
      FluidAction action;
      if (packet.actions) std::memcpy(&action, lost_sight[k].bytes.data() + sizeof packet, sizeof action);
      take(lost_sight[k].bytes.data() + sizeof packet + packet.actions * sizeof action, row);
      const int boundary = first.state == Place::State::boundary ? first.boundary : places[k].boundary;
      gone.push_back({packet.id, packet.body, packet.carried, action, packet.cell, boundary, row});
    } else {
      const int rank = places[k].inside() ? mpi_rank() : places[k].rank;
      put(outgoing[rank], lost_sight[k].bytes.data(), lost_sight[k].bytes.size());
    }
  }
  receive(true);
  if (mpi_any(vanished)) throw RunError("a particle was sent to the rank that holds it, and was not found there");
  return gone;
}

}  // namespace silt
