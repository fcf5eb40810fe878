// A damper whose force is no straight line over the velocity: bump, rebound and a valve that opens.
//
//   F = (1 + kappa sgn(v)) (c D(v) + c2 v |v|)
//   D(v) = r v + (1 - r) v / sqrt(1 + (v / v_k)^2)
//
// kappa damping_asymmetry, positive: stronger while x grows (rebound of a strut); v_k [m/s]
// damping_knee, 0: D = v; r damping_beyond, slope beyond the knee over that below: less than 1
// digressive, more progressive; c [N s/m] viscous (c(x) along the stroke), c2 quadratic_damping.
// Passive for |kappa| < 1, r >= 0. The force is continuous, its slope jumps at v = 0 with kappa.
// Not modelled: hysteresis of the valve, cavitation.

#include "laws.h"

double damper_shaped(const InerterDevice* p, double viscous, double v) {
  double bent = v;
  if (p->damping_knee > 0) {
    double ratio = v / p->damping_knee;
    bent = p->damping_beyond * v + (1 - p->damping_beyond) * v / sqrt(1 + ratio * ratio);
  }
  double force = viscous * bent + p->quadratic_damping * fabs(v) * v;
  double side = v < 0 ? -p->damping_asymmetry : p->damping_asymmetry;
  return force * (1 + side) - p->damping_held * v;
}

double damper_steepest(const InerterDevice* p) {
  double bent = p->damping_knee > 0 ? fmax(1, p->damping_beyond) : 1;
  return p->viscous * bent * (1 + fabs(p->damping_asymmetry));
}
