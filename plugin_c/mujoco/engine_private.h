// What the engine's library exports and its public headers leave out. The plugin is built for
// exactly one version of the library and refuses any other (see plugin.c).

#ifndef INERTER_MUJOCO_ENGINE_PRIVATE_H_
#define INERTER_MUJOCO_ENGINE_PRIVATE_H_

#include <mujoco/mujoco.h>

// Derivative of the smooth forces by velocity into mjData.qDeriv; bias: Coriolis forces too.
void mjd_smooth_vel(const mjModel* m, mjData* d, int bias);

// Implicit 6 x 6 inertia of a free body that stands alone, for implicitfast (discrete: 0); 0 if the
// joint is none.
int mjd_freeMhat(const mjModel* m, const mjData* d, int joint, mjtNum h, mjtNum A[36],
                 int discrete);
int mju_factorLU6(mjtNum A[36], int pivot[6]);
void mju_solveLU6(mjtNum x[6], const mjtNum A[36], const mjtNum y[6], const int pivot[6]);

// L'DL factors in the sparsity of the inertia matrix.
void mj_factorI(mjtNum* factor, mjtNum* inverse, int nv, const int* rownnz, const int* rowadr,
                const int* colind, const int* index);
void mj_solveLD(mjtNum* x, const mjtNum* factor, const mjtNum* inverse, int nv, int n,
                const int* rownnz, const int* rowadr, const int* colind, const int* index);

// Solve with the effective metric of the discrete integrator; add what it has beyond the inertia,
// times a vector.
void mj_effSolve(const mjModel* m, mjData* d, mjtNum* x, const mjtNum* y);
void mj_effMulAdd(const mjModel* m, mjData* d, mjtNum* result, const mjtNum* vector);

// Damping that actuators add to a joint (returned, and poly), and the slope of a damping law.
mjtNum mj_actuatorDamping(const mjModel* m, mjtObj type, int id, mjtNum poly[mjNPOLY]);
mjtNum mjd_xPolyForce(mjtNum linear, const mjtNum* poly, mjtNum x, int n, int odd);

#endif  // INERTER_MUJOCO_ENGINE_PRIVATE_H_
