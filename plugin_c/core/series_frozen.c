// Steps of a series element (series.c) whose coefficients vary, exact for those of the middle.
//
//   in contact:  B w' + R + G = phi + c_s s',   w = v - s',   d = s - gap
//                B_m d'' + (c_s + D_m) d' + phi'_m d = B_m a + D_m v + e + e' t
//   loose:       B w' + R + G = 0,   d' = -phi / c_s
//   e + e' t:  R + G_gas + (B - B_m) w' through the start and the middle, and what the tangents of
//              the spring, of the dampers and of friction leave there
//
// A half step with the coefficients of the start leads to the middle. B, R, G, phi, c_s, s, w: as
// in series.c, with friction without memory at the flywheel in G; D: slope of the flywheel's
// dampers and of that friction; m: in the middle. Why: a step need not resolve the oscillation,
// only how much its coefficients change. A step in which friction turns is left to series_step.c.
// Order: 2. Source: exponential Rosenbrock methods (Hochbruck, Ostermann 2010), the middle in place
// of the start. Not modelled: backlash, slip.

#include "series.h"

enum { S, W, GAP };  // places in z

// what the coefficients are at one state
typedef struct Coefficients_ {
  double mass, damper_slope, spring_slope;
  double varying;   // R + gas
  double fixed;     // what the tangents of dampers and spring leave
  double force;     // F_s
  double rate;      // w'
  Tangent rubbing;  // friction
} Coefficients;

// friction without memory at the flywheel, at its displacement and velocity
static Tangent rubbing_at(const InerterDevice* p, double y, double w) {
  return has(p, PART_WHEEL_FRICTION)
             ? (Tangent){law_of(p)->force(p, y, w, 0, 0), friction_grip(p, y, w)}
             : (Tangent){0, 0};
}

