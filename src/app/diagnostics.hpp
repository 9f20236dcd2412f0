#pragma once
#include <string>
#include <vector>

#include "app/moment.hpp"
#include "base/csv.hpp"
#include "base/mesh.hpp"
#include "base/output_directory.hpp"

namespace silt {

/// The integrals of a run through time: `diagnostics.csv` and, with a fluid, `boundaries.csv`, a row a step.
///
/// Heights are measured against gravity from the lowest point of the mesh (without gravity: along the last axis).
/// - bed_height: twice the height of the particles' centre of mass, the height of a homogeneous bed;
/// - bed_height_95: below it lie 95 % of the particles' volume;
/// - bed_solids: the particles' volume over cross-section times bed_height (cross-section: mesh volume over its
/// height);
/// - mean_temperature_of_particles, mean_charge_of_particles, mean_magnetic_moment_of_particles_x ...: the mean over
/// the
///   particles of what they carry besides their motion.
/// - pressure_drop: mean pressure of the boundaries where fluid is given (velocity, mass_flow) minus that of the
///   pressure boundaries; where there are no such two, the largest minus the least mean pressure of a boundary.
///   It is the pressure the fluid is solved for: without the static head rho g.x unless `-fluid_hydrostatic yes`.
class Diagnostics {
 public:
  Diagnostics(const Mesh& mesh, Options& options, const Vec3& gravity, const Fluid* fluid, const Particles* particles);
  /// Opens the files. Collective.
  void start(const OutputDirectory& directory);
  /// Measures, writes a row, and adds every column to `quantities`. Collective.
  void sample(const Moment& moment, Quantities& quantities);
  /// Columns of both files as quantities, for checking names.
  std::vector<std::string> columns() const;

 private:
  void measure_particles(const Particles& particles, std::vector<double>& row) const;
  void measure_fluid(const Moment& moment, std::vector<double>& row, std::vector<double>& flows) const;

  const Mesh& mesh_;
  Vec3 up_;
  double bottom_, height_;
  bool with_fluid_, with_heat_, with_gas_, with_drive_, with_particles_;
  std::vector<int> carried_;  ///< columns of the particles whose means are recorded
  std::vector<std::string> columns_, boundary_columns_;
  std::vector<int> role_;            ///< of each boundary: 1 fluid is given, -1 pressure is given, 0 neither
  std::vector<double> area_, mass_;  ///< area of each boundary; volume that belongs to each node
  CsvWriter table_, boundary_table_;
};

}  // namespace silt
