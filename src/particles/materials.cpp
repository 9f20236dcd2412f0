#include "particles/materials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.hpp"

namespace silt {
namespace {

PairProperties mean_of(const Material& a, const Material& b) {
  const auto shear = [](const Material& m) { return m.young_modulus / (2 * (1 + m.poisson_ratio)); };
  const auto plane = [](const Material& m) { return (1 - m.poisson_ratio * m.poisson_ratio) / m.young_modulus; };
  PairProperties pair;
  pair.effective_young = 1 / (plane(a) + plane(b));
  pair.effective_shear = 1 / ((2 - a.poisson_ratio) / shear(a) + (2 - b.poisson_ratio) / shear(b));
  pair.poisson_ratio = 0.5 * (a.poisson_ratio + b.poisson_ratio);
  pair.restitution = 0.5 * (a.restitution + b.restitution);
  pair.friction = 0.5 * (a.friction + b.friction);
  pair.rolling_friction = 0.5 * (a.rolling_friction + b.rolling_friction);
  pair.yield_pressure = std::min(a.yield_pressure.value_or(infinity), b.yield_pressure.value_or(infinity));
  pair.surface_energy = std::sqrt(a.surface_energy * b.surface_energy);
  pair.hamaker = std::sqrt(a.hamaker * b.hamaker);
  pair.potential_product = a.surface_potential * b.surface_potential;
  pair.potential_squares = a.surface_potential * a.surface_potential + b.surface_potential * b.surface_potential;
  return pair;
}

}  // namespace

Materials::Materials(Options& options) {
  const auto note_restitution = [&](const std::string& prefix) {
    if (restitution_given_.empty() && options.given(prefix + "_restitution"))
      restitution_given_ = "-" + prefix + "_restitution";
  };
  for (const auto& name : options.names("material", Options::declared<Material>())) {
    Material material;
    material.name = name;
    options.read("material_" + name, material);
    note_restitution("material_" + name);
    if (!material.density)
      throw UserError(
          fmt::format("material {} has no density: give -material_{}_density in kg/m3 (positive)", name, name));
    materials_.push_back(material);
  }
  const int n = count();
  pairs_.resize(static_cast<size_t>(n) * n);
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < n; ++b) pairs_[a * n + b] = mean_of(materials_[std::min(a, b)], materials_[std::max(a, b)]);

  std::map<std::pair<int, int>, std::string> named;
  for (const auto& name : options.names("pair", Options::declared<PairOverride>())) {
    int first = -1, second = -1;
    for (int a = 0; a < n; ++a)
      for (int b = 0; b < n; ++b)
        if (materials_[a].name + "_" + materials_[b].name == name) first = a, second = b;
    if (first < 0) {
      std::vector<std::string> known;
      for (int a = 0; a < n; ++a)
        for (int b = a; b < n; ++b) known.push_back(materials_[a].name + "_" + materials_[b].name);
      throw UserError(fmt::format("-pair_{}_...: {} is not a pair of materials; the pairs are {}", name, name,
                                  fmt::join(known, ", ")));
    }
    if (const std::string& before = named[{std::min(first, second), std::max(first, second)}]; !before.empty())
      throw UserError(fmt::format("-pair_{}_... and -pair_{}_... are the same pair of materials", before, name));
    named[{std::min(first, second), std::max(first, second)}] = name;
    PairOverride given;
    options.read("pair_" + name, given);
    note_restitution("pair_" + name);
    for (const int k : {first * n + second, second * n + first}) {
      if (given.restitution) pairs_[k].restitution = *given.restitution;
      if (given.friction) pairs_[k].friction = *given.friction;
      if (given.rolling_friction) pairs_[k].rolling_friction = *given.rolling_friction;
      if (given.yield_pressure) pairs_[k].yield_pressure = *given.yield_pressure;
      if (given.surface_energy) pairs_[k].surface_energy = *given.surface_energy;
      if (given.hamaker) pairs_[k].hamaker = *given.hamaker;
    }
  }
}

}  // namespace silt
