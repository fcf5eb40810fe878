// Forces of a step whose damping the constraints do not feel: see damped.h.

#include "mujoco/damped.h"

#include "mujoco/metric.h"
#include "mujoco/monotone.h"

// J' force of the devices of a group, into a vector that is 0
static void pull(const mjModel* m, const mjData* d, const Solution* part, const mjtNum* force,
                 mjtNum* vector) {
  for (int i = 0; i < part->n; i++) {
    instance_add_moment(m, d, part->all[i].self, force[i], vector);
  }
}

// Let constraints rest elsewhere by J_c e, and the engine's solver start from there.
static void shift_rest(const mjModel* m, mjData* d, const Group* group, const mjtNum* e) {
  mjtNum* rest = mj_stackAllocNum(d, d->nefc);
  mj_mulJacVec(m, d, rest, e);
  for (int i = 0; i < group->nrow; i++) {
    d->efc_aref[group->row[i]] += rest[group->row[i]];
  }
  mju_addTo(d->qacc_warmstart, e, m->nv);
}

int damped_step(const mjModel* m, mjData* d, Solution* part, const Group* group, mjtNum* W) {
  int n = part->n, nv = m->nv;
  mj_markStack(d);
  mjtNum* q = mj_stackAllocNum(d, nv);
  mjtNum* push = mj_stackAllocNum(d, nv);
  mjtNum* x = mj_stackAllocNum(d, nv);
  mjtNum* felt = mj_stackAllocNum(d, n);
  mjtNum* p = mj_stackAllocNum(d, n);
  mjtNum* scratch = mj_stackAllocNum(d, n * (n + 9));

  // f + J_c' f_c, from A q; other dofs are none of it
  mju_zero(q, nv);
  for (int c = 0; c < group->ndof; c++) {
    q[group->dof[c]] = d->qacc_warmstart[group->dof[c]];
  }
  mj_mulM(m, d, push, q);
  pull(m, d, part, part->force, push);
  metric_solve(m, d, &part->metric, group->ndof, group->dof, push, x);
  for (int i = 0; i < n; i++) {
    p[i] = instance_along(m, d, part->all[i].self, x) + part->bias[i];
  }
  mju_copy(felt, part->force, n);
  solution_mobilities(m, d, part, group, W);
  int rounds = monotone_solve(solution_law, part->all, n, W, p, solution_grains(d, part->all, n),
                              part->a, part->force, scratch);

  // with all actuation disabled the engine makes its reference acceleration only after this
  if (m->opt.disableflags & mjDSBL_ACTUATION) {
    mj_freeStack(d);
    return rounds;
  }
  const Metric inertia = {METRIC_INERTIA, NULL, NULL, NULL};
  mju_subFrom(felt, part->force, n);
  mju_zero(push, nv);
  pull(m, d, part, felt, push);
  mju_zero(x, nv);
  metric_solve(m, d, &inertia, group->ndof, group->dof, push, x);
  shift_rest(m, d, group, x);
  mj_freeStack(d);
  return rounds;
}
