// The core under the sanitizers: random devices, random and extreme values,
// every function. Prints the number of calls; a sanitizer's report or a broken
// promise ends it with an error.

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/device.h"
#include "core/motion.h"

static uint64_t seed = 20261121;

// uniform in [0, 1): xorshift64*
static double uniform(void) {
  seed ^= seed >> 12;
  seed ^= seed << 25;
  seed ^= seed >> 27;
  return (double)((seed * UINT64_C(2685821657736338717)) >> 11) / 9007199254740992.0;
}

static int below(int n) {
  return (int)(uniform() * n);
}

// a number of any size and sign; every tenth from a list of the awkward ones
static double any(void) {
  const double awkward[] = {0,     -0.0,   1,       -1,       5e-324,   -5e-324, 2.3e-308, 1e-300,
                            1e300, -1e300, 1.7e308, -1.7e308, INFINITY, NAN,     1e12,     -1e12};
  if (below(10) == 0) {
    return awkward[below((int)(sizeof(awkward) / sizeof(*awkward)))];
  }
  double size = pow(10, 24 * uniform() - 12);
  return below(2) ? size : -size;
}

static double moderate(void) {
  double size = pow(10, 6 * uniform() - 4);
  return below(8) ? (below(2) ? size : -size) : 0;
}

// a device with random keys; returns 0 where the core refused it, always with a
// message
static int random_device(InerterDevice* device, int tame) {
  char message[INERTER_MESSAGE_SIZE];
  char text[64];
  inerter_default(device);
  int law = below(INERTER_NFRICTION);
  if (inerter_set(device, "friction", inerter_friction_name(law), message)) {
    abort();
  }
  for (int i = 0; i < INERTER_NPARAMETER; i++) {
    const InerterParameter* p = inerter_parameter(i);
    int read = !*p->laws || strstr(p->laws, inerter_friction_name(law));
    if (tame ? !read || below(4) == 0 : below(3)) {
      continue;
    }
    double value = tame ? fabs(moderate()) : any();
    if (tame && value < p->lower) value = p->lower;
    if (tame && value > p->upper) value = p->upper;
    snprintf(text, sizeof(text), "%.17g", value);
    memset(message, 0, sizeof(message));
    if (inerter_set(device, p->name, text, message) && !strstr(message, p->name)) {
      abort();
    }
  }
  memset(message, 0, sizeof(message));
  int refused = inerter_finish(device, message);
  if (refused && !*message) {
    abort();
  }
  return !refused;
}

// texts that a configuration file might hold
static void awkward_texts(void) {
  const char* texts[] = {
      "",       " ",  "nan",   "inf",   "-",        "1e",     "1e999",
      "1e-999", "0x", "0x1p4", "1.5.2", "\xff\xfe", "%s%n%d", "12345678901234567890",
      "1,5"};
  const char* keys[] = {"inertance", "friction", "", "inertanc", "%s%n", "bw_exponent"};
  char message[INERTER_MESSAGE_SIZE];
  char* endless = malloc(100000);
  if (!endless) {
    abort();
  }
  memset(endless, '7', 99999);
  endless[99999] = 0;
  for (size_t k = 0; k < sizeof(keys) / sizeof(*keys); k++) {
    InerterDevice device;
    inerter_default(&device);
    for (size_t i = 0; i < sizeof(texts) / sizeof(*texts); i++) {
      if (inerter_set(&device, keys[k], texts[i], message) && strlen(message) < 10) {
        abort();
      }
    }
    inerter_set(&device, keys[k], endless, message);
    inerter_set(&device, endless, "1", message);
    inerter_finish(&device, message);
  }
  free(endless);
}

int main(void) {
  enum { N = 64, DEVICES = 3 };
  long calls = 0;
  static double x[N], v[N], a[N], z[N], result[6 * N], many[DEVICES * N];
  awkward_texts();

  // past either end of the lists
  for (int i = -2; i < 100; i++) {
    int known = i >= 0 && i < INERTER_NFRICTION;
    if (known != (inerter_friction_name(i) != NULL)) abort();
    if (known != (inerter_friction_meaning(i) != NULL)) abort();
    if (known != (inerter_friction_nstate(i) >= 0)) abort();
    if ((i >= 0 && i < INERTER_NPARAMETER) != (inerter_parameter(i) != NULL)) abort();
  }

  for (int round = 0; round < 20000; round++) {
    InerterDevice device;
    int tame = below(2);
    if (!random_device(&device, tame)) {
      continue;
    }
    for (int i = 0; i < N; i++) {
      x[i] = tame ? moderate() : any();
      v[i] = tame ? moderate() : any();
      a[i] = tame ? moderate() : any();
      z[i] = tame ? 1e-6 * moderate() : any();
    }
    double h = tame ? pow(10, 18 * uniform() - 9) : any();
    calls++;

    // one by one
    double stepped = inerter_state_step(&device, x[0], v[0], z[0], h);
    double found = inerter_state_of_force(&device, x[1], v[1], a[1], any());
    if (tame && inerter_nstate(&device) && device.friction != INERTER_FRICTION_bouc_wen &&
        (!isfinite(stepped) || !isfinite(found))) {
      fprintf(stderr, "round %d: step %g, state of force %g\n", round, stepped, found);
      return 1;
    }
    inerter_evaluate(&device, N, x, v, a, z, result);

    // along a motion; n = 0 and missing outputs are allowed
    double state = z[0];
    inerter_along(&device, N, fabs(h), x, v, a, &state, result, result + N, result + 2 * N);
    inerter_along(&device, N, fabs(h), x, v, a, NULL, NULL, NULL, NULL);
    inerter_along(&device, 0, fabs(h), NULL, NULL, NULL, &state, NULL, NULL, NULL);
    InerterDevice devices[DEVICES] = {device, device, device};
    inerter_along_many(devices, DEVICES, N, fabs(h), x, v, a, many);
    if (memcmp(many, many + N, sizeof(double) * N) != 0) {
      return 2;
    }
  }
  printf("%ld devices\n", calls);
  return calls > 1000 ? 0 : 3;
}
