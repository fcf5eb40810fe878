// What the model does without the forces that are solved for.
//
//   f = passive - bias + applied + sum_k J_k' F_k
//
// F_k the forces of all actuators but those sought, as the engine limits them. Where nothing that
// it does after the plugins is missing (friction of DC motors, other plugins, forces on bodies) f
// is added up here; else the engine is asked for its forward pass once more.

#ifndef INERTER_MUJOCO_SMOOTH_H_
#define INERTER_MUJOCO_SMOOTH_H_

#include "mujoco/engine.h"
#include "mujoco/metric.h"

// Smooth force f (nv), devices marked `solved` left out. shift (nv): what the metric of the
// discrete integrator adds to it, else 0. Called when the last instance is computed: their rows of
// actuator_force hold the command alone.
void smooth_without(const mjModel* m, mjData* d, int last, mjtNum* force, mjtNum* shift);

#endif  // INERTER_MUJOCO_SMOOTH_H_
