// What a sensor of the plugin shows.

#ifndef INERTER_MUJOCO_SENSOR_H_
#define INERTER_MUJOCO_SENSOR_H_

#include "mujoco/instance.h"

// Number of values: total, inertance and friction force, each state, stored and dissipated energy.
int sensor_size(int nstate);

// Forces of the device in the engine's balance of mj_forward: in the device's place they would give
// the same qacc. Their inertance force is B times qacc's acceleration where the engine holds the
// inertance, and times that of the step, (v_next - v) / h, where it was solved for: the two differ
// under implicit, implicitfast and Euler with joint damping. Runs after the constraint solver.
InerterForce sensor_force(const mjModel* m, const mjData* d, const Instance* self);

// Write the values into mjData.sensordata; runs after the constraint solver.
void sensor_compute(const mjModel* m, mjData* d, int instance);

#endif  // INERTER_MUJOCO_SENSOR_H_
