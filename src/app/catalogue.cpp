#include "app/catalogue.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/simulation.hpp"
#include "coupling/drag/drag_models.hpp"
#include "fluid/boundary/boundary_conditions.hpp"
#include "fluid/energy/energy_equation.hpp"
#include "fluid/fluid_options.hpp"
#include "fluid/monolithic.hpp"
#include "fluid/pressure_correction/pressure_correction.hpp"
#include "particles/contact_models.hpp"
#include "particles/insertion/insertion_options.hpp"
#include "particles/materials.hpp"
#include "particles/particle_options.hpp"
#include "particles/walls/wall_boundary.hpp"
#include "particles/walls/walls.hpp"

namespace silt {
namespace {

template <class T>
void declare(Options& options, const std::string& prefix) {
  T object{};
  options.read(prefix, object);
}

/// The choice among a list of models, then the parameters of each of them.
template <class... Model>
void declare(Options& options, const std::string& prefix, Models<Model...> list, const std::string& help) {
  const std::vector<std::string> names = list.names();
  options.declare({prefix + "_type", "word", "", names.front(), fmt::format("{}", fmt::join(names, ", ")), help,
                   names.front(), false});
  (declare<Model>(options, prefix), ...);
}

Options everything() {
  Options options;
  declare<CaseOptions>(options, "");
  declare<TimeOptions>(options, "time");
  declare<MeshOptions>(options, "mesh");
  declare<FluidOptions>(options, "fluid");
  declare<EnergyOptions>(options, "fluid");
  declare<PressureCorrectionOptions>(options, "fluid");
  declare<MonolithicOptions>(options, "fluid");
  declare<BoundaryOptions>(options, "boundary_<name>");
  declare<WallBoundaryOptions>(options, "boundary_<name>");
  declare<WallOptions>(options, "walls");
  declare<Material>(options, "material_<name>");
  declare<PairOverride>(options, "pair_<a>_<b>");
  declare(options, "normal", NormalModels{}, "normal contact force");
  declare(options, "tangential", TangentialModels{}, "tangential contact force");
  declare(options, "rolling", RollingModels{}, "rolling resistance");
  declare<ParticleOptions>(options, "particles");
  declare<InsertionOptions>(options, "insertion_<name>");
  declare<SettleOptions>(options, "settle");
  declare(options, "drag", DragModels{}, "drag law");
  declare<CouplingOptions>(options, "coupling");
  declare<OutputOptions>(options, "output");
  declare<ProbeOptions>(options, "probe_<name>");
  declare<LineOptions>(options, "line_<name>");
  declare<ProfileOptions>(options, "profile_<name>");
  declare<LedgerOptions>(options, "ledger");
  declare<ExpectationOptions>(options, "expect_<name>");
  declare<ProgressOptions>(options, "progress");
  return options;
}

template <class... Model>
void list(std::string& text, const char* slot, Models<Model...>) {
  ((text += fmt::format("{:<12} {}\n", slot, Model::name)), ...);
}

}  // namespace

const Options& catalogue() {
  static const Options options = everything();
  return options;
}

std::string model_list() {
  std::string text;
  list(text, "normal", NormalModels{});
  list(text, "tangential", TangentialModels{});
  list(text, "rolling", RollingModels{});
  list(text, "drag", DragModels{});
  return text;
}

}  // namespace silt
