#pragma once
#include <algorithm>
#include <map>
#include <memory>
#include <random>
#include <vector>

#include "base/petsc.hpp"
#include "particles/particles.hpp"

namespace silt {

/// Options of a box of particles, with the choices the tests share.
struct BoxCase {
  MeshOptions mesh;
  Options options;
  Vec3 gravity = Vec3::Zero();

  BoxCase() {
    mesh.cells = {3, 3, 3};
    set("material_bead_density", "2500");
  }
  BoxCase& set(const std::string& name, const std::string& value) {
    options.set(name, value);
    return *this;
  }
  BoxCase& box(const Vec3& lower, const Vec3& upper) {
    mesh.lower = lower, mesh.upper = upper;
    return *this;
  }
  BoxCase& periodic() {
    mesh.periodic = {1, 1, 1};
    return *this;
  }
};

/// A box with its mesh and particles.
struct BoxRun {
  explicit BoxRun(BoxCase setup) : mesh(setup.mesh), particles(mesh, setup.options, setup.gravity) {}
  Mesh mesh;
  Particles particles;
};

/// State of one particle, gathered by id on every rank.
struct State {
  double x[3], v[3], w[3];
};
inline std::map<std::int64_t, State> gather(const Particles& particles) {
  struct Record {
    std::int64_t id;
    State state;
  };
  std::vector<Record> mine(particles.owned());
  for (int i = 0; i < particles.owned(); ++i) {
    mine[i].id = particles.id(i);
    for (int d = 0; d < 3; ++d) {
      mine[i].state.x[d] = particles.position(i)[d];
      mine[i].state.v[d] = particles.velocity(i)[d];
      mine[i].state.w[d] = particles.spin(i)[d];
    }
  }
  const int size = mpi_size(), bytes = static_cast<int>(mine.size() * sizeof(Record));
  std::vector<int> count(size), start(size, 0);
  MPI_Allgather(&bytes, 1, MPI_INT, count.data(), 1, MPI_INT, PETSC_COMM_WORLD);
  for (int r = 1; r < size; ++r) start[r] = start[r - 1] + count[r - 1];
  std::vector<Record> all((start.back() + count.back()) / sizeof(Record));
  MPI_Allgatherv(mine.data(), bytes, MPI_BYTE, all.data(), count.data(), start.data(), MPI_BYTE, PETSC_COMM_WORLD);
  std::map<std::int64_t, State> result;
  for (const auto& record : all) result[record.id] = record.state;
  return result;
}

/// The same random numbers everywhere, in [low, high).
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double operator()(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_()) / 4294967296.0);
  }
  Vec3 vector(double size) {
    const double x = (*this)(-size, size), y = (*this)(-size, size), z = (*this)(-size, size);
    return {x, y, z};
  }

 private:
  std::mt19937 engine_;
};

/// Spheres on a jittered lattice of n^3 sites filling [lower, upper], random velocities and spins.
inline std::vector<Seed> gas(int n, const Vec3& lower, const Vec3& upper, double radius, double speed,
                             double radius_scatter = 0, unsigned seed = 1) {
  Random random(seed);
  std::vector<Seed> seeds;
  const Vec3 step = (upper - lower) / n;
  const double room = 0.5 * step.minCoeff() - radius * (1 + radius_scatter);
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        Seed s;
        s.radius = radius * (1 + random(-radius_scatter, radius_scatter));
        s.position = lower + step.cwiseProduct(Vec3(i + 0.5, j + 0.5, k + 0.5)) + random.vector(std::max(room, 0.0));
        s.velocity = random.vector(speed);
        s.spin = random.vector(speed / radius);
        seeds.push_back(s);
      }
  return seeds;
}

inline Seed sphere(const Vec3& position, const Vec3& velocity, double radius, const Vec3& spin = Vec3::Zero()) {
  Seed seed;
  seed.position = position, seed.velocity = velocity, seed.radius = radius, seed.spin = spin;
  return seed;
}

}  // namespace silt
