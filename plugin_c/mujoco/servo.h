// Servos whose damping the engine has derived from masses that lack a native inertance.

#ifndef INERTER_MUJOCO_SERVO_H_
#define INERTER_MUJOCO_SERVO_H_

#include "mujoco/engine.h"

// Warn of every position servo whose `dampratio` was turned into a damping before native inertances
// were in place, with the damping that would be right.
//
//   kv = 2 dampratio sqrt(kp m),   1 / m = sum over dofs of moment^2 / M0
//
// By the compiler's init. M0: mjModel.dof_M0 as it was before (nv). d: workspace in qpos0, its
// moments computed.
void servo_warn(const mjModel* m, const mjData* d, const mjtNum* M0);

#endif  // INERTER_MUJOCO_SERVO_H_
