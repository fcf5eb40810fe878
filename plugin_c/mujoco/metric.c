// The effective mass of a step: see metric.h.

#include "mujoco/metric.h"

#include "mujoco/engine.h"

//------------------------------ factors -----------------------------------------------------------

// places for the factor of H, whose lower half stands in metric->matrix in the sparsity of M
static void hold_cholesky(const mjModel* m, mjData* d, Metric* metric) {
  metric->kind = METRIC_CHOLESKY;
  metric->factor = mj_stackAllocNum(d, m->nC);
  metric->inverse = mj_stackAllocNum(d, m->nv);
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
void metric_factor_lu(const mjModel* m, mjData* d, int ndof, const int* dof, mjtNum* A) {
  mj_markStack(d);
  int* place = mj_stackAllocInt(d, m->nv);
  for (int i = 0; i < m->nv; i++) {
    place[i] = -1;
  }
  for (int n = ndof - 1; n >= 0; n--) {
    int k = dof ? dof[n] : n, start = m->D_rowadr[k], diagonal = start + m->D_diag[k];
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

void metric_solve_lu(const mjModel* m, const mjtNum* A, int ndof, const int* dof, mjtNum* x) {
  // upper part, leaves first
  for (int k = ndof - 1; k >= 0; k--) {
    int i = dof[k], start = m->D_rowadr[i], end = start + m->D_rownnz[i];
    for (int q = start + m->D_diag[i] + 1; q < end; q++) {
      x[i] -= A[q] * x[m->D_colind[q]];
    }
  }

  // lower part with the pivots
  for (int k = 0; k < ndof; k++) {
    int i = dof[k], start = m->D_rowadr[i], diagonal = start + m->D_diag[i];
    for (int q = start; q < diagonal; q++) {
      x[i] -= A[q] * x[m->D_colind[q]];
    }
    x[i] /= A[diagonal];
  }
}

static void solve_lu_transposed(const mjModel* m, const mjtNum* A, int ndof, const int* dof,
                                mjtNum* x) {
  // lower part with the pivots, leaves first
  for (int k = ndof - 1; k >= 0; k--) {
    int i = dof[k], start = m->D_rowadr[i], diagonal = start + m->D_diag[i];
    x[i] /= A[diagonal];
    for (int q = start; q < diagonal; q++) {
      x[m->D_colind[q]] -= A[q] * x[i];
    }
  }

  // upper part
  for (int k = 0; k < ndof; k++) {
    int i = dof[k], start = m->D_rowadr[i], end = start + m->D_rownnz[i];
    for (int q = start + m->D_diag[i] + 1; q < end; q++) {
      x[m->D_colind[q]] -= A[q] * x[i];
    }
  }
}

//------------------------------ metric ------------------------------------------------------------

static Metric metric_of_euler(const mjModel* m, mjData* d) {
  Metric metric = {METRIC_INERTIA, NULL, NULL, NULL};
  if (m->opt.disableflags & (mjDSBL_EULERDAMP | mjDSBL_DAMPER)) {
    return metric;
  }
  metric.matrix = mj_stackAllocNum(d, m->nC);
  mju_copy(metric.matrix, d->M, m->nC);
  if (add_joint_damping(m, d, metric.matrix)) {
    hold_cholesky(m, d, &metric);
  }
  return metric;
}

static Metric metric_of_implicitfast(const mjModel* m, mjData* d) {
  Metric metric = {METRIC_CHOLESKY, mj_stackAllocNum(d, m->nC), NULL, NULL};
  mjd_smooth_vel(m, d, 0);
  for (int k = 0; k < m->nC; k++) {
    metric.matrix[k] = d->M[k] - m->opt.timestep * d->qDeriv[m->mapD2M[k]];
  }

  // the engine solves free bodies apart, in full: here they keep the plain inertia
  for (int j = 0; j < m->njnt; j++) {
    mjtNum block[36];
    if (m->jnt_type[j] != mjJNT_FREE || !mjd_freeMhat(m, d, j, m->opt.timestep, block, 0)) {
      continue;
    }
    for (int i = m->jnt_dofadr[j]; i < m->jnt_dofadr[j] + 6; i++) {
      mju_copy(metric.matrix + m->M_rowadr[i], d->M + m->M_rowadr[i], m->M_rownnz[i]);
    }
  }
  hold_cholesky(m, d, &metric);
  return metric;
}

static Metric metric_of_implicit(const mjModel* m, mjData* d) {
  Metric metric = {METRIC_LU, mj_stackAllocNum(d, m->nD), mj_stackAllocNum(d, m->nD), NULL};
  mjd_smooth_vel(m, d, 1);
  for (int k = 0; k < m->nD; k++) {
    mjtNum inertia = m->mapM2D[k] >= 0 ? d->M[m->mapM2D[k]] : 0;
    metric.matrix[k] = inertia - m->opt.timestep * d->qDeriv[k];
  }
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
      // with all actuation disabled the engine has not built it yet (plugin.c)
      if (m->opt.disableflags & mjDSBL_ACTUATION) {
        return (Metric){METRIC_INERTIA, NULL, NULL, NULL};
      }
      return (Metric){d->efm_active ? METRIC_DISCRETE : METRIC_INERTIA, NULL, NULL, NULL};
  }
}

void metric_factor(const mjModel* m, mjData* d, const Metric* metric) {
  if (metric->kind == METRIC_CHOLESKY) {
    mju_copy(metric->factor, metric->matrix, m->nC);
    mj_factorI(metric->factor, metric->inverse, m->nv, m->M_rownnz, m->M_rowadr, m->M_colind, NULL);
  } else if (metric->kind == METRIC_LU) {
    mju_copy(metric->factor, metric->matrix, m->nD);
    metric_factor_lu(m, d, m->nv, NULL, metric->factor);
  }
}

int metric_moves_qacc(const Metric* metric) {
  return metric->kind == METRIC_CHOLESKY || metric->kind == METRIC_LU;
}

// with the full metric, which knows no parts
static void solve_discrete(const mjModel* m, mjData* d, int ndof, const int* dof, const mjtNum* y,
                           mjtNum* x) {
  mj_markStack(d);
  mjtNum* force = mj_stackAllocNum(d, m->nv);
  mjtNum* answer = mj_stackAllocNum(d, m->nv);
  mju_zero(force, m->nv);
  for (int k = 0; k < ndof; k++) {
    force[dof[k]] = y[dof[k]];
  }
  mj_effSolve(m, d, answer, force);
  for (int k = 0; k < ndof; k++) {
    x[dof[k]] = answer[dof[k]];
  }
  mj_freeStack(d);
}

// implicitfast: free bodies with their gyroscopic terms
static void solve_free_bodies(const mjModel* m, const mjData* d, int ndof, const int* dof,
                              const mjtNum* y, mjtNum* x, int transposed) {
  for (int k = 0; k < ndof; k++) {
    mjtNum block[36];
    int pivot[6], joint = m->dof_jntid[dof[k]], address = m->jnt_dofadr[joint];
    if (m->jnt_type[joint] != mjJNT_FREE || dof[k] != address ||
        !mjd_freeMhat(m, d, joint, m->opt.timestep, block, 0)) {
      continue;
    }
    if (transposed) {
      mjtNum rows[36];
      mju_copy(rows, block, 36);
      mju_transpose(block, rows, 6, 6);
    }
    if (mju_factorLU6(block, pivot)) {
      mju_solveLU6(x + address, block, y + address, pivot);
    }
  }
}

static void solve(const mjModel* m, mjData* d, const Metric* metric, int ndof, const int* dof,
                  const mjtNum* y, mjtNum* x, int transposed) {
  if (metric->kind == METRIC_DISCRETE) {
    solve_discrete(m, d, ndof, dof, y, x);
    return;
  }
  for (int k = 0; k < ndof; k++) {
    x[dof[k]] = y[dof[k]];
  }
  const int *nnz = m->M_rownnz, *address = m->M_rowadr, *column = m->M_colind;
  if (metric->kind == METRIC_INERTIA) {
    mj_solveLD(x, d->qLD, d->qLDiagInv, ndof, 1, nnz, address, column, dof);
  } else if (metric->kind == METRIC_CHOLESKY) {
    mj_solveLD(x, metric->factor, metric->inverse, ndof, 1, nnz, address, column, dof);
    if (m->opt.integrator == mjINT_IMPLICITFAST) {
      solve_free_bodies(m, d, ndof, dof, y, x, transposed);
    }
  } else if (transposed) {
    solve_lu_transposed(m, metric->factor, ndof, dof, x);
  } else {
    metric_solve_lu(m, metric->factor, ndof, dof, x);
  }
}

void metric_solve(const mjModel* m, mjData* d, const Metric* metric, int ndof, const int* dof,
                  const mjtNum* y, mjtNum* x) {
  solve(m, d, metric, ndof, dof, y, x, 0);
}

void metric_solve_transposed(const mjModel* m, mjData* d, const Metric* metric, int ndof,
                             const int* dof, const mjtNum* y, mjtNum* x) {
  solve(m, d, metric, ndof, dof, y, x, 1);
}

void metric_multiply_discrete(const mjModel* m, mjData* d, const mjtNum* x, mjtNum* product) {
  mj_mulM(m, d, product, x);
  mj_effMulAdd(m, d, product, x);
}
