#pragma once
#include "base/models.hpp"
#include "particles/materials.hpp"
#include "particles/tangential/tangential_load.hpp"

namespace silt {

/// Incremental slip (7.37-7.38), Walton & Braun 1986. F* is the value of F_t at the last reversal (0 at first), scaled
/// with F_n when F_n changes. The stiffness is integrated over the step in closed form, so F_t does not depend on the
/// size of the increments. In 3D the part of d(zeta) normal to F_t uses k_t0, and F_t is turned into the present
/// tangent plane first (Walton 1993). k_n is the slope of the normal spring, s the mean Poisson ratio of the pair.
struct WaltonBraunTangential {
  static constexpr const char* name = "walton_braun";
  static constexpr ModelNote note{
      "(7.37-7.38)", "Walton & Braun 1986; Walton 1993",
      "F_t += k_t d(zeta), k_t = k_t0 [1 - (F_t - F*)/(mu F_n - F*)]^(1/3) growing, k_t0 [1 - (F* - F_t)/(mu F_n + "
      "F*)]^(1/3) falling, k_t0 = k_n (1 - s)/(1 - s/2)",
      "F_t = mu F_n [1 - (1 - 2/3 k_t0 zeta/(mu F_n))^1.5] on first loading, and its unloading curve"};
  static constexpr bool extended = false;
  void options(OptionGroup&) {}

  template <class Real>
  struct Constants {
    Real ratio;  ///< -, k_t0/k_n
    Real friction, least_share;
  };
  Constants<double> constants(const PairProperties& pair) const {
    return {(1 - pair.poisson_ratio) / (1 - pair.poisson_ratio / 2), pair.friction, pair.least_share};
  }

  template <class Real>
  struct History {
    Real force[3];  ///< N, F_t as the displacement pulls it (the force on i is its negative)
    Real turning;   ///< N, F*, signed along `force`
    Real falling;   ///< -1 while F_t grows, 1 while it falls, 0 at first
    Real limit;     ///< N, mu F_n of the last step
    Real owed[3];   ///< m, displacement in the rest of the step, after the force was read (share_of_step)
  };

  template <class Real>
  static SILT_INLINE void force(const Contact<Real>& contact, const NormalLoad<Real>& normal, const Constants<Real>& c,
                                Real dt, History<Real>& history, Real* force) {
    const Real zero(0.0), one(1.0), least(1e-300), two_thirds(2.0 / 3.0);
    const Real limit = c.friction * magnitude(normal.force), stiffness = c.ratio * normal.stiffness;
    turn_into_plane(history.force, contact.normal);
    const Real present = sqrt(dot(history.force, history.force));
    const Real read = dt * share_of_step(c.least_share, stiffness, contact.effective_mass, dt);
    const Real out_of_plane = dot(history.owed, contact.normal);
    Real direction[3], step[3];
    for (int d = 0; d < 3; ++d) {
      step[d] = history.owed[d] - out_of_plane * contact.normal[d] + read * contact.slip[d];
      history.owed[d] = (dt - read) * contact.slip[d];
      direction[d] = history.force[d] / larger(present, least);
    }
    // Without a force yet, it starts along the displacement.
    const Real length = sqrt(dot(step, step));
    for (int d = 0; d < 3; ++d) direction[d] = select(present > zero, direction[d], step[d] / larger(length, least));
    const Real along = dot(step, direction);
    const auto grows = along >= zero;
    const Real falling = select(grows, zero - one, one);
    const Real scaled = select(history.limit > zero, history.turning * limit / larger(history.limit, least), zero);
    // The first loading starts from F* = 0; afterwards each change of sense is a reversal.
    const Real turning = select(falling * history.falling < zero, present, scaled);
    const Real room = larger(select(grows, limit - turning, limit + turning), least);
    const Real passed = larger(smaller(select(grows, present - turning, turning - present) / room, one), zero);
    // With y = 1 - passed, dy/dzeta = -k_t0/room y^(1/3), hence y^(2/3) falls linearly.
    const Real root = cbrt(one - passed);
    const Real left = larger(root * root - two_thirds * stiffness * magnitude(along) / room, zero);
    const Real moved = room * (one - left * sqrt(left));
    Real value = select(grows, turning + moved, turning - moved);
    value = larger(smaller(value, limit), zero - limit);
    Real result[3];
    for (int d = 0; d < 3; ++d) {
      const Real across = step[d] - along * direction[d];
      result[d] = value * direction[d] + stiffness * across;
    }
    const Real size = sqrt(dot(result, result));
    const Real kept = select(size > limit, limit / larger(size, least), one);
    // Past zero the force points the other way: it then grows from a reversal at -F*.
    const auto flipped = value < zero;
    history.turning = select(flipped, zero - turning, turning);
    history.falling = select(flipped, zero - one, select(length > zero, falling, history.falling));
    history.limit = limit;
    for (int d = 0; d < 3; ++d) {
      history.force[d] = kept * result[d];
      force[d] = zero - history.force[d];
    }
  }
};

}  // namespace silt
