// Forces of devices found together with those of constraints: see constrained.h.
//
// Each round takes the constraints as the springs that they are at q,
//   K = A + J_c' S J_c,  K x = f + J_c' (f_c + S J_c q) - P' F(P x + bias),
// and solves that for x with the devices' laws as they are (monotone.h). Where the springs are the
// same at x the round was the last. Else q goes towards x as far as it leads downhill.

#include "mujoco/constrained.h"

#include <math.h>

#include "mujoco/downhill.h"
#include "mujoco/profile.h"
#include "mujoco/rows.h"

enum { ROUNDS = 40 };

// gradient that is left, over its terms: of a solution, and of one that is as good as any
static const double kSolved = 1e-12, kEnough = 1e-8;

// entry of the lower half of a symmetric matrix
typedef struct Entry_ {
  int row, column;
  mjtNum value;
} Entry;

// The dofs of the group stand last first, so that factors fill in only where constraints do.
typedef struct Part_ {
  int n;       // dofs
  int k;       // devices
  int nentry;  // of A
  Entry* A;
  int* first;  // first column of each row of K that can hold anything
  mjtNum* K;   // n x n, then its factor
  mjtNum* f;
  mjtNum* P;  // k x n
  mjtNum* X;  // K^-1 P' (k x n)
  Rows rows;
  // along the devices and the rows
  mjtNum *q, *x, *gradient, *step, *product;     // n
  mjtNum *j, *answer, *model, *change, *beside;  // rows
  mjtNum* reference;                             // a_ref of the rows
  mjtNum *p, *along, *turn, *other;              // k
} Part;

//------------------------------ gathering ---------------------------------------------------------

static void add_entry(Part* part, int a, int b, mjtNum value) {
  part->A[part->nentry++] = (Entry){mjMAX(a, b), mjMIN(a, b), value};
}

// the metric of the discrete integrator, column by column
static void gather_discrete(const mjModel* m, mjData* d, Part* part, const Group* group,
                            const int* place) {
  int nv = m->nv;
  mj_markStack(d);
  mjtNum* unit = mj_stackAllocNum(d, nv);
  mjtNum* column = mj_stackAllocNum(d, nv);
  mju_zero(unit, nv);
  for (int i = 0; i < group->ndof; i++) {
    int dof = group->dof[i];
    unit[dof] = 1;
    metric_multiply_discrete(m, d, unit, column);
    unit[dof] = 0;
    for (int k = i; k < group->ndof; k++) {
      if (column[group->dof[k]] != 0) {
        add_entry(part, place[group->dof[k]], place[dof], column[group->dof[k]]);
      }
    }
  }
  mj_freeStack(d);
}

static void gather_matrix(const mjModel* m, mjData* d, Part* part, const Metric* metric,
                          const Group* group, const int* place) {
  if (metric->kind == METRIC_DISCRETE) {
    gather_discrete(m, d, part, group, place);
    return;
  }
  for (int i = 0; i < group->ndof; i++) {
    int dof = group->dof[i], end = m->M_rowadr[dof] + m->M_rownnz[dof];
    for (int e = m->M_rowadr[dof]; e < end; e++) {
      add_entry(part, place[dof], place[m->M_colind[e]], d->M[e]);
    }
  }
}

// columns of K before which a row holds nothing
static void find_profile(Part* part) {
  for (int i = 0; i < part->n; i++) {
    part->first[i] = i;
  }
  for (int e = 0; e < part->nentry; e++) {
    const Entry* entry = part->A + e;
    part->first[entry->row] = mjMIN(part->first[entry->row], entry->column);
  }
  const Rows* rows = &part->rows;
  for (int i = 0; i < rows->n; i++) {
    int end = rows->start[i + 1];
    for (int e = rows->start[i]; e < end; e++) {
      int* first = part->first + rows->column[e];
      *first = mjMIN(*first, rows->column[end - 1]);
    }
  }
}

