// Steps of a linear series element (series.c) along a motion (a quintic), exact while contact
// stays.
//
//   in contact:  b s'' + (c_s + c_w) s' + k_s (s - gap) = b a(t) + c_w v(t),  w = v - s'
//   loose:       w' = -c_w w / b,  d' = -k_s d / c_s,  s' = v - w
//
// In contact see oscillator.c. With backlash a step is only taken where the force keeps its sign,
// or the play is not used up, in its middle and at its end; others are left to series_step.c.
//
// b, k_s > 0, c_s, c_w, s, d, gap, w: as in series.c.
// Source: linear oscillator.
// Not modelled: inertance that varies, pipe, gas, hardening.

#include "laws.h"

enum { S, W, GAP };  // places in z

static double contact_force(const InerterDevice* p, double v, const double* z) {
  return p->series_stiffness * (z[S] - z[GAP]) + p->series_damping * (v - z[W]);
}

// whether a linear flywheel hangs on a linear spring
static int is_linear(const InerterDevice* p) {
  return p->series_stiffness > 0 && p->series_hardening == 0 && !has(p, PART_VARYING) &&
         !has(p, PART_PIPE) && !has(p, PART_GAS);
}

void series_exact_steps(const InerterDevice* p, double h, SeriesExact* steps) {
  steps->holds = is_linear(p) && h >= 0 && !has(p, PART_WHEEL_FRICTION) &&
                 series_parts(p, p->series_stiffness, p->inertance, h) < series_most_parts(p);
  if (steps->holds) {
    steps->h = h;
    steps->has_swings = steps->has_slides = 0;
    steps->oscillator = (Oscillator){.mass = p->inertance,
                                     .damping = p->series_damping + p->flywheel_viscous,
                                     .stiffness = p->series_stiffness,
                                     .lost = p->flywheel_viscous};
  }
}

// s and w after a swing in contact at a play's position
static void contact(const SeriesExact* steps, const Swing* swing, const Way* way, double gap,
                    double* z) {
  z[S] -= gap;
  oscillator_swung(&steps->oscillator, swing, way, z);
  z[S] += gap;
}

// s, w and gap after a slide in the play
static Slide slide_over(const InerterDevice* p, double t) {
  double rate = p->flywheel_viscous / p->inertance;
  return (Slide){t, rate * t > 1e-8 ? -expm1(-rate * t) / rate : t,
                 p->series_damping > 0 ? exp(-p->series_stiffness * t / p->series_damping) : 0};
}
static void loose(const InerterDevice* p, const Slide* slide, const Way* way, double* z) {
  double rate = p->flywheel_viscous / p->inertance, w = z[W];
  double d = p->series_damping > 0 ? (z[S] - z[GAP]) * slide->fade : 0;
  z[S] += way_travel(way, slide->time) - w * slide->run;
  z[W] = w - rate * w * slide->run;
  z[GAP] = z[S] - d;
}

static void find_swings(SeriesExact* steps, int backlash) {
  if (!steps->has_swings) {
    steps->has_swings = 1;
    steps->swing = oscillator_swing(&steps->oscillator, steps->h);
    steps->half_swing =
        backlash ? oscillator_swing(&steps->oscillator, 0.5 * steps->h) : steps->swing;
  }
}
static void find_slides(const InerterDevice* p, SeriesExact* steps) {
  if (!steps->has_slides) {
    steps->has_slides = 1;
    steps->slide = slide_over(p, steps->h);
    steps->half_slide = slide_over(p, 0.5 * steps->h);
  }
}

int series_exact(const InerterDevice* p, SeriesExact* steps, const Way* way, double* z) {
  if (!steps->holds) {
    return 0;
  }
  if (!has(p, PART_BACKLASH)) {
    find_swings(steps, 0);
    contact(steps, &steps->swing, way, 0, z);
    return 1;
  }
  double gap = series_gap(p, z), end[3] = {z[S], z[W], gap}, middle[3] = {z[S], z[W], gap};
  int side = (gap >= p->backlash) - (gap <= -p->backlash);
  double v = way->v, midway = way_speed(way, 0.5 * steps->h), last = way_speed(way, steps->h);
  if (side == 0) {
    find_slides(p, steps);
    loose(p, &steps->half_slide, way, middle);
    loose(p, &steps->slide, way, end);
    if (fabs(middle[GAP]) >= p->backlash || fabs(end[GAP]) >= p->backlash) {
      return 0;
    }
  } else {
    find_swings(steps, 1);
    contact(steps, &steps->half_swing, way, gap, middle);
    contact(steps, &steps->swing, way, gap, end);
    if (!(side * contact_force(p, v, (double[]){z[S], z[W], gap}) > 0 &&
          side * contact_force(p, midway, middle) > 0 && side * contact_force(p, last, end) > 0)) {
      return 0;
    }
  }
  z[S] = end[S];
  z[W] = end[W];
  z[GAP] = end[GAP];
  return 1;
}
