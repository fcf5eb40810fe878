// What the devices of a model are solved for with, and what is found of them.

#ifndef INERTER_MUJOCO_SOLUTION_H_
#define INERTER_MUJOCO_SOLUTION_H_

#include "mujoco/engine.h"
#include "mujoco/groups.h"
#include "mujoco/instance.h"
#include "mujoco/metric.h"

// one device in the equations of coupled.h
typedef struct Coupled_ {
  Instance* self;
  mjtNum constant;  // inertance that the engine's matrix holds already [kg]
  int constrained;  // 1: constraints act on its group
  int stopped;      // 1: the search for its force stopped at its bound
  InerterStep step;
} Coupled;

// all devices to solve for, and what is found of them
typedef struct Solution_ {
  int n;
  Coupled* all;
  int* moment;   // their rows of mjData.actuator_moment
  mjtNum* bias;  // acceleration that qvel alone causes
  mjtNum* a;     // acceleration along them
  mjtNum* force;
  mjtNum* smooth;  // smooth force of the model without theirs (nv), the shift in it
  mjtNum* shift;   // what the metric of the discrete integrator adds to it (nv)
  Metric metric;
  int ngroup;
  Group* groups;
  int on_joints;    // 1: all are solved for without W (joints.h)
  mjtNum** W;       // of each group: how its accelerations fall with its forces
  int constrained;  // 1: constraints act on some group
  int large;        // 1: on one too large to be solved here
} Solution;

// Force of a device at an acceleration, less what the engine's matrix holds; how it rises.
double solution_law(const void* devices, int i, double a, double* rise);

// Accelerations whose rounding the laws of n devices do not see (monotone.h), on the stack of
// mjData.
mjtNum* solution_grains(mjData* d, const Coupled* all, int n);

// The solution of one group, its devices one after another; on the stack of mjData. And what was
// found of them back to the whole.
Solution solution_part(mjData* d, const Solution* s, const Group* group);
void solution_take(const Solution* part, const Group* group, Solution* s);

// How the accelerations of a group fall with its forces in the metric of the step, without
// constraints.
void solution_mobilities(const mjModel* m, mjData* d, const Solution* part, const Group* group,
                         mjtNum* W);

#endif  // INERTER_MUJOCO_SOLUTION_H_
