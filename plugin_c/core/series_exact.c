// Steps of a linear series element (series.c) along a motion (a quintic), exact while contact
// stays.
//
//   in contact:  b s'' + (c_s + c_w) s' + k_s (s - gap) = b a(t) + c_w v(t),  w = v - s'
//   loose:       b w' = -c_w w,  d' = -k_s d / c_s,  s' = v - w
//   in both a constant drag on the flywheel (series_sliding.c)
//   a dashpot c alone, or a laminar leak:  s'' + (c + c_w) / b s' = a(t) + c_w / b v(t)
//   one that bends: of fourth order, or the same for its tangent in the middle, of second
//   a clutch that slips:  b w' = F_c - c_w w,  c_s d' = F_c - k_s d
//
// In contact see oscillator.c. With backlash a step is only taken where the force keeps its sign,
// or the play is not used up, in its middle and at its end, with a clutch where that holds there;
// others are left to series_step.c.
//
// b, k_s, c_s, c_w, s, d, gap, w: as in series.c.
// Source: linear oscillator.
// Not modelled: inertance that varies, pipe, gas, hardening.

#include "series.h"

enum { S, W, GAP };  // places in z

static double contact_force(const InerterDevice* p, double v, const double* z) {
  return p->series_stiffness * (z[S] - z[GAP]) + p->series_damping * (v - z[W]);
}

// whether a flywheel is linear but for friction
static int is_linear(const InerterDevice* p) {
  return !has(p, PART_VARYING) && !has(p, PART_PIPE) && !has(p, PART_GAS);
}

// a linear dashpot without a spring beside it [N s/m], or 0
static double dashpot_alone(const InerterDevice* p) {
  if (p->series_stiffness > 0) {
    return 0;
  }
  if (!has(p, PART_CLUTCH)) {
    return p->series_damping;
  }
  int straight = p->series_damping == 0 && p->clutch_force == 0 && p->leak_quadratic_damping == 0;
  return straight ? p->leak_damping : 0;
}

// a step of a flywheel behind a dashpot
static void drag_along(const InerterDevice* p, const SeriesExact* steps, const Way* way,
                       double* z) {
  const double drive[] = {way->v, way->a, way->jerk, way->snap, way->crackle, 0};
  double own = p->flywheel_viscous / p->inertance, rate = steps->dashpot / p->inertance + own;
  double u = way->v - z[W], end = steps->decay * u;
  for (int k = 0; k < RESPONSES; k++) {
    end += steps->driven[k] * (drive[k + 1] + own * drive[k]);
  }
  double faster = way_speed(way, steps->h), travel = way_travel(way, steps->h);
  double slid = (faster - way->v + own * travel + u - end) / rate;
  z[S] += slid;
  z[W] = faster - end;
  if (has(p, PART_CLUTCH)) {
    z[GAP] += slid;
  }
}

// The same behind a leak that bends, exact for its tangent at `near`, its velocity in the middle:
// u after a time h; *slid: its way.
static double leak_near(const InerterDevice* p, const Way* way, double u, double near, double h,
                        double* slid) {
  const double drive[] = {way->v, way->a, way->jerk, way->snap, way->crackle, 0};
  double own = p->flywheel_viscous / p->inertance, slope = clutch_slope(p, near) / p->inertance;
  double rest = clutch_law(p, near) / p->inertance - slope * near, rate = slope + own;
  double driven[RESPONSES], end = exp(-rate * h) * u;
  decay_driven(rate, h, driven);
  end -= driven[0] * rest;
  for (int k = 0; k < RESPONSES; k++) {
    end += driven[k] * (drive[k + 1] + own * drive[k]);
  }
  double faster = way_speed(way, h) - way->v + own * way_travel(way, h);
  *slid = rate * h > 1e-3 ? (faster - rest * h + u - end) / rate : 0.5 * h * (u + end);
  return end;
}

