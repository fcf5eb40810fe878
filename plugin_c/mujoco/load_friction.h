// Load friction mu |b a| sign(v) of all devices of a model, solved together.

#ifndef INERTER_MUJOCO_LOAD_FRICTION_H_
#define INERTER_MUJOCO_LOAD_FRICTION_H_

#include "mujoco/instance.h"

// Add the load friction of every instance of this plugin to actuator_force and to its power. Runs
// in the last instance, when the forces of the others stand in actuator_force.
void load_friction_solve(const mjModel* m, mjData* d, int instance);

#endif  // INERTER_MUJOCO_LOAD_FRICTION_H_
