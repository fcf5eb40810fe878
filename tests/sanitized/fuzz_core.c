// The core at any doubles: a device from a configuration of any values, then
// every function at any motion and states. Nothing crashes or hangs; what is no
// number is named by inerter_valid; moderate numbers give finite ones.

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/device.h"
#include "core/motion.h"

enum { N = 4 };

// what is looked at, for the report
static InerterDevice device;
static double x[N], v[N], a[N], z[N * INERTER_MAXSTATE], h, mobility, total;

static void fail(int line, const char* promise) {
  fprintf(stderr, "fuzz_core.c:%d: %s\nfriction %s\n", line, promise,
          inerter_friction_name(device.friction));
  for (int i = 0; i < INERTER_NPARAMETER; i++) {
    const InerterParameter* p = inerter_parameter(i);
    if (inerter_is_given(&device, i)) {
      fprintf(stderr, "%s %.17g\n", p->name, *(const double*)((const char*)&device + p->offset));
    }
  }
  fprintf(stderr, "x %.17g v %.17g a %.17g h %.17g mobility %.17g force %.17g\nz", x[0], v[0], a[0],
          h, mobility, total);
  for (int i = 0; i < inerter_nstate(&device); i++) {
    fprintf(stderr, " %.17g", z[i]);
  }
  fprintf(stderr, "\n");
  abort();
}

