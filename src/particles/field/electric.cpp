#include "particles/field/electric.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/physical_constants.hpp"
#include "particles/field/turned.hpp"
#include "particles/particles.hpp"

namespace silt {
namespace {

constexpr double pi = std::numbers::pi;

}  // namespace

std::unique_ptr<Electric> Electric::create(Options& options, const Mesh& mesh, Columns& columns,
                                           const std::string& instructions) {
  ElectricOptions chosen;
  options.read("electric", chosen);
  if (chosen.type == "none") return nullptr;
  if (chosen.type == "ac" && !(chosen.frequency > 0))
    throw UserError("-electric_frequency is missing: -electric_type ac needs it");
  if (chosen.type == "dc" && chosen.polarisation == "conductivity" &&
      !(chosen.particle_conductivity + chosen.fluid_conductivity > 0))
    throw UserError(
        "-electric_polarisation conductivity needs -electric_particle_conductivity or "
        "-electric_fluid_conductivity above 0");
  return std::make_unique<Electric>(chosen, options, mesh, columns, instructions);
}

Electric::Electric(const ElectricOptions& chosen, Options& options, const Mesh& mesh, Columns& columns,
                   const std::string& instructions)
    : options_(chosen),
      field_("electric_field", chosen.field, (mesh.upper - mesh.lower).norm()),
      charge_formula_(std::make_shared<Expression>("electric_charge", chosen.charge)),
      permittivity_(vacuum_permittivity * chosen.fluid_permittivity),
      kernels_(choose_pair_kernels(instructions.c_str())) {
  const Dielectric sphere{vacuum_permittivity * chosen.particle_permittivity, permittivity_,
                          chosen.particle_conductivity, chosen.fluid_conductivity};
  if (chosen.type == "ac") {
    const auto factor = sphere.at(2 * pi * chosen.frequency);
    real_ = factor.real();
    imaginary_ = factor.imag();
  } else {
    real_ = chosen.polarisation == "conductivity" ? sphere.conducting() : sphere.insulating();
  }
  range_ = field_.range(mesh.lower, mesh.upper);
  for (int k = 0; k < 125; ++k) {
    const Vec3 share = Vec3(k % 5, k / 5 % 5, k / 25) / 4;
    largest_charge_ = std::max(
        largest_charge_, std::abs((*charge_formula_)(mesh.lower + share.cwiseProduct(mesh.upper - mesh.lower), 0)));
  }
  charge_ =
      columns.add({"charge", 1, GhostValues::none, true, [formula = charge_formula_](const Seed& seed, double* row) {
                     *row = (*formula)(seed.position, 0);
                   }});
  if (chosen.dipole.norm() > 0)
    moment_ = columns.add({"electric_moment", 3, GhostValues::none, true,
                           [dipole = chosen.dipole](const Seed&, double* row) { vec3(row) = dipole; }});
  if (chosen.solve)
    potential_ = std::make_unique<ElectricPotential>(mesh, options, permittivity_, chosen.charge_density);
  if (potential_) range_.largest += potential_->strongest();
}

void Electric::repel(FieldStep& step) {
  Store& store = step.store;
  const double* charge = store.columns.values(charge_);
  sources_.gather(store, charge, 1, step.communicator);
  if (options_.cutoff > 0) sources_.sort(step.periods, options_.cutoff);
  sum_.clear(sources_.count);
  kernels_.charges({&sources_, nullptr, &sum_, step.periods, options_.cutoff});
  for (int p = 0; p < store.owned; ++p) {
    const int at = sources_.place[p];
    const Vec3 force = charge[p] / (4 * pi * permittivity_) * Vec3(sum_.x[at], sum_.y[at], sum_.z[at]);
    vec3(store.present[p].force) += force;
    step.size += force.norm();
  }
}

void Electric::turn(Store& store, const double (*turned)[4]) {
  if (turns()) turn_vectors(store.columns.values(moment_), turned, store.owned);
}

void Electric::act(FieldStep& step) {
  Store& store = step.store;
  const bool alternating = options_.type == "ac", uniform = field_.uniform();
  const Vec3 everywhere = uniform ? field_(Vec3::Zero(), step.time) : Vec3::Zero();
  for (int p = 0; p < store.owned; ++p) {
    const Motion& motion = store.motion[p];
    const Vec3 x = vec3(motion.position);
    Vec3 field = uniform ? everywhere : field_(x, step.time);
    Mat3 gradient = uniform ? Mat3(Mat3::Zero()) : field_.gradient(x, step.time);
    if (potential_) {
      Vec3 solved;
      Mat3 slope;
      potential_->at(motion.position, store.cell[p], solved, slope);
      field += solved;
      gradient += slope;
    }
    const double cube = 8 * motion.radius * motion.radius * motion.radius;
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero(), moment = 0.5 * pi * permittivity_ * real_ * cube * field;
    if (alternating) {
      torque = -0.5 * pi * permittivity_ * imaginary_ * cube * field.squaredNorm() *
               (options_.rotation.norm() > 0 ? Vec3(options_.rotation.normalized()) : Vec3::Zero());
    } else {
      force = *store.columns.row(charge_, p) * field;
      if (moment_ >= 0) {
        const Vec3 permanent = vec3(store.columns.row(moment_, p));
        torque = permanent.cross(field);
        moment += permanent;
      }
    }
    force += gradient.transpose() * moment;
    vec3(store.present[p].force) += force;
    vec3(store.present[p].torque) += torque;
    step.external += force;
  }
  if (options_.coulomb) repel(step);
}

std::vector<StepBound> Electric::bounds(const Materials& materials, const SmallestRadii& smallest) const {
  std::vector<StepBound> bounds;
  if (range_.rate > 0) bounds.push_back({pi / range_.rate, fmt::format("change of the {} field", "electric")});
  for (int a = 0; a < materials.count(); ++a) {
    const double radius = smallest.radius[a];
    if (radius >= infinity) continue;
    const double mass = *materials[a].density * 4.0 / 3.0 * pi * radius * radius * radius;
    if (options_.coulomb && largest_charge_ > 0) {
      // In contact |dF/dr| = 2 F/r, r = d.
      const double stiffness =
          2 * largest_charge_ * largest_charge_ / (4 * pi * permittivity_ * std::pow(2 * radius, 3));
      bounds.push_back(
          {pi * std::sqrt(0.5 * mass / stiffness), fmt::format("electric force of {} in contact", materials[a].name)});
    }
    if (const double torque = options_.dipole.norm() * range_.largest; moment_ >= 0 && torque > 0)
      bounds.push_back({pi * std::sqrt(0.4 * mass * radius * radius / torque),
                        fmt::format("electric swing of {}", materials[a].name)});
  }
  return bounds;
}

std::string Electric::description() const {
  return fmt::format("electric {}, K = {:.4g}{}{}", options_.type, real_,
                     options_.type == "ac" ? fmt::format(" {:+.4g}j", imaginary_) : "",
                     options_.coulomb ? ", Coulomb" : "");
}

}  // namespace silt
