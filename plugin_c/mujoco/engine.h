// The engine, for every file of this folder: its public header, what differs between its versions,
// and what its library exports and that header leaves out. A member that another version calls by
// another name is given its name here: nobody includes <mujoco/mujoco.h> beside this. A library of
// the plugin is built for exactly one version and refuses any other (see plugin.c); which versions:
// packaging/engines.py.

#ifndef INERTER_MUJOCO_ENGINE_H_
#define INERTER_MUJOCO_ENGINE_H_

#include <mujoco/mujoco.h>

//------------------------------ versions ----------------------------------------------------------
//
//   before 3.16   mj_effSolve has another name, mj_readCtrl (3.13) other arguments; no `discrete`
//                 before 3.13
//   3.16          no mujoco.batch in Python
//   3.16, 3.17    mj_setConst computes statistics anew; RK4 turns free bodies in second order;
//                 no entry points for plugins in Python (inerter/__init__.py)
//   4.0.0         Newton with a sparse constraint Jacobian is wrong (mujoco #3767); 4.0.1 mends it

#if mjVERSION_HEADER < 3016000
#error "the plugin needs MuJoCo 3.16.0 or newer: the engine's functions below are not in this one"
#endif

// What is known to be wrong with this engine for such a model, NULL if nothing is.
static inline const char* engine_fault(const mjModel* m) {
#if mjVERSION_HEADER == 4000000
  if (m->opt.solver == mjSOL_NEWTON && mj_isSparse(m)) {
    return "MuJoCo 4.0.0 has a fault that this model meets: its Newton solver with a sparse "
           "constraint Jacobian converges slowly and may be wrong (mujoco #3767); take MuJoCo "
           "4.0.1 or 3.17, or <option solver=\"CG\"/> or jacobian=\"dense\"";
  }
#endif
  (void)m;
  return NULL;
}

//------------------------------ what the headers leave out ----------------------------------------

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

#endif  // INERTER_MUJOCO_ENGINE_H_
