// The plugin "inerter.device": what the engine calls, and when.
//
//   compile       nstate, nsensordata, init (the first time: the model receives b and c)
//   forward pass  compute (passive), act_dot, compute (actuator), ..., compute (sensor)
//   end of step   advance
//
// The engine also steps mjData that it has made without plugins (the compiler does, for ranges of
// lengths): callbacks that meet one do nothing.
//
// The actuator's force is what the engine does not integrate itself (placement.c):
//   actuator_force = ctrl - (F - b a - c v)
// What of F hangs on the acceleration is solved for, all devices together, when the last instance
// is computed (coupled.c). The device's states are mjData.act. RK4 integrates them through act_dot.
// The other integrators take one step of them by the laws' own unconditionally stable formulas, at
// the velocity that the step has just found: a bristle driven by the old velocity would be an
// explicit spring. Heat is integrated in mjData.plugin_state where a sensor asks for it: with RK4
// by the weights of its stages, else by the trapezoid.

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "mujoco/advice.h"
#include "mujoco/attachment.h"
#include "mujoco/command.h"
#include "mujoco/configuration.h"
#include "mujoco/coupled.h"
#include "mujoco/engine.h"
#include "mujoco/instance.h"
#include "mujoco/live.h"
#include "mujoco/placement.h"
#include "mujoco/sensor.h"
#include "mujoco/visual.h"
#include "mujoco/watch.h"

static const char kName[] = "inerter.device", kQuietName[] = "inerter.device.quiet";

//------------------------------ life of an instance -----------------------------------------------

static int count_states(const mjModel* m, int instance) {
  return instance_sensed(m, instance);
}

static int count_sensor_values(const mjModel* m, int instance, int sensor) {
  (void)sensor;
  InerterDevice device;
  char message[INERTER_MESSAGE_SIZE];

  // init reports a bad configuration; here any size will do
  int bad = configuration_read(m, instance, &device, message) || inerter_finish(&device, message);
  return sensor_size(bad ? 0 : inerter_nstate(&device));
}

// the instance from its configuration; returns 0, or -1 with a message
static int prepare(const mjModel* m, int instance, Instance* self,
                   char message[INERTER_MESSAGE_SIZE]) {
  if (configuration_read(m, instance, &self->stated, message)) {
    return -1;
  }
  InerterDevice device = self->stated;
  if (inerter_finish(&device, message)) {
    return -1;
  }

  if (attachment_find(m, instance, &self->actuator, message)) {
    return -1;
  }
  int compiling = placement_is_new(m, self->actuator);
  if (live_find(m, self, message)) {
    return -1;
  }
  int live = instance_has_live_inertance(self);
  if (attachment_check(m, self->actuator, &device, live, message) ||
      placement_decide(m, self->actuator, &device, &self->native, message) ||
      live_derive(m, self, message) ||
      (compiling && command_range(m, self->actuator, &device, message))) {
    return -1;
  }

  if (compiling && advice_on_content(m, instance, self, message)) {
    return -1;
  }

  // what acts on the inertance alone would do nothing; edited or live, it may be 0
  if (compiling && instance_varies(&self->device) && self->device.inertance == 0 && !live) {
    snprintf(message, INERTER_MESSAGE_SIZE,
             "%s is given, but inertance is 0 kg, which is all that it acts on; state inertance or "
             "remove it",
             inerter_has_load_friction(&self->device) ? "load_friction"
                                                      : "a variation of the inertance");
    return -1;
  }
  self->sensed = instance_sensed(m, instance);
  self->last = 1;
  for (int k = instance + 1; k < m->nplugin; k++) {
    self->last &= !instance_is_device(m, k);
  }

  // Before it calls a sensor plugin the engine derives accelerations and forces of all bodies,
  // which is a fifth of a full car's step: nobody needs them where no sensor reads the instance.
  // The model is written here as in placement_decide, and only while it is compiled.
  if (compiling && !self->sensed) {
    ((mjModel*)m)->plugin[instance] = instance_slot_quiet;
  }
  if (compiling && self->last) {
    if (live_check_names(m, message)) {
      return -1;
    }
    placement_finish(m);
    advice_on_engine(m);
  }
  return 0;
}

