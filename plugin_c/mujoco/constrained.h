// Forces of devices found together with those of constraints.
//
//   A q = f + J_c' f_c(J_c q - a_ref) - P' F,   F_i = law_i(a_i),   a_i = P_i q + bias_i
//
// q acceleration that the engine's constraint solver sees, of the dofs of a group (groups.h); A the
// matrix that it sees (the inertia, or the metric of the discrete integrator), f smooth forces
// without the devices', J_c' f_c constraint forces (rows.h), P moment arms of the devices, P_i q +
// bias_i [m/s^2] the acceleration along device i. q is where the convex function
//   (q - A^-1 f)' A (q - A^-1 f) / 2 + s(J_c q - a_ref) + sum_i (integral of F_i)(P_i q + bias_i)
// is least: found downhill, from the acceleration of the last step. Where the step has another
// metric than A, its own forces are found after that (damped.h).

#ifndef INERTER_MUJOCO_CONSTRAINED_H_
#define INERTER_MUJOCO_CONSTRAINED_H_

#include "mujoco/engine.h"
#include "mujoco/groups.h"
#include "mujoco/metric.h"
#include "mujoco/monotone.h"

// the devices of a group, as the equations above need them
typedef struct Constrained_ {
  int n;                // devices
  const void* devices;  // what the law is asked with
  MonotoneLaw law;
  const int* moment;    // their rows of mjData.actuator_moment
  const mjtNum* bias;   // n
  const mjtNum* grain;  // n, see monotone.h
} Constrained;

// Whether the workspace for a group fits on the stack of mjData.
int constrained_fits(const mjModel* m, const mjData* d, const Group* group, int n);

// Solve. smooth: f as a vector of the model; a: acceleration along the devices; force: F; W (n x
// n): how the acceleration falls with the force there, constraints answering. q becomes the
// engine's warm start. Returns the number of rounds, negative if it stopped at its bound; then the
// warm start stays, or is the last round's where a step with damping of its own goes on from it.
int constrained_solve(const mjModel* m, mjData* d, const Metric* metric, const Group* group,
                      const Constrained* problem, const mjtNum* smooth, mjtNum* a, mjtNum* force,
                      mjtNum* W);

#endif  // INERTER_MUJOCO_CONSTRAINED_H_
