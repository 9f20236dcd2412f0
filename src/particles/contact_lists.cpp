#include "particles/contact_lists.hpp"

#include <cstring>

namespace silt {
namespace {
constexpr int pad_to = 8;  // the widest pack
}

void ContactLists::reserve_contacts(int count) {
  const auto needed = static_cast<std::size_t>(count) + 2 * pad_to;
  contact_i_.reserve(needed);
  contact_j_.reserve(needed);
  if (needed <= stride_) return;
  const std::size_t stride = (needed + needed / 4 + 63) / 64 * 64;
  Aligned<double> wider;
  wider.reserve(stride * (components_ > 0 ? components_ : 1));
  for (int c = 0; c < components_; ++c)
    if (contacts_ > 0)
      std::memcpy(wider.data() + c * stride, history_.data() + c * stride_, contacts_ * sizeof(double));
  history_.swap(wider);
  stride_ = stride;
}

void ContactLists::gather(const Store& store, ContactMemory& memory) const {
  ParticleRows& rows = memory.rows;
  rows.start.assign(store.owned + 1, 0);
  const auto each = [&](auto&& visit) {
    for (int k = 0; k < contacts_; ++k) {
      const int i = contact_i_[k], j = contact_j_[k];
      if (i < store.owned) visit(k, i, j);
      if (j < store.owned) visit(k, j, i);
    }
  };
  each([&](int, int p, int) { ++rows.start[p + 1]; });
  for (int p = 0; p < store.owned; ++p) rows.start[p + 1] += rows.start[p];
  rows.entries.resize(static_cast<std::size_t>(rows.start[store.owned]) * rows.width);
  std::vector<int> at(rows.start.begin(), rows.start.end() - 1);
  each([&](int k, int p, int partner) {
    double* row = rows.row(at[p]++);
    row[0] = std::bit_cast<double>(store.id[partner]);
    for (int c = 0; c < components_; ++c) row[1 + c] = history_[c * stride_ + k];
  });
}

void ContactLists::sort_candidates() {
  candidates_ = static_cast<int>(unsorted_.size());
  candidate_i_.reserve(static_cast<std::size_t>(candidates_) + 2 * pad_to);
  candidate_j_.reserve(static_cast<std::size_t>(candidates_) + 2 * pad_to);
  int at[groups + 1] = {};
  for (const Unsorted& pair : unsorted_) ++at[pair.group + 1];
  for (int g = 0; g < groups; ++g) at[g + 1] += at[g];
  for (int g = 0; g <= groups; ++g) start_[g] = at[g];
  for (const Unsorted& pair : unsorted_) {
    const int k = at[pair.group]++;
    candidate_i_[k] = pair.i;
    candidate_j_[k] = pair.j;
  }
}

void ContactLists::put_nearest(int i, int j) {
  candidate_i_.reserve(static_cast<std::size_t>(candidates_) + 2 * pad_to);
  candidate_j_.reserve(static_cast<std::size_t>(candidates_) + 2 * pad_to);
  // The first of every further group moves behind its last, which makes room at the end of the nearest.
  int hole = candidates_++;
  for (int g = groups - 1; g > 0; --g) {
    candidate_i_[hole] = candidate_i_[start_[g]];
    candidate_j_[hole] = candidate_j_[start_[g]];
    hole = start_[g]++;
  }
  candidate_i_[hole] = i;
  candidate_j_[hole] = j;
}

void ContactLists::take_out(int place) {
  int group = 0;
  while (group + 1 < groups && start_[group + 1] <= place) ++group;
  // The last of its group takes its place, and so on in every further group.
  for (int hole = place; group < groups; ++group) {
    const int last = (group + 1 < groups ? start_[group + 1] : candidates_) - 1;
    candidate_i_[hole] = candidate_i_[last];
    candidate_j_[hole] = candidate_j_[last];
    hole = last;
    if (group + 1 < groups) --start_[group + 1];
  }
  --candidates_;
}

void ContactLists::add_contact(int i, int j, const double* history, std::size_t history_step) {
  reserve_contacts(contacts_ + 1);
  contact_i_[contacts_] = i;
  contact_j_[contacts_] = j;
  for (int c = 0; c < components_; ++c) history_[c * stride_ + contacts_] = history ? history[c * history_step] : 0.0;
  ++contacts_;
}

void ContactLists::pad_contacts(int dummy) {
  reserve_contacts(contacts_);
  for (int k = contacts_; k < contacts_ + pad_to; ++k) {
    contact_i_[k] = dummy;
    contact_j_[k] = dummy + 1;
    for (int c = 0; c < components_; ++c) history_[c * stride_ + k] = 0;
  }
}

void ContactLists::pad_candidates(int dummy) {
  candidate_i_.reserve(static_cast<std::size_t>(candidates_) + 2 * pad_to);
  candidate_j_.reserve(static_cast<std::size_t>(candidates_) + 2 * pad_to);
  for (int k = candidates_; k < candidates_ + pad_to; ++k) {
    candidate_i_[k] = dummy;
    candidate_j_[k] = dummy + 1;
  }
}

void ContactLists::pad(int dummy) {
  pad_contacts(dummy);
  pad_candidates(dummy);
}

PairArrays ContactLists::pairs() { return {contacts_, contact_i_.data(), contact_j_.data(), history_.data(), stride_}; }

void ContactLists::fill(CandidateSweep& sweep, double moved) {
  if (static_cast<int>(places_.size()) < candidates_ + pad_to) places_.resize(candidates_ + candidates_ / 4 + pad_to);
  // Both may have moved; the share of a group is rounded up.
  const double reached = 2 * moved * groups + 1e-6;
  sweep.count = reached < groups - 1 ? start_[static_cast<int>(reached) + 1] : candidates_;
  sweep.i = candidate_i_.data();
  sweep.j = candidate_j_.data();
  sweep.entering = places_.data();
}

int* ContactLists::leaving() {
  if (static_cast<int>(places_.size()) < contacts_ + pad_to) places_.resize(contacts_ + contacts_ / 4 + pad_to);
  return places_.data();
}

void ContactLists::enter(const int* places, int count, int dummy) {
  if (count == 0) return;
  reserve_contacts(contacts_ + count);
  for (int e = count - 1; e >= 0; --e) {  // from the back, so that the last one moved in is never one of those to move
    const int k = places[e];
    add_contact(candidate_i_[k], candidate_j_[k], nullptr, 0);
    take_out(k);
  }
  pad(dummy);
}

void ContactLists::leave(const int* places, int count, int dummy) {
  if (count == 0) return;
  for (int e = count - 1; e >= 0; --e) {
    const int k = places[e];
    put_nearest(contact_i_[k], contact_j_[k]);
    --contacts_;
    contact_i_[k] = contact_i_[contacts_];
    contact_j_[k] = contact_j_[contacts_];
    for (int c = 0; c < components_; ++c) history_[c * stride_ + k] = history_[c * stride_ + contacts_];
  }
  pad(dummy);
}

}  // namespace silt
