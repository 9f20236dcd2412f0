#pragma once
#include "particles/real.hpp"

namespace silt {

/// What every step needs of a moving sphere: one cache line, two aligned loads of four doubles.
struct alignas(64) Motion {
  double position[3];   ///< m
  double radius;        ///< m
  double velocity[3];   ///< m/s
  double inverse_mass;  ///< 1/kg
};
static_assert(sizeof(Motion) == 64);

/// What a force law needs besides; stored apart, so that those that touch nothing move without it.
struct alignas(32) Rotation {
  double spin[3];   ///< rad/s
  double material;  ///< index into Materials (a whole number)
};
static_assert(sizeof(Rotation) == 32);

/// All a force law needs of a sphere.
struct Body : Motion, Rotation {};

/// One contact as the force laws see it, between particle i and a partner j: another particle, a ghost or a wall.
/// `Real` is double or a pack of doubles (one contact a lane). Whoever makes contacts fills this and nothing else, so
/// no law is written twice; for a wall R_eff = R_i, m_eff = m_i, arm_j = 0 and its spin is that of the wall.
template <class Real>
struct Contact {
  Real normal[3];         ///< unit vector from j to i
  Real overlap;           ///< m, x = R_i + R_j - R_ij, > 0 in contact
  Real approach;          ///< m/s, dx/dt, > 0 while approaching
  Real slip[3];           ///< m/s, tangential velocity of i relative to j at the contact point
  Real spin[3];           ///< rad/s, w_i - w_j
  Real effective_radius;  ///< m, (7.14)
  Real effective_mass;    ///< kg, (7.10)
  Real dt;                ///< s, length of the step that has led here, 0 at the start

  // Only where a law of the run is `extended` (as spin):
  Real radius;           ///< m, of i; with effective_radius it gives R_j also at a wall: 1/R_j = 1/R_eff - 1/R_i
  Real distance;         ///< m, X = R_ij between the centres; at a wall from the centre to the wall
  Real rolling_inertia;  ///< kg m2, of the relative rolling, (1/(7/5 m_i R_i^2) + 1/(7/5 m_j R_j^2))^-1
};

/// Distances from the two centres to the contact point. arm_i + arm_j = R_ij, so that a pair of equal and opposite
/// forces at that point leaves the angular momentum unchanged; both bodies give way by half the overlap.
template <class Real>
struct Arms {
  Real i, j;
};

/// A point where a particle is near a wall, as the wall's geometry gives it: with the particle it makes a Contact
/// (wall_contact below). An edge or vertex that several facets share gives one point.
///
/// The engine asks walls/walls.hpp for them in two calls:
///   void list(const Motion* particles, int count, double skin);
///     at every rebuild: remember which of the particles may come within their radius of a wall (of any rank's facets)
///     before having moved `skin` / 2;
///   void points(const Motion* particles, double time, std::vector<WallPoint>& points) const;
///     every substep: the points nearer than the particle's radius, ordered by particle, in the same order on every
///     call with the same input. The engine carries the history of a point to the next step's point of the same
///     particle whose normal is nearest to it, so facets need no key and rolling over an edge between them is smooth.
struct WallPoint {
  int particle;        ///< local index
  int boundary;        ///< which wall: the boundaries of the mesh, then the rigid walls (forces are summed per wall)
  int material;        ///< index into Materials
  double distance;     ///< m, from the centre to the point; touching when below the radius
  double normal[3];    ///< unit vector from the wall to the centre
  double velocity[3];  ///< m/s, of the wall's material at the point
  double shift[3];     ///< m, of the rigid wall's periodic image that is touched
};

template <class Real>
SILT_INLINE Real dot(const Real* a, const Real* b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Fills approach, slip and spin of a contact whose normal is set, from the velocity difference of the centres (or of
/// the centre and the wall's point) `velocity` = v_i - v_j and `rolling` = arm_i w_i + arm_j w_j.
template <class Real>
SILT_INLINE void set_relative_motion(Contact<Real>& contact, const Real* velocity, const Real* rolling) {
  const Real* n = contact.normal;
  const Real separating = dot(velocity, n);
  contact.approach = -separating;
  // Velocity of the material at the contact point, -arm w x n for i and +arm w x n for j, less its normal part.
  contact.slip[0] = velocity[0] - separating * n[0] - (rolling[1] * n[2] - rolling[2] * n[1]);
  contact.slip[1] = velocity[1] - separating * n[1] - (rolling[2] * n[0] - rolling[0] * n[2]);
  contact.slip[2] = velocity[2] - separating * n[2] - (rolling[0] * n[1] - rolling[1] * n[0]);
}

/// The contact of a particle with a wall: R_eff = R, m_eff = m; the wall is rigid, so the arm is the distance.
inline Contact<double> wall_contact(const Body& particle, const WallPoint& point) {
  Contact<double> contact;
  double velocity[3], rolling[3];
  for (int d = 0; d < 3; ++d) {
    contact.normal[d] = point.normal[d];
    velocity[d] = particle.velocity[d] - point.velocity[d];
    rolling[d] = point.distance * particle.spin[d];
    contact.spin[d] = particle.spin[d];
  }
  contact.overlap = particle.radius - point.distance;
  contact.effective_radius = particle.radius;
  contact.effective_mass = 1 / particle.inverse_mass;
  contact.dt = 0;
  contact.radius = particle.radius;
  contact.distance = point.distance;
  contact.rolling_inertia = 1.4 * particle.radius * particle.radius / particle.inverse_mass;
  set_relative_motion(contact, velocity, rolling);
  return contact;
}

}  // namespace silt
