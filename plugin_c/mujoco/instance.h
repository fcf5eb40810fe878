// One plugin instance: a device and the actuator that carries it.

#ifndef INERTER_MUJOCO_INSTANCE_H_
#define INERTER_MUJOCO_INSTANCE_H_

#include "core/device.h"
#include "mujoco/engine.h"

_Static_assert(sizeof(mjtNum) == sizeof(double), "the plugin is built for double precision");

// most stages of an integrator
enum { MAXSTAGE = 4 };

// What can be live: a parameter by its index, list i by LIVE_LIST + i.
enum { LIVE_LIST = INERTER_NPARAMETER + 1, NLIVE = LIVE_LIST + INERTER_NLIST };

// a parameter, or a list, that a numeric of the model holds (live.h)
typedef struct LiveParameter_ {
  int parameter;   // which
  int address;     // place in numeric_data
  int count;       // numbers there
  uint64_t print;  // of the numbers last seen
} LiveParameter;

// What an mjData keeps of an instance between the callbacks of one step. Everything that has to
// survive a step is in mjData.act and mjData.plugin_state.
typedef struct Instance_ {
  const mjModel* model;  // whose configuration this is (plugin.c)
  mjtNum time;           // of the last evaluation
  uint64_t print;
  InerterDevice stated;  // as configured, nothing derived yet
  InerterDevice device;  // as it is now, with what the engine integrates of it; rest_length: 0
  InerterDevice share;   // the device without that: what the plugin's force is made of
  InerterDevice matter;  // what of the share stays when actuation is disabled
  mjtNum armature;       // what of the model these were made for (instance_refresh)
  mjtNum damping;
  mjtNum replaced;  // inertance of the engine's that the plugin's share stands in for [kg]
  int undamped;
  mjtNum viscous;      // as stated or live, whoever integrates it
  mjtNum rest_length;  // actuator length at which the displacement is 0
  int actuator;        // index of the actuator
  int forceless;       // 1: the plugin's share is nothing
  int native;          // 1: the engine integrates inertance and viscous damping (placement.h)
  int limited;         // 1: the engine limits what actuators do where it pulls (instance_pull)
  int sensed;          // 1: a sensor reads this instance
  int last;            // 1: the last instance of the plugin in the model
  int probing;         // 1: the engine is asked what it does without the forces (coupled.c)
  int disabled;        // 1: its actuator is, so that only matter is left
  int shifted;         // 1: constraints were told to rest elsewhere (damped.h); kept by the last
  int nlive;           // number of live parameters
  LiveParameter live[NLIVE];

  // where the rates of the states were last asked for, and what they are there
  mjtNum rate_x, rate_v;
  double rate_state[INERTER_MAXSTATE], rate[INERTER_MAXSTATE];

  // the last evaluation
  mjtNum x, v;  // displacement, velocity
  mjtNum bias;  // acceleration that qvel alone causes: d(moment)/dt qvel
  double state[INERTER_MAXSTATE];
  mjtNum detour;           // force that stands in mjData.qfrc_passive
  int solved;              // 1: the force was found together with the acceleration (coupled.h)
  double acceleration;     // which one [m/s^2]
  int misfit;              // 1: one that it does not fit, which has been counted
  double mobility;         // acceleration of the terminals per force [1/kg]
  double power[MAXSTAGE];  // dissipated power at the last evaluations, newest last [W]
  int complained;          // reasons (Complaint) for which it has said once what is wrong
  int integrator;          // under which (+ 1), and with which step, its stiffness was looked at
  mjtNum timestep;
  mjtNum light;         // mobility in the initial configuration, and the share of what a step can
  mjtNum bristle_rate;  // bear that a bristle is per mobility (watch_stiffness)
  int stiff_bristle;    // 1: a bristle is too stiff to be taken at the start of the step
  int64_t solves;       // how often its force was solved for, how often that stopped at its bound,
  int64_t stops;        // and how often the engine's solver left it a misfit
  int64_t misfits;
} Instance;

static inline Instance* instance_of(const mjData* d, int instance) {
  return (Instance*)d->plugin_data[instance];
}

// Whether an mjData was made without plugins.
static inline int instance_absent(const mjData* d, int instance) {
  return instance >= d->nplugin || !d->plugin_data || !d->plugin_data[instance];
}

// The slots at which the engine knows the plugin, for instances with and without a sensor
// (plugin.c); whether an instance of the model is a device.
extern int instance_slot_sensed, instance_slot_quiet;
static inline int instance_is_device(const mjModel* m, int instance) {
  return m->plugin[instance] == instance_slot_quiet || m->plugin[instance] == instance_slot_sensed;
}

// The actuator of an instance, or -1 with *count != 1.
int instance_actuator(const mjModel* m, int instance, int* count);

// Whether a sensor reads the instance.
int instance_sensed(const mjModel* m, int instance);

// Report what is wrong with an instance: who it is, then the text.
void instance_report(const mjModel* m, int instance, const char* text);

