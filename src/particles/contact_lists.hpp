#pragma once
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
  int components() const { return rows.width - 1; }
  /// The history of particle p with `other`, or null when they did not touch.
  const double* find(int p, std::int64_t other) const {
    for (int k = rows.start[p]; k < rows.start[p + 1]; ++k)
      if (std::bit_cast<std::int64_t>(rows.row(k)[0]) == other) return rows.row(k) + 1;
    return nullptr;
  }
};

/// The pairs of particles that touch, with packed history, and the pairs near enough to touch before the next rebuild.
/// In both, i is the particle with the lower global id, so that all ranks that know a pair compute the same bits.
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

  /// Candidates stand in groups of growing gap: those of group g are at least g/groups of the skin from touching, so
  /// that they need no test before two particles together may have moved that far.
  static constexpr int groups = 16;

  /// What the contacts remember, for every owned particle of the store the lists belong to.
  void gather(const Store& store, ContactMemory& memory) const;
  void clear() {
    contacts_ = candidates_ = 0;
    unsorted_.clear();
    for (int& start : start_) start = 0;
  }
  /// A pair for sort_candidates(); `gap` is what it lacks to a contact, as a share of the skin.
  void add_candidate(int i, int j, double gap) {
    const int group = static_cast<int>(gap * groups);
    unsorted_.push_back({i, j, group < 0 ? 0 : group >= groups ? groups - 1 : group});
  }
  /// Makes the added pairs the candidates, by group and in the order in which they were added.
  void sort_candidates();
  /// With the history it had, or null for a new contact.
  void add_contact(int i, int j, const double* history, std::size_t history_step);

  /// Pads the lists to whole packs with the dummy pair (dummy, dummy + 1).
  void pad(int dummy);
  PairArrays pairs();
  /// Fills in the candidates that may touch once no particle has moved further than this share of the skin, and room
  /// for the answer.
  void fill(CandidateSweep& sweep, double moved);
  int* leaving();
  /// Moves the candidates at the places found by the sweep to the contacts, and those contacts that ended back.
  void enter(const int* places, int count, int dummy);
  void leave(const int* places, int count, int dummy);

 private:
  void reserve_contacts(int count);
  void pad_contacts(int dummy);
  void pad_candidates(int dummy);
  void put_nearest(int i, int j);
  void take_out(int place);

  int components_, contacts_ = 0, candidates_ = 0;
  std::size_t stride_ = 0;
  Aligned<int> contact_i_, contact_j_, candidate_i_, candidate_j_;
  int start_[groups + 1] = {};  ///< of each group; the last entry is not kept
  struct Unsorted {
    int i, j, group;
  };
  std::vector<Unsorted> unsorted_;
  Aligned<double> history_;  ///< [components][stride]
  std::vector<int> places_;
};

}  // namespace silt
