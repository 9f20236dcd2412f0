#pragma once
#include <optional>
#include <string>

#include "base/options.hpp"

namespace silt {

/// The options `-law_table_...`: `silt case.yaml -law_table_motion normal` prints what the case's laws do to two equal
/// particles that are led along a path, and runs nothing.
struct LawTableOptions {
  std::string motion = "none";
  double radius = 1e-3, depth = 1e-6, speed = 0.01, amplitude = 0, angle = 0;
  std::optional<double> gap;
  int rows = 400;
  void options(OptionGroup& option) {
    option("motion", motion, {"none", "normal", "tangential", "rolling", "twisting", "field"},
           "print the force between two particles led together and apart, or pressed together and slid, rolled or "
           "turned to and fro, or by their fields at a distance, as CSV instead of a run");
    option("radius", radius, "m", "of both particles", positive);
    option("depth", depth, "m", "overlap to which they are pressed", positive);
    option("gap", gap, "m", "from which they come; default: a little beyond the reach of the laws; field: 8 radii",
           positive);
    option("angle", angle, "degrees", "field: between the line of centres and z", Range{0, 180, false, false});
    option("speed", speed, "m/s", "of the motion; rolling and twisting: of their surfaces", positive);
    option("amplitude", amplitude, "m", "of the motion to and fro; rolling and twisting: of their surfaces",
           non_negative);
    option("rows", rows, "-", "of a sweep of the motion", at_least(2));
  }
};

/// The table as text: for normal `gap,force`, twice `rows` of them, in and out (force > 0 repulsive); for tangential
/// `slip,force`, for rolling and twisting `angle,torque` of the one particle against the other, over once to and fro;
/// for field see field_table.hpp. Throws UserError for motions to and fro without an amplitude.
std::string law_table(Options& options);

}  // namespace silt
