// Whether a configuration fits together, and what follows from it. Each message names what is
// wrong, its value, and what to do.

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "configuration.h"
#include "laws.h"
#include "series.h"

int refuse(char* message, const char* format, ...) {
  va_list values;
  va_start(values, format);
  vsnprintf(message, INERTER_MESSAGE_SIZE, format, values);
  va_end(values);
  return -1;
}

// whether a word stands in a list separated by blanks
static int listed(const char* list, const char* word) {
  size_t length = strlen(word);
  for (const char* at = list; (at = strstr(at, word)); at += length) {
    if ((at == list || at[-1] == ' ') && (at[length] == ' ' || !at[length])) {
      return 1;
    }
  }
  return 0;
}

// a parameter of another law is a mistake, not a wish to ignore
static int check_law(const InerterDevice* device, char* message) {
  const char* law = inerter_friction_name(device->friction);
  for (int i = 0; i < INERTER_NPARAMETER; i++) {
    const InerterParameter* p = inerter_parameter(i);
    if (*p->laws && inerter_is_given(device, i) && !listed(p->laws, law)) {
      return refuse(message,
                    "%s is given, but friction is \"%s\", which does not read it; remove it or "
                    "choose friction from: %s",
                    p->name, law, p->laws);
    }
  }
  return 0;
}

static int check_ranges(InerterDevice* device, char* message) {
  char range[128];
  for (int i = 0; i < INERTER_NPARAMETER; i++) {
    const InerterParameter* p = inerter_parameter(i);
    double value = *value_of(device, i);
    if (!allowed(p, value) && !(isnan(value) && isnan(p->initial))) {
      return refuse(message, "%s is %g: out of range; give %s (%s)", p->name, value,
                    range_text(p, range), p->meaning);
    }
  }
  return 0;
}

// elements of maxwell_slip: each whole, the first ones without a gap
static int check_slip(const InerterDevice* device, char* message) {
  int count = slip_count(device);
  for (int i = 0; i < INERTER_MAXSLIP; i++) {
    double stiffness = slip_element(device, i)[0], force = slip_element(device, i)[1];
    if ((stiffness > 0) != (force > 0)) {
      const char *there = stiffness > 0 ? "stiffness" : "force",
                 *missing = stiffness > 0 ? "force" : "stiffness";
      return refuse(message, "slip_%s_%d is %g %s, but slip_%s_%d is 0; give both > 0, or neither",
                    there, i + 1, stiffness > 0 ? stiffness : force, stiffness > 0 ? "N/m" : "N",
                    missing, i + 1);
    }
    if (stiffness > 0 && i >= count) {
      return refuse(message,
                    "slip_stiffness_%d is %g N/m, but slip_stiffness_%d is 0 N/m: elements "
                    "are numbered from 1 without a gap; give slip_stiffness_%d > 0 N/m",
                    i + 1, stiffness, count + 1, count + 1);
    }
  }
  return count ? 0
               : refuse(message,
                        "slip_stiffness_1 is 0 N/m, but friction is \"maxwell_slip\"; give "
                        "slip_stiffness_1 and slip_force_1 > 0 or friction \"none\"");
}

static int check_friction(const InerterDevice* device, char* message) {
  int friction = device->friction;
  if (device->static_force < device->coulomb_force) {
    return refuse(message,
                  "static_force is %g N, below coulomb_force %g N; give static_force >= "
                  "coulomb_force",
                  device->static_force, device->coulomb_force);
  }
  if (friction == INERTER_FRICTION_none) {
    return 0;
  }
  if (friction == INERTER_FRICTION_bouc_wen) {
    return device->bw_stiffness > 0
               ? 0
               : refuse(message,
                        "bw_stiffness is 0 N/m, but friction is \"bouc_wen\"; give bw_stiffness > "
                        "0 N/m or friction \"none\"");
  }
  if (friction == INERTER_FRICTION_maxwell_slip) {
    return check_slip(device, message);
  }
  int bristle = friction == INERTER_FRICTION_dahl || friction == INERTER_FRICTION_lugre;
  if (!bristle && (device->control == INERTER_CONTROL_coulomb_force ||
                   device->control == INERTER_CONTROL_static_force)) {
    return 0;  // a clutch may be open
  }
  if ((bristle ? device->coulomb_force : device->static_force) <= 0) {
    return refuse(message,
                  "coulomb_force is 0 N, but friction is \"%s\"; give coulomb_force > 0 N or "
                  "friction \"none\"",
                  inerter_friction_name(friction));
  }
  return 0;
}

