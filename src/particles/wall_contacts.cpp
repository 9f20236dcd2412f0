#include "particles/wall_contacts.hpp"

namespace silt {
namespace {

/// A point whose normal has turned by more than 45 degrees since the last step is another contact.
constexpr double same_contact = 0.7;

}  // namespace

void WallContacts::resize(Aligned<double>& values, std::size_t& stride, int count) const {
  const auto needed = static_cast<std::size_t>(count) + 8;
  if (needed > stride) {
    stride = (needed + needed / 4 + 63) / 64 * 64;
    values.reserve(stride * (components_ > 0 ? components_ : 1));
  }
}

void WallContacts::adopt(const Motion* particles, double gap) {
  const int old_count = count(), found = static_cast<int>(next_.size());
  int new_count = 0;
  resize(next_history_, next_stride_, found);
  if (keep_lost_) taken_.assign(old_count, 0);
  int first = 0;  // of the particle at hand among the old points
  for (int k = 0; k < found;) {
    const int particle = next_[k].particle;
    const double limit = particles[particle].radius + gap;
    int end = k;
    while (end < found && next_[end].particle == particle) ++end;
    while (first < old_count && points_[first].particle < particle) ++first;
    int last = first;
    while (last < old_count && points_[last].particle == particle) ++last;
    unsigned taken = 0;
    for (int n = k; n < end; ++n) {
      int best = -1;
      double closest = same_contact;
      for (int o = first; o < last && o < first + 32; ++o) {
        if (taken >> (o - first) & 1) continue;
        // The spring goes on from one wall to a flat neighbour; of two on one spot each keeps its own.
        const double own = points_[o].boundary == next_[n].boundary ? 1e-6 : 0;
        const double cosine = dot(points_[o].normal, next_[n].normal) + own;
        if (cosine > closest) closest = cosine, best = o;
      }
      if (next_[n].distance >= limit && (best < 0 || points_[best].distance >= limit)) continue;
      if (best >= 0) taken |= 1u << (best - first);
      if (best >= 0 && keep_lost_) taken_[best] = 1;
      for (int c = 0; c < components_; ++c)
        next_history_[c * next_stride_ + new_count] = best >= 0 ? history(c, best) : 0.0;
      next_[new_count++] = next_[n];
    }
    k = end;
  }
  if (keep_lost_) {
    lost_.clear();
    for (int o = 0; o < old_count; ++o) {
      if (taken_[o]) continue;
      Lost lost{points_[o].particle, std::vector<double>(components_)};
      for (int c = 0; c < components_; ++c) lost.history[c] = history(c, o);
      lost_.push_back(std::move(lost));
    }
  }
  for (int c = 0; c < components_; ++c)
    for (int k = new_count; k < new_count + 8; ++k) next_history_[c * next_stride_ + k] = 0;
  next_.resize(new_count);
  points_.swap(next_);
  history_.swap(next_history_);
  std::swap(stride_, next_stride_);
}

void WallContacts::fill(WallSweep& sweep) {
  sweep.count = count();
  sweep.points = points_.data();
  sweep.history = history_.data();
  sweep.stride = stride_;
}

void WallContacts::gather(int particles, ParticleRows& rows) const {
  rows.clear();
  if (count() == 0) return rows.start.assign(particles + 1, 0);
  std::vector<double> entries;
  int k = 0;
  for (int p = 0; p < particles; ++p) {
    entries.clear();
    int found = 0;
    for (; k < count() && points_[k].particle == p; ++k, ++found) {
      entries.insert(entries.end(), {static_cast<double>(points_[k].boundary), static_cast<double>(points_[k].material),
                                     points_[k].distance});
      entries.insert(entries.end(), points_[k].normal, points_[k].normal + 3);
      for (int c = 0; c < components_; ++c) entries.push_back(history(c, k));
    }
    rows.append(entries.data(), found);
  }
}

void WallContacts::restore(const ParticleRows& rows) {
  const int particles = static_cast<int>(rows.start.size()) - 1;
  points_.clear();
  resize(history_, stride_, rows.start.back());
  for (int p = 0; rows.start.back() > 0 && p < particles; ++p)
    for (int k = rows.start[p]; k < rows.start[p + 1]; ++k) {
      const double* row = rows.row(k);
      WallPoint point{};
      point.particle = p;
      point.boundary = static_cast<int>(row[0]);
      point.material = static_cast<int>(row[1]);
      point.distance = row[2];
      for (int d = 0; d < 3; ++d) point.normal[d] = row[3 + d];
      points_.push_back(point);
      for (int c = 0; c < components_; ++c) history(c, k) = row[head + c];
    }
}

}  // namespace silt
