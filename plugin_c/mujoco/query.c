// What a program may ask of the devices of a running model: see query.h.

#include "mujoco/query.h"

#include "mujoco/instance.h"

// the device that an actuator carries, or NULL
static const Instance* device_of(const mjModel* m, const mjData* d, int actuator) {
  if (actuator < 0 || actuator >= m->nactuator) {
    return NULL;
  }
  int instance = m->actuator_plugin[actuator];
  if (instance < 0 || !instance_is_device(m, instance) || instance_absent(d, instance)) {
    return NULL;
  }
  return instance_of(d, instance);
}

int inerter_solve_counts(const mjModel* m, const mjData* d, int actuator, int64_t counts[3]) {
  const Instance* self = device_of(m, d, actuator);
  if (!self) {
    return -1;
  }
  counts[0] = self->solves;
  counts[1] = self->stops;
  counts[2] = self->misfits;
  return 0;
}

int inerter_energy(const mjModel* m, const mjData* d, int actuator, double energy[2]) {
  const Instance* self = device_of(m, d, actuator);
  if (!self) {
    return -1;
  }
  const mjtNum* state = d->act + (self->device.nstate ? instance_act(m, self) : 0);
  mjtNum v = instance_velocity(m, d, self);
  mjtNum x = instance_displacement(m, d, self);
  if (self->device.ncontrol) {
    // the value that the state says now
    InerterDevice present = self->device;
    inerter_command(&present, present.command, state);
    energy[0] = inerter_stored_energy(&present, x, v, state);
  } else {
    energy[0] = inerter_stored_energy(&self->device, x, v, state);
  }
  energy[1] = 0.5 * m->actuator_armature[actuator] * v * v;
  return 0;
}
