#include "app/profiles.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>

#include "base/csv.hpp"
#include "base/error.hpp"
#include "base/hdf5_file.hpp"

namespace silt {
namespace {

const std::vector<std::string> names = {"void_fraction", "particle_velocity_x", "particle_velocity_y",
                                        "particle_velocity_z"};
constexpr size_t width = 4;

/// Points of equal weight in the unit ball: eight shells of equal volume, each with 64 directions on a golden spiral.
const std::array<Vec3, 512>& ball_points() {
  static const std::array<Vec3, 512> points = [] {
    std::array<Vec3, 512> result;
    constexpr int shells = 8, directions = 64;
    for (int s = 0; s < shells; ++s) {
      const double radius = std::cbrt((s + 0.5) / shells);
      for (int k = 0; k < directions; ++k) {
        const double height = 1 - (2 * k + 1.0) / directions, across = std::sqrt(1 - height * height);
        const double angle = (k + 0.37 * s) * M_PI * (3 - std::sqrt(5.0));
        result[s * directions + k] = radius * Vec3(across * std::cos(angle), across * std::sin(angle), height);
      }
    }
    return result;
  }();
  return points;
}

}  // namespace

double share_in_box(const Vec3& centre, double radius, const Vec3& lower, const Vec3& upper) {
  const Vec3 below = centre - lower, above = upper - centre;
  const double inside = std::min(below.minCoeff(), above.minCoeff());
  if (inside >= radius) return 1;
  if (inside <= -radius) return 0;
  int count = 0;
  for (const Vec3& point : ball_points()) {
    const Vec3 x = centre + radius * point;
    count += (x.array() >= lower.array()).all() && (x.array() <= upper.array()).all();
  }
  return count / 512.0;
}

void ProfileOptions::options(OptionGroup& option) {
  option("from", from, "m", "centre of the first box over which particles are averaged");
  option("to", to, "m", "centre of the last box");
  option("size", size, "m",
         "extent of every box; of a ring the height along its axis and the thickness in the two other directions");
  option("axis", axis, {"none", "x", "y", "z"},
         "none: boxes; else rings about this axis, each at the distance from it that the box's centre would have");
  option("centre", centre, "m", "a point of the axis of rings");
  option("points", points, "-", "number of boxes", at_least(1));
  option("start", start, "s", "time from which the average is taken", non_negative);
}

Profiles::Profiles(const Mesh& mesh, Options& options, bool with_particles)
    : lower_(mesh.lower), upper_(mesh.upper), periodic_{mesh.periodic[0], mesh.periodic[1], mesh.periodic[2]} {
  for (const auto& name : options.names("profile", Options::declared<ProfileOptions>())) {
    ProfileOptions profile;
    options.read("profile_" + name, profile);
    if (!with_particles) throw UserError("-profile_... averages particles, and the case has none (-insertion_...)");
    if (!(profile.size.head(mesh.dimension).minCoeff() > 0))
      throw UserError(fmt::format("-profile_{}_size must be given: three positive lengths in m", name));
    Item item{name, profile.start, static_cast<int>(std::string("xyz").find(profile.axis)), profile.centre, {}, {}, 0,
              {}};
    if (profile.axis == "none") item.axis = -1;
    if (item.axis >= 0 && mesh.dimension == 2)
      throw UserError(fmt::format("-profile_{}_axis: rings need a mesh in three dimensions", name));
    for (int k = 0; k < profile.points; ++k) {
      Box box;
      box.centre = profile.from;
      if (profile.points > 1) box.centre += (profile.to - profile.from) * k / (profile.points - 1.0);
      box.lower = (box.centre - 0.5 * profile.size).cwiseMax(mesh.lower);
      box.upper = (box.centre + 0.5 * profile.size).cwiseMin(mesh.upper);
      if (mesh.dimension == 2) {
        box.lower[2] = -0.5 * profile.size[2];
        box.upper[2] = 0.5 * profile.size[2];
      }
      box.volume = (box.upper - box.lower).prod();
      if (!((box.upper - box.lower).minCoeff() > 0))
        throw UserError(fmt::format("-profile_{}: the box at ({:g}, {:g}, {:g}) lies outside the mesh", name,
                                    box.centre[0], box.centre[1], box.centre[2]));
      if (item.axis >= 0) make_ring(mesh, profile, item, box);
      item.boxes.push_back(box);
    }
    item.sums.assign(width * item.boxes.size(), 0.0);
    items_.push_back(std::move(item));
  }
}

/// A ring that is as high as the box, as far from the axis as the box's centre.
void Profiles::make_ring(const Mesh& mesh, const ProfileOptions& profile, const Item& item, Box& box) {
  const int a = item.axis, b = (a + 1) % 3, c = (a + 2) % 3;
  const double radius = std::hypot(box.centre[b] - item.origin[b], box.centre[c] - item.origin[c]);
  if (profile.size[b] != profile.size[c])
    throw UserError(
        fmt::format("-profile_{0}_size: the thickness of rings about {1} is given twice, as {2:g} and {3:g}", item.name,
                    "xyz"[a], profile.size[b], profile.size[c]));
  const double half = 0.5 * profile.size[b];
  box.ring = {std::max(0.0, radius - half), radius + half,
              std::max(box.centre[a] - 0.5 * profile.size[a], mesh.lower[a]),
              std::min(box.centre[a] + 0.5 * profile.size[a], mesh.upper[a])};
  box.volume = box.ring.volume();
}

double Profiles::share(const Item& item, const Box& box, const Vec3& centre, double radius) {
  if (item.axis < 0) return share_in_box(centre, radius, box.lower, box.upper);
  const int a = item.axis, b = (a + 1) % 3, c = (a + 2) % 3;
  const double distance = std::hypot(centre[b] - item.origin[b], centre[c] - item.origin[c]);
  return volume_in_ring(distance, centre[a], radius, box.ring) / (4.0 / 3.0 * M_PI * radius * radius * radius);
}

int Profiles::images(const Vec3& centre, double radius, std::array<Vec3, 8>& places) const {
  int count = 1;
  places[0] = centre;
  for (int d = 0; d < 3; ++d) {
    if (!periodic_[d]) continue;
    const double length = upper_[d] - lower_[d];
    const double shift = centre[d] - radius < lower_[d] ? length : centre[d] + radius > upper_[d] ? -length : 0;
    if (shift == 0) continue;
    for (int k = 0; k < count; ++k) places[count + k] = places[k] + shift * Vec3::Unit(d);
    count *= 2;
  }
  return count;
}

void Profiles::sample(const Moment& moment) {
  std::array<Vec3, 8> places;
  for (auto& item : items_) {
    if (moment.time < item.start || moment.dt <= 0) continue;
    item.time += moment.dt;
    const Particles& particles = *moment.particles;
    for (int i = 0; i < particles.owned(); ++i) {
      const Vec3 v = particles.velocity(i);
      const double radius = particles.radius(i);
      const int count = images(particles.position(i), radius, places);
      for (size_t b = 0; b < item.boxes.size(); ++b) {
        double part = 0;
        for (int k = 0; k < count; ++k) part += share(item, item.boxes[b], places[k], radius);
        if (part <= 0) continue;
        const double weight = part * particles.volume(i) * moment.dt;
        double* sum = &item.sums[width * b];
        sum[0] += weight;
        for (int d = 0; d < 3; ++d) sum[1 + d] += weight * v[d];
      }
    }
  }
}

void Profiles::save(CheckpointWriter& to) const {
  for (const auto& item : items_) {
    std::vector<double> sums(item.sums.size());
    MPI_Allreduce(item.sums.data(), sums.data(), static_cast<int>(sums.size()), MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
    sums.insert(sums.end(), {item.time, item.start, 0, 0});
    if (mpi_rank() > 0) sums.clear();
    to.add("profile_" + item.name, width, sums);
  }
}

void Profiles::load(const CheckpointReader& from) {
  for (auto& item : items_) {
    const std::string name = "profile_" + item.name;
    if (!from.has(name) || from.rows(name) != static_cast<long long>(item.boxes.size()) + 1) continue;
    auto sums = from.numbers(name);
    const double time = sums[width * item.boxes.size()], start = sums[width * item.boxes.size() + 1];
    if (start != item.start) continue;
    item.time = time;
    sums.resize(item.sums.size());
    if (mpi_rank() == 0) item.sums = sums;
  }
}

void Profiles::write(const OutputDirectory& directory) {
  for (auto& item : items_) {
    std::vector<double> sums(item.sums.size());
    MPI_Allreduce(item.sums.data(), sums.data(), static_cast<int>(sums.size()), MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
    std::string text = fmt::format("distance,x,y,z,{}\n", fmt::join(names, ","));
    item.means.clear();
    for (size_t b = 0; b < item.boxes.size(); ++b) {
      const Box& box = item.boxes[b];
      const double* sum = &sums[width * b];
      item.means.push_back(item.time > 0 ? 1 - sum[0] / (box.volume * item.time) : std::nan(""));
      for (int d = 0; d < 3; ++d) item.means.push_back(sum[0] > 0 ? sum[1 + d] / sum[0] : 0);
      std::vector<std::string> row = {csv_number((box.centre - item.boxes[0].centre).norm())};
      for (int d = 0; d < 3; ++d) row.push_back(csv_number(box.centre[d]));
      for (size_t c = 0; c < width; ++c) row.push_back(csv_number(item.means[width * b + c]));
      text += fmt::format("{}\n", fmt::join(row, ","));
    }
    write_text(directory.path("profile_" + item.name + ".csv"), text);
  }
}

std::vector<std::string> Profiles::columns() const {
  std::vector<std::string> all;
  for (const auto& item : items_)
    for (const auto& name : names) all.push_back(item.name + "." + name);
  return all;
}

std::vector<double> Profiles::values(const std::string& column) const {
  std::vector<double> result;
  for (const auto& item : items_)
    for (size_t c = 0; c < width; ++c)
      if (item.name + "." + names[c] == column)
        for (size_t k = c; k < item.means.size(); k += width) result.push_back(item.means[k]);
  return result;
}

double Profiles::spacing(const std::string& column) const {
  for (const auto& item : items_)
    if (column.starts_with(item.name + ".") && item.boxes.size() > 1)
      return (item.boxes[1].centre - item.boxes[0].centre).norm();
  return 0;
}

}  // namespace silt
