// Dahl friction: one bristle that bends before it slides.
//
//   z' = v sgn(u) |u|^m,  u = 1 - sigma0 z sgn(v) / (f_c + load)
//   F  = sigma0 z
//
// z [m] bristle deflection, sigma0 [N/m] bristle_stiffness, f_c [N] coulomb_force (times the level
// of friction.h), m dahl_exponent, load [N]: load_friction.c. Stored energy sigma0 z^2 / 2.
// |F| <= f_c + load once inside.
// Passive for every m.
// Source: Dahl 1968; eq. (4)-(6) of the hysteretic inerter paper.
// Free play before it: friction_play.c.
// Not modelled: breakaway above f_c, Stribeck effect (see lugre.c).

#include "friction_block.h"

// ratio of the bristle force to what it can bear, along the direction of motion: u above
static double slack(const InerterDevice* p, double level, double v, double z) {
  return 1 - p->bristle_stiffness * z * sign(v) / level;
}

static double yield_level(const InerterDevice* p, double x, double v, double load) {
  return friction_level(p, x, v) * p->coulomb_force + load;
}

static double rate(const InerterDevice* p, double x, double v, double z, double load) {
  double level = yield_level(p, x, v, load);
  double u = slack(p, level, v, z);
  return p->dahl_exponent == 1 ? v * u : v * sign(u) * pow(fabs(u), p->dahl_exponent);
}

// for m = 1: share of the way to the steady state that a path is, over how much bends the bristle
// in full; the steady state
static INLINED double gone_along(double path) {
  return -elementary_expm1(-path);
}
static INLINED double bent_in_the_end(const InerterDevice* p, double v, double level) {
  return sign(v) * level / p->bristle_stiffness;
}

// At constant v, u' = -(sigma0 |v| / f_c) sgn(u) |u|^m has a closed form for every m.
static double step(const InerterDevice* p, double x, double v, double z, double h, double load) {
  double level = yield_level(p, x, v, load);
  if (v == 0) {
    return z;
  }
  double path = p->bristle_stiffness * fabs(v) * h / level;
  double m = p->dahl_exponent;
  if (m == 1) {
    return z + gone_along(path) * (bent_in_the_end(p, v, level) - z);
  }
  double u = slack(p, level, v, z);
  double change;  // u(h) / u - 1, kept exact for short paths and for m near 1
  if (u == 0) {
    change = 0;
  } else {
    double growth = (m - 1) * path * pow(fabs(u), m - 1);
    change = growth > -1 ? expm1(log1p(growth) / (1 - m)) : -1;
  }
  return z - change * u * sign(v) * level / p->bristle_stiffness;
}

// u' as above, from u > 1 until u = 1
static double straight(const InerterDevice* p, double x, double v, double z, double load) {
  double level = yield_level(p, x, v, load);
  double path = log1p(p->bristle_stiffness * fabs(z) / level), m = p->dahl_exponent;
  if (m != 1) {
    path = expm1((1 - m) * path) / (1 - m);
  }
  return path * level / (p->bristle_stiffness * fabs(v));
}

static double force(const InerterDevice* p, double x, double v, double z, double load) {
  (void)load;
  (void)x;
  (void)v;
  return p->bristle_stiffness * z;
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
  if (p->dahl_exponent != 1) {
    friction_along(p, path, z, forces, step, force);
    return;
  }
  FrictionSamples to;
  double level[FRICTION_BLOCK], share[FRICTION_BLOCK] = {0}, end[FRICTION_BLOCK] = {0};
  samples_between(p, path, &to);
  levels_at(p, &to, level);
  for (int i = 0; i < to.size; i++) {
    double yield = level[i] * p->coulomb_force;
    share[i] = gone_along(p->bristle_stiffness * fabs(to.v[i]) * path->h / yield);
    end[i] = bent_in_the_end(p, to.v[i], yield);
  }
  double state[FRICTION_BLOCK] = {0};
  bristle_along(p, path, share, end, z, state, step);
  for (int i = 0; i < to.size; i++) {
    forces[i] = p->bristle_stiffness * state[i];
  }
}

const FrictionLaw inerter_dahl = {
    .rate = rate,
    .step = step,
    .straight = straight,
    .force = force,
    .energy = energy,
    .stiffness = stiffness,
    .along = along,
};
