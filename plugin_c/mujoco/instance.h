// One plugin instance: a device and the actuator that carries it.

#ifndef INERTER_MUJOCO_INSTANCE_H_
#define INERTER_MUJOCO_INSTANCE_H_

#include <mujoco/mujoco.h>

#include "core/device.h"

_Static_assert(sizeof(mjtNum) == sizeof(double), "the plugin is built for double precision");

// most stages of an integrator
enum { MAXSTAGE = 4 };

// What an mjData keeps of an instance between the callbacks of one step. Everything that has to
// survive a step is in mjData.act and mjData.plugin_state.
typedef struct Instance_ {
  InerterDevice device;     // inertance, viscous: 0, the engine integrates them; rest_length: 0
  mjtNum rest_length;       // actuator length at which the displacement is 0
  int actuator;             // index of the actuator
  int sensed;               // 1: a sensor reads this instance
  int solves_acceleration;  // 1: finds the acceleration forces of every instance of the model
  double state;             // state at the last evaluation
  double power[MAXSTAGE];   // dissipated power at the last evaluations, newest last [W]
} Instance;

static inline Instance* instance_of(const mjData* d, int instance) {
  return (Instance*)d->plugin_data[instance];
}

// The actuator of an instance, or -1 with *count != 1.
int instance_actuator(const mjModel* m, int instance, int* count);

// Whether a sensor reads the instance.
int instance_sensed(const mjModel* m, int instance);

// Report what is wrong with an instance: who it is, then the text.
void instance_report(const mjModel* m, int instance, const char* text);

// The device as the engine integrates it now: with the actuator's armature and damping.
InerterDevice instance_device(const mjModel* m, const Instance* self);

// Whether the actuator does nothing now: its group or all actuation is disabled, or it sleeps.
int instance_idle(const mjModel* m, const mjData* d, const Instance* self);

// Displacement of the device: length of the actuator less the rest length. Every force law sees
// this one.
mjtNum instance_displacement(const mjModel* m, const mjData* d, const Instance* self);

// Velocity of the actuator at the present qvel, with the moment arms of the last forward pass.
mjtNum instance_velocity(const mjModel* m, const mjData* d, const Instance* self);

// The part of the actuator's acceleration that qvel alone causes: d(moment)/dt qvel.
mjtNum instance_bias_acceleration(const mjModel* m, mjData* d, const Instance* self);

#endif  // INERTER_MUJOCO_INSTANCE_H_
