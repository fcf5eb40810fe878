// What changes along the stroke: a curve through values, a sum of periods, or both.
//
//   f(x) = S(x) + sum over k of A_k sin(2 pi x / L_k + phi_k)
//   S: n values at evenly spaced x from curve_lower to curve_upper, a cubic spline through them
//   (C2)
//      with slope 0 at both ends; constant beyond
//   S = [c_i (1-u)^3 + c_i+1 (3u^3 - 6u^2 + 4) + c_i+2 (-3u^3 + 3u^2 + 3u + 1) + c_i+3 u^3] / 6
//   c_i + 4 c_i+1 + c_i+2 = 6 value_i,  c_0 = c_2,  c_n+1 = c_n-1
//
// x [m] displacement; u in [0, 1] place between two values, i the first of them; L_k [m] length,
// A_k amplitude [unit of f], phi_k phase [rad] of a gear's eccentricity, a screw's pitch, a tooth.
// f is, each with its own values and periods: a relative rise of the friction level (friction.h), a
// relative rise of the inertance (inertance.c), a force [N] (conservative: cogging, detents, cams;
// stored energy: its integral from 0), viscous damping [N s/m] beside `viscous`.
// For v < 0 friction level and inertance have others where friction_back, inertance_back are given.
// Why slope 0 at the ends: the curve goes on as a constant, and what hangs on the slope (the force
// b'(x) v^2 / 2) has no jump there. Why B-splines: the c_i bound the curve and its slope.
// Source: cardinal cubic splines (de Boor, A Practical Guide to Splines).
// Not modelled: other places than evenly spaced ones; a curve that depends on speed or load.

#include <stdio.h>

#include "elementary.h"
#include "laws.h"

static const double kTurn = 6.28318530717958647692;
static const double kLeastLevel = 1e-3, kLeastInertance = 0.01;

//------------------------------ the curve ---------------------------------------------------------

// place of x among the values: the first of the four coefficients, and how far on
static INLINED int place(const InerterCurve* c, double x, double* u) {
  int last = c->nvalue > 2 ? c->nvalue - 2 : 0;
  double t = (x - c->lower) * c->rate;
  t = t > 0 ? t : 0;
  t = t < last + 1 ? t : last + 1;
  int i = (int)t;
  i = i < last ? i : last;
  *u = t - i;
  return i;
}

// the spline through four coefficients, with its slope
static INLINED double spline_of(double rate, double u, double f0, double f1, double f2, double f3,
                                double* slope) {
  double w = 1 - u, square = u * u, cube = square * u;
  *slope = 0.5 * rate * ((f1 - f0) * w * w + (f2 - f1) * (1 + 2 * u * w) + (f3 - f2) * square);
  return (f0 * w * w * w + f1 * (3 * cube - 6 * square + 4) + f2 * (3 * (square - cube + u) + 1) +
          f3 * cube) /
         6;
}

// it is level beyond both ends
static INLINED int is_end(double u, int first) {
  return u == 1 || (u == 0 && first == 0);
}

static double spline(const InerterCurve* c, double x, double* slope) {
  double u;
  int i = place(c, x, &u);
  const double* f = c->fit + i;
  double value = spline_of(c->rate, u, f[0], f[1], f[2], f[3], slope);
  *slope = is_end(u, i) ? 0 : *slope;
  return value;
}

static INLINED void splines(const InerterCurve* c, int n, const double* restrict x,
                            double* restrict value, double* restrict slope) {
  double place_of[FRICTION_BLOCK], fit[4][FRICTION_BLOCK], rate[FRICTION_BLOCK];
  for (int i = 0; i < n; i++) {
    int first = place(c, x[i], place_of + i);
    rate[i] = is_end(place_of[i], first) ? 0 : c->rate;
    for (int k = 0; k < 4; k++) {
      fit[k][i] = c->fit[first + k];
    }
  }
  for (int i = 0; i < n; i++) {
    value[i] =
        spline_of(rate[i], place_of[i], fit[0][i], fit[1][i], fit[2][i], fit[3][i], slope + i);
  }
}

// integral from the first value on
static double spline_integral(const InerterCurve* c, double x) {
  double t = (x - c->lower) * c->rate, sum = 0;
  int last = c->nvalue - 1;
  if (t <= 0) {
    return c->value[0] * (x - c->lower);
  }
  for (int i = 0; i < last && i < t; i++) {
    const double* f = c->fit + i;
    double u = t < i + 1 ? t - i : 1, w = 1 - u, square = u * u, fourth = square * square;
    sum += (f[0] * (1 - w * w * w * w) + f[1] * (3 * fourth - 8 * square * u + 16 * u) +
            f[2] * (-3 * fourth + 4 * square * u + 6 * square + 4 * u) + f[3] * fourth) /
           24;
  }
  double beyond = t > last ? c->value[last] * (t - last) : 0;
  return (sum + beyond) / c->rate;
}

