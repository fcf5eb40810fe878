// Load friction mu |b a| sign(v): friction that grows with the force through the inertance.
//
//   F_i = phi_i |a_i|,  phi_i = mu_i b_i tanh(v_i / v_t)
//   a_i = a0_i - sum_j W_ij F_j,  W = J M^-1 J',  a0 = J M^-1 f + dJ/dt v
//
// a_i [m/s^2] acceleration of device i, a0 the one without load friction, f all smooth forces, M
// the inertia matrix with every inertance in it. The force depends on the acceleration that it
// causes. One device in closed form: a = a0 / (1 + W phi sgn(a0)), with W b < 1 and mu <= 1;
// several by going round until nothing changes (Gauss-Seidel; a contraction for the same reason).
// Why not the acceleration of the last step: friction then lags and feeds energy in.
// Not modelled: what is unknown when the engine asks for actuator forces. That is the forces of
// contacts, limits, equality constraints and friction loss, of plugins later in the model's list
// and of the friction of DC motors; with those acting, |b a| lacks their share.

#include "mujoco/load_friction.h"

#include <math.h>

// all smooth generalized forces known now
static void smooth_force(const mjModel* m, mjData* d, mjtNum* f) {
  for (int i = 0; i < m->nv; i++) {
    f[i] = d->qfrc_passive[i] - d->qfrc_bias[i] + d->qfrc_applied[i];
  }

  // actuators, with the limits that the engine applies after the plugins
  for (int i = 0; i < m->nactuator; i++) {
    for (int row = m->actuator_outadr[i]; row < m->actuator_outadr[i] + m->actuator_outnum[i];
         row++) {
      mjtNum force = d->actuator_force[row];
      if (m->actuator_forcelimited[i] && m->actuator_outnum[i] == 1) {
        force = mju_clip(force, m->actuator_forcerange[2 * i], m->actuator_forcerange[2 * i + 1]);
      }
      int start = d->moment_rowadr[row];
      for (int k = start; k < start + d->moment_rownnz[row]; k++) {
        f[d->moment_colind[k]] += d->actuator_moment[k] * force;
      }
    }
  }

  // gravity compensation by actuators
  if (m->flg_gravcomp && !(m->opt.disableflags & mjDSBL_GRAVITY)) {
    for (int i = 0; i < m->nv; i++) {
      f[i] += m->jnt_actgravcomp[m->dof_jntid[i]] ? d->qfrc_gravcomp[i] : 0;
    }
  }

  // forces applied to bodies
  for (int i = 1; i < m->nbody; i++) {
    const mjtNum* wrench = d->xfrc_applied + 6 * i;
    if (!mju_isZero(wrench, 6)) {
      mj_applyFT(m, d, wrench, wrench + 3, d->xipos + 3 * i, i, f);
    }
  }
}

// row of the moment arms of an actuator, dense
static void moment_row(const mjModel* m, const mjData* d, const Instance* self, mjtNum* row) {
  int output = m->actuator_outadr[self->actuator];
  int start = d->moment_rowadr[output];
  mju_zero(row, m->nv);
  for (int k = start; k < start + d->moment_rownnz[output]; k++) {
    row[d->moment_colind[k]] = d->actuator_moment[k];
  }
}

void load_friction_solve(const mjModel* m, mjData* d, int instance) {
  int nv = m->nv, n = 0;
  mj_markStack(d);
  Instance** devices = mj_stackAllocByte(d, m->nplugin * sizeof(Instance*), _Alignof(Instance*));
  mjtNum* phi = mj_stackAllocNum(d, m->nplugin);

  // devices that have load friction now
  for (int k = 0; k <= instance; k++) {
    if (m->plugin[k] != m->plugin[instance]) {
      continue;
    }
    Instance* self = instance_of(d, k);
    if (!self->device.load_friction || instance_idle(m, d, self)) {
      continue;
    }
    mjtNum velocity = d->actuator_velocity[m->actuator_outadr[self->actuator]];
    devices[n] = self;
    phi[n++] = inerter_load_factor(&self->device, velocity) * m->actuator_armature[self->actuator];
  }
  if (!n) {
    mj_freeStack(d);
    return;
  }

  // accelerations without load friction, and what a force of each device does to each
  mjtNum* f = mj_stackAllocNum(d, nv);
  mjtNum* J = mj_stackAllocNum(d, (size_t)n * nv);
  mjtNum* JM = mj_stackAllocNum(d, (size_t)n * nv);
  mjtNum* W = mj_stackAllocNum(d, (size_t)n * n);
  mjtNum* a0 = mj_stackAllocNum(d, n);
  mjtNum* a = mj_stackAllocNum(d, n);
  smooth_force(m, d, f);
  for (int i = 0; i < n; i++) {
    moment_row(m, d, devices[i], J + i * nv);
  }
  mj_solveM(m, d, JM, J, n);
  for (int i = 0; i < n; i++) {
    a[i] = a0[i] = mju_dot(JM + i * nv, f, nv) + instance_bias_acceleration(m, d, devices[i]);
    for (int j = 0; j < n; j++) {
      W[i * n + j] = mju_dot(JM + i * nv, J + j * nv, nv);
    }
  }

  // go round; one device is solved by the first round
  int rounds = n == 1 ? 1 : 100;
  for (int round = 0; round < rounds; round++) {
    mjtNum change = 0, size = 0;
    for (int i = 0; i < n; i++) {
      mjtNum rest = a0[i];
      for (int j = 0; j < n; j++) {
        rest -= j == i ? 0 : W[i * n + j] * phi[j] * fabs(a[j]);
      }
      mjtNum slope = 1 + W[i * n + i] * phi[i] * (rest < 0 ? -1 : 1);
      mjtNum next = rest / mju_max(slope, mjMINVAL);
      change = mju_max(change, fabs(next - a[i]));
      size = mju_max(size, fabs(next));
      a[i] = next;
    }
    if (change <= 1e-14 * size) {
      break;
    }
  }

  // forces and heat
  for (int i = 0; i < n; i++) {
    int row = m->actuator_outadr[devices[i]->actuator];
    mjtNum force = phi[i] * fabs(a[i]);
    d->actuator_force[row] -= force;
    devices[i]->power[MAXSTAGE - 1] += force * d->actuator_velocity[row];
  }
  mj_freeStack(d);
}
