// Stribeck friction: the level falls from breakaway to sliding as the speed grows.
//
//   F = [f_c + (f_s - f_c) exp(-(|v| / v_s)^delta)] sign(v),  sign(v) = tanh(v / v_t)
//
// f_c, f_s [N] coulomb_force, static_force (times the level of friction.h); v_s [m/s]
// stribeck_velocity; delta stribeck_exponent; v_t [m/s] transition_velocity, to be well below v_s.
// Source: the static characteristic of Canudas de Wit et al. 1995.
// Not modelled: memory before sliding and frictional lag (see lugre.c).

#include "friction_block.h"

static double force(const InerterDevice* p, double x, double v, double z, double load) {
  (void)z;
  (void)load;
  return friction_level(p, x, v) * friction_stribeck_curve(p, v) * friction_direction(p, v);
}

static double level(const InerterDevice* p, double x, double v) {
  return friction_along_stroke(p, x) * friction_stribeck_curve(p, v);
}

static double width(const InerterDevice* p) {
  return p->transition_velocity;
}

static SEVERAL_AT_ONCE void along(const InerterDevice* p, const FrictionPath* path, double* z,
                                  double* forces) {
  FrictionSamples at;
  double levels[FRICTION_BLOCK], curve[FRICTION_BLOCK];
  (void)z;
  samples_at(p, path, &at);
  levels_at(p, &at, levels);
  stribeck_curves_at(p, &at, curve);
  for (int i = 0; i < at.size; i++) {
    forces[i] = levels[i] * curve[i] * friction_direction(p, at.v[i]);
  }
}

const FrictionLaw inerter_stribeck = {
    .force = force, .along = along, .level = level, .width = width};
