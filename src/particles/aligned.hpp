#pragma once
#include <sys/mman.h>

#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <new>
#include <type_traits>
#include <utility>

namespace silt {

/// An array of plain records aligned for vector loads (64 bytes; in 2 MB pages once it is large). Growing keeps the
/// contents, by an eighth at least; new entries are zero.
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
  ~Aligned() { std::free(data_); }

  void swap(Aligned& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(capacity_, other.capacity_);
  }
  /// Makes room for at least `count` entries.
  void reserve(std::size_t count) {
    if (count <= capacity_) return;
    constexpr std::size_t page = std::size_t(2) << 20;
    const std::size_t grown = capacity_ + capacity_ / 8 + 64;
    std::size_t bytes = (count > grown ? count : grown) * sizeof(T);
    bytes = (bytes + 63) / 64 * 64;
    const std::size_t alignment = bytes > 2 * page ? page : 64;
    void* memory = nullptr;
    // The last page need not be whole.
    if (posix_memalign(&memory, alignment, bytes) != 0) throw std::bad_alloc();
    if (alignment == page) madvise(memory, bytes / page * page, MADV_HUGEPAGE);
    const std::size_t kept = capacity_ * sizeof(T);
    if (kept) std::memcpy(memory, data_, kept);
    std::memset(static_cast<char*>(memory) + kept, 0, bytes - kept);
    std::free(data_);
    data_ = static_cast<T*>(memory);
    capacity_ = bytes / sizeof(T);
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
