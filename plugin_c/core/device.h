// A device: forces at the terminals, and an inertance, perhaps behind a series element.
//
//   F = T(x, v, z) + N + mu sign(v) |N|
//   T = D(x, v) + k x + k3 x^3 + f(x) + F_map(x, v) + F_0 + F_friction + F_stops + F_branches
//   D = c(x) v + c2 v|v|, bent (damper.c), at w in place of v behind a spring (damper_spring.c)
//   N = B(x, v) a + R(x, v) + G(x, v)                              rigid
//   N = F_s,  B(y, w) w' + R(y, w) + G(y, w) = F_s,  y = x - s     with a series element
//   F = T + F_s,  F_s = N + F_friction(y, w) + mu sign(w) |N|      friction_side = flywheel
//   N = B(y, w) w' + R(y, w) + G(y, w)                             (wheel_friction.c)
//
// N: force through the inertance. B, R: inertance.c. G = flywheel_viscous w + pipe + gas: pipe.c,
// gas_spring.c. c(x), f(x) and other curves along the stroke: curve.c. F_map: force_map.c. F_s,
// deflection s [m],
// flywheel velocity w [m/s]: series.c. F_stops: end_stop.c. x, v, a: displacement [m] (length minus
// rest_length), velocity [m/s] and acceleration [m/s^2] of terminal 2 relative to terminal 1,
// positive = longer. Functions take the length. F [N]: the force that lengthens the device, tension
// positive. For a rotational device read rad, N m and kg m^2.
//
// States z, each only where it is needed, in this order: the friction law's, s, w, the position of
// the free play, the springs of the viscoelastic branches (branches.c), the velocity over dampers
// behind a spring (damper_spring.c), the change of a parameter that the control sets
// (control.c). All 0: unloaded, the flywheel at rest, in the middle of the
// play, the parameter as stated.
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

// friction laws: INERTER_FRICTION_none, INERTER_FRICTION_coulomb, ...
typedef enum InerterFriction_ {
#define X(identifier, nstate, meaning) INERTER_FRICTION_##identifier,
  INERTER_FRICTION_LAWS(X)
#undef X
      INERTER_NFRICTION
} InerterFriction;

// laws of the gas spring: INERTER_GAS_polytropic, INERTER_GAS_expanded
typedef enum InerterGas_ {
#define X(identifier, meaning) INERTER_GAS_##identifier,
  INERTER_GAS_LAWS(X)
#undef X
      INERTER_NGAS
} InerterGas;

// sides on which friction acts: INERTER_SIDE_terminals, INERTER_SIDE_flywheel
typedef enum InerterSide_ {
#define X(identifier, meaning) INERTER_SIDE_##identifier,
  INERTER_FRICTION_SIDES(X)
#undef X
      INERTER_NSIDE
} InerterSide;

// what the control is: INERTER_CONTROL_force, or a parameter, INERTER_CONTROL_viscous, ...
typedef enum InerterControl_ {
#define X(identifier, meaning) INERTER_CONTROL_##identifier,
  INERTER_CONTROLS(X)
#undef X
      INERTER_NCONTROL
} InerterControl;

enum {
#define X(name, ...) INERTER_INDEX_##name,
  INERTER_PARAMETERS(X)
#undef X
      INERTER_NPARAMETER,
  INERTER_INDEX_gas_law,  // not numbers, but they can be given
  INERTER_INDEX_friction_side,
  INERTER_INDEX_control,
  INERTER_NGIVEN = (INERTER_INDEX_control + 64) / 64,
  INERTER_MAXSLIP = 8,                    // elements of maxwell_slip
  INERTER_MAXFRICTION = INERTER_MAXSLIP,  // states of a friction law
  INERTER_MAXBRANCH = 3,
  INERTER_MAXSTATE = INERTER_MAXFRICTION + 3 + INERTER_MAXBRANCH + 2,
  INERTER_MAXCURVE = 64,  // most values of a curve
  INERTER_MAXPERIOD = 8,  // most periods of a sum
  INERTER_MAXPLACE = 24,  // most rows and columns of a force map
  INERTER_MAXSPEED = 16,
  INERTER_MAXMAP = INERTER_MAXPLACE * INERTER_MAXSPEED,
  INERTER_MESSAGE_SIZE = 512
};

// what changes along the stroke: INERTER_STROKE_friction, ...
typedef enum InerterStroke_ {
#define X(name, ...) INERTER_STROKE_##name,
  INERTER_STROKES(X)
#undef X
      INERTER_NSTROKE,
  INERTER_LIST_force_map = 2 * INERTER_NSTROKE,  // after curve and periods of each
  INERTER_NLIST
} InerterStroke;

