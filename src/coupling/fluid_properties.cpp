#include "coupling/fluid_properties.hpp"

namespace silt {

void FluidProperties::sample(const Filter& filter, const Kernel& kernel) {
  const Fluid::Properties fields = fluid_.properties();
  varies_ = !fields.density.empty();
  if (!varies_) return;
  nodal_.resize(3 * static_cast<std::size_t>(mesh_.nodes));
  for (std::size_t i = 0; i < fields.density.size(); ++i) {
    nodal_[3 * i] = fields.density[i];
    nodal_[3 * i + 1] = fields.viscosity[i];
    nodal_[3 * i + 2] = fields.sound[i];
  }
  filter.apply(nodal_.data(), 3);
  values_.resize(3 * static_cast<std::size_t>(kernel.count()));
  kernel.sample(nodal_, values_, 3);
}

}  // namespace silt