static void gather_devices(const mjData* d, Part* part, const int* moment, const int* place) {
  mju_zero(part->P, part->k * part->n);
  for (int i = 0; i < part->k; i++) {
    int start = d->moment_rowadr[moment[i]], end = start + d->moment_rownnz[moment[i]];
    for (int e = start; e < end; e++) {
      part->P[i * part->n + place[d->moment_colind[e]]] = d->actuator_moment[e];
    }
  }
}

static int* places(const mjModel* m, mjData* d, const Group* group) {
  int* place = mj_stackAllocInt(d, m->nv);
  for (int i = 0; i < group->ndof; i++) {
    place[group->dof[i]] = group->ndof - 1 - i;
  }
  return place;
}

static Part allocate(mjData* d, const Group* group, int k, int nentry) {
  int n = group->ndof, r = group->nrow;
  Part part = {.n = n, .k = k};
  part.A = mj_stackAllocByte(d, (size_t)nentry * sizeof(Entry), _Alignof(Entry));
  part.first = mj_stackAllocInt(d, n);
  part.K = mj_stackAllocNum(d, n * n);
  part.P = mj_stackAllocNum(d, 2 * k * n);
  part.X = part.P + k * n;
  part.f = mj_stackAllocNum(d, 6 * n);
  part.q = part.f + n;
  part.x = part.q + n;
  part.gradient = part.x + n;
  part.step = part.gradient + n;
  part.product = part.step + n;
  part.j = mj_stackAllocNum(d, 6 * r);
  part.answer = part.j + r;
  part.model = part.answer + r;
  part.change = part.model + r;
  part.beside = part.change + r;
  part.reference = part.beside + r;
  for (int i = 0; i < r; i++) {
    part.reference[i] = d->efc_aref[group->row[i]];
  }
  part.p = mj_stackAllocNum(d, 4 * k);
  part.along = part.p + k;
  part.turn = part.along + k;
  part.other = part.turn + k;
  return part;
}

// most entries of the matrix of a group
static int most_entries(const mjModel* m, const Metric* metric, const Group* group) {
  if (metric->kind == METRIC_DISCRETE) {
    return group->ndof * (group->ndof + 1) / 2;
  }
  int count = 0;
  for (int i = 0; i < group->ndof; i++) {
    count += m->M_rownnz[group->dof[i]];
  }
  return count;
}

int constrained_fits(const mjModel* m, const mjData* d, const Group* group, int n) {
  size_t dofs = (size_t)group->ndof, rows = (size_t)group->nrow, devices = (size_t)n, entries = 0;
  for (int i = 0; i < group->nrow; i++) {
    entries += (size_t)(mj_isSparse(m) ? d->efc_J_rownnz[group->row[i]] : m->nv);
  }
  size_t matrices = dofs * dofs * (1 + sizeof(Entry) / sizeof(mjtNum)) + 3 * devices * dofs;
  size_t lists =
      16 * dofs + 48 * rows + 2 * entries + devices * (2 * devices + 20) + 4 * (size_t)m->nv;
  size_t left = (size_t)d->narena - d->parena - d->pstack;
  return (matrices + lists) * sizeof(mjtNum) + 4096 < left;
}

//------------------------------ linear algebra ----------------------------------------------------

// A x
static void multiply(const Part* part, const mjtNum* x, mjtNum* product) {
  mju_zero(product, part->n);
  for (int e = 0; e < part->nentry; e++) {
    const Entry* entry = part->A + e;
    product[entry->row] += entry->value * x[entry->column];
    if (entry->row != entry->column) {
      product[entry->column] += entry->value * x[entry->row];
    }
  }
}

// K = A + J_c' S J_c, and its Cholesky factor within the profile; 0 if it is not positive
static int factor(Part* part) {
  int n = part->n;
  for (int i = 0; i < n; i++) {
    mju_zero(part->K + i * n + part->first[i], i + 1 - part->first[i]);
  }
  for (int e = 0; e < part->nentry; e++) {
    part->K[part->A[e].row * n + part->A[e].column] += part->A[e].value;
  }
  rows_add_stiffness(&part->rows, n, part->K);
  return profile_factor(n, part->first, part->K);
}