// a quantity along the stroke: a curve through values, and a sum of periods (curve.c)
typedef struct InerterCurve_ {
  int nvalue, nperiod;                   // 0: none
  double lower, rate;                    // place of the first value [m], values per metre
  double value[INERTER_MAXCURVE];        // as stated
  double fit[INERTER_MAXCURVE + 2];      // of the curve through them; set by inerter_finish
  double period[3 * INERTER_MAXPERIOD];  // length [m], amplitude, phase [rad] of each
} InerterCurve;

// a force over displacement and velocity (force_map.c); all but the values by inerter_finish
typedef struct InerterMap_ {
  int nvalue, nplace, nspeed;     // 0: none
  double rate, speed_rate, edge;  // rows per metre, columns per w(v), w at the last column
  double value[INERTER_MAXMAP];   // as stated, row by row
  double fit[(INERTER_MAXPLACE + 2) * (INERTER_MAXSPEED + 2)];
  InerterCurve still;  // at v = 0
} InerterMap;

typedef struct InerterDevice_ {
#define X(name, ...) double name;
  INERTER_PARAMETERS(X)
#undef X
  int friction;                    // InerterFriction
  int gas_law;                     // InerterGas
  int friction_side;               // InerterSide
  int control;                     // InerterControl
  uint64_t given[INERTER_NGIVEN];  // see inerter_is_given
  uint32_t parts;                  // which parts there are (laws.h); set by inerter_finish
  int nstate, nfriction, nbranch;  // states, of the friction law, of branches; by inerter_finish
  int ndamper;                     // 1: a state of the dampers behind a spring
  int ncontrol;                    // 1: a state of the control
  double control_rest, command;    // value as stated; the one that is commanded (inerter_command)
  double damping_held;             // of `viscous`, what an engine takes care of: left out of forces
  InerterCurve curve[INERTER_NSTROKE];
  InerterMap map;
} InerterDevice;

// Whether parameter i (or a name, such as INERTER_INDEX_gas_law) was set; the inertance also when
// the channel gives it.
static inline int inerter_is_given(const InerterDevice* device, int i) {
  return (int)(device->given[i / 64] >> i % 64 & 1);
}
// Whether damping bends, differs by direction or is behind a spring: no engine's damping can hold
// it.
static inline int inerter_shapes_damping(const InerterDevice* device) {
  return device->damping_asymmetry != 0 || device->damper_stiffness > 0 ||
         (device->damping_knee > 0 && device->damping_beyond != 1) ||
         (device->damping_knee_back > 0 && device->damping_beyond_back != 1);
}
// Whether a finished device has load friction.
static inline int inerter_has_load_friction(const InerterDevice* device) {
  return device->mu_forward > 0 || device->mu_backward > 0;
}

// Whether anything was set.
static inline int inerter_states_something(const InerterDevice* device) {
  uint64_t any = 0;
  for (int i = 0; i < INERTER_NGIVEN; i++) {
    any |= device->given[i];
  }
  return any != 0;
}
static inline void inerter_mark_given(InerterDevice* device, int i) {
  device->given[i / 64] |= UINT64_C(1) << i % 64;
}

// what is known of one parameter
typedef struct InerterParameter_ {
  const char* name;
  const char* unit;
  double initial;    // default; NaN: derived from others when it is not set, or the part is absent
  double lower;      // smallest value
  double upper;      // largest value
  int lower_open;    // 1: the smallest value itself is not allowed
  size_t offset;     // place in InerterDevice
  const char* laws;  // friction laws that read it; empty: the device itself
  const char* meaning;
} InerterParameter;

// what is known of one list of numbers
typedef struct InerterList_ {
  const char* name;
  const char* unit;
  int most;          // numbers
  int periods;       // 1: three numbers each: length [m], amplitude [unit], phase [rad]
  const char* laws;  // as of a parameter
  const char* meaning;
} InerterList;

// parts of a force, in N
typedef struct InerterForce_ {
  double total;
  double inertance;  // through the inertance, N
  double friction;   // friction law and load friction
} InerterForce;

//------------------------------ description -------------------------------------------------------

// Description of parameter i, or NULL past the end.
INERTER_API const InerterParameter* inerter_parameter(int i);

// Description of list i, or NULL past the end; its numbers in a device, `count` of them.
INERTER_API const InerterList* inerter_list(int i);
INERTER_API const double* inerter_list_values(const InerterDevice* device, int i, int* count);

// Size of a device in bytes.
INERTER_API size_t inerter_device_size(void);

// Name, largest number of states and meaning of friction law i; NULL or -1 past the end.
INERTER_API const char* inerter_friction_name(int i);
INERTER_API const char* inerter_friction_meaning(int i);
INERTER_API int inerter_friction_nstate(int i);

// Name and meaning of law i of the gas spring; NULL past the end.
INERTER_API const char* inerter_gas_law_name(int i);
INERTER_API const char* inerter_gas_law_meaning(int i);

