// What the laws beside friction give to the device. One law, one file; friction is in friction.h.

#ifndef INERTER_CORE_LAWS_H_
#define INERTER_CORE_LAWS_H_

#include <stddef.h>

#include "device.h"
#include "friction.h"

// which parts a device has (InerterDevice.parts)
enum {
  PART_VARYING = 1 << 0,   // the inertance varies along the stroke or with speed
  PART_FLYWHEEL = 1 << 1,  // damping or gas at the flywheel: G
  PART_PIPE = 1 << 2,      // loss of the fluid in its channel
  PART_GAS = 1 << 3,
  PART_SERIES = 1 << 4,
  PART_BACKLASH = 1 << 5,
  PART_STOPS = 1 << 6,
  PART_WHEEL_FRICTION = 1 << 7,  // friction at the flywheel behind a series element
  PART_BRANCHES = 1 << 8,
  PART_DAMPER = 1 << 9,  // damping that bends, differs by direction, or is behind a spring
  PART_DAMPER_SPRING = 1 << 10,
  PART_CLUTCH = 1 << 11,  // a series element that slips

  // along the stroke (curve.c); that of friction is in friction.h
  PART_FRICTION_BACK = 1 << 17,
  PART_INERTANCE_CURVE = 1 << 18,
  PART_INERTANCE_BACK = 1 << 19,
  PART_FORCE_CURVE = 1 << 20,
  PART_VISCOUS_CURVE = 1 << 21,
  PART_FORCE_MAP = 1 << 22
};

static inline int has(const InerterDevice* p, unsigned part) {
  return (p->parts & part) != 0;
}

// displacement that the laws see
static inline double stretch_of(const InerterDevice* p, double length) {
  return length - p->rest_length;
}

static inline const FrictionLaw* law_of(const InerterDevice* p) {
  return inerter_friction_law[p->friction];
}

// friction laws with a state, a bit each
enum {
#define X(identifier, nstate, meaning) | ((nstate) > 0) << INERTER_FRICTION_##identifier
  LAWS_WITH_BRISTLE = 0 INERTER_FRICTION_LAWS(X)
#undef X
};

// whether the friction law has a state, z[0]
static inline int has_bristle(const InerterDevice* p) {
  return LAWS_WITH_BRISTLE >> p->friction & 1;
}

// a law with a bristle, with or without free play before it: deflection of the bristle, rate, step
// and force at its state s
static inline double bristle_deflection(const InerterDevice* p, double s) {
  return p->friction_backlash == 0 ? s : play_deflection(p, s);
}
static inline double bristle_rate(const InerterDevice* p, double x, double v, double s,
                                  double load) {
  return p->friction_backlash == 0 ? law_of(p)->rate(p, x, v, s, load)
                                   : play_rate(p, x, v, s, load);
}
static inline double bristle_step(const InerterDevice* p, double x, double v, double s, double h,
                                  double load) {
  return p->friction_backlash == 0 ? law_of(p)->step(p, x, v, s, h, load)
                                   : play_step(p, x, v, s, h, load);
}
static inline double bristle_force(const InerterDevice* p, double x, double v, double s,
                                   double load) {
  return p->friction_backlash == 0 ? law_of(p)->force(p, x, v, s, load)
                                   : play_force(p, x, v, s, load);
}

// a friction law with states, one or several: rates, states after a time, force, stored energy and
// its rate
static inline void friction_rates(const InerterDevice* p, double x, double v, const double* z,
                                  double load, double* rate) {
  const FrictionStates* several = law_of(p)->several;
  if (several) {
    several->rate(p, x, v, z, load, rate);
  } else {
    rate[0] = bristle_rate(p, x, v, z[0], load);
  }
}
static inline void friction_step(const InerterDevice* p, double x, double v, double* z, double h,
                                 double load) {
  const FrictionStates* several = law_of(p)->several;
  if (several) {
    several->step(p, x, v, z, h, load);
  } else {
    z[0] = bristle_step(p, x, v, z[0], h, load);
  }
}
static inline double friction_force(const InerterDevice* p, double x, double v, const double* z,
                                    double load) {
  const FrictionStates* several = law_of(p)->several;
  return several ? several->force(p, z) : bristle_force(p, x, v, z[0], load);
}
static inline double friction_energy(const InerterDevice* p, double x, const double* z) {
  const FrictionStates* several = law_of(p)->several;
  return several ? several->energy(p, z) : law_of(p)->energy(p, x, bristle_deflection(p, z[0]));
}

