// From the attributes of a plugin instance to a device: see configuration.h.

#include "mujoco/configuration.h"

// NOLINTBEGIN(bugprone-suspicious-missing-comma)
const char* const kAttributes[NATTRIBUTE] = {
#define X(name, ...) #name,
    INERTER_PARAMETERS(X)
#undef X
        "friction",
    "gas_law",
    "friction_side",
    "control",
#define X(name, ...) #name "_curve", #name "_periods",
    INERTER_STROKES(X)
#undef X
        "force_map",
};
// NOLINTEND(bugprone-suspicious-missing-comma)

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

uint64_t configuration_print(const mjModel* m, int instance) {
  // FNV-1a over the texts of the attributes, which lie one after another
  int end = instance + 1 < m->nplugin ? m->plugin_attradr[instance + 1] : (int)m->npluginattr;
  uint64_t print = UINT64_C(14695981039346656037);
  for (int i = m->plugin_attradr[instance]; i < end; i++) {
    print = (print ^ (unsigned char)m->plugin_attr[i]) * UINT64_C(1099511628211);
  }
  const uint64_t sizes[] = {(uint64_t)m->nnumeric, (uint64_t)m->nnumericdata, (uint64_t)m->nnames,
                            (uint64_t)m->nactuator, (uint64_t)m->nsensor};
  for (size_t i = 0; i < sizeof(sizes) / sizeof(*sizes); i++) {
    print = (print ^ sizes[i]) * UINT64_C(1099511628211);
  }
  return print;
}
