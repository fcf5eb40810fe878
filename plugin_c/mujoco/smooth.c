// The smooth force without the forces that are sought: see smooth.h.

#include "mujoco/smooth.h"

#include <string.h>

#include "mujoco/instance.h"

// Whether the forces of all other actuators stand already, and nothing but them and what the
// forward pass has made of position and velocity goes into the smooth force.
static int stands(const mjModel* m, const mjData* d) {
  if (m->opt.integrator == mjINT_DISCRETE || m->opt.enableflags & mjENBL_SLEEP || m->ngravcomp) {
    return 0;
  }
  for (int i = 0; i < m->nactuator; i++) {
    // cogging and friction of a motor are added after the plugins
    int motor = m->actuator_biastype[i] == mjBIAS_DCMOTOR;
    int other = m->actuator_plugin[i] >= 0 && !instance_is_device(m, m->actuator_plugin[i]);
    if (motor || other || m->actuator_forcelimited[i]) {
      return 0;
    }
  }
  for (int i = 0; i < m->ntendon; i++) {
    if (m->tendon_actfrclimited[i]) {
      return 0;
    }
  }
  for (int i = 0; i < m->njnt; i++) {
    if (m->jnt_actfrclimited[i]) {
      return 0;
    }
  }
  return mju_isZero(d->xfrc_applied, 6 * m->nbody);
}

// that force
static void add_up(const mjModel* m, const mjData* d, mjtNum* smooth) {
  for (int i = 0; i < m->nv; i++) {
    smooth[i] = d->qfrc_passive[i] - d->qfrc_bias[i] + d->qfrc_applied[i];
  }
  for (int row = 0; row < m->nout; row++) {
    mjtNum force = d->actuator_force[row];
    int start = d->moment_rowadr[row], end = start + d->moment_rownnz[row];
    for (int k = start; force != 0 && k < end; k++) {
      smooth[d->moment_colind[k]] += force * d->actuator_moment[k];
    }
  }
}

// What a control callback writes: controls and applied forces, one after another.
static int input_size(const mjModel* m) {
  return (int)m->nu + (int)m->nv + 6 * (int)m->nbody;
}

static void get_input(const mjModel* m, const mjData* d, mjtNum* input) {
  mju_copy(input, d->ctrl, m->nu);
  mju_copy(input + m->nu, d->qfrc_applied, m->nv);
  mju_copy(input + m->nu + m->nv, d->xfrc_applied, 6 * m->nbody);
}

static void set_input(const mjModel* m, mjData* d, const mjtNum* input) {
  mju_copy(d->ctrl, input, m->nu);
  mju_copy(d->qfrc_applied, input + m->nu, m->nv);
  mju_copy(d->xfrc_applied, input + m->nu + m->nv, 6 * m->nbody);
}

// The engine comes back to this plugin on the way, which leaves the forces out then, and takes the
// flag back: it must not stay where an error of a callback ends the pass.
static void actuate_without(const mjModel* m, mjData* d, Instance* self) {
  self->probing = 1;
  mj_fwdActuation(m, d);
  mj_fwdAcceleration(m, d);
}

// The discrete integrator builds its metric and its constraint rows in a place that only the whole
// pass reaches. A control callback is called once more then; the input of the step is what the
// first call, or the user after it, has left.
static void pass_without(const mjModel* m, mjData* d, Instance* self) {
  if (!mjcb_control) {
    self->probing = 1;
    mj_forwardSkip(m, d, mjSTAGE_VEL, 1);
    return;
  }
  mj_markStack(d);
  int size = input_size(m);
  mjtNum* input = mj_stackAllocNum(d, size);
  mjtNum* now = mj_stackAllocNum(d, size);
  get_input(m, d, input);
  self->probing = 1;
  mj_forwardSkip(m, d, mjSTAGE_VEL, 1);
  get_input(m, d, now);
  if (memcmp(now, input, sizeof(mjtNum) * (size_t)size) != 0) {
    set_input(m, d, input);
    actuate_without(m, d, self);
  }
  mj_freeStack(d);
}

// The forward pass from actuation on, without the forces that are sought, so that every other force
// is the engine's own.
static void forward_without(const mjModel* m, mjData* d, int last) {
  mj_markStack(d);
  mjtNum* force = mj_stackAllocNum(d, m->nout);
  mju_copy(force, d->actuator_force, m->nout);
  Instance* self = instance_of(d, last);
  if (m->opt.integrator == mjINT_DISCRETE) {
    pass_without(m, d, self);
  } else {
    actuate_without(m, d, self);
  }

  // the outer pass goes on with the forces that it had
  mju_copy(d->actuator_force, force, m->nout);
  mj_freeStack(d);
}

void smooth_without(const mjModel* m, mjData* d, int last, mjtNum* force, mjtNum* acceleration) {
  if (stands(m, d)) {
    add_up(m, d, force);
    mj_solveM(m, d, acceleration, force, 1);
  } else {
    forward_without(m, d, last);
    mju_copy(force, d->qfrc_smooth, m->nv);
    mju_copy(acceleration, d->qacc_smooth, m->nv);
  }
}