static INLINED double angle_at(const double* period, double x) {
  return kTurn * x / period[0] + period[2];
}

// one of a sum of periods, with its slope; in a loop where all angles are within ELEMENTARY_ANGLE
static INLINED double near_period(const double* period, double x, double* slope) {
  double cosine, sine = elementary_sin_cos(angle_at(period, x), &cosine);
  *slope = period[1] * kTurn / period[0] * cosine;
  return period[1] * sine;
}

static double period_at(const double* period, double x, double* slope) {
  double angle = angle_at(period, x);
  if (fabs(angle) <= ELEMENTARY_ANGLE) {
    return near_period(period, x, slope);
  }
  *slope = period[1] * kTurn / period[0] * cos(angle);
  return period[1] * sin(angle);
}

Tangent curve_at(const InerterCurve* c, double x) {
  Tangent curve = {0, 0};
  if (c->nvalue) {
    curve.value = spline(c, x, &curve.slope);
  }
  for (int k = 0; k < c->nperiod; k++) {
    double slope;
    curve.value += period_at(c->period + 3 * k, x, &slope);
    curve.slope += slope;
  }
  return curve;
}

double curve_value(const InerterCurve* c, double x) {
  return curve_at(c, x).value;
}

SEVERAL_AT_ONCE void curve_at_samples(const InerterCurve* c, int n, const double* restrict x,
                                      double* restrict value, double* restrict slope) {
  if (c->nvalue) {
    splines(c, n, x, value, slope);
  } else {
    memset(value, 0, sizeof(double) * (size_t)n);
    memset(slope, 0, sizeof(double) * (size_t)n);
  }
  for (int k = 0; k < c->nperiod; k++) {
    const double* period = c->period + 3 * k;
    int near = 1;
    for (int i = 0; i < n; i++) {
      near &= fabs(angle_at(period, x[i])) <= ELEMENTARY_ANGLE;
    }
    for (int i = 0; near && i < n; i++) {
      double rise;
      value[i] += near_period(period, x[i], &rise);
      slope[i] += rise;
    }
    for (int i = 0; !near && i < n; i++) {
      double rise;
      value[i] += period_at(period, x[i], &rise);
      slope[i] += rise;
    }
  }
}

double curve_integral(const InerterCurve* c, double x) {
  double sum = c->nvalue ? spline_integral(c, x) - spline_integral(c, 0) : 0;
  for (int k = 0; k < c->nperiod; k++) {
    // cos b - cos a, exact for short ways
    const double* period = c->period + 3 * k;
    double half = 0.5 * kTurn * x / period[0];
    sum += 2 * period[1] * period[0] / kTurn * sin(half) * sin(half + period[2]);
  }
  return sum;
}

double inerter_curve_steepest(const InerterDevice* device, InerterStroke stroke) {
  const InerterCurve* c = &device->curve[stroke];
  double steepest = 0;
  for (int i = 0; c->nvalue && i <= c->nvalue; i++) {
    steepest = fmax(steepest, fabs(c->fit[i + 1] - c->fit[i]) * c->rate);
  }
  for (int k = 0; k < c->nperiod; k++) {
    steepest += fabs(c->period[3 * k + 1]) * kTurn / c->period[3 * k];
  }
  return steepest;
}

// of both directions, as friction_curve_level
static INLINED double level_of_both(double rise, double forth, double back, double* lean) {
  forth = larger(kLeastLevel, 1 + rise + forth);
  back = larger(kLeastLevel, 1 + rise + back);
  *lean = (forth - back) / (forth + back);
  return 0.5 * (forth + back);
}

double friction_curve_level(const InerterDevice* p, double x, double rise, double* lean) {
  double forth = curve_value(&p->curve[INERTER_STROKE_friction], x);
  if (!has(p, PART_FRICTION_BACK)) {
    return larger(kLeastLevel, 1 + rise + forth);
  }
  double back = curve_value(&p->curve[INERTER_STROKE_friction_back], x);
  return level_of_both(rise, forth, back, lean);
}

