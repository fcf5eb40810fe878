// A spring in series with the dampers between the terminals: oil that is compressed, rubber mounts.
//
//   F = D(w),   w' = k_d (v - w) / D'(w)
//
// w [m/s] velocity over the dampers, v of the terminals, D their force (damper.c), k_d [N/m]
// damper_stiffness. The spring is bent by D(w) / k_d. Positive force lengthens. Stored energy:
// D^2 / (2 k_d); heat: D w. Along the curve of the dampers over the velocity the force runs in a
// loop: late by D' / k_d. Why w and not the spring's deflection: D need not be inverted, and a
// stiff spring follows with w = v whatever D does. Source: Maxwell element with the dampers' own
// law; oil that is compressed in shock absorbers: Surace, Worden, Tomlinson 1992. Not modelled:
// damping along the stroke, or set by a control, behind the spring; damping that falls with the
// speed.

#include "elementary.h"
#include "laws.h"

// slope of a damper that has levelled off, at which w follows at once
static const double kLevel = 1e-200;

// how fast w comes to v [1/s]; 0 without damping, when an engine has it disabled: there is no force
static double pace_at(const InerterDevice* p, double w) {
  if (p->viscous == 0 && p->quadratic_damping == 0) {
    return 0;
  }
  return p->damper_stiffness / fmax(damper_slope(p, p->viscous, w), kLevel);
}

double damper_spring_rate(const InerterDevice* p, double v, double w) {
  return pace_at(p, w) * (v - w);
}

// what w follows a way with at one pace: v - v' / pace + v'' / pace^2 - ...
static double followed(const Way* w, double time) {
  return w->v - time * (w->a - time * (w->jerk - time * (w->snap - time * w->crackle)));
}

// from this many paces on the terms of that leave digits enough
static const double kLong = 0.05;

// w after a time t at one pace
static double relaxed(const Way* way, double pace, double w, double t) {
  if (pace * t > kLong) {
    Way end = way_after(way, t);
    double time = 1 / pace, left = w - followed(way, time);
    return followed(&end, time) + left * elementary_exp(-pace * t);
  }
  const double rates[RESPONSES] = {way->v, way->a, way->jerk, way->snap, way->crackle};
  double driven[RESPONSES], follows = 0;
  decay_driven(pace, t, driven);
  for (int k = 0; k < RESPONSES; k++) {
    follows += driven[k] * rates[k];
  }
  return w * elementary_exp(-pace * t) + pace * follows;
}

// a step at the pace of its middle, which that of its start leads to
static double middled(const InerterDevice* p, const Way* way, double w, double h) {
  double middle = relaxed(way, pace_at(p, w), w, 0.5 * h);
  return relaxed(way, pace_at(p, middle), w, h);
}

// a step is divided until both halves tell a force that is this near to that of the whole
static const double kNear = 1e-4;
enum { MOST_HALVES = 12 };

static double divided(const InerterDevice* p, const Way* way, double w, double h, int halves) {
  Way later = way_after(way, 0.5 * h);
  double whole = middled(p, way, w, h), half = middled(p, way, w, 0.5 * h);
  double end = middled(p, &later, half, 0.5 * h);
  double force = damper_spring_force(p, end), before = damper_spring_force(p, w);
  double miss = fabs(force - damper_spring_force(p, whole));
  // with asymmetry the pace jumps where w changes its sign, which both may have missed
  int jumps = p->damping_asymmetry != 0 && w * end < 0;
  if (halves == 0 || (miss <= kNear * (fabs(force) + fabs(before)) && !jumps)) {
    // the error of a step goes with its square
    return end + (end - whole) / 3;
  }
  half = divided(p, way, w, 0.5 * h, halves - 1);
  return divided(p, &later, half, 0.5 * h, halves - 1);
}

void damper_spring_follow(const InerterDevice* p, const Way* way, double* w, double h) {
  int bends = p->quadratic_damping > 0 || p->damping_knee > 0 || p->damping_knee_back > 0 ||
              p->damping_asymmetry != 0;
  *w = bends ? divided(p, way, *w, h, MOST_HALVES) : relaxed(way, pace_at(p, *w), *w, h);
}

double damper_spring_force(const InerterDevice* p, double w) {
  return damper_law(p, p->viscous, w);
}

enum { MOST_TURNS = 60 };

// w1 with D(w1) + k_d h w1 = D(w) + k_d h v1, between w and v1: Newton's steps, halved where they
// lead out
static double backward(const InerterDevice* p, double v1, double w, double h) {
  double stiff = p->damper_stiffness * h, whole = damper_law(p, p->viscous, w) + stiff * v1;
  double low = fmin(w, v1), high = fmax(w, v1), at = w;
  for (int i = 0; i < MOST_TURNS; i++) {
    double miss = damper_law(p, p->viscous, at) + stiff * at - whole;
    if (miss > 0) {
      high = at;
    } else {
      low = at;
    }
    double next = at - miss / (damper_slope(p, p->viscous, at) + stiff);
    if (!(next >= low && next <= high)) {
      next = 0.5 * (low + high);
    }
    double step = fabs(next - at);
    at = next;
    if (!(step > 1e-14 * (fabs(w) + fabs(v1)))) {
      break;
    }
  }
  return at;
}

double damper_spring_over_step(const InerterDevice* p, double v1, double* w, double h,
                               double mobility) {
  double share = least_share(p->damper_stiffness, mobility, h);
  double before = damper_spring_force(p, *w);
  *w = backward(p, v1, *w, h);
  return before + share * (damper_spring_force(p, *w) - before);
}

double damper_spring_energy(const InerterDevice* p, double w) {
  double force = damper_spring_force(p, w);
  return 0.5 * force * force / p->damper_stiffness;
}

double damper_spring_heat(const InerterDevice* p, double w) {
  return damper_spring_force(p, w) * w;
}
