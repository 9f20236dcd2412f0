#include "app/catalogue.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/simulation.hpp"
#include "coupling/dispersion.hpp"
#include "coupling/drag/drag_models.hpp"
#include "coupling/fluid_forces.hpp"
#include "coupling/heat/nusselt.hpp"
#include "coupling/thermophoresis.hpp"
#include "coupling/turbulence_modulation.hpp"
#include "fluid/boundary/boundary_conditions.hpp"
#include "fluid/boundary/drive.hpp"
#include "fluid/compressible/compressible.hpp"
#include "fluid/energy/energy_equation.hpp"
#include "fluid/fluid_options.hpp"
#include "fluid/initial_state.hpp"
#include "fluid/monolithic.hpp"
#include "fluid/prescribed.hpp"
#include "fluid/pressure_correction/pressure_correction.hpp"
#include "fluid/turbulence/smagorinsky.hpp"
#include "fluid/turbulence/turbulence_options.hpp"
#include "fluid/turbulence/wale.hpp"
#include "particles/brownian.hpp"
#include "particles/contact_models.hpp"
#include "particles/field/electric.hpp"
#include "particles/field/magnetic.hpp"
#include "particles/heat/particle_heat.hpp"
#include "particles/insertion/insertion_options.hpp"
#include "particles/insertion/streams.hpp"
#include "particles/law_table.hpp"
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
  declare<ExactOptions>(options, "exact");
  declare<MeshOptions>(options, "mesh");
  declare<FluidOptions>(options, "fluid");
  declare<DriveOptions>(options, "fluid_drive");
  declare<InitialStateOptions>(options, "fluid");
  declare<EnergyOptions>(options, "fluid");
  declare<CompressibleOptions>(options, "fluid");
  declare<PressureCorrectionOptions>(options, "fluid");
  declare<MonolithicOptions>(options, "fluid");
  declare<PrescribedOptions>(options, "fluid");
  declare<TurbulenceOptions>(options, "fluid");
  declare<Smagorinsky>(options, "fluid");
  declare<Wale>(options, "fluid");
  declare<BoundaryOptions>(options, "boundary_<name>");
  declare<WallBoundaryOptions>(options, "boundary_<name>");
  declare<PotentialBoundaryOptions>(options, "boundary_<name>");
  declare<WallOptions>(options, "walls");
  declare<RigidWallOptions>(options, "wall_<name>");
  declare<Material>(options, "material_<name>");
  declare<PairOverride>(options, "pair_<a>_<b>");
  declare(options, "normal", NormalModels{}, "normal contact force");
  declare(options, "tangential", TangentialModels{}, "tangential contact force");
  declare(options, "rolling", RollingModels{}, "rolling resistance");
  declare(options, "twisting", TwistingModels{}, "twisting resistance");
  declare(options, "adhesion", AdhesionModels{}, "adhesion of surfaces in contact");
  declare(options, "dlvo", DlvoModels{}, "forces between surfaces in a liquid");
  declare(options, "bridge", BridgeModels{}, "liquid bridges");
  declare(options, "interfacial", InterfacialModels{}, "attraction at a fluid interface");
  declare(options, "lubrication", LubricationModels{}, "fluid squeezed out of narrow gaps");
  declare<LawTableOptions>(options, "law_table");
  declare<ParticleOptions>(options, "particles");
  declare<BrownianOptions>(options, "brownian");
  declare(options, "magnetic", MagneticModels{}, "magnetic moment of the particles");
  declare<MagneticOptions>(options, "magnetic");
  declare<ElectricOptions>(options, "electric");
  declare<HeatOptions>(options, "heat");
  declare<InsertionOptions>(options, "insertion_<name>");
  declare<RemovalOptions>(options, "removal_<name>");
  declare<SettleOptions>(options, "settle");
  declare(options, "drag", DragModels{}, "drag law");
  declare(options, "saffman", SaffmanModels{}, "lift by shear");
  declare(options, "magnus", MagnusModels{}, "lift by spin");
  declare<VirtualMassOptions>(options, "virtual_mass");
  declare(options, "viscous_torque", ViscousTorqueModels{}, "viscous torque on the spin");
  declare(options, "thermophoresis", ThermophoresisModels{}, "force by a temperature gradient of the gas");
  declare<ThermophoresisOptions>(options, "thermophoresis");
  declare(options, "dispersion", DispersionModels{}, "turbulent dispersion of particles");
  declare(options, "modulation", ModulationModels{}, "what particles do to the fluid's turbulence");
  declare(options, "nusselt", NusseltModels{}, "heat transfer between fluid and particles");
  declare<CouplingOptions>(options, "coupling");
  declare<OutputOptions>(options, "output");
  declare<CheckpointOptions>(options, "checkpoint");
  declare<RestartOptions>(options, "");
  declare<BalanceOptions>(options, "balance");
  declare<ProbeOptions>(options, "probe_<name>");
  declare<LineOptions>(options, "line_<name>");
  declare<ProfileOptions>(options, "profile_<name>");
  declare<LedgerOptions>(options, "ledger");
  declare<ExpectationOptions>(options, "expect_<name>");
  declare<ProgressOptions>(options, "progress");
  return options;
}