// perhaps another model than the configuration was read from: what it states, and where it is
static void follow_other(const mjModel* m, int instance, Instance* self) {
  uint64_t print = configuration_print(m, instance);
  if (m == self->model && print == self->print) {
    return;
  }
  char message[INERTER_MESSAGE_SIZE];
  self->model = NULL;
  if (prepare(m, instance, self, message)) {
    const char* name = mj_id2name(m, mjOBJ_ACTUATOR, self->actuator);
    mju_error("inerter.device, actuator \"%.60s\", in a model that the data was not made for: %s",
              name ? name : "", message);
  }
  self->model = m;
  self->print = print;
}

// An mjData may be stepped with another model than it was made for: rollouts over a list of models
// do so. What is configured there counts. Looked at where the model is another one, or time has
// gone back, as another one may lie where the first was; it costs nothing in between.
static inline void follow_model(const mjModel* m, const mjData* d, int instance, Instance* self) {
  if (m == self->model && d->time == self->time) {
    return;
  }
  if (instance_sees_falling_asleep(m, d)) {
    return;
  }
  if (m != self->model || d->time < self->time) {
    follow_other(m, instance, self);
  }
  self->time = d->time;
}

static int init(const mjModel* m, mjData* d, int instance) {
  char message[INERTER_MESSAGE_SIZE];
  Instance* self = mju_malloc(sizeof(Instance));
  memset(self, 0, sizeof(*self));
  if (prepare(m, instance, self, message)) {
    instance_report(m, instance, message);
    mju_free(self);
    return -1;
  }
  self->model = m;
  self->time = -INFINITY;  // mjData.time is not set yet
  self->print = configuration_print(m, instance);
  d->plugin_data[instance] = (uintptr_t)self;
  return 0;
}

static void destroy(mjData* d, int instance) {
  mju_free(instance_of(d, instance));
  d->plugin_data[instance] = 0;
}

static void copy(mjData* dest, const mjModel* m, const mjData* src, int instance) {
  (void)m;
  if (instance_absent(dest, instance) || instance_absent(src, instance)) {
    return;
  }
  *instance_of(dest, instance) = *instance_of(src, instance);
  instance_of(dest, instance)->probing = 0;
}

static void reset(const mjModel* m, mjtNum* plugin_state, void* plugin_data, int instance) {
  Instance* self = plugin_data;
  if (!self) {
    return;
  }
  mju_zero(plugin_state, m->plugin_statenum[instance]);
  mju_zero(self->power, MAXSTAGE);
  mju_zero(self->state, INERTER_MAXSTATE);
  self->probing = 0;  // a callback may have ended the pass by an error
  self->detour = 0;
  self->solves = self->stops = self->misfits = 0;
}

//------------------------------ forward pass ------------------------------------------------------

static void act_dot(const mjModel* m, mjData* d, int instance) {
  if (instance_absent(d, instance)) {
    return;
  }
  Instance* self = instance_of(d, instance);
  follow_model(m, d, instance, self);
  live_update(m, self);
  instance_let_go(m, d, self);
  int nstate = inerter_nstate(&self->device);
  command_take(m, d, self);
  if (!nstate) {
    return;
  }
  int address = instance_act(m, self);
  watch_state(m, self, d->act + address);
  mjtNum* rate = d->act_dot + address;
  mju_zero(rate, nstate);
  if (!instance_idle(m, d, self)) {
    self->rate_x = instance_displacement(m, d, self);
    self->rate_v = d->actuator_velocity[m->actuator_outadr[self->actuator]];
    mju_copy(self->rate_state, d->act + address, nstate);
    watch_rates(m, self, 0, rate);
  }
}

// sleep may have been enabled since the model was compiled
static void refuse_sleep(const mjModel* m, const Instance* self) {
  char message[INERTER_MESSAGE_SIZE];
  if (attachment_check_sleep(m, self->actuator, message)) {
    mju_error("inerter.device, actuator \"%.60s\": %s",
              attachment_name(m, mjOBJ_ACTUATOR, self->actuator), message);
  }
}

