// A flywheel on a linear spring along a cubic motion of the terminals, exact.
//
//   m s'' + c s' + k s = m a(t) + c_w v(t) + e + e' t,   w = v - s'
//
// The right side is a polynomial of second order in time: s is a polynomial and a free oscillation.
//
// m [kg] mass, k > 0 [N/m] stiffness, c [N s/m] damping of the spring and of the flywheel, c_w of
// the flywheel alone; e [N], e' [N/s] a force that deflects the spring; s [m] deflection, w [m/s]
// velocity of the flywheel.
// Source: linear oscillator.

#include "laws.h"

enum { S, W };  // places in z

Swing oscillator_swing(const Oscillator* o, double t) {
  double decay = 0.5 * o->damping / o->mass, square = o->stiffness / o->mass - decay * decay;
  double scale = exp(-decay * t), even, odd;
  if (fabs(square) * t * t < 1e-8) {
    even = 1 - 0.5 * square * t * t;
    odd = t * (1 - square * t * t / 6);
  } else if (square > 0) {
    double frequency = sqrt(square);
    even = cos(frequency * t);
    odd = sin(frequency * t) / frequency;
  } else {
    // the exponentials apart, so that a strong damper does not overflow
    double rate = sqrt(-square), slow = exp((rate - decay) * t), fast = exp(-(rate + decay) * t);
    even = 0.5 * (slow + fast);
    odd = 0.5 * (slow - fast) / rate;
    scale = 1;
  }
  return (Swing){t, decay, scale, even, odd};
}

// free oscillation from value u and rate r: value and rate at its end
static void oscillate(const Oscillator* o, const Swing* swing, double* u, double* r) {
  double value = *u, speed = *r, lead = speed + swing->decay * value;
  double pull = o->stiffness / o->mass * value + swing->decay * speed;
  *u = swing->scale * (value * swing->even + lead * swing->odd);
  *r = swing->scale * (speed * swing->even - pull * swing->odd);
}

void oscillator_swung(const Oscillator* o, const Swing* swing, double v, double a, double jerk,
                      double* z) {
  double t = swing->time;

  // the polynomial that the motion drives
  double two = 0.5 * o->lost * jerk / o->stiffness;
  double one = (o->mass * jerk + o->lost * a + o->drift - 2 * o->damping * two) / o->stiffness;
  double zero =
      (o->mass * a + o->lost * v + o->push - o->damping * one - 2 * o->mass * two) / o->stiffness;

  double u = z[S] - zero, r = v - z[W] - one;
  oscillate(o, swing, &u, &r);
  z[S] = zero + (one + two * t) * t + u;
  z[W] = v + (a + 0.5 * jerk * t) * t - (one + 2 * two * t + r);
}

void oscillator_step(const Oscillator* o, double v, double a, double jerk, double t, double* z) {
  Swing swing = oscillator_swing(o, t);
  oscillator_swung(o, &swing, v, a, jerk, z);
}
