// Steps of the series element (series.c): linear equations for the end of a step, in closed form.
//
// Flywheel:  B (w1 - w) / h + R + G(w) + G' share (w1 - w) = F
//            s1 - s = h (v - w - share (w1 - w))
// Spring in contact:  F = phi(d) + share phi'(d) (d1 - d) + c_s (d1 - d) / h
// Loose: backward step, the spring relaxes to `rest` while the play takes up the motion:
//            rest c_s / h + phi(d) + phi'(d) (rest - d) = d c_s / h
//            F = (phi' + c_s / h) (s1 - gap1 - rest),  gap1 = s1 - rest clamped to the play
//
// With backlash F is a dead zone in s1: one line pushes, one pulls. A side that is in contact keeps
// its own line, which the step resolves better. The sum of both is continuous and does not fall
// with s1, so that with the flywheel's line there is one F.
//
// A slip of h U over the step leaves the spring the rest of u = s1 - s: F = S(U), and
//            (1 + slope give) S(U) + slope h U = F without slip (1 + slope give)
//
// v, w, s, d, phi, B, R, G, h [s]: as in series.c; share 1/2 ... 1: implicit part of the step.
// Friction at the flywheel (wheel_friction.c) takes a force D of F there, that of the velocity
//            w + share (w1 - w): one equation in D, which does not fall with w1, found by bisection
//            and inverse quadratic interpolation.
// Source: the theta method; least share for stability follows from the linear oscillator.
// Not modelled: impacts within a step, whose times are not searched.

#include <string.h>

#include "series.h"

enum { S, W, GAP };  // places in z

// what F does to the flywheel over a step: s1 - s = free_u - give_u F, w1 = free_w + give_w F
typedef struct Flywheel_ {
  double free_u, give_u;
  double free_w, give_w;
} Flywheel;

// F over a step as function of u = s1 - s, each line its value at u = 0 and slope
typedef struct Element_ {
  Tangent push, pull;  // F = max(0, push) + min(0, pull); without backlash F = push
  double rest;         // deflection that a loose spring relaxes to
  double h;            // [s]
  double stiffness;    // tangent of the spring
  int side;            // +1, -1: side in contact at the start
} Element;

static double at(Tangent line, double u) {
  return line.value + line.slope * u;
}

// the flywheel's step from w, its coefficients taken at displacement y and velocity near
static Flywheel flywheel_step(const InerterDevice* p, double y, double near, double w, double v,
                              double h, double share) {
  double rest, mass = inertance_felt(p, y, near, &rest) / h;
  if (has(p, PART_FLYWHEEL)) {
    Tangent damper = flywheel_damper(p, near);
    rest += damper.value + damper.slope * (w - near) + (has(p, PART_GAS) ? gas_force(p, y) : 0);
    mass += share * damper.slope;
  }
  double change = rest / mass;
  return (Flywheel){h * (v - w + share * change), h * share / mass, w - change, 1 / mass};
}

// the element's step from z; in contact linearised at deflection near, with `share`
static Element element_step(const InerterDevice* p, const double* z, double near, double h,
                            double share) {
  Element element = {.h = h, .side = 0};
  double damping = p->series_damping / h, gap = series_gap(p, z), d = z[S] - gap;
  Tangent spring = series_spring(p, near);
  spring.value += spring.slope * (d - near);
  element.stiffness = spring.slope;
  spring.slope = share * spring.slope + damping;
  element.push = spring;
  if (!has(p, PART_BACKLASH)) {
    return element;
  }

  // loose; without damper the spring is unloaded at once
  Tangent loose = series_spring(p, damping > 0 ? d : 0);
  loose.slope += damping;
  element.rest = damping > 0 ? d - loose.value / loose.slope : 0;
  element.push.value = loose.slope * (z[S] - element.rest - p->backlash);
  element.pull.value = loose.slope * (z[S] - element.rest + p->backlash);
  element.push.slope = element.pull.slope = loose.slope;

  // in contact
  element.side = (gap >= p->backlash) - (gap <= -p->backlash);
  if (element.side > 0) {
    element.push = spring;
  } else if (element.side < 0) {
    element.pull = spring;
  }
  return element;
}

static double on_line(Tangent line, Flywheel flywheel) {
  return at(line, flywheel.free_u) / (1 + line.slope * flywheel.give_u);
}

