// Parameters that can be changed while a model runs.
//
//   <custom><numeric name="strut.coulomb_force" data="10"/></custom>
//
// A numeric named after the actuator (or the plugin instance) and a parameter holds that parameter:
// its value is read at every evaluation, in place of the configured one. A sweep writes
// mjModel.numeric_data and needs no recompile; in a batch the field is expanded and every
// simulation has its own. Prefix and suffix of an attached model are followed:
// "/strut.coulomb_force_left" belongs to "/strut_left".

#ifndef INERTER_MUJOCO_LIVE_H_
#define INERTER_MUJOCO_LIVE_H_

#include "mujoco/instance.h"

// Find the numerics of a device. Return 0, or -1 with a message (a wrong size, one too many).
int live_find(const mjModel* m, Instance* self, char message[INERTER_MESSAGE_SIZE]);

// By the compiler's init: whether every numeric that has the name of a live parameter belongs to a
// device. Return 0, or -1 with a message.
int live_check_names(const mjModel* m, char message[INERTER_MESSAGE_SIZE]);

// Address in numeric_data of what holds a parameter of an instance, -1 without; for Python.
INERTER_API int inerter_live_address(const mjModel* m, int instance, int parameter);

// Make the device of what is stated and what the numerics hold. Return 0, or -1 with a message.
int live_derive(const mjModel* m, Instance* self, char message[INERTER_MESSAGE_SIZE]);

// Take over what has changed in numerics and native fields. Values that cannot be are an error of
// the engine: Python raises it, a batch reports it for the one simulation.
void live_update(const mjModel* m, Instance* self);

#endif  // INERTER_MUJOCO_LIVE_H_
