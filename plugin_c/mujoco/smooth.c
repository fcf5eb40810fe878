// The smooth force without the forces that are sought: see smooth.h.

#include "mujoco/smooth.h"

#include <string.h>

#include "mujoco/instance.h"

// Whether the forces of all other actuators stand already, and nothing but them and what the
// forward pass has made of position and velocity goes into the smooth force.
static int stands(const mjModel* m, const mjData* d) {
  if (m->opt.integrator == mjINT_DISCRETE || m->opt.enableflags & mjENBL_SLEEP) {
    return 0;
  }
  for (int i = 0; i < m->nactuator; i++) {
    // cogging and friction of a motor are added after the plugins
    int motor = m->actuator_biastype[i] == mjBIAS_DCMOTOR;
    int other = m->actuator_plugin[i] >= 0 && !instance_is_device(m, m->actuator_plugin[i]);
    if (motor || other || (m->actuator_forcelimited[i] && m->actuator_outnum[i] != 1)) {
      return 0;
    }
  }
  for (int i = 0; m->ngravcomp && i < m->njnt; i++) {
    if (m->jnt_actgravcomp[i]) {
      return 0;
    }
  }
  return mju_isZero(d->xfrc_applied, 6 * m->nbody);
}

// what the engine leaves of the forces of actuators on limited tendons
static void limit_tendons(const mjModel* m, mjtNum* force) {
  for (int t = 0; t < m->ntendon; t++) {
    if (!m->tendon_actfrclimited[t]) {
      continue;
    }
    mjtNum total = 0, low = m->tendon_actfrcrange[2 * t], high = m->tendon_actfrcrange[2 * t + 1];
    for (int i = 0; i < m->nactuator; i++) {
      int here = m->actuator_trntype[i] == mjTRN_TENDON && m->actuator_trnid[2 * i] == t;
      total += here ? force[m->actuator_outadr[i]] : 0;
    }
    mjtNum kept = mju_clip(total, low, high);
    for (int i = 0; total != kept && i < m->nactuator; i++) {
      if (m->actuator_trntype[i] == mjTRN_TENDON && m->actuator_trnid[2 * i] == t) {
        force[m->actuator_outadr[i]] *= kept / total;
      }
    }
  }
}

// forces of the actuators on the dofs, limited as the engine does after the plugins
static void actuate(const mjModel* m, mjData* d, mjtNum* total) {
  mj_markStack(d);
  mjtNum* force = mj_stackAllocNum(d, m->nout);
  mju_copy(force, d->actuator_force, m->nout);
  limit_tendons(m, force);
  for (int i = 0; i < m->nactuator; i++) {
    const mjtNum* range = m->actuator_forcerange + 2 * i;
    if (m->actuator_forcelimited[i]) {
      mjtNum* limited = force + m->actuator_outadr[i];
      *limited = mju_clip(*limited, range[0], range[1]);
    }
  }
  mju_zero(total, m->nv);
  for (int row = 0; row < m->nout; row++) {
    int start = d->moment_rowadr[row], end = start + d->moment_rownnz[row];
    for (int k = start; force[row] != 0 && k < end; k++) {
      total[d->moment_colind[k]] += force[row] * d->actuator_moment[k];
    }
  }
  for (int j = 0; j < m->njnt; j++) {
    if (m->jnt_actfrclimited[j]) {
      mjtNum* limited = total + m->jnt_dofadr[j];
      *limited = mju_clip(*limited, m->jnt_actfrcrange[2 * j], m->jnt_actfrcrange[2 * j + 1]);
    }
  }
  mj_freeStack(d);
}

// That force. What actuators bring is left where the engine's derivatives look for it, to see which
// joints are at their limit: the force of the step before stands there.
static void add_up(const mjModel* m, mjData* d, mjtNum* smooth) {
  actuate(m, d, smooth);
  mju_copy(d->qfrc_actuator, smooth, m->nv);
  for (int i = 0; i < m->nv; i++) {
    smooth[i] += d->qfrc_passive[i] - d->qfrc_bias[i] + d->qfrc_applied[i];
  }
}

// The same while the engine adds up its passive forces, all actuation disabled: what it derives
// from the velocity after them is derived here.
static void add_up_early(const mjModel* m, mjData* d, mjtNum* smooth) {
  mj_referenceConstraint(m, d);
  mj_rne(m, d, 0, smooth);
  for (int i = 0; i < m->nv; i++) {
    smooth[i] = d->qfrc_passive[i] - smooth[i] + d->qfrc_applied[i];
  }
  for (int body = 1; body < m->nbody; body++) {
    const mjtNum* applied = d->xfrc_applied + 6 * body;
    if (!mju_isZero(applied, 6)) {
      mj_applyFT(m, d, applied, applied + 3, d->xipos + 3 * body, body, smooth);
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

void smooth_without(const mjModel* m, mjData* d, int last, mjtNum* force, mjtNum* shift) {
  mju_zero(shift, m->nv);
  if (m->opt.disableflags & mjDSBL_ACTUATION) {
    add_up_early(m, d, force);
  } else if (stands(m, d)) {
    add_up(m, d, force);
  } else {
    forward_without(m, d, last);
    mju_copy(force, d->qfrc_smooth, m->nv);
    if (m->opt.integrator == mjINT_DISCRETE && d->efm_active) {
      mju_copy(shift, d->efm_c, m->nv);
      if (d->efm_ca) {
        mju_addTo(shift, d->efm_ca, m->nv);
      }
    }
  }
}
