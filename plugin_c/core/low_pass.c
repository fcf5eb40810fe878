// A signal through the low-pass of measured records, every so many samples of it.
//
//   H(f) = 1 / (1 + (f / f_c)^6),   h(t) = w e^(-w |t|) / 6 + Im(u e^(i u |t|)) / 3
//
// w = 2 pi f_c, u = w e^(i pi / 6). Sums of each exponential over what came before and over what
// comes after are carried from one kept sample to the next. Beyond its ends the signal goes on as
// its mirror image, sign turned, about the line through both. Against H at the frequencies of the
// samples stands (f_c h)^6 of the signal, which sums over samples fold in.
// Source: partial fractions of |H|^2 of a Butterworth filter of third order.

#include <math.h>

#include "motion.h"

enum {
  CHUNK = 64,  // samples that are summed with powers of a table
  DECAY = 60   // an exponential of -DECAY / 2 is nothing
};

// sums, or powers, of e^(-w t) and of the real and imaginary part of e^(i u t)
typedef struct Modes_ {
  double real, re, im;
} Modes;

// the signal and the line through its ends
typedef struct Signal_ {
  int n;
  const double* x;
  double first, slope;
} Signal;

static Modes modes_after(double angle) {
  double scale = exp(-0.5 * angle), turn = sqrt(0.75) * angle;
  return (Modes){exp(-angle), scale * cos(turn), scale * sin(turn)};
}
static Modes times(Modes a, Modes b) {
  return (Modes){a.real * b.real, a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}
static Modes sum_of(Modes a, Modes b) {
  return (Modes){a.real + b.real, a.re + b.re, a.im + b.im};
}

static double above(const Signal* s, int i) {
  return s->x[i] - (s->first + s->slope * i);
}
static double above_anywhere(const Signal* s, int i) {
  int period = 2 * (s->n - 1), place = ((i % period) + period) % period;
  return place < s->n ? above(s, place) : -above(s, period - place);
}

// of samples k = 1, 2, ... away from one end, each k steps old
static Modes beyond(const Signal* s, int end, int side, double angle) {
  Modes one = modes_after(angle), sum = {0, 0, 0};
  for (int k = (int)fmin(DECAY / angle + 1, 1e6); k > 0; k--) {
    double value = above_anywhere(s, end + side * k);
    sum = times(one, sum_of(sum, (Modes){value, value, 0}));
  }
  return sum;
}

// of `count` samples after one at `begin`: seen from it, or (forth) from the last of them
static Modes of_samples(const Signal* s, int begin, int count, const Modes* power, int forth) {
  Modes sum = {0, 0, 0};
  for (int i = 1; i <= count; i++) {
    double value = above(s, begin + i);
    const Modes* old = power + (forth ? count - i : i);
    sum.real += old->real * value;
    sum.re += old->re * value;
    sum.im += old->im * value;
  }
  return sum;
}

// what is shown of the sums
static double shown(Modes sum, double angle) {
  return angle * (sum.real / 6 + (sqrt(0.75) * sum.im + 0.5 * sum.re) / 3);
}

void inerter_low_pass(int n, int step, double angle, const double* x, double* result) {
  if (n < 2) {
    if (n == 1) result[0] = x[0];
    return;
  }
  Signal signal = {n, x, x[0], (x[n - 1] - x[0]) / (n - 1)};
  Modes power[CHUNK + 1];
  for (int i = 0; i <= CHUNK; i++) {
    power[i] = modes_after(angle * i);
  }
  Modes after = beyond(&signal, n - 1, 1, angle);
  for (int end = n - 1, kept = (n - 1) / step * step; end >= 0; kept -= step) {
    while (end > kept) {
      int count = end - kept < CHUNK ? end - kept : CHUNK;
      end -= count;
      after = sum_of(times(power[count], after), of_samples(&signal, end, count, power, 0));
    }
    result[kept / step] = shown(after, angle);
    if (kept == 0) break;
  }
  Modes before = beyond(&signal, 0, -1, angle);
  for (int begin = 0, kept = 0; kept < n; kept += step) {
    while (begin < kept) {
      int count = kept - begin < CHUNK ? kept - begin : CHUNK;
      before = sum_of(times(power[count], before), of_samples(&signal, begin, count, power, 1));
      begin += count;
    }
    result[kept / step] += shown(before, angle) + signal.first + signal.slope * kept;
  }
}
