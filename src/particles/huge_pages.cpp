#include "particles/huge_pages.hpp"

#include <sys/mman.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <new>

namespace silt {
namespace {

char* allocate(std::size_t alignment, std::size_t bytes) {
  void* memory = nullptr;
  if (posix_memalign(&memory, alignment, bytes) != 0) throw std::bad_alloc();
  // The last page of an array with memory of its own need not be whole. Refused advice costs speed only.
  if (alignment == HugePages::page) madvise(memory, bytes / HugePages::page * HugePages::page, MADV_HUGEPAGE);
  return static_cast<char*>(memory);
}

}  // namespace

HugePages& HugePages::shared() {
  static auto& pages = *new HugePages;
  return pages;
}

void* HugePages::take(std::size_t bytes) {
  bytes = whole_lines(bytes);
  if (bytes < least) return allocate(line, bytes);
  if (bytes >= region) return allocate(page, bytes);
  const auto fits = [bytes](const auto& piece) { return piece.second >= bytes; };
  // The first piece that is long enough: arrays stay together, and fewer pages are touched.
  for (Region& one : regions_) {
    const auto piece = std::find_if(one.free.begin(), one.free.end(), fits);
    if (piece == one.free.end()) continue;
    const auto [offset, length] = *piece;
    one.free.erase(piece);
    if (length > bytes) one.free.emplace(offset + bytes, length - bytes);
    return one.start + offset;
  }
  regions_.push_back({allocate(page, region), {{bytes, region - bytes}}});
  return regions_.back().start;
}

void HugePages::give(void* memory, std::size_t bytes) {
  bytes = whole_lines(bytes);
  if (bytes < least || bytes >= region) return std::free(memory);
  auto* const start = static_cast<char*>(memory);
  const auto home = std::find_if(regions_.begin(), regions_.end(), [start](const Region& one) {
    return start >= one.start && start < one.start + region;
  });
  auto piece = home->free.emplace(start - home->start, bytes).first;
  if (const auto next = std::next(piece); next != home->free.end() && piece->first + piece->second == next->first) {
    piece->second += next->second;
    home->free.erase(next);
  }
  if (piece != home->free.begin())
    if (const auto before = std::prev(piece); before->first + before->second == piece->first) {
      before->second += piece->second;
      home->free.erase(piece);
    }
  if (home->free.begin()->second < region) return;
  std::free(home->start);
  regions_.erase(home);
}

std::size_t HugePages::idle() const {
  std::size_t bytes = 0;
  for (const Region& one : regions_)
    for (const auto& [offset, length] : one.free) bytes += length;
  return bytes;
}

}  // namespace silt