// Name and meaning of side i on which friction can act; NULL past the end.
INERTER_API const char* inerter_friction_side_name(int i);
INERTER_API const char* inerter_friction_side_meaning(int i);

// Name and meaning of control i; NULL past the end.
INERTER_API const char* inerter_control_name(int i);
INERTER_API const char* inerter_control_meaning(int i);

//------------------------------ configuration -----------------------------------------------------

// Fill the device with the defaults.
INERTER_API void inerter_default(InerterDevice* device);

// Read a parameter (or the friction or gas law) from text. Return 0, or -1 with a message that
// names the key, the value and what is allowed.
INERTER_API int inerter_set(InerterDevice* device, const char* key, const char* text,
                            char message[INERTER_MESSAGE_SIZE]);

// Set parameter i to a number. Return 0, or -1 where it is out of range.
INERTER_API int inerter_set_number(InerterDevice* device, int i, double value);

// The same as inerter_set for list i from numbers; 0 numbers take it away.
INERTER_API int inerter_set_list(InerterDevice* device, int i, int count, const double* values,
                                 char message[INERTER_MESSAGE_SIZE]);

// What follows of a finished device after a part of it was taken away, without checks.
INERTER_API void inerter_find_parts(InerterDevice* device);

// Check every value and how they fit together, and derive what was not set. Return 0, or -1 with a
// message as above. Every function below wants a finished device.
INERTER_API int inerter_finish(InerterDevice* device, char message[INERTER_MESSAGE_SIZE]);

//------------------------------ states ------------------------------------------------------------

// Number of states of the device, at most INERTER_MAXSTATE.
INERTER_API int inerter_nstate(const InerterDevice* device);

// The compiler that made the library, with its version.
INERTER_API const char* inerter_compiler(void);

// Name of state i: "friction_state" (of maxwell_slip "friction_state_1", ...), "series_deflection",
// "flywheel_velocity", "gap_position" or "slip_position", "branch_deflection_1", ...; NULL past the
// end.
INERTER_API const char* inerter_state_name(const InerterDevice* device, int i);

// Rates of the states z at displacement x, velocity v, acceleration a, which matters only where a
// load bends a bristle (inerter_load_bends) without a series element.
INERTER_API void inerter_state_rate(const InerterDevice* device, double x, double v, double a,
                                    const double* z, double* rate);

// States after a time h at velocity v from displacement x, in place, with the load of an
// acceleration a (as above) and else at constant velocity; unconditionally
// stable however stiff the law. A friction state: exact or second order, at the friction level of
// x. The others: second order where h resolves them, settled where it does not; but the force of
// gas at the flywheel is that of the start, so that h has to resolve its stiffness.
INERTER_API void inerter_state_step(const InerterDevice* device, double x, double v, double a,
                                    double* z, double h);

// States at which the device has a given total force at x, v, a. A friction state within what its
// law can hold; 0 where the force does not depend on it. With a series element this one carries the
// force, the flywheel moves along and friction is at 0. It tells the state that a measured run
// begins with. Behind free play a friction of 0 has many states: the middle of the play.
INERTER_API void inerter_state_of_force(const InerterDevice* device, double x, double v, double a,
                                        double force, double* z);

//------------------------------ control
//------------------------------------------------------------

// From now on the device has the value of its controlled parameter that a command (in the
// parameter's unit, limited to the bounds; NaN: the value that is stated) and the states z say;
// nothing where the control is a force. z may be NULL: no change so far. Rates and steps of the
// states follow the last command; every other function reads the value.
INERTER_API void inerter_command(InerterDevice* device, double command, const double* z);

// Index of the parameter that the control sets, -1 where it is a force.
INERTER_API int inerter_controlled(const InerterDevice* device);

// Power that the actuator gives to the device as it changes the parameter [W]: dE/dp p'
// (control.c).
INERTER_API double inerter_control_power(const InerterDevice* device, double x, double v,
                                         const double* z);

//------------------------------ forces and energy -------------------------------------------------

// All forces that do not depend on acceleration: T, and with a series element also N and its load
// friction. Without one those are told by inerter_inertance and inerter_load_factor, and the damper
// of LuGre, where a load bends its bristle, is that of a = 0.
INERTER_API double inerter_force_motion(const InerterDevice* device, double x, double v,
                                        const double* z);

// The same where the rates of the states at x, v, z are known (inerter_state_rate).
INERTER_API double inerter_force_motion_of_rate(const InerterDevice* device, double x, double v,
                                                const double* z, const double* rate);

// Largest stiffness of the friction law's bristle [N/m], and its damping [N s/m]; 0 without one.
INERTER_API double inerter_bristle(const InerterDevice* device, double* damping);

// Force of the friction law alone (without any load), at the terminals or at the flywheel.
INERTER_API double inerter_friction_force(const InerterDevice* device, double x, double v,
                                          const double* z);