// one load friction, or one for each direction of power
static int check_load(InerterDevice* device, char* message) {
  double* both[] = {&device->mu_forward, &device->mu_backward};
  for (int i = 0; i < 2; i++) {
    const char* name = i ? "mu_backward" : "mu_forward";
    if (isnan(*both[i])) {
      *both[i] = device->load_friction;
    } else if (device->load_friction > 0 && *both[i] != device->load_friction) {
      return refuse(message,
                    "%s is %g, but load_friction is %g; state mu_forward and mu_backward, or "
                    "load_friction for both",
                    name, *both[i], device->load_friction);
    }
  }

  // a load raises the force at which Bouc-Wen yields: there has to be one
  if (device->friction == INERTER_FRICTION_bouc_wen && inerter_has_load_friction(device)) {
    double narrow = device->bw_beta + device->bw_gamma;
    double mu = fmax(device->mu_forward, device->mu_backward);
    if (!(narrow > 0)) {
      return refuse(message,
                    "load friction is %g, but bw_beta + bw_gamma is %g: this bouc_wen never "
                    "yields, so that no load can raise where it does; give bw_beta + bw_gamma > 0, "
                    "or remove the load friction",
                    mu, narrow);
    }
    if (device->bw_ratio == 1) {
      return refuse(
          message,
          "load friction is %g, but bw_ratio is 1: no share of this bouc_wen yields, so that "
          "no load can raise where it does; give bw_ratio < 1, or remove the load friction",
          mu);
    }
  }
  return 0;
}

static int check_branches(const InerterDevice* device, char* message) {
  int count = branch_count(device);
  for (int i = 0; i < INERTER_MAXBRANCH; i++) {
    double stiffness = branch_element(device, i)[0], damping = branch_element(device, i)[1];
    if ((stiffness > 0) != (damping > 0)) {
      return refuse(message,
                    "branch_stiffness_%d is %g N/m and branch_damping_%d %g N*s/m: half a branch; "
                    "give both > 0, or neither",
                    i + 1, stiffness, i + 1, damping);
    }
    if (stiffness > 0 && i >= count) {
      return refuse(message,
                    "branch_stiffness_%d is %g N/m, but branch_stiffness_%d is 0 N/m: "
                    "branches are numbered from 1 without a gap; give branch_stiffness_%d > 0 N/m",
                    i + 1, stiffness, count + 1, count + 1);
    }
  }
  return 0;
}

static int check_damper_spring(const InerterDevice* device, char* message) {
  double stiffness = device->damper_stiffness;
  if (stiffness == 0) {
    return 0;
  }
  if (device->control == INERTER_CONTROL_viscous ||
      device->control == INERTER_CONTROL_quadratic_damping) {
    return refuse(message,
                  "damper_stiffness is %g N/m and control is \"%s\": dampers behind a spring "
                  "cannot be set by a control; remove one of the two",
                  stiffness, inerter_control_name(device->control));
  }
  if (inerter_has_curve(device, INERTER_STROKE_viscous)) {
    return refuse(message,
                  "damper_stiffness is %g N/m, and viscous changes along the stroke: dampers "
                  "behind a spring cannot; remove damper_stiffness or viscous_curve and "
                  "viscous_periods",
                  stiffness);
  }
  if (device->viscous == 0) {
    return refuse(message,
                  "damper_stiffness is %g N/m, but viscous is 0 N*s/m: behind the spring there is "
                  "nothing that holds it at rest; give viscous > 0 N*s/m or remove "
                  "damper_stiffness",
                  stiffness);
  }
  if (device->damping_exponent < 0 && (device->damping_knee > 0 || device->damping_knee_back > 0)) {
    return refuse(message,
                  "damper_stiffness is %g N/m and damping_exponent %g: damping that falls with the "
                  "speed has no steady motion behind a spring; give damping_exponent >= 0 or "
                  "remove damper_stiffness",
                  stiffness, device->damping_exponent);
  }
  return 0;
}

