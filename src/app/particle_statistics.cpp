#include "app/particle_statistics.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "base/error.hpp"
#include "base/petsc.hpp"
#include "particles/materials.hpp"

namespace silt {
namespace {

constexpr const char* prefix = "particles.";

double value_of(const Particles& particles, int i, int which) {
  return which < 0 ? 2 * particles.radius(i) : particles.velocity(i)[which];
}

/// Mean and deviation over all ranks.
std::pair<double, double> moments(const Particles& particles, int which) {
  double sum = 0, square = 0;
  for (int i = 0; i < particles.owned(); ++i) sum += value_of(particles, i, which);
  const double count = static_cast<double>(particles.total()), mean = mpi_sum(sum) / count;
  for (int i = 0; i < particles.owned(); ++i) square += std::pow(value_of(particles, i, which) - mean, 2);
  return {mean, std::sqrt(mpi_sum(square) / count)};
}

/// (diameter, mass) of all particles of all ranks by rising diameter.
std::vector<std::pair<double, double>> gather_sizes(const Particles& particles) {
  std::vector<double> own, all;
  for (int i = 0; i < particles.owned(); ++i) own.insert(own.end(), {2 * particles.radius(i), particles.mass(i)});
  std::vector<int> counts(mpi_size()), starts(mpi_size(), 0);
  const int count = static_cast<int>(own.size());
  MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, PETSC_COMM_WORLD);
  std::partial_sum(counts.begin(), counts.end() - 1, starts.begin() + 1);
  all.resize(static_cast<std::size_t>(starts.back()) + counts.back());
  MPI_Allgatherv(own.data(), count, MPI_DOUBLE, all.data(), counts.data(), starts.data(), MPI_DOUBLE, PETSC_COMM_WORLD);
  std::vector<std::pair<double, double>> sizes;
  for (std::size_t k = 0; k + 1 < all.size(); k += 2) sizes.emplace_back(all[k], all[k + 1]);
  std::sort(sizes.begin(), sizes.end());
  return sizes;
}

double quantile(const std::vector<std::pair<double, double>>& sizes, double level, bool by_mass) {
  double whole = 0, sum = 0;
  for (const auto& size : sizes) whole += by_mass ? size.second : 1;
  for (const auto& size : sizes) {
    sum += by_mass ? size.second : 1;
    if (sum >= level * whole * (1 - 1e-12)) return size.first;
  }
  return sizes.back().first;
}

/// What follows the beginning of a text, if that is how it begins.
std::optional<std::string> rest(const std::string& text, const std::string& beginning) {
  return text.rfind(beginning, 0) == 0 ? std::optional<std::string>(text.substr(beginning.size())) : std::nullopt;
}

}  // namespace

ParticleStatistics::ParticleStatistics(const std::vector<std::string>& asked, const Particles* particles) {
  if (!particles) return;
  for (const auto& name : asked) {
    if (!rest(name, prefix) || std::find(names_.begin(), names_.end(), name) != names_.end()) continue;
    items_.push_back(parse(name, *particles));
    names_.push_back(name);
  }
}

ParticleStatistics::Item ParticleStatistics::parse(const std::string& name, const Particles& particles) const {
  const std::string what = *rest(name, prefix);
  if (what == "diameter_mean") return {Kind::mean, -1, 0};
  if (what == "diameter_deviation") return {Kind::deviation, -1, 0};
  for (int axis = 0; axis < 3; ++axis) {
    if (what == std::string("velocity_mean_") + "xyz"[axis]) return {Kind::mean, axis, 0};
    if (what == std::string("velocity_deviation_") + "xyz"[axis]) return {Kind::deviation, axis, 0};
  }
  for (const Kind kind : {Kind::number_quantile, Kind::mass_quantile}) {
    const auto percent = rest(what, kind == Kind::mass_quantile ? "diameter_mass_" : "diameter_number_");
    if (!percent) continue;
    double value = -1;
    const char* last = percent->data() + percent->size();
    const auto [end, error] = std::from_chars(percent->data(), last, value);
    if (error == std::errc() && end == last && value > 0 && value <= 100) return {kind, -1, value / 100};
  }
  std::vector<std::string> materials;
  materials.reserve(static_cast<size_t>(particles.materials().count()));
  for (int k = 0; k < particles.materials().count(); ++k) materials.push_back(particles.materials()[k].name);
  if (const auto material = rest(what, "share_")) {
    const auto found = std::find(materials.begin(), materials.end(), *material);
    if (found != materials.end()) return {Kind::share, static_cast<int>(found - materials.begin()), 0};
  }
  throw UserError(
      fmt::format("quantity '{}': of all particles there are diameter_mean, diameter_deviation, "
                  "diameter_number_<percent>, diameter_mass_<percent>, velocity_mean_x, velocity_deviation_x, the same "
                  "for y and z, and share_<material> of {}",
                  name, fmt::join(materials, ", ")));
}

void ParticleStatistics::sample(const Moment& moment, Quantities& quantities) const {
  if (items_.empty() || !moment.particles || moment.particles->total() == 0) return;
  const Particles& particles = *moment.particles;
  const bool ordered = std::any_of(items_.begin(), items_.end(), [](const Item& item) {
    return item.kind == Kind::number_quantile || item.kind == Kind::mass_quantile;
  });
  const auto sizes = ordered ? gather_sizes(particles) : std::vector<std::pair<double, double>>{};
  for (std::size_t k = 0; k < items_.size(); ++k) {
    const Item& item = items_[k];
    double value = 0;
    if (item.kind == Kind::mean || item.kind == Kind::deviation) {
      const auto [mean, deviation] = moments(particles, item.which);
      value = item.kind == Kind::mean ? mean : deviation;
    } else if (item.kind == Kind::share) {
      for (int i = 0; i < particles.owned(); ++i) value += particles.material(i) == item.which;
      value = mpi_sum(value) / static_cast<double>(particles.total());
    } else {
      value = quantile(sizes, item.level, item.kind == Kind::mass_quantile);
    }
    quantities.set(names_[k], value);
  }
}

}  // namespace silt
