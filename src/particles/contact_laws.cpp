#include "particles/contact_laws.hpp"

#include <cstring>
#include <type_traits>

namespace silt {
namespace {

template <class Struct>
constexpr int doubles_in = std::is_empty_v<Struct> ? 0 : static_cast<int>(sizeof(Struct) / sizeof(double));

/// The model's constants for all pairs of materials, [constant][pair].
template <class Model>
std::vector<double> table(const Model& model, const Materials& materials, double friction_factor) {
  using Constants = typename Model::template Constants<double>;
  const int n = doubles_in<Constants>, count = materials.count(), pairs = count * count;
  std::vector<double> result(static_cast<std::size_t>(n) * pairs);
  for (int a = 0; a < count; ++a)
    for (int b = 0; b < count; ++b) {
      PairProperties pair = materials.pair(a, b);
      pair.friction *= friction_factor;
      pair.rolling_friction *= friction_factor;
      const Constants constants = model.constants(pair);
      double value[n + 1];
      std::memcpy(value, &constants, n * sizeof(double));
      for (int c = 0; c < n; ++c) result[static_cast<std::size_t>(c) * pairs + a * count + b] = value[c];
    }
  return result;
}

template <class Any>
int history_of(const Any& model) {
  return std::visit(
      [](const auto& m) { return doubles_in<typename std::decay_t<decltype(m)>::template History<double>>; }, model);
}

}  // namespace

ContactLaws::ContactLaws(Options& options, const Materials& materials)
    : materials_(materials),
      normal_(NormalModels::read(options, "normal", "tsuji", "normal contact law")),
      tangential_(TangentialModels::read(options, "tangential", "mindlin", "tangential contact law")),
      rolling_(RollingModels::read(options, "rolling", "none", "rolling resistance")) {
  setup_.materials = materials.count();
  setup_.normal.model = static_cast<int>(normal_.index());
  setup_.tangential.model = static_cast<int>(tangential_.index());
  setup_.rolling.model = static_cast<int>(rolling_.index());
  setup_.normal.first_history = 0;
  setup_.tangential.first_history = history_of(normal_);
  setup_.rolling.first_history = setup_.tangential.first_history + history_of(tangential_);
  history_components_ = setup_.rolling.first_history + history_of(rolling_);
  prepare(1);
}

void ContactLaws::scale_friction(double factor) { prepare(factor); }

void ContactLaws::prepare(double friction_factor) {
  const auto tabulate = [&](const auto& model) { return table(model, materials_, friction_factor); };
  normal_constants_ = std::visit(tabulate, normal_);
  tangential_constants_ = std::visit(tabulate, tangential_);
  rolling_constants_ = std::visit(tabulate, rolling_);
  setup_.normal.constants = normal_constants_.data();
  setup_.tangential.constants = tangential_constants_.data();
  setup_.rolling.constants = rolling_constants_.data();
}

double ContactLaws::duration(int a, int b, double mass, double radius, double speed) const {
  return std::visit(
      [&](const auto& model) {
        return std::decay_t<decltype(model)>::duration(model.constants(materials_.pair(a, b)), mass, radius, speed);
      },
      normal_);
}

bool ContactLaws::hertzian() const {
  return std::visit([](const auto& model) { return std::decay_t<decltype(model)>::hertzian; }, normal_);
}

}  // namespace silt