static int check_stops(const InerterDevice* device, char* message) {
  int lower = !isnan(device->stop_lower), upper = !isnan(device->stop_upper);
  if (!lower && !upper) {
    const int needy[] = {INERTER_INDEX_stop_stiffness, INERTER_INDEX_stop_stiffness_cubic,
                         INERTER_INDEX_stop_damping};
    const double values[] = {device->stop_stiffness, device->stop_stiffness_cubic,
                             device->stop_damping};
    for (int i = 0; i < 3; i++) {
      const InerterParameter* p = inerter_parameter(needy[i]);
      if (values[i] > 0) {
        return refuse(message,
                      "%s is %g %s, but there is no stop; give stop_lower or stop_upper, or remove "
                      "%s",
                      p->name, values[i], p->unit, p->name);
      }
    }
    return 0;
  }
  if (device->stop_stiffness <= 0) {
    const char* name = lower ? "stop_lower" : "stop_upper";
    return refuse(message,
                  "%s is %g m, but stop_stiffness is 0 N/m; give stop_stiffness > 0 N/m or remove "
                  "%s",
                  name, lower ? device->stop_lower : device->stop_upper, name);
  }
  if (device->stop_lower >= device->stop_upper) {
    return refuse(message,
                  "stop_lower is %g m, not below stop_upper %g m; give stop_lower < stop_upper",
                  device->stop_lower, device->stop_upper);
  }
  return 0;
}

static int check_gas(InerterDevice* device, char* message) {
  if (device->gas_pressure == 0) {
    const int needy[] = {INERTER_INDEX_gas_area, INERTER_INDEX_gas_volume,
                         INERTER_INDEX_gas_exponent};
    const char* found = inerter_is_given(device, INERTER_INDEX_gas_law) ? "gas_law" : NULL;
    for (int i = 0; i < 3; i++) {
      if (inerter_is_given(device, needy[i]) && *value_of(device, needy[i]) != 0) {
        found = inerter_parameter(needy[i])->name;
      }
    }
    return found ? refuse(message,
                          "%s is given, but gas_pressure is 0 Pa: there is no gas spring; give "
                          "gas_pressure > 0 Pa or remove %s",
                          found, found)
                 : 0;
  }
  if (isnan(device->gas_area)) {
    device->gas_area = device->piston_area;
  }
  if (device->gas_area == 0) {
    return refuse(message,
                  "gas_area is %s, but gas_pressure is %g Pa; give a gas_area other than 0 m^2 (or "
                  "piston_area) or remove gas_pressure",
                  inerter_is_given(device, INERTER_INDEX_gas_area) ? "0 m^2" : "unset",
                  device->gas_pressure);
  }
  if (device->gas_volume == 0) {
    return refuse(message,
                  "gas_volume is 0 m^3, but gas_pressure is %g Pa; give gas_volume > 0 m^3 or "
                  "remove gas_pressure",
                  device->gas_pressure);
  }
  return 0;
}

// the channel's geometry is there as a whole or not at all; it gives the inertance
static int check_channel(InerterDevice* device, char* message) {
  const int geometry[] = {INERTER_INDEX_piston_area, INERTER_INDEX_channel_area,
                          INERTER_INDEX_channel_length};
  const int others[] = {INERTER_INDEX_channel_area,      INERTER_INDEX_channel_length,
                        INERTER_INDEX_fluid_density,     INERTER_INDEX_fluid_viscosity,
                        INERTER_INDEX_channel_roughness, INERTER_INDEX_minor_loss,
                        INERTER_INDEX_coil_diameter};
  const int nothers = (int)(sizeof(others) / sizeof(*others));
  const char* found = device->piston_area > 0 && device->gas_pressure == 0 ? "piston_area" : NULL;
  for (int i = 0; i < nothers; i++) {
    if (inerter_is_given(device, others[i]) && *value_of(device, others[i]) != 0) {
      found = inerter_parameter(others[i])->name;
    }
  }
  if (!found) {
    return 0;
  }

  char missing[64] = "";
  for (int i = 0, length = 0; i < 3; i++) {
    if (*value_of(device, geometry[i]) == 0) {
      length += snprintf(missing + length, sizeof(missing) - (size_t)length, "%s%s",
                         length ? ", " : "", inerter_parameter(geometry[i])->name);
    }
  }
  if (*missing) {
    return refuse(message,
                  "%s is given, but the channel is incomplete: %s missing; give piston_area, "
                  "channel_area and channel_length > 0, or remove %s",
                  found, missing, found);
  }
  double bore = pipe_diameter(device);
  if (device->coil_diameter != 0 && !(device->coil_diameter > bore)) {
    return refuse(message,
                  "coil_diameter is %g m, but the channel itself is %g m wide (from channel_area); "
                  "give coil_diameter > %g m, or 0 for a straight channel",
                  device->coil_diameter, bore, bore);
  }
  double inertance = pipe_inertance(device);
  if (inerter_is_given(device, INERTER_INDEX_inertance)) {
    return refuse(message,
                  "inertance is %g kg, but the channel gives %g kg; state one of them: remove "
                  "inertance, or the channel's parameters",
                  device->inertance, inertance);
  }
  if (!isfinite(inertance) || inertance == 0) {
    return refuse(message,
                  "inertance is %g kg from fluid_density, channel_length, piston_area and "
                  "channel_area: out of range; give values that make it finite and > 0",
                  inertance);
  }
  device->inertance = inertance;
  inerter_mark_given(device, INERTER_INDEX_inertance);
  return 0;
}

