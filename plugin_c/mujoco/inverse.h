// The devices' forces at a given acceleration, for inverse dynamics.

#ifndef INERTER_MUJOCO_INVERSE_H_
#define INERTER_MUJOCO_INVERSE_H_

#include "mujoco/instance.h"

// Forces that the devices have at the acceleration qacc (nv), at the position, velocity and states
// of d, for which mj_forward or mj_inverse has run.
//
//   force  (number of devices, in the order of the instances) tension [N], as a sensor shows it
//   qfrc   (nv) what the actuators of the devices bring of it, which mj_inverse does not know:
//            the forces that are missing for qacc are qfrc_inverse - qfrc
//
// It is the force that the step from here takes (coupled.h), so that mj_forward answers the missing
// forces with qacc. Return 0, or -1 with a message. Nothing of d changes.
INERTER_API int inerter_device_force(const mjModel* m, mjData* d, const mjtNum* qacc, mjtNum* force,
                                     mjtNum* qfrc, char message[INERTER_MESSAGE_SIZE]);

// The acceleration felt (nv) at which constraints answer, where mj_forward ends with qacc: qacc,
// but another one where the devices have one force for the constraints and one for the step
// (damped.h). Returns as above; nothing of d changes.
INERTER_API int inerter_felt_acceleration(const mjModel* m, mjData* d, const mjtNum* qacc,
                                          mjtNum* felt, char message[INERTER_MESSAGE_SIZE]);

#endif  // INERTER_MUJOCO_INVERSE_H_
