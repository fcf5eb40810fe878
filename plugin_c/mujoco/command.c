// What a control commands: see command.h.

#include "mujoco/command.h"

#include <math.h>
#include <stdio.h>

#include "mujoco/engine.h"

mjtNum command_value(const mjModel* m, const mjData* d, int actuator) {
  if (!m->actuator_ctrlnum[actuator]) {
    return NAN;
  }
  int address = m->actuator_ctrladr[actuator];
  mjtNum ctrl = d->ctrl[address];
  if (m->actuator_delay[actuator]) {
    const mjtNum* found =
        mj_readCtrl(m, d, actuator, d->time, &ctrl, m->actuator_history[2 * actuator + 1]);
    ctrl = found ? *found : ctrl;
  }
  if (m->actuator_ctrllimited[address] && !(m->opt.disableflags & mjDSBL_CLAMPCTRL)) {
    ctrl =
        mju_clip(ctrl, m->actuator_ctrlrange[2 * address], m->actuator_ctrlrange[2 * address + 1]);
  }
  return mju_isBad(ctrl) ? 0 : ctrl;
}

mjtNum command_force(const mjModel* m, const mjData* d, const Instance* self) {
  if (!m->actuator_ctrlnum[self->actuator] || self->device.control != INERTER_CONTROL_force) {
    return 0;
  }
  return command_value(m, d, self->actuator);
}

static double* controlled(InerterDevice* device, int parameter) {
  return (double*)(void*)((char*)device + inerter_parameter(parameter)->offset);
}

void command_take_value(const mjModel* m, const mjData* d, Instance* self) {
  InerterDevice* device = &self->device;
  // where the actuator is disabled nobody hears the control
  mjtNum command = instance_disabled(m, self) ? NAN : command_value(m, d, self->actuator);
  inerter_command(device, command, d->act + (device->nstate ? instance_act(m, self) : 0));
  int parameter = inerter_controlled(device);
  if (parameter == INERTER_INDEX_viscous && self->undamped) {
    device->viscous = 0;
  }

  // what is the plugin's of it, and what stays without actuation
  InerterDevice *share = &self->share, *matter = &self->matter;
  share->command = device->command;
  share->static_force = device->static_force;
  *controlled(share, parameter) = *controlled(device, parameter);
  if (!instance_has_series(device) &&
      (parameter == INERTER_INDEX_inertance || parameter == INERTER_INDEX_viscous)) {
    *controlled(matter, parameter) = *controlled(device, parameter);
  }
}

int command_range(const mjModel* m, int actuator, const InerterDevice* device,
                  char message[INERTER_MESSAGE_SIZE]) {
  if (!m->actuator_ctrlnum[actuator]) {
    return 0;
  }
  const mjtNum* given = m->actuator_ctrlrange + 2 * (size_t)m->actuator_ctrladr[actuator];
  if (device->control == INERTER_CONTROL_force) {
    int limited = m->actuator_ctrllimited[m->actuator_ctrladr[actuator]];
    if (limited && !(given[0] <= 0 && given[1] >= 0)) {
      snprintf(message, INERTER_MESSAGE_SIZE,
               "ctrlrange is %g to %g, without 0: a device that nobody commands would be pushed by "
               "%g all the time; give a range with 0, or ctrllimited=\"false\" where a class of "
               "defaults has brought it",
               given[0], given[1], given[0] > 0 ? given[0] : given[1]);
      return -1;
    }
    return 0;
  }
  // the model is written here as in placement_decide, and only while it is compiled
  mjModel* model = (mjModel*)m;
  int address = m->actuator_ctrladr[actuator];
  mjtNum* range = model->actuator_ctrlrange + 2 * (size_t)address;
  double lower = device->control_lower, upper = device->control_upper;
  if (m->actuator_ctrllimited[address]) {
    const double size = fmax(fabs(lower), fabs(upper)), rounding = 1e-6 * size;
    if (range[0] < lower - rounding || range[1] > upper + rounding) {
      snprintf(message, INERTER_MESSAGE_SIZE,
               "ctrlrange is %g to %g, but the control sets %s from %g to %g (control_lower, "
               "control_upper); remove ctrlrange, or give one within them",
               range[0], range[1], inerter_parameter(inerter_controlled(device))->name, lower,
               upper);
      return -1;
    }
    return 0;
  }
  range[0] = lower;
  range[1] = upper;
  model->actuator_ctrllimited[address] = 1;
  return 0;
}
