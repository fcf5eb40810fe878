// What a sensor of the plugin shows: see sensor.h.

#include "mujoco/sensor.h"

int sensor_size(int nstate) {
  return 5 + nstate;
}

void sensor_compute(const mjModel* m, mjData* d, int instance) {
  const Instance* self = instance_of(d, instance);
  int actuator = self->actuator, row = m->actuator_outadr[actuator];
  InerterDevice device = instance_device(m, self);
  int nstate = inerter_nstate(&device);

  // motion along the device; the acceleration that the whole model has found
  mjtNum x = instance_displacement(m, d, self);
  mjtNum v = instance_velocity(m, d, self);
  mjtNum z = nstate ? d->act[m->actuator_actadr[actuator]] : 0;
  mjtNum a = instance_bias_acceleration(m, d, self);
  int start = d->moment_rowadr[row];
  for (int k = start; k < start + d->moment_rownnz[row]; k++) {
    a += d->actuator_moment[k] * d->qacc[d->moment_colind[k]];
  }

  // a disabled actuator is its constant inertance and damping alone: the engine keeps those
  InerterForce force = inerter_force(&device, x, v, a, z);
  if (instance_idle(m, d, self)) {
    force.friction = 0;
    force.inertance = device.inertance * a;
    force.total = force.inertance + device.viscous * v;
  }

  for (int i = 0; i < m->nsensor; i++) {
    if (m->sensor_plugin[i] != instance) {
      continue;
    }
    mjtNum* value = d->sensordata + m->sensor_adr[i];
    *value++ = force.total;
    *value++ = force.inertance;
    *value++ = force.friction;
    if (nstate) {
      *value++ = z;
    }
    *value++ = inerter_stored_energy(&device, x, v, z);
    *value = d->plugin_state[m->plugin_stateadr[instance]];
  }
}
