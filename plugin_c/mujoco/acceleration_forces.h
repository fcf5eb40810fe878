// Forces that depend on the acceleration, of all devices of a model, solved together.

#ifndef INERTER_MUJOCO_ACCELERATION_FORCES_H_
#define INERTER_MUJOCO_ACCELERATION_FORCES_H_

#include "mujoco/instance.h"

// Whether a device has any beside its constant inertance.
int acceleration_forces_needed(const InerterDevice* device);

// Add them for every instance of this plugin to actuator_force, and the heat to its power. Runs in
// the last instance, when the forces of the others stand in actuator_force.
void acceleration_forces_solve(const mjModel* m, mjData* d, int instance);

#endif  // INERTER_MUJOCO_ACCELERATION_FORCES_H_
