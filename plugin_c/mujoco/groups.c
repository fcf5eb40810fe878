// Which devices feel each other's force: see groups.h.

#include "mujoco/groups.h"

//------------------------------ ties between trees ------------------------------------------------

// the tree that stands for all that a tree is tied to
static int head(int* parent, int tree) {
  while (parent[tree] != tree) {
    tree = parent[tree] = parent[parent[tree]];
  }
  return tree;
}

// tie two trees; -1 is none, or nothing that moves
static int tie(int* parent, int a, int b) {
  if (a < 0 || b < 0) {
    return a < 0 ? b : a;
  }
  a = head(parent, a);
  b = head(parent, b);
  parent[a > b ? a : b] = a > b ? b : a;
  return a > b ? b : a;
}

// tie the trees of a sparse row of dofs; returns one of them, or -1
static int tie_row(const mjModel* m, int* parent, const int* dofs, int count) {
  int tree = -1;
  for (int k = 0; k < count; k++) {
    tree = tie(parent, tree, m->dof_treeid[dofs[k]]);
  }
  return tree;
}

// tie what the metric of the discrete integrator ties: tendons and actuators that damp or pull back
static void tie_metric(const mjModel* m, const mjData* d, int* parent) {
  for (int k = 0; k < d->nefmT; k++) {
    int tendon = d->efm_tid[k];
    tie_row(m, parent, m->ten_J_colind + m->ten_J_rowadr[tendon], m->ten_J_rownnz[tendon]);
  }
  for (int k = 0; k < d->nefmA; k++) {
    int actuator = d->efm_aid[k], first = m->actuator_outadr[actuator];
    for (int row = first; row < first + m->actuator_outnum[actuator]; row++) {
      tie_row(m, parent, d->moment_colind + d->moment_rowadr[row], d->moment_rownnz[row]);
    }
  }

  // flexes and contacts in the metric are not looked into
  if (m->nflex || d->nefmK || d->nefmdof || d->nefmcon) {
    for (int tree = 1; tree < m->ntree; tree++) {
      tie(parent, 0, tree);
    }
  }
}

static int is_contact(int type) {
  return type == mjCNSTR_CONTACT_FRICTIONLESS || type == mjCNSTR_CONTACT_PYRAMIDAL ||
         type == mjCNSTR_CONTACT_ELLIPTIC;
}

// tie the trees of a constraint row; returns one of them, or -1
static int tie_constraint(const mjModel* m, const mjData* d, int* parent, int row) {
  const mjContact* contact = is_contact(d->efc_type[row]) ? d->contact + d->efc_id[row] : NULL;
  if (contact && contact->geom[0] >= 0 && contact->geom[1] >= 0) {
    return tie(parent, m->body_treeid[m->geom_bodyid[contact->geom[0]]],
               m->body_treeid[m->geom_bodyid[contact->geom[1]]]);
  }
  if (mj_isSparse(m)) {
    return tie_row(m, parent, d->efc_J_colind + d->efc_J_rowadr[row], d->efc_J_rownnz[row]);
  }
  int tree = -1;
  for (int k = 0; k < m->nv; k++) {
    if (d->efc_J[row * m->nv + k] != 0) {
      tree = tie(parent, tree, m->dof_treeid[k]);
    }
  }
  return tree;
}

//------------------------------ groups ------------------------------------------------------------

// Rows of constraints. With all actuation disabled the discrete integrator has made their Jacobian
// and not yet their softness where the plugin is asked (smooth.c): there is nothing to answer with.
static int known_rows(const mjModel* m, const mjData* d) {
  int early = m->opt.integrator == mjINT_DISCRETE && m->opt.disableflags & mjDSBL_ACTUATION;
  return early ? 0 : d->nefc;
}

// so few devices and dofs are solved for at once sooner than they are told apart
enum { FEW = 4, FEW_DOFS = 30 };

