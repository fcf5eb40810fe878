// The plugin "inerter.device": what the engine calls, and when.
//
//   compile       nstate, nsensordata, init (the first time: the model receives b and c)
//   forward pass  act_dot, compute (actuator), ..., compute (sensor)
//   end of step   advance
//
// The actuator's force is everything but b a and c v, which the engine integrates (coupling.c):
//   actuator_force = ctrl - (F - b a - c v)
// What of F depends on the acceleration beside b a is solved for (acceleration_forces.c).
// The friction state z is mjData.act. RK4 integrates it through act_dot. The other integrators take
// one step of z by the law's own unconditionally stable formula, at the velocity that the step has
// just found: a bristle driven by the old velocity would be an explicit spring.
// Heat is integrated in mjData.plugin_state where a sensor asks for it: with RK4 by the weights of
// its stages, else by the trapezoid.

#include <mujoco/mujoco.h>
#include <stdio.h>
#include <string.h>

#include "mujoco/acceleration_forces.h"
#include "mujoco/configuration.h"
#include "mujoco/coupling.h"
#include "mujoco/instance.h"
#include "mujoco/sensor.h"

static const char kName[] = "inerter.device";

//------------------------------ life of an instance -----------------------------------------------

static int count_states(const mjModel* m, int instance) {
  return instance_sensed(m, instance);
}

static int count_sensor_values(const mjModel* m, int instance, int sensor) {
  (void)sensor;
  InerterDevice device;
  char message[INERTER_MESSAGE_SIZE];

  // init reports a bad configuration; here any size will do
  int bad = configuration_read(m, instance, &device, message);
  return sensor_size(bad ? 0 : inerter_nstate(&device));
}

// whether an instance is the last of this plugin, in a model where one needs the acceleration
static int solves_acceleration(const mjModel* m, int instance) {
  int needed = 0;
  for (int k = 0; k < m->nplugin; k++) {
    if (m->plugin[k] != m->plugin[instance]) {
      continue;
    }
    InerterDevice device;
    char message[INERTER_MESSAGE_SIZE];
    needed |= !configuration_read(m, k, &device, message) && acceleration_forces_needed(&device);
    if (k > instance) {
      return 0;
    }
  }
  return needed;
}

static int init(const mjModel* m, mjData* d, int instance) {
  char message[INERTER_MESSAGE_SIZE];
  InerterDevice device;
  if (configuration_read(m, instance, &device, message)) {
    instance_report(m, instance, message);
    return -1;
  }

  // one actuator carries the device
  int count;
  int actuator = instance_actuator(m, instance, &count);
  if (count != 1) {
    snprintf(message, sizeof(message),
             "%d actuators refer to it; give every actuator an instance of its own", count);
    instance_report(m, instance,
                    count ? message
                          : "no actuator refers to it; add <actuator><plugin "
                            "plugin=\"inerter.device\" instance=\"...\" "
                            "tendon=\"...\"/></actuator>");
    return -1;
  }
  if (coupling_check(m, actuator, &device, message) ||
      coupling_place(m, actuator, &device, message)) {
    instance_report(m, instance, message);
    return -1;
  }

  Instance* self = mju_malloc(sizeof(Instance));
  memset(self, 0, sizeof(*self));
  self->device = device;
  self->device.inertance = 0;
  self->device.viscous = 0;
  self->device.rest_length = 0;
  self->rest_length = device.rest_length;
  self->actuator = actuator;
  self->sensed = instance_sensed(m, instance);
  self->solves_acceleration = solves_acceleration(m, instance);
  d->plugin_data[instance] = (uintptr_t)self;
  return 0;
}

static void destroy(mjData* d, int instance) {
  mju_free(instance_of(d, instance));
  d->plugin_data[instance] = 0;
}

static void copy(mjData* dest, const mjModel* m, const mjData* src, int instance) {
  (void)m;
  *instance_of(dest, instance) = *instance_of(src, instance);
}

static void reset(const mjModel* m, mjtNum* plugin_state, void* plugin_data, int instance) {
  Instance* self = plugin_data;
  mju_zero(plugin_state, m->plugin_statenum[instance]);
  mju_zero(self->power, MAXSTAGE);
  self->state = 0;
}

//------------------------------ forward pass ------------------------------------------------------

// friction state now, 0 for laws without
static mjtNum state_now(const mjModel* m, const mjData* d, const Instance* self) {
  int address = m->actuator_actadr[self->actuator];
  return inerter_nstate(&self->device) ? d->act[address] : 0;
}

static void act_dot(const mjModel* m, mjData* d, int instance) {
  const Instance* self = instance_of(d, instance);
  if (!inerter_nstate(&self->device)) {
    return;
  }
  int row = m->actuator_outadr[self->actuator];
  mjtNum rate = 0;
  if (!instance_idle(m, d, self)) {
    rate = inerter_state_rate(&self->device, instance_displacement(m, d, self),
                              d->actuator_velocity[row], state_now(m, d, self));
  }
  d->act_dot[m->actuator_actadr[self->actuator]] = rate;
}

