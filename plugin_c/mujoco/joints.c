// Forces of devices that are each on one joint: see joints.h.
//
// The solution is where the convex function
//   phi(x) = x'H x / 2 - f'x + sum_i (integral of F_i)(g_i x_i + bias_i)
// is least; where H is not symmetric there is no phi, and its slope along a step is taken all the
// same. Beside x the forces y are kept that balance it exactly, H x = f - sum_i g_i y_i e_i, so
// that the gradient of phi is F - y on each joint and H is never multiplied. Newton's step is
//   (H + sum_i g_i^2 s_i e_i e_i') dx = sum_i g_i (y_i - F_i) e_i,   y -> F + s g dx,
// s the rises of F. Where it goes too far the line is searched. While the rises hardly change the
// factor stays.

#include "mujoco/joints.h"

#include <float.h>
#include <math.h>

#include "mujoco/downhill.h"
#include "mujoco/engine.h"

enum { ROUNDS = 100 };

// step that is left, over the accelerations that it is a difference of: of a solution, and one from
// which on steps that shrink no more are rounding
static const double kSolved = 64 * DBL_EPSILON, kEnough = 1e-9;

// change of the rises, over the diagonal, with which a factor still serves
static const double kSame = 1e-2;

typedef struct Solve_ {
  const mjModel* m;
  mjData* d;
  const Group* group;
  const Joints* problem;
  const mjtNum* H;
  int lu;                    // 1: in the sparsity of D, and not symmetric
  int* dof;                  // of each device
  mjtNum* gear;              // n, as everything that follows of a device
  mjtNum *a, *force, *law;   // where x is; y there; F there
  mjtNum* rise;              // of F there
  mjtNum *next, *next_rise;  // the same where the line was asked last
  mjtNum* used;              // rises in the factor
  mjtNum *turn, *size;       // g dx; what a is a difference of
  mjtNum *factor, *inverse;  // of the matrix of a round
  mjtNum* x;                 // nv: a right hand side, then the step
} Solve;

int joints_fit(const mjModel* m, const mjData* d, const Metric* metric, const Group* group,
               const int* moment) {
  if (group->nrow || metric->kind == METRIC_DISCRETE) {
    return 0;
  }
  for (int i = 0; i < group->n; i++) {
    if (d->moment_rownnz[moment[group->device[i]]] != 1) {
      return 0;
    }
  }
  // free bodies are solved apart there, in full
  int apart = m->opt.integrator == mjINT_IMPLICITFAST;
  for (int i = 0; apart && i < group->ndof; i++) {
    if (m->jnt_type[m->dof_jntid[group->dof[i]]] == mjJNT_FREE) {
      return 0;
    }
  }
  return 1;
}

//------------------------------ linear algebra ----------------------------------------------------

static int start_of(const Solve* s, int dof) {
  return s->lu ? s->m->D_rowadr[dof] : s->m->M_rowadr[dof];
}

static int count_of(const Solve* s, int dof) {
  return s->lu ? s->m->D_rownnz[dof] : s->m->M_rownnz[dof];
}

static int diagonal(const Solve* s, int dof) {
  return start_of(s, dof) + (s->lu ? s->m->D_diag[dof] : s->m->M_rownnz[dof] - 1);
}

// factor of H and the rises
static void factor(Solve* s) {
  const mjModel* m = s->m;
  const Group* group = s->group;
  for (int i = 0; i < group->ndof; i++) {
    int start = start_of(s, group->dof[i]);
    mju_copy(s->factor + start, s->H + start, count_of(s, group->dof[i]));
  }
  for (int i = 0; i < s->problem->n; i++) {
    s->factor[diagonal(s, s->dof[i])] += s->gear[i] * s->gear[i] * s->rise[i];
    s->used[i] = s->rise[i];
  }
  if (s->lu) {
    metric_factor_lu(m, s->d, group->ndof, group->dof, s->factor);
    return;
  }
  const int* list = group->ndof == m->nv ? NULL : group->dof;
  mj_factorI(s->factor, s->inverse, group->ndof, m->M_rownnz, m->M_rowadr, m->M_colind, list);
}

// x in place
static void solve(Solve* s) {
  const mjModel* m = s->m;
  if (s->lu) {
    metric_solve_lu(m, s->factor, s->group->ndof, s->group->dof, s->x);
    return;
  }
  const int* list = s->group->ndof == m->nv ? NULL : s->group->dof;
  mj_solveLD(s->x, s->factor, s->inverse, s->group->ndof, 1, m->M_rownnz, m->M_rowadr, m->M_colind,
             list);
}

// whether the factor was made with about these rises
static int factor_serves(const Solve* s) {
  for (int i = 0; i < s->problem->n; i++) {
    mjtNum square = s->gear[i] * s->gear[i];
    mjtNum size = s->H[diagonal(s, s->dof[i])] + square * s->used[i];
    if (square * fabs(s->rise[i] - s->used[i]) > kSame * size) {
      return 0;
    }
  }
  return 1;
}

//------------------------------ rounds ------------------------------------------------------------

static void evaluate(Solve* s) {
  for (int i = 0; i < s->problem->n; i++) {
    s->law[i] = s->problem->law(s->problem->devices, i, s->a[i], s->rise + i);
  }
}

