// Which devices feel each other's force.
//
// A force changes the acceleration of the trees that it pulls at, and of those that the metric of
// the step or a constraint ties to them. Devices that share no such trees do not feel each other:
// many cars in one model are as many small problems, and cost no more than that.

#ifndef INERTER_MUJOCO_GROUPS_H_
#define INERTER_MUJOCO_GROUPS_H_

#include <mujoco/mujoco.h>

#include "mujoco/metric.h"

// devices that feel each other: places first to first + n - 1 in the order
typedef struct Group_ {
  int first;
  int n;
} Group;

// Group the devices whose moment arms stand in rows row[0..n-1] of mjData.actuator_moment. order:
// the n devices, group by group. Returns the number of groups, at most n.
int groups_find(const mjModel* m, mjData* d, const Metric* metric, int n, const int* row,
                int* order, Group* groups);

#endif  // INERTER_MUJOCO_GROUPS_H_
