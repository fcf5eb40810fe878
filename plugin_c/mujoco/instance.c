// What the callbacks ask of an instance: see instance.h.

#include "mujoco/instance.h"

#include <math.h>
#include <stdio.h>

#include "mujoco/bias.h"
#include "mujoco/units.h"

//------------------------------ who it is ---------------------------------------------------------

int instance_slot_sensed = -1, instance_slot_quiet = -1;

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

// the sensor that reads an instance
static int find_sensor(const mjModel* m, int instance) {
  for (int i = 0; i < m->nsensor; i++) {
    if (m->sensor_plugin[i] == instance) {
      return i;
    }
  }
  return -1;
}

int instance_sensed(const mjModel* m, int instance) {
  return find_sensor(m, instance) >= 0;
}

void instance_report(const mjModel* m, int instance, const char* text) {
  int count, actuator = instance_actuator(m, instance, &count), id = actuator;
  const char* name = mj_id2name(m, mjOBJ_PLUGIN, instance);
  const char* kind = "instance";
  if (!name || !*name) {
    kind = actuator >= 0 ? "actuator" : "sensor";
    id = actuator >= 0 ? actuator : find_sensor(m, instance);
    name = id < 0 ? NULL : mj_id2name(m, actuator >= 0 ? mjOBJ_ACTUATOR : mjOBJ_SENSOR, id);
  }
  char message[INERTER_MESSAGE_SIZE];
  units_of_actuator(m, actuator, text, message);
  if (name && *name) {
    mju_warning("inerter.device, %s \"%.60s\": %s", kind, name, message);
  } else {
    mju_warning("inerter.device, %s %d: %s", kind, id < 0 ? instance : id, message);
  }
}

void instance_complain(const mjModel* m, Instance* self, Complaint reason, const char* text) {
  if (!(self->complained & reason)) {
    self->complained |= reason;
    instance_report(m, m->actuator_plugin[self->actuator], text);
  }
}

//------------------------------ the device --------------------------------------------------------

int instance_is_live(const Instance* self, int parameter) {
  return inerter_controlled(&self->stated) == parameter || instance_has_numeric(self, parameter);
}

int instance_has_numeric(const Instance* self, int parameter) {
  for (int k = 0; k < self->nlive; k++) {
    if (self->live[k].parameter == parameter) {
      return 1;
    }
  }
  return 0;
}

int instance_has_live_inertance(const Instance* self) {
  int channel = instance_is_live(self, INERTER_INDEX_piston_area) ||
                instance_is_live(self, INERTER_INDEX_channel_area) ||
                instance_is_live(self, INERTER_INDEX_channel_length) ||
                instance_is_live(self, INERTER_INDEX_fluid_density);
  return instance_is_live(self, INERTER_INDEX_inertance) ||
         (channel && self->stated.channel_length > 0);
}

// inertance and viscous damping, as the engine keeps its armature and damping
static InerterDevice matter_of(const InerterDevice* share) {
  InerterDevice matter;
  inerter_default(&matter);
  if (instance_has_series(share)) {
    return matter;
  }
  matter.inertance = share->inertance;
  matter.inertance_gradient = share->inertance_gradient;
  matter.inertance_curvature = share->inertance_curvature;
  matter.inertance_speed_gradient = share->inertance_speed_gradient;
  // behind a spring dampers hold nothing by themselves
  matter.viscous = share->damper_stiffness > 0 ? 0 : share->viscous;
  matter.damping_asymmetry = share->damping_asymmetry;
  matter.damping_knee = share->damping_knee;
  matter.damping_beyond = share->damping_beyond;
  matter.damping_sharpness = share->damping_sharpness;
  matter.damping_exponent = share->damping_exponent;
  matter.damping_knee_back = share->damping_knee_back;
  matter.damping_beyond_back = share->damping_beyond_back;
  matter.damping_held = share->damping_held;
  const int kept[] = {INERTER_STROKE_inertance, INERTER_STROKE_inertance_back,
                      INERTER_STROKE_viscous};
  for (int i = 0; i < 3; i++) {
    matter.curve[kept[i]] = share->curve[kept[i]];
  }
  inerter_find_parts(&matter);
  return matter;
}