// velocity of the slip over the step, and F
static double clutch_over_step(const InerterDevice* p, Element element, Flywheel flywheel,
                               double* force) {
  Tangent line = element.push;
  double h = element.h, give = flywheel.give_u, u;
  if (p->series_stiffness == 0 && p->series_damping == 0) {
    u = clutch_speed(p, give, h, flywheel.free_u);
    *force = clutch_law(p, u);
    return u;
  }
  double weight = 1 + line.slope * give, wanted = at(line, flywheel.free_u);
  u = clutch_speed(p, weight, line.slope * h, wanted);
  *force = (wanted - line.slope * h * u) / weight;
  return u;
}

// Way of the slip over a step in which the whole lengthens by u. Where F is that of a clutch the
// spring goes on to bear it, c_s d' = F - phi, however little h resolves of that.
static double slipped(const InerterDevice* p, Element element, Flywheel flywheel, double u) {
  double force, rate = clutch_over_step(p, element, flywheel, &force);
  int leaks = p->leak_damping > 0 || p->leak_quadratic_damping > 0;
  if (leaks || rate == 0) {
    return element.h * rate;
  }
  double rest = force - element.push.value, stiffness = element.stiffness;
  double time = element.h / p->series_damping;
  return u - (stiffness > 0 ? rest / stiffness * -expm1(-stiffness * time) : rest * time);
}

// F of both; of the four combinations of lines the one that fits itself
static double common_force(const InerterDevice* p, Element element, Flywheel flywheel) {
  if (has(p, PART_CLUTCH)) {
    double force;
    clutch_over_step(p, element, flywheel, &force);
    return force;
  }
  if (!has(p, PART_BACKLASH)) {
    return on_line(element.push, flywheel);
  }
  Tangent push = element.push, pull = element.pull;
  Tangent both = {push.value + pull.value, push.slope + pull.slope};
  const double candidates[] = {0, on_line(push, flywheel), on_line(pull, flywheel),
                               on_line(both, flywheel)};
  double found = 0, least = INFINITY;
  for (int i = 0; i < 4; i++) {
    double u = flywheel.free_u - flywheel.give_u * candidates[i];
    double error = fabs(fmax(0, at(push, u)) + fmin(0, at(pull, u)) - candidates[i]);
    if (error < least) {
      least = error;
      found = candidates[i];
    }
  }
  return found;
}

// states at the end of a step with force F
static void finish_step(const InerterDevice* p, Element element, Flywheel flywheel, double force,
                        double* z) {
  double u = flywheel.free_u - flywheel.give_u * force;
  z[S] += u;
  z[W] = flywheel.free_w + flywheel.give_w * force;
  if (has(p, PART_CLUTCH)) {
    z[GAP] += slipped(p, element, flywheel, u);
    return;
  }
  if (!has(p, PART_BACKLASH)) {
    return;
  }
  int held = (element.side > 0 && at(element.push, u) > 0 && at(element.pull, u) >= 0) ||
             (element.side < 0 && at(element.pull, u) < 0 && at(element.push, u) <= 0);
  if (held && p->series_damping > 0) {
    z[GAP] = element.side * p->backlash;
  } else {
    z[GAP] = clamp(z[S] - element.rest, -p->backlash, p->backlash);
  }
}

//------------------------------ friction at the flywheel ------------------------------------------

// a step of the friction at the flywheel
typedef struct Rubbing_ {
  double y;             // displacement of the flywheel
  double near;          // velocity at which the level is taken
  double w, share, h;   // the force is that of w + share (w1 - w), over a time h
  double implicit;      // share of a bristle's spring
  const double* start;  // states of the friction law at the start, NULL without
  double end[INERTER_MAXFRICTION];
} Rubbing;

static Flywheel held(Flywheel flywheel, double drag) {
  flywheel.free_u += flywheel.give_u * drag;
  flywheel.free_w -= flywheel.give_w * drag;
  return flywheel;
}

// force of the law over the step, its level that of the load; states of the end
static double rubbing_force(const InerterDevice* p, Rubbing* rubbing, double w, double force,
                            double drag) {
  size_t size = sizeof(double) * (size_t)p->nfriction;
  double load = load_on_bristle(p, w, force - drag);
  if (inerter_load_bends(p) && p->bristle_damping > 0) {
    // less the bristle's spring alone, on the mean of its way with the load of its start
    double spring = bristle_spring(p, rubbing->y, w, rubbing->start);
    load = load_on_bristle(p, w, force - spring);
    friction_over_step(p, rubbing->y, rubbing->near, w, rubbing->h, rubbing->implicit, load,
                       rubbing->end);
    double after = bristle_spring(p, rubbing->y, w, rubbing->end);
    spring += rubbing->implicit * (after - spring);
    load = load_on_bristle(p, w, force - spring);
    memcpy(rubbing->end, rubbing->start, size);
  }
  return friction_over_step(p, rubbing->y, rubbing->near, w, rubbing->h, rubbing->implicit, load,
                            rubbing->end);
}

