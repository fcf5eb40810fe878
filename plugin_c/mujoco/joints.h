// Forces of devices that are each on one joint, found without the matrix W of monotone.h.
//
//   H x = f - sum_i g_i F_i(a_i) e_i,   a_i = g_i x_i + bias_i
//
// x_i acceleration of the dof of device i, g_i its gear, e_i that dof, H the metric of the step
// (metric.h), f smooth forces without the devices'. The slopes of the laws stand on the diagonal of
// H then: the matrix of a round is as sparse as the engine's own, and as quickly factorised.

#ifndef INERTER_MUJOCO_JOINTS_H_
#define INERTER_MUJOCO_JOINTS_H_

#include "mujoco/engine.h"
#include "mujoco/groups.h"
#include "mujoco/metric.h"
#include "mujoco/monotone.h"

// Whether a group is such: no constraints, a metric in the sparsity of the engine's. W is not found
// then.
int joints_fit(const mjModel* m, const mjData* d, const Metric* metric, const Group* group,
               const int* moment);

// The devices of such a group.
typedef struct Joints_ {
  int n;
  const void* devices;  // what the law is asked with
  MonotoneLaw law;
  int lines;           // 1: every law is a line
  const int* moment;   // their rows of mjData.actuator_moment
  const mjtNum* bias;  // n
} Joints;

// Solve for a (in: a guess), as far as rounding lets. smooth: f as a vector of the model; force:
// the n forces at the solution. Returns the number of rounds, negative if it stopped at its bound.
int joints_solve(const mjModel* m, mjData* d, const Metric* metric, const Group* group,
                 const Joints* problem, const mjtNum* smooth, mjtNum* a, mjtNum* force);

#endif  // INERTER_MUJOCO_JOINTS_H_
