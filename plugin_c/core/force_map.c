// A force over displacement and velocity that has no law: a restoring-force surface.
//
//   F(x, v) = sum over i, j of c_ij B(s - i) B(t - j),   B the cubic B-spline, two derivatives
//   s = (x - lower) / dx,     rows at evenly spaced x from force_map_lower to force_map_upper
//   t = (w(v) + w(V)) / dw,   columns at evenly spaced w from -V to V = force_map_speed
//   w(v) = asinh(v / scale),  fine near v = 0 and coarse at speed;  w = v without force_map_scale
//   c_ij: F runs through the values at rows and columns, with slope 0 at the four edges
//   F = S(x) + D(x, v),  S(x) = F(x, 0);  force_map_passive: D counts only where D v > 0
//
// x [m] displacement, v [m/s]; F [N], tension positive; scale [m/s] force_map_scale. Beyond the
// edges it goes on as the value of the edge: bounded, whatever the motion. Stored energy: the
// integral of S from 0; heat: D v, which may be negative where a map is not passive. Range: 2 to 24
// rows, 2 to 16 columns. Why: what a machine repeats and nobody can name is kept without a cause;
// splines through values keep two derivatives, so that RK4 keeps its order. Source: Masri and
// Caughey 1979 (the surface), de Boor (splines). Not modelled: memory; jumps at v = 0, which are
// for a friction law; steps smaller than the distance of rows and columns.

#include <math.h>
#include <stdio.h>

#include "laws.h"

enum { STRIDE = INERTER_MAXSPEED + 2 };

// w(v), and how it rises
static Tangent stretched(const InerterDevice* p, double v) {
  if (isnan(p->force_map_scale)) {
    return (Tangent){v, 1};
  }
  double ratio = v / p->force_map_scale;
  return (Tangent){asinh(ratio), 1 / (p->force_map_scale * hypot(1, ratio))};
}

// place along an axis: first of four coefficients, their weights, and what these rise by; constant
// beyond the edges
static int weigh(double at, int count, double weight[4], double rise[4]) {
  int last = count - 2, i = at > 0 ? (at < last ? (int)at : last) : 0;
  double u = clamp(at - i, 0, 1), w = 1 - u, square = u * u, cube = square * u;
  weight[0] = w * w * w / 6;
  weight[1] = (3 * cube - 6 * square + 4) / 6;
  weight[2] = (3 * (square - cube + u) + 1) / 6;
  weight[3] = cube / 6;
  int inside = at > 0 && at < count - 1;
  rise[0] = -0.5 * w * w * inside;
  rise[1] = (1.5 * square - 2 * u) * inside;
  rise[2] = (0.5 + u - 1.5 * square) * inside;
  rise[3] = 0.5 * square * inside;
  return i;
}

Tangent map_force(const InerterDevice* p, double x, double v) {
  const InerterMap* m = &p->map;
  double wx[4], rx[4], wv[4], rv[4];
  Tangent speed = stretched(p, v);
  int i = weigh((x - p->force_map_lower) * m->rate, m->nplace, wx, rx);
  int j = weigh((speed.value + m->edge) * m->speed_rate, m->nspeed, wv, rv);
  Tangent force = {0, 0};
  for (int k = 0; k < 4; k++) {
    const double* c = m->fit + (i + k) * STRIDE + j;
    force.value += wx[k] * (c[0] * wv[0] + c[1] * wv[1] + c[2] * wv[2] + c[3] * wv[3]);
    force.slope += wx[k] * (c[0] * rv[0] + c[1] * rv[1] + c[2] * rv[2] + c[3] * rv[3]);
  }
  force.slope *= m->speed_rate * speed.slope;
  if (p->force_map_passive != 0) {
    double still = curve_value(&m->still, x);
    if (!((force.value - still) * v > 0)) {
      return (Tangent){still, 0};
    }
  }
  return force;
}

double map_energy(const InerterDevice* p, double x) {
  return curve_integral(&p->map.still, x);
}

double map_heat(const InerterDevice* p, double x, double v) {
  return (map_force(p, x, v).value - curve_value(&p->map.still, x)) * v;
}

double inerter_map_steepest(const InerterDevice* p, double* over_speed) {
  const InerterMap* m = &p->map;
  double steepest = 0;
  *over_speed = 0;
  for (int i = 0; m->nplace && i < m->nplace + 2; i++) {
    for (int j = 0; j < m->nspeed + 2; j++) {
      const double* c = m->fit + i * STRIDE + j;
      if (i) steepest = fmax(steepest, fabs(c[0] - c[-STRIDE]) * m->rate);
      if (j) *over_speed = fmax(*over_speed, fabs(c[0] - c[-1]) * m->speed_rate);
    }
  }
  *over_speed *= stretched(p, 0).slope;
  return steepest;
}