// by how much friction at a drag differs from it
static double misfit(const InerterDevice* p, Element element, Flywheel flywheel, Rubbing* rubbing,
                     double drag) {
  Flywheel slowed = held(flywheel, drag);
  double force = common_force(p, element, slowed);
  double w = rubbing->w;
  w += rubbing->share * (slowed.free_w + slowed.give_w * force - w);
  if (rubbing->start) {
    memcpy(rubbing->end, rubbing->start, sizeof(double) * (size_t)p->nfriction);
  }
  double friction = rubbing_force(p, rubbing, w, force, drag);
  return friction + inerter_load_factor(p, w, rubbing->start, force - drag) * fabs(force - drag) -
         drag;
}

enum { MOST_TURNS = 100 };
#define EXACT 4e-15  // a difference per drag that is rounding

// The drag that friction has at the velocity which it leaves; 0 without friction there. Between 0
// and what the flywheel would feel without it: Chandrupatla's method.
static double drag_of(const InerterDevice* p, Element element, Flywheel flywheel,
                      Rubbing* rubbing) {
  if (!has(p, PART_WHEEL_FRICTION)) {
    return 0;
  }
  double a = 0, fa = misfit(p, element, flywheel, rubbing, 0), b = fa;
  if (!(fabs(fa) > 0 && isfinite(fa))) {
    return 0;
  }
  double fb = misfit(p, element, flywheel, rubbing, b);
  if (fb == 0) {
    // it slides, with a force that does not go with its velocity
    return b;
  }
  for (int i = 0; i < MOST_TURNS && fa * fb > 0; i++) {
    a = b;
    fa = fb;
    b *= 2;
    fb = misfit(p, element, flywheel, rubbing, b);
  }
  // a flywheel that sticks and one that slides are both nearly linear
  double part = clamp(fa / (fa - fb), 1e-3, 1 - 1e-3), last = b;
  for (int i = 0; i < MOST_TURNS; i++) {
    // the bracket is a, b with a the newest; c the one before
    double next = a + part * (b - a), value = misfit(p, element, flywheel, rubbing, next);
    last = next;
    if (fabs(value) <= EXACT * fabs(next)) {
      // friction falls with the drag: no further from it than this
      return next;
    }
    double c = value * fa > 0 ? a : b, fc = value * fa > 0 ? fa : fb;
    if (c == b) {
      b = a;
      fb = fa;
    }
    a = next;
    fa = value;
    double least = 4e-16 * fmax(fabs(a), fabs(b)) / fabs(b - a);
    if (fa == 0 || fb == 0 || !(least < 0.5)) {
      break;
    }
    double xi = (a - b) / (c - b), phi = (fa - fb) / (fc - fb);
    part = 0.5;
    if (phi * phi < xi && (1 - phi) * (1 - phi) < 1 - xi) {
      part = fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb);
    }
    part = clamp(part, least, 1 - least);
  }
  double best = fabs(fa) < fabs(fb) ? a : b;
  if (best != last) {
    misfit(p, element, flywheel, rubbing, best);
  }
  return best;
}

// One step from velocity v at acceleration a: a backward half step to the middle, then the whole
// with the coefficients there. Second order with share 1/2; the share rises where h does not
// resolve the element, so that it settles.
static void substep(const InerterDevice* p, double x, double v, double a, double* bristle,
                    double* z, double h) {
  double middle[3] = {z[S], z[W], series_count(p) > GAP ? z[GAP] : 0};
  double d = z[S] - series_gap(p, z);
  Element half = element_step(p, z, d, 0.5 * h, 1);
  double midway = v + 0.5 * h * a;
  Flywheel flywheel = flywheel_step(p, x - z[S], z[W], z[W], midway, 0.5 * h, 1);
  Rubbing rubbing = {x - z[S], z[W], z[W], 1, 0.5 * h, 1, bristle, {0}};
  flywheel = held(flywheel, drag_of(p, half, flywheel, &rubbing));
  finish_step(p, half, flywheel, common_force(p, half, flywheel), middle);

  double near = middle[S] - series_gap(p, middle);
  double y = x + 0.25 * h * (v + midway) - middle[S];
  double inertance = inertance_felt(p, y, middle[W], NULL);
  double damping = p->series_damping, stiffness = series_spring(p, near).slope, relaxed = 0;
  if (has(p, PART_FLYWHEEL)) {
    damping += flywheel_damper(p, middle[W]).slope;
  }
  if (has(p, PART_WHEEL_FRICTION)) {
    damping += friction_grip(p, y, middle[W]);
    stiffness += bristle ? law_of(p)->stiffness(p) : 0;
  }
  if (has(p, PART_CLUTCH)) {
    double slip = clutch_slope(p, (middle[GAP] - z[GAP]) / (0.5 * h));
    if (stiffness == 0 && p->series_damping == 0) {
      damping += slip;
    } else if (p->leak_damping > 0 || p->leak_quadratic_damping > 0) {
      relaxed = h * stiffness / (slip + p->series_damping);
    }
  }
  double square = fmax(relaxed, h * (h * stiffness + damping) / inertance);
  double share = square > 2 ? 1 - 1 / square : 0.5;
  Element element = element_step(p, z, near, h, share);
  flywheel = flywheel_step(p, y, middle[W], z[W], v + share * h * a, h, share);
  rubbing = (Rubbing){y, middle[W], z[W], share, h, share, bristle, {0}};
  flywheel = held(flywheel, drag_of(p, element, flywheel, &rubbing));
  finish_step(p, element, flywheel, common_force(p, element, flywheel), z);
  if (bristle) {
    memcpy(bristle, rubbing.end, sizeof(double) * (size_t)p->nfriction);
  }
}

