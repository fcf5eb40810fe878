// The part of a series element that slips: a clutch, or a fluid that leaks past its piston.
//
//   F_s = S(u),  |S| = F_c + c_l |u| + q_l u^2,  sign(S) = sign(u);   u = 0 where |F_s| <= F_c
//   F_c = clutch_force (1 + clutch_asymmetry sign(F_s)),  p' = u
//
// F_s [N] force through the element (series.c), u [m/s] and p [m] velocity and way of the slip,
// c_l leak_damping [N s/m], q_l leak_quadratic_damping [N s^2/m^2]. Heat F_s u. With an asymmetry
// of 1 or -1 a one-way clutch: it holds in one direction alone. Source: the parallel connection of
// a leak, laminar or turbulent, with the channel of a fluid inerter adds their flows; a clutch is
// the torque limiter of Coulomb. Not modelled: a breakaway force above the sliding one, the time
// that a clutch takes to engage.

#include "series.h"

double clutch_limit(const InerterDevice* p, double force) {
  return p->clutch_force * (1 + p->clutch_asymmetry * sign(force));
}

double clutch_law(const InerterDevice* p, double u) {
  double speed = fabs(u);
  double rising = (p->leak_damping + p->leak_quadratic_damping * speed) * speed;
  return sign(u) * (clutch_limit(p, u) + rising);
}

double clutch_slope(const InerterDevice* p, double u) {
  return p->leak_damping + 2 * p->leak_quadratic_damping * fabs(u);
}

double clutch_speed(const InerterDevice* p, double weight, double damping, double force) {
  double beyond = fabs(force) - weight * clutch_limit(p, force);
  if (!(beyond > 0)) {
    return 0;
  }
  double line = weight * p->leak_damping + damping;
  double root = sqrt(line * line + 4 * weight * p->leak_quadratic_damping * beyond);
  return sign(force) * 2 * beyond / (line + root);
}

double clutch_rate(const InerterDevice* p, double spring, double rate) {
  double damping = p->series_damping;
  if (p->series_stiffness == 0 && damping == 0) {
    return rate;
  }
  return clutch_speed(p, 1, damping, spring + damping * rate);
}

double clutch_carries(const InerterDevice* p, double spring, double rate) {
  double damping = p->series_damping;
  if (p->series_stiffness == 0 && damping == 0) {
    return clutch_law(p, rate);
  }
  return spring + damping * (rate - clutch_rate(p, spring, rate));
}