//------------------------------ configuration -----------------------------------------------------

// the coefficients, along the columns and then along the rows; S(x) beside them
static void fit(InerterDevice* p) {
  InerterMap* m = &p->map;
  double row[INERTER_MAXPLACE], line[INERTER_MAXPLACE + 2];
  m->rate = (m->nplace - 1) / (p->force_map_upper - p->force_map_lower);
  m->edge = stretched(p, p->force_map_speed).value;
  m->speed_rate = (m->nspeed - 1) / (2 * m->edge);
  for (int i = 0; i < m->nplace; i++) {
    curve_coefficients(m->nspeed, m->value + i * m->nspeed, m->fit + (i + 1) * STRIDE);
  }
  double weight[4], rise[4];
  int first = weigh(m->edge * m->speed_rate, m->nspeed, weight, rise);
  m->still.nvalue = m->nplace;
  m->still.lower = p->force_map_lower;
  m->still.rate = m->rate;
  for (int i = 0; i < m->nplace; i++) {
    const double* c = m->fit + (i + 1) * STRIDE + first;
    m->still.value[i] = c[0] * weight[0] + c[1] * weight[1] + c[2] * weight[2] + c[3] * weight[3];
  }
  curve_coefficients(m->nplace, m->still.value, m->still.fit);
  for (int j = 0; j < m->nspeed + 2; j++) {
    for (int i = 0; i < m->nplace; i++) {
      row[i] = m->fit[(i + 1) * STRIDE + j];
    }
    curve_coefficients(m->nplace, row, line);
    for (int i = 0; i < m->nplace + 2; i++) {
      m->fit[i * STRIDE + j] = line[i];
    }
  }
}

// a parameter of the map that is given without one, or missing beside one; NULL: neither
static const char* odd_one(const InerterDevice* p) {
  int there = p->map.nvalue > 0;
  const char* names[] = {"force_map_lower", "force_map_upper", "force_map_speed",
                         "force_map_columns"};
  const double values[] = {p->force_map_lower, p->force_map_upper, p->force_map_speed,
                           p->force_map_columns};
  for (int i = 0; i < 4; i++) {
    if (isnan(values[i]) ? there : !there) return names[i];
  }
  if (there) return NULL;
  if (!isnan(p->force_map_scale)) return "force_map_scale";
  return p->force_map_passive != 0 ? "force_map_passive" : NULL;
}

int map_check(InerterDevice* p, char* message) {
  InerterMap* m = &p->map;
  const char* odd = odd_one(p);
  if (odd) {
    snprintf(message, INERTER_MESSAGE_SIZE,
             m->nvalue ? "force_map is given, but not %s; give force_map_lower, force_map_upper, "
                         "force_map_speed and force_map_columns"
                       : "%s is given, but there is no force_map; give its values or remove it",
             odd);
    return -1;
  }
  if (!m->nvalue) {
    return 0;
  }
  double lower = p->force_map_lower, upper = p->force_map_upper, columns = p->force_map_columns;
  if (!(lower < upper && isfinite(INERTER_MAXPLACE / (upper - lower)) && isfinite(upper - lower))) {
    snprintf(message, INERTER_MESSAGE_SIZE,
             "force_map_lower is %g m, not below force_map_upper %g m; give force_map_lower < "
             "force_map_upper",
             lower, upper);
    return -1;
  }
  int whole = (int)columns;
  if (columns != whole || m->nvalue % whole || m->nvalue / whole < 2 ||
      m->nvalue / whole > INERTER_MAXPLACE) {
    snprintf(message, INERTER_MESSAGE_SIZE,
             "force_map has %d numbers and force_map_columns is %g; give rows x columns numbers, "
             "row by row, 2 to %d rows (displacements) and 2 to %d columns (velocities)",
             m->nvalue, columns, INERTER_MAXPLACE, INERTER_MAXSPEED);
    return -1;
  }
  if (p->force_map_passive != 0 && p->force_map_passive != 1) {
    snprintf(message, INERTER_MESSAGE_SIZE,
             "force_map_passive is %g; give 1 to leave out what would give energy, or 0",
             p->force_map_passive);
    return -1;
  }
  m->nspeed = whole;
  m->nplace = m->nvalue / whole;
  fit(p);
  if (!(isfinite(m->speed_rate) && m->edge > 0)) {
    snprintf(message, INERTER_MESSAGE_SIZE,
             "force_map_speed is %g m/s with force_map_scale %g m/s: too far apart; give a scale "
             "of about a tenth of the speed",
             p->force_map_speed, p->force_map_scale);
    return -1;
  }
  return 0;
}
