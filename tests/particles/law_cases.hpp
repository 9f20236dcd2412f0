#pragma once
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "particles/contact_laws.hpp"

namespace silt {

/// The options that select a law of a slot and give it what it needs; the same for all tests over the lists of models.
inline std::vector<std::pair<std::string, std::string>> law_options(const std::string& slot, const std::string& name) {
  using Given = std::vector<std::pair<std::string, std::string>>;
  static const std::map<std::string, Given> needs = {
      {"normal linear", {{"normal_stiffness", "1e4"}}},
      {"normal lee_herrmann", {{"normal_damping", "0.02"}}},
      {"normal kuwabara_kono", {{"normal_relaxation_time", "1e-6"}}},
      {"normal walton_braun", {{"normal_stiffness", "1e4"}}},
      {"normal thornton", {{"material_bead_yield_pressure", "2e5"}}},
      {"normal lennard_jones", {{"normal_energy", "1e-7"}, {"normal_damping_rate", "100"}}},
      {"normal langston", {{"normal_gravity", "1e5"}}},
      {"adhesion jkr", {{"material_bead_surface_energy", "0.5"}}},
      {"adhesion dmt", {{"material_bead_surface_energy", "0.5"}}},
      {"adhesion auto", {{"material_bead_surface_energy", "0.5"}}},
      {"dlvo vdw", {{"material_bead_hamaker", "1e-9"}, {"dlvo_least_gap", "1e-6"}}},
      {"dlvo electrostatic",
       {{"material_bead_surface_potential", "1e3"}, {"dlvo_least_gap", "1e-6"}, {"dlvo_debye_length", "1e-5"}}},
      {"dlvo full",
       {{"material_bead_hamaker", "1e-9"},
        {"material_bead_surface_potential", "1e3"},
        {"dlvo_least_gap", "1e-6"},
        {"dlvo_debye_length", "1e-5"}}},
      {"bridge capillary",
       {{"bridge_surface_tension", "0.07"},
        {"bridge_contact_angle", "20"},
        {"bridge_viscosity", "0.01"},
        {"bridge_roughness", "1e-6"},
        {"bridge_liquid_content", "0.01"}}},
      {"interfacial nicolson",
       {{"interfacial_surface_tension", "0.07"},
        {"interfacial_contact_angle", "60"},
        {"interfacial_filling_angle", "40"},
        {"interfacial_density_difference", "1000"},
        {"interfacial_cutoff", "5e-3"}}},
      {"lubrication squeeze", {{"lubrication_viscosity", "0.01"}, {"lubrication_least_gap", "1e-6"}}},
      {"tangential spring_dashpot", {{"tangential_stiffness", "3e3"}}},
      {"tangential spring", {{"tangential_stiffness", "3e3"}}},
      {"tangential viscous", {{"tangential_damping", "0.01"}}},
      {"rolling spring", {{"rolling_stiffness", "1e-3"}, {"rolling_damping", "1e-9"}}},
      {"rolling viscous_coulomb", {{"rolling_damping", "1e-10"}}},
  };
  Given given = {{slot + "_type", name}};
  if (const auto found = needs.find(slot + " " + name); found != needs.end())
    given.insert(given.end(), found->second.begin(), found->second.end());
  return given;
}

/// Calls act(slot, name) for every law of every list.
template <class Act>
void each_law(Act&& act) {
  for (const auto& name : NormalModels::names()) act("normal", name);
  for (const auto& name : TangentialModels::names()) act("tangential", name);
  for (const auto& name : RollingModels::names()) act("rolling", name);
  for (const auto& name : TwistingModels::names()) act("twisting", name);
  for (const auto& name : AdhesionModels::names()) act("adhesion", name);
  for (const auto& name : DlvoModels::names()) act("dlvo", name);
  for (const auto& name : BridgeModels::names()) act("bridge", name);
  for (const auto& name : InterfacialModels::names()) act("interfacial", name);
  for (const auto& name : LubricationModels::names()) act("lubrication", name);
}

/// The laws of a case with one material, `bead`, and what the case adds.
struct LawCase {
  Options options;
  LawCase() {
    set("material_bead_density", "2500").set("material_bead_rolling_friction", "0.1");
    set("material_bead_friction", "0.5");
  }
  LawCase& set(const std::string& name, const std::string& value) {
    options.set(name, value);
    return *this;
  }
  /// With a restitution, unless one is given or the normal law has another damping.
  LawCase& damped() {
    const std::string law = options.find("normal_type").value_or("tsuji");
    const bool by_restitution =
        law == "tsuji" || ((law == "linear" || law == "walton_braun") && !options.given("normal_damping") &&
                           !options.given("normal_unloading_stiffness") && !options.given("normal_hardening"));
    if (by_restitution && !options.given("material_bead_restitution")) set("material_bead_restitution", "0.8");
    return *this;
  }
  LawCase& choose(const std::string& slot, const std::string& name) {
    for (const auto& [option, value] : law_options(slot, name)) set(option, value);
    return *this;
  }
};

/// The materials and laws of a case.
struct LawRun {
  /// With particles of all materials between two radii, if given.
  explicit LawRun(LawCase setup, double smallest = 0, double largest = 0)
      : materials(setup.damped().options), laws(setup.options, materials) {
    if (!(smallest > 0)) return;
    ParticleSizes sizes(materials.count());
    for (int m = 0; m < materials.count(); ++m) sizes.smallest[m] = smallest, sizes.largest[m] = largest;
    laws.set_sizes(sizes);
  }
  Materials materials;
  ContactLaws laws;
};

}  // namespace silt
