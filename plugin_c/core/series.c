// Series element between the terminals and the flywheel: spring, damper, backlash or slip.
//
//   y = x - s,   s' = v - w,   B(y, w) w' + R(y, w) + G(y, w) = F_s
//   d = s - gap,   |gap| <= eps
//   phi(d) = k_s (1 + q d) d, constant from where its tangent would turn negative (1 + 2 q d < 0)
//   F_s = phi(d) + c_s (s' - gap')
//   gap = +eps: gap' = min(0, s' + phi / c_s);  -eps: max(0, ...);  between: gap' = s' + phi / c_s
//   with slip in the place of a play (clutch.c): d = s - p,  F_s = phi(d) + c_s (s' - p')
//
// s [m] deflection with the play, w [m/s] velocity of the flywheel, gap [m] position in the play, d
// [m] deflection of the spring; k_s [N/m] series_stiffness, c_s [N s/m] series_damping, q [1/m]
// series_hardening, eps [m] backlash, half of the play. F_s lengthens. Stored energy: integral of
// phi; heat c_s d'^2. Within the play F_s = 0 and the spring relaxes against its damper. Without
// damper that takes no time: gap = s clamped to the play, F_s a dead zone. Without stiffness the
// damper alone is in series, without either what slips alone: F_s = S(s').
// Why contact ends at the force's sign and not at a position: the damper of a plain dead zone pulls
// the sides together as they part.
// Source: Nordin, Galic, Gutman 1997; the release set of Wang & Su 2008, eq. (7).
// Not modelled: friction within the play, impact losses beyond c_s, inertia of the shaft.

#include "series.h"

#include <stdio.h>

enum { S, W, GAP };  // places in z

Tangent series_spring(const InerterDevice* p, double d) {
  double relative = 1 + 2 * p->series_hardening * d;
  if (relative < 0) {
    return (Tangent){-0.25 * p->series_stiffness / p->series_hardening, 0};
  }
  return (Tangent){p->series_stiffness * (1 + p->series_hardening * d) * d,
                   p->series_stiffness * relative};
}

// gap', or p'
static double gap_rate(const InerterDevice* p, double v, const double* z) {
  double rate = v - z[W];
  if (has(p, PART_CLUTCH)) {
    return clutch_rate(p, series_spring(p, z[S] - z[GAP]).value, rate);
  }
  if (p->series_damping == 0) {
    return fabs(z[S]) < p->backlash ? rate : 0;
  }
  rate += series_spring(p, z[S] - series_gap(p, z)).value / p->series_damping;
  if (z[GAP] >= p->backlash) {
    return fmin(0, rate);
  }
  return z[GAP] <= -p->backlash ? fmax(0, rate) : rate;
}

double series_force(const InerterDevice* p, double v, const double* z) {
  if (has(p, PART_CLUTCH)) {
    return clutch_carries(p, series_spring(p, z[S] - z[GAP]).value, v - z[W]);
  }
  double force = series_spring(p, z[S] - series_gap(p, z)).value + p->series_damping * (v - z[W]);
  if (!has(p, PART_BACKLASH) || p->series_damping == 0) {
    return force;
  }
  if (z[GAP] >= p->backlash) {
    return fmax(0, force);
  }
  return z[GAP] <= -p->backlash ? fmin(0, force) : 0;
}

void series_rate(const InerterDevice* p, double x, double v, const double* z, double drag,
                 double* rate) {
  double rest, y = x - z[S], inertance = inertance_felt(p, y, z[W], &rest);
  rest += flywheel_force(p, y, z[W]);
  rate[S] = v - z[W];
  rate[W] = (series_force(p, v, z) - drag - rest) / inertance;
  if (series_count(p) > GAP) {
    rate[GAP] = gap_rate(p, v, z);
  }
}

double series_energy(const InerterDevice* p, const double* z) {
  double d = z[S] - series_gap(p, z), q = p->series_hardening, inside = d, beyond = 0;
  if (1 + 2 * q * d < 0) {
    inside = -0.5 / q;
    beyond = series_spring(p, d).value * (d - inside);
  }
  return p->series_stiffness * (0.5 + q * inside / 3) * inside * inside + beyond;
}

double series_heat(const InerterDevice* p, double v, const double* z) {
  double rate = v - z[W], slip = series_count(p) > GAP ? gap_rate(p, v, z) : 0;
  if (has(p, PART_CLUTCH)) {
    double force = series_force(p, v, z), spring = series_spring(p, z[S] - z[GAP]).value;
    return (force - spring) * (rate - slip) + force * slip;
  }
  return p->series_damping * (rate - slip) * (rate - slip);
}

int series_valid(const InerterDevice* p, const double* z, char* message) {
  double d = z[S] - series_gap(p, z);
  if (1 + 2 * p->series_hardening * d < 0) {
    snprintf(
        message, INERTER_MESSAGE_SIZE,
        "series spring: deflection %g m is beyond %g m, where series_hardening %g 1/m lets its "
        "tangent vanish; lower series_hardening or raise series_stiffness",
        d, -0.5 / p->series_hardening, p->series_hardening);
    return 0;
  }
  return 1;
}

void series_of_force(const InerterDevice* p, double v, double force, double* z) {
  double k = p->series_stiffness, q = p->series_hardening;
  z[S] = 0;
  z[W] = v;
  if (has(p, PART_CLUTCH)) {
    z[GAP] = 0;
    double held = clutch_limit(p, force);
    if (p->leak_damping > 0 || p->leak_quadratic_damping > 0) {
      z[W] -= clutch_speed(p, 1, 0, force);
    } else {
      force = clamp(force, -held, held);
    }
  }
  if (k == 0) {
    z[W] -= p->series_damping > 0 ? force / p->series_damping : 0;
    return;
  }

  // phi(d) = force; beyond what the spring can bear, the deflection where it bears most
  double gap = has(p, PART_BACKLASH) ? sign(force) * p->backlash : 0;
  double square = fmax(0, 1 + 4 * q * force / k);
  z[S] = gap + 2 * force / k / (1 + sqrt(square));
  if (has(p, PART_BACKLASH)) {
    z[GAP] = gap;
  }
}
