// LuGre friction: a bristle whose yield level follows the Stribeck curve.
//
//   z' = v - sigma0 |v| z / g(v),  g = f_c + (f_s - f_c) exp(-(|v| / v_s)^delta) + load
//   F  = sigma0 z + sigma1 z'      (sigma2 v is the device's viscous term)
//
// z [m] bristle deflection; sigma0 [N/m] bristle_stiffness, sigma1 [N s/m] bristle_damping;
// f_c, f_s [N] coulomb_force, static_force (times the level of friction.h); v_s [m/s]
// stribeck_velocity; delta stribeck_exponent; load [N]: load_friction.c. Stored energy sigma0 z^2 /
// 2; steady sliding g(v). Source: Canudas de Wit, Olsson, Astrom, Lischinsky 1995. The hysteretic
// inerter paper prints |v| z / g without sigma0: its g is this g divided by sigma0. Passive where
// sigma1 <= 4 g / |v|; a constant sigma1 breaks that at high speed. Under a load sigma1 has another
// bound, mu sigma1 |v| < level (load_friction.c). Free play before it:
// friction_play.c. Not modelled: a sigma1 that falls with speed, hysteresis with non-local memory.

#include "friction.h"

static double yield_level(const InerterDevice* p, double x, double v, double load) {
  return friction_level(p, x, v) * friction_stribeck_curve(p, v) + load;
}

static double rate(const InerterDevice* p, double x, double v, double z, double load) {
  double g = yield_level(p, x, v, load);
  return v - p->bristle_stiffness * fabs(v) * z / g;
}

// exact at constant v: exponential decay towards sgn(v) g / sigma0
static double step(const InerterDevice* p, double x, double v, double z, double h, double load) {
  double g = yield_level(p, x, v, load);
  if (v == 0) {
    return z;
  }
  double end = sign(v) * g / p->bristle_stiffness;
  return z - expm1(-p->bristle_stiffness * fabs(v) * h / g) * (end - z);
}

// the same decay, from z against v until 0
static double straight(const InerterDevice* p, double x, double v, double z, double load) {
  double decay = p->bristle_stiffness / yield_level(p, x, v, load);
  return log1p(decay * fabs(z)) / (decay * fabs(v));
}

static double force_of_rate(const InerterDevice* p, double z, double z_rate) {
  return p->bristle_stiffness * z + p->bristle_damping * z_rate;
}

static double force(const InerterDevice* p, double x, double v, double z, double load) {
  return force_of_rate(p, z, rate(p, x, v, z, load));
}

// both at once, with the derivative over v but for that of the level's asymmetry
static double over_step(const InerterDevice* p, double x, double v, double z, double h,
                        double share, double* slope) {
  double factor = friction_level(p, x, v), curve = friction_stribeck_curve(p, v);
  double g = factor * curve, stiff = p->bristle_stiffness, speed = fabs(v);
  double end = sign(v) * g / stiff, gone = v == 0 ? 0 : -expm1(-stiff * speed * h / g);
  double change = gone * (end - z);

  // g' over g: the fall of the curve
  double fall = 0, excess = p->static_force - p->coulomb_force;
  if (excess != 0 && v != 0) {
    double power = log(excess / (curve - p->coulomb_force));
    fall = curve > p->coulomb_force
               ? -p->stribeck_exponent * power / v * (curve - p->coulomb_force) / curve
               : 0;
  }
  double path = stiff * h / g, left = 1 - gone;
  double dchange = v == 0 ? h - path * z
                          : left * path * (sign(v) - speed * fall) * (end - z) + gone * end * fall;
  *slope = (stiff * share + p->bristle_damping / h) * dchange;
  return force_of_rate(p, z + share * change, change / h);
}

static double energy(const InerterDevice* p, double x, double z) {
  (void)x;
  return 0.5 * p->bristle_stiffness * z * z;
}

static double stiffness(const InerterDevice* p) {
  return p->bristle_stiffness;
}

static void along(const InerterDevice* p, const FrictionPath* path, double* z, double* forces) {
  friction_along(p, path, z, forces, step, force);
}

const FrictionLaw inerter_lugre = {
    .rate = rate,
    .step = step,
    .straight = straight,
    .force = force,
    .energy = energy,
    .stiffness = stiffness,
    .along = along,
    .force_of_rate = force_of_rate,
    .over_step = over_step,
};
