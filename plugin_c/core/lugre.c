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

#include "friction_block.h"

static double yield_level(const InerterDevice* p, double x, double v, double load) {
  return friction_level(p, x, v) * friction_stribeck_curve(p, v) + load;
}

static INLINED double rate_at(const InerterDevice* p, double v, double z, double g) {
  return v - p->bristle_stiffness * fabs(v) * z / g;
}

static double rate(const InerterDevice* p, double x, double v, double z, double load) {
  return rate_at(p, v, z, yield_level(p, x, v, load));
}

// share of the way to the steady state that is gone within h; the steady state
static INLINED double gone_within(const InerterDevice* p, double v, double h, double g) {
  return -elementary_expm1(-p->bristle_stiffness * fabs(v) * h / g);
}
static INLINED double bent_in_the_end(const InerterDevice* p, double v, double g) {
  return sign(v) * g / p->bristle_stiffness;
}

// exact at constant v: exponential decay towards sgn(v) g / sigma0
static double step(const InerterDevice* p, double x, double v, double z, double h, double load) {
  double g = yield_level(p, x, v, load);
  if (v == 0) {
    return z;
  }
  return z + gone_within(p, v, h, g) * (bent_in_the_end(p, v, g) - z);
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
  double end = bent_in_the_end(p, v, g), gone = gone_within(p, v, h, g);
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

static SEVERAL_AT_ONCE void along(const InerterDevice* p, const FrictionPath* path, double* z,
                                  double* forces) {
  FrictionSamples samples;
  double level[FRICTION_BLOCK], curve[FRICTION_BLOCK];
  double share[FRICTION_BLOCK] = {0}, end[FRICTION_BLOCK] = {0}, state[FRICTION_BLOCK] = {0};
  samples_between(p, path, &samples);
  levels_at(p, &samples, level);
  stribeck_curves_at(p, &samples, curve);
  for (int i = 0; i < samples.size; i++) {
    double g = level[i] * curve[i];
    share[i] = gone_within(p, samples.v[i], path->h, g);
    end[i] = bent_in_the_end(p, samples.v[i], g);
  }
  bristle_along(p, path, share, end, z, state, step);

  samples_at(p, path, &samples);
  levels_at(p, &samples, level);
  stribeck_curves_at(p, &samples, curve);
  for (int i = 0; i < samples.size; i++) {
    double slip = rate_at(p, samples.v[i], state[i], level[i] * curve[i]);
    forces[i] = force_of_rate(p, state[i], slip);
  }
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
