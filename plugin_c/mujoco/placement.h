// Where the inertance and the viscous damping of a device live: in the engine or in the plugin.

#ifndef INERTER_MUJOCO_PLACEMENT_H_
#define INERTER_MUJOCO_PLACEMENT_H_

#include "core/device.h"
#include "mujoco/engine.h"

// Place inertance and viscous damping in the model: the first time, by the compiler's init, into
// the actuator's armature and damping where the engine can hold them. *native: whether it does.
// Return 0, or -1 with a message.
int placement_decide(const mjModel* m, int actuator, const InerterDevice* device, int* native,
                     char message[INERTER_MESSAGE_SIZE]);

// Whether the model is being compiled: nothing is placed yet.
int placement_is_new(const mjModel* m, int actuator);

// By the compiler's init, when the last device is placed: derive anew what depends on the armature
// and damping of actuators.
void placement_finish(const mjModel* m);

#endif  // INERTER_MUJOCO_PLACEMENT_H_
