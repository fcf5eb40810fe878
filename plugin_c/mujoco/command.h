// The force that a control commands beside a device.

#ifndef INERTER_MUJOCO_COMMAND_H_
#define INERTER_MUJOCO_COMMAND_H_

#include <mujoco/mujoco.h>

// Commanded force parallel to the device [N]: the control, delayed and limited as for other
// actuators.
mjtNum command_force(const mjModel* m, const mjData* d, int actuator);

#endif  // INERTER_MUJOCO_COMMAND_H_
