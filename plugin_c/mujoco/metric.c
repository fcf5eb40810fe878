// The effective mass of a step: see metric.h.

#include "mujoco/metric.h"

#include "mujoco/engine_private.h"

//------------------------------ factors -----------------------------------------------------------

// factor H, whose lower half stands in metric->factor in the sparsity of M
static void factor_cholesky(const mjModel* m, mjData* d, Metric* metric) {
  metric->inverse = mj_stackAllocNum(d, m->nv);
  mj_factorI(metric->factor, metric->inverse, m->nv, m->M_rownnz, m->M_rowadr, m->M_colind, NULL);
}

// Euler: joint damping on the diagonal; returns 0 if there is none
static int add_joint_damping(const mjModel* m, const mjData* d, mjtNum* H) {
  int found = 0;
  for (int i = 0; i < m->nv; i++) {
    mjtNum poly[mjNPOLY];
    mju_copy(poly, m->dof_dampingpoly + mjNPOLY * i, mjNPOLY);
    mjtNum damping = m->dof_damping[i] + mj_actuatorDamping(m, mjOBJ_JOINT, m->dof_jntid[i], poly);
    mjtNum slope = mjd_xPolyForce(damping, poly, d->qvel[i], mjNPOLY, 1);
    H[m->M_rowadr[i] + m->M_rownnz[i] - 1] += m->opt.timestep * slope;
    found |= slope != 0;
  }
  return found;
}

// LU without fill-in, rows eliminated from the leaves to the root: in the sparsity of the tree
// every dof couples only with its ancestors and descendants
static void factor_lu(const mjModel* m, mjData* d, mjtNum* A) {
  mj_markStack(d);
  int* place = mj_stackAllocInt(d, m->nv);
  for (int i = 0; i < m->nv; i++) {
    place[i] = -1;
  }
  for (int k = m->nv - 1; k >= 0; k--) {
    int start = m->D_rowadr[k], diagonal = start + m->D_diag[k];
    for (int p = start; p < diagonal; p++) {
      // row i of an ancestor, less its multiple of row k
      int i = m->D_colind[p], first = m->D_rowadr[i], last = first + m->D_rownnz[i];
      for (int q = first; q < last; q++) {
        place[m->D_colind[q]] = q;
      }
      mjtNum ratio = A[place[k]] /= A[diagonal];
      for (int q = start; q < diagonal; q++) {
        A[place[m->D_colind[q]]] -= ratio * A[q];
      }
      for (int q = first; q < last; q++) {
        place[m->D_colind[q]] = -1;
      }
    }
  }
  mj_freeStack(d);
}

static void solve_lu(const mjModel* m, const mjtNum* A, mjtNum* x) {
  // upper part, leaves first
  for (int i = m->nv - 1; i >= 0; i--) {
    int start = m->D_rowadr[i], end = start + m->D_rownnz[i];
    for (int q = start + m->D_diag[i] + 1; q < end; q++) {
      x[i] -= A[q] * x[m->D_colind[q]];
    }
  }

  // lower part with the pivots
  for (int i = 0; i < m->nv; i++) {
    int start = m->D_rowadr[i], diagonal = start + m->D_diag[i];
    for (int q = start; q < diagonal; q++) {
      x[i] -= A[q] * x[m->D_colind[q]];
    }
    x[i] /= A[diagonal];
  }
}

//------------------------------ metric ------------------------------------------------------------

static Metric metric_of_euler(const mjModel* m, mjData* d) {
  Metric metric = {METRIC_INERTIA, NULL, NULL};
  if (m->opt.disableflags & (mjDSBL_EULERDAMP | mjDSBL_DAMPER)) {
    return metric;
  }
  metric.factor = mj_stackAllocNum(d, m->nC);
  mju_copy(metric.factor, d->M, m->nC);
  if (add_joint_damping(m, d, metric.factor)) {
    metric.kind = METRIC_CHOLESKY;
    factor_cholesky(m, d, &metric);
  }
  return metric;
}

