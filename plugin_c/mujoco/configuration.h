// From the attributes of a plugin instance to a device.

#ifndef INERTER_MUJOCO_CONFIGURATION_H_
#define INERTER_MUJOCO_CONFIGURATION_H_

#include "mujoco/instance.h"

// names of the attributes: every parameter of the device, "friction", "gas_law", "friction_side",
// "control", every list
enum { NATTRIBUTE = INERTER_NPARAMETER + 4 + INERTER_NLIST };
extern const char* const kAttributes[NATTRIBUTE];

// Read what is stated of the device of an instance; inerter_finish makes it whole. Return 0, or -1
// with a message as in inerter_set.
int configuration_read(const mjModel* m, int instance, InerterDevice* device,
                       char message[INERTER_MESSAGE_SIZE]);

// A number that tells configurations of an instance apart, and models by their sizes.
uint64_t configuration_print(const mjModel* m, int instance);

#endif  // INERTER_MUJOCO_CONFIGURATION_H_