// the same with the tangent in the middle, which that of the start leads to
static double leak_step(const InerterDevice* p, const Way* way, double u, double h, double* slid) {
  double middle = leak_near(p, way, u, u, 0.5 * h, slid);
  return leak_near(p, way, u, middle, h, slid);
}

// u' from a time on a way
static double leak_rate(const InerterDevice* p, const Way* way, double t, double u) {
  double own = p->flywheel_viscous / p->inertance;
  return way_acceleration(way, t) + own * (way_speed(way, t) - u) - clutch_law(p, u) / p->inertance;
}

// a step of Runge and Kutta's fourth order
static double leak_run(const InerterDevice* p, const Way* way, double u, double h, double* slid) {
  double half = 0.5 * h, first = leak_rate(p, way, 0, u), early = u + half * first;
  double second = leak_rate(p, way, half, early), late = u + half * second;
  double third = leak_rate(p, way, half, late), end = u + h * third;
  double fourth = leak_rate(p, way, h, end);
  *slid = h / 6 * (u + 2 * (early + late) + end);
  return u + h / 6 * (first + 2 * (second + third) + fourth);
}

// parts of so little of a radian are run through; more are steps whose error goes with its square,
// at most so many
enum { PER_RUN = 4, MOST_RUNS = 8, MOST_BENDS = 64 };

static void leak_along(const InerterDevice* p, const Way* way, double h, double* z) {
  double u = way->v - z[W], fastest = fabs(u) + fabs(way_speed(way, h) - way->v), slid;
  double parts = PER_RUN * h * (clutch_slope(p, fastest) + p->flywheel_viscous) / p->inertance;
  int runs = parts < MOST_RUNS, count = parts < MOST_BENDS ? 1 + (int)parts : MOST_BENDS;
  double part = h / count;
  for (int i = 0; i < count; i++) {
    Way now = i ? way_after(way, part * i) : *way;
    u = runs ? leak_run(p, &now, u, part, &slid) : leak_step(p, &now, u, part, &slid);
    z[S] += slid;
    z[GAP] += slid;
  }
  z[W] = way_speed(way, h) - u;
}

