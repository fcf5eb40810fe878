// Parameters that can be changed while a model runs: see live.h.

#include "mujoco/live.h"

#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "mujoco/units.h"

// level [N] that friction has where a live one is 0: none, without another law
static const double kOpen = 1e-30;

static double* value_of(InerterDevice* device, int parameter) {
  return (double*)(void*)((char*)device + inerter_parameter(parameter)->offset);
}

// name of what can be live; NULL where there is nothing
static const char* key_of(int which) {
  if (which < INERTER_NPARAMETER) {
    return inerter_parameter(which)->name;
  }
  return which < LIVE_LIST ? NULL : inerter_list(which - LIVE_LIST)->name;
}

// What tells the numbers that a live parameter has from any others. Each step is one to one in its
// number: what changes in one alone is never missed, in several once in 2^64.
static uint64_t print_of(const mjModel* m, const LiveParameter* live) {
  uint64_t print = UINT64_C(14695981039346656037);
  for (int k = 0; k < live->count; k++) {
    uint64_t bits;
    memcpy(&bits, m->numeric_data + live->address + k, sizeof bits);
    print = (print ^ bits) * UINT64_C(0x9e3779b97f4a7c15);
    print ^= print >> 32;
  }
  return print;
}

//------------------------------ names -------------------------------------------------------------

// whether two pieces together are a name
static int joined(const char* name, const char* head, size_t length, const char* tail) {
  return name && !strncmp(name, head, length) && !strcmp(name + length, tail);
}

// The device of which two pieces of a numeric's name are the name, -1 without: the name of its
// actuator, else that of its instance, which stays when the actuator is renamed.
static int device_named(const mjModel* m, const char* head, size_t length, const char* tail) {
  for (int by_instance = 0; by_instance < 2; by_instance++) {
    for (int k = 0; k < m->nplugin; k++) {
      int count, id = by_instance ? k : instance_actuator(m, k, &count);
      if (instance_is_device(m, k) && id >= 0 &&
          joined(mj_id2name(m, by_instance ? mjOBJ_PLUGIN : mjOBJ_ACTUATOR, id), head, length,
                 tail)) {
        return k;
      }
    }
  }
  return -1;
}

// The device whose parameter a numeric holds, -1 without. An attachment with a suffix makes
// "a.viscous_right" of "a.viscous" and "a_right" of "a": what follows the parameter belongs to the
// device's name. The shortest that does counts, so that no parameter is taken for another.
static int owner(const mjModel* m, const char* name, int* parameter) {
  int found = -1;
  size_t shortest = SIZE_MAX;
  for (const char* dot = strchr(name, '.'); dot; dot = strchr(dot + 1, '.')) {
    for (int i = 0; i < NLIVE; i++) {
      const char* key = key_of(i);
      if (!key) {
        continue;
      }
      const char* tail = dot + 1 + strlen(key);
      if (strncmp(dot + 1, key, strlen(key)) != 0 || strlen(tail) >= shortest) {
        continue;
      }
      int device = device_named(m, name, (size_t)(dot - name), tail);
      if (device >= 0) {
        found = device;
        *parameter = i;
        shortest = strlen(tail);
      }
    }
  }
  return found;
}

int live_find(const mjModel* m, Instance* self, char message[INERTER_MESSAGE_SIZE]) {
  int instance = m->actuator_plugin[self->actuator];
  self->nlive = 0;
  for (int i = 0; i < m->nnumeric; i++) {
    int parameter = -1;
    const char* name = mj_id2name(m, mjOBJ_NUMERIC, i);
    if (!name || owner(m, name, &parameter) != instance) {
      continue;
    }
    if (m->numeric_size[i] != 1 && parameter < INERTER_NPARAMETER) {
      snprintf(message, INERTER_MESSAGE_SIZE,
               "numeric \"%.120s\" has %d values; a live parameter is one number", name,
               m->numeric_size[i]);
      return -1;
    }
    if (instance_has_numeric(self, parameter)) {
      snprintf(message, INERTER_MESSAGE_SIZE,
               "numeric \"%.120s\" is the second one that holds its %s: one is named after the "
               "actuator, one after the instance; remove one",
               name, key_of(parameter));
      return -1;
    }
    LiveParameter* live = self->live + self->nlive++;
    live->parameter = parameter;
    live->address = m->numeric_adr[i];
    live->count = m->numeric_size[i];
    live->print = print_of(m, live);
  }
  return 0;
}

