// The smooth force without the forces that are sought: see smooth.h.

#include "mujoco/smooth.h"

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

// The forward pass from actuation on, without the forces that are sought, so that every other force
// is the engine's own. The engine comes back to this plugin on the way, which leaves the forces out
// then (Instance.probing). The discrete integrator builds its metric and its constraint rows in a
// place that only the whole pass reaches (a control callback is called once more then).
static void forward_without(const mjModel* m, mjData* d, int last) {
  mj_markStack(d);
  mjtNum* force = mj_stackAllocNum(d, m->nout);
  mju_copy(force, d->actuator_force, m->nout);
  Instance* self = instance_of(d, last);
  self->probing = 1;
  if (m->opt.integrator == mjINT_DISCRETE) {
    mj_forwardSkip(m, d, mjSTAGE_VEL, 1);
  } else {
    mj_fwdActuation(m, d);
    mj_fwdAcceleration(m, d);
  }
  self->probing = 0;

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