//------------------------------ solution ----------------------------------------------------------

// the round's x, with the constraints as springs at q; a: in a guess, out the accelerations
static int solve_springs(Part* part, const Constrained* problem, mjtNum* a, mjtNum* force,
                         mjtNum* W, mjtNum* scratch) {
  int n = part->n, k = part->k;
  if (!factor(part)) {
    return 0;
  }

  // without the devices: f + J_c' (f_c + S J_c q)
  mju_zero(part->model, part->rows.n);
  mju_add(part->change, part->j, part->reference, part->rows.n);
  rows_stiffen(&part->rows, part->change, part->model);
  mju_addTo(part->model, part->answer, part->rows.n);
  mju_copy(part->x, part->f, n);
  rows_add_force(&part->rows, part->model, part->x);
  profile_solve(n, part->first, part->K, part->x);

  // and what each takes away
  for (int i = 0; i < k; i++) {
    mju_copy(part->X + i * n, part->P + i * n, n);
    profile_solve(n, part->first, part->K, part->X + i * n);
    part->p[i] = profile_dot(part->P + i * n, part->x, n) + problem->bias[i];
  }
  for (int i = 0; i < k; i++) {
    for (int c = 0; c < k; c++) {
      W[i * k + c] = profile_dot(part->P + i * n, part->X + c * n, n);
    }
  }
  int rounds = monotone_solve(problem->law, problem->devices, k, W, part->p, problem->grain, a,
                              force, scratch);
  for (int i = 0; i < k; i++) {
    mju_addToScl(part->x, part->X + i * n, -force[i], n);
  }
  return rounds >= 0;
}

// What the springs of the round do at x less what the rows answer there: the gradient that is left,
// over the size of its terms.
static double miss(Part* part, const mjData* d) {
  int n = part->n, r = part->rows.n;
  rows_multiply(&part->rows, part->x, part->change);
  mju_sub(part->beside, part->change, part->reference, r);
  mju_zero(part->j, r);
  rows_stiffen(&part->rows, part->change, part->j);
  rows_answer(d, &part->rows, part->beside, part->answer);

  // the same springs: nothing but rounding
  double most = 0, size = 0;
  for (int i = 0; i < r; i++) {
    mjtNum apart = part->model[i] - part->j[i] - part->answer[i];
    size = fmax(size, fabs(part->j[i]) + fabs(part->answer[i]));
    most = fmax(most, fabs(apart));
    part->model[i] = apart;
  }
  if (most <= kSolved * size) {
    return 0;
  }
  mju_zero(part->gradient, n);
  mju_zero(part->product, n);
  rows_add_force(&part->rows, part->answer, part->product);
  rows_add_force(&part->rows, part->model, part->gradient);
  multiply(part, part->x, part->step);
  double square = profile_dot(part->f, part->f, n) + profile_dot(part->product, part->product, n) +
                  profile_dot(part->step, part->step, n);
  return square > 0 ? sqrt(profile_dot(part->gradient, part->gradient, n) / square) : 0;
}

// the line from q to x
typedef struct Line_ {
  Part* part;
  const mjData* d;
  const Constrained* problem;
  double constant, rise;   // slope of the quadratic part
  mjtNum *start, *change;  // j at q and over the line
  mjtNum *along, *turn;    // acceleration of the devices, the same
  mjtNum* pull;            // work of the devices' forces on the line, per force
} Line;

// slope of the convex function at the part t of it
static double slope_at(void* context, double t) {
  Line* line = context;
  Part* part = line->part;
  Rows* rows = &part->rows;
  for (int i = 0; i < rows->n; i++) {
    part->beside[i] = line->start[i] + t * line->change[i];
  }
  rows_answer(line->d, rows, part->beside, part->answer);
  double slope = line->constant + t * line->rise - profile_dot(part->answer, line->change, rows->n);
  for (int i = 0; i < part->k; i++) {
    mjtNum rise, a = line->along[i] + t * line->turn[i];
    slope += line->pull[i] * line->problem->law(line->problem->devices, i, a, &rise);
  }
  return slope;
}

