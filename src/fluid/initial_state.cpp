#include "fluid/initial_state.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"
#include "base/field_file.hpp"
#include "base/nodal_gradient.hpp"
#include "base/nodal_matrix.hpp"
#include "fluid/pressure_correction/cell_loops.hpp"
#include "fluid/pressure_correction/pressure_solver.hpp"

namespace silt {

std::vector<double> potential_velocity(const Mesh& mesh, const BoundaryConditions& boundary,
                                       const std::vector<double>& void_fraction) {
  double flows = 0;
  for (double flow : boundary.boundary_flow()) flows += flow;
  if (boundary.closed() && std::abs(flows) > 0.01 * boundary.throughput())
    throw UserError(
        fmt::format("-fluid_initial_solve potential: the boundaries prescribe an outflow of {:.3g} m3/s in "
                    "all, and no boundary has type pressure",
                    flows));
  const NodalGraph graph(mesh);
  const CellLoops loops(graph);
  PressureSolver solver(graph, boundary.pressure_boundary(), boundary.closed());
  const std::vector<double> one(loops.padded_cells(), 1.0), mass = lumped_mass(mesh);
  solver.matrix().zero();
  loops.diffusion(one.data(), solver.matrix().values.data());
  solver.update(true);
  // int grad q . U = oint q U.n; what the quadrature of a balanced inflow leaves over is spread evenly.
  std::vector<double> right = boundary.flow(), phi(mesh.nodes, 0.0), velocity;
  if (boundary.closed())
    for (int i = 0; i < mesh.nodes; ++i) right[i] -= mass[i] * flows / mesh.volume;
  for (int k = 0; k < 4; ++k) solver.solve(right, phi);  // each solve leaves a thousandth
  NodalGradient(mesh, mass).apply(phi, 1, velocity);
  for (std::size_t i = 0; i < velocity.size(); ++i) velocity[i] /= void_fraction[i / 3];
  boundary.impose(velocity.data());
  return velocity;
}

InitialState initial_state(const Mesh& mesh, Options& options, const BoundaryConditions& boundary,
                           const std::vector<double>& places, bool with_temperature, bool also_on_restart) {
  InitialStateOptions given;
  options.read("fluid", given);
  InitialState start;
  const bool solve = given.solve != "none", read = !given.file.empty();
  if (!solve && !read) return start;
  if (solve && read) throw UserError("give one of -fluid_initial_solve and -fluid_initial_file");
  for (const char* formula : {"fluid_initial_velocity", "fluid_initial_pressure", "fluid_initial_temperature"}) {
    const std::string name = formula;
    const bool replaced = name.ends_with("velocity") || (name.ends_with("pressure") && given.solve != "potential") ||
                          (name.ends_with("temperature") && read);
    if (options.given(name) && replaced)
      throw UserError(
          fmt::format("-{} and -{} exclude each other", name, solve ? "fluid_initial_solve" : "fluid_initial_file"));
  }
  if (options.given("restart") && !also_on_restart) return start;
  if (given.solve == "potential") {
    if (options.given("fluid_drive_direction"))
      throw UserError("-fluid_initial_solve potential has no meaning for a driven flow (-fluid_drive_...); use stokes");
    start.velocity = potential_velocity(mesh, boundary, std::vector<double>(mesh.nodes, 1.0));
    if (places.size() > start.velocity.size())
      throw UserError("-fluid_initial_solve potential is not available with -fluid_element taylor_hood; use stokes");
  } else if (solve) {
    start.stokes = true;
  } else {
    const FieldFile file("fluid_initial_file", given.file);
    std::vector<Vec3> at(places.size() / 3);
    for (std::size_t k = 0; k < at.size(); ++k) at[k] = vec3(&places[3 * k]);
    start.velocity = file.sample("velocity", 3, at);
    at.resize(mesh.nodes);
    start.pressure = file.sample("pressure", 1, at);
    if (with_temperature) start.temperature = file.sample("temperature", 1, at);
  }
  return start;
}

}  // namespace silt
