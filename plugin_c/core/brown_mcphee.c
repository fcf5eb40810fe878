// Brown-McPhee friction: a smooth Stribeck curve without states.
//
//   F = [f_d tanh(4 |v| / v_s) + (f_s - f_d) (|v| / v_s) / ((v / v_s)^2 / 4 + 3/4)^2] sgn(v)
//
// f_d [N] coulomb_force, f_s [N] static_force (times the level of friction.h), v_s [m/s]
// stribeck_velocity: the curve peaks near f_s at v_s. Its viscous part is the device's viscous.
// Source: Brown & McPhee 2016; fluid inerter experiment.
// Not modelled: stiction and memory; below v_s the law is a damper.

#include "friction_block.h"

// force without its level
static INLINED double shaped(const InerterDevice* p, double v) {
  double ratio = v / p->stribeck_velocity;
  double shape = 0.25 * ratio * ratio + 0.75;
  double sliding = p->coulomb_force * elementary_tanh(4 * ratio);
  double peak = (p->static_force - p->coulomb_force) * ratio / (shape * shape);
  return sliding + peak;
}

static double force(const InerterDevice* p, double x, double v, double z, double load) {
  (void)z;
  (void)load;
  return friction_level(p, x, v) * shaped(p, v);
}

static double width(const InerterDevice* p) {
  return 0.25 * p->stribeck_velocity;
}

static SEVERAL_AT_ONCE void along(const InerterDevice* p, const FrictionPath* path, double* z,
                                  double* forces) {
  (void)z;
  memoryless_along(p, path, forces, shaped);
}

const FrictionLaw inerter_brown_mcphee = {
    .force = force, .along = along, .width = width, .width_parameter = "stribeck_velocity"};
