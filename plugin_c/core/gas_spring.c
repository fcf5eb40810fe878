// Gas spring: an enclosed volume that the piston changes, the pressure p0 outside.
//
//   polytropic: F = p0 A (1 - r^-gamma),  r = 1 + A y / V0
//   expanded:   F = k (1 - (gamma + 1) / 2 (A / V0) y) y,  k = gamma p0 A^2 / V0
//
// y [m] displacement of the flywheel side; p0 [Pa] gas_pressure, A [m^2] gas_area, V0 [m^3]
// gas_volume at y = 0, gamma gas_exponent. F is the force that lengthens: tension where the gas is
// thin. Stored energy: the integral of F from 0 to y, with the work of the atmosphere.
// A < 0: the gas is on the other side of the piston, and y and F have the other sign.
// Range: r > 0.05, below which the polytropic law goes on along its tangent. The expanded law is
// the second order of the other one; beyond y = V0 / ((gamma + 1) A), where its tangent would turn
// negative, its force stays.
// Source: polytropic change of state; expanded: as the fluid inerter paper prints it (it turns
// negative itself at twice that y).
// Not modelled: heat exchange (gamma is constant), mass of the gas, leakage.

#include <stdio.h>

#include "laws.h"

static const double kSmallest = 0.05;  // relative volume

// relative volume
static double volume_at(const InerterDevice* p, double y) {
  return 1 + p->gas_area * y / p->gas_volume;
}

// |y| at which the tangent of the expanded law turns negative
static double turning(const InerterDevice* p) {
  return p->gas_volume / ((p->gas_exponent + 1) * fabs(p->gas_area));
}

// y that makes the gas grow, with its force and energy
static double growing(const InerterDevice* p, double y) {
  return p->gas_area < 0 ? -y : y;
}

static double expanded(const InerterDevice* p, double y) {
  double ratio = fabs(p->gas_area) / p->gas_volume;
  double stiffness = p->gas_exponent * p->gas_pressure * fabs(p->gas_area) * ratio;
  y = fmin(y, turning(p));
  return stiffness * (1 - 0.5 * (p->gas_exponent + 1) * ratio * y) * y;
}

// integral of the expanded law up to y
static double expanded_energy(const InerterDevice* p, double y) {
  double ratio = fabs(p->gas_area) / p->gas_volume;
  double stiffness = p->gas_exponent * p->gas_pressure * fabs(p->gas_area) * ratio;
  double inside = fmin(y, turning(p));
  double energy = stiffness * (0.5 - (p->gas_exponent + 1) * ratio * inside / 6) * inside * inside;
  return y > inside ? energy + expanded(p, y) * (y - inside) : energy;
}

double gas_force(const InerterDevice* p, double y) {
  if (p->gas_law == INERTER_GAS_expanded) {
    return growing(p, expanded(p, growing(p, y)));
  }
  double volume = volume_at(p, y), inside = fmax(volume, kSmallest);
  double power = pow(inside, -p->gas_exponent);
  double tangent = p->gas_exponent * power / inside;
  return p->gas_pressure * p->gas_area * (1 - power + tangent * (volume - inside));
}

double gas_energy(const InerterDevice* p, double y) {
  if (p->gas_law == INERTER_GAS_expanded) {
    return expanded_energy(p, growing(p, y));
  }
  double volume = volume_at(p, y), inside = fmax(volume, kSmallest), beyond = volume - inside;
  double rest = 1 - p->gas_exponent, height = log(inside);
  double compressed = rest == 0 ? height : expm1(rest * height) / rest;
  double power = pow(inside, -p->gas_exponent);
  double tangent = p->gas_exponent * power / inside;
  return p->gas_pressure * p->gas_volume *
         (inside - 1 - compressed + (1 - power + 0.5 * tangent * beyond) * beyond);
}

int gas_valid(const InerterDevice* p, double y, char* message) {
  double volume = volume_at(p, y);
  if (!(volume > kSmallest)) {
    snprintf(message, INERTER_MESSAGE_SIZE,
             "gas spring: its volume is %.3g of gas_volume at displacement %g m, below the limit "
             "%g; enlarge gas_volume or set %s",
             volume, y, kSmallest, p->gas_area < 0 ? "stop_upper" : "stop_lower");
    return 0;
  }
  if (p->gas_law == INERTER_GAS_expanded && growing(p, y) > turning(p)) {
    snprintf(message, INERTER_MESSAGE_SIZE,
             "gas spring: displacement %g m is beyond %g m, where the expanded law ends; choose "
             "gas_law \"polytropic\"",
             y, growing(p, turning(p)));
    return 0;
  }
  return 1;
}
