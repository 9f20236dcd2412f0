#include "particles/contact_laws.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <type_traits>

#include "base/error.hpp"

namespace silt {
namespace {

template <class Struct>
constexpr int doubles_in = std::is_empty_v<Struct> ? 0 : static_cast<int>(sizeof(Struct) / sizeof(double));

/// The model's constants for all pairs of materials, [constant][pair].
template <class Model>
std::vector<double> table(const Model& model, const ContactLaws& laws, int count) {
  using Constants = typename Model::template Constants<double>;
  const int n = doubles_in<Constants>, pairs = count * count;
  std::vector<double> result(static_cast<std::size_t>(n) * pairs);
  for (int a = 0; a < count; ++a)
    for (int b = 0; b < count; ++b) {
      const Constants constants = model.constants(laws.pair(a, b));
      double value[n + 1];
      std::memcpy(value, &constants, n * sizeof(double));
      for (int c = 0; c < n; ++c) result[static_cast<std::size_t>(c) * pairs + a * count + b] = value[c];
    }
  return result;
}

/// The force of a model along the line of centres at a gap, approaching at 1 m/s. N
template <class Model>
double force_at(const typename Model::template Constants<double>& constants, const Encounter& e, double gap) {
  Contact<double> contact{};
  contact.overlap = -gap, contact.approach = 1;
  contact.effective_radius = e.radius, contact.effective_mass = e.mass;
  contact.radius = e.radius_i, contact.distance = e.distance + gap;
  return Model::template force<double>(contact, constants, {});
}

/// The largest force and the largest slope of a model up to its reach, and its force there.
struct Shape {
  double peak = 0, slope = 0, end = 0;
};
template <class Model>
Shape shape_of(const Model& model, const typename Model::template Constants<double>& constants, const Encounter& e) {
  Shape shape;
  if constexpr (requires { model.reach(constants, e); }) {
    const double reach = model.reach(constants, e) * (1 - 1e-6);
    if (reach <= 0) return shape;
    constexpr int samples = 400;
    double last = 0, before = 0;
    for (int k = 0; k <= samples; ++k) {
      const double gap = reach * std::pow(10.0, -5.0 * (1 - k / static_cast<double>(samples)));
      const double force = force_at<Model>(constants, e, gap);
      shape.peak = std::max(shape.peak, std::abs(force));
      if (k > 0) shape.slope = std::max(shape.slope, std::abs(force - last) / (gap - before));
      last = force, before = gap;
    }
    shape.end = std::abs(last);
  }
  return shape;
}

double mass_of(const Material& material, double radius) {
  return *material.density * 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
}

/// Calls act(a, b, encounter) for every pair of materials at its smallest and its largest particles, walls included.
template <class Act>
void each_encounter(const Materials& materials, const ParticleSizes& sizes, Act&& act) {
  for (int a = 0; a < materials.count(); ++a) {
    if (!(sizes.largest[a] > 0)) continue;
    for (const auto* radius : {&sizes.smallest, &sizes.largest})
      for (int b = 0; b < materials.count(); ++b) {
        const double ra = (*radius)[a], rb = (*radius)[b], mass = mass_of(materials[a], ra);
        act(a, b, meeting(mass, ra, infinity, infinity, 0));
        if (!(sizes.largest[b] > 0)) continue;
        const double other = mass_of(materials[b], rb);
        act(a, b, meeting(mass, ra, other, rb, 0));
      }
  }
}

}  // namespace

ContactLaws::ContactLaws(Options& options, const Materials& materials)
    : materials_(materials), sizes_(materials.count()) {
  normal_.model = NormalModels::read(options, "normal", "tsuji", "normal contact law");
  tangential_.model = TangentialModels::read(options, "tangential", "mindlin", "tangential contact law");
  rolling_.model = RollingModels::read(options, "rolling", "none", "rolling resistance");
  twisting_.model = TwistingModels::read(options, "twisting", "none", "twisting resistance");
  adhesion_.model = AdhesionModels::read(options, "adhesion", "none", "adhesion of surfaces in contact");
  dlvo_.model = DlvoModels::read(options, "dlvo", "none", "forces between surfaces in a liquid");
  bridge_.model = BridgeModels::read(options, "bridge", "none", "liquid bridges");
  interfacial_.model = InterfacialModels::read(options, "interfacial", "none", "attraction at a fluid interface");
  lubrication_.model = LubricationModels::read(options, "lubrication", "none", "fluid squeezed out of narrow gaps");
  setup_.materials = materials.count();
  each([&](const auto& slot, LawStage& stage) {
    stage.model = static_cast<int>(slot.model.index());
    stage.first_history = history_components_;
    std::visit(
        [&](const auto& model) {
          using Model = std::decay_t<decltype(model)>;
          using Constants = typename Model::template Constants<double>;
          history_components_ += doubles_in<typename Model::template History<double>>;
          setup_.extended |= Model::extended;
          setup_.jumping |= requires { Model::jumps; };
          setup_.cohesive |= requires(const Constants& c, const Encounter& e) { model.reach(c, e); };
        },
        slot.model);
  });
  setup_.history_components = history_components_;
  setup_.cohesive |= setup_.adhesion.model > 0;
  check_combination();
  prepare();
}

void ContactLaws::check_combination() const {
  const char* adhesion = std::visit([](const auto& model) { return model.name; }, adhesion_.model);
  const bool soft =
      std::holds_alternative<Jkr>(adhesion_.model) || std::holds_alternative<AutomaticAdhesion>(adhesion_.model);
  std::visit(
      [&](const auto& model) {
        using Model = std::decay_t<decltype(model)>;
        if (setup_.adhesion.model > 0 && !Model::hertz_spring)
          throw UserError(
              fmt::format("-adhesion_type {} needs the Hertz spring of -normal_type tsuji, lee_herrmann or "
                          "kuwabara_kono; {} has another",
                          adhesion, model.name));
        if constexpr (requires { model.loss(); })
          if (model.loss() && !materials_.restitution_given().empty())
            throw UserError(
                fmt::format("{} and {} both say what a collision loses: -normal_type {} takes the latter, give "
                            "one",
                            materials_.restitution_given(), model.loss(), model.name));
        if constexpr (requires { model.no_attraction; })
          if (setup_.adhesion.model > 0 && model.no_attraction)
            throw UserError(fmt::format("-normal_no_attraction and -adhesion_type {} exclude each other", adhesion));
      },
      normal_.model);
  if (const auto* law = std::get_if<ViscousCoulombRolling>(&rolling_.model); law && law->length)
    for (int m = 0; m < materials_.count() * materials_.count(); ++m)
      if (materials_.pair(m / materials_.count(), m % materials_.count()).rolling_friction > 0)
        throw UserError("-rolling_length and the materials' rolling_friction both say the length g_r: give one");
  if (const auto* spring = std::get_if<SpringRolling>(&rolling_.model); spring && spring->needs_neck() && !soft)
    throw UserError(
        "-rolling_type spring needs -rolling_stiffness (N, positive): only the neck of -adhesion_type jkr or auto has "
        "a "
        "default");
}

PairProperties ContactLaws::pair(int a, int b) const {
  PairProperties pair = materials_.pair(a, b);
  pair.friction *= friction_factor_;
  pair.rolling_friction *= friction_factor_;
  pair.least_share = least_share_;
  // The effective radius grows with both, and is largest at a wall.
  const auto least = [&](int m) { return sizes_.smallest[m]; };
  const auto wall = [&](int m, int other) { return sizes_.largest[m] > 0 ? sizes_.largest[m] : sizes_.largest[other]; };
  if (sizes_.largest[a] > 0 || sizes_.largest[b] > 0) {
    const double ra = least(a), rb = least(b);
    pair.smallest_radius = ra < infinity && rb < infinity ? ra * rb / (ra + rb) : std::min(ra, rb);
    pair.largest_radius = std::max(wall(a, b), wall(b, a));
  }
  return pair;
}

void ContactLaws::prepare() {
  each([&](auto& slot, LawStage& stage) {
    slot.constants = std::visit([&](const auto& model) { return table(model, *this, materials_.count()); }, slot.model);
    stage.constants = slot.constants.data();
  });
}

void ContactLaws::set_sizes(const ParticleSizes& sizes) {
  sizes_ = sizes;
  notices_.clear();
  warnings_.clear();
  prepare();
  setup_.enter_gap = setup_.leave_gap = 0;
  each([&](const auto& slot, const LawStage&) {
    std::visit(
        [&](const auto& model) {
          using Model = std::decay_t<decltype(model)>;
          double worst = 0;
          each_encounter(materials_, sizes_, [&](int a, int b, const Encounter& e) {
            const auto constants = model.constants(pair(a, b));
            if constexpr (requires { model.reach(constants, e); }) {
              // A hair more than the law's own end, so that the end is the law's.
              setup_.leave_gap = std::max(setup_.leave_gap, 1.001 * model.reach(constants, e));
              if constexpr (requires { model.enter(constants, e); })
                setup_.enter_gap = std::max(setup_.enter_gap, model.enter(constants, e));
            }
            if constexpr (requires { Model::template force<double>(Contact<double>{}, constants, {}); }) {
              const Shape shape = shape_of(model, constants, e);
              if (shape.peak > 0) worst = std::max(worst, shape.end / shape.peak);
            }
          });
          if (worst > 1e-3)
            warnings_.push_back(
                fmt::format("the force {} is cut off at {:.2g} of its peak; allowed without this line: 0.001 "
                            "(give a longer cutoff)",
                            model.name, worst));
        },
        slot.model);
  });
  if (setup_.adhesion.model > 0) describe_adhesion();
}

void ContactLaws::describe_adhesion() {
  const double distance = std::visit(
      [](const auto& model) {
        if constexpr (requires { model.shared; })
          return model.shared.distance;
        else
          return 0.0;
      },
      adhesion_.model);
  const char* chosen = std::visit([](const auto& model) { return model.name; }, adhesion_.model);
  for (int a = 0; a < materials_.count(); ++a)
    for (int b = a; b < materials_.count(); ++b) {
      const PairProperties p = pair(a, b);
      if (p.largest_radius <= 0 || p.surface_energy <= 0) continue;
      const auto tabor = [&](double radius) {
        return tabor_parameter(radius, p.surface_energy, p.effective_young, distance);
      };
      const double low = tabor(p.smallest_radius), high = tabor(p.largest_radius);
      notices_.push_back(fmt::format("adhesion {} of {} with {}: Tabor parameter {:.3g} to {:.3g}, {}", chosen,
                                     materials_[a].name, materials_[b].name, low, high,
                                     high < tabor_hard  ? "where dmt holds"
                                     : low > tabor_soft ? "where jkr holds"
                                                        : "between dmt (below 0.1) and jkr (above 3)"));
    }
}

double ContactLaws::duration(int a, int b, const Encounter& encounter) const {
  return std::visit(
      [&](const auto& model) {
        return std::decay_t<decltype(model)>::duration(model.constants(pair(a, b)), encounter);
      },
      normal_.model);
}

std::vector<LawDuration> ContactLaws::pull_durations(int a, int b, const Encounter& encounter) const {
  std::vector<LawDuration> result;
  const auto add = [&](const char* slot, const auto& acts) {
    std::visit(
        [&](const auto& model) {
          using Model = std::decay_t<decltype(model)>;
          const auto constants = model.constants(pair(a, b));
          double stiffness = 0, damping = 0;
          if constexpr (requires { Model::damping(constants, encounter); })
            damping = Model::damping(constants, encounter);
          if constexpr (requires { Model::stiffness(constants, encounter); })
            stiffness = Model::stiffness(constants, encounter);
          else if constexpr (requires { model.slope(constants, encounter); })
            stiffness = model.slope(constants, encounter);
          else if constexpr (requires { Model::template force<double>(Contact<double>{}, constants, {}); })
            if (damping == 0) stiffness = shape_of(model, constants, encounter).slope;
          if (stiffness > 0)
            result.push_back(
                {fmt::format("{} {}", slot, model.name), std::numbers::pi * std::sqrt(encounter.mass / stiffness)});
          if (damping > 0)
            result.push_back(
                {fmt::format("{} {} (viscous)", slot, model.name), std::numbers::pi * encounter.mass / damping});
        },
        acts);
  };
  add("adhesion", adhesion_.model);
  add("dlvo", dlvo_.model);
  add("bridge", bridge_.model);
  add("interfacial", interfacial_.model);
  add("lubrication", lubrication_.model);
  return result;
}

std::vector<LawDuration> ContactLaws::swing_durations(int a, int b, const Encounter& encounter) const {
  std::vector<LawDuration> result;
  const auto add = [&](const char* slot, const auto& resists) {
    std::visit(
        [&](const auto& model) {
          using Model = std::decay_t<decltype(model)>;
          const auto constants = model.constants(pair(a, b));
          if constexpr (requires { Model::swing(constants, encounter); })
            if (const double time = Model::swing(constants, encounter); time < infinity)
              result.push_back({fmt::format("{} {}", slot, model.name), time});
        },
        resists);
  };
  add("tangential", tangential_.model);
  add("rolling", rolling_.model);
  add("twisting", twisting_.model);
  return result;
}

bool ContactLaws::hertzian() const {
  return std::visit([](const auto& model) { return std::decay_t<decltype(model)>::hertzian; }, normal_.model);
}

}  // namespace silt
