// Force over a step at whose end the velocity is v1 = v + h a, for implicit time stepping.
//
//   dampers, direction of friction without memory and of the load friction: at v1
//   level of friction without memory: at v;  springs, constant force, what changes along the
//   stroke: at x
//   end stops: at x + h v1, v1
//   bristle: z1 = step(x, v1, z, h), force at z + share (z1 - z), its damper at the mean rate
//   (z1 - z) / h, however soon within the step the bristle is bent; its load is N over the step
//   dampers behind a spring: w1 by a backward step, force at D(w) + share (D(w1) - D(w))
//   rigid inertance: B a + R + G at (x, v), the dampers of G with their slope times (v1 - v)
//   series element: series_step.c
//   share(k, m) = max(0, 1 - 1 / (h^2 k m)), m = mobility [1/kg] of the masses at the spring's ends
//
// Why: an explicit force is unstable where h^2 k m > 4 or h c m > 2, and forces at the end of the
// step make a = a0 - mobility F(a) an equation with one solution, since F does not fall with a: the
// part of sharp friction that falls with speed (Stribeck, asymmetry above 1/2) is that of
// the start. The share is the least that is stable: it adds no damping where h resolves the spring.
// End stops are backward in full: they may take energy at an impact, never give it. Where h
// resolves one without damping, a mass m comes back with exp(-pi h sqrt(k_e / m) / 2) of its speed.
// Falls with a where the yield level of LuGre or Brown-McPhee friction falls with speed: the
// solution is then unique for h mobility |slope| < 1. Order: 1. For h -> 0 it is inerter_force.
// Source: Newmark's beta method in its semi-implicit form. Not modelled: springs between the
// terminals stiffer than h resolves; those belong to the caller.

#include <string.h>

#include "laws.h"
#include "series.h"

// asymmetry of friction up to which its force does not fall with v1
static const double kMildAsymmetry = 0.5;

enum { STEP_LINE, STEP_FRICTION, STEP_BRISTLE, STEP_LOAD, STEP_GENERAL };  // InerterStep.kind

// friction without memory, with its slope over v1
static Tangent sharp_friction(const InerterStep* step, double v1) {
  const InerterDevice* p = step->device;
  if (!law_of(p)->level) {
    double near = 4e-6 * law_of(p)->width(p), force = law_of(p)->force(p, step->stretch, v1, 0, 0);
    double beside = law_of(p)->force(p, step->stretch, v1 + near, 0, 0);
    return (Tangent){force, fmax(0, (beside - force) / near)};
  }
  double direction = elementary_tanh(v1 / step->width);
  Tangent friction = {step->level * direction,
                      step->level * (1 - direction * direction) / step->width};
  if (step->lean != 0) {
    double side = friction_direction(p, v1), factor = 1 + step->lean * side;
    double turn = step->lean * (1 - side * side) / p->transition_velocity;
    friction.slope = friction.slope * factor + friction.value * turn;
    friction.value *= factor;
  }
  return friction;
}

// what friction without memory is at any v1
static void find_level(InerterStep* step, double stretch) {
  const InerterDevice* p = step->device;
  step->stretch = stretch;
  if (!law_of(p)->level) {
    return;
  }
  step->level = law_of(p)->level(p, stretch, step->v);
  step->width = law_of(p)->width(p);
  friction_levels(p, stretch, &step->lean);
  if (fabs(step->lean) > kMildAsymmetry) {
    step->level *= 1 + step->lean * friction_direction(p, step->v);
    step->lean = 0;
  }
}

// implicit share of a bristle's spring
static double bristle_share(const InerterDevice* device, double h, double mobility) {
  return has_bristle(device) ? least_share(law_of(device)->stiffness(device), mobility, h) : 0;
}

// force of a law with a bristle; z, z1: its state at the start and at the end
static double bristle_over_step(const InerterDevice* device, double x, double v1, double z,
                                double h, double share, double load, double* z1) {
  const FrictionLaw* law = law_of(device);
  *z1 = bristle_step(device, x, v1, z, h, load);
  if (device->friction_backlash > 0) {
    return play_force_over_step(device, x, v1, z, *z1, share, h);
  }
  double middle = z + share * (*z1 - z);
  return law->force_of_rate ? law->force_of_rate(device, middle, (*z1 - z) / h)
                            : law->force(device, x, v1, middle, load);
}

// the same of a law with several states
static double states_over_step(const InerterDevice* device, double x, double v1, double h,
                               double share, double load, double* z) {
  double mean[INERTER_MAXFRICTION];
  memcpy(mean, z, sizeof(double) * (size_t)device->nfriction);
  friction_step(device, x, v1, z, h, load);
  for (int i = 0; i < device->nfriction; i++) {
    mean[i] += share * (z[i] - mean[i]);
  }
  return friction_force(device, x, v1, mean, load);
}

