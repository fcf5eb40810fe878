// Which devices feel each other's force, and what else feels it.
//
// A force changes the acceleration of the trees that it pulls at, and of those that the metric of
// the step or a constraint ties to them. Devices that share no such trees do not feel each other:
// many cars in one model are as many small problems, and cost no more than that.

#ifndef INERTER_MUJOCO_GROUPS_H_
#define INERTER_MUJOCO_GROUPS_H_

#include "mujoco/engine.h"
#include "mujoco/metric.h"

// devices that feel each other
typedef struct Group_ {
  int n;
  const int* device;  // which of the devices, ascending
  int ndof;
  const int* dof;  // dofs that feel them, ascending
  int nrow;
  const int* row;  // constraint rows that act on these dofs, ascending
} Group;

// Group the devices whose moment arms stand in rows moment[0..n-1] of mjData.actuator_moment, in
// the order of their first. Returns their number, at most n; everything lives on the stack of
// mjData. A device without moment arms is alone, with no dofs.
int groups_find(const mjModel* m, mjData* d, const Metric* metric, int n, const int* moment,
                Group* groups);

#endif  // INERTER_MUJOCO_GROUPS_H_
