#pragma once
#include <vector>

#include "particles/adhesion/capillary.hpp"
#include "particles/contact_laws.hpp"
#include "particles/contact_lists.hpp"
#include "particles/migration.hpp"
#include "particles/store.hpp"
#include "particles/wall_contacts.hpp"

namespace silt {

/// The liquid of wet particles: every particle carries a film (column `film`, m3); bridges take from it when they form
/// and give back what they took when they break, so that films and bridges together keep their volume to round-off.
///
/// A pair that touches asks for a bridge in one step and gets it in the next: in between, each particle's owner has
/// summed up all that is asked of its film (column `film_demand`) and every rank has heard of it. What a particle gives
/// is then the same on all ranks that know the pair, and never more than it has.
class LiquidExchange {
 public:
  /// Does nothing unless the laws have bridges; else registers the columns.
  LiquidExchange(const ContactLaws& laws, Columns& columns);
  bool active() const { return law_ != nullptr; }

  /// Breaks, makes and asks for bridges at the present positions, which a step of dt led to; before the contacts'
  /// forces. Local.
  void exchange(Store& store, ContactLists& contacts, WallContacts& walls, const Periods& periods, double dt);
  /// Gives back the liquid of bridges whose partner has left the domain (which takes its own along); `memory` as it is
  /// between lists. Collective.
  void forget(Store& store, ContactMemory& memory, const std::vector<Gone>& gone, MPI_Comm communicator) const;
  /// Liquid of this rank's particles, in films and in what they gave to bridges. m3
  double volume(const Store& store, const ContactLists& contacts, const WallContacts& walls) const;

 private:
  const CapillaryBridge* law_ = nullptr;
  int first_ = 0;  ///< component of the bridge's history
  int film_ = -1, demand_ = -1;
  const LawSetup* setup_ = nullptr;
  std::vector<double> change_, asked_;
};

}  // namespace silt