// place of the series element's first state, after those of friction
static inline int series_index(const InerterDevice* p) {
  return p->nfriction;
}

// a quantity and its derivative
typedef struct Tangent_ {
  double value;
  double slope;
} Tangent;

// a motion from a time on: its velocity then, and the rates of that
typedef struct Way_ {
  double v, a, jerk, snap, crackle;
} Way;

// the quintic through displacement, velocity and acceleration at two samples h seconds apart
static inline Way way_between(const double* x, const double* v, const double* a, double h) {
  double rest = (x[1] - x[0]) / h - v[0] - 0.5 * h * a[0], turn = v[1] - v[0] - h * a[0];
  double bend = 0.5 * h * (a[1] - a[0]), square = h * h;
  return (Way){v[0], a[0], 6 * (10 * rest - 4 * turn + bend) / square,
               24 * (7 * turn - 15 * rest - 2 * bend) / (square * h),
               120 * (6 * rest - 3 * turn + bend) / (square * square)};
}
static inline double way_travel(const Way* w, double t) {
  return t *
         (w->v + t * (w->a / 2 + t * (w->jerk / 6 + t * (w->snap / 24 + t * w->crackle / 120))));
}
static inline double way_speed(const Way* w, double t) {
  return w->v + t * (w->a + t * (w->jerk / 2 + t * (w->snap / 6 + t * w->crackle / 24)));
}
static inline double way_acceleration(const Way* w, double t) {
  return w->a + t * (w->jerk + t * (w->snap / 2 + t * w->crackle / 6));
}
static inline Way way_after(const Way* w, double t) {
  return (Way){way_speed(w, t), way_acceleration(w, t),
               w->jerk + t * (w->snap + t * w->crackle / 2), w->snap + t * w->crackle, w->crackle};
}

static inline double clamp(double value, double lower, double upper) {
  return value < lower ? lower : value > upper ? upper : value;
}

// inertance.c, at displacement y and velocity w of the flywheel: B; R (if not NULL); stored energy
double inertance_felt(const InerterDevice* p, double y, double w, double* rest);
// forces_of_inertance: B w' + R at n samples, FRICTION_BLOCK at most
double inertance_energy(const InerterDevice* p, double y, double w);
void forces_of_inertance(const InerterDevice* p, int n, const double* y, const double* w,
                         const double* acceleration, double* force);
int inertance_valid(const InerterDevice* p, double y, char* message);

// gas_spring.c, at displacement y
double gas_force(const InerterDevice* p, double y);
double gas_energy(const InerterDevice* p, double y);
int gas_valid(const InerterDevice* p, double y, char* message);

// pipe.c: inertance of the fluid; diameter of the channel [m]; force of its losses at velocity w,
// with slope >= 0
double pipe_inertance(const InerterDevice* p);
double pipe_diameter(const InerterDevice* p);
Tangent pipe_force(const InerterDevice* p, double w);

// end_stop.c, at displacement x, velocity v
double stop_force(const InerterDevice* p, double x, double v);
double stop_energy(const InerterDevice* p, double x);
double stop_heat(const InerterDevice* p, double x, double v);

// curve.c: curve and periods at x, with the slope; at n samples,
// FRICTION_BLOCK at most; their value alone; their integral
// from 0 to x.
// curve_check: see that those of a device fit, and make the curves; -1 with a message if not.
// curve_coefficients: n + 2 of the spline through n values, level at both ends.
Tangent curve_at(const InerterCurve* c, double x);
void curve_at_samples(const InerterCurve* c, int n, const double* x, double* value, double* slope);
double curve_value(const InerterCurve* c, double x);
double curve_integral(const InerterCurve* c, double x);
int curve_check(InerterDevice* device, char* message);
void curve_coefficients(int n, const double* value, double* fit);
uint32_t curve_parts(const InerterDevice* device);

