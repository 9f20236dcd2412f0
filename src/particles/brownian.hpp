#pragma once
#include "base/models.hpp"
#include "base/options.hpp"
#include "particles/store.hpp"
#include "particles/sweep.hpp"

namespace silt {

/// What `-brownian_...` switches on.
inline constexpr SwitchedModel brownian_models[] = {
    {"inertial",
     "brownian_temperature",
     {"(3.293)", "Ornstein & Uhlenbeck 1930; Ermak & Buckholz 1980",
      "noise that keeps m <v^2>/3 = k_B T: <dv^2> = (k_B T/m)(1 - exp(-2 k h/m)) a substep h, with the displacement "
      "that "
      "goes with it",
      "equipartition, velocity autocorrelation and 6 D t at any step; the same noise on any ranks"}},
    {"overdamped",
     "brownian_overdamped yes",
     {"(3.293)", "Ermak & McCammon 1978", "dx = (u + F/k) h + (2 D h)^0.5 xi, D = k_B T/k",
      "6 D t, and the drift F/k"}},
};

/// The options `-brownian_...`.
struct BrownianOptions {
  double temperature = 0;
  bool overdamped = false;
  int seed = 1;
  void options(OptionGroup& option) {
    option("temperature", temperature, "K",
           "temperature of the Brownian motion that goes with drag (and with the viscous torque); 0: none",
           non_negative);
    option("overdamped", overdamped,
           "particles have no inertia: dx = (u + F/k) dt + noise; for steps far beyond the response time");
    option("seed", seed, "-", "another seed, another noise", at_least(0));
  }
};

/// How far the particles of this rank have come. m
struct BrownianWay {
  double from_lists;  ///< largest distance from where the lists were made
  double jump;        ///< longest way by the noise of this substep
};

/// Brownian motion (3.293) by the exact step of Ornstein & Uhlenbeck (F5, docs/theory/fluid_forces.md): over a substep
/// the drag of a particle goes with jointly normal changes of velocity and position, so that the friction of the motion
/// is that of the noise for every step. Spin and angle of a particle with viscous torque likewise. The random numbers
/// are a function of particle id, time and seed: any ranks give the same.
class Brownian {
 public:
  explicit Brownian(const BrownianOptions& options) : options_(options) {}
  bool active() const { return options_.temperature > 0; }
  bool overdamped() const { return options_.overdamped; }
  /// m/s, speed that few particles of this mass exceed: three times the root mean square.
  double speed(double mass) const;
  /// Moves the particles of a drift pass on; `time` is that of the end of the substep. Adds what they received to
  /// DragStep::impulse: it comes from the fluid.
  BrownianWay act(Store& store, const Integration& step, double time) const;

 private:
  BrownianOptions options_;
};

}  // namespace silt