// how far to go from q towards x
static double search(Part* part, const mjData* d, const Constrained* problem) {
  int n = part->n;
  mju_sub(part->step, part->x, part->q, n);
  Line line = {part, d, problem, 0, 0, part->j, part->change, part->along, part->turn, part->other};
  multiply(part, part->step, part->product);
  line.rise = profile_dot(part->step, part->product, n);
  line.constant = profile_dot(part->q, part->product, n) - profile_dot(part->f, part->step, n);
  rows_multiply(&part->rows, part->q, line.start);
  mju_subFrom(line.start, part->reference, part->rows.n);
  rows_multiply(&part->rows, part->step, line.change);
  for (int i = 0; i < part->k; i++) {
    line.along[i] = profile_dot(part->P + i * n, part->q, n) + problem->bias[i];
    line.turn[i] = profile_dot(part->P + i * n, part->step, n);
    line.pull[i] = profile_dot(part->P + i * n, part->step, n);
  }
  return downhill_search(slope_at, &line, slope_at(&line, 0));
}

// Rounds until it fits. Returns their number, negative if it stopped at its bound.
static int descend(const mjData* d, Part* part, const Constrained* problem, const mjtNum* start,
                   mjtNum* a, mjtNum* force, mjtNum* W, mjtNum* scratch) {
  int n = part->n;
  mju_copy(part->q, start, n);
  for (int i = 0; i < part->k; i++) {
    mjtNum rise;
    a[i] = profile_dot(part->P + i * n, start, n) + problem->bias[i];
    force[i] = problem->law(problem->devices, i, a[i], &rise);
  }
  double before = INFINITY;
  for (int round = 1; round <= ROUNDS; round++) {
    rows_multiply(&part->rows, part->q, part->j);
    mju_subFrom(part->j, part->reference, part->rows.n);
    rows_answer(d, &part->rows, part->j, part->answer);
    if (!solve_springs(part, problem, a, force, W, scratch)) {
      return -round;
    }
    double left = miss(part, d);
    if (left <= kSolved || (left <= kEnough && left >= 0.5 * before)) {
      return round;
    }
    before = left;
    double t = search(part, d, problem);
    for (int i = 0; i < n; i++) {
      part->q[i] += t * (part->x[i] - part->q[i]);
    }
  }
  return -ROUNDS;
}

int constrained_solve(const mjModel* m, mjData* d, const Metric* metric, const Group* group,
                      const Constrained* problem, const mjtNum* smooth, mjtNum* a, mjtNum* force,
                      mjtNum* W) {
  mj_markStack(d);
  int k = problem->n, n = group->ndof;
  const int* place = places(m, d, group);
  Part part = allocate(d, group, k, most_entries(m, metric, group));
  part.rows = rows_gather(m, d, group->nrow, group->row, place);
  mjtNum* start = mj_stackAllocNum(d, n);
  mjtNum* scratch = mj_stackAllocNum(d, k * (k + 9));
  for (int i = 0; i < n; i++) {
    start[place[group->dof[i]]] = d->qacc_warmstart[group->dof[i]];
    part.f[place[group->dof[i]]] = smooth[group->dof[i]];
  }
  gather_matrix(m, d, &part, metric, group, place);
  find_profile(&part);
  gather_devices(d, &part, problem->moment, place);
  mju_copy(part.x, start, n);
  int rounds = descend(d, &part, problem, start, a, force, W, scratch);

  // the engine's solver starts from the solution, and so ends there however soon it stops; a step
  // with damping of its own (damped.h) goes on from the last round
  int goes_on = rounds >= 0 || metric_moves_qacc(metric);
  for (int i = 0; goes_on && i < n; i++) {
    d->qacc_warmstart[group->dof[i]] = part.x[place[group->dof[i]]];
  }
  mj_freeStack(d);
  return rounds;
}
