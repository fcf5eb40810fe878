// Which devices feel each other's force: see groups.h.

#include "mujoco/groups.h"

// so few are solved for at once sooner than they are told apart
enum { FEW = 4 };

//------------------------------ ties between trees ------------------------------------------------

// the tree that stands for all that a tree is tied to
static int head(int* parent, int tree) {
  while (parent[tree] != tree) {
    tree = parent[tree] = parent[parent[tree]];
  }
  return tree;
}

// tie the trees of a sparse row of dofs
static void tie(const mjModel* m, int* parent, const int* dofs, int count) {
  for (int k = 1; k < count; k++) {
    int a = head(parent, m->dof_treeid[dofs[0]]), b = head(parent, m->dof_treeid[dofs[k]]);
    parent[a > b ? a : b] = a > b ? b : a;
  }
}

// tie what the metric of the discrete integrator ties: tendons and actuators that damp or pull back
static void tie_metric(const mjModel* m, const mjData* d, int* parent) {
  for (int k = 0; k < d->nefmT; k++) {
    int tendon = d->efm_tid[k];
    tie(m, parent, m->ten_J_colind + m->ten_J_rowadr[tendon], m->ten_J_rownnz[tendon]);
  }
  for (int k = 0; k < d->nefmA; k++) {
    int actuator = d->efm_aid[k], first = m->actuator_outadr[actuator];
    for (int row = first; row < first + m->actuator_outnum[actuator]; row++) {
      tie(m, parent, d->moment_colind + d->moment_rowadr[row], d->moment_rownnz[row]);
    }
  }
}

// whether more is tied than is looked into: flexes and contacts in the metric, constraints whose
// rows are dense (models of few dofs)
static int all_tied(const mjModel* m, const mjData* d, const Metric* metric) {
  int metric_is_wide =
      metric->kind == METRIC_DISCRETE && (m->nflex || d->nefmK || d->nefmdof || d->nefmcon);
  return metric_is_wide || (d->nefc && !mj_isSparse(m));
}

//------------------------------ groups ------------------------------------------------------------

int groups_find(const mjModel* m, mjData* d, const Metric* metric, int n, const int* row,
                int* order, Group* groups) {
  if (n <= FEW || all_tied(m, d, metric)) {
    for (int i = 0; i < n; i++) {
      order[i] = i;
    }
    groups[0] = (Group){0, n};
    return 1;
  }
  mj_markStack(d);
  int* parent = mj_stackAllocInt(d, m->ntree);
  int* group = mj_stackAllocInt(d, m->ntree);
  for (int tree = 0; tree < m->ntree; tree++) {
    parent[tree] = tree;
    group[tree] = -1;
  }
  for (int i = 0; i < n; i++) {
    tie(m, parent, d->moment_colind + d->moment_rowadr[row[i]], d->moment_rownnz[row[i]]);
  }
  if (metric->kind == METRIC_DISCRETE) {
    tie_metric(m, d, parent);
  }
  for (int i = 0; i < d->nefc; i++) {
    tie(m, parent, d->efc_J_colind + d->efc_J_rowadr[i], d->efc_J_rownnz[i]);
  }

  // a device that moves nothing now feels nobody
  int count = 0;
  int* of = mj_stackAllocInt(d, n);
  for (int i = 0; i < n; i++) {
    int start = d->moment_rowadr[row[i]], alone = !d->moment_rownnz[row[i]];
    int tree = alone ? -1 : head(parent, m->dof_treeid[d->moment_colind[start]]);
    if (alone || group[tree] < 0) {
      groups[count] = (Group){0, 0};
      of[i] = count++;
    } else {
      of[i] = group[tree];
    }
    if (!alone) {
      group[tree] = of[i];
    }
    groups[of[i]].n++;
  }

  // group by group, each in the order of the devices
  for (int g = 1; g < count; g++) {
    groups[g].first = groups[g - 1].first + groups[g - 1].n;
    groups[g - 1].n = 0;
  }
  groups[count - 1].n = 0;
  for (int i = 0; i < n; i++) {
    Group* mine = groups + of[i];
    order[mine->first + mine->n++] = i;
  }
  mj_freeStack(d);
  return count;
}