SEVERAL_AT_ONCE void friction_curve_levels(const InerterDevice* p, int n, const double* x,
                                           double* restrict level, double* restrict lean) {
  double forth[FRICTION_BLOCK], back[FRICTION_BLOCK], slope[FRICTION_BLOCK];
  double linear = p->friction_gradient, square = p->friction_curvature;
  curve_at_samples(&p->curve[INERTER_STROKE_friction], n, x, forth, slope);
  if (has(p, PART_FRICTION_BACK)) {
    curve_at_samples(&p->curve[INERTER_STROKE_friction_back], n, x, back, slope);
    for (int i = 0; i < n; i++) {
      level[i] = level_of_both((linear + square * x[i]) * x[i], forth[i], back[i], lean + i);
    }
  } else {
    for (int i = 0; i < n; i++) {
      level[i] = larger(kLeastLevel, 1 + (linear + square * x[i]) * x[i] + forth[i]);
      lean[i] = p->friction_asymmetry;
    }
  }
}

//------------------------------ configuration -----------------------------------------------------

uint32_t curve_parts(const InerterDevice* p) {
  int friction = inerter_has_curve(p, INERTER_STROKE_friction);
  int friction_back = inerter_has_curve(p, INERTER_STROKE_friction_back);
  int inertance = inerter_has_curve(p, INERTER_STROKE_inertance);
  int inertance_back = inerter_has_curve(p, INERTER_STROKE_inertance_back);
  int force = inerter_has_curve(p, INERTER_STROKE_force);
  int viscous = inerter_has_curve(p, INERTER_STROKE_viscous);
  return (friction || friction_back ? PART_FRICTION_CURVE : 0) |
         (friction_back ? PART_FRICTION_BACK : 0) |
         (inertance || inertance_back ? PART_INERTANCE_CURVE | PART_VARYING : 0) |
         (inertance_back ? PART_INERTANCE_BACK : 0) | (force ? PART_FORCE_CURVE : 0) |
         (viscous ? PART_VISCOUS_CURVE : 0) | (p->map.nvalue ? PART_FORCE_MAP : 0);
}

// by elimination from both equations of the ends
void curve_coefficients(int n, const double* value, double* fit) {
  double pivot[INERTER_MAXCURVE], *f = fit + 1;
  if (n < 2) {  // a straight line needs two
    return;
  }
  pivot[0] = 0.5;
  f[0] = 1.5 * value[0];
  for (int i = 1; i < n; i++) {
    double below = i == n - 1 ? 2 : 1, divisor = 4 - below * pivot[i - 1];
    pivot[i] = 1 / divisor;
    f[i] = (6 * value[i] - below * f[i - 1]) / divisor;
  }
  for (int i = n - 2; i >= 0; i--) {
    f[i] -= pivot[i] * f[i + 1];
  }
  fit[0] = f[1];
  f[n] = f[n - 2];
}

static void fit(InerterCurve* c, double lower, double upper) {
  c->lower = lower;
  c->rate = (c->nvalue - 1) / (upper - lower);
  curve_coefficients(c->nvalue, c->value, c->fit);
}

// Where base + curve is below the least that is allowed: 1 with place and value. The coefficients
// and the amplitudes bound it; where that is not enough it is looked at, over the curve and the
// longest period on either side.
static int falls_below(const InerterCurve* c, double base, double least, double* where,
                       double* value) {
  enum { MOST = 4096, PER_PERIOD = 32, PER_VALUE = 16 };
  double bound = base, span = c->nvalue ? (c->nvalue - 1) / c->rate : 0, longest = 0;
  double fine = c->nvalue ? 1 / (c->rate * PER_VALUE) : INFINITY;
  double size = fabs(base);
  for (int i = 0; c->nvalue && i < c->nvalue + 2; i++) {
    bound = fmin(bound, base + c->fit[i]);
    size = fmax(size, fabs(c->fit[i]));
  }
  for (int k = 0; k < c->nperiod; k++) {
    bound -= fabs(c->period[3 * k + 1]);
    size = fmax(size, fabs(c->period[3 * k + 1]));
    longest = fmax(longest, c->period[3 * k]);
    fine = fmin(fine, c->period[3 * k] / PER_PERIOD);
  }
  if (bound >= least) {
    return 0;
  }
  double start = (c->nvalue ? c->lower : 0) - longest, whole = span + 2 * longest;
  int count = whole / fine < MOST ? 1 + (int)(whole / fine) : MOST;
  *value = INFINITY;
  for (int i = 0; i <= count; i++) {
    double x = start + whole * i / count, here = base + curve_value(c, x);
    if (here < *value) {
      *value = here;
      *where = x;
    }
  }

  // the bottom between the neighbours
  double step = whole / count;
  for (int i = 0; i < 40; i++) {
    step *= 0.5;
    for (int side = -1; side <= 1; side += 2) {
      double x = *where + side * step, here = base + curve_value(c, x);
      if (here < *value) {
        *value = here;
        *where = x;
      }
    }
  }
  return *value < least - 1e-12 * size;  // less is rounding
}

