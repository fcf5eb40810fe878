// What a friction law gives to the device. One law, one file; the table in description.c lists
// them.

#ifndef INERTER_CORE_FRICTION_H_
#define INERTER_CORE_FRICTION_H_

#include <math.h>
#include <stddef.h>

#include "device.h"
#include "elementary.h"

// samples that a law takes at once at most, few enough to stay in the cache
enum { FRICTION_BLOCK = 256 };

// Samples [first, last) of a motion, FRICTION_BLOCK at most, h seconds apart. states, if not NULL,
// takes the law's state at each of them, `apart` numbers from one to the next.
typedef struct FrictionPath_ {
  int first, last, apart;
  double h;
  const double* x;
  const double* v;
  double* states;
} FrictionPath;

// bit of InerterDevice.parts: the level has a curve or periods (curve.c)
enum { PART_FRICTION_CURVE = 1 << 16 };

// curve.c: factor on the level in the mean of both directions, at a displacement where the
// polynomial rises it by `rise`; lean: so that it is that times 1 + lean sign(v)
// friction_curve_levels: the same at n samples, FRICTION_BLOCK at most.
double friction_curve_level(const InerterDevice* p, double x, double rise, double* lean);
void friction_curve_levels(const InerterDevice* p, int n, const double* x, double* level,
                           double* lean);

// A friction law as functions of the device's parameters p, displacement x, velocity v, state z.
// load [N]: by how much the force through the gear raises the level of a law with a bristle
// (load_friction.c); the others ignore it.
// straight: time until a state that v straightens is 0; asked for where z v < 0 only.
// stiffness: the largest slope of force over displacement while it sticks, for choosing a step.
// force_of_rate: the force where the rate of the state is known already; NULL where it is no help.
// along: force and state at samples of a motion, see `friction_along` and friction_block.h.
// over_step: step and force in one, z + share (step - z) in the force, and how the force rises with
// v; NULL where a small difference of the two says that.
// level: the force of a law with a sharp sign is level(p, x, v) tanh(v / width(p)); the level is
// even in v but for the asymmetry, which it leaves out. NULL where the law is smooth.
// width [m/s]: of the sign in a law without states, smooth or not: mu |N| tanh(v / width) is what a
// load adds (load_friction.c). width_parameter: which parameter it follows, for messages; NULL:
// transition_velocity. Laws without states leave all but force, along, level, width and its
// parameter NULL, those with one these but force and along.
// several: the same of a law with several states, whose functions take all of them; then rate,
// step, straight, force and energy are NULL. heat: of a step along a path [m] from states z, where
// the displacement is x and the load that of the start, to those of its end [J].
typedef struct FrictionStates_ {
  void (*rate)(const InerterDevice* p, double x, double v, const double* z, double load,
               double* rate);
  void (*step)(const InerterDevice* p, double x, double v, double* z, double h, double load);
  double (*force)(const InerterDevice* p, const double* z);
  double (*energy)(const InerterDevice* p, const double* z);
  double (*stored_power)(const InerterDevice* p, const double* z, const double* rate);
  double (*heat)(const InerterDevice* p, double x, double path, const double* z, const double* end,
                 double load);
  void (*of_force)(const InerterDevice* p, double x, double v, double force, double load,
                   double* z);
} FrictionStates;

typedef struct FrictionLaw_ {
  double (*rate)(const InerterDevice* p, double x, double v, double z, double load);
  double (*step)(const InerterDevice* p, double x, double v, double z, double h, double load);
  double (*straight)(const InerterDevice* p, double x, double v, double z, double load);
  double (*force)(const InerterDevice* p, double x, double v, double z, double load);
  double (*energy)(const InerterDevice* p, double x, double z);
  double (*stiffness)(const InerterDevice* p);
  void (*along)(const InerterDevice* p, const FrictionPath* path, double* z, double* forces);
  double (*force_of_rate)(const InerterDevice* p, double z, double rate);
  double (*level)(const InerterDevice* p, double x, double v);
  double (*width)(const InerterDevice* p);
  const char* width_parameter;
  double (*over_step)(const InerterDevice* p, double x, double v, double z, double h, double share,
                      double* slope);
  const FrictionStates* several;
} FrictionLaw;

#define X(identifier, nstate, meaning) extern const FrictionLaw inerter_##identifier;
INERTER_FRICTION_LAWS(X)
#undef X

// maxwell_slip.c: how many elements there are; sum of their slip forces [N]; stiffness and slip
// force of one, side by side
int slip_count(const InerterDevice* p);
double slip_level(const InerterDevice* p);
static inline const double* slip_element(const InerterDevice* p, int i) {
  return (const double*)p + offsetof(InerterDevice, slip_stiffness_1) / sizeof(double) + 2 * i;
}

// bouc_wen.c: force at which it yields [N], for beta + gamma > 0
double bouc_wen_level(const InerterDevice* p);

// rate_state.c: what speed and age make of the level
double rate_state_factor(const InerterDevice* p, double v, double z);

// by InerterFriction; nothing to call for "none"
extern const FrictionLaw* const inerter_friction_law[];