double friction_over_step(const InerterDevice* device, double x, double v, double v1, double h,
                          double share, double load, double* z) {
  if (device->friction == INERTER_FRICTION_none) {
    return 0;
  }
  if (has_bristle(device)) {
    return law_of(device)->several ? states_over_step(device, x, v1, h, share, load, z)
                                   : bristle_over_step(device, x, v1, z[0], h, share, load, z);
  }
  InerterStep step = {.device = device, .v = v};
  find_level(&step, x);
  return sharp_friction(&step, v1).value;
}

double friction_grip(const InerterDevice* device, double x, double v) {
  if (device->friction == INERTER_FRICTION_none) {
    return 0;
  }
  if (device->friction == INERTER_FRICTION_rate_state) {
    double slope;
    law_of(device)->over_step(device, x, v, 0, 0, 0, &slope);
    return slope;
  }
  if (has_bristle(device)) {
    return device->friction == INERTER_FRICTION_lugre ? device->bristle_damping : 0;
  }
  InerterStep step = {.device = device, .v = v};
  find_level(&step, x);
  return sharp_friction(&step, v).slope;
}

// friction at the terminals with its load, or at the flywheel
static double friction_with_load(const InerterDevice* device, double friction, double drag,
                                 double v1, const double* z, double carried) {
  return has(device, PART_WHEEL_FRICTION)
             ? drag
             : friction + inerter_load_factor(device, v1, z, carried) * fabs(carried);
}

InerterForce inerter_force_over_step(const InerterDevice* device, double x, double v, double a,
                                     const double* z, double h, double mobility, double* end) {
  double next[INERTER_MAXSTATE] = {0};
  double stretch = stretch_of(device, x), v1 = v + h * a;
  for (int i = 0; i < device->nstate; i++) {
    next[i] = z ? z[i] : 0;
  }
  InerterForce force;
  if (h == 0) {
    force = inerter_force(device, x, v, a, z);
  } else {
    double friction = 0, drag = 0;
    if (has(device, PART_SERIES)) {
      double* series = next + series_index(device);
      force.inertance =
          series_over_step(device, stretch, v1, next, series, h, mobility, &drag) - drag;
    } else {
      double rest, inertance = inerter_inertance(device, x, v, &rest);
      double slope = has(device, PART_FLYWHEEL) ? flywheel_damper(device, v).slope : 0;
      force.inertance = (inertance + slope * h) * a + rest;
    }
    if (!has(device, PART_WHEEL_FRICTION)) {
      double share = bristle_share(device, h, mobility);
      double load = load_on_bristle(device, v1, force.inertance);
      friction = friction_over_step(device, stretch, v, v1, h, share, load, next);
    }
    double spring = spring_force(device, stretch);
    double damper = has(device, PART_DAMPER) && !has(device, PART_DAMPER_SPRING)
                        ? damper_over_step(device, damping_at(device, stretch), v, v1)
                        : damper_force(device, stretch, v1);
    if (has(device, PART_DAMPER_SPRING)) {
      double* w = next + damper_index(device);
      damper += damper_spring_over_step(device, v1, w, h, mobility);
    }
    double stops = has(device, PART_STOPS) ? stop_force(device, stretch + h * v1, v1) : 0;
    if (has(device, PART_FORCE_MAP)) {
      Tangent map = map_force(device, stretch, v);
      stops += map.value + fmax(0, map.slope) * h * a;
    }
    if (has(device, PART_BRANCHES)) {
      stops += branches_over_step(device, v1, next + branch_index(device), h, mobility);
    }
    if (device->ncontrol) {
      next[control_index(device)] = control_step(device, next[control_index(device)], h);
    }
    force.friction = friction_with_load(device, friction, drag, v1, z, force.inertance);
    force.total = force.inertance + spring + damper + device->force_offset + stops + force.friction;
  }
  if (end && device->nstate) {
    memcpy(end, next, sizeof(double) * (size_t)device->nstate);
  }
  return force;
}

//------------------------------ as a function of the acceleration ---------------------------------

