// What goes wrong while a model runs: see watch.h.

#include "mujoco/watch.h"

#include <math.h>
#include <stdio.h>

void watch_validity(const mjModel* m, Instance* self, const mjtNum* state) {
  char message[INERTER_MESSAGE_SIZE];
  if (!self->complained && !inerter_valid(&self->device, self->x, state, message)) {
    instance_complain(m, self, message);
  }
}

void watch_bristle(const mjModel* m, Instance* self, double x, double v, const mjtNum* state,
                   mjtNum* rate) {
  const InerterDevice* device = &self->device;
  int bristle = device->friction == INERTER_FRICTION_dahl ||
                device->friction == INERTER_FRICTION_lugre ||
                device->friction == INERTER_FRICTION_bouc_wen;
  if (m->opt.integrator != mjINT_RK4 || !bristle || v == 0) {
    return;
  }

  // slope of the rate over the state, a little beyond the state
  double there[INERTER_MAXSTATE], beyond[INERTER_MAXSTATE];
  double step = 1e-6 * fabs(state[0]) + 1e-15;
  mju_copy(there, state, inerter_nstate(device));
  there[0] += step;
  inerter_state_rate(device, x, v, there, beyond);
  double decay = (rate[0] - beyond[0]) / step, fastest = 2 / m->opt.timestep;
  if (decay <= fastest) {
    return;
  }
  rate[0] *= fastest / decay;
  char message[INERTER_MESSAGE_SIZE];
  snprintf(message, sizeof(message),
           "at %g m/s the state of friction \"%s\" relaxes within %.2g s, faster than RK4 resolves "
           "with a timestep of %g s, and was slowed to that; for this law prefer "
           "integrator=\"implicitfast\", which steps it exactly, or shorten the timestep",
           v, inerter_friction_name(device->friction), 1 / decay, m->opt.timestep);
  instance_complain(m, self, message);
}
