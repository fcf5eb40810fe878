// A flywheel on a linear spring along a motion of the terminals, exact for a quintic.
//
//   m s'' + c s' + k s = m a(t) + c_w v(t) + e + e' t,   w = v - s'
//
// The right side over m is a sum of f_k t^k / k!, and s what it would be without and f_k G_k(t),
// where G_k answers t^k / k! from rest: G_k' = G_k-1, with G_-1 the answer to a blow.
//
//   k / m G_k + c / m G_k-1 + G_k-2 = t^k / k!
//
// Upwards this loses digits where little turns in a step, there G_4 and G_3 are sums of powers and
// it is gone down; where the spring is slow beside its damper each of both decays is taken alone.
// A step that does not resolve the oscillation settles: s is the polynomial that the motion drives.
//
// m [kg] mass, k > 0 [N/m] stiffness, c [N s/m] damping of the spring and of the flywheel, c_w of
// the flywheel alone; e [N], e' [N/s] a force that deflects the spring; s [m] deflection, w [m/s]
// velocity of the flywheel.
// Source: linear oscillator; phi functions of exponential integrators (Hochbruck, Ostermann 2010).

#include "series.h"

enum { S, W };  // places in z

// turns [rad] of a step from which on it is not resolved
static const double kUnresolved = 16.0;
// turns of a step below which powers are summed, and how many at most
static const double kShort = 2.0;
enum { MOST_POWERS = 40 };
// 1 / (n + 5)
static const double kShare[] = {
    1. / 5,  1. / 6,  1. / 7,  1. / 8,  1. / 9,  1. / 10, 1. / 11, 1. / 12, 1. / 13, 1. / 14,
    1. / 15, 1. / 16, 1. / 17, 1. / 18, 1. / 19, 1. / 20, 1. / 21, 1. / 22, 1. / 23, 1. / 24,
    1. / 25, 1. / 26, 1. / 27, 1. / 28, 1. / 29, 1. / 30, 1. / 31, 1. / 32, 1. / 33, 1. / 34,
    1. / 35, 1. / 36, 1. / 37, 1. / 38, 1. / 39, 1. / 40, 1. / 41, 1. / 42, 1. / 43, 1. / 44};

void decay_driven(double rate, double t, double* driven) {
  double power[RESPONSES];  // t^k / k!
  power[0] = 1;
  for (int k = 1; k < RESPONSES; k++) {
    power[k] = power[k - 1] * t / k;
  }
  if (rate * t > kShort) {
    double below = exp(-rate * t);
    for (int k = 0; k < RESPONSES; k++) {
      below = driven[k] = (power[k] - below) / rate;
    }
    return;
  }
  double term = power[RESPONSES - 1] * t / RESPONSES, sum = term;
  for (int n = 1; n < MOST_POWERS && fabs(term) > 1e-17 * fabs(sum); n++) {
    term *= -rate * t / (n + RESPONSES);
    sum += term;
  }
  driven[RESPONSES - 1] = sum;
  for (int k = RESPONSES - 1; k > 0; k--) {
    driven[k - 1] = power[k] - rate * driven[k];
  }
}

// where little turns in a step: powers of the answer to a blow, 0, 1, and what the equation makes
// of them
static Swing short_swing(double damping, double stiffness, double turns, double t) {
  double before = 0, now = 1, bound = 1, square = t * t / 2, cube = square * t / 3;
  double fourth = cube * t / 4, power = fourth * t / 5;
  Swing swing = {.time = t, .decay = 0.5 * damping, .scale = 1, .driven = {0}};
  double* driven = swing.driven;
  for (int n = 1; n < MOST_POWERS && bound > 1e-17; n++) {
    double next = -damping * now - stiffness * before, share = kShare[n];
    driven[3] += now * power;
    power *= t * share;
    driven[4] += now * power;
    before = now;
    now = next;
    bound *= turns * share;
  }
  driven[2] = fourth - damping * driven[3] - stiffness * driven[4];
  driven[1] = cube - damping * driven[2] - stiffness * driven[3];
  driven[0] = square - damping * driven[1] - stiffness * driven[2];
  swing.odd = t - damping * driven[0] - stiffness * driven[1];
  swing.even = 1 - damping * swing.odd - stiffness * driven[0] + swing.decay * swing.odd;
  return swing;
}

static void find_driven(double damping, double stiffness, Swing* swing) {
  double t = swing->time, decay = swing->decay;
  double* driven = swing->driven;
  if (decay * decay > 1.5 * stiffness) {
    double rate = sqrt(decay * decay - stiffness), quick[RESPONSES], slow[RESPONSES];
    decay_driven(decay + rate, t, quick);
    decay_driven(stiffness / (decay + rate), t, slow);
    for (int k = 0; k < RESPONSES; k++) {
      driven[k] = 0.5 * (slow[k] - quick[k]) / rate;
    }
  } else {
    double power = 1, blow = swing->scale * swing->odd;
    double two = swing->scale * (swing->even - decay * swing->odd), one = blow;
    for (int k = 0; k < RESPONSES; k++) {
      power *= k ? t / k : 1;
      driven[k] = (power - damping * one - two) / stiffness;
      two = one;
      one = driven[k];
    }
  }
}

Swing oscillator_swing(const Oscillator* o, double t) {
  double damping = o->damping / o->mass, stiffness = o->stiffness / o->mass;
  double turns = damping * t + sqrt(stiffness) * t;
  if (turns < kShort) {
    return short_swing(damping, stiffness, turns, t);
  }
  double decay = 0.5 * damping, square = stiffness - decay * decay;
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
  if (square > 0 && stiffness * t * t > kUnresolved * kUnresolved) {
    scale = 0;  // a ring that no sample shows has died away
  }
  Swing swing = {t, decay, scale, even, odd, {0}};
  find_driven(damping, stiffness, &swing);
  return swing;
}

// free oscillation from value u and rate r: value and rate at its end
static void oscillate(const Oscillator* o, const Swing* swing, double* u, double* r) {
  double value = *u, speed = *r, lead = speed + swing->decay * value;
  double pull = o->stiffness / o->mass * value + swing->decay * speed;
  *u = swing->scale * (value * swing->even + lead * swing->odd);
  *r = swing->scale * (speed * swing->even - pull * swing->odd);
}

void oscillator_swung(const Oscillator* o, const Swing* swing, const Way* way, double* z) {
  double lost = o->lost / o->mass, u = z[S], r = way->v - z[W];
  const double force[RESPONSES] = {
      way->a + lost * way->v + o->push / o->mass, way->jerk + lost * way->a + o->drift / o->mass,
      way->snap + lost * way->jerk, way->crackle + lost * way->snap, lost * way->crackle};
  oscillate(o, swing, &u, &r);
  double below = swing->scale * swing->odd;
  for (int k = 0; k < RESPONSES; k++) {
    r += below * force[k];
    below = swing->driven[k];
    u += below * force[k];
  }
  z[S] = u;
  z[W] = way_speed(way, swing->time) - r;
}

void oscillator_step(const Oscillator* o, const Way* way, double t, double* z) {
  Swing swing = oscillator_swing(o, t);
  oscillator_swung(o, &swing, way, z);
}