// whether a numeric is named after a device ("strut.coulmb_force"): returns what follows, or NULL
static const char* named_after(const mjModel* m, const char* name) {
  for (const char* dot = strchr(name, '.'); dot; dot = strchr(dot + 1, '.')) {
    if (device_named(m, name, (size_t)(dot - name), "") >= 0) {
      return dot + 1;
    }
  }
  return NULL;
}

int live_check_names(const mjModel* m, char message[INERTER_MESSAGE_SIZE]) {
  for (int i = 0; i < m->nnumeric; i++) {
    int parameter = -1;
    const char* name = mj_id2name(m, mjOBJ_NUMERIC, i);
    if (!name || owner(m, name, &parameter) >= 0) {
      continue;
    }
    const char *last = strrchr(name, '.'), *rest = named_after(m, name);
    if (rest) {
      snprintf(message, INERTER_MESSAGE_SIZE,
               "numeric \"%.120s\" is named after a device, but \"%.60s\" is not a parameter "
               "that can be live; see `inerter parameters`, or give the numeric another name",
               name, rest);
      return -1;
    }
    for (int k = 0; last && k < NLIVE; k++) {
      if (key_of(k) && !strcmp(last + 1, key_of(k))) {
        snprintf(message, INERTER_MESSAGE_SIZE,
                 "numeric \"%.120s\" has the name of a live parameter, but no device is named "
                 "\"%.*s\" (neither its actuator nor its instance), so that it would hold nothing; "
                 "name it after a device, or give it a name without \".%s\"",
                 name, (int)mjMIN(last - name, 120), name, last + 1);
        return -1;
      }
    }
  }
  return 0;
}

//------------------------------ values ------------------------------------------------------------

int live_derive(const mjModel* m, Instance* self, char message[INERTER_MESSAGE_SIZE]) {
  self->device = self->stated;
  for (int k = 0; k < self->nlive; k++) {
    LiveParameter* live = self->live + k;
    live->print = print_of(m, live);
    if (live->parameter >= LIVE_LIST) {
      if (inerter_set_list(&self->device, live->parameter - LIVE_LIST, live->count,
                           m->numeric_data + live->address, message)) {
        return -1;
      }
      continue;
    }
    *value_of(&self->device, live->parameter) = m->numeric_data[live->address];
    inerter_mark_given(&self->device, live->parameter);
  }
  InerterDevice* device = &self->device;
  int open = device->friction != INERTER_FRICTION_none && device->coulomb_force == 0;
  if (open && instance_is_live(self, INERTER_INDEX_coulomb_force)) {
    device->coulomb_force = kOpen;
    if (inerter_is_given(device, INERTER_INDEX_static_force) && device->static_force == 0) {
      device->static_force = kOpen;
    }
  }
  if (inerter_finish(device, message)) {
    return -1;
  }
  int nstate = inerter_nstate(&self->device), actdim = m->actuator_actnum[self->actuator];
  if (nstate != actdim) {
    snprintf(message, INERTER_MESSAGE_SIZE,
             "these values need %d states, but the model was compiled with actdim=\"%d\"; state "
             "the larger device and vary it between values > 0",
             nstate, actdim);
    return -1;
  }
  self->rest_length = self->device.rest_length;
  self->viscous = self->device.viscous;
  self->device.rest_length = 0;
  self->timestep = 0;  // look at its stiffness anew
  instance_refresh(m, self, 1);
  return 0;
}

void live_update(const mjModel* m, Instance* self) {
  int changed = 0;
  for (int k = 0; k < self->nlive; k++) {
    changed |= print_of(m, self->live + k) != self->live[k].print;
  }
  if (!changed) {
    instance_refresh(m, self, 0);
    return;
  }
  char message[INERTER_MESSAGE_SIZE], text[INERTER_MESSAGE_SIZE];
  if (live_derive(m, self, text)) {
    // not taken over: seen again at the next evaluation, and again an error unless it is mended
    for (int k = 0; k < self->nlive; k++) {
      self->live[k].print = ~print_of(m, self->live + k);
    }
    const char* name = mj_id2name(m, mjOBJ_ACTUATOR, self->actuator);
    units_of_actuator(m, self->actuator, text, message);
    mju_error("inerter.device, actuator \"%.60s\": live parameters: %s", name ? name : "", message);
  }
}

int inerter_live_address(const mjModel* m, int instance, int parameter) {
  for (int i = 0; i < m->nnumeric; i++) {
    int held = -1;
    const char* name = mj_id2name(m, mjOBJ_NUMERIC, i);
    if (name && owner(m, name, &held) == instance && held == parameter) {
      return m->numeric_adr[i];
    }
  }
  return -1;
}
