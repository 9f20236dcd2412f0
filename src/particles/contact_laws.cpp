#include "particles/contact_laws.hpp"

#include <cstring>
#include <type_traits>

#include "base/error.hpp"

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

}  // namespace

ContactLaws::ContactLaws(Options& options, const Materials& materials) : materials_(materials) {
  normal_.model = NormalModels::read(options, "normal", "tsuji", "normal contact law");
  tangential_.model = TangentialModels::read(options, "tangential", "mindlin", "tangential contact law");
  rolling_.model = RollingModels::read(options, "rolling", "none", "rolling resistance");
  twisting_.model = TwistingModels::read(options, "twisting", "none", "twisting resistance");
  setup_.materials = materials.count();
  each([&](const auto& slot, LawStage& stage) {
    stage.model = static_cast<int>(slot.model.index());
    stage.first_history = history_components_;
    std::visit(
        [&](const auto& model) {
          using Model = std::decay_t<decltype(model)>;
          history_components_ += doubles_in<typename Model::template History<double>>;
          setup_.extended |= Model::extended;
        },
        slot.model);
  });
  check_combination();
  prepare(1);
}

void ContactLaws::check_combination() const {
  if (const auto* spring = std::get_if<SpringRolling>(&rolling_.model); spring && spring->needs_neck())
    throw UserError("-rolling_type spring needs -rolling_stiffness (N, positive): only a JKR neck has a default");
}

void ContactLaws::prepare(double friction_factor) {
  each([&](auto& slot, LawStage& stage) {
    slot.constants =
        std::visit([&](const auto& model) { return table(model, materials_, friction_factor); }, slot.model);
    stage.constants = slot.constants.data();
  });
}

double ContactLaws::duration(int a, int b, const Encounter& encounter) const {
  return std::visit(
      [&](const auto& model) {
        return std::decay_t<decltype(model)>::duration(model.constants(materials_.pair(a, b)), encounter);
      },
      normal_.model);
}

bool ContactLaws::hertzian() const {
  return std::visit([](const auto& model) { return std::decay_t<decltype(model)>::hertzian; }, normal_.model);
}

}  // namespace silt
