// The effective mass of a step, in the way of the chosen integrator.
//
//   H a = f + J_c' f_c,   H = M                          RK4, Euler without joint damping
//                         H = M + h D                    Euler (D: joint damping)
//                         H = M - h df/dv                implicit, implicitfast
//                         H = M + h D + h^2 K            discrete
//
// a [rad/s^2, m/s^2]: (v_next - v) / h, the acceleration that the step applies; f smooth forces,
// J_c' f_c constraint forces. A force that is to be proportional to the acceleration has to be
// found in this metric: in another one a strong damper beside the inerter would be felt twice.

#ifndef INERTER_MUJOCO_METRIC_H_
#define INERTER_MUJOCO_METRIC_H_

#include "mujoco/engine.h"

typedef enum MetricKind_ { METRIC_INERTIA, METRIC_DISCRETE, METRIC_CHOLESKY, METRIC_LU } MetricKind;

typedef struct Metric_ {
  MetricKind kind;
  mjtNum* matrix;   // H, in the sparsity of M (METRIC_CHOLESKY) or of D (METRIC_LU)
  mjtNum* factor;   // of H
  mjtNum* inverse;  // inverse diagonal of the factor (METRIC_CHOLESKY)
} Metric;

// The metric of the present step; it lives on the stack of mjData. And its factor, that is wanted
// before anything is solved with it.
Metric metric_of_step(const mjModel* m, mjData* d);
void metric_factor(const mjModel* m, mjData* d, const Metric* metric);

// Whether the acceleration of the step differs from mjData.qacc.
int metric_moves_qacc(const Metric* metric);

// x = H^-1 y, or its transpose, of some dofs (dof[0..ndof-1], ascending, whole trees that the
// metric ties to no others). x and y are vectors of the model, different ones; the places of other
// dofs are not looked at.
void metric_solve(const mjModel* m, mjData* d, const Metric* metric, int ndof, const int* dof,
                  const mjtNum* y, mjtNum* x);
void metric_solve_transposed(const mjModel* m, mjData* d, const Metric* metric, int ndof,
                             const int* dof, const mjtNum* y, mjtNum* x);

// Factor in place a matrix in the sparsity of D (METRIC_LU), or the rows of some dofs of it, as
// above; and solve in place with that.
void metric_factor_lu(const mjModel* m, mjData* d, int ndof, const int* dof, mjtNum* A);
void metric_solve_lu(const mjModel* m, const mjtNum* A, int ndof, const int* dof, mjtNum* x);

// product = H x in the metric of the discrete integrator
void metric_multiply_discrete(const mjModel* m, mjData* d, const mjtNum* x, mjtNum* product);

#endif  // INERTER_MUJOCO_METRIC_H_
