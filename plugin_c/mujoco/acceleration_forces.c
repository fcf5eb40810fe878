// Forces that depend on the acceleration: the variable part of the inertance and load friction.
//
//   N_i = b_i(x) a_i + b_i'(x) v_i^2 / 2      inertance force
//   F_i = N_i - b_i a_i + lambda_i |N_i|      what of it the inertia matrix does not hold
//   a_i = a0_i - sum_j W_ij F_j,  W = J M^-1 J',  a0 = J M^-1 f + dJ/dt v
//
// a_i [m/s^2] acceleration of device i, a0 the one without these forces, f all smooth forces, M the
// inertia matrix with every constant inertance b in it, lambda = mu tanh(v / v_t). The forces
// depend on the acceleration that they cause. For given signs of N this is linear, n equations for
// n devices; the signs are corrected until they fit. With W b < 1, b(x) > 0 and mu <= 1 there is
// one solution.
//
// Why not the acceleration of the last step: friction then lags and feeds energy in.
//
// Not modelled: what is unknown when the engine asks for actuator forces. That is the forces of
// contacts, limits, equality constraints and friction loss, of plugins later in the model's list
// and of the friction of DC motors; with those acting, a lacks their share.

#include "mujoco/acceleration_forces.h"

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

int acceleration_forces_needed(const InerterDevice* device) {
  return device->load_friction != 0 || device->inertance_gradient != 0 ||
         device->inertance_curvature != 0;
}

// one device in the equations above
typedef struct Unknown_ {
  Instance* instance;
  mjtNum constant;   // b, in the inertia matrix [kg]
  mjtNum inertance;  // b(x) [kg]
  mjtNum offset;     // b'(x) v^2 / 2 [N]
  mjtNum load;       // lambda
  mjtNum sign;       // of N
  mjtNum free;       // a0 [m/s^2]
  mjtNum a;          // a [m/s^2]
} Unknown;

// Solve the n x n system A x = y by elimination with row exchange; A and y are destroyed.
static void solve_dense(int n, mjtNum* A, mjtNum* y, mjtNum* x) {
  for (int c = 0; c < n; c++) {
    int pivot = c;
    for (int r = c + 1; r < n; r++) {
      pivot = fabs(A[r * n + c]) > fabs(A[pivot * n + c]) ? r : pivot;
    }
    for (int k = 0; k < n; k++) {
      mjtNum swapped = A[c * n + k];
      A[c * n + k] = A[pivot * n + k];
      A[pivot * n + k] = swapped;
    }
    mjtNum swapped = y[c];
    y[c] = y[pivot];
    y[pivot] = swapped;
    for (int r = c + 1; r < n; r++) {
      mjtNum factor = A[r * n + c] / A[c * n + c];
      for (int k = c; k < n; k++) {
        A[r * n + k] -= factor * A[c * n + k];
      }
      y[r] -= factor * y[c];
    }
  }
  for (int r = n - 1; r >= 0; r--) {
    x[r] = y[r];
    for (int k = r + 1; k < n; k++) {
      x[r] -= A[r * n + k] * x[k];
    }
    x[r] /= A[r * n + r];
  }
}

// collect the devices that have such forces now
static int collect(const mjModel* m, const mjData* d, int last, Unknown* unknowns) {
  int n = 0;
  for (int k = 0; k <= last; k++) {
    if (m->plugin[k] != m->plugin[last]) {
      continue;
    }
    Instance* self = instance_of(d, k);
    if (!acceleration_forces_needed(&self->device) || instance_idle(m, d, self)) {
      continue;
    }
    InerterDevice device = instance_device(m, self);
    mjtNum v = d->actuator_velocity[m->actuator_outadr[self->actuator]], slope;
    Unknown* u = unknowns + n++;
    u->instance = self;
    u->constant = device.inertance;
    u->inertance = inerter_inertance(&device, instance_displacement(m, d, self), &slope);
    u->offset = 0.5 * slope * v * v;
    u->load = inerter_load_factor(&device, v);
  }
  return n;
}

void acceleration_forces_solve(const mjModel* m, mjData* d, int instance) {
  int nv = m->nv;
  mj_markStack(d);
  Unknown* u = mj_stackAllocByte(d, m->nplugin * sizeof(Unknown), _Alignof(Unknown));
  int n = collect(m, d, instance, u);
  if (!n) {
    mj_freeStack(d);
    return;
  }

  // accelerations without these forces, and what a force of each device does to each
  mjtNum* f = mj_stackAllocNum(d, nv);
  mjtNum* J = mj_stackAllocNum(d, (size_t)n * nv);
  mjtNum* JM = mj_stackAllocNum(d, (size_t)n * nv);
  mjtNum* W = mj_stackAllocNum(d, (size_t)n * n);
  smooth_force(m, d, f);
  for (int i = 0; i < n; i++) {
    moment_row(m, d, u[i].instance, J + i * nv);
  }
  mj_solveM(m, d, JM, J, n);
  for (int i = 0; i < n; i++) {
    u[i].free = mju_dot(JM + i * nv, f, nv) + instance_bias_acceleration(m, d, u[i].instance);
    u[i].sign = u[i].inertance * u[i].free + u[i].offset < 0 ? -1 : 1;
    for (int j = 0; j < n; j++) {
      W[i * n + j] = mju_dot(JM + i * nv, J + j * nv, nv);
    }
  }

  // solve for these signs, correct them, until they fit
  mjtNum* A = mj_stackAllocNum(d, (size_t)n * n);
  mjtNum* y = mj_stackAllocNum(d, n);
  mjtNum* a = mj_stackAllocNum(d, n);
  for (int fits = 0, round = 0; !fits && round < 2 + 4 * n; round++) {
    for (int i = 0; i < n; i++) {
      y[i] = u[i].free;
      for (int j = 0; j < n; j++) {
        mjtNum share = 1 + u[j].load * u[j].sign;
        A[i * n + j] = (i == j) + W[i * n + j] * (share * u[j].inertance - u[j].constant);
        y[i] -= W[i * n + j] * share * u[j].offset;
      }
    }
    solve_dense(n, A, y, a);
    fits = 1;
    for (int i = 0; i < n; i++) {
      u[i].a = a[i];
      mjtNum sign = u[i].inertance * a[i] + u[i].offset < 0 ? -1 : 1;
      fits &= sign == u[i].sign || u[i].load == 0;
      u[i].sign = sign;
    }
  }

  // forces and heat
  for (int i = 0; i < n; i++) {
    int row = m->actuator_outadr[u[i].instance->actuator];
    mjtNum N = u[i].inertance * u[i].a + u[i].offset;
    mjtNum friction = u[i].load * fabs(N);
    d->actuator_force[row] -= N - u[i].constant * u[i].a + friction;
    u[i].instance->power[MAXSTAGE - 1] += friction * d->actuator_velocity[row];
  }
  mj_freeStack(d);
}
