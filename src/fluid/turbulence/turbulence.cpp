#include "fluid/turbulence/turbulence.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"
#include "fluid/turbulence/algebraic.hpp"
#include "fluid/turbulence/realizable_k_epsilon.hpp"
#include "fluid/turbulence/sst_k_omega.hpp"
#include "fluid/turbulence/two_equation.hpp"
#include "fluid/turbulence/vertex_rule.hpp"
#include "fluid/turbulence/wall_distance.hpp"
#include "fluid/turbulence/wall_law.hpp"

namespace silt {

std::unique_ptr<Turbulence> Turbulence::create(const Mesh& mesh, Options& options, const BoundaryConditions& boundaries,
                                               bool axisymmetric) {
  TurbulenceOptions read;
  options.read("fluid", read);
  const bool equations = read.turbulence == RealizableKEpsilon::name || read.turbulence == SstKOmega::name;
  if (!equations) {
    for (const auto& name : Options::declared<TurbulenceOptions>())
      if (options.given("fluid_" + name) && name != "turbulence" && name != "turbulence_prandtl")
        throw UserError(fmt::format("-fluid_{} has no meaning with -fluid_turbulence {}", name, read.turbulence));
    refuse_inflow(mesh, options, "with -fluid_turbulence " + read.turbulence);
  }
  if (read.turbulence == RealizableKEpsilon::name)
    return std::make_unique<TwoEquation<RealizableKEpsilon>>(mesh, options, read, boundaries, axisymmetric);
  if (read.turbulence == SstKOmega::name)
    return std::make_unique<TwoEquation<SstKOmega>>(mesh, options, read, boundaries, axisymmetric);
  if (axisymmetric && read.turbulence != "none")
    throw UserError(fmt::format("-fluid_turbulence {} resolves eddies in space: not with -fluid_symmetry axisymmetric",
                                read.turbulence));
  if (read.turbulence == Smagorinsky::name)
    return std::make_unique<Algebraic<Smagorinsky>>(mesh, options, read, boundaries, axisymmetric);
  if (read.turbulence == Wale::name)
    return std::make_unique<Algebraic<Wale>>(mesh, options, read, boundaries, axisymmetric);
  return nullptr;
}

void Turbulence::refuse_inflow(const Mesh& mesh, const Options& options, const std::string& reason) {
  for (const auto& boundary : mesh.boundaries)
    for (const auto& name : Options::declared<TurbulenceInflowOptions>())
      if (options.given("boundary_" + boundary + "_turbulence_" + name))
        throw UserError(fmt::format("-boundary_{}_turbulence_{} has no meaning {}", boundary, name, reason));
}

void Turbulence::refuse(const Mesh& mesh, Options& options, const std::string& reason) {
  TurbulenceOptions read;
  options.read("fluid", read);
  if (read.turbulence != "none")
    throw UserError(fmt::format("-fluid_turbulence {} is not available {}", read.turbulence, reason));
  refuse_inflow(mesh, options, "without -fluid_turbulence");
}

std::vector<double> Turbulence::wall_distance_of(const Mesh& mesh, const BoundaryConditions& boundaries) {
  std::vector<char> wall(mesh.boundaries.size());
  for (std::size_t b = 0; b < wall.size(); ++b) wall[b] = boundaries.type(static_cast<int>(b)) == BoundaryType::no_slip;
  return silt::wall_distance(mesh, wall);
}

std::vector<double> Turbulence::cell_eddy_conductivity(double heat_capacity, double conductivity,
                                                       double viscosity) const {
  const double Pr = conductivity > 0 ? heat_capacity * viscosity / conductivity : infinity;
  const std::vector<double> everywhere(cell_eddy_viscosity_.size(), viscosity);
  return cell_eddy_conductivity(heat_capacity, Pr, everywhere);
}

std::vector<double> Turbulence::cell_eddy_conductivity(double heat_capacity, double prandtl,
                                                       std::span<const double> viscosity) const {
  std::vector<double> result(cell_eddy_viscosity_.size());
  for (std::size_t c = 0; c < result.size(); ++c) {
    result[c] = heat_capacity * cell_eddy_viscosity_[c] / options_.prandtl;
    if (const double y = wall_y_plus_[c]; y > 0 && prandtl < infinity)
      result[c] = std::max(0.0, heat_capacity * viscosity[c] * (y / wall_law::temperature(y, prandtl) - 1 / prandtl));
  }
  return result;
}

Turbulence::Snapshot Turbulence::snapshot() {
  std::vector<Fluid::StateArray> arrays;
  add_state(arrays);
  Snapshot kept;
  for (const auto& array : arrays) kept.push_back(*array.values);
  return kept;
}

void Turbulence::restore(const Snapshot& kept) {
  std::vector<Fluid::StateArray> arrays;
  add_state(arrays);
  for (std::size_t k = 0; k < arrays.size(); ++k) *arrays[k].values = kept[k];
  restored();
}

void Turbulence::add_transposed_stress(const Mesh& mesh, std::span<const double> velocity,
                                       std::span<const double> void_fraction, std::vector<double>& force) const {
  const VertexRule rule(mesh, false);
  std::vector<double> shared(mesh.nodes), slope, gradient;
  for (int i = 0; i < mesh.nodes; ++i) shared[i] = void_fraction[i] * eddy_viscosity_[i];
  rule.gradient(shared, 1, slope);
  rule.gradient(velocity, 3, gradient);
  for (std::size_t i = 0; i < shared.size(); ++i)
    for (int d = 0; d < mesh.dimension; ++d)
      for (int j = 0; j < mesh.dimension; ++j) force[3 * i + d] += slope[3 * i + j] * gradient[9 * i + 3 * j + d];
}

void Turbulence::add_scalars(std::vector<Fluid::Scalar>& scalars) const {
  scalars.push_back({"eddy_viscosity", eddy_viscosity_});
  scalars.push_back({"wall_distance", wall_distance_});
}

void Turbulence::add_state(std::vector<Fluid::StateArray>& arrays) {
  arrays.push_back({"eddy_viscosity", &eddy_viscosity_, 1});
  arrays.push_back({"cell_eddy_viscosity", &cell_eddy_viscosity_, 1, true});
  arrays.push_back({"wall_y_plus", &wall_y_plus_, 1, true});
}

}  // namespace silt
