// What the callbacks ask of an instance: see instance.h.

#include "mujoco/instance.h"

#include <stdio.h>

// Time derivative of a tendon's Jacobian times a vector. The library exports it, the public header
// leaves it out; the plugin is built for exactly one version of the library (see plugin.c).
mjtNum mj_tendonDot(const mjModel* m, mjData* d, int id, const mjtNum* vec);

int instance_actuator(const mjModel* m, int instance, int* count) {
  int found = -1;
  *count = 0;
  for (int i = 0; i < m->nactuator; i++) {
    if (m->actuator_plugin[i] == instance) {
      found = found < 0 ? i : found;
      ++*count;
    }
  }
  return found;
}

int instance_sensed(const mjModel* m, int instance) {
  for (int i = 0; i < m->nsensor; i++) {
    if (m->sensor_plugin[i] == instance) {
      return 1;
    }
  }
  return 0;
}

void instance_report(const mjModel* m, int instance, const char* text) {
  int count;
  int actuator = instance_actuator(m, instance, &count);
  const char* name = mj_id2name(m, mjOBJ_PLUGIN, instance);
  const char* kind = "instance";
  if ((!name || !*name) && actuator >= 0) {
    name = mj_id2name(m, mjOBJ_ACTUATOR, actuator);
    kind = "actuator";
  }
  if (name && *name) {
    mju_warning("inerter.device, %s \"%.60s\": %s", kind, name, text);
  } else {
    mju_warning("inerter.device, %s %d: %s", kind, actuator >= 0 ? actuator : instance, text);
  }
}

InerterDevice instance_device(const mjModel* m, const Instance* self) {
  InerterDevice device = self->device;
  device.inertance = m->actuator_armature[self->actuator];
  device.viscous = m->actuator_damping[self->actuator];
  if (m->opt.disableflags & mjDSBL_DAMPER) {
    device.viscous = 0;
  }
  return device;
}

int instance_idle(const mjModel* m, const mjData* d, const Instance* self) {
  int i = self->actuator;
  int group = m->actuator_group[i];
  if (m->opt.disableflags & mjDSBL_ACTUATION) {
    return 1;
  }
  if (group >= 0 && group < 31 && m->opt.disableactuator & (1 << group)) {
    return 1;
  }

  // asleep: the tree of the first dof is
  int row = m->actuator_outadr[i];
  if (m->opt.enableflags & mjENBL_SLEEP && d->moment_rownnz[row]) {
    int dof = d->moment_colind[d->moment_rowadr[row]];
    return d->tree_asleep[m->dof_treeid[dof]] >= 0;
  }
  return 0;
}

mjtNum instance_displacement(const mjModel* m, const mjData* d, const Instance* self) {
  return d->actuator_length[m->actuator_outadr[self->actuator]] - self->rest_length;
}

mjtNum instance_velocity(const mjModel* m, const mjData* d, const Instance* self) {
  int row = m->actuator_outadr[self->actuator];
  int start = d->moment_rowadr[row], end = start + d->moment_rownnz[row];
  mjtNum velocity = 0;
  for (int k = start; k < end; k++) {
    velocity += d->actuator_moment[k] * d->qvel[d->moment_colind[k]];
  }
  return velocity;
}

mjtNum instance_bias_acceleration(const mjModel* m, mjData* d, const Instance* self) {
  // nobody reads the acceleration of a device without inertance, and the engine has none for
  // tendons that wrap around geoms
  int i = self->actuator;
  if (m->actuator_trntype[i] != mjTRN_TENDON || m->actuator_armature[i] == 0) {
    return 0;
  }
  mjtNum gear = m->actuator_gear[6 * m->actuator_outadr[i]];
  return gear * mj_tendonDot(m, d, m->actuator_trnid[2 * i], d->qvel);
}