static uint32_t parts_of(const InerterDevice* p) {
  // where the control sets it, what is 0 now may become more
  int valve = p->control == INERTER_CONTROL_minor_loss;
  int brake = p->control == INERTER_CONTROL_flywheel_viscous || p->flywheel_viscous > 0;
  int pipe = p->fluid_viscosity > 0 || p->minor_loss > 0 || valve, gas = p->gas_pressure > 0;
  int slips = p->clutch_force > 0 || p->leak_damping > 0 || p->leak_quadratic_damping > 0;
  int series = p->series_stiffness > 0 || p->series_damping > 0 || slips;
  int varying =
      p->inertance_gradient != 0 || p->inertance_curvature != 0 || p->inertance_speed_gradient != 0;
  int stops = !isnan(p->stop_lower) || !isnan(p->stop_upper);
  int rubbing = p->friction != INERTER_FRICTION_none || inerter_has_load_friction(p);
  int wheel = series && rubbing && p->friction_side == INERTER_SIDE_flywheel;
  return curve_parts(p) | (varying ? PART_VARYING : 0) | (pipe ? PART_PIPE : 0) |
         (gas ? PART_GAS : 0) | (pipe || gas || brake ? PART_FLYWHEEL : 0) |
         (series ? PART_SERIES : 0) | (p->backlash > 0 ? PART_BACKLASH : 0) |
         (slips ? PART_CLUTCH : 0) | (stops ? PART_STOPS : 0) |
         (branch_count(p) ? PART_BRANCHES : 0) | (inerter_shapes_damping(p) ? PART_DAMPER : 0) |
         (p->damper_stiffness > 0 ? PART_DAMPER_SPRING : 0) | (wheel ? PART_WHEEL_FRICTION : 0);
}

int device_check(InerterDevice* device, char* message) {
  if (isnan(device->static_force)) {
    device->static_force = device->coulomb_force;
  }
  if (isnan(device->damping_knee_back)) {
    device->damping_knee_back = device->damping_knee;
  }
  if (isnan(device->damping_beyond_back)) {
    device->damping_beyond_back = device->damping_beyond;
  }
  return check_law(device, message) || check_ranges(device, message) ||
                 check_friction(device, message) || check_load(device, message) ||
                 check_branches(device, message) || check_damper_spring(device, message) ||
                 check_stops(device, message) || check_gas(device, message) ||
                 check_channel(device, message) || series_check(device, message) ||
                 curve_check(device, message) || map_check(device, message)
             ? -1
             : 0;
}

int inerter_finish(InerterDevice* device, char message[INERTER_MESSAGE_SIZE]) {
  if (!inerter_friction_name(device->friction)) {
    return refuse(message, "friction is %d: no such law", device->friction);
  }
  if (!inerter_gas_law_name(device->gas_law)) {
    return refuse(message, "gas_law is %d: no such law", device->gas_law);
  }
  if (!inerter_friction_side_name(device->friction_side)) {
    return refuse(message, "friction_side is %d: no such side", device->friction_side);
  }
  if (!inerter_control_name(device->control)) {
    return refuse(message, "control is %d: no such control", device->control);
  }
  if (control_check(device, message) || device_check(device, message)) {
    return -1;
  }
  inerter_find_parts(device);
  return 0;
}

void inerter_find_parts(InerterDevice* device) {
  device->parts = parts_of(device);
  device->nfriction = device->friction == INERTER_FRICTION_maxwell_slip
                          ? slip_count(device)
                          : inerter_friction_nstate(device->friction);
  device->nbranch = branch_count(device);
  device->ndamper = device->damper_stiffness > 0;
  device->ncontrol = device->control != INERTER_CONTROL_force && device->control_lag > 0;
  device->nstate = device->nfriction + series_count(device) + device->nbranch + device->ndamper +
                   device->ncontrol;
}