static int is_nothing(const InerterDevice* share) {
  return share->control == INERTER_CONTROL_force && share->friction == INERTER_FRICTION_none &&
         !share->parts && share->inertance == 0 && !inerter_has_load_friction(share) &&
         share->viscous == 0 && share->quadratic_damping == 0 && share->stiffness == 0 &&
         share->stiffness_cubic == 0 && share->force_offset == 0;
}

void instance_refresh(const mjModel* m, Instance* self, int force) {
  // viscous damping and inertance that the engine integrates: edits of the model count
  int undamped = (m->opt.disableflags & mjDSBL_DAMPER) != 0;
  mjtNum armature = m->actuator_armature[self->actuator];
  mjtNum damping = undamped ? 0 : m->actuator_damping[self->actuator];
  if (!force && armature == self->armature && damping == self->damping &&
      undamped == self->undamped) {
    return;
  }
  if (!self->native && armature != 0) {
    const char* name = mj_id2name(m, mjOBJ_ACTUATOR, self->actuator);
    name = name && *name ? name : "(unnamed)";
    mju_error(
        "inerter.device, actuator \"%.60s\": actuator_armature is %g, but the engine's inertia "
        "matrix cannot hold the inertance of this device; leave it 0 and change the inertance by a "
        "numeric \"%.60s.inertance\" in <custom>",
        name, armature, name);
  }
  self->undamped = undamped;
  self->armature = armature;
  self->damping = damping;
  InerterDevice* device = &self->device;
  int series = instance_has_series(device), live = instance_has_live_inertance(self);
  if (self->native && !series && !live) {
    device->inertance = armature;
  }
  int shaped = inerter_shapes_damping(device);
  if (self->native && !instance_is_live(self, INERTER_INDEX_viscous) && !(shaped && damping == 0)) {
    device->viscous = damping;
  } else {
    device->viscous = undamped ? 0 : self->viscous;
  }

  // an inertance that is not the engine's constant is the plugin's as a whole, be it 0 at present
  self->share = *device;
  if (undamped && device->damper_stiffness > 0) {
    self->share.quadratic_damping = 0;
  }
  if (undamped && inerter_has_curve(device, INERTER_STROKE_viscous)) {
    InerterCurve* curve = &self->share.curve[INERTER_STROKE_viscous];
    curve->nvalue = curve->nperiod = 0;
    inerter_find_parts(&self->share);
  }
  self->replaced = 0;
  if (self->native) {
    self->share.viscous -= shaped ? 0 : damping;
    self->share.damping_held = shaped ? damping : 0;
    if (live || instance_varies(device)) {
      self->replaced = series ? 0 : armature;
    } else if (!series) {
      self->share.inertance = 0;
    }
  }
  self->forceless = is_nothing(&self->share) && self->replaced == 0;
  self->matter = matter_of(&self->share);
}

//------------------------------ motion ------------------------------------------------------------

int instance_disabled(const mjModel* m, const Instance* self) {
  int group = m->actuator_group[self->actuator];
  return m->opt.disableflags & mjDSBL_ACTUATION ||
         (group >= 0 && group < 31 && m->opt.disableactuator & (1 << group));
}

int instance_asleep(const mjModel* m, const mjData* d, const Instance* self) {
  int row = m->actuator_outadr[self->actuator];
  int start = d->moment_rowadr[row], count = d->moment_rownnz[row];
  int asleep = m->opt.enableflags & mjENBL_SLEEP && count;
  for (int k = start; asleep && k < start + count; k++) {
    asleep = d->tree_asleep[m->dof_treeid[d->moment_colind[k]]] >= 0;
  }
  return asleep;
}

int instance_idle(const mjModel* m, const mjData* d, const Instance* self) {
  return instance_disabled(m, self) || instance_asleep(m, d, self);
}

