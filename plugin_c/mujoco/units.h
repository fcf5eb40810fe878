// Units in the messages of a device on a hinge.

#ifndef INERTER_MUJOCO_UNITS_H_
#define INERTER_MUJOCO_UNITS_H_

#include "core/device.h"
#include "mujoco/engine.h"

// A message of the core, which speaks of a line, in the units of what the actuator moves: of a
// hinge, or of a fixed tendon over hinges alone, rad, N m, kg m^2. actuator: may be -1.
void units_of_actuator(const mjModel* m, int actuator, const char* text,
                       char message[INERTER_MESSAGE_SIZE]);

#endif  // INERTER_MUJOCO_UNITS_H_
