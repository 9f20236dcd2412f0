#include <catch2/catch.hpp>

#include "flow_case.hpp"

using namespace silt;
using namespace silt::test;

namespace {

struct Profile {
  double position, value;
};
// Ghia, Ghia & Shin 1982, tables I and II: u(y) at x = 0.5 and v(x) at y = 0.5; the points that are nodes of no 64^2
// mesh are interpolated.
constexpr Profile u_100[] = {{0.0547, -0.03717}, {0.0625, -0.04192}, {0.0703, -0.04775}, {0.1016, -0.06434},
                             {0.1719, -0.10150}, {0.2813, -0.15662}, {0.4531, -0.21090}, {0.5000, -0.20581},
                             {0.6172, -0.13641}, {0.7344, 0.00332},  {0.8516, 0.23151},  {0.9531, 0.68717},
                             {0.9609, 0.73722},  {0.9688, 0.78871},  {0.9766, 0.84123}};
constexpr Profile v_100[] = {{0.0625, 0.09233},  {0.0703, 0.10091},  {0.0781, 0.10890},  {0.0938, 0.12317},
                             {0.1563, 0.16077},  {0.2266, 0.17507},  {0.2344, 0.17527},  {0.5000, 0.05454},
                             {0.8047, -0.24533}, {0.8594, -0.22445}, {0.9063, -0.16914}, {0.9453, -0.10313},
                             {0.9531, -0.08864}, {0.9609, -0.07391}, {0.9688, -0.05906}};

constexpr Profile u_400[] = {{0.0547, -0.08186}, {0.0625, -0.09266}, {0.0703, -0.10338}, {0.1016, -0.14612},
                             {0.1719, -0.24299}, {0.2813, -0.32726}, {0.4531, -0.17119}, {0.5000, -0.11477},
                             {0.6172, 0.02135},  {0.7344, 0.16256},  {0.8516, 0.29093},  {0.9531, 0.55892},
                             {0.9609, 0.61756},  {0.9688, 0.68439},  {0.9766, 0.75837}};
// The value printed for x = 0.9063 is a misprint and left out.
constexpr Profile v_400[] = {{0.0625, 0.18360},  {0.0703, 0.19713},  {0.0781, 0.20920},  {0.0938, 0.22965},
                             {0.1563, 0.28124},  {0.2266, 0.30203},  {0.2344, 0.30174},  {0.5000, 0.05186},
                             {0.8047, -0.38598}, {0.8594, -0.44993}, {0.9453, -0.22847}, {0.9531, -0.19254},
                             {0.9609, -0.15663}, {0.9688, -0.12146}};

FlowCase::Settings cavity(int cells, double viscosity) {
  const std::string n = std::to_string(cells);
  return {{"mesh_cell", "quadrilateral"},
          {"mesh_cells", n + ", " + n},
          {"mesh_upper", "1, 1, 0"},
          {"fluid_density", "1"},
          {"fluid_viscosity", std::to_string(viscosity)},
          {"boundary_x_min_type", "no_slip"},
          {"boundary_x_max_type", "no_slip"},
          {"boundary_y_min_type", "no_slip"},
          {"boundary_y_max_type", "no_slip"},
          {"boundary_y_max_velocity", "1, 0, 0"}};
}

/// Linear interpolation between nodes along a centre line.
double along(const FlowCase& flow, int cells, int component, bool vertical, double position) {
  const int k = std::min(static_cast<int>(position * cells), cells - 1);
  const double share = position * cells - k;
  const auto at = [&](int j) {
    const double s = static_cast<double>(j) / cells;
    return flow.value(flow.fluid->velocity(), 3, component, vertical ? Vec3(0.5, s, 0) : Vec3(s, 0.5, 0));
  };
  return (1 - share) * at(k) + share * at(k + 1);
}

template <std::size_t a, std::size_t b>
double largest_deviation(const FlowCase& flow, int cells, const Profile (&u)[a], const Profile (&v)[b]) {
  double worst = 0;
  for (const auto& [y, value] : u) worst = std::max(worst, std::abs(along(flow, cells, 0, true, y) - value));
  for (const auto& [x, value] : v) worst = std::max(worst, std::abs(along(flow, cells, 1, false, x) - value));
  return worst;
}

}  // namespace

TEST_CASE("The lid cavity at Re 100 has the centre-line profiles of Ghia et al.", "[fluid]") {
  FlowCase flow(cavity(64, 0.01));
  for (int k = 0; k < 200; ++k) flow.advance(0.06);
  CHECK(largest_deviation(flow, 64, u_100, v_100) < 0.01);
}

TEST_CASE("The lid cavity at Re 400 has the centre-line profiles of Ghia et al.", "[fluid][slow]") {
  FlowCase flow(cavity(64, 0.0025));
  for (int k = 0; k < 800; ++k) flow.advance(0.05);
  CHECK(largest_deviation(flow, 64, u_400, v_400) < 0.02);
}
