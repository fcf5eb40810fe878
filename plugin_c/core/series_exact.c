// Steps of a linear series element (series.c) along a cubic motion, exact while contact stays.
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

// s and w a time t into contact at a play's position
static void contact(const InerterDevice* p, double v, double a, double jerk, double gap, double t,
                    double* z) {
  Oscillator o = {.mass = p->inertance,
                  .damping = p->series_damping + p->flywheel_viscous,
                  .stiffness = p->series_stiffness,
                  .lost = p->flywheel_viscous};
  z[S] -= gap;
  oscillator_step(&o, v, a, jerk, t, z);
  z[S] += gap;
}

static double contact_force(const InerterDevice* p, double v, const double* z) {
  return p->series_stiffness * (z[S] - z[GAP]) + p->series_damping * (v - z[W]);
}

// whether a linear flywheel hangs on a linear spring
static int is_linear(const InerterDevice* p) {
  return p->series_stiffness > 0 && p->series_hardening == 0 && !has(p, PART_VARYING) &&
         !has(p, PART_PIPE) && !has(p, PART_GAS);
}

// s, w and gap a time t into the play
static void loose(const InerterDevice* p, double v, double a, double jerk, double t, double* z) {
  double rate = p->flywheel_viscous / p->inertance, w = z[W];
  double run = rate * t > 1e-8 ? -expm1(-rate * t) / rate : t;
  double d = p->series_damping > 0
                 ? (z[S] - z[GAP]) * exp(-p->series_stiffness * t / p->series_damping)
                 : 0;
  z[S] += (v + (0.5 * a + jerk * t / 6) * t) * t - w * run;
  z[W] = w - rate * w * run;
  z[GAP] = z[S] - d;
}

int series_exact(const InerterDevice* p, double v, double a, double jerk, double* z, double h) {
  if (!is_linear(p) || h < 0) {
    return 0;
  }
  if (!has(p, PART_BACKLASH)) {
    contact(p, v, a, jerk, 0, h, z);
    return 1;
  }
  double gap = series_gap(p, z), end[3] = {z[S], z[W], gap}, middle[3] = {z[S], z[W], gap};
  int side = (gap >= p->backlash) - (gap <= -p->backlash);
  double half = 0.5 * h, midway = v + (a + 0.5 * jerk * half) * half;
  double last = v + (a + 0.5 * jerk * h) * h;
  if (side == 0) {
    loose(p, v, a, jerk, half, middle);
    loose(p, v, a, jerk, h, end);
    if (fabs(middle[GAP]) >= p->backlash || fabs(end[GAP]) >= p->backlash) {
      return 0;
    }
  } else {
    contact(p, v, a, jerk, gap, half, middle);
    contact(p, v, a, jerk, gap, h, end);
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
