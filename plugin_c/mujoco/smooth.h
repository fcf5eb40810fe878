// What the model does without the forces that are solved for.
//
//   f = passive - bias + applied + sum_k J_k' F_k,   H a = f
//
// F_k the forces of all actuators but those sought. Where nothing can change them any more (no
// limits, no DC motors, no other plugins, no forces on bodies) f is added up here; else the engine
// is asked for its forward pass once more.

#ifndef INERTER_MUJOCO_SMOOTH_H_
#define INERTER_MUJOCO_SMOOTH_H_

#include <mujoco/mujoco.h>

// Smooth force f and acceleration of the dofs (nv each), devices marked `solved` left out. Called
// when the last instance is computed: their rows of actuator_force hold the command alone.
void smooth_without(const mjModel* m, mjData* d, int last, mjtNum* force, mjtNum* acceleration);

#endif  // INERTER_MUJOCO_SMOOTH_H_
