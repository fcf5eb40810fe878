// What a control commands: a force beside the device, or the value of a parameter.

#ifndef INERTER_MUJOCO_COMMAND_H_
#define INERTER_MUJOCO_COMMAND_H_

#include "mujoco/instance.h"

// The control, delayed and limited as for other actuators: a force parallel to the device [N], or a
// value of the parameter that it sets. NaN where the actuator has none.
mjtNum command_value(const mjModel* m, const mjData* d, int actuator);

// Commanded force parallel to the device [N].
mjtNum command_force(const mjModel* m, const mjData* d, const Instance* self);

// Let the device have the value that its control, and the state of it in mjData.act, say now.
void command_take_value(const mjModel* m, const mjData* d, Instance* self);
static inline void command_take(const mjModel* m, const mjData* d, Instance* self) {
  if (self->device.control != INERTER_CONTROL_force) {
    command_take_value(m, d, self);
  }
}

// By the compiler's init: the range of a control that sets a parameter. Return 0, or -1 with a
// message.
int command_range(const mjModel* m, int actuator, const InerterDevice* device,
                  char message[INERTER_MESSAGE_SIZE]);

#endif  // INERTER_MUJOCO_COMMAND_H_