static int check_positive(const InerterDevice* device, InerterStroke stroke, double base,
                          double least, const char* what, char* message) {
  const InerterCurve* c = &device->curve[stroke];
  const InerterList* list = inerter_list(2 * stroke + (c->nvalue == 0));
  double where = 0, value = 0;
  if (!inerter_has_curve(device, stroke) || !falls_below(c, base, least, &where, &value)) {
    return 0;
  }
  snprintf(message, INERTER_MESSAGE_SIZE,
           "%s: at x = %.6g m %s is %.4g, below %g; give values and amplitudes that leave at least "
           "that along the whole stroke",
           list->name, where, what, value, least);
  return -1;
}

// curve_lower and curve_upper are there where a curve is, and only there
static int check_range(const InerterDevice* device, char* message) {
  const char* found = NULL;
  for (int i = 0; i < INERTER_NSTROKE; i++) {
    found = device->curve[i].nvalue ? inerter_list(2 * i)->name : found;
  }
  double lower = device->curve_lower, upper = device->curve_upper;
  if (!found && (!isnan(lower) || !isnan(upper))) {
    snprintf(
        message, INERTER_MESSAGE_SIZE,
        "%s is %g m, but there is no curve; give values, such as inertance_curve, or remove it",
        isnan(lower) ? "curve_upper" : "curve_lower", isnan(lower) ? upper : lower);
    return -1;
  }
  if (found && (isnan(lower) || isnan(upper))) {
    snprintf(message, INERTER_MESSAGE_SIZE,
             "%s is given, but not %s; give curve_lower and curve_upper, the x of its first and "
             "last value in m",
             found, isnan(lower) ? "curve_lower" : "curve_upper");
    return -1;
  }
  if (found &&
      !(lower < upper && isfinite(INERTER_MAXCURVE / (upper - lower)) && isfinite(upper - lower))) {
    snprintf(message, INERTER_MESSAGE_SIZE,
             "curve_lower is %g m, not below curve_upper %g m; give curve_lower < curve_upper",
             lower, upper);
    return -1;
  }
  return 0;
}

static int check_friction_curve(const InerterDevice* device, char* message) {
  int back = inerter_has_curve(device, INERTER_STROKE_friction_back);
  if (!back && !inerter_has_curve(device, INERTER_STROKE_friction)) {
    return 0;
  }
  int stroke = back ? INERTER_STROKE_friction_back : INERTER_STROKE_friction;
  const char* name = inerter_list(2 * stroke + (device->curve[stroke].nvalue == 0))->name;
  if (device->friction == INERTER_FRICTION_none) {
    snprintf(message, INERTER_MESSAGE_SIZE,
             "%s is given, but friction is \"none\": there is no level; choose a friction law or "
             "remove %s",
             name, name);
    return -1;
  }
  if (back && device->friction_asymmetry != 0) {
    snprintf(message, INERTER_MESSAGE_SIZE,
             "%s is given, and friction_asymmetry is %g: both say how the directions differ; "
             "remove one of them",
             name, device->friction_asymmetry);
    return -1;
  }
  return 0;
}

int curve_check(InerterDevice* device, char* message) {
  if (check_range(device, message) || check_friction_curve(device, message)) {
    return -1;
  }
  for (int i = 0; i < INERTER_NSTROKE; i++) {
    if (device->curve[i].nvalue) {
      fit(&device->curve[i], device->curve_lower, device->curve_upper);
    }
  }
  const char* level = "the friction level, relative to what is stated,";
  const char* inertance = "the inertance, relative to what is stated,";
  return check_positive(device, INERTER_STROKE_friction, 1, kLeastLevel, level, message) ||
                 check_positive(device, INERTER_STROKE_friction_back, 1, kLeastLevel, level,
                                message) ||
                 check_positive(device, INERTER_STROKE_inertance, 1, kLeastInertance, inertance,
                                message) ||
                 check_positive(device, INERTER_STROKE_inertance_back, 1, kLeastInertance,
                                inertance, message) ||
                 check_positive(device, INERTER_STROKE_viscous, device->viscous, 0,
                                "the viscous damping in N s/m", message)
             ? -1
             : 0;
}
