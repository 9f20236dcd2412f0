#include "fluid/boundary/boundary_conditions.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.hpp"

namespace silt {
namespace {

constexpr int symmetric[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};

}  // namespace

void BoundaryOptions::options(OptionGroup& option) {
  option("type", type,
         {"no_slip", "slip", "symmetry", "velocity", "mass_flow", "pressure", "total_pressure", "far_field",
          "supersonic_inflow", "supersonic_outflow"},
         "what the flow obeys on this boundary; slip and symmetry are the same; the last four are for compressible "
         "flow");
  option("velocity", velocity,
         "m/s; type velocity: superficial velocity (void fraction times velocity) as formulas in x, y, z, t; type "
         "no_slip: velocity of the wall; far_field, supersonic_inflow: velocity outside");
  rotation.options(option);
  option("mass_flow", mass_flow, "kg/s into the domain (per metre of depth in 2D), a formula in t; normal");
  option("profile", profile,
         "type mass_flow: how the flow is spread over the boundary, a formula in x, y, z, t of which only the shape "
         "counts: y*(1 - y) for a parabola");
  option(
      "pressure", pressure,
      "Pa, formula in x, y, z, t: static pressure (pressure), stagnation pressure (total_pressure), pressure outside "
      "(far_field, supersonic_inflow); velocity, viscous gas: pressure of what enters");
  option.group("temperature", temperature);
  option.group("turbulence", turbulence);
}

BoundaryConditions::BoundaryConditions(const Mesh& mesh, Options& options, double density, bool compressible,
                                       bool axisymmetric)
    : mesh_(mesh),
      compressible_(compressible),
      axisymmetric_(axisymmetric),
      density_(density),
      facets_(facet_rules(mesh)) {
  read(options);
  areas_.assign(mesh.boundaries.size(), 0);
  for (const auto& facet : facets_)
    for (int q = 0; q < facet.points; q++) areas_[facet.boundary] += facet.point[q].area.norm();
  for (auto& area : areas_) area = mpi_sum(area);
  spread_.assign(mesh.boundaries.size(), 0);
  refuse_moving_through();
  find_nodes();
  velocity_.assign(3 * mesh.nodes, 0);
  pressure_.assign(mesh.nodes, 0);
  flow_.assign(mesh.nodes, 0);
  boundary_flow_.assign(mesh.boundaries.size(), 0);
}

void BoundaryConditions::read(Options& options) {
  std::string missing;
  for (const auto& name : mesh_.boundaries) {
    const std::string prefix = "boundary_" + name;
    BoundaryOptions given;
    options.read(prefix, given);
    Condition condition;
    if (given.type.empty()) {
      missing += (missing.empty() ? "" : ", ") + name;
      conditions_.push_back(std::move(condition));
      continue;
    }
    using enum BoundaryType;
    condition.type = given.type == "no_slip"              ? no_slip
                     : given.type == "velocity"           ? velocity
                     : given.type == "mass_flow"          ? mass_flow
                     : given.type == "pressure"           ? pressure
                     : given.type == "total_pressure"     ? total_pressure
                     : given.type == "far_field"          ? far_field
                     : given.type == "supersonic_inflow"  ? supersonic_inflow
                     : given.type == "supersonic_outflow" ? supersonic_outflow
                                                          : slip;
    if (!compressible_ && condition.type > pressure)
      throw UserError(fmt::format("-{}_type ({}): '{}' needs -fluid_type compressible", prefix,
                                  options.origin(prefix + "_type"), given.type));
    const bool outside = condition.type == far_field || condition.type == supersonic_inflow;
    const auto check = [&](const char* property, bool allowed, bool required) {
      const std::string option = prefix + "_" + property;
      if (options.given(option) && !allowed)
        throw UserError(fmt::format("-{} has no meaning on a boundary of type {}", option, given.type));
      if (required && !options.given(option))
        throw UserError(fmt::format("-{} is missing: boundary {} has type {}", option, name, given.type));
    };
    check("velocity", condition.type == velocity || condition.type == no_slip || outside,
          condition.type == velocity || condition.type == supersonic_inflow);
    check("rotation_rate", condition.type == no_slip, false);
    for (const char* property : {"rotation_axis", "rotation_centre"})
      check(property, condition.type == no_slip && options.given(prefix + "_rotation_rate"), false);
    check("mass_flow", condition.type == mass_flow, condition.type == mass_flow);
    check("profile", condition.type == mass_flow, false);
    check("pressure",
          condition.type == pressure || condition.type == total_pressure || outside ||
              (compressible_ && condition.type == velocity),
          condition.type == total_pressure || outside || (compressible_ && condition.type == pressure));
    condition.moving =
        condition.type == no_slip && (options.given(prefix + "_velocity") || options.given(prefix + "_rotation_rate"));
    condition.velocity =
        std::make_unique<VectorExpression>(prefix + "_velocity", given.rotation.formula(prefix, given.velocity));
    condition.mass_flow = std::make_unique<Expression>(prefix + "_mass_flow", given.mass_flow);
    if (!condition.mass_flow->uniform())
      throw UserError(
          fmt::format("option -{0}_mass_flow: '{1}' depends on the place; it is one number for the whole "
                      "boundary, -{0}_profile says how it is spread",
                      prefix, given.mass_flow));
    condition.profile = std::make_unique<Expression>(prefix + "_profile", given.profile);
    condition.pressure = std::make_unique<Expression>(prefix + "_pressure", given.pressure);
    condition.has_pressure = condition.type == velocity && options.given(prefix + "_pressure");
    closed_ = closed_ && condition.type < pressure;
    conditions_.push_back(std::move(condition));
  }
  if (!missing.empty())
    throw UserError(fmt::format(
        "no condition on boundary {}: give -boundary_<name>_type no_slip, slip, symmetry, "
        "velocity, mass_flow or pressure{}",
        missing, compressible_ ? ", total_pressure, far_field, supersonic_inflow or supersonic_outflow" : ""));
}

void BoundaryConditions::refuse_moving_through() const {
  for (std::size_t b = 0; b < conditions_.size(); b++) {
    if (!conditions_[b].moving) continue;
    const Expression::Trial trial;
    for (double time : {0.0, 1.0}) {  // a wall may start from rest
      double through = 0, along = 0;
      for (const auto& facet : facets_) {
        if (facet.boundary != static_cast<int>(b)) continue;
        double flow = 0;  // a facet of a shaft is a chord: what goes in at one end comes out at the other
        for (int q = 0; q < facet.points; q++) {
          const Vec3 u = (*conditions_[b].velocity)(facet.point[q].x, time);
          flow += u.dot(facet.point[q].area);
          along += u.norm() * facet.point[q].area.norm();
        }
        through += std::abs(flow);
      }
      if (mpi_sum(through) > 0.01 * mpi_sum(along))
        throw UserError(fmt::format(
            "-boundary_{0}_velocity, -boundary_{0}_rotation_rate: the wall would move through its own surface, which "
            "stays where it is; only motion along it is available (type velocity: fluid that passes a boundary)",
            mesh_.boundaries[b]));
    }
  }
}

void BoundaryConditions::find_nodes() {
  const int nodes = mesh_.nodes, count = static_cast<int>(conditions_.size());
  velocity_boundary_.assign(nodes, -1);
  pressure_boundary_.assign(nodes, -1);
  normal_.assign(3 * nodes, 0);
  std::vector<int> best(nodes, std::numeric_limits<int>::max());
  // A node may lie on a boundary whose facets all belong to other ranks: count over all ranks, one boundary at a time.
  // Touches [0], area-weighted normal [1..3], moments of the unit normals [4..9].
  std::vector<double> touch(10 * static_cast<std::size_t>(nodes)), slip_normals(6 * static_cast<std::size_t>(nodes));
  for (int b = 0; b < count; b++) {
    std::fill(touch.begin(), touch.end(), 0.0);
    for (const auto& facet : facets_) {
      if (facet.boundary != b) continue;
      Vec3 area = Vec3::Zero();
      for (int q = 0; q < facet.points; q++) area += facet.point[q].area;
      const Vec3 unit = area.normalized();
      for (int a = 0; a < facet.nodes; a++) {
        double* t = &touch[10 * static_cast<std::size_t>(facet.node[a])];
        t[0] += 1;
        for (int d = 0; d < 3; d++) t[1 + d] += area[d];
        for (int m = 0; m < 6; m++) t[4 + m] += unit[symmetric[m][0]] * unit[symmetric[m][1]];
      }
    }
    mesh_.sum_shared(touch.data(), 10);
    const auto& condition = conditions_[b];
    for (int i = 0; i < nodes; i++) {
      const double* t = &touch[10 * static_cast<std::size_t>(i)];
      if (t[0] == 0) continue;
      if (open(b)) {
        if (condition.type == BoundaryType::pressure && pressure_boundary_[i] < 0) pressure_boundary_[i] = b;
        continue;
      }
      if (condition.type == BoundaryType::slip)
        for (int m = 0; m < 6; m++) slip_normals[6 * static_cast<std::size_t>(i) + m] += t[4 + m];
      const int rank = strength(b);
      if (rank < best[i]) {
        best[i] = rank;
        velocity_boundary_[i] = b;
        vec3(&normal_[3 * i]) = Vec3(t[1], t[2], t[3]).normalized();
      }
    }
  }
  find_constraints(slip_normals);
}

void BoundaryConditions::find_constraints(const std::vector<double>& slip_normals) {
  for (int i = 0; i < mesh_.nodes; i++) {
    if (velocity_boundary_[i] < 0) continue;
    Constraint constraint{i, 3, {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()}};
    if (type(velocity_boundary_[i]) == BoundaryType::slip) {
      Mat3 moments;
      for (int m = 0; m < 6; m++)
        moments(symmetric[m][0], symmetric[m][1]) = moments(symmetric[m][1], symmetric[m][0]) =
            slip_normals[6 * static_cast<std::size_t>(i) + m];
      Eigen::SelfAdjointEigenSolver<Mat3> eigen(moments);
      // Two facets whose normals differ by d give eigenvalues in the ratio tan2(d/2): 0.05 is 25 degrees.
      constraint.count = 0;
      for (int k = 2; k >= 0; k--)
        if (eigen.eigenvalues()[k] > 0.05 * eigen.eigenvalues()[2])
          constraint.direction[constraint.count++] = eigen.eigenvectors().col(k);
    }
    constraints_.push_back(constraint);
  }
}

void BoundaryConditions::spread_mass_flows(double time) {
  for (std::size_t b = 0; b < conditions_.size(); b++) {
    const auto& condition = conditions_[b];
    if (condition.type != BoundaryType::mass_flow) continue;
    double integral = 0, magnitude = 0;
    for (const auto& facet : facets_) {
      if (facet.boundary != static_cast<int>(b)) continue;
      for (int q = 0; q < facet.points; q++) {
        const Vec3& x = facet.point[q].x;
        const double share =
            (*condition.profile)(x, time) * facet.point[q].area.norm() * (axisymmetric_ ? 2 * M_PI * x.y() : 1.0);
        integral += share, magnitude += std::abs(share);
      }
    }
    integral = mpi_sum(integral), magnitude = mpi_sum(magnitude);
    if (!(integral > 1e-6 * magnitude))
      throw RunError(
          fmt::format("option -boundary_{}_profile: its integral over the boundary is not above 0 at t = {:g} s",
                      mesh_.boundaries[b], time));
    spread_[b] = (*condition.mass_flow)(Vec3::Zero(), time) / integral;
  }
}

double BoundaryConditions::mass_flux(int b, const Vec3& x, double time) const {
  return spread_[b] * (*conditions_[b].profile)(x, time);
}

void BoundaryConditions::evaluate(double time, const double* void_fraction) {
  spread_mass_flows(time);
  for (const auto& constraint : constraints_) {
    const int i = constraint.node, b = velocity_boundary_[i];
    const auto& condition = conditions_[b];
    auto value = vec3(&velocity_[3 * i]);
    const double alpha = void_fraction ? void_fraction[i] : 1.0;
    if (condition.type == BoundaryType::velocity)
      value = (*condition.velocity)(vec3(&mesh_.node_coordinates[3 * i]), time) / alpha;
    else if (condition.type == BoundaryType::mass_flow)
      value = vec3(&normal_[3 * i]) * (-mass_flux(b, vec3(&mesh_.node_coordinates[3 * i]), time) / (density_ * alpha));
    else if (condition.moving)
      value = (*condition.velocity)(vec3(&mesh_.node_coordinates[3 * i]), time);
    if (mesh_.dimension == 2) value.z() = 0;
  }
  for (int i = 0; i < mesh_.nodes; i++)
    if (pressure_boundary_[i] >= 0)
      pressure_[i] = (*conditions_[pressure_boundary_[i]].pressure)(vec3(&mesh_.node_coordinates[3 * i]), time);
  add_flow(time);
}

Vec3 BoundaryConditions::prescribed(int b, const Vec3& x, const Vec3& normal, double time, double void_fraction) const {
  const auto& condition = conditions_[b];
  Vec3 value = Vec3::Zero();
  if (condition.type == BoundaryType::velocity)
    value = (*condition.velocity)(x, time) / void_fraction;
  else if (condition.type == BoundaryType::mass_flow)
    value = normal * (-mass_flux(b, x, time) / (density_ * void_fraction));
  else if (condition.moving)
    value = (*condition.velocity)(x, time);
  if (mesh_.dimension == 2) value.z() = 0;
  return value;
}

void BoundaryConditions::add_flow(double time) {
  std::fill(flow_.begin(), flow_.end(), 0.0);
  std::fill(boundary_flow_.begin(), boundary_flow_.end(), 0.0);
  throughput_ = 0;
  if (compressible_) return;
  bool flows = false;
  for (const auto& condition : conditions_)
    flows = flows || condition.type == BoundaryType::velocity || condition.type == BoundaryType::mass_flow;
  if (!flows) return;
  for (const auto& facet : facets_) {
    const auto& condition = conditions_[facet.boundary];
    const bool by_mass = condition.type == BoundaryType::mass_flow;
    if (condition.type != BoundaryType::velocity && !by_mass) continue;
    for (int q = 0; q < facet.points; q++) {
      const auto& point = facet.point[q];
      const double out = by_mass ? -mass_flux(facet.boundary, point.x, time) / density_ * point.area.norm()
                                 : (*condition.velocity)(point.x, time).dot(point.area);
      boundary_flow_[facet.boundary] += out;
      throughput_ += std::abs(out);
      for (int a = 0; a < facet.nodes; a++) flow_[facet.node[a]] += point.shape[a] * out;
    }
  }
  mesh_.sum_shared(flow_.data(), 1);
  MPI_Allreduce(MPI_IN_PLACE, boundary_flow_.data(), static_cast<int>(boundary_flow_.size()), MPI_DOUBLE, MPI_SUM,
                PETSC_COMM_WORLD);
  throughput_ = mpi_sum(throughput_);
}

void BoundaryConditions::check_balance(double volume_rate, double dt) const {
  if (!closed_) return;
  double flows = 0;
  for (double flow : boundary_flow_) flows += flow;
  const double rest = std::abs(flows + volume_rate), round_off = dt > 0 ? 1e-11 * mesh_.volume / dt : 0;
  if (rest > std::max(0.01 * (throughput_ + std::abs(volume_rate)), round_off))
    throw RunError(
        fmt::format("the flow cannot be conserved: the boundaries prescribe an outflow of {:.3g} m3/s in all, the "
                    "fluid's volume changes by {:.3g} m3/s, and no boundary has type pressure",
                    flows, volume_rate));
}

void BoundaryConditions::impose(double* u) const {
  for (const auto& constraint : constraints_) {
    auto value = vec3(u + 3 * constraint.node);
    const auto given = vec3(&velocity_[3 * constraint.node]);
    if (constraint.count == 3) {
      value = given;
      continue;
    }
    for (int k = 0; k < constraint.count; k++) {
      const Vec3& n = constraint.direction[k];
      value += n * n.dot(given - value);
    }
  }
}

void BoundaryConditions::project(double* r) const {
  for (const auto& constraint : constraints_) {
    auto value = vec3(r + 3 * constraint.node);
    if (constraint.count == 3) {
      value.setZero();
      continue;
    }
    for (int k = 0; k < constraint.count; k++) value -= constraint.direction[k] * constraint.direction[k].dot(value);
  }
}

}  // namespace silt