static Metric metric_of_implicitfast(const mjModel* m, mjData* d) {
  Metric metric = {METRIC_CHOLESKY, mj_stackAllocNum(d, m->nC), NULL};
  mjd_smooth_vel(m, d, 0);
  for (int k = 0; k < m->nC; k++) {
    metric.factor[k] = d->M[k] - m->opt.timestep * d->qDeriv[m->mapD2M[k]];
  }

  // the engine solves free bodies apart, in full: here they keep the plain inertia
  for (int j = 0; j < m->njnt; j++) {
    mjtNum block[36];
    if (m->jnt_type[j] != mjJNT_FREE || !mjd_freeMhat(m, d, j, m->opt.timestep, block, 0)) {
      continue;
    }
    for (int i = m->jnt_dofadr[j]; i < m->jnt_dofadr[j] + 6; i++) {
      mju_copy(metric.factor + m->M_rowadr[i], d->M + m->M_rowadr[i], m->M_rownnz[i]);
    }
  }
  factor_cholesky(m, d, &metric);
  return metric;
}

static Metric metric_of_implicit(const mjModel* m, mjData* d) {
  Metric metric = {METRIC_LU, mj_stackAllocNum(d, m->nD), NULL};
  mjd_smooth_vel(m, d, 1);
  for (int k = 0; k < m->nD; k++) {
    mjtNum inertia = m->mapM2D[k] >= 0 ? d->M[m->mapM2D[k]] : 0;
    metric.factor[k] = inertia - m->opt.timestep * d->qDeriv[k];
  }
  factor_lu(m, d, metric.factor);
  return metric;
}

Metric metric_of_step(const mjModel* m, mjData* d) {
  switch (m->opt.integrator) {
    case mjINT_EULER:
      return metric_of_euler(m, d);
    case mjINT_IMPLICIT:
      return metric_of_implicit(m, d);
    case mjINT_IMPLICITFAST:
      return metric_of_implicitfast(m, d);
    default:
      return (Metric){d->efm_active ? METRIC_DISCRETE : METRIC_INERTIA, NULL, NULL};
  }
}

int metric_moves_qacc(const Metric* metric) {
  return metric->kind == METRIC_CHOLESKY || metric->kind == METRIC_LU;
}

void metric_solve(const mjModel* m, mjData* d, const Metric* metric, mjtNum* x, const mjtNum* y,
                  int n) {
  int nv = m->nv;
  switch (metric->kind) {
    case METRIC_INERTIA:
      mj_solveM(m, d, x, y, n);
      return;

    case METRIC_DISCRETE:
      for (int i = 0; i < n; i++) {
        mj_effSolve(m, d, x + i * nv, y + i * nv);
      }
      return;

    case METRIC_LU:
      mju_copy(x, y, n * nv);
      for (int i = 0; i < n; i++) {
        solve_lu(m, metric->factor, x + i * nv);
      }
      return;

    case METRIC_CHOLESKY:
      mju_copy(x, y, n * nv);
      mj_solveLD(x, metric->factor, metric->inverse, nv, n, m->M_rownnz, m->M_rowadr, m->M_colind,
                 NULL);
      break;
  }

  // implicitfast: free bodies with their gyroscopic terms
  if (m->opt.integrator != mjINT_IMPLICITFAST) {
    return;
  }
  for (int j = 0; j < m->njnt; j++) {
    mjtNum block[36];
    int pivot[6], address = m->jnt_dofadr[j];
    if (m->jnt_type[j] != mjJNT_FREE || !mjd_freeMhat(m, d, j, m->opt.timestep, block, 0) ||
        !mju_factorLU6(block, pivot)) {
      continue;
    }
    for (int i = 0; i < n; i++) {
      mju_solveLU6(x + i * nv + address, block, y + i * nv + address, pivot);
    }
  }
}
