// What the devices of a model are solved for with: see solution.h.

#include "mujoco/solution.h"

double solution_law(const void* devices, int i, double a, double* rise) {
  const Coupled* c = (const Coupled*)devices + i;
  double force = inerter_step_force(&c->step, a, rise) - c->constant * a;
  *rise -= c->constant;
  return force;
}

mjtNum* solution_grains(mjData* d, const Coupled* all, int n) {
  mjtNum* grain = mj_stackAllocNum(d, n);
  for (int i = 0; i < n; i++) {
    grain[i] = inerter_step_grain(&all[i].step);
  }
  return grain;
}

void solution_mobilities(const mjModel* m, mjData* d, const Solution* part, const Group* group,
                         mjtNum* W) {
  int n = part->n;
  mj_markStack(d);
  mjtNum* J = mj_stackAllocNum(d, m->nv);
  mjtNum* x = mj_stackAllocNum(d, m->nv);
  for (int j = 0; j < n; j++) {
    for (int c = 0; c < group->ndof; c++) {
      J[group->dof[c]] = 0;
    }
    instance_add_moment(m, d, part->all[j].self, 1, J);
    metric_solve(m, d, &part->metric, group->ndof, group->dof, J, x);
    for (int i = 0; i < n; i++) {
      W[i * n + j] = instance_along(m, d, part->all[i].self, x);
    }
  }
  mj_freeStack(d);
}

// all devices in one group: nothing to sort
static int is_whole(const Solution* s, const Group* group) {
  return group->n == s->n;
}

Solution solution_part(mjData* d, const Solution* s, const Group* group) {
  Solution part = *s;
  if (is_whole(s, group)) {
    return part;
  }
  int n = part.n = group->n;
  part.all = mj_stackAllocByte(d, (size_t)n * sizeof(Coupled), _Alignof(Coupled));
  part.moment = mj_stackAllocInt(d, n);
  part.bias = mj_stackAllocNum(d, n);
  part.a = mj_stackAllocNum(d, n);
  part.force = mj_stackAllocNum(d, n);
  for (int i = 0; i < n; i++) {
    part.all[i] = s->all[group->device[i]];
    part.moment[i] = s->moment[group->device[i]];
    part.bias[i] = s->bias[group->device[i]];
  }
  return part;
}

void solution_take(const Solution* part, const Group* group, Solution* s) {
  if (is_whole(s, group)) {
    return;
  }
  for (int i = 0; i < group->n; i++) {
    int k = group->device[i];
    s->all[k] = part->all[i];
    s->a[k] = part->a[i];
    s->force[k] = part->force[i];
  }
}
