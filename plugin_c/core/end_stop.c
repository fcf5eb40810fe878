// End stops: elastic, and damped in proportion to the depth.
//
//   upper: depth = x - stop_upper > 0:  F = +(k_e depth + k_e3 depth^3) max(0, 1 + e v)
//   lower: depth = stop_lower - x > 0:  F = -(k_e depth + k_e3 depth^3) max(0, 1 - e v)
//
// x [m], v [m/s] displacement and velocity of the terminals; k_e [N/m] stop_stiffness, k_e3 [N/m^3]
// stop_stiffness_cubic, of rubber that stiffens; e [s/m] stop_damping. F is the force that
// lengthens: at the upper stop tension. Stored energy k_e depth^2 / 2 + k_e3 depth^4 / 4.
// Why depth times speed and not a damper beside the spring: that one jumps at the touch and pulls
// at the release. The max keeps a stop from holding what leaves it.
// Source: Hunt & Crossley 1975, with exponent 1 and 3. For small losses the coefficient of
// restitution is 1 - 2/3 e v at impact speed v, of any elastic force.
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

// elastic force of a stop at a depth
static double elastic(const InerterDevice* p, double depth) {
  return (p->stop_stiffness + p->stop_stiffness_cubic * depth * depth) * depth;
}

double stop_force(const InerterDevice* p, double x, double v) {
  double side, depth = depth_at(p, x, &side);
  if (depth == 0) {
    return 0;
  }
  return side * elastic(p, depth) * fmax(0, 1 + side * p->stop_damping * v);
}

double stop_energy(const InerterDevice* p, double x) {
  double side, depth = depth_at(p, x, &side);
  double square = depth * depth;
  return (0.5 * p->stop_stiffness + 0.25 * p->stop_stiffness_cubic * square) * square;
}

double stop_heat(const InerterDevice* p, double x, double v) {
  double side, depth = depth_at(p, x, &side);
  if (depth == 0) {
    return 0;
  }
  return elastic(p, depth) * fmax(-1, side * p->stop_damping * v) * side * v;
}
