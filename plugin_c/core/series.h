// What the files of the series element between terminals and flywheel give to each other and to the
// device.

#ifndef INERTER_CORE_SERIES_H_
#define INERTER_CORE_SERIES_H_

#include "laws.h"

// clutch.c: F_c for the sign of a force; force of a slip u, with its slope; u at which
// weight S(u) + damping u is a force; u and force where the spring bears a force and the element
// lengthens at a rate
double clutch_limit(const InerterDevice* p, double force);
double clutch_law(const InerterDevice* p, double u);
double clutch_slope(const InerterDevice* p, double u);
double clutch_speed(const InerterDevice* p, double weight, double damping, double force);
double clutch_rate(const InerterDevice* p, double spring, double rate);
double clutch_carries(const InerterDevice* p, double spring, double rate);

// series.c: states s, w, gap or slip in z; x, v of the terminals; drag: what friction at the
// flywheel takes of the force
double series_force(const InerterDevice* p, double v, const double* z);
void series_rate(const InerterDevice* p, double x, double v, const double* z, double drag,
                 double* rate);
double series_energy(const InerterDevice* p, const double* z);
double series_heat(const InerterDevice* p, double v, const double* z);
int series_valid(const InerterDevice* p, const double* z, char* message);
void series_of_force(const InerterDevice* p, double v, double force, double* z);

// series.c: spring phi(d) with its slope
Tangent series_spring(const InerterDevice* p, double d);

// number of its states
static inline int series_count(const InerterDevice* p) {
  return has(p, PART_SERIES) ? 2 + ((p->parts & (PART_BACKLASH | PART_CLUTCH)) != 0) : 0;
}

// what of the deflection is not the spring's: the position in the play, or the slip
static inline double series_gap(const InerterDevice* p, const double* z) {
  if (has(p, PART_CLUTCH)) {
    return z[2];
  }
  if (!has(p, PART_BACKLASH)) {
    return 0;
  }
  return clamp(p->series_damping > 0 ? z[2] : z[0], -p->backlash, p->backlash);
}

// oscillator.c: a flywheel on a linear spring, and its states after a time
typedef struct Oscillator_ {
  double mass, damping, stiffness;
  double lost;         // part of the damping that holds the flywheel
  double push, drift;  // force that deflects the spring, and its rate
} Oscillator;

// what it does in a time: by itself, cos and sin / frequency or their hyperbolic sisters, and where
// t^k / k! drives it from rest
typedef struct Swing_ {
  double time, decay, scale, even, odd;
  double driven[RESPONSES];
} Swing;

Swing oscillator_swing(const Oscillator* o, double t);
void oscillator_swung(const Oscillator* o, const Swing* swing, const Way* way, double* z);
void oscillator_step(const Oscillator* o, const Way* way, double t, double* z);

// what a loose flywheel does in a time: its way per velocity [s] and per push [s^2], what is left
// of a deflection
typedef struct Slide_ {
  double time, run, late, fade;
} Slide;

// series_exact.c: steps of h seconds of one device in closed form. What all of them have in common
// is worked out when it is first asked for. series_exact: states after a step, 1; 0 and nothing
// done where no closed form holds. Friction at the flywheel is oscillator.push, a constant.
typedef struct SeriesExact_ {
  int holds;  // whether there may be such steps
  double h;
  double dashpot;                   // alone in series [N s/m]; 0: there is a spring
  double decay, driven[RESPONSES];  // of that: what is left of s' after a step, and the rest
  int bends;                        // whether a leak that bends is alone in series
  int has_swings, has_slides;
  Oscillator oscillator;
  Swing half_swing, swing;
  Slide half_slide, slide;
} SeriesExact;

void series_exact_steps(const InerterDevice* p, double h, SeriesExact* steps);
int series_exact(const InerterDevice* p, SeriesExact* steps, const Way* way, double* z);

// whether friction that was one force and is another is the same all along, to a fiftieth
static inline int friction_is_even(double before, double after) {
  return fabs(after - before) <= 0.02 * fabs(before);
}

// series_sliding.c: the same where friction at the flywheel slides evenly; bristle: its states
int series_sliding(const InerterDevice* p, SeriesExact* steps, double x, const Way* way,
                   double* bristle, double* z);

// series_frozen.c: the same of varying coefficients, where less than `most` parts are enough
int series_frozen(const InerterDevice* p, double x, const Way* way, double* z, double h, int most);

// series_step.c: into how many parts a step of h seconds is divided; states after a time h from x
// on a way; force over a step and states at its end, where the velocity is v,
// for a mobility of the terminals. bristle: state of a friction law at the flywheel; drag: what
// friction at the flywheel takes of the force; carried: what is left for the inertance
double series_parts(const InerterDevice* p, double stiffness, double inertance, double h);
// from there on a step is not resolved: one behind a play, whose contacts have to be seen
enum { SERIES_MOST_PARTS = 256 };
static inline double series_most_parts(const InerterDevice* p) {
  return has(p, PART_BACKLASH) ? SERIES_MOST_PARTS : 1e8;
}
void series_step(const InerterDevice* p, double x, const Way* way, double* bristle, double* z,
                 double h);
double series_over_step(const InerterDevice* p, double x, double v, double* bristle, double* z,
                        double h, double mobility, double* drag);

#endif  // INERTER_CORE_SERIES_H_
