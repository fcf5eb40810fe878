// Forces that are found together with the acceleration they cause, all devices of the model at
// once.
//
//   H a = f + J_c' f_c - sum_i J_i' F_i,     F_i = law_i(a_i),     a_i = J_i a + dJ_i/dt v
//
// H [kg] the metric of the step (metric.h), f smooth forces, J_c' f_c constraint forces (contacts,
// limits, equalities, friction loss), J_i row of moment arms of device i, F_i its force [N].
//
// What is solved for here:
//   - inertance that the engine's matrix does not hold: between two branches of the tree, varying
//     with stroke or speed, swept by a live parameter;
//   - load friction, which hangs on the force through the inertance;
//   - with integrators of one stage, whatever is stiff in velocity or position: friction without
//     memory, end stops, the series element. Their force is that of the end of the step, so that
//     no step is too long for them (core: inerter_force_over_step).
//
// Why not the acceleration of the last step: it diverges as soon as the inertance exceeds the
// effective mass. What constraints answer is solved for too (constrained.h); where the metric of
// the step is not theirs, they feel the force that goes with their acceleration (damped.h).

#ifndef INERTER_MUJOCO_COUPLED_H_
#define INERTER_MUJOCO_COUPLED_H_

#include "mujoco/instance.h"

// Whether the force of a device has to be solved for under the present integrator.
int coupled_needed(const mjModel* m, const Instance* self);

// Solve for the forces of all devices marked `solved` among the instances up to the last one, and
// add them to actuator_force.
void coupled_solve(const mjModel* m, mjData* d, int last);

// At the end of a step: count where its acceleration is not the one that the force was found with,
// as the engine's solver stopped elsewhere.
void coupled_check(const mjModel* m, const mjData* d, Instance* self);

// The force of a device marked `solved`, with its parts, at the acceleration that was found. What
// the engine holds of the inertance is in it only where the share holds it too.
InerterForce coupled_force(const mjModel* m, const Instance* self);

#endif  // INERTER_MUJOCO_COUPLED_H_
