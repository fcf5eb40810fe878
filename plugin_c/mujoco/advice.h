// What the compiler is told of a device, or of an engine, that may not be what is meant.

#ifndef INERTER_MUJOCO_ADVICE_H_
#define INERTER_MUJOCO_ADVICE_H_

#include "mujoco/instance.h"

// Refuse a device without anything, warn of friction without a word about the inertance. By the
// compiler's init. Return 0, or -1 with a message.
int advice_on_content(const mjModel* m, int instance, const Instance* self,
                      char message[INERTER_MESSAGE_SIZE]);

// Warn of what is wrong with this version of the engine, where the model meets it: once in a
// process.
void advice_on_engine(const mjModel* m);

#endif  // INERTER_MUJOCO_ADVICE_H_
