// A block of contacts and the stages of force laws that run over it; part of sweep_kernels.hpp, compiled once per
// instruction set.
#pragma once
#include <type_traits>

#include "particles/contact_models.hpp"
#include "particles/pack.hpp"
#include "particles/sweep.hpp"

namespace silt {
namespace SILT_ISA {

inline constexpr int block_size = 64;

/// The contacts of a block, one array a quantity.
struct alignas(64) Block {
  double normal[3][block_size], overlap[block_size], approach[block_size];
  double slip[3][block_size], spin[3][block_size];
  double effective_radius[block_size], effective_mass[block_size];
  double arm_i[block_size], arm_j[block_size];
  double pair[block_size];  ///< number of the pair of materials
  double normal_force[block_size], damping[block_size], contact_radius[block_size];
  double force[3][block_size], torque[3][block_size];
};

SILT_INLINE Contact<Pack> contact_at(const Block& block, int o) {
  Contact<Pack> contact;
  for (int d = 0; d < 3; ++d) {
    contact.normal[d] = load(&block.normal[d][o]);
    contact.slip[d] = load(&block.slip[d][o]);
    contact.spin[d] = load(&block.spin[d][o]);
  }
  contact.overlap = load(&block.overlap[o]);
  contact.approach = load(&block.approach[o]);
  contact.effective_radius = load(&block.effective_radius[o]);
  contact.effective_mass = load(&block.effective_mass[o]);
  return contact;
}

SILT_INLINE NormalLoad<Pack> normal_load_at(const Block& block, int o) {
  return {load(&block.normal_force[o]), load(&block.damping[o]), load(&block.contact_radius[o])};
}

template <class Struct>
inline constexpr int packs_in = std::is_empty_v<Struct> ? 0 : int(sizeof(Struct) / sizeof(Pack));

/// The constants of the contacts at o: the same for all lanes with one material, else looked up by their pair.
template <class Constants, bool several>
SILT_INLINE Constants constants_at(const LawStage& stage, int materials, const Block& block, int o) {
  Constants constants;
  Pack* entry = reinterpret_cast<Pack*>(&constants);
  const int pairs = materials * materials;
  for (int c = 0; c < packs_in<Constants>; ++c) {
    if constexpr (several) {
      Vector value;
      for (int k = 0; k < lanes; ++k) value[k] = stage.constants[c * pairs + int(block.pair[o + k])];
      entry[c] = value;
    } else {
      entry[c] = Pack(stage.constants[c * pairs]);
    }
  }
  return constants;
}

/// Where the history of the block's first contact stands.
struct HistoryAt {
  double* first;
  std::size_t stride;
};

template <class History>
SILT_INLINE History history_at(const HistoryAt& at, int o) {
  History history;
  Pack* entry = reinterpret_cast<Pack*>(&history);
  for (int c = 0; c < packs_in<History>; ++c) entry[c] = load(at.first + c * at.stride + o);
  return history;
}
template <class History>
SILT_INLINE void keep_history(const History& history, const HistoryAt& at, int o) {
  const Pack* entry = reinterpret_cast<const Pack*>(&history);
  for (int c = 0; c < packs_in<History>; ++c) store(at.first + c * at.stride + o, entry[c]);
}

struct StageCall {
  const LawSetup* laws;
  const LawStage* stage;
  HistoryAt history;
  int count;
  double dt;
};
using StageFunction = void (*)(Block&, const StageCall&);

template <class Model, bool several>
void normal_stage(Block& block, const StageCall& call) {
  using Constants = typename Model::template Constants<Pack>;
  using History = typename Model::template History<Pack>;
  for (int o = 0; o < call.count; o += lanes) {
    const Constants constants = constants_at<Constants, several>(*call.stage, call.laws->materials, block, o);
    History history = history_at<History>(call.history, o);
    const NormalLoad<Pack> result = Model::template load<Pack>(contact_at(block, o), constants, history);
    keep_history(history, call.history, o);
    store(&block.normal_force[o], result.force);
    store(&block.damping[o], result.damping);
    store(&block.contact_radius[o], result.contact_radius);
  }
}

template <class Model, bool several>
void tangential_stage(Block& block, const StageCall& call) {
  using Constants = typename Model::template Constants<Pack>;
  using History = typename Model::template History<Pack>;
  const Pack dt(call.dt);
  for (int o = 0; o < call.count; o += lanes) {
    const Constants constants = constants_at<Constants, several>(*call.stage, call.laws->materials, block, o);
    History history = history_at<History>(call.history, o);
    const Contact<Pack> contact = contact_at(block, o);
    const NormalLoad<Pack> normal = normal_load_at(block, o);
    Pack force[3];
    Model::template force<Pack>(contact, normal, constants, dt, history, force);
    keep_history(history, call.history, o);
    for (int d = 0; d < 3; ++d) store(&block.force[d][o], force[d] + normal.force * contact.normal[d]);
  }
}

template <class Model, bool several>
void rolling_stage(Block& block, const StageCall& call) {
  using Constants = typename Model::template Constants<Pack>;
  using History = typename Model::template History<Pack>;
  const Pack dt(call.dt);
  for (int o = 0; o < call.count; o += lanes) {
    const Constants constants = constants_at<Constants, several>(*call.stage, call.laws->materials, block, o);
    History history = history_at<History>(call.history, o);
    Pack torque[3];
    Model::template torque<Pack>(contact_at(block, o), normal_load_at(block, o), constants, dt, history, torque);
    keep_history(history, call.history, o);
    for (int d = 0; d < 3; ++d) store(&block.torque[d][o], torque[d]);
  }
}

/// The stage functions of a list of models, by place in the list.
template <bool several, class... Model>
SILT_INLINE StageFunction normal_function(const Models<Model...>*, int model) {
  static constexpr StageFunction functions[] = {normal_stage<Model, several>...};
  return functions[model];
}
template <bool several, class... Model>
SILT_INLINE StageFunction tangential_function(const Models<Model...>*, int model) {
  static constexpr StageFunction functions[] = {tangential_stage<Model, several>...};
  return functions[model];
}
template <bool several, class... Model>
SILT_INLINE StageFunction rolling_function(const Models<Model...>*, int model) {
  static constexpr StageFunction functions[] = {rolling_stage<Model, several>...};
  return functions[model];
}
template <class... Model>
SILT_INLINE bool rolls(const Models<Model...>*, int model) {
  static constexpr bool acts[] = {Model::acts...};
  return acts[model];
}

/// The three laws of a run, looked up once a sweep.
struct Laws {
  StageFunction normal, tangential, rolling;
  bool rolls;
  SILT_INLINE explicit Laws(const LawSetup& setup) {
    const NormalModels* normals = nullptr;
    const TangentialModels* tangentials = nullptr;
    const RollingModels* rollings = nullptr;
    const bool several = setup.materials > 1;
    const int n = setup.normal.model, t = setup.tangential.model, r = setup.rolling.model;
    normal = several ? normal_function<true>(normals, n) : normal_function<false>(normals, n);
    tangential = several ? tangential_function<true>(tangentials, t) : tangential_function<false>(tangentials, t);
    rolling = several ? rolling_function<true>(rollings, r) : rolling_function<false>(rollings, r);
    rolls = SILT_ISA::rolls(rollings, r);
  }
  SILT_INLINE void run(Block& block, const LawSetup& setup, double* history, std::size_t stride, int count,
                       double dt) const {
    const auto call = [&](const LawStage& stage) {
      return StageCall{&setup, &stage, {history + stage.first_history * stride, stride}, count, dt};
    };
    normal(block, call(setup.normal));
    tangential(block, call(setup.tangential));
    if (rolls) rolling(block, call(setup.rolling));
  }
};

}  // namespace SILT_ISA
}  // namespace silt