// one group of all
static int group_of_all(const mjModel* m, mjData* d, int n, int nefc, Group* groups) {
  int size = mjMAX(n, mjMAX(m->nv, nefc));
  int* all = mj_stackAllocInt(d, size);
  for (int i = 0; i < size; i++) {
    all[i] = i;
  }
  groups[0] = (Group){n, all, m->nv, all, nefc, all};
  return 1;
}

// places for as many as each group has, one group after another; returns where the next goes
static int** places(mjData* d, int count, const int* size) {
  int total = 0;
  for (int g = 0; g < count; g++) {
    total += size[g];
  }
  int* list = mj_stackAllocInt(d, total + 1);
  int** next = (int**)mj_stackAllocByte(d, (size_t)(count + 1) * sizeof(int*), _Alignof(int*));
  for (int g = 0; g < count; g++) {
    next[g] = list;
    list += size[g];
  }
  return next;
}

int groups_find(const mjModel* m, mjData* d, const Metric* metric, int n, const int* moment,
                Group* groups) {
  int nefc = known_rows(m, d), tied = nefc || metric->kind == METRIC_DISCRETE;
  if (m->ntree == 1 || (!tied && n <= FEW && m->nv <= FEW_DOFS)) {
    return group_of_all(m, d, n, nefc, groups);
  }
  int* parent = mj_stackAllocInt(d, m->ntree);
  int* group = mj_stackAllocInt(d, m->ntree);
  int* of = mj_stackAllocInt(d, n);
  int* tree_of_row = mj_stackAllocInt(d, nefc + 1);
  for (int tree = 0; tree < m->ntree; tree++) {
    parent[tree] = tree;
    group[tree] = -1;
  }
  for (int i = 0; i < n; i++) {
    of[i] = tie_row(m, parent, d->moment_colind + d->moment_rowadr[moment[i]],
                    d->moment_rownnz[moment[i]]);
  }
  if (metric->kind == METRIC_DISCRETE) {
    tie_metric(m, d, parent);
  }
  for (int i = 0; i < nefc; i++) {
    tree_of_row[i] = tie_constraint(m, d, parent, i);
  }

  // number them
  int count = 0;
  int *ndevice = mj_stackAllocInt(d, 3 * n), *ndof = ndevice + n, *nrow = ndof + n;
  for (int i = 0; i < 3 * n; i++) {
    ndevice[i] = 0;
  }
  for (int i = 0; i < n; i++) {
    int top = of[i] < 0 ? -1 : head(parent, of[i]);
    if (top < 0) {
      of[i] = count++;
    } else {
      group[top] = group[top] < 0 ? count++ : group[top];
      of[i] = group[top];
    }
    ndevice[of[i]]++;
  }

  // and list what is in them
  for (int tree = 0; tree < m->ntree; tree++) {
    group[tree] = group[head(parent, tree)];
    if (group[tree] >= 0) {
      ndof[group[tree]] += m->tree_dofnum[tree];
    }
  }
  for (int i = 0; i < nefc; i++) {
    tree_of_row[i] = tree_of_row[i] < 0 ? -1 : group[tree_of_row[i]];
    if (tree_of_row[i] >= 0) {
      nrow[tree_of_row[i]]++;
    }
  }
  int **devices = places(d, count, ndevice), **dofs = places(d, count, ndof);
  int** rows = places(d, count, nrow);
  for (int g = 0; g < count; g++) {
    groups[g] = (Group){ndevice[g], devices[g], ndof[g], dofs[g], nrow[g], rows[g]};
  }
  for (int i = 0; i < n; i++) {
    *devices[of[i]]++ = i;
  }
  for (int dof = 0; dof < m->nv; dof++) {
    int g = group[m->dof_treeid[dof]];
    if (g >= 0) {
      *dofs[g]++ = dof;
    }
  }
  for (int i = 0; i < nefc; i++) {
    if (tree_of_row[i] >= 0) {
      *rows[tree_of_row[i]]++ = i;
    }
  }
  return count;
}
