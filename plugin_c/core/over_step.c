// Force over a step at whose end the velocity is v1 = v + h a, for implicit time stepping.
//
//   dampers, friction without memory, direction of the load friction: at v1
//   springs and constant force: at x;  end stops: at x + h v1, v1
//   bristle: z1 = step(x, v1, z, h), force at v1 and z + share (z1 - z); behind free play its
//   damper at the mean rate (friction_play.c)
//   rigid inertance: B a + R + G at (x, v), the dampers of G with their slope times (v1 - v)
//   series element: series_step.c
//   share(k, m) = max(0, 1 - 1 / (h^2 k m)), m = mobility [1/kg] of the masses at the spring's ends
//
// Why: an explicit force is unstable where h^2 k m > 4 or h c m > 2, and forces at the end of the
// step make a = a0 - mobility F(a) an equation with one solution, since F does not fall with a.
// The share is the least that is stable: it adds no damping where h resolves the spring.
// End stops are backward in full: they may take energy at an impact, never give it. Where h
// resolves one without damping, a mass m comes back with exp(-pi h sqrt(k_e / m) / 2) of its speed.
// Falls with a where friction falls with speed (Stribeck, asymmetry above 1/2): the solution is
// then unique for h mobility |slope| < 1. Order: 1. For h -> 0 it is inerter_force. Source:
// Newmark's beta method in its semi-implicit form. Not modelled: springs between the terminals
// stiffer than h resolves; those belong to the caller.

#include <string.h>

#include "laws.h"

// force of the friction law; z1: its state at the end
static double friction_over_step(const InerterDevice* device, double x, double v1, const double* z,
                                 double h, double mobility, double* z1) {
  if (device->friction == INERTER_FRICTION_none) {
    return 0;
  }
  const FrictionLaw* law = law_of(device);
  if (!has_bristle(device)) {
    return law->force(device, x, v1, 0);
  }
  *z1 = bristle_step(device, x, v1, z[0], h);
  double share = least_share(law->stiffness(device), mobility, h);
  if (device->friction_backlash > 0) {
    return play_force_over_step(device, x, v1, z[0], *z1, share, h);
  }
  return law->force(device, x, v1, z[0] + share * (*z1 - z[0]));
}

InerterForce inerter_force_over_step(const InerterDevice* device, double x, double v, double a,
                                     const double* z, double h, double mobility, double* end) {
  double next[INERTER_MAXSTATE] = {0};
  double stretch = stretch_of(device, x), v1 = v + h * a;
  if (z && device->nstate) {
    memcpy(next, z, sizeof(double) * (size_t)device->nstate);
  }
  InerterForce force;
  if (h == 0) {
    force = inerter_force(device, x, v, a, z);
  } else {
    double bristle = friction_over_step(device, stretch, v1, z, h, mobility, next);
    if (has(device, PART_SERIES)) {
      double* series = next + series_index(device);
      force.inertance = series_over_step(device, stretch, v1, series, h, mobility);
    } else {
      double rest, inertance = inerter_inertance(device, x, v, &rest);
      double slope = has(device, PART_FLYWHEEL) ? flywheel_damper(device, v).slope : 0;
      force.inertance = (inertance + slope * h) * a + rest;
    }
    double spring = (device->stiffness + device->stiffness_cubic * stretch * stretch) * stretch;
    double damper = (device->viscous + device->quadratic_damping * fabs(v1)) * v1;
    double stops = has(device, PART_STOPS) ? stop_force(device, stretch + h * v1, v1) : 0;
    force.friction = bristle + inerter_load_factor(device, v1) * fabs(force.inertance);
    force.total = force.inertance + spring + damper + device->force_offset + stops + force.friction;
  }
  if (end && device->nstate) {
    memcpy(end, next, sizeof(double) * (size_t)device->nstate);
  }
  return force;
}

int inerter_line_over_step(const InerterDevice* device, double x, double v, double h, double* start,
                           double* rise) {
  if (device->friction != INERTER_FRICTION_none || device->load_friction != 0 ||
      device->quadratic_damping != 0 || device->parts & ~(uint32_t)PART_VARYING) {
    return 0;
  }
  *start = inerter_force_over_step(device, x, v, 0, NULL, h, 0, NULL).total;
  *rise = inerter_inertance(device, x, v, NULL) + h * device->viscous;
  return 1;
}
