// What a sensor of the plugin shows: see sensor.h.

#include "mujoco/sensor.h"

#include <math.h>

#include "mujoco/coupled.h"

int sensor_size(int nstate) {
  return 5 + nstate;
}

InerterForce sensor_force(const mjModel* m, const mjData* d, const Instance* self) {
  // motion along the device; the acceleration that the whole model has found
  mjtNum v = instance_velocity(m, d, self);
  mjtNum a = instance_along(m, d, self, d->qacc) + instance_bias_acceleration(m, d, self);
  if (!self->solved && !instance_idle(m, d, self)) {
    return inerter_force(&self->device, self->x, v, a, self->state);
  }

  // what the engine holds, and what was found together with the acceleration
  InerterForce force = {0, 0, 0};
  mjtNum held = self->armature - (self->solved ? self->replaced : 0);
  if (self->solved) {
    force = coupled_force(m, self);
  } else if (self->disabled) {
    force.total = inerter_force_motion(&self->matter, self->x, v, NULL);
  }
  force.inertance += held * a;
  force.total += held * a + self->damping * v;
  return force;
}

void sensor_compute(const mjModel* m, mjData* d, int instance) {
  const Instance* self = instance_of(d, instance);
  const InerterDevice* device = &self->device;
  int nstate = inerter_nstate(device);

  InerterForce force = sensor_force(m, d, self);
  mjtNum v = instance_velocity(m, d, self);
  const mjtNum* state = d->act + (nstate ? instance_act(m, self) : 0);

  for (int i = 0; i < m->nsensor; i++) {
    if (m->sensor_plugin[i] != instance) {
      continue;
    }
    mjtNum* value = d->sensordata + m->sensor_adr[i];
    *value++ = force.total;
    *value++ = force.inertance;
    *value++ = force.friction;
    mju_copy(value, state, nstate);
    value += nstate;
    *value++ = inerter_stored_energy(device, instance_displacement(m, d, self), v, state);
    // one that is no number is said and set to 0 at the end of the step
    mjtNum heat = d->plugin_state[m->plugin_stateadr[instance]];
    *value = isfinite(heat) ? heat : 0;
  }
}
