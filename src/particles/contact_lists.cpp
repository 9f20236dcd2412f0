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

void ContactLists::add_candidate(int i, int j) {
  candidate_i_.reserve(static_cast<std::size_t>(candidates_) + 2 * pad_to);
  candidate_j_.reserve(static_cast<std::size_t>(candidates_) + 2 * pad_to);
  candidate_i_[candidates_] = i;
  candidate_j_[candidates_++] = j;
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

void ContactLists::fill(CandidateSweep& sweep) {
  if (static_cast<int>(places_.size()) < candidates_ + pad_to) places_.resize(candidates_ + candidates_ / 4 + pad_to);
  sweep.count = candidates_;
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
    --candidates_;
    candidate_i_[k] = candidate_i_[candidates_];
    candidate_j_[k] = candidate_j_[candidates_];
  }
  pad(dummy);
}

void ContactLists::leave(const int* places, int count, int dummy) {
  if (count == 0) return;
  for (int e = count - 1; e >= 0; --e) {
    const int k = places[e];
    add_candidate(contact_i_[k], contact_j_[k]);
    --contacts_;
    contact_i_[k] = contact_i_[contacts_];
    contact_j_[k] = contact_j_[contacts_];
    for (int c = 0; c < components_; ++c) history_[c * stride_ + k] = history_[c * stride_ + contacts_];
  }
  pad(dummy);
}

}  // namespace silt
