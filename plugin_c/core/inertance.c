// Inertance that varies along the stroke and with speed.
//
//   force = B(y, w) w' + R(y, w),   B = b X(y) V(w),   R = b X'(y) E(w)
//   X = max(0.01, 1 + gradient y + curvature y^2 + curve(y))
//   V = max(0.01, 1 + g |w|)
//   E = integral from 0 to w of u V(u) du = w^2 / 2 + g |w|^3 / 3
//
// y, w: displacement [m], velocity [m/s] of the flywheel; b [kg] inertance; gradient [1/m]
// inertance_gradient, curvature [1/m^2] inertance_curvature, g [s/m] inertance_speed_gradient.
// curve: curve.c; another one for w < 0 where the directions differ, as the flanks of teeth do: B
// jumps where w = 0, where there is no energy to change. Positive force lengthens. Stored energy b
// X E; R makes the force keep it: F w = d(b X E)/dt. Where a floor holds, X' = 0, and V stays 0.01.
// Source: Lagrange with the co-energy whose momentum is b X P(w), P' = V. With g = 0 this is
// b(x) a + b'(x) v^2 / 2 of a ball screw of varying lead.
// Not modelled: an inertance that depends on the history of the motion.

#include <stdio.h>

#include "elementary.h"
#include "laws.h"

static const double kFloor = 0.01;

// X, with its slope
static Tangent along_stroke(const InerterDevice* p, double y, double w) {
  double linear = p->inertance_gradient, square = p->inertance_curvature;
  double factor = 1 + (linear + square * y) * y, slope = linear + 2 * square * y;
  if (has(p, PART_INERTANCE_CURVE)) {
    int back = has(p, PART_INERTANCE_BACK) && w < 0;
    Tangent curve =
        curve_at(&p->curve[back ? INERTER_STROKE_inertance_back : INERTER_STROKE_inertance], y);
    factor += curve.value;
    slope += curve.slope;
  }
  if (factor < kFloor) {
    return (Tangent){kFloor, 0};
  }
  return (Tangent){factor, slope};
}

// E
static double kinetic(const InerterDevice* p, double w) {
  double g = p->inertance_speed_gradient, square = w * w;
  if (g == 0) {
    return 0.5 * square;
  }
  double edge = (kFloor - 1) / g;  // where V meets its floor
  if (g > 0 || fabs(w) <= edge) {
    return (0.5 + g * fabs(w) / 3) * square;
  }
  return (0.5 + g * edge / 3) * edge * edge + 0.5 * kFloor * (square - edge * edge);
}

static double resisting(const InerterDevice* p, double slope, double w) {
  return slope != 0 ? p->inertance * slope * kinetic(p, w) : 0;
}

double inertance_felt(const InerterDevice* p, double y, double w, double* rest) {
  Tangent stroke = along_stroke(p, y, w);
  if (rest) {
    *rest = resisting(p, stroke.slope, w);
  }
  return p->inertance * stroke.value * fmax(kFloor, 1 + p->inertance_speed_gradient * fabs(w));
}

SEVERAL_AT_ONCE void forces_of_inertance(const InerterDevice* p, int n, const double* y,
                                         const double* w, const double* acceleration,
                                         double* restrict force) {
  if (p->inertance_speed_gradient != 0 || has(p, PART_INERTANCE_BACK)) {
    for (int i = 0; i < n; i++) {
      double rest, inertance = inertance_felt(p, y[i], w[i], &rest);
      force[i] = inertance * acceleration[i] + rest;
    }
    return;
  }
  double value[FRICTION_BLOCK], rise[FRICTION_BLOCK], linear = p->inertance_gradient;
  curve_at_samples(&p->curve[INERTER_STROKE_inertance], n, y, value, rise);
  for (int i = 0; i < n; i++) {
    double factor = 1 + (linear + p->inertance_curvature * y[i]) * y[i] + value[i];
    double slope = linear + 2 * p->inertance_curvature * y[i] + rise[i];
    slope = factor < kFloor ? 0 : slope;
    factor = factor < kFloor ? kFloor : factor;
    double rest = p->inertance * slope * (0.5 * (w[i] * w[i]));
    force[i] = p->inertance * factor * acceleration[i] + rest;
  }
}

double inertance_energy(const InerterDevice* p, double y, double w) {
  return p->inertance * along_stroke(p, y, w).value * kinetic(p, w);
}

int inertance_valid(const InerterDevice* p, double y, char* message) {
  double factor = 1 + (p->inertance_gradient + p->inertance_curvature * y) * y;
  if (has(p, PART_INERTANCE_CURVE)) {
    double forth = curve_value(&p->curve[INERTER_STROKE_inertance], y), back = forth;
    if (has(p, PART_INERTANCE_BACK)) {
      back = curve_value(&p->curve[INERTER_STROKE_inertance_back], y);
    }
    factor += fmin(forth, back);
    if (factor < kFloor) {
      snprintf(message, INERTER_MESSAGE_SIZE,
               "at x = %g m the curves and periods of the inertance, with inertance_gradient %g "
               "1/m and inertance_curvature %g 1/m^2, leave %.2g of the inertance; below %g it is "
               "held there: fit them to the whole stroke",
               y, p->inertance_gradient, p->inertance_curvature, factor, kFloor);
    }
  }
  if (factor >= kFloor) {
    return 1;
  }
  if (has(p, PART_INERTANCE_CURVE)) {
    return 0;
  }
  snprintf(
      message, INERTER_MESSAGE_SIZE,
      "at x = %g m, inertance_gradient %g 1/m and inertance_curvature %g 1/m^2 leave %.2g of the "
      "inertance; below %g it is held there: fit them to the whole stroke",
      y, p->inertance_gradient, p->inertance_curvature, factor, kFloor);
  return 0;
}