void series_exact_steps(const InerterDevice* p, double h, SeriesExact* steps) {
  int linear = has(p, PART_SERIES) && is_linear(p) && h >= 0;
  steps->h = h;
  steps->dashpot = linear ? dashpot_alone(p) : 0;
  int spring = p->series_stiffness > 0 || p->series_damping > 0;
  steps->bends = linear && has(p, PART_CLUTCH) && !spring && p->leak_quadratic_damping > 0;
  if (steps->bends) {
    steps->holds = 1;
    return;
  }
  if (steps->dashpot > 0) {
    double rate = (steps->dashpot + p->flywheel_viscous) / p->inertance;
    steps->holds = 1;
    steps->decay = exp(-rate * h);
    decay_driven(rate, h, steps->driven);
    return;
  }
  steps->holds = linear && p->series_stiffness > 0 && p->series_hardening == 0 &&
                 series_parts(p, p->series_stiffness, p->inertance, h) < series_most_parts(p);
  if (steps->holds) {
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

// s and w after a slide in which a force pushes the flywheel
static Slide slide_over(const InerterDevice* p, double t) {
  double rate = p->flywheel_viscous / p->inertance;
  double run = rate * t > 1e-8 ? -expm1(-rate * t) / rate : t;
  return (Slide){t, run, rate * t > 1e-3 ? (t - run) / rate : t * t * (0.5 - rate * t / 6),
                 p->series_damping > 0 ? exp(-p->series_stiffness * t / p->series_damping) : 0};
}
static void slide_on(const InerterDevice* p, const Slide* slide, const Way* way, double force,
                     double* z) {
  double rate = p->flywheel_viscous / p->inertance, push = force / p->inertance, w = z[W];
  z[S] += way_travel(way, slide->time) - w * slide->run - push * slide->late;
  z[W] = w + (push - rate * w) * slide->run;
}

// the same in the play, whose spring relaxes
static void loose(const InerterDevice* p, const Slide* slide, const Way* way, double drag,
                  double* z) {
  double d = p->series_damping > 0 ? (z[S] - z[GAP]) * slide->fade : 0;
  slide_on(p, slide, way, -drag, z);
  z[GAP] = z[S] - d;
}

static void find_swings(SeriesExact* steps, int halves) {
  if (!steps->has_swings) {
    steps->has_swings = 1;
    steps->swing = oscillator_swing(&steps->oscillator, steps->h);
    steps->half_swing =
        halves ? oscillator_swing(&steps->oscillator, 0.5 * steps->h) : steps->swing;
  }
}
static void find_slides(const InerterDevice* p, SeriesExact* steps) {
  if (!steps->has_slides) {
    steps->has_slides = 1;
    steps->slide = slide_over(p, steps->h);
    steps->half_slide = slide_over(p, 0.5 * steps->h);
  }
}

// whether a clutch holds a force
static int holds(const InerterDevice* p, double force) {
  return fabs(force) < clutch_limit(p, force);
}

// a step in which a clutch holds at the start, in the middle and at the end; else 0, nothing done
static int holding(const InerterDevice* p, SeriesExact* steps, const Way* way, double* z) {
  if (!holds(p, contact_force(p, way->v, z))) {
    return 0;
  }
  double slip = z[GAP], middle[3] = {z[S], z[W], slip}, end[3] = {z[S], z[W], slip};
  find_swings(steps, 1);
  contact(steps, &steps->half_swing, way, slip, middle);
  contact(steps, &steps->swing, way, slip, end);
  if (!holds(p, contact_force(p, way_speed(way, 0.5 * steps->h), middle)) ||
      !holds(p, contact_force(p, way_speed(way, steps->h), end))) {
    return 0;
  }
  z[S] = end[S];
  z[W] = end[W];
  return 1;
}

// s, w and slip where a clutch slips with a constant force
static void slip_on(const InerterDevice* p, const Slide* slide, const Way* way, double force,
                    double* z) {
  double held = force / p->series_stiffness, d = held + (z[S] - z[GAP] - held) * slide->fade;
  slide_on(p, slide, way, force, z);
  z[GAP] = z[S] - d;
}

// a step in which a clutch slips one way at the start, in the middle and at the end, as above
static int slipping(const InerterDevice* p, SeriesExact* steps, const Way* way, double* z) {
  double start = contact_force(p, way->v, z), force = sign(start) * clutch_limit(p, start);
  double middle[3] = {z[S], z[W], z[GAP]}, end[3] = {z[S], z[W], z[GAP]};
  if (!(fabs(start) > fabs(force))) {
    return 0;
  }
  find_slides(p, steps);
  slip_on(p, &steps->half_slide, way, force, middle);
  slip_on(p, &steps->slide, way, force, end);
  double side = sign(start), beyond = fabs(force);
  if (!(side * contact_force(p, way_speed(way, 0.5 * steps->h), middle) > beyond &&
        side * contact_force(p, way_speed(way, steps->h), end) > beyond)) {
    return 0;
  }
  z[S] = end[S];
  z[W] = end[W];
  z[GAP] = end[GAP];
  return 1;
}

int series_exact(const InerterDevice* p, SeriesExact* steps, const Way* way, double* z) {
  if (!steps->holds) {
    return 0;
  }
  if (steps->dashpot > 0) {
    drag_along(p, steps, way, z);
    return 1;
  }
  if (steps->bends) {
    leak_along(p, way, steps->h, z);
    return 1;
  }
  if (has(p, PART_CLUTCH)) {
    int leaks = p->leak_damping > 0 || p->leak_quadratic_damping > 0;
    return holding(p, steps, way, z) || (!leaks && slipping(p, steps, way, z));
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
    loose(p, &steps->half_slide, way, steps->oscillator.push, middle);
    loose(p, &steps->slide, way, steps->oscillator.push, end);
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
