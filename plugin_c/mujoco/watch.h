// What goes wrong while a model runs: said once per mjData, and kept from doing harm.

#ifndef INERTER_MUJOCO_WATCH_H_
#define INERTER_MUJOCO_WATCH_H_

#include "mujoco/instance.h"

// Say that states are no finite numbers, and set them to 0, as the engine does with such controls:
// nothing else would stop them, since the engine looks at positions, velocities and accelerations.
void watch_state(const mjModel* m, Instance* self, mjtNum* state);

// The same of the dissipated energy.
void watch_heat(const mjModel* m, Instance* self, mjtNum* heat);

// Say that a force is no finite number. The engine resets such a simulation, if its integrator is
// not discrete, but does not tell what caused it.
void watch_force(const mjModel* m, Instance* self, mjtNum force);

// Say that a law has left the range that it is valid in.
void watch_validity(const mjModel* m, Instance* self, const mjtNum* state);

// Say what is too stiff for the integrator and the timestep, whenever these are new: what acts at
// the start of a step or within stages, and is not resolved by them. Tells too whether a bristle
// would be.
void watch_stiffness(const mjModel* m, Instance* self);

// Tell whether a bristle is too stiff for a step in the present configuration.
void watch_resolution(const mjModel* m, const mjData* d, Instance* self);

// Say that the sites of a tendon meet: there is no direction then.
void watch_sites(const mjModel* m, const mjData* d, Instance* self);

// Rates of the states at an acceleration, where the engine asked for them. The rate of a friction
// state is kept to what the stages of RK4 resolve. At speed v a bristle relaxes
// towards sliding at a rate of sigma0 |v| / g, which is easily beyond the stability of explicit
// stages. There it is slowed to the fastest that is stable: sliding then sets in within a step
// instead of at once, at the same level.
void watch_rates(const mjModel* m, Instance* self, mjtNum a, mjtNum* rate);

#endif  // INERTER_MUJOCO_WATCH_H_
