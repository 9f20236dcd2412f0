#include "particles/packed_state.hpp"

#include <bit>
#include <unordered_map>

namespace silt {

PackedMotions::PackedMotions(const Motion* motion, const Rotation* rotation, int count) {
  const auto hash = [](const Kind& kind) {
    return std::bit_cast<std::uint64_t>(kind.radius) ^ std::bit_cast<std::uint64_t>(kind.inverse_mass) * 31 ^
           std::bit_cast<std::uint64_t>(kind.material) * 17;
  };
  std::unordered_map<Kind, std::uint16_t, decltype(hash)> number(16, hash);
  // Where sizes are drawn from a distribution there is no table: looking for one ends soon.
  const auto most = static_cast<std::size_t>(std::min(count / 16 + 16, 65536));
  moving_.resize(9 * static_cast<std::size_t>(count));
  kind_.resize(count);
  const auto kind_of = [&](int p) { return Kind{motion[p].radius, motion[p].inverse_mass, rotation[p].material}; };
  bool few = true;
  for (int p = 0; p < count; ++p) {
    const Motion& from = motion[p];
    double* to = &moving_[9 * static_cast<std::size_t>(p)];
    for (int d = 0; d < 3; ++d) to[d] = from.position[d], to[3 + d] = from.velocity[d], to[6 + d] = rotation[p].spin[d];
    if (!few) continue;
    const Kind kind = kind_of(p);
    if (p > 0 && kinds_[kind_[p - 1]] == kind) {
      kind_[p] = kind_[p - 1];
      continue;
    }
    const auto [place, is_new] = number.try_emplace(kind, static_cast<std::uint16_t>(kinds_.size()));
    if (is_new) kinds_.push_back(kind);
    kind_[p] = place->second;
    few = kinds_.size() < most || !is_new;
  }
  if (few) return;
  std::vector<std::uint16_t>().swap(kind_);  // an empty list assigned would keep the room
  kinds_.resize(count);
  kinds_.shrink_to_fit();
  for (int p = 0; p < count; ++p) kinds_[p] = kind_of(p);
}

void PackedMotions::unpack(Motion* motion, Rotation* rotation) const {
  const std::size_t count = moving_.size() / 9;
  for (std::size_t p = 0; p < count; ++p) {
    const double* from = &moving_[9 * p];
    const Kind& kind = kinds_[kind_.empty() ? p : kind_[p]];
    motion[p] = {{from[0], from[1], from[2]}, kind.radius, {from[3], from[4], from[5]}, kind.inverse_mass};
    rotation[p] = {{from[6], from[7], from[8]}, kind.material};
  }
}

std::size_t PackedMotions::bytes() const {
  return moving_.capacity() * sizeof(double) + kinds_.capacity() * sizeof(Kind) +
         kind_.capacity() * sizeof(std::uint16_t);
}

PackedLoads::PackedLoads(const Load* load, int count) : values_(6 * static_cast<std::size_t>(count)) {
  for (int p = 0; p < count; ++p)
    for (int d = 0; d < 3; ++d) {
      values_[6 * static_cast<std::size_t>(p) + d] = load[p].force[d];
      values_[6 * static_cast<std::size_t>(p) + 3 + d] = load[p].torque[d];
    }
}

void PackedLoads::unpack(Load* load) const {
  for (std::size_t p = 0; p < values_.size() / 6; ++p) {
    load[p] = Load{};
    for (int d = 0; d < 3; ++d) {
      load[p].force[d] = values_[6 * p + d];
      load[p].torque[d] = values_[6 * p + 3 + d];
    }
  }
}

PackedRows::PackedRows(const ParticleRows& rows, bool first_is_id) : width_(rows.width), first_is_id_(first_is_id) {
  const auto count = static_cast<std::size_t>(rows.start.back());
  each_ = {rows.start.size() - 1, [&](std::size_t p) { return rows.start[p + 1] - rows.start[p]; }};
  if (!first_is_id) {
    entries_.assign(rows.entries.begin(), rows.entries.end());
    return;
  }
  id_ = {count, [&](std::size_t k) { return std::bit_cast<std::int64_t>(rows.row(static_cast<int>(k))[0]); }};
  entries_.resize(count * (width_ - 1));
  for (std::size_t k = 0; k < count; ++k)
    std::copy_n(rows.row(static_cast<int>(k)) + 1, width_ - 1, entries_.data() + k * (width_ - 1));
}

ParticleRows PackedRows::unpack() const {
  ParticleRows rows(width_);
  rows.start.resize(each_.size() + 1);
  for (std::size_t p = 0; p < each_.size(); ++p) rows.start[p + 1] = rows.start[p] + each_[p];
  if (!first_is_id_) {
    rows.entries = entries_;
    return rows;
  }
  rows.entries.resize(id_.size() * width_);
  for (std::size_t k = 0; k < id_.size(); ++k) {
    double* row = rows.row(static_cast<int>(k));
    row[0] = std::bit_cast<double>(id_[k]);
    std::copy_n(entries_.data() + k * (width_ - 1), width_ - 1, row + 1);
  }
  return rows;
}

}  // namespace silt