// friction_play.c: a law with a bristle behind its free play, s its state. play_force_over_step:
// over a step of h seconds to the state `end`, with the spring's implicit share.
double play_deflection(const InerterDevice* p, double s);
double play_rate(const InerterDevice* p, double x, double v, double s, double load);
double play_step(const InerterDevice* p, double x, double v, double s, double h, double load);
double play_force(const InerterDevice* p, double x, double v, double s, double load);
double play_force_over_step(const InerterDevice* p, double x, double v, double s, double end,
                            double share, double h);

// direction of sliding, smooth over the transition velocity
static INLINED double friction_direction(const InerterDevice* p, double v) {
  return elementary_tanh(v / p->transition_velocity);
}

// Factor on both friction levels: it differs between the directions and along the stroke.
//   (1 + asymmetry sign(v)) max(0.001, 1 + gradient x + curvature x^2 + curve(x))
// with a curve for v > 0 and another for v < 0, where they differ (then without asymmetry).
// The floor keeps bristles from facing a yield level of zero.
static inline double friction_levels(const InerterDevice* p, double x, double* lean) {
  *lean = p->friction_asymmetry;
  double rise = (p->friction_gradient + p->friction_curvature * x) * x;
  if (p->parts & PART_FRICTION_CURVE) {
    return friction_curve_level(p, x, rise, lean);
  }
  return p->friction_gradient == 0 && p->friction_curvature == 0 ? 1 : larger(1e-3, 1 + rise);
}
static inline int friction_level_is_one(const InerterDevice* p) {
  return !(p->parts & PART_FRICTION_CURVE) && p->friction_gradient == 0 &&
         p->friction_curvature == 0 && p->friction_asymmetry == 0;
}
static inline double friction_along_stroke(const InerterDevice* p, double x) {
  double lean;
  return friction_levels(p, x, &lean);
}
static inline double friction_level(const InerterDevice* p, double x, double v) {
  double lean, level = friction_levels(p, x, &lean);
  if (lean != 0) {
    level *= 1 + lean * friction_direction(p, v);
  }
  return level;
}

// Stribeck curve without direction: f_c + (f_s - f_c) exp(-(|v| / v_s)^exponent)
static INLINED double friction_stribeck_curve(const InerterDevice* p, double v) {
  double excess = p->static_force - p->coulomb_force;
  if (excess == 0) {
    return p->coulomb_force;
  }
  double ratio = fabs(v) / p->stribeck_velocity;
  double power = p->stribeck_exponent == 2 ? ratio * ratio : pow(ratio, p->stribeck_exponent);
  return p->coulomb_force + excess * elementary_exp(-power);
}

static INLINED double sign(double v) {
  return v > 0 ? 1.0 : v < 0 ? -1.0 : 0.0;
}

// A leg of the way from one sample to the next, gone at its mean velocity.
typedef struct Leg_ {
  double x0, x1;  // displacement where it begins and ends
  double time;
} Leg;

// The legs between two samples h apart, by their displacements x and velocities v: one, which keeps
// the path of a law, or two where the motion turns between them. How many.
static inline int legs_between(const double* x, const double* v, double h, Leg legs[2]) {
  // a turn nearer to a sample than this share of h is at the sample
  const double nearly = 1e-6;
  legs[0] = (Leg){x[0], x[1], h};
  if (!(v[0] * v[1] < 0)) {
    return 1;
  }
  double share = v[0] / (v[0] - v[1]), place = x[0] + 0.5 * v[0] * share * h;
  if (!(share > nearly && share < 1 - nearly && (x[1] - place) * v[1] > 0)) {
    return 1;
  }
  legs[0] = (Leg){x[0], place, share * h};
  legs[1] = (Leg){place, x[1], h - share * h};
  return 2;
}
static inline double mean_velocity(const Leg* leg) {
  return (leg->x1 - leg->x0) / leg->time;
}
static inline double middle_of(const Leg* leg) {
  return 0.5 * (leg->x0 + leg->x1);
}

typedef double StateStep(const InerterDevice* p, double x, double v, double z, double h,
                         double load);

// A state from one sample to the next, without load.
static INLINED double step_to_next(const InerterDevice* p, const double* x, const double* v,
                                   double h, double z, StateStep* step) {
  Leg legs[2];
  int count = legs_between(x, v, h, legs);
  for (int i = 0; i < count; i++) {
    const Leg* leg = legs + i;
    z = step(p, middle_of(leg) - p->rest_length, mean_velocity(leg), z, leg->time, 0);
  }
  return z;
}

// Forces at the samples of a path, the state z stepped from each to the next. The law's step and
// force are compiled into the loop, without load; without a state step is NULL. A law whose samples
// can be taken several at once does so by friction_block.h.
static inline void friction_along(const InerterDevice* restrict p, const FrictionPath* path,
                                  double* restrict z, double* restrict forces, StateStep* step,
                                  double (*force)(const InerterDevice* p, double x, double v,
                                                  double z, double load)) {
  const double *x = path->x, *v = path->v;
  double h = path->h, rest = p->rest_length, now = step ? *z : 0;
  for (int i = path->first; i < path->last; i++) {
    if (step && i) {
      now = step_to_next(p, x + i - 1, v + i - 1, h, now, step);
    }
    forces[i - path->first] = force(p, x[i] - rest, v[i], now, 0);
    if (step && path->states) {
      path->states[(size_t)i * (size_t)path->apart] = now;
    }
  }
  if (step) {
    *z = now;
  }
}

#endif  // INERTER_CORE_FRICTION_H_
