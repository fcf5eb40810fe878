// Coulomb friction: a constant level against the motion.
//
//   F = f_c sign(v),  sign(v) = tanh(v / v_t)
//
// f_c [N] coulomb_force (times the level of friction.h), v_t [m/s] transition_velocity.
// Why tanh: sign(v) jumps, so that an explicit integrator chatters and no integrator has an order;
// below v_t the law is a damper of f_c / v_t instead. Valid for speeds well above v_t.
// Source: Wang & Su 2008 use f_c sign(v).
// Not modelled: stiction, memory before sliding (see dahl.c, lugre.c). A loaded device creeps at a
// fraction of v_t instead of sticking.

#include "friction_block.h"

// force without its level
static INLINED double shaped(const InerterDevice* p, double v) {
  return p->coulomb_force * friction_direction(p, v);
}

static double force(const InerterDevice* p, double x, double v, double z, double load) {
  (void)z;
  (void)load;
  return friction_level(p, x, v) * shaped(p, v);
}

static double level(const InerterDevice* p, double x, double v) {
  (void)v;
  return friction_along_stroke(p, x) * p->coulomb_force;
}

static double width(const InerterDevice* p) {
  return p->transition_velocity;
}

static SEVERAL_AT_ONCE void along(const InerterDevice* p, const FrictionPath* path, double* z,
                                  double* forces) {
  (void)z;
  memoryless_along(p, path, forces, shaped);
}

const FrictionLaw inerter_coulomb = {
    .force = force, .along = along, .level = level, .width = width};
