// Parameters that can be changed while a model runs.
//
//   <custom><numeric name="strut.coulomb_force" data="10"/></custom>
//
// A numeric named after the actuator and a parameter holds that parameter: its value is read at
// every evaluation, in place of the configured one. A sweep writes mjModel.numeric_data and needs
// no recompile; in a batch the field is expanded and every simulation has its own.

#ifndef INERTER_MUJOCO_LIVE_H_
#define INERTER_MUJOCO_LIVE_H_

#include "mujoco/instance.h"

// Find the numerics of a device. Return 0, or -1 with a message (a wrong size).
int live_find(const mjModel* m, Instance* self, char message[INERTER_MESSAGE_SIZE]);

// Make the device of what is stated and what the numerics hold. Return 0, or -1 with a message.
int live_derive(const mjModel* m, Instance* self, char message[INERTER_MESSAGE_SIZE]);

// Take over what has changed in numerics and native fields. Values that cannot be are an error of
// the engine: Python raises it, a batch reports it for the one simulation.
void live_update(const mjModel* m, Instance* self);

#endif  // INERTER_MUJOCO_LIVE_H_
