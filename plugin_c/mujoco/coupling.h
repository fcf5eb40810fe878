// Where the inertance and the viscous damping live: in the actuator's own armature and damping.

#ifndef INERTER_MUJOCO_COUPLING_H_
#define INERTER_MUJOCO_COUPLING_H_

#include "mujoco/instance.h"

// Check the actuator that carries a device. Return 0, or -1 with a message.
int coupling_check(const mjModel* m, int actuator, const InerterDevice* device,
                   char message[INERTER_MESSAGE_SIZE]);

// Put inertance and viscous damping of the device into the model, once, while it is compiled.
// Return 0, or -1 with a message.
int coupling_place(const mjModel* m, int actuator, const InerterDevice* device,
                   char message[INERTER_MESSAGE_SIZE]);

#endif  // INERTER_MUJOCO_COUPLING_H_