// force of one device, or a note that it has to be solved for
static void compute_force(const mjModel* m, mjData* d, Instance* self) {
  live_update(m, self);
  self->x = instance_displacement(m, d, self);
  self->v = instance_velocity(m, d, self);
  self->solved = 0;
  self->disabled = instance_disabled(m, self);
  self->limited = attachment_limited(m, self->actuator);
  if (m->opt.enableflags & mjENBL_SLEEP) {
    refuse_sleep(m, self);
  }
  if (instance_asleep(m, d, self)) {
    return;
  }
  if (self->device.control != INERTER_CONTROL_force && !instance_sees_falling_asleep(m, d)) {
    command_take_value(m, d, self);
  }
  if (!self->disabled) {
    watch_stiffness(m, self);
    watch_sites(m, d, self);
    d->actuator_force[m->actuator_outadr[self->actuator]] = command_force(m, d, self);
  }
  if (self->forceless) {
    return;
  }
  // the states of the start of the step
  int nstate = inerter_nstate(&self->device);
  if (!instance_sees_falling_asleep(m, d)) {
    mju_copy(self->state, d->act + (nstate ? instance_act(m, self) : 0), nstate);
  }
  watch_resolution(m, d, self);
  self->solved = coupled_needed(m, self);
  if (self->solved) {
    self->bias = instance_bias_acceleration(m, d, self);
  } else if (self->disabled) {
    instance_pull(m, d, self, inerter_force_motion(&self->matter, self->x, self->v, NULL));
  } else {
    mjtNum rest;
    inerter_inertance(&self->share, self->x, self->v, &rest);
    instance_pull(m, d, self, rest + instance_force_motion(self));
  }
}

// heat now, for the sensors
static void remember_power(const mjModel* m, const mjData* d, Instance* self) {
  memmove(self->power, self->power + 1, (MAXSTAGE - 1) * sizeof(*self->power));
  self->power[MAXSTAGE - 1] = 0;
  if (!instance_idle(m, d, self)) {
    // only load friction asks for the acceleration, and then it has been solved for
    mjtNum a = self->solved ? self->acceleration : 0;
    self->power[MAXSTAGE - 1] =
        inerter_dissipated_power(&self->device, self->x, self->v, a, self->state);
  }
}

// With all actuation disabled the engine does not come to `compute_forces`: what is matter is
// solved for while it adds up the passive forces.
static void compute_matter(const mjModel* m, mjData* d, int instance, Instance* self) {
  instance_passive_is_new(self);
  if (!(m->opt.disableflags & mjDSBL_ACTUATION)) {
    return;
  }
  follow_model(m, d, instance, self);
  compute_force(m, d, self);
  if (self->last) {
    coupled_solve(m, d, instance);
  }
}

static void compute_forces(const mjModel* m, mjData* d, int instance, Instance* self) {
  follow_model(m, d, instance, self);
  compute_force(m, d, self);
  if (!self->last) {
    return;
  }
  if (self->probing) {
    self->probing = 0;
    return;
  }
  coupled_solve(m, d, instance);
  for (int k = 0; k <= instance; k++) {
    if (!instance_is_device(m, k)) {
      continue;
    }
    Instance* each = instance_of(d, k);
    if (each->solved && inerter_load_bends(&each->device) && !instance_idle(m, d, each)) {
      // the load on the bristle is known only now
      watch_rates(m, each, each->acceleration, d->act_dot + instance_act(m, each));
    }
    watch_force(m, each, d->actuator_force[m->actuator_outadr[each->actuator]] - each->detour);
    if (each->sensed && !instance_sees_falling_asleep(m, d)) {
      remember_power(m, d, each);
    }
  }
}

static void compute(const mjModel* m, mjData* d, int instance, int capability) {
  if (instance_absent(d, instance)) {
    return;
  }
  Instance* self = instance_of(d, instance);
  if (capability & mjPLUGIN_PASSIVE) {
    compute_matter(m, d, instance, self);
  }
  if (capability & mjPLUGIN_ACTUATOR) {
    compute_forces(m, d, instance, self);
  }
  if (capability & mjPLUGIN_SENSOR && self->sensed) {
    sensor_compute(m, d, instance);
  }
}