// What can go wrong while a model runs: each is said once per mjData.
typedef enum Complaint_ {
  COMPLAINT_FIT = 1 << 0,       // force and acceleration
  COMPLAINT_VALIDITY = 1 << 1,  // of a law
  COMPLAINT_BRISTLE = 1 << 2,   // too fast for RK4
  COMPLAINT_STIFF = 1 << 3,     // too stiff for the step
  COMPLAINT_SITES = 1 << 4,     // that meet
  COMPLAINT_STATE = 1 << 5,     // that is no number
  COMPLAINT_HEAT = 1 << 6,
  COMPLAINT_FORCE = 1 << 7
} Complaint;

void instance_complain(const mjModel* m, Instance* self, Complaint reason, const char* text);

// Whether a device has a series element; end stops.
static inline int instance_has_series(const InerterDevice* device) {
  return device->series_stiffness > 0 || device->series_damping > 0 || device->leak_damping > 0 ||
         device->leak_quadratic_damping > 0;
}
static inline int instance_has_stop(const InerterDevice* device) {
  return device->stop_stiffness > 0;
}

// Whether a device has friction with a state; friction whose sign is sharp, with a state or
// without.
static inline int instance_has_bristle(const InerterDevice* device) {
  return inerter_friction_nstate(device->friction) > 0;
}
static inline int instance_has_sharp_friction(const InerterDevice* device) {
  return device->friction != INERTER_FRICTION_none &&
         (!instance_has_bristle(device) || device->friction == INERTER_FRICTION_rate_state);
}

// Whether a device has viscoelastic branches, or dampers behind a spring.
static inline int instance_has_branches(const InerterDevice* device) {
  return device->nbranch > 0 || device->ndamper > 0;
}

// Whether friction acts at the flywheel, behind a series element.
static inline int instance_rubs_flywheel(const InerterDevice* device) {
  return instance_has_series(device) && device->friction_side == INERTER_SIDE_flywheel;
}

// Whether a device needs the acceleration although the engine integrates b: load friction, or an
// inertance that varies.
static inline int instance_varies(const InerterDevice* device) {
  return inerter_has_load_friction(device) || device->inertance_gradient != 0 ||
         device->inertance_curvature != 0 || device->inertance_speed_gradient != 0 ||
         inerter_has_curve(device, INERTER_STROKE_inertance) ||
         inerter_has_curve(device, INERTER_STROKE_inertance_back);
}

// Whether a numeric of the model holds a parameter of the device; the same, or the control sets it;
// one of these that the inertance comes from: its own, or the channel's where this is what states
// it.
int instance_has_numeric(const Instance* self, int parameter);
int instance_is_live(const Instance* self, int parameter);
int instance_has_live_inertance(const Instance* self);

// Make device and share anew if the model's armature or damping, or `force`, says so.
void instance_refresh(const mjModel* m, Instance* self, int force);

// Whether the actuator is disabled, its group or all of them; whether all that it moves sleeps; and
// one or the other: nothing but matter is left then.
int instance_disabled(const mjModel* m, const Instance* self);
int instance_asleep(const mjModel* m, const mjData* d, const Instance* self);
int instance_idle(const mjModel* m, const mjData* d, const Instance* self);

// Whether this evaluation is the engine's second look in the middle of a step, because trees have
// just fallen asleep: activations are those of the end of the step already.
int instance_sees_falling_asleep(const mjModel* m, const mjData* d);

// Displacement of the device: length of the actuator less the rest length. Every force law sees
// this one.
mjtNum instance_displacement(const mjModel* m, const mjData* d, const Instance* self);

// Velocity of the actuator at the present qvel, with the moment arms of the last forward pass.
mjtNum instance_velocity(const mjModel* m, const mjData* d, const Instance* self);

// Let the device pull with a force: it is the actuator's, but where the engine limits what
// actuators do. Motors have such limits, a device is none: there it takes the way of passive
// forces. The second takes that force away again; the third says that the engine has made passive
// forces anew.
void instance_pull(const mjModel* m, mjData* d, Instance* self, mjtNum force);
void instance_let_go(const mjModel* m, mjData* d, Instance* self);
void instance_passive_is_new(Instance* self);

// Add the actuator's moment arms, times a force, to a vector of the model's dofs.
void instance_add_moment(const mjModel* m, const mjData* d, const Instance* self, mjtNum force,
                         mjtNum* vec);

// Product of the actuator's moment arms and a vector of the model's dofs; the same with every term
// positive, which is what rounding is to be compared with.
mjtNum instance_along(const mjModel* m, const mjData* d, const Instance* self, const mjtNum* vec);
mjtNum instance_along_size(const mjModel* m, const mjData* d, const Instance* self,
                           const mjtNum* vec);

// The part of the actuator's acceleration that qvel alone causes: d(moment)/dt qvel.
mjtNum instance_bias_acceleration(const mjModel* m, const mjData* d, const Instance* self);

// Force of the plugin's share without what depends on the acceleration: inerter_force_motion.
double instance_force_motion(const Instance* self);

// First address of the device's states in mjData.act.
int instance_act(const mjModel* m, const Instance* self);

#endif  // INERTER_MUJOCO_INSTANCE_H_