// force_map.c, at displacement x, velocity v: force with its slope over v, energy, heat.
// map_check: as curve_check.
Tangent map_force(const InerterDevice* p, double x, double v);
double map_energy(const InerterDevice* p, double x);
double map_heat(const InerterDevice* p, double x, double v);
int map_check(InerterDevice* device, char* message);

// k x + k3 x^3
static INLINED double cubic_spring(const InerterDevice* device, double stretch) {
  return (device->stiffness + device->stiffness_cubic * stretch * stretch) * stretch;
}

// c v + c2 |v| v
static INLINED double quadratic_damper(const InerterDevice* device, double viscous, double v) {
  return (viscous + device->quadratic_damping * fabs(v)) * v;
}

// k x + k3 x^3 + f(x), at displacement `stretch`
static inline double spring_force(const InerterDevice* device, double stretch) {
  double spring = cubic_spring(device, stretch);
  return has(device, PART_FORCE_CURVE)
             ? spring + curve_value(&device->curve[INERTER_STROKE_force], stretch)
             : spring;
}

// c(x)
static inline double damping_at(const InerterDevice* device, double stretch) {
  return has(device, PART_VISCOUS_CURVE)
             ? device->viscous + curve_value(&device->curve[INERTER_STROKE_viscous], stretch)
             : device->viscous;
}

// damper.c: force at a velocity, with c(x), and its slope; the force without what an engine takes
// care of; that at the end v1 of a step from v
double damper_law(const InerterDevice* p, double viscous, double v);
double damper_slope(const InerterDevice* p, double viscous, double v);
double damper_shaped(const InerterDevice* p, double viscous, double v);
double damper_over_step(const InerterDevice* p, double viscous, double v, double v1);

// damper_spring.c, w: velocity over dampers behind a spring, a state after those of branches; over
// a step as branches_over_step
double damper_spring_rate(const InerterDevice* p, double v, double w);
void damper_spring_follow(const InerterDevice* p, const Way* way, double* w, double h);
double damper_spring_force(const InerterDevice* p, double w);
double damper_spring_over_step(const InerterDevice* p, double v1, double* w, double h,
                               double mobility);
double damper_spring_energy(const InerterDevice* p, double w);
double damper_spring_heat(const InerterDevice* p, double w);

// force of the dampers between the terminals, at displacement `stretch`; of those behind a spring
// nothing but what an engine takes care of
static inline double damper_force(const InerterDevice* device, double stretch, double v) {
  if (has(device, PART_DAMPER_SPRING)) {
    return -device->damping_held * v;
  }
  double viscous = damping_at(device, stretch);
  return has(device, PART_DAMPER) ? damper_shaped(device, viscous, v)
                                  : quadratic_damper(device, viscous, v);
}

// T without friction, at displacement `stretch`
static inline double parallel_force(const InerterDevice* device, double stretch, double v) {
  double spring = spring_force(device, stretch);
  double damper = damper_force(device, stretch, v);
  double stops = has(device, PART_STOPS) ? stop_force(device, stretch, v) : 0;
  double map = has(device, PART_FORCE_MAP) ? map_force(device, stretch, v).value : 0;
  return spring + damper + device->force_offset + stops + map;
}

// flywheel damping with its slope: flywheel_viscous w + pipe(w)
static inline Tangent flywheel_damper(const InerterDevice* p, double w) {
  Tangent damper = {0, 0};
  if (has(p, PART_PIPE)) {
    damper = pipe_force(p, w);
  }
  damper.value += p->flywheel_viscous * w;
  damper.slope += p->flywheel_viscous;
  return damper;
}

