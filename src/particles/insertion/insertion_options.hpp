#pragma once
#include <optional>
#include <string>

#include "base/options.hpp"

namespace silt {

/// The options `-insertion_<name>_...`: one set of particles present at the start.
struct InsertionOptions {
  std::string type = "fill", material, file;
  std::optional<double> diameter;
  std::string diameter_distribution = "mono";
  double diameter_deviation = 0;
  int count = 0;
  std::optional<double> solids_fraction;
  std::optional<Vec3> lower, upper;
  std::string cylinder = "none";
  int seed = 1;
  Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();
  std::optional<double> spacing;
  std::optional<double> jitter;
  double largest_overlap = 0.05;

  void options(OptionGroup& option) {
    option("type", type, {"fill", "lattice", "file"},
           "fill: at random without overlaps; lattice: simple cubic; file: as a CSV or HDF5 file says");
    option("material", material, "material of the particles; default: the first in alphabetical order");
    option("diameter", diameter, "m", "(mean) diameter", positive);
    option("diameter_distribution", diameter_distribution, {"mono", "uniform", "normal", "lognormal"},
           "all of one diameter, or spread about the mean (fill only)");
    option("diameter_deviation", diameter_deviation, "m",
           "standard deviation of the diameter; uniform: the half-width of the interval; normal deviates stay within "
           "3, diameters above a tenth of the mean",
           non_negative);
    option("count", count, "-", "number of particles; 0: by solids_fraction (fill), as many as fit (lattice)",
           at_least(0));
    option("solids_fraction", solids_fraction, "-", "particle volume as a share of the region's volume",
           Range{0, 1, true, true});
    option("lower", lower, "m", "lowest corner of the region that holds the whole particles; default: the mesh's");
    option("upper", upper, "m", "highest corner of the region; default: the mesh's");
    option("cylinder", cylinder, {"none", "x", "y", "z"}, "axis of the cylinder that fits into the region's box");
    option("seed", seed, "-", "another seed, another random filling", at_least(0));
    option("file", file,
           "CSV (header: x,y,z,diameter|radius[,vx,vy,vz,wx,wy,wz,material]) or HDF5 (an output of a run, "
           "particles/000010.h5)");
    option("velocity", velocity, "m/s", "velocity at the start (file: unless it has its own)");
    option("spin", spin, "rad/s", "angular velocity at the start (file: unless it has its own)");
    option("spacing", spacing, "m", "distance of lattice sites; default: the diameter", positive);
    option("jitter", jitter, "-",
           "how far particles are moved off lattice sites, as a share of what keeps them apart; default: 0.9 (fill), 0 "
           "(lattice)",
           fraction);
    option("largest_overlap", largest_overlap, "-",
           "overlap allowed to particles from a file, as a share of the smaller radius", fraction);
  }
};

}  // namespace silt
