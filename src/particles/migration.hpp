#pragma once
#include <mpi.h>

#include <vector>

#include "base/locator.hpp"
#include "particles/particle_rows.hpp"
#include "particles/store.hpp"

namespace silt {

/// A particle that is in no cell of the mesh any more.
struct Gone {
  std::int64_t id;
  Body body;
  Load carried;  ///< the contact load it had (Store::reorder)
  FluidAction action;
  int cell;                     ///< last local cell
  int boundary;                 ///< index into Mesh::boundaries: where it passed, as far as can be told
  std::vector<double> columns;  ///< Columns::gather of its row
};

/// Brings every particle to the rank whose cells contain its centre, with its fluid action and contact memories, and
/// wraps positions into the periodic domain. Particles may cross any number of ranks at once.
class Migration {
 public:
  Migration(const Mesh& mesh, MPI_Comm communicator) : mesh_(mesh), locator_(mesh), communicator_(communicator) {}

  /// Sets Store::cell and wraps the positions of the particles that are still on this rank; whether any particle of any
  /// rank is not, so that run() must follow. Collective.
  bool any_away(Store& store);
  /// Particles that left the domain are taken out of the store and returned. Ghosts are forgotten. `carried`: the load
  /// that must move along. After any_away(), of which nothing needs to be true. Collective.
  std::vector<Gone> run(Store& store, Aligned<Load>& carried, ParticleRows& contacts, ParticleRows& walls);

  /// Whether all owned particles are still in local cells; updates their cells and wraps their positions only then.
  /// `strays`: those in another rank's cells, but not across a periodic side, count as at home and keep their old cell.
  /// Collective.
  bool all_at_home(Store& store, bool strays);

  const Locator& locator() const { return locator_; }

 private:
  struct Packet;
  template <class Act>
  void each_on_the_move(const Store& store, Act&& act) const;
  void exchange(std::vector<std::vector<char>>& outgoing, std::vector<char>& incoming);
  bool within_periods(const double* x) const;

  const Mesh& mesh_;
  Locator locator_;
  MPI_Comm communicator_;
  struct Away {
    int particle;
    Place place;
  };
  std::vector<Away> away_;  ///< ascending
};

}  // namespace silt