#define REQUIRE(condition)        \
  do {                            \
    if (!(condition)) {           \
      fail(__LINE__, #condition); \
    }                             \
  } while (0)

// what is left of the input
typedef struct Input_ {
  const uint8_t* bytes;
  size_t size;
  int tame;      // 1: only moderate numbers are wanted
  int moderate;  // 1: every number so far is 0 or from 1e-3 to 1e3
} Input;

static unsigned byte(Input* input) {
  if (!input->size) {
    return 0;
  }
  input->size--;
  return *input->bytes++;
}

// a double of any eight bytes, an awkward one, or one of moderate size
static double number(Input* input) {
  static const double awkward[] = {0,      -0.0,  5e-324, -5e-324,  2.2250738585072014e-308,
                                   1e-300, 1e300, -1e300, 1.7e308,  -1.7e308,
                                   1e12,   -1e12, 1e-12,  INFINITY, -INFINITY,
                                   NAN};
  unsigned kind = byte(input);
  double value = 0;
  if (kind < 40 && !input->tame) {
    uint8_t raw[8];
    for (int i = 0; i < 8; i++) raw[i] = (uint8_t)byte(input);
    memcpy(&value, raw, sizeof(value));
  } else if (kind < 60 && !input->tame) {
    value = awkward[kind % 16];
  } else {
    value = pow(10, (double)byte(input) / 42.5 - 3) * (kind & 1 ? 1 : -1) * (kind % 32 ? 1 : 0);
  }
  double size = fabs(value);
  input->moderate &= size == 0 || (size >= 1e-3 && size <= 1e3);
  return value;
}

static void set(Input* input, const InerterParameter* p) {
  char message[INERTER_MESSAGE_SIZE], text[64];
  int moderate = input->moderate;
  double value = number(input);
  if (isfinite(p->lower)) value = fabs(value);
  snprintf(text, sizeof(text), "%.17g", value);
  if (inerter_set(&device, p->name, text, message)) {
    input->moderate = moderate;  // it was not taken
  }
}

static void set_each(Input* input, const char* names) {
  for (int i = 0; i < INERTER_NPARAMETER; i++) {
    const InerterParameter* p = inerter_parameter(i);
    size_t length = strlen(p->name);
    for (const char* at = names; (at = strstr(at, p->name)); at += length) {
      if ((at == names || at[-1] == ' ') && (at[length] == ' ' || !at[length])) set(input, p);
    }
  }
}

// two parameters of the k-th of several alike parts
static void set_pair(Input* input, const char* one, const char* other, unsigned k) {
  char text[128];
  snprintf(text, sizeof(text), "%s_%u %s_%u", one, k, other, k);
  set_each(input, text);
}

// a friction law with what it needs, some parts, some other parameters; 0 where
// it was refused
static int random_device(Input* input) {
  static const char* const parts[] = {"inertance series_stiffness",
                                      "series_damping",
                                      "backlash",
                                      "stop_upper stop_stiffness",
                                      "gas_pressure gas_area gas_volume",
                                      "piston_area channel_area channel_length"};
  char message[INERTER_MESSAGE_SIZE];
  // the law with the most states more often
  int law = (int)byte(input) % (INERTER_NFRICTION + 5);
  law = law < INERTER_NFRICTION ? law : INERTER_FRICTION_maxwell_slip;
  inerter_default(&device);
  REQUIRE(!inerter_set(&device, "friction", inerter_friction_name(law), message));
  if (law == INERTER_FRICTION_bouc_wen) {
    set_each(input, "bw_stiffness");
  } else if (law == INERTER_FRICTION_maxwell_slip) {
    unsigned count = byte(input) % (2 * INERTER_MAXSLIP);
    for (unsigned k = 1; k <= count + 1 && k <= INERTER_MAXSLIP; k++) {
      set_pair(input, "slip_stiffness", "slip_force", k);
    }
  } else if (law != INERTER_FRICTION_none) {
    set_each(input, "coulomb_force");
  }
  unsigned wanted = byte(input);
  for (int i = 0; i < 6; i++) {
    if (wanted >> i & 1) set_each(input, parts[i]);
  }
  for (unsigned count = wanted >> 6, k = 1; k <= count; k++) {
    set_pair(input, "branch_stiffness", "branch_damping", k);
  }
  unsigned control = byte(input) % (2 * INERTER_NCONTROL);
  if (control && control < INERTER_NCONTROL) {
    REQUIRE(!inerter_set(&device, "control", inerter_control_name((int)control), message));
    // around the value that there is, or anywhere
    double value = *(const double*)((const char*)&device +
                                    inerter_parameter(inerter_controlled(&device))->offset);
    double around = isnan(value) ? 1 : value;
    char text[64];
    snprintf(text, sizeof(text), "%.17g", around - 0.5 * fabs(around));
    inerter_set(&device, "control_lower", text, message);
    snprintf(text, sizeof(text), "%.17g", around + fabs(around) + 1);
    inerter_set(&device, "control_upper", text, message);
    set_each(input, byte(input) % 4 ? "control_lag" : "control_lower control_upper control_lag");
  }
  for (unsigned count = byte(input) % 8; count; count--) {
    set(input, inerter_parameter((int)byte(input) % INERTER_NPARAMETER));
  }
  return !inerter_finish(&device, message);
}

static int all_finite(const double* values, int n) {
  int finite = 1;
  for (int i = 0; i < n; i++) finite &= isfinite(values[i]);
  return finite;
}

// how many inputs had to give finite results, by number of states
static long sound_count[INERTER_MAXSTATE + 1];

static void tell(void) {
  for (int i = 0; i <= INERTER_MAXSTATE; i++) {
    printf("%ld inputs with moderate numbers and %d states\n", sound_count[i], i);
  }
}

int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  Input input = {bytes, size, 0, 1};
  input.tame = byte(&input) & 1;
  if (!random_device(&input)) {
    return 0;
  }
  char message[INERTER_MESSAGE_SIZE] = "";
  int nstate = inerter_nstate(&device), wide = nstate ? nstate : 1;
  double result[6 * N], rates[N * INERTER_MAXSTATE];
  for (int i = 0; i < N; i++) {
    x[i] = number(&input);
    v[i] = number(&input);
    a[i] = number(&input);
  }
  for (int i = 0; i < N * wide; i++) {
    z[i] = number(&input);
  }
  h = fabs(number(&input));
  mobility = fabs(number(&input));
  total = number(&input);

  // what is no number is named
  int finite = isfinite(x[0]) && (!nstate || all_finite(z, nstate));
  if (!inerter_valid(&device, x[0], z, message)) {
    REQUIRE(strlen(message) > 20);
  } else {
    REQUIRE(finite);
  }

  // everything once, for moderate numbers with finite results; not where a law
  // has been left, as by gas without volume, and not by Bouc-Wen where its
  // state grows exponentially (bouc_wen.c)
  int grows =
      device.friction == INERTER_FRICTION_bouc_wen && device.bw_beta < fabs(device.bw_gamma);
  int sound = input.moderate && !grows && inerter_valid(&device, x[0], z, message);
  if (!sound_count[0] && sound && !nstate) {
    atexit(tell);
  }
  sound_count[nstate] += sound;

  // gas at a flywheel behind a series element is taken explicitly: a step has
  // to resolve it
  int steady =
      sound && !(device.gas_pressure > 0 && device.series_stiffness + device.series_damping > 0);
  double own[INERTER_MAXSTATE], end[INERTER_MAXSTATE];
  memcpy(own, z, sizeof(double) * (size_t)wide);
  InerterForce force = inerter_force(&device, x[0], v[0], a[0], own);
  inerter_evaluate(&device, N, x, v, a, z, result, rates);
  inerter_state_rate(&device, x[0], v[0], a[0], own, end);
  REQUIRE(!sound ||
          (isfinite(force.total) && isfinite(force.inertance) && isfinite(force.friction)));
  REQUIRE(!sound || !nstate || all_finite(end, nstate));
  inerter_state_of_force(&device, x[0], v[0], a[0], total, end);
  REQUIRE(!sound || !nstate || all_finite(end, nstate));
  force = inerter_force_over_step(&device, x[0], v[0], a[0], own, h, mobility, end);
  REQUIRE(!steady || (isfinite(force.total) && (!nstate || all_finite(end, nstate))));
  inerter_state_step(&device, x[0], v[0], a[0], own, h);
  REQUIRE(!steady || !nstate || all_finite(own, nstate));
  memcpy(own, z, sizeof(double) * (size_t)wide);
  inerter_evaluate_commanded(&device, N, x, v, a, a, z, result, rates);
  REQUIRE(!sound || all_finite(result, N));
  inerter_along_commanded(&device, N, h, x, v, a, v, own, result, result + N, rates);
  memcpy(own, z, sizeof(double) * (size_t)wide);
  inerter_along(&device, N, h, x, v, a, own, result, result + N, rates);
  return 0;
}
