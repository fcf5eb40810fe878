// Constraint rows as functions of the acceleration: see rows.h.

#include "mujoco/rows.h"

#include <math.h>
#include <string.h>

//------------------------------ rows --------------------------------------------------------------

static RowKind kind_of(const mjData* d, int row) {
  if (row < d->ne) {
    return ROW_EQUALITY;
  }
  if (row < d->ne + d->nf) {
    return ROW_FRICTION;
  }
  if (d->efc_type[row] != mjCNSTR_CONTACT_ELLIPTIC) {
    return ROW_ONESIDED;
  }
  return row == d->contact[d->efc_id[row]].efc_address ? ROW_CONE : ROW_OF_CONE;
}

static int dim_of(const mjData* d, const Rows* rows, int i) {
  return rows->kind[i] == ROW_CONE ? d->contact[d->efc_id[rows->row[i]]].dim : 1;
}

// entries of one row, or of the rows of one contact, from the engine's sparse rows; returns their
// number
static int gather_sparse(const mjData* d, Rows* rows, int i, int dim, const int* place, int at) {
  int nnz = d->efc_J_rownnz[rows->row[i]];
  for (int k = 0; k < dim; k++) {
    int address = d->efc_J_rowadr[rows->row[i + k]];
    rows->start[i + k] = at + k * nnz;
    for (int e = 0; e < nnz; e++) {
      rows->column[at + k * nnz + e] = place[d->efc_J_colind[address + e]];
      rows->value[at + k * nnz + e] = d->efc_J[address + e];
    }
  }
  return dim * nnz;
}

// columns in which one row, or any of the rows of one contact, has an entry; returns their number
static int columns_of(int nv, const mjtNum* J, int dim, int* column) {
  int nnz = 0;
  if (dim == 1) {
    for (int c = 0; c < nv; c++) {
      column[nnz] = c;
      nnz += J[c] != 0;
    }
    return nnz;
  }
  for (int c = 0; c < nv; c++) {
    int there = 0;
    for (int k = 0; k < dim; k++) {
      there |= J[k * nv + c] != 0;
    }
    column[nnz] = c;
    nnz += there;
  }
  return nnz;
}

// the same from its dense ones; there has to be room for one entry more
static int gather_dense(const mjModel* m, const mjData* d, Rows* rows, int i, int dim,
                        const int* place, int at) {
  int nv = m->nv, *column = rows->column + at;
  const mjtNum* J = d->efc_J + rows->row[i] * nv;
  int nnz = columns_of(nv, J, dim, column);
  for (int k = 0; k < dim; k++) {
    rows->start[i + k] = at + k * nnz;
    for (int e = 0; e < nnz; e++) {
      rows->value[at + k * nnz + e] = J[k * nv + column[e]];
    }
  }
  for (int e = 0; e < nnz; e++) {
    column[e] = place[column[e]];
  }
  for (int k = 1; k < dim; k++) {
    memcpy(column + k * nnz, column, (size_t)nnz * sizeof(int));
  }
  return dim * nnz;
}

Rows rows_gather(const mjModel* m, mjData* d, int n, const int* row, const int* place) {
  Rows rows = {.n = n, .row = row};
  int sparse = mj_isSparse(m), entries = sparse ? 0 : n * m->nv + 1, cones = 0;
  rows.kind = mj_stackAllocByte(d, (size_t)n * sizeof(RowKind), _Alignof(RowKind));
  rows.start = mj_stackAllocInt(d, n + 1);
  rows.stiffness = mj_stackAllocNum(d, n);
  for (int i = 0; i < n; i++) {
    rows.kind[i] = kind_of(d, row[i]);
    entries += sparse ? d->efc_J_rownnz[row[i]] : 0;
    cones |= rows.kind[i] == ROW_CONE;
  }
  rows.column = mj_stackAllocInt(d, entries);
  rows.value = mj_stackAllocNum(d, entries);
  rows.cones = cones ? mj_stackAllocNum(d, 36 * n) : NULL;
  int at = 0;
  for (int i = 0; i < n;) {
    int dim = dim_of(d, &rows, i);
    at += sparse ? gather_sparse(d, &rows, i, dim, place, at)
                 : gather_dense(m, d, &rows, i, dim, place, at);
    i += dim;
  }
  rows.start[n] = at;
  return rows;
}

//------------------------------ products ----------------------------------------------------------

void rows_multiply(const Rows* rows, const mjtNum* a, mjtNum* j) {
  for (int i = 0; i < rows->n; i++) {
    mjtNum sum = 0;
    for (int e = rows->start[i]; e < rows->start[i + 1]; e++) {
      sum += rows->value[e] * a[rows->column[e]];
    }
    j[i] = sum;
  }
}

void rows_add_force(const Rows* rows, const mjtNum* force, mjtNum* vector) {
  for (int i = 0; i < rows->n; i++) {
    for (int e = rows->start[i]; force[i] != 0 && e < rows->start[i + 1]; e++) {
      vector[rows->column[e]] += rows->value[e] * force[i];
    }
  }
}