int instance_sees_falling_asleep(const mjModel* m, const mjData* d) {
  if (!(m->opt.enableflags & mjENBL_SLEEP)) {
    return 0;
  }
  // the list of those awake follows after it
  for (int i = 0; i < m->ntree; i++) {
    if (d->tree_asleep[i] >= 0 && d->tree_awake[i]) {
      return 1;
    }
  }
  return 0;
}

mjtNum instance_displacement(const mjModel* m, const mjData* d, const Instance* self) {
  return d->actuator_length[m->actuator_outadr[self->actuator]] - self->rest_length;
}

void instance_add_moment(const mjModel* m, const mjData* d, const Instance* self, mjtNum force,
                         mjtNum* vec) {
  int row = m->actuator_outadr[self->actuator];
  int start = d->moment_rowadr[row], end = start + d->moment_rownnz[row];
  for (int k = start; k < end; k++) {
    vec[d->moment_colind[k]] += force * d->actuator_moment[k];
  }
}

void instance_pull(const mjModel* m, mjData* d, Instance* self, mjtNum force) {
  if (self->limited || self->disabled) {
    instance_add_moment(m, d, self, -force, d->qfrc_passive);
    self->detour = force;
  } else {
    d->actuator_force[m->actuator_outadr[self->actuator]] -= force;
  }
}

void instance_let_go(const mjModel* m, mjData* d, Instance* self) {
  if (self->detour == 0) {
    return;
  }
  // without springs and dampers the engine makes passive forces of nothing, and asks nobody
  int none = mjDSBL_SPRING | mjDSBL_DAMPER;
  if ((m->opt.disableflags & none) == none) {
    int row = m->actuator_outadr[self->actuator], start = d->moment_rowadr[row];
    for (int k = start; k < start + d->moment_rownnz[row]; k++) {
      d->qfrc_passive[d->moment_colind[k]] = 0;
    }
  } else {
    instance_add_moment(m, d, self, self->detour, d->qfrc_passive);
  }
  self->detour = 0;
}

void instance_passive_is_new(Instance* self) {
  self->detour = 0;
}

mjtNum instance_along(const mjModel* m, const mjData* d, const Instance* self, const mjtNum* vec) {
  int row = m->actuator_outadr[self->actuator];
  int start = d->moment_rowadr[row], end = start + d->moment_rownnz[row];
  mjtNum sum = 0;
  for (int k = start; k < end; k++) {
    sum += d->actuator_moment[k] * vec[d->moment_colind[k]];
  }
  return sum;
}

mjtNum instance_along_size(const mjModel* m, const mjData* d, const Instance* self,
                           const mjtNum* vec) {
  int row = m->actuator_outadr[self->actuator];
  int start = d->moment_rowadr[row], end = start + d->moment_rownnz[row];
  mjtNum sum = 0;
  for (int k = start; k < end; k++) {
    sum += fabs(d->actuator_moment[k] * vec[d->moment_colind[k]]);
  }
  return sum;
}

mjtNum instance_velocity(const mjModel* m, const mjData* d, const Instance* self) {
  return instance_along(m, d, self, d->qvel);
}

mjtNum instance_bias_acceleration(const mjModel* m, const mjData* d, const Instance* self) {
  int i = self->actuator;
  if (m->actuator_trntype[i] != mjTRN_TENDON) {
    return 0;
  }
  return m->actuator_gear[6 * m->actuator_outadr[i]] *
         bias_of_tendon(m, d, m->actuator_trnid[2 * i]);
}

double instance_force_motion(const Instance* self) {
  // what the engine asked of the states a moment ago saves the friction law half its work
  if (self->rate_x == self->x && self->rate_v == self->v && self->rate_state[0] == self->state[0]) {
    return inerter_force_motion_of_rate(&self->share, self->x, self->v, self->state, self->rate);
  }
  return inerter_force_motion(&self->share, self->x, self->v, self->state);
}

int instance_act(const mjModel* m, const Instance* self) {
  return m->actuator_actadr[self->actuator];
}