// parts of a sixteenth of a radian as long as they are not too many, else a few that settle
enum { PER_RADIAN = 16, FEW_PARTS = 4 };

double series_parts(const InerterDevice* p, double stiffness, double inertance, double h) {
  return PER_RADIAN * fabs(h) * (sqrt(stiffness / inertance) + p->series_damping / inertance);
}

void series_step(const InerterDevice* p, double x, const Way* way, double* bristle, double* z,
                 double h) {
  if (h == 0) {
    return;
  }
  double inertance = inertance_felt(p, x - z[S], z[W], NULL);
  double stiffness = series_spring(p, z[S] - series_gap(p, z)).slope;
  int rubs = has(p, PART_WHEEL_FRICTION);
  if (rubs && has_bristle(p)) {
    stiffness += law_of(p)->stiffness(p);
  }
  double parts = series_parts(p, stiffness, inertance, h);
  if (has(p, PART_CLUTCH) && stiffness == 0 && p->series_damping == 0) {
    parts += PER_RADIAN * fabs(h) * clutch_slope(p, way->v - z[W]) / inertance;
  }
  int resolved = parts < SERIES_MOST_PARTS, count = resolved ? 1 + (int)parts : FEW_PARTS;
  if (parts < series_most_parts(p)) {
    SeriesExact steps;
    series_exact_steps(p, h, &steps);
    int most = 1 + (resolved ? count : SERIES_MOST_PARTS) / 2;
    double* states = rubs && has_bristle(p) ? bristle : NULL;
    int exact =
        rubs ? series_sliding(p, &steps, x, way, states, z) : series_exact(p, &steps, way, z);
    if (exact || series_frozen(p, x, way, z, h, most)) {
      return;
    }
  }
  double part = h / count;
  for (int i = 0; i < count; i++) {
    double t = part * i;
    substep(p, x + way_travel(way, t), way_speed(way, t), way_acceleration(way, t + 0.5 * part),
            rubs && has_bristle(p) ? bristle : NULL, z, part);
  }
}

double series_over_step(const InerterDevice* p, double x, double v, double* bristle, double* z,
                        double h, double mobility, double* drag) {
  double inertance = inertance_felt(p, x - z[S], z[W], NULL), d = z[S] - series_gap(p, z);
  double stiffness = series_spring(p, d).slope;
  double share = least_share(stiffness, mobility + 1 / inertance, h);
  if (stiffness > 0 && (p->leak_damping > 0 || p->leak_quadratic_damping > 0)) {
    // what leaks lets the spring relax
    share = fmax(share, 1 - (p->series_damping + p->leak_damping) / (stiffness * h));
  }
  Element element = element_step(p, z, d, h, share);
  Flywheel flywheel = flywheel_step(p, x - z[S], z[W], z[W], v, h, 1);
  if (has(p, PART_WHEEL_FRICTION)) {
    int has_state = has_bristle(p);
    double grip = has_state ? least_share(law_of(p)->stiffness(p), 1 / inertance, h) : 0;
    Rubbing rubbing = {x - z[S], z[W], z[W], 1, h, grip, has_state ? bristle : NULL, {0}};
    *drag = drag_of(p, element, flywheel, &rubbing);
    flywheel = held(flywheel, *drag);
    if (has_state) {
      memcpy(bristle, rubbing.end, sizeof(double) * (size_t)p->nfriction);
    }
  }
  double force = common_force(p, element, flywheel);
  finish_step(p, element, flywheel, force, z);
  return force;
}