// the laws as lines through the guess
static void start(Solve* s, const mjtNum* smooth) {
  const Group* group = s->group;
  const mjtNum* bias = s->problem->bias;
  evaluate(s);
  factor(s);
  for (int i = 0; i < group->ndof; i++) {
    s->x[group->dof[i]] = smooth[group->dof[i]];
  }
  for (int i = 0; i < s->problem->n; i++) {
    s->x[s->dof[i]] -= s->gear[i] * (s->law[i] + s->rise[i] * (bias[i] - s->a[i]));
  }
  solve(s);
  for (int i = 0; i < s->problem->n; i++) {
    mjtNum a = s->gear[i] * s->x[s->dof[i]] + bias[i], before = s->a[i];
    s->force[i] = s->law[i] + s->rise[i] * (a - before);
    s->a[i] = a;
    s->size[i] = fabs(bias[i]) +
                 fabs(s->gear[i] * smooth[s->dof[i]]) / s->H[diagonal(s, s->dof[i])] + DBL_MIN;
  }
}

// g dx that the difference of F and y asks for, with the factor that there is
static void find_step(Solve* s) {
  const Group* group = s->group;
  for (int i = 0; i < group->ndof; i++) {
    s->x[group->dof[i]] = 0;
  }
  for (int i = 0; i < s->problem->n; i++) {
    s->x[s->dof[i]] += s->gear[i] * (s->force[i] - s->law[i]);
  }
  solve(s);
  for (int i = 0; i < s->problem->n; i++) {
    s->turn[i] = s->gear[i] * s->x[s->dof[i]];
  }
}

// largest of the steps over what its acceleration is a difference of
static double largest(const Solve* s) {
  double worst = 0;
  for (int i = 0; i < s->problem->n; i++) {
    worst = fmax(worst, fabs(s->turn[i]) / (s->size[i] + fabs(s->a[i])));
  }
  return worst;
}

static int same_everywhere(const Solve* s) {
  for (int i = 0; i < s->problem->n; i++) {
    if (s->law[i] != s->force[i]) {
      return 0;
    }
  }
  return 1;
}

// slope of phi at the part t of the step
static double slope_at(void* context, double t) {
  Solve* s = context;
  double slope = 0;
  for (int i = 0; i < s->problem->n; i++) {
    mjtNum a = s->a[i] + t * s->turn[i], whole = s->law[i] + s->used[i] * s->turn[i];
    s->next[i] = s->problem->law(s->problem->devices, i, a, s->next_rise + i);
    slope += s->turn[i] * (s->next[i] - s->force[i] - t * (whole - s->force[i]));
  }
  return slope;
}

// go the part t of the step
static void go(Solve* s, double t) {
  for (int i = 0; i < s->problem->n; i++) {
    s->force[i] += t * (s->law[i] + s->used[i] * s->turn[i] - s->force[i]);
    s->a[i] += t * s->turn[i];
  }
}

// the step as far as it leads downhill
static void search(Solve* s) {
  double slope = 0;
  for (int i = 0; i < s->problem->n; i++) {
    slope += s->turn[i] * (s->law[i] - s->force[i]);
  }
  go(s, downhill_search(slope_at, s, slope));
  mju_copy(s->law, s->next, s->problem->n);
  mju_copy(s->rise, s->next_rise, s->problem->n);
}

static int descend(Solve* s) {
  double before = 0;
  evaluate(s);
  for (int round = 1; round <= ROUNDS; round++) {
    if (same_everywhere(s)) {
      return round;
    }
    if (!factor_serves(s)) {
      factor(s);
    }
    find_step(s);
    // what a step leaves shrinks at least as the steps do
    double left = largest(s), shrinks = before > 0 ? left / before : 1;
    if (left * shrinks <= kSolved || (left <= kEnough && before > 0 && shrinks >= 0.5)) {
      go(s, 1);
      return round;
    }
    before = left;
    search(s);
  }
  return -ROUNDS;
}

int joints_solve(const mjModel* m, mjData* d, const Metric* metric, const Group* group,
                 const Joints* problem, const mjtNum* smooth, mjtNum* a, mjtNum* force) {
  mj_markStack(d);
  int n = problem->n;
  int lu = metric->kind == METRIC_LU, entries = (int)(lu ? m->nD : m->nC);
  mjtNum* numbers = mj_stackAllocNum(d, 8 * n + entries + 2 * m->nv);
  Solve s = {.m = m, .d = d, .group = group, .problem = problem, .lu = lu};
  s.H = metric->matrix ? metric->matrix : d->M;
  s.dof = mj_stackAllocInt(d, n);
  s.a = a;
  s.force = force;
  s.gear = numbers;
  s.law = s.gear + n;
  s.rise = s.law + n;
  s.next = s.rise + n;
  s.next_rise = s.next + n;
  s.used = s.next_rise + n;
  s.turn = s.used + n;
  s.size = s.turn + n;
  s.factor = s.size + n;
  s.inverse = s.factor + entries;
  s.x = s.inverse + m->nv;
  for (int i = 0; i < n; i++) {
    int entry = d->moment_rowadr[problem->moment[i]];
    s.dof[i] = d->moment_colind[entry];
    s.gear[i] = d->actuator_moment[entry];
  }
  start(&s, smooth);
  int rounds = problem->lines ? 0 : descend(&s);
  mj_freeStack(d);
  return rounds;
}
