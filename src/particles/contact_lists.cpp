#include "particles/contact_lists.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <unordered_map>

namespace silt {
void ContactLists::reserve(int count) {
  const auto needed = static_cast<std::size_t>(count) + 2 * pad_to;
  if (needed <= stride_) return;
  const std::size_t stride = (needed + 63) / 64 * 64;
  contact_i_.reserve(stride);
  contact_j_.reserve(stride);
  Aligned<double> wider;
  wider.reserve(stride * (components_ > 0 ? components_ : 1));
  for (int c = 0; c < components_; ++c)
    if (contacts_ > 0)
      std::memcpy(wider.data() + c * stride, history_.data() + c * stride_, contacts_ * sizeof(double));
  history_.swap(wider);
  stride_ = stride;
}

void ContactLists::make_room(int count) {
  if (static_cast<std::size_t>(count) + 2 * pad_to > stride_) reserve(count + count / 8 + 64);
}

void ContactLists::clear() {
  contacts_ = candidates_ = due_count_ = with_ghost_ = in_order_ = 0;
  open_page_ = 0;
  now_ = 0;
  // The next lists will be about as long, so that they need not grow.
  for (int k = 0; k < pages; ++k) {
    page_[k].clear();
    page_[k].reserve(filed_[k] + filed_[k] / 16);
  }
}

void ContactLists::gather(const Store& store, ContactMemory& memory) const {
  ParticleRows& rows = memory.rows;
  memory.once = false;
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

void ContactMemory::complete(const std::vector<std::int64_t>& id) {
  if (!once) return;
  once = false;
  const int particles = static_cast<int>(rows.start.size()) - 1;
  std::unordered_map<std::int64_t, int> place;
  for (int p = 0; p < particles; ++p) place[id[p]] = p;
  const auto each = [&](auto&& visit) {
    for (int p = 0; p < particles; ++p)
      for (int k = rows.start[p]; k < rows.start[p + 1]; ++k) {
        visit(p, k, rows.row(k)[0]);
        if (const auto partner = place.find(std::bit_cast<std::int64_t>(rows.row(k)[0])); partner != place.end())
          visit(partner->second, k, std::bit_cast<double>(id[p]));
      }
  };
  ParticleRows both(rows.width);
  both.start.assign(particles + 1, 0);
  each([&](int p, int, double) { ++both.start[p + 1]; });
  for (int p = 0; p < particles; ++p) both.start[p + 1] += both.start[p];
  both.entries.resize(static_cast<std::size_t>(both.start[particles]) * rows.width);
  std::vector<int> at(both.start.begin(), both.start.end() - 1);
  each([&](int p, int k, double partner) {
    double* row = both.row(at[p]++);
    std::copy_n(rows.row(k), rows.width, row);
    row[0] = partner;
  });
  rows = std::move(both);
}

void ContactLists::gather_once(const Store& store, const std::vector<int>& new_place, ContactMemory& memory) const {
  ParticleRows& rows = memory.rows;
  memory.once = true;
  rows.start.assign(store.owned + 1, 0);
  const auto holder = [&](int k) { return contact_i_[k] < store.owned ? contact_i_[k] : contact_j_[k]; };
  const auto place_of = [&](int p) { return new_place.empty() ? p : new_place[p]; };
  for (int k = 0; k < contacts_; ++k) ++rows.start[place_of(holder(k)) + 1];
  for (int p = 0; p < store.owned; ++p) rows.start[p + 1] += rows.start[p];
  rows.entries.resize(static_cast<std::size_t>(contacts_) * rows.width);
  // The starts serve as places to write at and are shifted back.
  for (int k = 0; k < contacts_; ++k) {
    const int p = holder(k), partner = contact_i_[k] + contact_j_[k] - p;
    double* row = rows.row(rows.start[place_of(p)]++);
    row[0] = std::bit_cast<double>(store.id[partner]);
    for (int c = 0; c < components_; ++c) row[1 + c] = history_[c * stride_ + k];
  }
  for (int p = store.owned; p > 0; --p) rows.start[p] = rows.start[p - 1];
  rows.start[0] = 0;
}

void ContactLists::add_due(int i, int j) {
  const auto needed = static_cast<std::size_t>(due_count_) + 2 * pad_to;
  due_i_.reserve(needed);
  due_j_.reserve(needed);
  due_i_[due_count_] = i;
  due_j_[due_count_++] = j;
}

void ContactLists::add_contact(int i, int j, const double* history, std::size_t history_step) {
  make_room(contacts_ + 1);
  contact_i_[contacts_] = i;
  contact_j_[contacts_] = j;
  for (int c = 0; c < components_; ++c) history_[c * stride_ + contacts_] = history ? history[c * history_step] : 0.0;
  ++contacts_;
}

void ContactLists::pad_contacts() {
  make_room(contacts_);
  for (int k = contacts_; k < contacts_ + pad_to; ++k) {
    contact_i_[k] = padding_;
    contact_j_[k] = padding_ + 1;
    for (int c = 0; c < components_; ++c) history_[c * stride_ + k] = 0;
  }
}

void ContactLists::pad(int padding, int owned) {
  padding_ = padding;
  owned_ = owned;
  leaving();
  bring_ghosts_forward();
  for (int k = 0; k < pages; ++k) {
    filed_[k] = page_[k].size();
    if (page_[k].capacity() > filed_[k] + filed_[k] / 8) page_[k].shrink_to_fit();
  }
  pad_contacts();
}

PairArrays ContactLists::pairs() { return {contacts_, contact_i_.data(), contact_j_.data(), history_.data(), stride_}; }

void ContactLists::look(CandidateSweep& sweep, double moved, double skin, void (*measure)(CandidateSweep&)) {
  now_ = (2 * moved + 1e-6) * pages_a_skin;  // both may have moved; rounded up
  const auto reached = static_cast<long long>(now_);
  for (int turned = 0; open_page_ < reached && turned < pages; ++turned) {
    auto& page = page_[++open_page_ % pages];
    for (const Pair& pair : page) add_due(pair.i, pair.j);
    std::vector<Pair>().swap(page);
  }
  open_page_ = std::max(open_page_, reached);
  const auto needed = static_cast<std::size_t>(due_count_) + 2 * pad_to;
  due_i_.reserve(needed);
  due_j_.reserve(needed);
  for (int k = due_count_; k < due_count_ + pad_to; ++k) {
    due_i_[k] = padding_;
    due_j_[k] = padding_ + 1;
  }

  const double scale = pages_a_skin / skin;
  const int due = due_count_, before = contacts_;
  looked_at_ = due;
  due_count_ = 0;
  constexpr int at_once = 512;
  gap_.reserve(at_once + pad_to);
  const double* gap = sweep.gap = gap_.data();
  for (int first = 0; first < due; first += at_once) {
    sweep.count = std::min(at_once, due - first);
    sweep.i = due_i_.data() + first;
    sweep.j = due_j_.data() + first;
    measure(sweep);
    for (int k = 0; k < sweep.count; ++k) {
      const int i = due_i_[first + k], j = due_j_[first + k];  // file() writes no further than here
      if (gap[k] < 0) {
        add_contact(i, j, nullptr, 0);
        --candidates_;
      } else {
        file(i, j, now_ + gap[k] * scale);
      }
    }
  }
  if (contacts_ > before) pad_contacts();
}

unsigned char* ContactLists::leaving(bool more) {
  if (!more) leaving_.clear();
  leaving_.resize(contacts_ / 8 + 1, 0);
  return leaving_.data();
}

void ContactLists::copy(int from, int to) {
  contact_i_[to] = contact_i_[from];
  contact_j_[to] = contact_j_[from];
  for (int c = 0; c < components_; ++c) history_[c * stride_ + to] = history_[c * stride_ + from];
}

void ContactLists::bring_ghosts_forward() {
  make_room(contacts_);
  for (int k = in_order_; k < contacts_; ++k) {
    if (contact_i_[k] < owned_ && contact_j_[k] < owned_) continue;
    const int to = with_ghost_++;
    if (to == k) continue;
    copy(k, contacts_);  // the padding is made anew
    copy(to, k);
    copy(contacts_, to);
    const auto marked = [&](int place) { return leaving_[place / 8] >> place % 8 & 1; };
    if (marked(k) != marked(to))
      for (const int place : {k, to}) leaving_[place / 8] ^= static_cast<unsigned char>(1 << place % 8);
  }
  in_order_ = contacts_;
}

void ContactLists::leave(int count) {
  const bool moved = in_order_ < contacts_;
  bring_ghosts_forward();
  if (count == 0 && !moved) return;
  // From the back, so that those moved into a hole, the last of all and the last with a ghost, are never marked.
  for (int k = contacts_ - 1; count > 0; --k) {
    if (leaving_[k / 8] == 0) k &= ~7;
    if (!(leaving_[k / 8] >> k % 8 & 1)) continue;
    --count;
    add_due(contact_i_[k], contact_j_[k]);
    ++candidates_;
    int hole = k;
    if (hole < with_ghost_) {
      copy(--with_ghost_, hole);
      hole = with_ghost_;
    }
    copy(--contacts_, hole);
  }
  in_order_ = contacts_;
  pad_contacts();
}

std::size_t ContactLists::contact_bytes() const {
  return (contact_i_.capacity() + contact_j_.capacity()) * sizeof(int) + leaving_.capacity() +
         history_.capacity() * sizeof(double);
}

std::size_t ContactLists::candidate_bytes() const {
  std::size_t pairs = 0;
  for (const auto& page : page_) pairs += page.capacity();
  return pairs * sizeof(Pair) + (due_i_.capacity() + due_j_.capacity()) * sizeof(int);
}

}  // namespace silt
