#include "fluid/boundary/temperature_boundaries.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "base/error.hpp"

namespace silt {

TemperatureBoundaries::TemperatureBoundaries(const Mesh& mesh, Options& options, const BoundaryConditions& boundaries)
    : mesh_(mesh), boundaries_(boundaries) {
  for (size_t b = 0; b < mesh_.boundaries.size(); ++b) {
    const std::string& name = mesh_.boundaries[b];
    const std::string prefix = "boundary_" + name + "_temperature";
    TemperatureOptions read;
    options.read(prefix, read);
    const BoundaryType flow = boundaries_.type(static_cast<int>(b));
    const bool open = boundaries_.open(static_cast<int>(b));
    const bool inflow = flow == BoundaryType::velocity || flow == BoundaryType::mass_flow;
    const bool enters = open && flow != BoundaryType::pressure && flow != BoundaryType::supersonic_outflow;
    if (open && !read.type.empty())
      throw UserError(
          fmt::format("-{}_type: on an open boundary heat leaves with the fluid; only {}_value, the temperature of "
                      "fluid that enters, can be given",
                      prefix, prefix));
    if (read.type == "inflow" && (!inflow || boundaries_.compressible()))
      throw UserError(
          fmt::format("-{}_type inflow is for boundaries of type velocity and mass_flow of an incompressible "
                      "fluid",
                      prefix));
    if (read.type.empty()) read.type = !inflow || open ? "adiabatic" : boundaries_.compressible() ? "given" : "inflow";
    Condition c;
    c.kind = read.type == "given"           ? Condition::given
             : read.type == "flux"          ? Condition::flux
             : read.type == "heat_transfer" ? Condition::heat_transfer
             : read.type == "inflow"        ? Condition::inflow
                                            : Condition::adiabatic;
    const auto check = [&](const char* property, bool allowed, bool required) {
      const std::string option = prefix + "_" + property;
      if (options.given(option) && !allowed)
        throw UserError(fmt::format("-{} has no meaning with -{}_type {}", option, prefix, read.type));
      if (required && !options.given(option))
        throw UserError(fmt::format("-{} is missing: the temperature condition of boundary {} is {}", option, name,
                                    enters ? "that of what enters" : read.type));
    };
    const bool outside =
        c.kind == Condition::given || c.kind == Condition::heat_transfer || c.kind == Condition::inflow || enters;
    check("value", outside || flow == BoundaryType::pressure, outside);
    check("flux", c.kind == Condition::flux, c.kind == Condition::flux);
    check("coefficient", c.kind == Condition::heat_transfer, c.kind == Condition::heat_transfer);
    c.has_value = options.given(prefix + "_value");
    c.value = std::make_unique<Expression>(prefix + "_value", read.value);
    c.flux_density = std::make_unique<Expression>(prefix + "_flux", read.flux);
    c.coefficient = std::make_unique<Expression>(prefix + "_coefficient", read.coefficient);
    conditions_.push_back(std::move(c));
  }
  std::vector<char> given, entered;
  for (size_t b = 0; b < conditions_.size(); ++b) {
    const Condition& c = conditions_[b];
    given.push_back(c.kind == Condition::given);
    entered.push_back(c.kind == Condition::inflow || boundaries_.type(static_cast<int>(b)) == BoundaryType::pressure);
  }
  fixed_boundary_ = strongest(given);
  entered_boundary_ = strongest(entered);
  for (const int boundary : fixed_boundary_) fixed_.push_back(boundary >= 0);
}

std::vector<int> TemperatureBoundaries::strongest(const std::vector<char>& has_it) const {
  std::vector<int> found(mesh_.nodes, -1), best(mesh_.nodes, std::numeric_limits<int>::max());
  std::vector<double> touch(mesh_.nodes);
  for (size_t b = 0; b < conditions_.size(); ++b) {
    if (!has_it[b]) continue;
    std::fill(touch.begin(), touch.end(), 0.0);
    for (const auto& facet : boundaries_.facets())
      if (facet.boundary == static_cast<int>(b))
        for (int a = 0; a < facet.nodes; ++a) touch[facet.node[a]] = 1;
    mesh_.sum_shared(touch.data(), 1);
    const int strength = boundaries_.strength(static_cast<int>(b));
    for (int i = 0; i < mesh_.nodes; ++i)
      if (touch[i] > 0 && strength < best[i]) {
        best[i] = strength;
        found[i] = static_cast<int>(b);
      }
  }
  return found;
}

double TemperatureBoundaries::given(int node, double t) const {
  return (*conditions_[fixed_boundary_[node]].value)(vec3(&mesh_.node_coordinates[3 * static_cast<size_t>(node)]), t);
}

/// f(facet, point, heat per area that does not depend on T, coefficient) over `flux` and `heat_transfer` boundaries.
template <class F>
void TemperatureBoundaries::for_each_point(double t, F f) const {
  for (const auto& facet : boundaries_.facets()) {
    const Condition& c = conditions_[facet.boundary];
    if (c.kind != Condition::flux && c.kind != Condition::heat_transfer) continue;
    for (int p = 0; p < facet.points; ++p) {
      const FacetPoint& point = facet.point[p];
      const bool transfer = c.kind == Condition::heat_transfer;
      const double h = transfer ? (*c.coefficient)(point.x, t) : 0.0;
      f(facet, point, transfer ? h * (*c.value)(point.x, t) : (*c.flux_density)(point.x, t), h);
    }
  }
}

void TemperatureBoundaries::heat(double t, bool axisymmetric, std::vector<double>& heat,
                                 std::vector<double>& coefficient) const {
  std::vector<double> sums(2 * static_cast<size_t>(mesh_.nodes), 0.0);
  for_each_point(t, [&](const FacetRule& facet, const FacetPoint& point, double q, double h) {
    const double area = point.area.norm() * (axisymmetric ? point.x.y() : 1.0);
    for (int a = 0; a < facet.nodes; ++a) {
      sums[2 * static_cast<size_t>(facet.node[a])] += point.shape[a] * area * q;
      sums[2 * static_cast<size_t>(facet.node[a]) + 1] += point.shape[a] * area * h;
    }
  });
  mesh_.sum_shared(sums.data(), 2);
  heat.resize(mesh_.nodes);
  coefficient.resize(mesh_.nodes);
  for (size_t i = 0; i < heat.size(); ++i) {
    heat[i] = sums[2 * i];
    coefficient[i] = sums[2 * i + 1];
  }
}

void TemperatureBoundaries::add_heat_flow(double t, const std::vector<double>& T, std::vector<double>& flow) const {
  for_each_point(t, [&](const FacetRule& facet, const FacetPoint& point, double q, double h) {
    for (int a = 0; a < facet.nodes; ++a)
      flow[facet.boundary] -= point.shape[a] * point.area.norm() * (q - h * T[facet.node[a]]);
  });
}

void TemperatureBoundaries::refuse(const Mesh& mesh, const Options& options, const std::string& reason) {
  for (const auto& boundary : mesh.boundaries)
    for (const auto& name : Options::declared<TemperatureOptions>())
      if (options.given("boundary_" + boundary + "_temperature_" + name))
        throw UserError(fmt::format("-boundary_{}_temperature_{} has no meaning {}", boundary, name, reason));
}

}  // namespace silt
