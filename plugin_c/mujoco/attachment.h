// Whether an actuator can carry a device.

#ifndef INERTER_MUJOCO_ATTACHMENT_H_
#define INERTER_MUJOCO_ATTACHMENT_H_

#include "core/device.h"
#include "mujoco/engine.h"

// Check what the device is attached to (a tendon or a slide or hinge joint that moves, trees that
// stay awake) and the number of its states. live: the inertance may become another. Return 0, or -1
// with a message.
int attachment_check(const mjModel* m, int actuator, const InerterDevice* device, int live,
                     char message[INERTER_MESSAGE_SIZE]);

// Whether the engine limits the forces of actuators where this one acts (forcerange,
// actuatorfrcrange of its tendon or of a joint that it moves).
int attachment_limited(const mjModel* m, int actuator);

// The geom that a tendon wraps around, or -1.
int attachment_wrapped_geom(const mjModel* m, int tendon);

// Name of an element of the model, or "(unnamed)".
const char* attachment_name(const mjModel* m, mjtObj type, int id);

// The one actuator that carries a device. Returns 0, or -1 with a message.
int attachment_find(const mjModel* m, int instance, int* actuator,
                    char message[INERTER_MESSAGE_SIZE]);

// Refuse trees that may fall asleep one without the other. Returns as above.
int attachment_check_sleep(const mjModel* m, int actuator, char message[INERTER_MESSAGE_SIZE]);

#endif  // INERTER_MUJOCO_ATTACHMENT_H_