// Inertance that the terminals feel, B(x, v) [kg]; rest (if not NULL): the branch's force R + G at
// a = 0 [N]. With a series element both are 0.
INERTER_API double inerter_inertance(const InerterDevice* device, double x, double v, double* rest);

// Load friction per force N through the inertance at velocity v and states z, so that it adds
// inerter_load_factor * |N|; 0 where the load bends a bristle. Of N only the sign counts.
INERTER_API double inerter_load_factor(const InerterDevice* device, double v, const double* z,
                                       double carried);

// Whether the load raises the level at which a bristle yields: rates of its states then follow N.
INERTER_API int inerter_load_bends(const InerterDevice* device);

// All forces.
INERTER_API InerterForce inerter_force(const InerterDevice* device, double x, double v, double a,
                                       const double* z);

// Forces over a step of length h [s] at whose end the velocity is v + h a, for implicit stepping:
// a continuous function of a that does not fall where friction does not, so that
// a = a0 - mobility * F(a) has one solution. mobility [1/kg]: acceleration of the terminals per
// force. end (if not NULL): states at the end of the step. See over_step.c.
INERTER_API InerterForce inerter_force_over_step(const InerterDevice* device, double x, double v,
                                                 double a, const double* z, double h,
                                                 double mobility, double* end);

// The total of those as a function of the acceleration alone, for a solver that asks often: what
// does not depend on a is found once. z has to live as long as the step.
typedef struct InerterStep_ {
  const InerterDevice* device;
  double x, v;
  const double* z;
  double h, mobility;
  int kind;            // which of the parts below there are (over_step.c)
  double start, rise;  // a line: start + rise a
  double stretch, level, width,
      lean;  // friction without memory: level (1 + lean sign(v1)) tanh(v1 / width)
  double motion, load, load_negative;  // load friction of this instant, for N > 0 and N < 0
} InerterStep;

INERTER_API void inerter_step_begin(InerterStep* step, const InerterDevice* device, double x,
                                    double v, const double* z, double h, double mobility);

// The same for the force of this instant, h = 0; motion: what inerter_force_motion says.
INERTER_API void inerter_step_instant(InerterStep* step, const InerterDevice* device, double x,
                                      double v, const double* z, double motion);

// Whether the force is a line in a; the force at a, and how it rises with a (>= 0).
INERTER_API int inerter_step_is_line(const InerterStep* step);
INERTER_API double inerter_step_force(const InerterStep* step, double a, double* slope);

// An acceleration whose rounding the force does not see: the velocities of terminals and flywheel
// over the step [m/s^2].
INERTER_API double inerter_step_grain(const InerterStep* step);

// Energy stored in inertance, springs, bristles, gas and stops [J].
INERTER_API double inerter_stored_energy(const InerterDevice* device, double x, double v,
                                         const double* z);

// Power turned into heat [W]: F v - d(stored energy)/dt - F_0 v + inerter_control_power. The
// constant force is external.
INERTER_API double inerter_dissipated_power(const InerterDevice* device, double x, double v,
                                            double a, const double* z);

// Heat [J] of a step of one stage, h seconds from x, v, a, z to a velocity v1, an acceleration a1
// and states `end`: the trapezoid of that power, but for what elements of friction slip, which is
// added up exactly. Afterwards the device is at the value that its control has at the end.
INERTER_API double inerter_heat_over_step(InerterDevice* device, double x, double v, double a,
                                          const double* z, double h, double v1, double a1,
                                          const double* end);

// Whether something changes along the stroke; the largest size of its slope [unit/m].
static inline int inerter_has_curve(const InerterDevice* device, InerterStroke stroke) {
  return device->curve[stroke].nvalue > 0 || device->curve[stroke].nperiod > 0;
}
INERTER_API double inerter_curve_steepest(const InerterDevice* device, InerterStroke stroke);

// The largest sizes of the slopes of the force map over x [N/m] and over v [N s/m].
INERTER_API double inerter_map_steepest(const InerterDevice* device, double* over_speed);

// Viscous damping at x [N s/m].
INERTER_API double inerter_viscous(const InerterDevice* device, double x);
// the steepest slope of the viscous damper's force over the velocity
INERTER_API double inerter_steepest_damping(const InerterDevice* device);
// The least of the same; 0 where it levels off.
INERTER_API double inerter_flattest_damping(const InerterDevice* device);

// Whether x and z are finite numbers that lie where the laws hold: 1, or 0 with a message that
// names law, value and limit. Every other function answers a number that is none with such a
// number.
INERTER_API int inerter_valid(const InerterDevice* device, double x, const double* z,
                              char message[INERTER_MESSAGE_SIZE]);

#ifdef __cplusplus
}
#endif

#endif  // INERTER_CORE_DEVICE_H_