void inerter_step_begin(InerterStep* step, const InerterDevice* device, double x, double v,
                        const double* z, double h, double mobility) {
  *step = (InerterStep){.device = device, .x = x, .v = v, .z = z, .h = h, .mobility = mobility};
  step->kind = STEP_GENERAL;
  if (inerter_has_load_friction(device) || device->quadratic_damping != 0 ||
      has(device, PART_SERIES) || has(device, PART_STOPS) || has(device, PART_BRANCHES) ||
      has(device, PART_DAMPER)) {
    return;
  }

  // a line, or a line and friction
  double rest, inertance = inerter_inertance(device, x, v, &rest), stretch = stretch_of(device, x);
  double slope = has(device, PART_FLYWHEEL) ? flywheel_damper(device, v).slope : 0;
  double viscous = damping_at(device, stretch);
  step->start = rest + spring_force(device, stretch) + viscous * v + device->force_offset;
  step->rise = inertance + h * (slope + viscous);
  if (has(device, PART_FORCE_MAP)) {
    Tangent map = map_force(device, stretch, v);
    step->start += map.value;
    step->rise += h * fmax(0, map.slope);
  }
  step->kind = STEP_LINE;
  if (has_bristle(device)) {
    step->kind = STEP_BRISTLE;
  } else if (device->friction != INERTER_FRICTION_none) {
    step->kind = STEP_FRICTION;
    find_level(step, stretch);
  }
}

void inerter_step_instant(InerterStep* step, const InerterDevice* device, double x, double v,
                          const double* z, double motion) {
  *step = (InerterStep){.device = device, .x = x, .v = v, .z = z};
  step->rise = inerter_inertance(device, x, v, &step->start);
  if (inerter_load_bends(device) && device->bristle_damping > 0) {
    step->kind = STEP_GENERAL;  // a bristle's damper moves with the load
  } else if (inerter_has_load_friction(device) && !inerter_load_bends(device)) {
    step->kind = STEP_LOAD;
    step->motion = motion;
    step->load = inerter_load_factor(device, v, z, 1);
    step->load_negative = inerter_load_factor(device, v, z, -1);
  } else {
    step->kind = STEP_LINE;
    step->start += motion;
  }
}

int inerter_step_is_line(const InerterStep* step) {
  return step->kind == STEP_LINE;
}

// force of a law with states over the step to a velocity v1
static double state_force(const InerterStep* step, double stretch, double v1, double share) {
  const InerterDevice* p = step->device;
  double end[INERTER_MAXFRICTION];
  if (!law_of(p)->several) {
    return bristle_over_step(p, stretch, v1, step->z[0], step->h, share, 0, end);
  }
  memcpy(end, step->z, sizeof(double) * (size_t)p->nfriction);
  return states_over_step(p, stretch, v1, step->h, share, 0, end);
}

// the same, with its slope over v1
static double state_force_with_slope(const InerterStep* step, double v1, double* slope) {
  const InerterDevice* p = step->device;
  double x = stretch_of(p, step->x), h = step->h, share = bristle_share(p, h, step->mobility);
  if (law_of(p)->over_step && p->friction_backlash == 0) {
    return law_of(p)->over_step(p, x, v1, step->z[0], h, share, slope);
  }
  double near = 1e-6 * (h + fabs(v1 - step->v)), force = state_force(step, x, v1, share);
  *slope = (state_force(step, x, v1 + near, share) - force) / near;
  return force;
}

double inerter_step_force(const InerterStep* step, double a, double* slope) {
  double line = step->start + step->rise * a;
  switch (step->kind) {
    case STEP_LINE:
      *slope = step->rise;
      return line;

    case STEP_FRICTION: {
      Tangent friction = sharp_friction(step, step->v + step->h * a);
      *slope = step->rise + step->h * friction.slope;
      return line + friction.value;
    }

    case STEP_BRISTLE: {
      double rise, friction = state_force_with_slope(step, step->v + step->h * a, &rise);
      *slope = step->rise + step->h * fmax(0, rise);
      return line + friction;
    }

    case STEP_LOAD: {
      double load = line < 0 ? step->load_negative : step->load;
      *slope = step->rise * (1 + load * sign(line));
      return line + load * fabs(line) + step->motion;
    }

    default:
      break;
  }

  // a small difference: laws with corners have no better slope
  double near = 1e-6 * (1 + fabs(a));
  const InerterDevice* p = step->device;
  double force =
      inerter_force_over_step(p, step->x, step->v, a, step->z, step->h, step->mobility, NULL).total;
  double beside =
      inerter_force_over_step(p, step->x, step->v, a + near, step->z, step->h, step->mobility, NULL)
          .total;
  *slope = fmax(0, (beside - force) / near);
  return force;
}

double inerter_step_grain(const InerterStep* step) {
  enum { W = 1 };  // the flywheel's velocity among the states of a series element
  if (!(step->h > 0)) {
    return 0;
  }
  int turns = has(step->device, PART_SERIES) && step->z;
  double w = turns ? step->z[series_index(step->device) + W] : 0;
  return (fabs(step->v) + fabs(w)) / step->h;
}
