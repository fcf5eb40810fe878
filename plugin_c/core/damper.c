// A damper whose force is no straight line over the velocity: bump, rebound and a valve that opens.
//
//   F = (1 + kappa sgn(v)) (c D(v) + c2 v |v|)
//   D(v) = r v + (1 - r) v (1 + |v / v_k|^n)^((alpha - 1) / n)
//
// kappa damping_asymmetry, positive: stronger while x grows (rebound of a strut); v_k [m/s]
// damping_knee, 0: D = v; r damping_beyond, slope beyond the knee over that below: less than 1
// digressive, more progressive; n damping_sharpness, 2: gently, the larger the nearer to a corner
// at v_k between two straight lines; alpha damping_exponent: what bends grows as |v|^alpha beyond
// the knee, 0: it levels off, 0.3, say: a silicone damper, -1: an eddy-current brake, whose force
// falls; for v < 0 damping_knee_back and damping_beyond_back, a valve of its own; c [N s/m] viscous
// (c(x) along the stroke), c2 quadratic_damping. Passive for |kappa| < 1, r >= 0. The force is
// continuous, its slope jumps at v = 0 with kappa. With n = 2 and alpha = -1 the brake of Smythe
// (1942), otherwise the viscosity of Carreau (1972) and Yasuda (1979). Behind a spring, which makes
// its curve a loop: damper_spring.c. Not modelled: cavitation.

#include "laws.h"

// v where it is small, as |v|^alpha where it is large
static double bend(const InerterDevice* p, double knee, double v) {
  double ratio = fabs(v) / knee, n = p->damping_sharpness, lost = 1 - p->damping_exponent;
  if (n == 2 && lost == 1) {
    return v / sqrt(1 + ratio * ratio);
  }
  // of the larger one no power: it may be none that there is a number for
  return ratio <= 1 ? v * pow(1 + pow(ratio, n), -lost / n)
                    : copysign(knee, v) * pow(ratio, p->damping_exponent) *
                          pow(1 + pow(ratio, -n), -lost / n);
}

// its slope over v: (1 + r^n)^(-lost / n - 1) (1 + alpha r^n), r = |v| / knee
static double bend_slope(const InerterDevice* p, double knee, double v) {
  double ratio = fabs(v) / knee, n = p->damping_sharpness, alpha = p->damping_exponent;
  double power = -(1 - alpha) / n - 1;
  if (n == 2 && alpha == 0) {
    double size = 1 + ratio * ratio;
    return 1 / (size * sqrt(size));
  }
  if (ratio <= 1) {
    double some = pow(ratio, n);
    return pow(1 + some, power) * (1 + alpha * some);
  }
  double some = pow(ratio, -n);
  return pow(ratio, alpha - 1) * pow(1 + some, power) * (some + alpha);
}

double damper_law(const InerterDevice* p, double viscous, double v) {
  double knee = v < 0 ? p->damping_knee_back : p->damping_knee;
  double bent = v;
  if (knee > 0) {
    double beyond = v < 0 ? p->damping_beyond_back : p->damping_beyond;
    bent = beyond * v + (1 - beyond) * bend(p, knee, v);
  }
  double force = viscous * bent + p->quadratic_damping * fabs(v) * v;
  double side = v < 0 ? -p->damping_asymmetry : p->damping_asymmetry;
  return force * (1 + side);
}

double damper_slope(const InerterDevice* p, double viscous, double v) {
  double knee = v < 0 ? p->damping_knee_back : p->damping_knee;
  double bent = 1;
  if (knee > 0) {
    double beyond = v < 0 ? p->damping_beyond_back : p->damping_beyond;
    bent = beyond + (1 - beyond) * bend_slope(p, knee, v);
  }
  double slope = viscous * bent + 2 * p->quadratic_damping * fabs(v);
  double side = v < 0 ? -p->damping_asymmetry : p->damping_asymmetry;
  return slope * (1 + side);
}

double damper_shaped(const InerterDevice* p, double viscous, double v) {
  return damper_law(p, viscous, v) - p->damping_held * v;
}

double damper_over_step(const InerterDevice* p, double viscous, double v, double v1) {
  // where it falls with the speed, by the slope to where it is: the step has one solution
  if (p->damping_exponent >= 0) {
    return damper_shaped(p, viscous, v1);
  }
  double nearly = fabs(v) > 1e-100 ? v : copysign(1e-100, v1);
  return damper_shaped(p, viscous, nearly) / nearly * v1;
}

// slopes of c over the velocity at rest and far beyond the knees, while x grows and while it
// shrinks
static void slopes_of(const InerterDevice* p, double slopes[4]) {
  double forth = p->viscous * (1 + p->damping_asymmetry);
  double back = p->viscous * (1 - p->damping_asymmetry);
  slopes[0] = forth;
  slopes[1] = back;
  slopes[2] = p->damping_knee > 0 ? forth * p->damping_beyond : forth;
  slopes[3] = p->damping_knee_back > 0 ? back * p->damping_beyond_back : back;
}

double inerter_steepest_damping(const InerterDevice* p) {
  double s[4];
  slopes_of(p, s);
  return fmax(fmax(s[0], s[1]), fmax(s[2], s[3]));
}

double inerter_flattest_damping(const InerterDevice* p) {
  double s[4];
  slopes_of(p, s);
  return fmin(fmin(s[0], s[1]), fmin(s[2], s[3]));
}
