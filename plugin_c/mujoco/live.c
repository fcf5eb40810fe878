// Parameters that can be changed while a model runs: see live.h.

#include "mujoco/live.h"

#include <stdio.h>
#include <string.h>

static double* value_of(InerterDevice* device, int parameter) {
  return (double*)(void*)((char*)device + inerter_parameter(parameter)->offset);
}

// whether a name continues an actuator's name of this length to that of another actuator: "car" to
// "car.front" in "car.front.inertance"
static int names_longer(const mjModel* m, const char* name, size_t length) {
  char other[256];
  size_t end = (size_t)(strrchr(name, '.') - name);
  if (end <= length || end >= sizeof(other)) {
    return 0;
  }
  memcpy(other, name, end);
  other[end] = 0;
  return mj_name2id(m, mjOBJ_ACTUATOR, other) >= 0;
}

int live_find(const mjModel* m, Instance* self, char message[INERTER_MESSAGE_SIZE]) {
  const char* actuator = mj_id2name(m, mjOBJ_ACTUATOR, self->actuator);
  self->nlive = 0;
  if (!actuator || !*actuator) {
    return 0;
  }
  for (int i = 0; i < INERTER_NPARAMETER; i++) {
    char name[256];
    snprintf(name, sizeof(name), "%.150s.%s", actuator, inerter_parameter(i)->name);
    int numeric = mj_name2id(m, mjOBJ_NUMERIC, name);
    if (numeric < 0) {
      continue;
    }
    if (m->numeric_size[numeric] != 1) {
      snprintf(message, INERTER_MESSAGE_SIZE,
               "numeric \"%.120s\" has %d values; a live parameter is one number", name,
               m->numeric_size[numeric]);
      return -1;
    }
    LiveParameter* live = self->live + self->nlive++;
    live->parameter = i;
    live->address = m->numeric_adr[numeric];
    live->value = m->numeric_data[live->address];
  }

  // a numeric named after this actuator alone, but after no parameter, is a slip
  size_t length = strlen(actuator);
  for (int i = 0; i < m->nnumeric; i++) {
    const char* name = mj_id2name(m, mjOBJ_NUMERIC, i);
    int ours = name && !strncmp(name, actuator, length) && name[length] == '.' &&
               !names_longer(m, name, length);
    for (int k = 0; ours && k < INERTER_NPARAMETER; k++) {
      ours = strcmp(name + length + 1, inerter_parameter(k)->name) != 0;
    }
    if (ours) {
      snprintf(message, INERTER_MESSAGE_SIZE,
               "numeric \"%.120s\" is named after this device, but \"%.60s\" is not a parameter "
               "that can be live; see `inerter parameters`, or give the numeric another name",
               name, name + length + 1);
      return -1;
    }
  }
  return 0;
}

int live_derive(const mjModel* m, Instance* self, char message[INERTER_MESSAGE_SIZE]) {
  self->device = self->stated;
  for (int k = 0; k < self->nlive; k++) {
    LiveParameter* live = self->live + k;
    live->value = m->numeric_data[live->address];
    *value_of(&self->device, live->parameter) = live->value;
    self->device.given |= UINT64_C(1) << live->parameter;
  }
  if (inerter_finish(&self->device, message)) {
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
    changed |= m->numeric_data[self->live[k].address] != self->live[k].value;
  }
  if (!changed) {
    instance_refresh(m, self, 0);
    return;
  }
  char message[INERTER_MESSAGE_SIZE];
  if (live_derive(m, self, message)) {
    const char* name = mj_id2name(m, mjOBJ_ACTUATOR, self->actuator);
    mju_error("inerter.device, actuator \"%.60s\": live parameters: %s", name, message);
  }
}
