// Steps of a series element (series.c) whose coefficients vary, exact for those of the middle.
//
//   B w' + R + G = phi + c_s s',   w = v - s'
//   B_m s'' + (c_s + D_m) s' + phi'_m s = B_m a + D_m v + e + e' t
//   e + e' t:  R + G_gas + (B - B_m) w' through the start and the middle, and what the tangents of
//              the spring and of the dampers leave there
//
// A half step with the coefficients of the start leads to the middle. B, R, G, phi, c_s, s, w: as
// in series.c; D: slope of the flywheel's dampers; m: in the middle. Why: a step need not resolve
// the oscillation, only how much its coefficients change. Order: 2. Source: exponential Rosenbrock
// methods (Hochbruck, Ostermann 2010), the middle in place of the start. Not modelled: backlash.

#include "laws.h"

enum { S, W };  // places in z

// what the coefficients are at one state
typedef struct Coefficients_ {
  double mass, damper_slope, spring_slope;
  double varying;  // R + gas
  double fixed;    // what the tangents of dampers and spring leave
  double rate;     // w'
} Coefficients;

static Coefficients coefficients(const InerterDevice* p, double x, double v, const double* z) {
  double rest, mass = inertance_felt(p, x - z[S], z[W], &rest);
  Tangent damper = flywheel_damper(p, z[W]), spring = series_spring(p, z[S]);
  double varying = rest + (has(p, PART_GAS) ? gas_force(p, x - z[S]) : 0);
  double force = spring.value + p->series_damping * (v - z[W]);
  return (Coefficients){
      .mass = mass,
      .damper_slope = damper.slope,
      .spring_slope = spring.slope,
      .varying = varying,
      .fixed = damper.value - damper.slope * z[W] - (spring.value - spring.slope * z[S]),
      .rate = (force - damper.value - varying) / mass,
  };
}

static Oscillator oscillator(const InerterDevice* p, const Coefficients* c) {
  return (Oscillator){.mass = c->mass,
                      .damping = p->series_damping + c->damper_slope,
                      .stiffness = c->spring_slope,
                      .lost = c->damper_slope,
                      .push = c->varying + c->fixed};
}

// how much the coefficients change over a step, relative
static double change(const InerterDevice* p, const Coefficients* start, const Coefficients* middle,
                     double step, double h) {
  double masses = fabs(middle->mass - start->mass) / middle->mass;
  double springs = fabs(middle->spring_slope - start->spring_slope) / middle->spring_slope;
  double dampers = fabs(middle->damper_slope - start->damper_slope) * h / middle->mass;
  double gas = 0;
  if (has(p, PART_GAS) && step != 0) {
    gas = fabs((middle->varying - start->varying) / step) * h * h / middle->mass;
  }
  return 2 * (masses + springs + dampers) + gas;
}

// one step; how much the coefficients changed, infinite where there is no oscillation
static double frozen(const InerterDevice* p, double x, double v, double a, double jerk, double h,
                     double* z) {
  double half = 0.5 * h, middle[2] = {z[S], z[W]};
  Coefficients start = coefficients(p, x, v, z);
  if (!(start.spring_slope > 0)) {
    return INFINITY;
  }
  Oscillator o = oscillator(p, &start);
  oscillator_step(&o, v, a, jerk, half, middle);

  double midway = x + (v + (0.5 * a + jerk * half / 6) * half) * half;
  Coefficients there = coefficients(p, midway, v + (a + 0.5 * jerk * half) * half, middle);
  if (!(there.spring_slope > 0)) {
    return INFINITY;
  }
  double before = start.varying + (start.mass - there.mass) * start.rate;
  o = oscillator(p, &there);
  o.drift = (there.varying - before) / half;
  o.push -= o.drift * half;
  double step = midway - middle[S] - (x - z[S]);
  oscillator_step(&o, v, a, jerk, h, z);
  return change(p, &start, &there, step, h);
}

// parts in which the coefficients change by a sixteenth
enum { PER_CHANGE = 16 };

int series_frozen(const InerterDevice* p, double x, double v, double a, double jerk, double* z,
                  double h, int most) {
  if (has(p, PART_BACKLASH) || h < 0) {
    return 0;
  }
  double next[2] = {z[S], z[W]};
  double parts = PER_CHANGE * frozen(p, x, v, a, jerk, h, next);
  if (!(parts < most)) {
    return 0;
  }
  int count = 1 + (int)parts;
  if (count > 1) {
    double part = h / count;
    next[S] = z[S];
    next[W] = z[W];
    for (int i = 0; i < count; i++) {
      double t = part * i, here = x + (v + (0.5 * a + jerk * t / 6) * t) * t;
      if (isinf(frozen(p, here, v + (a + 0.5 * jerk * t) * t, a + jerk * t, jerk, part, next))) {
        return 0;
      }
    }
  }
  z[S] = next[S];
  z[W] = next[W];
  return 1;
}
