#pragma once
#include <mpi.h>

#include <vector>

#include "particles/aligned.hpp"
#include "particles/store.hpp"

namespace silt {

/// Who acts on whom between all particles: where those of all ranks are and what they carry, in columns of doubles with
/// room for a pack more.
struct PairSources {
  int count = 0;            ///< particles on all ranks
  std::vector<int> place;   ///< [owned] where this rank's particles stand
  Aligned<double> x, y, z;  ///< m
  Aligned<double> a, b, c;  ///< moment (A m2, C m); a charge (C) stands in a
  // With a cut-off the sources are sorted along cells, so that the cells around a particle make few runs of places.
  std::vector<int> run_start, run;  ///< of owned particle p: places run[2 k], end run[2 k + 1], k from run_start[p]

  /// Collects `values` ([owned][width], width 1 or 3) of every rank. Collective.
  void gather(const Store& store, const double* values, int width, MPI_Comm communicator);
  /// The same places and runs with new values. Collective.
  void gather_values(const Store& store, const double* values, int width, MPI_Comm communicator);
  /// Sorts by cells of the width of the cut-off, after gather().
  void sort(const Periods& periods, double cutoff);

 private:
  std::vector<int> counts_, starts_, sorted_;  ///< sorted_: place of each gathered particle; empty: as gathered
  std::vector<double> sending_, receiving_;
};

/// Three sums at every place; only those of this rank's particles are meaningful.
struct PairSums {
  Aligned<double> x, y, z;
  void clear(int count);
};

/// One loop over pairs; distances are to the nearest image where periodic.
struct PairLoop {
  const PairSources* sources = nullptr;
  PairSums* force = nullptr;  ///< null: not wanted
  PairSums* field = nullptr;  ///< null: not wanted
  Periods periods;
  double cutoff = 0;  ///< m; 0: all with all
};

/// The loops for one instruction set: the sums over j of the formulas of `magnetic_models` and `electric_models`
///  - dipoles, force: of F_ij over 3 mu0/(4 pi);
///  - dipoles, field: of H_ij over 3/(4 pi);
///  - charges, field: of the field of Q_j over 1/(4 pi eps).
struct PairKernels {
  void (*dipoles)(const PairLoop&);
  void (*charges)(const PairLoop&);
};
extern const PairKernels plain_pair_kernels, avx2_pair_kernels, avx512_pair_kernels;
/// The widest this processor can run, or the one named plain, avx2, avx512 (-particles_instructions).
const PairKernels& choose_pair_kernels(const char* name);

}  // namespace silt