// G(y, w)
static inline double flywheel_force(const InerterDevice* p, double y, double w) {
  double gas = has(p, PART_GAS) ? gas_force(p, y) : 0;
  return gas + flywheel_damper(p, w).value;
}

// load_friction.c: by how much a force N through the inertance raises the level of a law with a
// bristle that moves with velocity v [N]
double load_on_bristle(const InerterDevice* p, double v, double carried);

// force of a law with a bristle without its damper
static inline double bristle_spring(const InerterDevice* p, double x, double v, const double* z) {
  if (p->friction == INERTER_FRICTION_lugre) {
    return z ? p->bristle_stiffness * bristle_deflection(p, z[0]) : 0;
  }
  return friction_force(p, x, v, z, 0);
}

// wheel_friction.c: N, of the force F_s that the series element bears and of the friction law's
// force, at velocity w of the flywheel; z: states of the law
double wheel_carried(const InerterDevice* p, double w, const double* z, double force,
                     double friction);

// over_step.c: force of the friction law over a step h at displacement x to velocity v1. v:
// velocity at which the level of friction without memory is taken; z: states of the law, those of
// the end when it returns; share: implicit part of a bristle's spring; load: on its level.
// friction_grip: how the force rises with the velocity at v [N s/m].
double friction_over_step(const InerterDevice* p, double x, double v, double v1, double h,
                          double share, double load, double* z);
double friction_grip(const InerterDevice* p, double x, double v);

// blocks.c: devices whose samples can be taken in blocks, and those along a motion, see
// inerter_along; z: states at the start, then at the end
int fits_blocks(const InerterDevice* p);
void blocks_along(const InerterDevice* p, int n, double h, const double* x, const double* v,
                  const double* a, double* z, double* total, double* friction, double* states);

// branches.c, e: deflections of their springs, the last states; over a step of h seconds to
// velocity v1 with the springs' implicit share
// branch_share: how much of the way to its end a branch goes in h seconds
static inline double branch_share(double time, double h) {
  return -elementary_expm1(-h / time);
}
int branch_count(const InerterDevice* p);
void branches_rate(const InerterDevice* p, double v, const double* e, double* rate);
void branches_step(const InerterDevice* p, double v, double* e, double h);
void branches_follow(const InerterDevice* p, const Way* way, double* e, double h);
double branches_force(const InerterDevice* p, const double* e);
double branches_over_step(const InerterDevice* p, double v1, double* e, double h, double mobility);
double branches_energy(const InerterDevice* p, const double* e);
double branches_heat(const InerterDevice* p, const double* e);
static inline const double* branch_element(const InerterDevice* p, int i) {
  return (const double*)p + offsetof(InerterDevice, branch_stiffness_1) / sizeof(double) + 2 * i;
}
static inline int branch_index(const InerterDevice* p) {
  return p->nstate - p->nbranch - p->ndamper - p->ncontrol;
}

// place of the velocity over the dampers behind a spring
static inline int damper_index(const InerterDevice* p) {
  return branch_index(p) + p->nbranch;
}

// place of the control's state, the last
static inline int control_index(const InerterDevice* p) {
  return p->nstate > 0 ? p->nstate - 1 : 0;
}

// check.c: see that everything but the control fits, and derive what was not set; -1 with a message
int device_check(InerterDevice* device, char* message);

// control.c: see that a control fits the device, whose other parts are not checked yet; the rate of
// its state, and the state after a time h
int control_check(InerterDevice* device, char* message);
double control_rate(const InerterDevice* p, double z);
double control_step(const InerterDevice* p, double z, double h);

// oscillator.c: what decays with a rate after a time, where t^k / k! drives it from 0, k <
// RESPONSES
enum { RESPONSES = 5 };
void decay_driven(double rate, double t, double* driven);

// Least implicit share of a spring in a step: stable always, neutral where h resolves the spring.
static inline double least_share(double stiffness, double mobility, double h) {
  double square = h * h * stiffness * mobility;
  return square > 1 ? 1 - 1 / square : 0;
}

#endif  // INERTER_CORE_LAWS_H_