// commanded force parallel to the device: the control, delayed and limited as for other actuators
static mjtNum command(const mjModel* m, const mjData* d, int actuator) {
  if (!m->actuator_ctrlnum[actuator]) {
    return 0;
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

static void compute_force(const mjModel* m, mjData* d, int instance) {
  Instance* self = instance_of(d, instance);
  int row = m->actuator_outadr[self->actuator];
  mjtNum x = instance_displacement(m, d, self), v = d->actuator_velocity[row];
  mjtNum power = 0;
  if (!instance_idle(m, d, self)) {
    self->state = state_now(m, d, self);
    d->actuator_force[row] =
        command(m, d, self->actuator) - inerter_force_motion(&self->device, x, v, self->state);
    if (self->sensed) {
      InerterDevice device = instance_device(m, self);
      device.load_friction = 0;  // its heat is added where its force is found
      power = inerter_dissipated_power(&device, x, v, 0, self->state);
    }
  }

  // remember the last evaluations
  if (self->sensed) {
    memmove(self->power, self->power + 1, (MAXSTAGE - 1) * sizeof(*self->power));
    self->power[MAXSTAGE - 1] = power;
  }
  if (self->solves_acceleration) {
    acceleration_forces_solve(m, d, instance);
  }
}

static void compute(const mjModel* m, mjData* d, int instance, int capability) {
  if (capability & mjPLUGIN_ACTUATOR) {
    compute_force(m, d, instance);
  } else if (capability & mjPLUGIN_SENSOR && instance_of(d, instance)->sensed) {
    sensor_compute(m, d, instance);
  }
}

//------------------------------ end of step -------------------------------------------------------

static void advance(const mjModel* m, mjData* d, int instance) {
  Instance* self = instance_of(d, instance);
  if (instance_idle(m, d, self)) {
    return;
  }
  mjtNum h = m->opt.timestep;
  const mjtNum* power = self->power;
  mjtNum* heat = self->sensed ? d->plugin_state + m->plugin_stateadr[instance] : NULL;

  // RK4 has integrated the state; the last four evaluations were its stages
  if (m->opt.integrator == mjINT_RK4) {
    if (heat) {
      *heat += h / 6 * (power[0] + 2 * power[1] + 2 * power[2] + power[3]);
    }
    return;
  }

  // the step went from x with the velocity that stands in qvel now
  int row = m->actuator_outadr[self->actuator];
  mjtNum v0 = d->actuator_velocity[row], v = instance_velocity(m, d, self);
  mjtNum x = instance_displacement(m, d, self);
  mjtNum z = inerter_state_step(&self->device, x + 0.5 * h * v, v, self->state, h);
  if (inerter_nstate(&self->device)) {
    d->act[m->actuator_actadr[self->actuator]] = z;
  }
  if (heat) {
    InerterDevice device = instance_device(m, self);
    mjtNum end = inerter_dissipated_power(&device, x + h * v, v, (v - v0) / h, z);
    *heat += 0.5 * h * (power[MAXSTAGE - 1] + end);
  }
}

//------------------------------ registration ------------------------------------------------------

mjPLUGIN_LIB_INIT(inerter) {
  // mjModel and mjData differ between versions: refuse to read them with the wrong headers
  if (mj_version() != mjVERSION_HEADER) {
    int header = mjVERSION_HEADER;
    mju_warning(
        "inerter was compiled for MuJoCo %d.%d.%d, loaded is MuJoCo %s; inerter.device is "
        "not available. Run `pip install mujoco==%d.%d.%d`, or install an inerter made for "
        "MuJoCo %s",
        header / 1000000, header / 1000 % 1000, header % 1000, mj_versionString(), header / 1000000,
        header / 1000 % 1000, header % 1000, mj_versionString());
    return;
  }

  // a second copy of the library adds nothing
  int slot;
  if (mjp_getPlugin(kName, &slot)) {
    return;
  }
  mjpPlugin plugin;
  mjp_defaultPlugin(&plugin);
  plugin.name = kName;
  plugin.nattribute = NATTRIBUTE;
  plugin.attributes = kAttributes;
  plugin.capabilityflags = mjPLUGIN_ACTUATOR | mjPLUGIN_SENSOR;
  plugin.needstage = mjSTAGE_ACC;
  plugin.nstate = count_states;
  plugin.nsensordata = count_sensor_values;
  plugin.init = init;
  plugin.destroy = destroy;
  plugin.copy = copy;
  plugin.reset = reset;
  plugin.actuator_act_dot = act_dot;
  plugin.compute = compute;
  plugin.advance = advance;
  mjp_registerPlugin(&plugin);
}
