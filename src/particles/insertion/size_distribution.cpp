#include "particles/insertion/size_distribution.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.hpp"
#include "base/text.hpp"

namespace silt {
namespace {

/// Running sums of weights, the last one 1.
std::vector<double> running(std::vector<double> weights) {
  std::partial_sum(weights.begin(), weights.end(), weights.begin());
  for (double& w : weights) w /= weights.back();
  weights.back() = 1;
  return weights;
}

std::size_t pick(const std::vector<double>& up_to, double u) {
  return static_cast<std::size_t>(std::upper_bound(up_to.begin(), up_to.end() - 1, u) - up_to.begin());
}

}  // namespace

SizeDistribution::SizeDistribution(const InsertionOptions& options, const std::string& prefix)
    : kind_(options.diameter_distribution),
      deviation_(options.diameter_deviation),
      by_mass_(options.share_by == "mass"),
      diameters_(options.diameters) {
  const bool listed = kind_ == "discrete" || kind_ == "sieve";
  if (!listed) {
    if (!options.diameter) throw UserError(fmt::format("option -{}_diameter is missing", prefix));
    if (!options.diameters.empty() || !options.diameter_shares.empty())
      throw UserError(fmt::format(
          "-{0}: -{0}_diameters and -{0}_diameter_shares go with the distributions discrete and sieve", prefix));
    mean_ = *options.diameter;
    const double variance = std::log(1 + deviation_ * deviation_ / (mean_ * mean_));
    largest_ = kind_ == "mono"      ? mean_
               : kind_ == "uniform" ? mean_ + deviation_
               : kind_ == "normal"  ? mean_ + 3 * deviation_
                                    : mean_ * std::exp(3 * std::sqrt(variance));
    return;
  }
  const auto& shares = options.diameter_shares;
  if (options.diameter)
    throw UserError(
        fmt::format("-{0}: give -{0}_diameters instead of -{0}_diameter for the distribution {1}", prefix, kind_));
  const std::size_t least = kind_ == "sieve" ? 2 : 1;
  if (diameters_.size() < least || shares.size() != diameters_.size())
    throw UserError(
        fmt::format("-{0}: the distribution {1} needs at least {2} -{0}_diameters and as many -{0}_diameter_shares, "
                    "{3} and {4} are given",
                    prefix, kind_, least, diameters_.size(), shares.size()));
  largest_ = *std::max_element(diameters_.begin(), diameters_.end());
  std::vector<double> weights;
  if (kind_ == "discrete") {
    if (std::accumulate(shares.begin(), shares.end(), 0.0) <= 0)
      throw UserError(fmt::format("option -{}_diameter_shares: one at least must be above 0", prefix));
    for (std::size_t k = 0; k < shares.size(); ++k)
      weights.push_back(by_mass_ ? shares[k] / std::pow(diameters_[k], 3) : shares[k]);
  } else {
    const bool rising = std::is_sorted(diameters_.begin(), diameters_.end(), std::less_equal<>()) &&
                        std::is_sorted(shares.begin(), shares.end());
    if (!rising || shares.front() != 0 || shares.back() != 1)
      throw UserError(
          fmt::format("-{0}: a sieve curve has rising -{0}_diameters (the openings) and the shares that pass "
                      "them, from 0 to 1; given are {1} and {2}",
                      prefix, fmt::join(diameters_, ", "), fmt::join(shares, ", ")));
    for (std::size_t k = 0; k + 1 < shares.size(); ++k) {
      const double a = diameters_[k], b = diameters_[k + 1];
      // Mass spread evenly over an interval has the number density d^-3.
      weights.push_back((shares[k + 1] - shares[k]) * (by_mass_ ? (a + b) / (2 * a * a * b * b) : 1));
    }
  }
  up_to_ = running(weights);
}

double SizeDistribution::radius(RandomStream& random) const { return 0.5 * diameter(random); }

double SizeDistribution::diameter(RandomStream& random) const {
  if (kind_ == "mono") return mean_;
  if (kind_ == "discrete") return diameters_[pick(up_to_, random.uniform())];
  if (kind_ == "sieve") {
    const std::size_t k = pick(up_to_, random.uniform());
    const double a = diameters_[k], b = diameters_[k + 1], u = random.uniform();
    if (!by_mass_) return a + u * (b - a);
    return 1 / std::sqrt(1 / (a * a) - u * (1 / (a * a) - 1 / (b * b)));
  }
  const auto normal = [&] {
    double z = random.normal();
    while (std::abs(z) > 3) z = random.normal();
    return z;
  };
  double diameter;
  do {
    if (kind_ == "uniform") {
      diameter = mean_ + random.uniform(-deviation_, deviation_);
    } else if (kind_ == "normal") {
      diameter = mean_ + deviation_ * normal();
    } else {
      const double variance = std::log(1 + deviation_ * deviation_ / (mean_ * mean_));
      diameter = mean_ * std::exp(std::sqrt(variance) * normal() - 0.5 * variance);
    }
  } while (diameter < 0.1 * mean_);
  return diameter;
}

MaterialChoice::MaterialChoice(const InsertionOptions& options, const std::string& prefix,
                               const std::vector<std::string>& materials) {
  if (materials.empty()) throw UserError(fmt::format("-{}: no material is defined (-material_<name>_density)", prefix));
  const auto find = [&](const std::string& name, const char* option) {
    const auto found = std::find(materials.begin(), materials.end(), lower_case(name));
    if (found != materials.end()) return static_cast<int>(found - materials.begin());
    const std::string hint = nearest(name, materials);
    throw UserError(fmt::format("option -{}_{}: '{}' is not a material; there are {}{}", prefix, option, name,
                                fmt::join(materials, ", "),
                                hint.empty() ? "" : fmt::format(" (did you mean {}?)", hint)));
  };
  if (options.materials.empty()) {
    if (!options.material_shares.empty())
      throw UserError(fmt::format("-{0}_material_shares go with -{0}_materials", prefix));
    index_ = {options.material.empty()
                  ? static_cast<int>(std::min_element(materials.begin(), materials.end()) - materials.begin())
                  : find(options.material, "material")};
    up_to_ = {1};
    return;
  }
  if (!options.material.empty())
    throw UserError(fmt::format("-{0}: give either -{0}_material or -{0}_materials", prefix));
  if (options.material_shares.size() != options.materials.size() ||
      std::accumulate(options.material_shares.begin(), options.material_shares.end(), 0.0) <= 0)
    throw UserError(
        fmt::format("option -{0}_material_shares: {1} shares, not all of them 0, go with {1} -{0}_materials", prefix,
                    options.materials.size()));
  for (const auto& name : options.materials) index_.push_back(find(name, "materials"));
  up_to_ = running(options.material_shares);
}

int MaterialChoice::draw(RandomStream& random) const {
  return index_.size() == 1 ? index_[0] : index_[pick(up_to_, random.uniform())];
}

}  // namespace silt
