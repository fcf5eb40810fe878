// Cholesky factor of a symmetric matrix whose rows begin late.
//
// The lower half is held in full rows of n numbers; row i holds nothing before column first[i], and
// so does its factor.

#ifndef INERTER_MUJOCO_PROFILE_H_
#define INERTER_MUJOCO_PROFILE_H_

#include "mujoco/engine.h"

// Factor in place, the diagonal inverted; 0 if the matrix is not positive.
int profile_factor(int n, const int* first, mjtNum* matrix);

// x = K^-1 x with the factor of K
void profile_solve(int n, const int* first, const mjtNum* factor, mjtNum* x);

// product of two vectors, in four sums, which a processor adds side by side
mjtNum profile_dot(const mjtNum* a, const mjtNum* b, int n);

#endif  // INERTER_MUJOCO_PROFILE_H_