// Add scale left' right to the lower half, two rows of entries in the same columns, which fall.
static void add_product(const int* column, int nnz, mjtNum scale, const mjtNum* left,
                        const mjtNum* right, int n, mjtNum* matrix) {
  for (int r = 0; scale != 0 && r < nnz; r++) {
    mjtNum scaled = scale * left[r];
    mjtNum* to = matrix + column[r] * n;
    for (int c = r; c < nnz; c++) {
      to[column[c]] += scaled * right[c];
    }
  }
}

void rows_add_stiffness(const Rows* rows, int n, mjtNum* matrix) {
  for (int i = 0; i < rows->n; i++) {
    const int* column = rows->column + rows->start[i];
    const mjtNum* value = rows->value + rows->start[i];
    int nnz = rows->start[i + 1] - rows->start[i], dim = -(int)rows->stiffness[i];
    if (rows->stiffness[i] >= 0) {
      add_product(column, nnz, rows->stiffness[i], value, value, n, matrix);
      continue;
    }
    const mjtNum* H = rows->cones + 36 * i;
    for (int a = 0; a < dim; a++) {
      for (int b = 0; b < dim; b++) {
        add_product(column, nnz, H[a * dim + b], value + a * nnz, value + b * nnz, n, matrix);
      }
    }
  }
}

void rows_stiffen(const Rows* rows, const mjtNum* u, mjtNum* force) {
  for (int i = 0; i < rows->n; i++) {
    if (rows->stiffness[i] >= 0) {
      force[i] = rows->stiffness[i] * u[i];
      continue;
    }
    int dim = -(int)rows->stiffness[i];
    for (int a = 0; a < dim; a++) {
      force[i + a] = mju_dot(rows->cones + 36 * i + a * dim, u + i, dim);
    }
    i += dim - 1;
  }
}

//------------------------------ answers -----------------------------------------------------------

// Hessian of the middle zone of a cone, N normal and T tangential size of U
static void cone_hessian(mjtNum scale, mjtNum mu, const mjtNum* friction, int dim, const mjtNum* U,
                         mjtNum N, mjtNum T, mjtNum* H) {
  for (int a = 0; a < dim; a++) {
    for (int b = 0; b < dim; b++) {
      mjtNum inner;
      if (a == 0 || b == 0) {
        inner = a == b ? 1 : -mu / T * (a == 0 ? U[b] : U[a]);
      } else {
        inner = mu * N / (T * T * T) * U[a] * U[b] + (a == b ? mu * mu - mu * N / T : 0);
      }
      mjtNum left = a == 0 ? mu : friction[a - 1], right = b == 0 ? mu : friction[b - 1];
      H[a * dim + b] = scale * left * right * inner;
    }
  }
}

// the rows of an elliptic contact
static void answer_cone(const mjData* d, Rows* rows, int i, const mjtNum* j, mjtNum* force) {
  const mjContact* contact = d->contact + d->efc_id[rows->row[i]];
  int dim = contact->dim;
  mjtNum mu = contact->mu, U[ROWS_OF_CONTACT], square = 0;
  U[0] = j[i] * mu;
  for (int k = 1; k < dim; k++) {
    U[k] = j[i + k] * contact->friction[k - 1];
    square += U[k] * U[k];
  }
  mjtNum N = U[0], T = sqrt(square);
  int inside = N >= mu * T || (T <= 0 && N >= 0), below = mu * N + T <= 0 || (T <= 0 && N < 0);
  if (inside || below) {
    for (int k = 0; k < dim; k++) {
      rows->stiffness[i + k] = inside ? 0 : d->efc_D[rows->row[i + k]];
      force[i + k] = -rows->stiffness[i + k] * j[i + k];
    }
    return;
  }
  mjtNum scale = d->efc_D[rows->row[i]] / (mu * mu * (1 + mu * mu));
  force[i] = -scale * (N - mu * T) * mu;
  rows->stiffness[i] = -dim;
  for (int k = 1; k < dim; k++) {
    force[i + k] = -force[i] / T * U[k] * contact->friction[k - 1];
    rows->stiffness[i + k] = 0;
  }
  cone_hessian(scale, mu, contact->friction, dim, U, N, T, rows->cones + 36 * i);
}

void rows_answer(const mjData* d, Rows* rows, const mjtNum* j, mjtNum* force) {
  for (int i = 0; i < rows->n; i++) {
    int row = rows->row[i], acts = 1;
    mjtNum D = d->efc_D[row], most = d->efc_frictionloss[row];
    switch (rows->kind[i]) {
      case ROW_OF_CONE:
        continue;

      case ROW_CONE:
        answer_cone(d, rows, i, j, force);
        continue;

      case ROW_FRICTION:
        acts = fabs(j[i]) < d->efc_R[row] * most;
        force[i] = acts ? -D * j[i] : j[i] < 0 ? most : -most;
        break;

      case ROW_ONESIDED:
        acts = j[i] < 0;
        force[i] = acts ? -D * j[i] : 0;
        break;

      case ROW_EQUALITY:
        force[i] = -D * j[i];
        break;
    }
    rows->stiffness[i] = acts ? D : 0;
  }
}
