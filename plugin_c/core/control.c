// A control that sets a parameter within bounds, with a lag: semi-active dampers and inerters.
//
//   p  = clamp(p_0 + z, lower, upper),   z' = (clamp(u, lower, upper) - p_0 - z) / T     T > 0
//   p  = clamp(u, lower, upper)                                                         T = 0
//
// p the parameter named by `control`, in its own unit; u the command, in the same unit; p_0 the
// value that is stated, where nothing is: the default within the bounds. lower, upper
// control_lower, control_upper; T [s] control_lag. z [unit of p] control_change: all states 0 is
// the device as stated. Exact at a constant command.
//
// Energy. The laws hold at the value of the moment: F = p a of an inertance, F = p x of a spring. A
// device stores E(x, v, z; p), and its actuator gives it
//   P = dE/dp p':   p' v^2 / 2 of an inertance,  p' x^2 / 2 of a spring
// so that F v + P = dE/dt + heat. Who raises an inertance at speed pays for what it stores
// more; who lowers it is paid, and at once (T = 0) by the difference of E before and after.
// Dampers, valves and friction levels store nothing: P = 0, such a device is passive at any
// command. Why F = p a and not d(p v)/dt: it needs no rate of the command, and has no impulse where
// p jumps. It is the semi-active inerter of the control literature. One whose ratio changes without
// work has F = p a + p' v / 2, one whose flywheel's masses move F = p a + p' v; state what is
// missing by a force of your own. Source: Karnopp, Crosby, Harwood 1974 (skyhook); Hu, Chen, Shu,
// Huang 2014 (semi-active inerter). Not modelled: power and dynamics of the actuator beyond the
// lag, hysteresis of the field.

#include <stdio.h>

#include "laws.h"

// index of the parameter of each control
static const int kControlled[] = {
#define INERTER_INDEX_force (-1)
#define X(identifier, meaning) INERTER_INDEX_##identifier,
    INERTER_CONTROLS(X)
#undef X
#undef INERTER_INDEX_force
};

static double* value_of(InerterDevice* p) {
  return (double*)(void*)((char*)p + inerter_parameter(inerter_controlled(p))->offset);
}

int inerter_controlled(const InerterDevice* device) {
  return kControlled[device->control];
}

//------------------------------ the value ---------------------------------------------------------

void inerter_command(InerterDevice* device, double command, const double* z) {
  if (device->control == INERTER_CONTROL_force) {
    return;
  }
  double lower = device->control_lower, upper = device->control_upper;
  device->command = isnan(command) ? device->control_rest : clamp(command, lower, upper);
  double value = device->command;
  if (device->ncontrol) {
    double change = z ? z[control_index(device)] : 0;
    value = device->control_rest + (isnan(change) ? 0 : change);
  }
  *value_of(device) = clamp(value, lower, upper);

  // a breakaway level that is not stated is the sliding level
  if (device->control == INERTER_CONTROL_coulomb_force &&
      !inerter_is_given(device, INERTER_INDEX_static_force)) {
    device->static_force = device->coulomb_force;
  }
}

double control_rate(const InerterDevice* p, double z) {
  return (p->command - p->control_rest - z) / p->control_lag;
}

double control_step(const InerterDevice* p, double z, double h) {
  return z - expm1(-h / p->control_lag) * (p->command - p->control_rest - z);
}

// dE/dp; every energy is linear in the parameter
static double energy_per_unit(const InerterDevice* device, double x, double v, const double* z) {
  double y = stretch_of(device, x), w = v;
  if (device->control == INERTER_CONTROL_stiffness) {
    return 0.5 * y * y;
  }
  if (device->control != INERTER_CONTROL_inertance &&
      device->control != INERTER_CONTROL_bw_stiffness) {
    return 0;
  }
  InerterDevice unit = *device;
  int inertance = device->control == INERTER_CONTROL_inertance;
  if (has(device, PART_SERIES) && (inertance || has(device, PART_WHEEL_FRICTION))) {
    y -= z[series_index(device)];
    w = z[series_index(device) + 1];
  }
  *value_of(&unit) = 1;
  return inertance ? inertance_energy(&unit, y, w) : friction_energy(&unit, y, z);
}

double inerter_control_power(const InerterDevice* device, double x, double v, const double* z) {
  if (!device->ncontrol) {
    return 0;
  }
  double change = z[control_index(device)], rate = control_rate(device, change);
  double value = device->control_rest + change;
  if (value < device->control_lower || value > device->control_upper) {
    return 0;  // held at the bound
  }

  return energy_per_unit(device, x, v, z) * rate;
}

//------------------------------ configuration -----------------------------------------------------

static int check_control(InerterDevice* device, char* message) {
  const double lower = device->control_lower, upper = device->control_upper;
  if (device->control == INERTER_CONTROL_force) {
    const char* found = !isnan(lower)             ? "control_lower"
                        : !isnan(upper)           ? "control_upper"
                        : device->control_lag > 0 ? "control_lag"
                                                  : NULL;
    if (found) {
      snprintf(message, INERTER_MESSAGE_SIZE,
               "%s is given, but control is \"force\", which does not read it; remove it or "
               "choose the parameter that the control sets, such as control \"viscous\"",
               found);
    }
    return found ? -1 : 0;
  }
  const InerterParameter* p = inerter_parameter(inerter_controlled(device));
  if (isnan(lower) || isnan(upper)) {
    snprintf(message, INERTER_MESSAGE_SIZE,
             "control is \"%s\", but %s is not given; give control_lower and control_upper, "
             "between which it sets %s in %s",
             p->name, isnan(lower) ? "control_lower" : "control_upper", p->name, p->unit);
    return -1;
  }
  if (!(lower < upper && isfinite(upper - lower))) {
    snprintf(message, INERTER_MESSAGE_SIZE,
             "control_lower is %g, not below control_upper %g; give control_lower < control_upper "
             "(%s in %s)",
             lower, upper, p->name, p->unit);
    return -1;
  }
  double* value = value_of(device);
  if (!inerter_is_given(device, inerter_controlled(device))) {
    *value = isnan(*value) ? lower : clamp(*value, lower, upper);
    inerter_mark_given(device, inerter_controlled(device));
  }
  if (!(*value >= lower && *value <= upper)) {
    snprintf(message, INERTER_MESSAGE_SIZE,
             "%s is %g %s, but the control sets it from %g to %g; give a value between "
             "control_lower and control_upper, or none: then it begins at the nearer one",
             p->name, *value, p->unit, lower, upper);
    return -1;
  }
  return 0;
}

int control_check(InerterDevice* device, char* message) {
  if (check_control(device, message)) {
    return -1;
  }
  if (device->control == INERTER_CONTROL_force) {
    return 0;
  }
  const double bounds[] = {device->control_lower, device->control_upper};
  for (int i = 0; i < 2; i++) {
    InerterDevice there = *device;
    char text[INERTER_MESSAGE_SIZE];
    *value_of(&there) = bounds[i];
    if (device_check(&there, text)) {
      snprintf(message, INERTER_MESSAGE_SIZE, "%s is %g: %.400s",
               i ? "control_upper" : "control_lower", bounds[i], text);
      return -1;
    }
  }
  device->control_rest = device->command = *value_of(device);
  return 0;
}
