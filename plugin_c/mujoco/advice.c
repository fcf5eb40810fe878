// What the compiler is told of a device that may not be what is meant: see advice.h.

#include "mujoco/advice.h"

#include <stdatomic.h>
#include <stdio.h>

#include "mujoco/engine.h"

int advice_on_content(const mjModel* m, int instance, const Instance* self,
                      char message[INERTER_MESSAGE_SIZE]) {
  int native = m->actuator_armature[self->actuator] != 0;
  int damped = m->actuator_damping[self->actuator] != 0;
  if (inerter_is_given(&self->device, INERTER_INDEX_inertance) || native) {
    return 0;
  }
  if (!inerter_states_something(&self->stated) && !self->device.parts && !self->nlive && !damped &&
      self->stated.friction == INERTER_FRICTION_none) {
    snprintf(message, INERTER_MESSAGE_SIZE,
             "nothing is configured: the device would do nothing; state inertance, or what else it "
             "has, as <config key=\"inertance\" value=\"...\"/>");
    return -1;
  }
  if (self->stated.friction != INERTER_FRICTION_none) {
    instance_report(
        m, instance,
        "inertance is not given: it runs as friction without one; if that is meant, say "
        "so: <config key=\"inertance\" value=\"0\"/>");
  }
  return 0;
}

void advice_on_engine(const mjModel* m) {
  static atomic_flag said = ATOMIC_FLAG_INIT;
  const char* fault = engine_fault(m);
  if (fault && !atomic_flag_test_and_set(&said)) {
    mju_warning("inerter.device: %s", fault);
  }
}