/// Calls act(slot, model) for every model of every list.
template <class... Model, class Act>
void each_of(const char* slot, Models<Model...>, Act&& act) {
  (act(slot, Model{}), ...);
}
template <class Act>
void each_model(Act&& act) {
  each_of("normal", NormalModels{}, act);
  each_of("tangential", TangentialModels{}, act);
  each_of("rolling", RollingModels{}, act);
  each_of("twisting", TwistingModels{}, act);
  each_of("adhesion", AdhesionModels{}, act);
  each_of("dlvo", DlvoModels{}, act);
  each_of("bridge", BridgeModels{}, act);
  each_of("interfacial", InterfacialModels{}, act);
  each_of("lubrication", LubricationModels{}, act);
  each_of("drag", DragModels{}, act);
  each_of("saffman", SaffmanModels{}, act);
  each_of("magnus", MagnusModels{}, act);
  each_of("viscous_torque", ViscousTorqueModels{}, act);
  each_of("thermophoresis", ThermophoresisModels{}, act);
  each_of("dispersion", DispersionModels{}, act);
  each_of("modulation", ModulationModels{}, act);
  each_of("nusselt", NusseltModels{}, act);
  each_of("magnetic", MagneticModels{}, act);
}

/// Calls act(slot, model) for every model that an option of its own switches on.
template <class Act>
void each_switched(Act&& act) {
  const auto all = [&](const char* slot, const auto& models) {
    for (const SwitchedModel& model : models) act(slot, model);
  };
  all("magnetic", magnetic_models);
  all("electric", electric_models);
  all("brownian", brownian_models);
  all("virtual_mass", virtual_mass_models);
  all("coupling", coupling_models);
  all("heat", heat_models);
}

template <class Model>
constexpr ModelNote note_of(const Model&) {
  if constexpr (requires { Model::note; })
    return Model::note;
  else
    return {"", "", "", ""};
}

/// Equation and paper of a note.
std::string source_of(const ModelNote& note) {
  return fmt::format("{}{}{}", note.equation, *note.equation && *note.source ? ", " : "", note.source);
}

/// A cell of a Markdown table.
std::string cell(std::string text) {
  for (size_t k = 0; (k = text.find('|', k)) != std::string::npos; k += 2) text.insert(k, 1, '\\');
  return text;
}

}  // namespace

const Options& catalogue() {
  static const Options options = everything();
  return options;
}

std::string model_list() {
  std::string text;
  const auto line = [&](const char* slot, const char* name, const ModelNote& note) {
    text += fmt::format("{:<13} {:<19} {:<22} {}\n", slot, name, note.equation[0] ? note.equation : "-",
                        note.source[0] ? note.source : "-");
  };
  each_model([&](const char* slot, const auto& model) { line(slot, model.name, note_of(model)); });
  each_switched([&](const char* slot, const SwitchedModel& model) { line(slot, model.name, model.note); });
  return text;
}

std::string model_page() {
  std::string text, section;
  each_model([&](const char* slot, auto model) {
    if (section != slot) {
      section = slot;
      text += fmt::format(
          "\n## `-{}_type`\n\n| name | formula | parameters `-{}_...` | source | checked against |\n"
          "|---|---|---|---|---|\n",
          slot, slot);
    }
    Options scratch;
    scratch.read("", model);
    std::string parameters;
    for (const auto& entry : scratch.entries())
      parameters += fmt::format("{}`{}`{}", parameters.empty() ? "" : ", ", entry.name,
                                entry.unit.empty() || entry.unit == "-" ? "" : " (" + entry.unit + ")");
    const ModelNote note = note_of(model);
    text += fmt::format("| `{}` | {} | {} | {} | {} |\n", model.name, cell(note.formula), cell(parameters),
                        cell(source_of(note)), cell(note.check));
  });
  section.clear();
  each_switched([&](const char* slot, const SwitchedModel& model) {
    if (section != slot) {
      section = slot;
      text += fmt::format(
          "\n## `-{}_...`\n\n| name | formula | option | source | checked against |\n|---|---|---|---|---|\n", slot);
    }
    text += fmt::format("| `{}` | {} | `-{}` | {} | {} |\n", model.name, cell(model.note.formula), model.option,
                        cell(source_of(model.note)), cell(model.note.check));
  });
  return text;
}

}  // namespace silt
