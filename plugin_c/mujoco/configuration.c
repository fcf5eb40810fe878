// From the attributes of a plugin instance to a device: see configuration.h.

#include "mujoco/configuration.h"

const char* const kAttributes[NATTRIBUTE] = {
#define X(name, ...) #name,
    INERTER_PARAMETERS(X)
#undef X
        "friction",
    "gas_law",
};

int configuration_read(const mjModel* m, int instance, InerterDevice* device,
                       char message[INERTER_MESSAGE_SIZE]) {
  inerter_default(device);
  for (int i = 0; i < NATTRIBUTE; i++) {
    // what the model does not state has an empty text
    const char* text = mj_getPluginConfig(m, instance, kAttributes[i]);
    if (text && *text && inerter_set(device, kAttributes[i], text, message)) {
      return -1;
    }
  }
  return 0;
}
