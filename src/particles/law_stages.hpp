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
  double pair[block_size];                                                       ///< number of the pair of materials
  double radius[block_size], distance[block_size], rolling_inertia[block_size];  ///< extended
  double normal_force[block_size], damping[block_size], contact_radius[block_size], stiffness[block_size];
  double pull_off[block_size] = {};  ///< stays 0 without adhesion
  double jump[block_size] = {};      ///< stays 0 unless the normal law jumps
  double pull[block_size];           ///< N, normal force besides normal_force; cohesive laws only
  double rest[block_size];           ///< s, of the step, after a tangential spring was read
  double noted[block_size];          ///< N, normal_force as the normal law left it; only where traced
  double force[3][block_size], torque[3][block_size];
  double dt = 0;  ///< s
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
  contact.dt = Pack(block.dt);
  contact.radius = load(&block.radius[o]);
  contact.distance = load(&block.distance[o]);
  contact.rolling_inertia = load(&block.rolling_inertia[o]);
  return contact;
}

SILT_INLINE NormalLoad<Pack> normal_load_at(const Block& block, int o) {
  return {load(&block.normal_force[o]), load(&block.damping[o]), load(&block.contact_radius[o]),
          load(&block.stiffness[o]), load(&block.pull_off[o])};
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

/// Calls act(first contact, constants, history) for every pack of contacts of the block and keeps the history.
template <class Model, bool several, class Act>
SILT_INLINE void each_pack(const Block& block, const StageCall& call, Act&& act) {
  using Constants = typename Model::template Constants<Pack>;
  using History = typename Model::template History<Pack>;
  for (int o = 0; o < call.count; o += lanes) {
    const Constants constants = constants_at<Constants, several>(*call.stage, call.laws->materials, block, o);
    History history = history_at<History>(call.history, o);
    act(o, constants, history);
    keep_history(history, call.history, o);
  }
}

template <class Model, bool several>
void normal_stage(Block& block, const StageCall& call) {
  each_pack<Model, several>(block, call, [&](int o, const auto& constants, auto& history) {
    const NormalLoad<Pack> result = Model::template load<Pack>(contact_at(block, o), constants, history);
    store(&block.normal_force[o], result.force);
    if constexpr (requires { Model::jumps; }) store(&block.jump[o], result.jump);
    store(&block.damping[o], result.damping);
    store(&block.contact_radius[o], result.contact_radius);
    store(&block.stiffness[o], result.stiffness);
  });
}

/// A tangential law that is a spring and dashpot with the Coulomb limit (tangential_load.hpp).
template <class Model>
inline constexpr bool is_spring = requires(NormalLoad<Pack> normal, typename Model::template Constants<Pack> c) {
  Model::template law<Pack>(normal, c);
};

template <class Model, bool several>
void tangential_stage(Block& block, const StageCall& call) {
  const Pack dt(call.dt);
  const auto keep = [&](int o, const Contact<Pack>& contact, const NormalLoad<Pack>& normal, const Pack* force) {
    for (int d = 0; d < 3; ++d) store(&block.force[d][o], force[d] + normal.force * contact.normal[d]);
  };
  if constexpr (is_spring<Model>) {
    each_pack<Model, several>(block, call, [&](int o, const auto& constants, auto& history) {
      const Pack stiffness = Model::template law<Pack>(normal_load_at(block, o), constants).stiffness;
      store(&block.rest[o], grow_spring(contact_at(block, o), stiffness, constants.least_share, dt, history.spring));
    });
    each_pack<Model, several>(block, call, [&](int o, const auto& constants, auto& history) {
      const Contact<Pack> contact = contact_at(block, o);
      const NormalLoad<Pack> normal = normal_load_at(block, o);
      Pack force[3];
      limit_spring(contact, normal.force, constants.friction, Model::template law<Pack>(normal, constants),
                   load(&block.rest[o]), history.spring, force);
      keep(o, contact, normal, force);
    });
  } else {
    each_pack<Model, several>(block, call, [&](int o, const auto& constants, auto& history) {
      const Contact<Pack> contact = contact_at(block, o);
      const NormalLoad<Pack> normal = normal_load_at(block, o);
      Pack force[3];
      Model::template force<Pack>(contact, normal, constants, dt, history, force);
      keep(o, contact, normal, force);
    });
  }
}

template <class Model, bool several>
void rolling_stage(Block& block, const StageCall& call) {
  const Pack dt(call.dt);
  each_pack<Model, several>(block, call, [&](int o, const auto& constants, auto& history) {
    Pack torque[3];
    Model::template torque<Pack>(contact_at(block, o), normal_load_at(block, o), constants, dt, history, torque);
    for (int d = 0; d < 3; ++d) store(&block.torque[d][o], torque[d]);
  });
}

template <class Model, bool several>
void twisting_stage(Block& block, const StageCall& call) {
  const Pack dt(call.dt);
  each_pack<Model, several>(block, call, [&](int o, const auto& constants, auto& history) {
    const Contact<Pack> contact = contact_at(block, o);
    const Pack torque = Model::template torque<Pack>(contact, normal_load_at(block, o), constants, dt, history);
    for (int d = 0; d < 3; ++d) store(&block.torque[d][o], load(&block.torque[d][o]) + torque * contact.normal[d]);
  });
}

template <class Model, bool several>
void adhesion_stage(Block& block, const StageCall& call) {
  each_pack<Model, several>(block, call, [&](int o, const auto& constants, auto& history) {
    NormalLoad<Pack> normal = normal_load_at(block, o);
    Pack pull;
    Model::template adhere<Pack>(contact_at(block, o), constants, history, normal, pull);
    store(&block.normal_force[o], normal.force);
    store(&block.contact_radius[o], normal.contact_radius);
    store(&block.stiffness[o], normal.stiffness);
    store(&block.pull_off[o], normal.pull_off);
    store(&block.pull[o], pull);
  });
}

/// A force along the line of centres that does not press the surfaces together. Such a law only reads its history.
template <class Model, bool several>
void pull_stage(Block& block, const StageCall& call) {
  each_pack<Model, several>(block, call, [&](int o, const auto& constants, const auto& history) {
    store(&block.pull[o], load(&block.pull[o]) + Model::template force<Pack>(contact_at(block, o), constants, history));
  });
}

/// Surfaces that do not touch rub no friction: their normal force is a pull, and the memory of the slip is dropped.
inline void separate_stage(Block& block, const StageCall& call) {
  const Pack zero(0.0);
  const int first = call.laws->tangential.first_history, last = call.laws->history_components;
  for (int o = 0; o < call.count; o += lanes) {
    const Mask touches = load(&block.contact_radius[o]) > zero;
    const Pack force = load(&block.normal_force[o]);
    store(&block.pull[o], load(&block.pull[o]) + select(touches, zero, force));
    store(&block.normal_force[o], select(touches, force, zero));
    store(&block.damping[o], select(touches, load(&block.damping[o]), zero));
    for (int c = first; c < last; ++c) {
      double* entry = call.history.first + c * call.history.stride + o;
      store(entry, select(touches, load(entry), zero));
    }
  }
}

inline void add_pull_stage(Block& block, const StageCall& call) {
  for (int o = 0; o < call.count; o += lanes)
    for (int d = 0; d < 3; ++d)
      store(&block.force[d][o], load(&block.force[d][o]) + load(&block.pull[o]) * load(&block.normal[d][o]));
}

inline void add_jump_stage(Block& block, const StageCall& call) {
  for (int o = 0; o < call.count; o += lanes)
    for (int d = 0; d < 3; ++d)
      store(&block.force[d][o], load(&block.force[d][o]) + load(&block.jump[o]) * load(&block.normal[d][o]));
}

inline void note_normal_stage(Block& block, const StageCall& call) {
  for (int o = 0; o < call.count; o += lanes)
    store(&block.noted[o], load(&block.normal_force[o]) + load(&block.jump[o]));
}

/// The stage functions of a list of models, by place in the list.
#define SILT_STAGE_OF(kind)                                                         \
  template <bool several, class... Model>                                           \
  SILT_INLINE StageFunction kind##_function(const Models<Model...>*, int model) {   \
    static constexpr StageFunction functions[] = {kind##_stage<Model, several>...}; \
    return functions[model];                                                        \
  }
SILT_STAGE_OF(normal)
SILT_STAGE_OF(adhesion)
SILT_STAGE_OF(pull)
SILT_STAGE_OF(tangential)
SILT_STAGE_OF(rolling)
SILT_STAGE_OF(twisting)
#undef SILT_STAGE_OF

/// The laws of a run in the order in which they act, looked up once a sweep.
class Laws {
 public:
  SILT_INLINE explicit Laws(const LawSetup& setup) : setup_(setup) {
    setup.materials > 1 ? choose<true>(setup) : choose<false>(setup);
  }
  SILT_INLINE void run(Block& block, double* history, std::size_t stride, int count, double dt) const {
    for (int s = 0; s < count_; ++s) {
      const LawStage& stage = *stage_[s];
      function_[s](block, {&setup_, &stage, {history + stage.first_history * stride, stride}, count, dt});
    }
  }

 private:
  SILT_INLINE void add(StageFunction function, const LawStage& stage) {
    function_[count_] = function;
    stage_[count_++] = &stage;
  }
  template <class List, bool several>
  SILT_INLINE void pull(const LawStage& stage) {
    if (stage.model > 0) add(pull_function<several>(static_cast<const List*>(nullptr), stage.model), stage);
  }
  template <bool several>
  SILT_INLINE void choose(const LawSetup& setup) {
    add(normal_function<several>(static_cast<const NormalModels*>(nullptr), setup.normal.model), setup.normal);
    if (setup.traced) add(note_normal_stage, whole_);
    if (setup.cohesive) {
      // The adhesion sets the pull, be it none; the others add to it.
      add(adhesion_function<several>(static_cast<const AdhesionModels*>(nullptr), setup.adhesion.model),
          setup.adhesion);
      pull<DlvoModels, several>(setup.dlvo);
      pull<BridgeModels, several>(setup.bridge);
      pull<InterfacialModels, several>(setup.interfacial);
      pull<LubricationModels, several>(setup.lubrication);
      add(separate_stage, whole_);
    }
    add(tangential_function<several>(static_cast<const TangentialModels*>(nullptr), setup.tangential.model),
        setup.tangential);
    if (setup.cohesive) add(add_pull_stage, whole_);
    if (setup.jumping) add(add_jump_stage, whole_);
    if (!setup.extended) return;
    // The first of the two writes the torque, be it none.
    add(rolling_function<several>(static_cast<const RollingModels*>(nullptr), setup.rolling.model), setup.rolling);
    if (setup.twisting.model > 0)
      add(twisting_function<several>(static_cast<const TwistingModels*>(nullptr), setup.twisting.model),
          setup.twisting);
  }

  const LawSetup& setup_;
  LawStage whole_;  ///< for stages that see the whole history
  StageFunction function_[13];
  const LawStage* stage_[13];
  int count_ = 0;
};

}  // namespace SILT_ISA
}  // namespace silt
