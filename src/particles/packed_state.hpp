#pragma once
#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "particles/contact_lists.hpp"
#include "particles/particle_rows.hpp"
#include "particles/sweep.hpp"

namespace silt {

/// What a kept state is made of: the same numbers to the last bit in fewer bytes.

/// Whole numbers, as offsets from the least of them in the narrow type where all fit in it.
template <class Narrow, class Wide>
class Narrowed {
 public:
  Narrowed() = default;
  /// `number(k)`: the k-th of them.
  template <class Number>
  Narrowed(std::size_t count, Number&& number) {
    Wide highest = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const Wide value = number(k);
      least_ = k == 0 ? value : std::min(least_, value);
      highest = k == 0 ? value : std::max(highest, value);
    }
    const auto range = static_cast<std::uint64_t>(highest) - static_cast<std::uint64_t>(least_);
    is_narrow_ = range <= std::numeric_limits<Narrow>::max();
    is_narrow_ ? narrow_.resize(count) : wide_.resize(count);
    for (std::size_t k = 0; k < count; ++k)
      if (is_narrow_)
        narrow_[k] = static_cast<Narrow>(number(k) - least_);
      else
        wide_[k] = number(k);
  }
  std::size_t size() const { return is_narrow_ ? narrow_.size() : wide_.size(); }
  Wide operator[](std::size_t k) const { return is_narrow_ ? static_cast<Wide>(least_ + narrow_[k]) : wide_[k]; }
  std::size_t bytes() const { return narrow_.capacity() * sizeof(Narrow) + wide_.capacity() * sizeof(Wide); }

 private:
  Wide least_ = 0;
  bool is_narrow_ = true;
  std::vector<Narrow> narrow_;
  std::vector<Wide> wide_;
};
using PackedIds = Narrowed<std::uint32_t, std::int64_t>;

/// Motions of particles; radius, mass and material stand in a table where there are few kinds of particles.
class PackedMotions {
 public:
  PackedMotions() = default;
  PackedMotions(const Motion* motion, const Rotation* rotation, int count);
  void unpack(Motion* motion, Rotation* rotation) const;
  std::size_t bytes() const;

 private:
  struct Kind {
    double radius, inverse_mass, material;
    bool operator==(const Kind&) const = default;
  };
  std::vector<double> moving_;       ///< [count][9] position, velocity, spin
  std::vector<Kind> kinds_;          ///< of all that there are, or one a particle
  std::vector<std::uint16_t> kind_;  ///< [count], empty: a kind a particle
};

/// Forces and torques of particles, without the zeros that align them.
class PackedLoads {
 public:
  PackedLoads() = default;
  PackedLoads(const Load* load, int count);
  bool empty() const { return values_.empty(); }
  void unpack(Load* load) const;
  std::size_t bytes() const { return values_.capacity() * sizeof(double); }

 private:
  std::vector<double> values_;  ///< [count][6]
};

/// Rows of numbers that belong to particles; the first number of a row may be an id.
class PackedRows {
 public:
  PackedRows() = default;
  PackedRows(const ParticleRows& rows, bool first_is_id);
  ParticleRows unpack() const;
  std::size_t bytes() const { return each_.bytes() + id_.bytes() + entries_.capacity() * sizeof(double); }

 private:
  int width_ = 0;
  bool first_is_id_ = false;
  Narrowed<std::uint8_t, int> each_;  ///< rows of each particle
  PackedIds id_;                      ///< of each row
  std::vector<double> entries_;       ///< the other numbers
};

}  // namespace silt
