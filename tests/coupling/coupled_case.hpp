#pragma once
#include <memory>
#include <string>
#include <vector>

#include "coupling/coupling.hpp"

namespace silt::test {

/// A mesh, a fluid and particles from options, stepped together.
struct CoupledCase {
  Options options;
  Vec3 gravity = Vec3::Zero();
  std::unique_ptr<Mesh> mesh;
  std::unique_ptr<Fluid> fluid;
  std::unique_ptr<Particles> particles;
  std::unique_ptr<Coupling> coupling;
  double time = 0;
  FluidStep flow;  ///< of the last step

  CoupledCase& set(const std::string& name, const std::string& value) {
    options.set(name, value);
    return *this;
  }
  void create(const std::vector<Seed>& seeds) {
    MeshOptions mesh_options;
    options.read("mesh", mesh_options);
    mesh = std::make_unique<Mesh>(mesh_options);
    fluid = Fluid::create(*mesh, options, gravity);
    particles = std::make_unique<Particles>(*mesh, options, gravity);
    if (!seeds.empty()) particles->add(seeds);
    coupling = std::make_unique<Coupling>(*mesh, *particles, *fluid, options, gravity);
  }
  void step(double dt) {
    coupling->before_particles(dt);
    particles->advance(time, dt);
    coupling->before_fluid(dt);
    flow = fluid->advance(time, dt);
    coupling->after_fluid(dt);
    time += dt;
  }
};

}  // namespace silt::test
