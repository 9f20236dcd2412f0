#pragma once
#include <mpi.h>

namespace silt {

/// What the ranks tell each other of a substep: of each number the largest of all ranks. It is heard at once, or only
/// when the next substep asks, so that meanwhile no rank waits for a slower one.
class StepNews {
 public:
  struct Numbers {
    double trouble = 0;   ///< 1: something is wrong
    double walls = 0;     ///< m, how far a wall has come since its list was made
    double farthest = 0;  ///< m, how far any particle may have come since the lists were made
    double stride = 0;    ///< m, longest way of a particle against particles and walls in the substep
  };

  explicit StepNews(MPI_Comm communicator) : communicator_(communicator) {
    int size = 1;
    MPI_Comm_size(communicator, &size);
    alone_ = size == 1;
  }
  ~StepNews() { MPI_Wait(&request_, MPI_STATUS_IGNORE); }
  StepNews(const StepNews&) = delete;
  StepNews& operator=(const StepNews&) = delete;

  /// Collective, as hear() of what was told; `at_once`: the ranks wait for each other here.
  void tell(const Numbers& numbers, bool at_once) {
    numbers_ = numbers;
    told_ = true;
    if (alone_) return;
    constexpr int count = sizeof(Numbers) / sizeof(double);
    auto* values = reinterpret_cast<double*>(&numbers_);
    if (at_once)
      MPI_Allreduce(MPI_IN_PLACE, values, count, MPI_DOUBLE, MPI_MAX, communicator_);
    else
      MPI_Iallreduce(MPI_IN_PLACE, values, count, MPI_DOUBLE, MPI_MAX, communicator_, &request_);
  }
  /// Whether something was told and not heard yet.
  bool told() const { return told_; }
  const Numbers& hear() {
    MPI_Wait(&request_, MPI_STATUS_IGNORE);
    told_ = false;
    return numbers_;
  }

 private:
  MPI_Comm communicator_;
  MPI_Request request_ = MPI_REQUEST_NULL;
  Numbers numbers_;
  bool alone_ = true, told_ = false;
};

}  // namespace silt
