// Forces that fit the acceleration that the engine's constraint solver ends with: see engine_fit.h.

#include "mujoco/engine_fit.h"

#include <math.h>

#include "mujoco/monotone.h"

// most rounds with the engine's constraint solver, the fit that ends them, and the worst that is
// one
enum { ENGINE_ROUNDS = 12 };
static const double kFit = 1e-9, kLooseFit = 1e-6;

// share of the largest acceleration of the model that counts beside those along a device
static const double kRounding = 1e-3;

int engine_fit_is_exact(const mjModel* m, const Solution* s) {
  if (m->opt.disableflags & mjDSBL_ACTUATION) {
    return 1;  // it cannot be asked before it has added up its forces
  }
  if (s->metric.kind == METRIC_DISCRETE) {
    // free bodies: gyroscopic terms come after the constraints
    for (int j = 0; j < m->njnt; j++) {
      if (m->jnt_type[j] == mjJNT_FREE) {
        return 0;
      }
    }
  }
  return !s->constrained || !(m->opt.noslip_iterations || m->opt.disableflags & mjDSBL_WARMSTART);
}

// acceleration along the devices when they pull with these forces, in the engine's own words; size:
// of the accelerations that it is a difference of
static void respond(const mjModel* m, mjData* d, const Solution* s, const mjtNum* force, mjtNum* a,
                    mjtNum* size) {
  int nv = m->nv;
  mj_markStack(d);
  int* all = mj_stackAllocInt(d, nv);
  mjtNum* pull = mj_stackAllocNum(d, nv);
  mjtNum* qacc = mj_stackAllocNum(d, nv);
  for (int i = 0; i < nv; i++) {
    all[i] = i;
  }
  mju_zero(pull, nv);
  for (int i = 0; i < s->n; i++) {
    instance_add_moment(m, d, s->all[i].self, force[i], pull);
  }
  mju_sub(d->qfrc_smooth, s->smooth, pull, nv);
  int moves = metric_moves_qacc(&s->metric);
  if (moves) {
    mj_solveM(m, d, d->qacc_smooth, d->qfrc_smooth, 1);
  } else {
    metric_solve(m, d, &s->metric, nv, all, d->qfrc_smooth, d->qacc_smooth);
    mju_subFrom(d->qfrc_smooth, s->shift, nv);
  }
  mj_fwdConstraint(m, d);
  const mjtNum* moved = d->qacc;
  if (moves) {
    mju_add(pull, d->qfrc_smooth, d->qfrc_constraint, nv);
    metric_solve(m, d, &s->metric, nv, all, pull, qacc);
    moved = qacc;
  }
  // a body in free fall accelerates its joints by the rounding of its own acceleration alone
  mjtNum largest = 0;
  for (int i = 0; i < nv; i++) {
    largest = mju_max(largest, mju_max(fabs(moved[i]), fabs(d->qacc[i])));
  }
  mju_fill(pull, kRounding * largest, nv);
  for (int i = 0; i < s->n; i++) {
    // constraints feel the force that goes with qacc (damped.h)
    const Instance* self = s->all[i].self;
    const mjtNum* found = s->all[i].constrained ? d->qacc : moved;
    a[i] = instance_along(m, d, self, found) + self->bias;
    size[i] = instance_along_size(m, d, self, found) + fabs(self->bias) +
              instance_along_size(m, d, self, pull);
  }
  mj_freeStack(d);
}

// Broyden's update: W such that it explains the last change of a by the last change of force
static void learn(int n, mjtNum* W, const mjtNum* da, const mjtNum* dforce) {
  mjtNum square = mju_dot(dforce, dforce, n);
  for (int i = 0; square > 0 && i < n; i++) {
    mjtNum missing = -da[i] - mju_dot(W + i * n, dforce, n);
    mju_addToScl(W + i * n, dforce, missing / square, n);
  }
}

// The forces of a group that fit the engine's answer to those asked, taken as linear; returns how
// far they are off, beside the accelerations and their size. part: a, force in: asked and answered;
// out: those that fit.
static double refit(mjData* d, Solution* part, const mjtNum* W, const mjtNum* scale) {
  int n = part->n;
  mjtNum* p = mj_stackAllocNum(d, n);
  mjtNum* asked = mj_stackAllocNum(d, n);
  mjtNum* answered = mj_stackAllocNum(d, n);
  mjtNum* scratch = mj_stackAllocNum(d, n * (n + 9));
  mju_copy(asked, part->force, n);
  mju_copy(answered, part->a, n);
  for (int i = 0; i < n; i++) {
    p[i] = answered[i] + mju_dot(W + i * n, asked, n);
  }
  monotone_solve(solution_law, part->all, n, W, p, solution_grains(d, part->all, n), part->a,
                 part->force, scratch);
  double worst = 0;
  for (int i = 0; i < n; i++) {
    double size = fabs(p[i]) + fabs(answered[i]) + scale[i] + mjMINVAL, miss = 0;
    for (int j = 0; j < n; j++) {
      size += fabs(W[i * n + j] * asked[j]);
      miss += W[i * n + j] * (part->force[j] - asked[j]);
    }
    worst = fmax(worst, fabs(miss) / size);
  }
  return worst;
}

int engine_fit(const mjModel* m, mjData* d, Solution* s) {
  int n = s->n;
  mjtNum* asked = mj_stackAllocNum(d, n);
  mjtNum* answered = mj_stackAllocNum(d, n);
  mjtNum* before = mj_stackAllocNum(d, 2 * n);
  mjtNum* best = mj_stackAllocNum(d, 2 * n);
  mjtNum* size = mj_stackAllocNum(d, n);
  double least = INFINITY;
  mju_copy(asked, s->force, n);
  for (int round = 0; round < ENGINE_ROUNDS; round++) {
    respond(m, d, s, asked, answered, size);
    double worst = 0;
    for (int g = 0; g < s->ngroup; g++) {
      const Group* group = s->groups + g;
      mj_markStack(d);
      Solution part = solution_part(d, s, group);
      mjtNum* da = mj_stackAllocNum(d, part.n);
      mjtNum* dforce = mj_stackAllocNum(d, part.n);
      mjtNum* scale = mj_stackAllocNum(d, part.n);
      for (int i = 0; i < part.n; i++) {
        int k = group->device[i];
        part.a[i] = answered[k];
        part.force[i] = asked[k];
        da[i] = answered[k] - before[k];
        dforce[i] = asked[k] - before[n + k];
        scale[i] = size[k];
      }
      if (round) {
        learn(part.n, s->W[g], da, dforce);
      }
      worst = fmax(worst, refit(d, &part, s->W[g], scale));
      solution_take(&part, group, s);
      mj_freeStack(d);
    }
    if (worst < least) {
      least = worst;
      mju_copy(best, answered, n);
      mju_copy(best + n, asked, n);
    }
    if (least <= kFit) {
      break;
    }
    mju_copy(before, answered, n);
    mju_copy(before + n, asked, n);
    mju_copy(asked, s->force, n);
  }
  mju_copy(s->a, best, n);
  mju_copy(s->force, best + n, n);
  if (metric_moves_qacc(&s->metric)) {
    respond(m, d, s, s->force, answered, size);
    mju_copy(d->qacc_warmstart, d->qacc, m->nv);
  }
  return least <= kLooseFit;
}
