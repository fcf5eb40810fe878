// What a program may ask of the devices of a running model, beside sensors. Exported by the
// library; Python's inerter.energy and inerter.solve_counts call it.

#ifndef INERTER_MUJOCO_QUERY_H_
#define INERTER_MUJOCO_QUERY_H_

#include <stdint.h>

#include "core/device.h"
#include "mujoco/engine.h"

#ifdef __cplusplus
extern "C" {
#endif

// How often the force of an actuator's device was solved for since the last reset: counts[0]; how
// often that stopped at its bound: counts[1]; how often the engine left force and acceleration of
// an evaluation or a step apart: counts[2]. Returns 0, or -1 if the actuator carries no device
// here.
INERTER_API int inerter_solve_counts(const mjModel* m, const mjData* d, int actuator,
                                     int64_t counts[3]);

// Energy [J] of an actuator's device at the present position, velocity and states of mjData:
// energy[0] stored in it; energy[1] the part of that which the engine's inertia matrix holds
// (native inertance), and which mjData.energy counts. Returns as above.
INERTER_API int inerter_energy(const mjModel* m, const mjData* d, int actuator, double energy[2]);

#ifdef __cplusplus
}
#endif

#endif  // INERTER_MUJOCO_QUERY_H_
