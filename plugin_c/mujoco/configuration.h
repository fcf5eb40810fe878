// From the attributes of a plugin instance to a device.

#ifndef INERTER_MUJOCO_CONFIGURATION_H_
#define INERTER_MUJOCO_CONFIGURATION_H_

#include "mujoco/instance.h"

// names of the attributes: every parameter of the device, and "friction"
enum { NATTRIBUTE = INERTER_NPARAMETER + 1 };
extern const char* const kAttributes[NATTRIBUTE];

// Read the device of an instance. Return 0, or -1 with a message as in inerter_set.
int configuration_read(const mjModel* m, int instance, InerterDevice* device,
                       char message[INERTER_MESSAGE_SIZE]);

#endif  // INERTER_MUJOCO_CONFIGURATION_H_
