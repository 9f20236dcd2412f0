#include "fluid/space/rendezvous.hpp"

#include <algorithm>
#include <map>

#include "base/petsc.hpp"

namespace silt {
namespace {

using Name = std::array<long long, 8>;

int meeting_rank(const Name& name) {
  unsigned long long hash = 1469598103934665603ull;
  for (long long part : name) hash = (hash ^ static_cast<unsigned long long>(part)) * 1099511628211ull;
  return static_cast<int>((hash >> 32) % static_cast<unsigned long long>(mpi_size()));
}

std::vector<int> offsets(const std::vector<int>& counts) {
  std::vector<int> result(counts.size() + 1, 0);
  for (size_t i = 0; i < counts.size(); ++i) result[i + 1] = result[i] + counts[i];
  return result;
}

std::vector<long long> exchange(const std::vector<long long>& data, const std::vector<int>& send,
                                const std::vector<int>& receive) {
  const std::vector<int> from = offsets(send), to = offsets(receive);
  std::vector<long long> result(to.back());
  MPI_Alltoallv(data.data(), send.data(), from.data(), MPI_LONG_LONG, result.data(), receive.data(), to.data(),
                MPI_LONG_LONG, PETSC_COMM_WORLD);
  return result;
}

}  // namespace

std::vector<long long> least_over_ranks(const std::vector<Name>& names, const std::vector<long long>& values) {
  constexpr int record = 9;
  const int ranks = mpi_size();
  std::vector<int> count(ranks, 0), arriving(ranks, 0);
  std::vector<size_t> sequence(names.size());
  for (size_t k = 0; k < names.size(); ++k) sequence[k] = k;
  std::stable_sort(sequence.begin(), sequence.end(),
                   [&](size_t a, size_t b) { return meeting_rank(names[a]) < meeting_rank(names[b]); });
  std::vector<long long> outgoing;
  for (size_t k : sequence) {
    count[meeting_rank(names[k])] += record;
    outgoing.insert(outgoing.end(), names[k].begin(), names[k].end());
    outgoing.push_back(values[k]);
  }
  MPI_Alltoall(count.data(), 1, MPI_INT, arriving.data(), 1, MPI_INT, PETSC_COMM_WORLD);
  const std::vector<long long> met = exchange(outgoing, count, arriving);

  const auto name_at = [&met](size_t k) {
    Name name;
    std::copy_n(met.begin() + static_cast<long>(k), 8, name.begin());
    return name;
  };
  std::map<Name, long long> least;
  for (size_t k = 0; k < met.size(); k += record) {
    const auto [entry, fresh] = least.try_emplace(name_at(k), met[k + 8]);
    if (!fresh) entry->second = std::min(entry->second, met[k + 8]);
  }
  std::vector<long long> answers;
  for (size_t k = 0; k < met.size(); k += record) answers.push_back(least[name_at(k)]);
  for (int r = 0; r < ranks; ++r) {
    count[r] /= record;
    arriving[r] /= record;
  }
  const std::vector<long long> returned = exchange(answers, arriving, count);
  std::vector<long long> result(names.size());
  for (size_t k = 0; k < sequence.size(); ++k) result[sequence[k]] = returned[k];
  return result;
}

}  // namespace silt
