#pragma once
#include <cstddef>
#include <cstring>
#include <type_traits>
#include <utility>

#include "particles/huge_pages.hpp"

namespace silt {

/// An array of plain records aligned for vector loads (64 bytes), in huge pages. Growing keeps the contents, by an
/// eighth at least; new entries are zero.
template <class T>
class Aligned {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  Aligned() = default;
  Aligned(const Aligned& other) {
    if (other.capacity_ == 0) return;
    reserve(other.capacity_);
    std::memcpy(data_, other.data_, other.capacity_ * sizeof(T));
  }
  Aligned(Aligned&& other) noexcept { swap(other); }
  Aligned& operator=(Aligned&& other) noexcept {
    swap(other);
    return *this;
  }
  ~Aligned() { HugePages::shared().give(data_, capacity_ * sizeof(T)); }

  void swap(Aligned& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(capacity_, other.capacity_);
  }
  /// Makes room for at least `count` entries.
  void reserve(std::size_t count) {
    if (count <= capacity_) return;
    const std::size_t grown = capacity_ + capacity_ / 8 + 64;
    // Whole cache lines, whatever the record.
    const std::size_t room = ((count > grown ? count : grown) + 63) / 64 * 64, kept = capacity_ * sizeof(T);
    void* memory = HugePages::shared().take(room * sizeof(T));
    if (kept) std::memcpy(memory, data_, kept);
    std::memset(static_cast<char*>(memory) + kept, 0, room * sizeof(T) - kept);
    HugePages::shared().give(data_, kept);
    data_ = static_cast<T*>(memory);
    capacity_ = room;
  }
  std::size_t capacity() const { return capacity_; }
  T* data() { return data_; }
  const T* data() const { return data_; }
  T& operator[](std::size_t i) { return data_[i]; }
  const T& operator[](std::size_t i) const { return data_[i]; }

 private:
  T* data_ = nullptr;
  std::size_t capacity_ = 0;
};

}  // namespace silt
