// A device: inertance, viscous damping, stiffness, further force laws and one friction law.
//
//   F = b(x) a + b'(x) v^2 / 2 + c v + c2 v|v| + k x + k3 x^3 + F_0 + F_friction
//       + mu |b(x) a + b'(x) v^2 / 2| sign(v),   b(x) = b max(0.01, 1 + gradient x + curvature x^2)
//
// The term with b' makes a varying inertance keep its kinetic energy b(x) v^2 / 2.
// x, v, a: displacement [m] (length minus rest_length), velocity [m/s] and acceleration [m/s^2] of
// terminal 2 relative to terminal 1, positive = longer. Functions take the length. F [N]: the force
// that lengthens the device, tension positive. For a rotational device read rad, N m and kg m^2.
//
// This file and its neighbours are plain C17: no allocation, no globals, no simulator.

#ifndef INERTER_CORE_DEVICE_H_
#define INERTER_CORE_DEVICE_H_

#include <stddef.h>
#include <stdint.h>

#include "parameters.h"

#ifdef __cplusplus
extern "C" {
#endif

#if defined(_WIN32)
#define INERTER_API __declspec(dllexport)
#else
#define INERTER_API __attribute__((visibility("default")))
#endif

// friction laws: INERTER_FRICTION_NONE, INERTER_FRICTION_COULOMB, ...
typedef enum InerterFriction_ {
#define X(identifier, nstate, meaning) INERTER_FRICTION_##identifier,
  INERTER_FRICTION_LAWS(X)
#undef X
      INERTER_NFRICTION
} InerterFriction;

enum {
#define X(name, ...) INERTER_INDEX_##name,
  INERTER_PARAMETERS(X)
#undef X
      INERTER_NPARAMETER,
  INERTER_MAXSTATE = 1,
  INERTER_MESSAGE_SIZE = 512
};

typedef struct InerterDevice_ {
#define X(name, ...) double name;
  INERTER_PARAMETERS(X)
#undef X
  int friction;    // InerterFriction
  uint64_t given;  // bit i: parameter i was set
} InerterDevice;

// what is known of one parameter
typedef struct InerterParameter_ {
  const char* name;
  const char* unit;
  double initial;    // default; NaN: derived from another parameter when it is not set
  double lower;      // smallest value
  double upper;      // largest value
  int lower_open;    // 1: the smallest value itself is not allowed
  size_t offset;     // place in InerterDevice
  const char* laws;  // friction laws that read it; empty: the device itself
  const char* meaning;
} InerterParameter;

// parts of a force, in N
typedef struct InerterForce_ {
  double total;
  double inertance;  // b(x) a + b'(x) v^2 / 2
  double friction;   // friction law and load friction
} InerterForce;

// Description of parameter i, or NULL past the end.
INERTER_API const InerterParameter* inerter_parameter(int i);

// Name, number of states and meaning of friction law i; NULL or -1 past the end.
INERTER_API const char* inerter_friction_name(int i);
INERTER_API const char* inerter_friction_meaning(int i);
INERTER_API int inerter_friction_nstate(int i);

// Fill the device with the defaults.
INERTER_API void inerter_default(InerterDevice* device);

// Read a parameter (or the friction law) from text. Return 0, or -1 with a message that names the
// key, the value and what is allowed.
INERTER_API int inerter_set(InerterDevice* device, const char* key, const char* text,
                            char message[INERTER_MESSAGE_SIZE]);

// Check every value and how they fit together, and derive what was not set. Return 0, or -1 with a
// message as above.
INERTER_API int inerter_finish(InerterDevice* device, char message[INERTER_MESSAGE_SIZE]);

// Number of states of the device.
INERTER_API int inerter_nstate(const InerterDevice* device);

// Rate of the state at displacement x, velocity v, state z.
INERTER_API double inerter_state_rate(const InerterDevice* device, double x, double v, double z);

// State after a time h at constant velocity v from displacement x, exact or unconditionally stable
// however stiff the law.
INERTER_API double inerter_state_step(const InerterDevice* device, double x, double v, double z,
                                      double h);

// State at which the device has a given total force at x, v, a, within what its friction law can
// hold; 0 where the force does not depend on a state. It tells the state that a measured run begins
// with.
INERTER_API double inerter_state_of_force(const InerterDevice* device, double x, double v, double a,
                                          double force);

// All forces but those that depend on acceleration (inertance force, load friction).
INERTER_API double inerter_force_motion(const InerterDevice* device, double x, double v, double z);

// Force of the friction law alone (without load friction).
INERTER_API double inerter_friction_force(const InerterDevice* device, double x, double v,
                                          double z);

// Inertance at displacement x, b(x) [kg]; slope (if not NULL): b'(x) [kg/m].
INERTER_API double inerter_inertance(const InerterDevice* device, double x, double* slope);

// Load friction per inertance force magnitude at velocity v: mu sign(v), so that it adds
// inerter_load_factor * |inertance force|.
INERTER_API double inerter_load_factor(const InerterDevice* device, double v);

// All forces.
INERTER_API InerterForce inerter_force(const InerterDevice* device, double x, double v, double a,
                                       double z);

// Energy stored in inertance, springs and bristles [J].
INERTER_API double inerter_stored_energy(const InerterDevice* device, double x, double v, double z);

// Power turned into heat [W]: F v - d(stored energy)/dt - F_0 v. The constant force is external.
INERTER_API double inerter_dissipated_power(const InerterDevice* device, double x, double v,
                                            double a, double z);

#ifdef __cplusplus
}
#endif

#endif  // INERTER_CORE_DEVICE_H_