static Coefficients coefficients(const InerterDevice* p, double x, double v, double gap,
                                 const double* z) {
  double rest, d = z[S] - gap, mass = inertance_felt(p, x - z[S], z[W], &rest);
  Tangent damper = flywheel_damper(p, z[W]), spring = series_spring(p, d);
  Tangent rubbing = rubbing_at(p, x - z[S], z[W]);
  damper.value += rubbing.value;
  damper.slope += rubbing.slope;
  double varying = rest + (has(p, PART_GAS) ? gas_force(p, x - z[S]) : 0);
  double force = spring.value + p->series_damping * (v - z[W]);
  return (Coefficients){
      .mass = mass,
      .damper_slope = damper.slope,
      .spring_slope = spring.slope,
      .varying = varying,
      .fixed = damper.value - damper.slope * z[W] - (spring.value - spring.slope * d),
      .force = force,
      .rate = (force - damper.value - varying) / mass,
      .rubbing = rubbing,
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

// how much friction is off its tangent in the middle, by speed; relative to what it is at most
static double bend(const InerterDevice* p, const Coefficients* start, const Coefficients* middle,
                   double w, double midway, double y1, double w1) {
  if (!has(p, PART_WHEEL_FRICTION)) {
    return 0;
  }
  Tangent near = middle->rubbing;
  double end = law_of(p)->force(p, y1, w1, 0, 0);
  double most = fmax(fabs(near.value), fmax(fabs(start->rubbing.value), fabs(end)));
  double off = fabs(start->rubbing.value - near.value - near.slope * (w - midway)) +
               fabs(end - near.value - near.slope * (w1 - midway));
  return most > 0 ? off / most : 0;
}

// one step in contact at a play's side (0: there is no play); how much the coefficients changed,
// infinite where there is no oscillation or contact is lost
static double frozen(const InerterDevice* p, double x, const Way* way, double h, int side,
                     double* z) {
  double half = 0.5 * h, gap = side * p->backlash, middle[2] = {z[S] - gap, z[W]};
  Coefficients start = coefficients(p, x, way->v, gap, z);
  if (!(start.spring_slope > 0)) {
    return INFINITY;
  }
  Oscillator o = oscillator(p, &start);
  oscillator_step(&o, way, half, middle);
  middle[S] += gap;

  double midway = x + way_travel(way, half);
  Coefficients there = coefficients(p, midway, way_speed(way, half), gap, middle);
  if (!(there.spring_slope > 0)) {
    return INFINITY;
  }
  double before = start.varying + (start.mass - there.mass) * start.rate;
  o = oscillator(p, &there);
  o.drift = (there.varying - before) / half;
  o.push -= o.drift * half;
  double step = midway - middle[S] - (x - z[S]), end[2] = {z[S] - gap, z[W]};
  oscillator_step(&o, way, h, end);
  if (side) {
    double last = series_spring(p, end[S]).value + p->series_damping * (way_speed(way, h) - end[W]);
    if (!(side * start.force > 0 && side * there.force > 0 && side * last > 0)) {
      return INFINITY;
    }
  }
  double y1 = x + way_travel(way, h) - end[S] - gap;
  double bends = bend(p, &start, &there, z[W], middle[W], y1, end[W]);
  z[S] = end[S] + gap;
  z[W] = end[W];
  return change(p, &start, &there, step, h) + bends;
}

// one step within the play, in which only the flywheel's own forces change its velocity; 0 and
// nothing done where the play is used up, or friction turns
static int loose(const InerterDevice* p, double x, const Way* way, double h, double* z) {
  double d = z[S] - z[GAP], half = 0.5 * h, rest;
  double mass = inertance_felt(p, x - z[S], z[W], &rest);
  double first = rubbing_at(p, x - z[S], z[W]).value;
  double w = z[W] - half * (rest + flywheel_force(p, x - z[S], z[W]) + first) / mass;
  double midway = x + way_travel(way, half);
  double s = z[S] + midway - x - half * 0.5 * (z[W] + w);
  mass = inertance_felt(p, midway - s, w, &rest);
  double rubbing = rubbing_at(p, midway - s, w).value;
  double end = z[W] - h * (rest + flywheel_force(p, midway - s, w) + rubbing) / mass;
  double s1 = z[S] + way_travel(way, h) - h * 0.5 * (z[W] + end);
  if (has(p, PART_WHEEL_FRICTION)) {
    double last = rubbing_at(p, x + way_travel(way, h) - s1, end).value;
    if (!friction_is_even(rubbing, first) || !friction_is_even(rubbing, last)) {
      return 0;
    }
  }

  // the spring relaxes with the stiffness of its chord
  double fade = p->series_damping > 0 && d != 0
                    ? exp(-series_spring(p, d).value / d * half / p->series_damping)
                    : 0;
  if (!(fabs(s - d * fade) < p->backlash && fabs(s1 - d * fade * fade) < p->backlash)) {
    return 0;
  }
  z[S] = s1;
  z[W] = end;
  z[GAP] = s1 - d * fade * fade;
  return 1;
}

// parts in which the coefficients change by a sixteenth
enum { PER_CHANGE = 16 };

int series_frozen(const InerterDevice* p, double x, const Way* way, double* z, double h, int most) {
  if (h < 0 || has(p, PART_CLUTCH)) {
    return 0;
  }
  if (has(p, PART_WHEEL_FRICTION) && (has_bristle(p) || inerter_has_load_friction(p))) {
    return 0;
  }
  int side = 0;
  if (has(p, PART_BACKLASH)) {
    double gap = series_gap(p, z);
    side = (gap >= p->backlash) - (gap <= -p->backlash);
    if (side == 0) {
      return loose(p, x, way, h, z);
    }
  }
  double next[2] = {z[S], z[W]};
  double parts = PER_CHANGE * frozen(p, x, way, h, side, next);
  if (!(parts < most)) {
    return 0;
  }
  int count = 1 + (int)parts;
  if (count > 1) {
    double part = h / count;
    next[S] = z[S];
    next[W] = z[W];
    for (int i = 0; i < count; i++) {
      Way rest = way_after(way, part * i);
      if (isinf(frozen(p, x + way_travel(way, part * i), &rest, part, side, next))) {
        return 0;
      }
    }
  }
  z[S] = next[S];
  z[W] = next[W];
  return 1;
}
