// Forces and accelerations that fit each other.
//
//   a + W F(a) = p,   F(a) = (F_1(a_1), ..., F_n(a_n))
//
// a_i [m/s^2] acceleration along device i, F_i [N] its force, which does not fall with a_i, W
// [1/kg] (n x n) the acceleration that the forces take away, symmetric or nearly so with no
// negative eigenvalue, p the acceleration without the forces. There is one solution.

#ifndef INERTER_MUJOCO_MONOTONE_H_
#define INERTER_MUJOCO_MONOTONE_H_

#include <mujoco/mujoco.h>

// force of device i at acceleration a
typedef double (*MonotoneForce)(const void* devices, int i, double a);

// how it changes with a, where the force is known; near enough will do
typedef double (*MonotoneSlope)(const void* devices, int i, double a, double force);

// Solve for a (in: a guess), as far as rounding lets. force: the n forces at the solution. scratch:
// n * (n + 4) numbers.
void monotone_solve(MonotoneForce law, MonotoneSlope slope, const void* devices, int n,
                    const mjtNum* W, const mjtNum* p, mjtNum* a, mjtNum* force, mjtNum* scratch);

#endif  // INERTER_MUJOCO_MONOTONE_H_
