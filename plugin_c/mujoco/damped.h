// Forces of a step whose damping the constraints do not feel.
//
// Under Euler with joint damping, implicit and implicitfast the engine solves constraints with the
// plain inertia A, and then steps with the metric H (metric.h). An inertance of its own is in both:
//   (A + P' b P) q = f + J_c' f_c(J_c q - a_ref),   (H + P' b P) a = f + J_c' f_c
// A device's force is to be that, twice:
//   A q = f + J_c' f_c(J_c q - a_ref) - P' F(P q + bias)    constraints (constrained.h)
//   H a = f + J_c' f_c - P' F(P a + bias)                   step
// Both are lowest points of convex functions, however strong damping, device and contacts are. One
// force for both, that of the step, need not exist: constraints would push it back by more than it
// pulls.
//
// The engine takes one force, that of the step. What constraints are to feel beside it goes to
// where they would be at rest: with a_ref + J_c e, e = A^-1 P' (F(P q + bias) - F(P a + bias)), the
// engine's solver ends at q + e with the same f_c.

#ifndef INERTER_MUJOCO_DAMPED_H_
#define INERTER_MUJOCO_DAMPED_H_

#include "mujoco/engine.h"
#include "mujoco/groups.h"
#include "mujoco/solution.h"

// The step of a group whose constraints are solved for: part->force is what they feel, the engine's
// warm start is q. part->a and part->force become those of the step, mjData.efc_aref and the warm
// start what makes the engine end there. Returns the number of rounds, negative if it stopped at
// its bound.
int damped_step(const mjModel* m, mjData* d, Solution* part, const Group* group, mjtNum* W);

#endif  // INERTER_MUJOCO_DAMPED_H_
