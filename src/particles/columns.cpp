#include "particles/columns.hpp"

#include <algorithm>
#include <stdexcept>

#include "particles/particles.hpp"
#include "particles/rearrange.hpp"

namespace silt {

int Columns::add(const ColumnRequest& request, int particles) {
  const int known = find(request.name);
  if (known >= 0) {
    ColumnRequest& old = columns_[known].request;
    if (old.width != request.width)
      throw std::logic_error("the particle column " + request.name + " was asked for with two widths");
    old.ghosts = std::max(old.ghosts, request.ghosts);
    old.output = old.output || request.output;
    if (!old.start) old.start = request.start;
    return known;
  }
  columns_.push_back({request, {}});
  width_ += request.width;
  reserve(std::max(room_, particles));
  return count() - 1;
}

int Columns::find(const std::string& name) const {
  for (int c = 0; c < count(); ++c)
    if (columns_[c].request.name == name) return c;
  return -1;
}

int Columns::offset(int column) const {
  int at = 0;
  for (int c = 0; c < column; ++c) at += request(c).width;
  return at;
}

void Columns::reserve(int particles) {
  room_ = std::max(room_, particles);
  for (Column& column : columns_)
    column.values.reserve((static_cast<std::size_t>(room_) + 2) * static_cast<std::size_t>(column.request.width));
}

void Columns::clear(int first, int last) {
  for (int c = 0; c < count(); ++c) std::fill(row(c, first), row(c, last), 0.0);
}

void Columns::start(int p, const Seed& seed) {
  clear(p, p + 1);
  for (int c = 0; c < count(); ++c) {
    if (columns_[c].request.start) columns_[c].request.start(seed, row(c, p));
    for (const auto& given : seed.columns)
      if (given.name == columns_[c].request.name && given.row.size() == static_cast<std::size_t>(request(c).width))
        std::copy(given.row.begin(), given.row.end(), row(c, p));
  }
}

void Columns::gather(int p, double* to) const {
  for (int c = 0; c < count(); ++c) to = std::copy_n(row(c, p), request(c).width, to);
}

void Columns::scatter(int p, const double* from) {
  for (int c = 0; c < count(); from += request(c).width, ++c) std::copy_n(from, request(c).width, row(c, p));
}

void Columns::reorder(const Rearrangement& order) {
  for (Column& column : columns_) order.apply(column.values.data(), column.request.width);
}

std::size_t Columns::bytes() const {
  std::size_t sum = 0;
  for (const Column& column : columns_) sum += column.values.capacity() * sizeof(double);
  return sum;
}

int Columns::ghost_width(bool rebuild) const {
  int width = 0;
  for (const Column& column : columns_) width += column.for_ghosts(rebuild) ? column.request.width : 0;
  return width;
}

void Columns::gather_ghost(int p, bool rebuild, double* to) const {
  for (int c = 0; c < count(); ++c)
    if (columns_[c].for_ghosts(rebuild)) to = std::copy_n(row(c, p), request(c).width, to);
}

void Columns::scatter_ghost(int p, bool rebuild, const double* from) {
  for (int c = 0; c < count(); ++c)
    if (columns_[c].for_ghosts(rebuild)) {
      std::copy_n(from, request(c).width, row(c, p));
      from += request(c).width;
    }
}

std::vector<double> Columns::save(int particles) const {
  std::vector<double> saved(static_cast<std::size_t>(particles) * width_);
  for (int p = 0; p < particles && width_ > 0; ++p) gather(p, &saved[static_cast<std::size_t>(p) * width_]);
  return saved;
}

void Columns::restore(const std::vector<double>& saved, int particles) {
  reserve(particles);
  for (int p = 0; p < particles && width_ > 0; ++p) scatter(p, &saved[static_cast<std::size_t>(p) * width_]);
}

}  // namespace silt
