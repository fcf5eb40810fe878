// exp, exp - 1, tanh, sin and cos without branches and calls: a loop over samples that takes them
// is compiled for several samples at once.
//
//   exp(x) = 2^k (1 + p),  k = x / ln 2 rounded,  r = x - k ln 2,  p = exp(r) - 1 = sum of r^n / n!
//   sin(x) = sin(k pi/2 + r),  k = x / (pi/2) rounded:  +- sin(r) or +- cos(r), by their series
//
// Their errors are below 3 units in the last place, of sin and cos (of the last place of 1) up to
// |x| = 1e6 (tests/sanitized/test_elementary.py): the same on every machine, whether one sample is
// taken or several. An |x| above 708 counts as 708: exp ends at 1e-308 and 1e307 instead of 0 and
// infinity. NaN stays NaN.

#ifndef INERTER_CORE_ELEMENTARY_H_
#define INERTER_CORE_ELEMENTARY_H_

#include <math.h>
#include <stdint.h>
#include <string.h>

// A function with such a loop is compiled twice where the system can choose as the library is
// loaded (CMakeLists.txt): for every processor, and for those that take four numbers at once.
#ifdef INERTER_CHOOSES
#define SEVERAL_AT_ONCE __attribute__((target_clones("avx2", "default")))
#else
#define SEVERAL_AT_ONCE
#endif

// in a loop over samples there must be no call
#define INLINED inline __attribute__((always_inline))

// the larger one, b where one is no number
static INLINED double larger(double a, double b) {
  return a > b ? a : b;
}

// p and 2^k
static INLINED double reduced_exp(double x, double* scale) {
  const double most = 708, round = 0x1.8p52;  // what is added to it is a whole number
  x = x < -most ? -most : x;
  x = x > most ? most : x;
  double turns = x * 0x1.71547652b82fep0 + round, k = turns - round;

  // ln 2 in two parts: of the first, k times is exact
  double r = (x - k * 0x1.62e42feep-1) - k * 0x1.a39ef35793c76p-33;

  // the last bits of `turns` are k
  uint64_t bits;
  memcpy(&bits, &turns, sizeof(bits));
  bits = (bits + 1023) << 52;
  memcpy(scale, &bits, sizeof(bits));

  double r2 = r * r, r4 = r2 * r2;
  double low = (1.0 / 2 + r * (1.0 / 6)) + (1.0 / 24 + r * (1.0 / 120)) * r2;
  double middle = (1.0 / 720 + r * (1.0 / 5040)) + (1.0 / 40320 + r * (1.0 / 362880)) * r2;
  double high =
      (1.0 / 3628800 + r * (1.0 / 39916800)) + (1.0 / 479001600 + r * (1.0 / 6227020800)) * r2;
  return r + r2 * ((low + middle * r4) + high * (r4 * r4));
}

static INLINED double elementary_exp(double x) {
  double scale, p = reduced_exp(x, &scale);
  return scale + scale * p;
}

static INLINED double elementary_expm1(double x) {
  double scale, p = reduced_exp(x, &scale);
  return scale * p + (scale - 1);
}

static INLINED double elementary_tanh(double x) {
  double gone = -elementary_expm1(-2 * fabs(x)), size = gone / (2 - gone);
  return x < 0 ? -size : size;
}

// sin(x); cosine: cos(x). Of an angle up to ELEMENTARY_ANGLE [rad], where k times pi / 2 is exact.
#define ELEMENTARY_ANGLE 1e6
static INLINED double elementary_sin_cos(double x, double* cosine) {
  const double round = 0x1.8p52;
  double turns = x * 0x1.45f306dc9c883p-1 + round, k = turns - round;

  // pi / 2 in three parts, of the first two of which k times is exact
  double r = x - k * 0x1.921fb544p+0 - k * 0x1.0b4611a6p-34 - k * 0x1.3198a2e037073p-69;
  uint64_t bits;
  memcpy(&bits, &turns, sizeof(bits));

  double s = r * r;
  double odd =
      -1.0 / 6 +
      s * (1.0 / 120 +
           s * (-1.0 / 5040 + s * (1.0 / 362880 + s * (-1.0 / 39916800 +
                                                       s * (1.0 / 6227020800 +
                                                            s * (-1.0 / 1307674368000 +
                                                                 s * (1.0 / 355687428096000)))))));
  double even =
      1.0 / 24 +
      s * (-1.0 / 720 +
           s * (1.0 / 40320 +
                s * (-1.0 / 3628800 + s * (1.0 / 479001600 + s * (-1.0 / 87178291200 +
                                                                  s * (1.0 / 20922789888000))))));
  odd = r + r * s * odd;
  even = 1 - 0.5 * s + s * s * even;

  // the last bits of `turns` are k
  double first = bits & 1 ? even : odd, second = bits & 1 ? odd : even;
  *cosine = (bits + 1) & 2 ? -second : second;
  return bits & 2 ? -first : first;
}

#endif  // INERTER_CORE_ELEMENTARY_H_
