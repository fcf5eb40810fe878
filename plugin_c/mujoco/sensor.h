// What a sensor of the plugin shows.

#ifndef INERTER_MUJOCO_SENSOR_H_
#define INERTER_MUJOCO_SENSOR_H_

#include "mujoco/instance.h"

// Number of values: total, inertance and friction force, each state, stored and dissipated energy.
int sensor_size(int nstate);

// Forces of the device as the model feels them now; runs after the constraint solver.
InerterForce sensor_force(const mjModel* m, const mjData* d, const Instance* self);

// Write the values into mjData.sensordata; runs after the constraint solver.
void sensor_compute(const mjModel* m, mjData* d, int instance);

#endif  // INERTER_MUJOCO_SENSOR_H_
