// The acceleration of a tendon's length that velocities alone cause, dJ/dt v.
//
//   L_i'' = n (a_2 - a_1) + (|dv|^2 - (n dv)^2) / L_i,   dv = v_2 - v_1
//
// for each straight piece i between two sites: L_i [m] its length, n its direction, v the
// velocities of the sites, a their accelerations while no joint accelerates. Pieces behind a pulley
// count by its divisor.
//
// Why not the engine's own mj_tendonDot: it makes whole Jacobians, and nobody needs them here.

#ifndef INERTER_MUJOCO_BIAS_H_
#define INERTER_MUJOCO_BIAS_H_

#include "mujoco/engine.h"

// 0 for tendons over joints, whose arms are constant, and for those that wrap around geoms: their
// devices have no inertance at the terminals (placement.h), so that nobody reads it.
mjtNum bias_of_tendon(const mjModel* m, const mjData* d, int tendon);

#endif  // INERTER_MUJOCO_BIAS_H_
