// End stops: elastic, and damped in proportion to the depth.
//
//   upper: depth = x - stop_upper > 0:  F = +k_e depth max(0, 1 + e v)
//   lower: depth = stop_lower - x > 0:  F = -k_e depth max(0, 1 - e v)
//
// x [m], v [m/s] displacement and velocity of the terminals; k_e [N/m] stop_stiffness, e [s/m]
// stop_damping. F is the force that lengthens: at the upper stop tension. Stored energy
// k_e depth^2 / 2.
// Why depth times speed and not a damper beside the spring: that one jumps at the touch and pulls
// at the release. The max keeps a stop from holding what leaves it.
// Source: Hunt & Crossley 1975, with exponent 1. For small losses the coefficient of restitution is
// 1 - 2/3 e v at impact speed v.
// Implicit steps lose more: over_step.c.
// Not modelled: adhesion, the mass of the stop, plastic deformation.

#include "laws.h"

// depth in a stop, and the direction in which it pushes back; depth 0 where there is none
static double depth_at(const InerterDevice* p, double x, double* side) {
  if (x > p->stop_upper) {
    *side = 1;
    return x - p->stop_upper;
  }
  *side = -1;
  return x < p->stop_lower ? p->stop_lower - x : 0;  // false where the stop is unset: NaN
}

double stop_force(const InerterDevice* p, double x, double v) {
  double side, depth = depth_at(p, x, &side);
  if (depth == 0) {
    return 0;
  }
  return side * p->stop_stiffness * depth * fmax(0, 1 + side * p->stop_damping * v);
}

double stop_energy(const InerterDevice* p, double x) {
  double side, depth = depth_at(p, x, &side);
  return 0.5 * p->stop_stiffness * depth * depth;
}

double stop_heat(const InerterDevice* p, double x, double v) {
  double side, depth = depth_at(p, x, &side);
  if (depth == 0) {
    return 0;
  }
  return p->stop_stiffness * depth * fmax(-1, side * p->stop_damping * v) * side * v;
}
