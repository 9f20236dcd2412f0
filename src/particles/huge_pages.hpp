#pragma once
#include <cstddef>
#include <map>
#include <vector>

namespace silt {

/// Memory of long arrays. A processor finds memory faster in pages of 2 MB than of 4 kB, but an array of less than many
/// of them would waste half a page at its end, so arrays share regions of whole pages; one that would fill a region has
/// its own. Where the system gives no such pages, they are of 4 kB. Not for several threads at once.
class HugePages {
 public:
  static constexpr std::size_t page = std::size_t(2) << 20, region = 16 * page;  ///< B
  static constexpr std::size_t least = 16384;  ///< B, shorter arrays come from malloc()

  /// That of the process. It is never destroyed, for static arrays may end late.
  static HugePages& shared();

  /// 64-byte aligned; what it holds is undefined. Throws std::bad_alloc.
  void* take(std::size_t bytes);
  /// Gives back what take(bytes) gave; null is allowed.
  void give(void* memory, std::size_t bytes);
  /// Bytes of the shared regions that nobody has, and the number of regions.
  std::size_t idle() const;
  std::size_t regions() const { return regions_.size(); }

 private:
  struct Region {
    char* start;
    std::map<std::size_t, std::size_t> free;  ///< length by offset, no two adjacent
  };
  static constexpr std::size_t line = 64;
  static std::size_t whole_lines(std::size_t bytes) { return (bytes + line - 1) / line * line; }

  std::vector<Region> regions_;
};

}  // namespace silt