//------------------------------ end of step -------------------------------------------------------

// the stages of RK4 overshoot the ends of the free play by their order: back to them
static void keep_gap(const InerterDevice* device, mjtNum* state) {
  if (device->backlash > 0) {
    mjtNum* gap = state + device->nfriction + 2;
    *gap = mju_clip(*gap, -device->backlash, device->backlash);
  }
}

static void advance(const mjModel* m, mjData* d, int instance) {
  if (instance_absent(d, instance)) {
    return;
  }
  Instance* self = instance_of(d, instance);
  coupled_check(m, d, self);
  int resting = !self->device.nstate && !self->device.parts && !self->sensed;
  if (resting || instance_idle(m, d, self)) {
    return;
  }
  mjtNum h = m->opt.timestep;
  const mjtNum* power = self->power;
  mjtNum* heat = self->sensed ? d->plugin_state + m->plugin_stateadr[instance] : NULL;
  int nstate = inerter_nstate(&self->device);
  mjtNum* state = d->act + (nstate ? instance_act(m, self) : 0);
  watch_validity(m, self, state);
  // RK4 has integrated the states; the last four evaluations were its stages, the newest at the end
  // of the step. In mj_step2 there is but one, since the engine takes a step of Euler there.
  if (m->opt.integrator == mjINT_RK4 && d->time == self->time) {
    keep_gap(&self->device, state);
    if (heat) {
      *heat += h / 6 * (power[0] + 2 * power[1] + 2 * power[2] + power[3]);
      watch_heat(m, self, heat);
    }
    return;
  }

  // the step went from x with the velocity that stands in qvel now
  mjtNum v = instance_velocity(m, d, self), a = (v - self->v) / h, before[INERTER_MAXSTATE];
  mju_copy(before, self->state, nstate);
  if (instance_has_series(&self->device) || inerter_load_bends(&self->device)) {
    inerter_force_over_step(&self->share, self->x, self->v, a + self->bias, self->state, h,
                            self->mobility, self->state);
  } else if (nstate) {
    inerter_state_step(&self->device, self->x + 0.5 * h * v, v, 0, self->state, h);
  }
  mju_copy(state, self->state, nstate);
  if (heat) {
    mjtNum first = self->solved ? self->acceleration : 0;
    *heat += inerter_heat_over_step(&self->device, self->x, self->v, first, before, h, v, a, state);
    watch_heat(m, self, heat);
  }
}

//------------------------------ registration ------------------------------------------------------

// Version of MuJoCo that this library was compiled for, as mj_version() tells it; for Python, which
// turns the warning below into an error.
INERTER_API int inerter_built_for(void);

int inerter_built_for(void) {
  return mjVERSION_HEADER;
}

mjPLUGIN_LIB_INIT(inerter) {
  // mjModel and mjData differ between versions: refuse to read them with the wrong headers
  if (mj_version() != mjVERSION_HEADER) {
    int header = mjVERSION_HEADER;
    mju_warning(
        "this library of inerter was compiled for MuJoCo %d.%d.%d, loaded is MuJoCo %s; "
        "inerter.device is not available. Take the library that `inerter plugin-path --mujoco %s` "
        "prints, or run `pip install mujoco==%d.%d.%d`",
        header / 1000000, header / 1000 % 1000, header % 1000, mj_versionString(),
        mj_versionString(), header / 1000000, header / 1000 % 1000, header % 1000);
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
  plugin.capabilityflags = mjPLUGIN_ACTUATOR | mjPLUGIN_SENSOR | mjPLUGIN_PASSIVE;
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
  plugin.visualize = visual_draw;
  instance_slot_sensed = mjp_registerPlugin(&plugin);

  // the same for instances that no sensor reads; `prepare` moves them there
  plugin.name = kQuietName;
  plugin.capabilityflags = mjPLUGIN_ACTUATOR | mjPLUGIN_PASSIVE;
  instance_slot_quiet = mjp_registerPlugin(&plugin);
}
