#include "particles/pair_sums.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

namespace silt {
namespace {

constexpr std::size_t padding = 8;  // the widest pack

}  // namespace

void PairSums::clear(int count) {
  for (Aligned<double>* column : {&x, &y, &z}) {
    column->reserve(count + padding);
    std::fill_n(column->data(), count + padding, 0.0);
  }
}

void PairSources::gather(const Store& store, const double* values, int width, MPI_Comm communicator) {
  int size = 1, rank = 0;
  MPI_Comm_size(communicator, &size);
  MPI_Comm_rank(communicator, &rank);
  counts_.resize(size);
  starts_.resize(size);
  MPI_Allgather(&store.owned, 1, MPI_INT, counts_.data(), 1, MPI_INT, communicator);
  count = std::accumulate(counts_.begin(), counts_.end(), 0);
  std::exclusive_scan(counts_.begin(), counts_.end(), starts_.begin(), 0);
  place.resize(store.owned);
  std::iota(place.begin(), place.end(), starts_[rank]);
  sorted_.clear();
  for (Aligned<double>* column : {&x, &y, &z, &a, &b, &c}) {
    column->reserve(count + padding);
    std::fill_n(column->data() + count, padding, 0.0);
  }
  std::vector<int> counts(size), starts(size);
  for (int r = 0; r < size; ++r) counts[r] = 3 * counts_[r], starts[r] = 3 * starts_[r];
  sending_.resize(3 * static_cast<std::size_t>(store.owned));
  receiving_.resize(3 * static_cast<std::size_t>(count));
  for (int p = 0; p < store.owned; ++p)
    for (int d = 0; d < 3; ++d) sending_[3 * p + d] = store.motion[p].position[d];
  MPI_Allgatherv(sending_.data(), 3 * store.owned, MPI_DOUBLE, receiving_.data(), counts.data(), starts.data(),
                 MPI_DOUBLE, communicator);
  for (int k = 0; k < count; ++k) {
    x[k] = receiving_[3 * k];
    y[k] = receiving_[3 * k + 1];
    z[k] = receiving_[3 * k + 2];
  }
  gather_values(store, values, width, communicator);
}

void PairSources::gather_values(const Store& store, const double* values, int width, MPI_Comm communicator) {
  const auto size = counts_.size();
  std::vector<int> counts(size), starts(size);
  for (std::size_t r = 0; r < size; ++r) counts[r] = width * counts_[r], starts[r] = width * starts_[r];
  receiving_.resize(static_cast<std::size_t>(width) * count);
  MPI_Allgatherv(values, width * store.owned, MPI_DOUBLE, receiving_.data(), counts.data(), starts.data(), MPI_DOUBLE,
                 communicator);
  for (int k = 0; k < count; ++k) {
    const int at = sorted_.empty() ? k : sorted_[k];
    const double* value = &receiving_[static_cast<std::size_t>(width) * k];
    a[at] = value[0];
    if (width == 3) b[at] = value[1], c[at] = value[2];
  }
}

void PairSources::sort(const Periods& periods, double cutoff) {
  const Aligned<double>* column[3] = {&x, &y, &z};
  double lower[3], width[3];
  int cells[3];
  for (int d = 0; d < 3; ++d) {
    const double* v = column[d]->data();
    const auto [low, high] = std::minmax_element(v, v + count);
    lower[d] = count > 0 ? *low : 0;
    double length = count > 0 ? *high - *low : 0;
    if (periods.length[d] > 0) length = periods.length[d];
    cells[d] = static_cast<int>(std::clamp(std::floor(length / cutoff), 1.0, 128.0));
    width[d] = cells[d] > 1 ? length / cells[d] : std::max(length, cutoff);
  }
  const auto cell_of = [&](int k, int d) {
    const int cell = static_cast<int>(std::floor(((*column[d])[k] - lower[d]) / width[d]));
    return periods.length[d] > 0 ? ((cell % cells[d]) + cells[d]) % cells[d] : std::clamp(cell, 0, cells[d] - 1);
  };
  std::vector<int> cell(count), first(static_cast<std::size_t>(cells[0]) * cells[1] * cells[2] + 1, 0);
  for (int k = 0; k < count; ++k) {
    cell[k] = (cell_of(k, 2) * cells[1] + cell_of(k, 1)) * cells[0] + cell_of(k, 0);
    ++first[cell[k] + 1];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<int> at(first.begin(), first.end() - 1);
  sorted_.resize(count);
  for (int k = 0; k < count; ++k) sorted_[k] = at[cell[k]]++;
  std::vector<double> scratch(count);
  for (Aligned<double>* values : {&x, &y, &z, &a, &b, &c}) {
    std::copy_n(values->data(), count, scratch.data());
    for (int k = 0; k < count; ++k) (*values)[sorted_[k]] = scratch[k];
  }
  run_start.assign(1, 0);
  run.clear();
  for (int& p : place) {
    const int mine = cell[p];
    p = sorted_[p];
    const int i[3] = {mine % cells[0], mine / cells[0] % cells[1], mine / (cells[0] * cells[1])};
    // The cells from one below to one above in each direction, each once, also where the period is short.
    std::vector<int> near[3];
    for (int d = 0; d < 3; ++d) {
      for (int step = -1; step <= 1; ++step) {
        int j = i[d] + step;
        if (periods.length[d] > 0) j = (j + cells[d]) % cells[d];
        if (j >= 0 && j < cells[d] && std::find(near[d].begin(), near[d].end(), j) == near[d].end())
          near[d].push_back(j);
      }
      std::sort(near[d].begin(), near[d].end());
    }
    for (const int k : near[2])
      for (const int j : near[1])
        for (const int l : near[0]) {
          const int next = (k * cells[1] + j) * cells[0] + l;
          if (first[next] == first[next + 1]) continue;
          if (static_cast<int>(run.size()) > 2 * run_start.back() && run.back() == first[next])
            run.back() = first[next + 1];
          else
            run.insert(run.end(), {first[next], first[next + 1]});
        }
    run_start.push_back(static_cast<int>(run.size() / 2));
  }
}

}  // namespace silt
