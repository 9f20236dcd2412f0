#pragma once
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "particles/aligned.hpp"
#include "particles/particle_rows.hpp"
#include "particles/store.hpp"
#include "particles/sweep.hpp"

namespace silt {

/// What the contacts between particles remember, kept by global ids while particles are reordered, migrate or become
/// ghosts: for every owned particle the partners it touches, {partner's id, history seen from the lower id}.
class ContactMemory {
 public:
  explicit ContactMemory(int components) : rows(1 + components) {}
  ParticleRows rows;
  /// Whether a contact of two particles of this rank stands in the row of one of them only, that which find_pairs()
  /// asks: enough while both stay.
  bool once = false;
  /// Then gives the other its row too. `id`: of the particles of this rank.
  void complete(const std::vector<std::int64_t>& id);
  int components() const { return rows.width - 1; }
  /// The history of particle p with `other`, or null when they did not touch.
  const double* find(int p, std::int64_t other) const {
    for (int k = rows.start[p]; k < rows.start[p + 1]; ++k)
      if (std::bit_cast<std::int64_t>(rows.row(k)[0]) == other) return rows.row(k) + 1;
    return nullptr;
  }
};

/// The pairs of particles that touch, with packed history, and the candidates: pairs near enough to touch before the
/// next rebuild. In both, i is the particle with the lower global id, so that all ranks that know a pair compute the
/// same bits.
///
/// Candidates wait in a calendar. A pair with a gap g cannot touch before both particles together may have come that
/// far, and nobody looks at it until then; found apart, it is filed again by the gap it has. Time in the calendar is
/// twice the way that the fastest particle of every step has come since the lists were made, in skins.
class ContactLists {
 public:
  explicit ContactLists(int components) : components_(components) {}

  int contacts() const { return contacts_; }
  int candidates() const { return candidates_; }
  const int* contact_i() const { return contact_i_.data(); }
  const int* contact_j() const { return contact_j_.data(); }
  double& history(int component, int contact) { return history_[component * stride_ + contact]; }
  double history(int component, int contact) const { return history_[component * stride_ + contact]; }
  int components() const { return components_; }

  /// What the contacts remember, for every owned particle of the store the lists belong to.
  void gather(const Store& store, ContactMemory& memory) const;
  /// The same with each contact once, for particles about to be reordered: p becomes new_place[p] (empty: p stays).
  void gather_once(const Store& store, const std::vector<int>& new_place, ContactMemory& memory) const;
  /// Empties the lists; the clock of the calendar begins anew.
  void clear();
  /// Room for so many contacts, no more.
  void reserve(int contacts);
  /// A new candidate; `gap` is what it lacks to a contact, in skins (below 0: it is one).
  void add_candidate(int i, int j, double gap) {
    ++candidates_;
    file(i, j, gap > 0 ? gap * pages_a_skin : 0);
  }
  /// With the history it had, or null for a new contact.
  void add_contact(int i, int j, const double* history, std::size_t history_step);

  /// From now on the lists are padded to whole packs with the pair (padding, padding + 1), and contacts with a ghost, a
  /// particle from number `owned` on, stand first.
  void pad(int padding, int owned);
  PairArrays pairs();
  /// The first pack of contacts without a ghost.
  int first_inner() const { return (with_ghost_ + pad_to - 1) / pad_to * pad_to; }
  /// The end of the packs that are full.
  int last_full() const { return contacts_ / pad_to * pad_to; }
  /// Looks at the candidates that may touch once the fastest particles have come `moved` skins since the lists were
  /// made (steps added up): `measure` gives their gaps; those with gaps below 0 become contacts, the others are filed
  /// by them. `sweep`: all but the pairs.
  void look(CandidateSweep& sweep, double moved, double skin, void (*measure)(CandidateSweep&));
  int looked_at() const { return looked_at_; }  ///< pairs, in the last look()
  /// A bit for each contact, for the sweep to mark those that ended; `more`: new contacts have come since the last
  /// call, whose marks stay, otherwise all are clear.
  unsigned char* leaving(bool more = false);
  /// Moves the marked contacts, `count` of them, to the candidates, and the new ones with a ghost to the first.
  void leave(int count);
  /// Memory by array, as counted by its containers. B
  std::size_t contact_bytes() const;
  std::size_t candidate_bytes() const;

 private:
  struct Pair {
    int i, j;
  };
  /// The calendar has pages of equal time; it goes round, so that no pair may be filed further ahead than a round.
  static constexpr int pages_a_skin = 32, pages = 64;

  static constexpr int pad_to = 8;  ///< the widest pack
  void make_room(int count);
  /// Contact `to` becomes what contact `from` is.
  void copy(int from, int to);
  void bring_ghosts_forward();
  void pad_contacts();
  void file(int i, int j, double due) {
    const auto page = static_cast<long long>(due);
    if (page <= open_page_) return add_due(i, j);
    page_[(page < open_page_ + pages - 1 ? page : open_page_ + pages - 1) % pages].push_back({i, j});
  }
  void add_due(int i, int j);

  int components_, contacts_ = 0, candidates_ = 0, padding_ = 0, owned_ = 0;
  int with_ghost_ = 0;  ///< contacts with a ghost among those in order, the first
  int in_order_ = 0;    ///< contacts that stand in order, before those that have come since the last leave()
  std::size_t stride_ = 0;
  Aligned<int> contact_i_, contact_j_;
  Aligned<double> history_;  ///< [components][stride]
  std::array<std::vector<Pair>, pages> page_;
  std::size_t filed_[pages] = {};  ///< pairs of each page when the lists had been made
  long long open_page_ = 0;        ///< all up to this are in the due list
  double now_ = 0;                 ///< in pages
  int due_count_ = 0;
  Aligned<int> due_i_, due_j_;
  Aligned<double> gap_;  ///< m, of those measured at once
  int looked_at_ = 0;
  std::vector<unsigned char> leaving_;
};

}  // namespace silt
