#pragma once
#include <optional>
#include <string>
#include <vector>

#include "base/options.hpp"

namespace silt {

/// The options `-insertion_<name>_...`: one set of particles, present at the start or added during the run.
struct InsertionOptions {
  std::string type = "fill", material;
  InputFile file;
  std::optional<double> diameter;
  std::string diameter_distribution = "mono", share_by = "number";
  std::vector<double> diameters, diameter_shares, material_shares;
  std::vector<std::string> materials;
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
  double mass_rate = 0, number_rate = 0, start = 0, end = 1e300, interval = 0, velocity_scatter = 0;
  double mass = 0, radius = 0;
  std::optional<Vec3> centre, normal;

  void options(OptionGroup& option) {
    option("type", type, {"fill", "pack", "lattice", "file", "stream"},
           "fill: at random without overlaps; pack: a dense random packing, up to 62 % solids; lattice: simple cubic; "
           "file: as a CSV or HDF5 file says; stream: added during the run at a rate");
    option("material", material, "material of the particles; default: the first in alphabetical order");
    option("materials", materials, "several materials, drawn at random by their shares");
    option("material_shares", material_shares, "-", "share of each of the materials in the number of particles",
           non_negative);
    option("diameter", diameter, "m", "(mean) diameter", positive);
    option("diameter_distribution", diameter_distribution,
           {"mono", "uniform", "normal", "lognormal", "discrete", "sieve"},
           "all of one diameter, spread about the mean, a list of diameters, or a sieve curve (fill, pack and stream)");
    option("diameters", diameters, "m", "discrete: the diameters; sieve: the openings, rising", positive);
    option("diameter_shares", diameter_shares, "-",
           "discrete: the share of each diameter; sieve: the share that passes each opening, from 0 to 1",
           non_negative);
    option("share_by", share_by, {"number", "mass"}, "what the diameter shares are shares of");
    option("diameter_deviation", diameter_deviation, "m",
           "standard deviation of the diameter; uniform: the half-width of the interval; normal deviates stay within "
           "3 of them, diameters above a tenth of the mean",
           non_negative);
    option("count", count, "-",
           "number of particles; 0: by solids_fraction (fill, pack), as many as fit (lattice), no limit (stream)",
           at_least(0));
    option("solids_fraction", solids_fraction, "-", "particle volume as a share of the region's volume",
           Range{0, 1, true, true});
    option("mass_rate", mass_rate, "kg/s", "stream: mass added per time", non_negative);
    option("number_rate", number_rate, "1/s", "stream: particles added per time, instead of a mass rate", non_negative);
    option("start", start, "s", "stream: time of the first particle", non_negative);
    option("end", end, "s", "stream: time after which none is added", non_negative);
    option("interval", interval, "s", "stream: particles are added in batches at multiples of this; 0: at every step",
           non_negative);
    option("mass", mass, "kg", "stream: none is added beyond this mass in all; 0: no limit", non_negative);
    option("velocity_scatter", velocity_scatter, "m/s",
           "stream: standard deviation of each component of the velocity about the velocity", non_negative);
    option("centre", centre, "m", "stream: centre of the disc that particles start on, instead of a box");
    option("normal", normal, "-", "stream: normal of the disc");
    option("radius", radius, "m", "stream: radius of the disc; whole particles lie within", non_negative);
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
