// Random numbers for the programs of this folder: the same for the same seed,
// everywhere.

#ifndef TESTS_SANITIZED_RANDOM_H_
#define TESTS_SANITIZED_RANDOM_H_

#include <math.h>
#include <stdint.h>

typedef struct Random_ {
  uint64_t state;  // not 0
} Random;

// uniform in [0, 1): xorshift64*
static inline double uniform(Random* random) {
  random->state ^= random->state >> 12;
  random->state ^= random->state << 25;
  random->state ^= random->state >> 27;
  return (double)((random->state * UINT64_C(2685821657736338717)) >> 11) / 9007199254740992.0;
}

static inline int below(Random* random, int n) {
  return (int)(uniform(random) * n);
}

// a number of any size and sign; every tenth from a list of the awkward ones
static inline double any(Random* random) {
  const double awkward[] = {0,     -0.0,   1,       -1,       5e-324,   -5e-324, 2.3e-308, 1e-300,
                            1e300, -1e300, 1.7e308, -1.7e308, INFINITY, NAN,     1e12,     -1e12};
  if (below(random, 10) == 0) {
    return awkward[below(random, (int)(sizeof(awkward) / sizeof(*awkward)))];
  }
  double size = pow(10, 24 * uniform(random) - 12);
  return below(random, 2) ? size : -size;
}

#endif  // TESTS_SANITIZED_RANDOM_H_
