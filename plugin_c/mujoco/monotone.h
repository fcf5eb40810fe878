// Forces and accelerations that fit each other.
//
//   a + W F(a) = p,   F(a) = (F_1(a_1), ..., F_n(a_n))
//
// a_i [m/s^2] acceleration along device i, F_i [N] its force, which does not fall with a_i, W
// [1/kg] (n x n) the acceleration that the forces take away, symmetric or nearly so with no
// negative eigenvalue, p the acceleration without the forces. There is one solution.

#ifndef INERTER_MUJOCO_MONOTONE_H_
#define INERTER_MUJOCO_MONOTONE_H_

#include "mujoco/engine.h"

// Force of device i at acceleration a, and how it rises with a; near enough will do for the rise.
typedef double (*MonotoneLaw)(const void* devices, int i, double a, double* rise);

// Solve for a (in: a guess), as far as rounding lets. grain: n accelerations whose rounding the
// laws do not see, those of their velocities over a step. force: the n forces at the solution.
// scratch: n * (n + 9) numbers. Returns the number of rounds, negative if it stopped at its bound.
int monotone_solve(MonotoneLaw law, const void* devices, int n, const mjtNum* W, const mjtNum* p,
                   const mjtNum* grain, mjtNum* a, mjtNum* force, mjtNum* scratch);

// The same where every law is a line: F_i = start_i + rise_i a_i. scratch: n * (n + 1) numbers.
void monotone_solve_lines(int n, const mjtNum* start, const mjtNum* rise, const mjtNum* W,
                          const mjtNum* p, mjtNum* a, mjtNum* force, mjtNum* scratch);

#endif  // INERTER_MUJOCO_MONOTONE_H_
