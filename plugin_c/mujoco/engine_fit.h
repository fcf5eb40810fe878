// Forces that fit the acceleration that the engine's constraint solver ends with.
//
// The solver starts from the solution (constrained.h) and stays there, unless it is told to leave
// it (noslip, no warm start) or something comes after it (gyroscopic terms of free bodies under the
// discrete integrator). Then the engine is asked for its answer to the forces, they are solved for
// with that taken as linear, it is asked again; the best forces stay.

#ifndef INERTER_MUJOCO_ENGINE_FIT_H_
#define INERTER_MUJOCO_ENGINE_FIT_H_

#include "mujoco/solution.h"

// Whether the engine's acceleration is that of the solution.
int engine_fit_is_exact(const mjModel* m, const Solution* s);

// Forces of a solution that fit, W its slopes at the start. Returns whether they do.
int engine_fit(const mjModel* m, mjData* d, Solution* s);

#endif  // INERTER_MUJOCO_ENGINE_FIT_H_
