// The core under the sanitizers: random devices, random and extreme values,
// every function. Prints the number of calls; a sanitizer's report or a broken
// promise ends it with an error.

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/device.h"
#include "core/motion.h"
#include "random.h"

static Random source = {20261121};

static double moderate(void) {
  double size = pow(10, 6 * uniform(&source) - 4);
  return below(&source, 8) ? (below(&source, 2) ? size : -size) : 0;
}

// whether a parameter belongs to a part that a tame device leaves out; bits:
// series element, backlash, stops, gas, channel
static int left_out(const char* name, unsigned parts, int slips, int branches) {
  // of several alike the first ones
  if (!strncmp(name, "slip_", 5) || !strncmp(name, "branch_", 7)) {
    return atoi(strrchr(name, '_') + 1) > (*name == 's' ? slips : branches);
  }
  const char* const starts[] = {"series_", "backlash", "stop_",  "gas_", "channel_",
                                "fluid_",  "piston_",  "minor_", "coil_"};
  const int bits[] = {0, 1, 2, 3, 4, 4, 4, 4, 4};
  for (int i = 0; i < 9; i++) {
    if (!strncmp(name, starts[i], strlen(starts[i]))) {
      return !(parts >> bits[i] & 1);
    }
  }
  // the range of curves comes with them, the bounds of a control with it
  if (!strncmp(name, "control_", 8)) {
    return 1;
  }
  // dampers that have a spring need others, which are known later
  return (!strcmp(name, "inertance") && parts >> 4 & 1) || !strncmp(name, "curve_", 6) ||
         !strcmp(name, "damper_stiffness") || !strncmp(name, "force_map_", 10) ||
         !strncmp(name, "clutch_", 7) || !strncmp(name, "leak_", 5);
}

// a control that sets a parameter around its value, or any, with a lag or
// without
static void random_control(InerterDevice* device, int tame, int channel) {
  char message[INERTER_MESSAGE_SIZE], text[64];
  const char *name = NULL, *law = inerter_friction_name(device->friction);
  for (int fits = 0; !fits;) {
    name = inerter_control_name(below(&source, INERTER_NCONTROL));
    fits = 1;
    for (int i = 0; tame && i < INERTER_NPARAMETER; i++) {
      const InerterParameter* p = inerter_parameter(i);
      fits &= strcmp(p->name, name) || !*p->laws || strstr(p->laws, law);
    }
    fits &= !tame || strcmp(name, channel ? "inertance" : "minor_loss");
  }
  if (inerter_set(device, "control", name, message)) {
    abort();
  }
  if (!strcmp(name, "force")) {
    return;
  }
  int parameter = inerter_controlled(device);
  double value = *(const double*)((const char*)device + inerter_parameter(parameter)->offset);
  double lower = isnan(value) ? 1 : value - 0.5 * fabs(value), upper = value + fabs(value) + 1e-3;
  const char* keys[] = {"control_lower", "control_upper", "control_lag"};
  double values[] = {lower, upper, below(&source, 8) ? 1e-3 + fabs(moderate()) : 0};
  for (int i = 0; i < 3; i++) {
    snprintf(text, sizeof(text), "%.17g", tame ? values[i] : any(&source));
    inerter_set(device, keys[i], text, message);
  }
}

// a device with random keys; returns 0 where the core refused it, always with a
// message
static int random_device(InerterDevice* device, int tame) {
  char message[INERTER_MESSAGE_SIZE];
  char text[64];
  inerter_default(device);
  // the law with the most states more often
  int law = below(&source, 2) ? below(&source, INERTER_NFRICTION) : INERTER_FRICTION_maxwell_slip;
  if (inerter_set(device, "friction", inerter_friction_name(law), message)) {
    abort();
  }
  unsigned parts = (unsigned)below(&source, 32);
  if (!(parts & 1)) {
    parts &= ~2u;
  }
  // as many as there can be of either, or fewer
  int slips = below(&source, 2) ? INERTER_MAXSLIP : 1 + below(&source, INERTER_MAXSLIP);
  int branches =
      below(&source, 2) ? below(&source, 2) * INERTER_MAXBRANCH : below(&source, INERTER_MAXBRANCH);
  if (tame ? parts >> 3 & 1 : below(&source, 8) == 0) {
    if (inerter_set(device, "gas_law", inerter_gas_law_name(below(&source, INERTER_NGAS)),
                    message)) {
      abort();
    }
  }
  if (below(&source, 3) == 0 &&
      inerter_set(device, "friction_side",
                  inerter_friction_side_name(below(&source, INERTER_NSIDE)), message)) {
    abort();
  }
  for (int i = 0; i < INERTER_NPARAMETER; i++) {
    const InerterParameter* p = inerter_parameter(i);
    int read = !*p->laws || strstr(p->laws, inerter_friction_name(law));
    int numbered = !strncmp(p->name, "slip_", 5) || !strncmp(p->name, "branch_", 7);
    if (tame ? !read || left_out(p->name, parts, slips, branches) ||
                   (!numbered && below(&source, 16) == 0)
             : below(&source, 6)) {
      continue;
    }
    double value = tame ? fabs(moderate()) : any(&source);
    if (tame && numbered) value += 1e-3;
    if (tame && !strcmp(p->name, "stop_lower")) value = -value;
    if (tame && !strcmp(p->name, "coil_diameter")) value += 1e3;
    if (tame && value < p->lower) value = p->lower;
    if (tame && value > p->upper) value = p->upper;
    snprintf(text, sizeof(text), "%.17g", value);
    memset(message, 0, sizeof(message));
    if (inerter_set(device, p->name, text, message) && !strstr(message, p->name)) {
      abort();
    }
  }
  if (below(&source, tame ? 4 : 2)) {
    random_control(device, tame, (int)(parts >> 4 & 1));
  }
  for (int i = 0; i < INERTER_NLIST; i++) {
    const InerterList* list = inerter_list(i);
    if (below(&source, tame ? 3 : 6) || (law == INERTER_FRICTION_none && *list->laws) ||
        (tame && i / 2 == INERTER_STROKE_friction_back && device->friction_asymmetry != 0)) {
      continue;
    }
    double values[INERTER_MAXCURVE];
    int count =
        list->periods ? 3 * (1 + below(&source, INERTER_MAXPERIOD)) : 2 + below(&source, 63);
    for (int k = 0; k < count; k++) {
      values[k] = tame ? fmod(moderate(), 0.05) : any(&source);
      if (tame && i / 2 == INERTER_STROKE_viscous) values[k] = list->periods ? 0 : 0.01;
      if (tame && list->periods && k % 3 == 0) values[k] = 1e-3 + fabs(values[k]);
    }
    if (tame && i == INERTER_LIST_force_map) {
      // three rows of four
      const char* const keys[] = {"force_map_lower", "force_map_upper", "force_map_speed",
                                  "force_map_columns"};
      const char* const texts[] = {"-0.5", "0.75", "2", "4"};
      count = 12;
      for (int k = 0; k < 12; k++) values[k] = fmod(moderate(), 50);
      for (int k = 0; k < 4; k++) {
        if (inerter_set(device, keys[k], texts[k], message)) abort();
      }
    } else if (tame && !list->periods) {
      // every curve has its range
      if (inerter_set(device, "curve_lower", "-0.5", message) ||
          inerter_set(device, "curve_upper", "0.75", message)) {
        abort();
      }
    }
    memset(message, 0, sizeof(message));
    if (inerter_set_list(device, i, count, values, message) && !strstr(message, list->name)) {
      abort();
    }
  }
  const InerterCurve* along = device->curve + INERTER_STROKE_viscous;
  int set = device->control == INERTER_CONTROL_viscous ||
            device->control == INERTER_CONTROL_quadratic_damping;
  if (tame && device->viscous > 0 && device->damping_exponent >= 0 && !set && !along->nvalue &&
      !along->nperiod && below(&source, 2)) {
    snprintf(text, sizeof(text), "%.17g", 1e-3 + fabs(moderate()));
    if (inerter_set(device, "damper_stiffness", text, message)) abort();
  }
  if (tame && (device->inertance > 0 || device->channel_area > 0) && device->backlash == 0 &&
      below(&source, 2)) {
    const char* const keys[] = {"leak_damping", "leak_quadratic_damping", "clutch_force"};
    for (int i = 0; i < 2 + (device->series_stiffness > 0); i++) {
      snprintf(text, sizeof(text), "%.17g", 1e-3 + fabs(moderate()));
      if (inerter_set(device, keys[i], text, message)) abort();
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
  const char* keys[] = {"inertance", "friction", "gas_law", "", "inertanc", "%s%n", "stop_lower"};
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
  enum { N = 64, DEVICES = 3, WIDE = INERTER_MAXSTATE };
  long calls = 0, by_states[WIDE + 1] = {0};
  static double x[N], v[N], a[N], z[WIDE * N], rates[WIDE * N], result[6 * N], many[DEVICES * N];
  awkward_texts();

  // past either end of the lists
  for (int i = -2; i < 100; i++) {
    int known = i >= 0 && i < INERTER_NFRICTION;
    if (known != (inerter_friction_name(i) != NULL)) abort();
    if (known != (inerter_friction_meaning(i) != NULL)) abort();
    if (known != (inerter_friction_nstate(i) >= 0)) abort();
    if ((i >= 0 && i < INERTER_NPARAMETER) != (inerter_parameter(i) != NULL)) abort();
    if ((i >= 0 && i < INERTER_NGAS) != (inerter_gas_law_name(i) != NULL)) abort();
    if ((i >= 0 && i < INERTER_NGAS) != (inerter_gas_law_meaning(i) != NULL)) abort();
    if ((i >= 0 && i < INERTER_NCONTROL) != (inerter_control_name(i) != NULL)) abort();
    if ((i >= 0 && i < INERTER_NCONTROL) != (inerter_control_meaning(i) != NULL)) abort();
    if ((i >= 0 && i < INERTER_NSIDE) != (inerter_friction_side_name(i) != NULL)) abort();
    if ((i >= 0 && i < INERTER_NSIDE) != (inerter_friction_side_meaning(i) != NULL)) abort();
  }

  // devices with many states are seldom: after the first rounds only such as
  // are still missing, until none is
  for (int round = 0, missing = 1; round < 20000 || (missing && round < 400000); round++) {
    InerterDevice device;
    int tame = below(&source, 2);
    if (!random_device(&device, tame) ||
        (round > 20000 && by_states[inerter_nstate(&device)] >= 100)) {
      continue;
    }
    for (int i = 0; i < N; i++) {
      x[i] = tame ? moderate() : any(&source);
      v[i] = tame ? moderate() : any(&source);
      a[i] = tame ? moderate() : any(&source);
    }
    for (int i = 0; i < WIDE * N; i++) {
      z[i] = tame ? 1e-6 * moderate() : any(&source);
    }
    double h = tame ? pow(10, 18 * uniform(&source) - 9) : any(&source);
    int nstate = inerter_nstate(&device);
    calls++;
    by_states[nstate]++;
    missing = 0;
    for (int i = 0; i <= WIDE; i++) missing |= by_states[i] < 100;
    for (int i = -1; i <= WIDE; i++) {
      if ((i >= 0 && i < nstate) != (inerter_state_name(&device, i) != NULL)) abort();
    }

    // one by one; exactly as many states as there are, so that a look beyond
    // them is reported
    double* own = malloc(sizeof(double) * (size_t)(nstate + 1));
    double* end = malloc(sizeof(double) * (size_t)(nstate + 1));
    if (!own || !end) abort();
    double* states = own + 1;
    memcpy(states, z, sizeof(double) * (size_t)nstate);
    inerter_state_step(&device, x[0], v[0], a[0], states, h);
    inerter_state_of_force(&device, x[1], v[1], a[1], tame ? moderate() : any(&source), end + 1);
    for (int i = 0; tame && i < nstate; i++) {
      int bounded = device.friction != INERTER_FRICTION_bouc_wen || i > 0;
      if (bounded && h < 1 && (!isfinite(states[i]) || !isfinite(end[i + 1]))) {
        fprintf(stderr, "round %d: state %d: step %g, of force %g\n", round, i, states[i],
                end[i + 1]);
        return 1;
      }
    }
    memcpy(states, z, sizeof(double) * (size_t)nstate);
    inerter_force_over_step(&device, x[2], v[2], a[2], states, fabs(h), fabs(any(&source)),
                            end + 1);
    inerter_force_over_step(&device, x[2], v[2], a[2], states, fabs(h), 0, NULL);
    if (tame && h < 1 && h > 1e-7) {
      // never falls beyond the friction law's own fall; see the Python tests
      // for the laws
      InerterForce low = inerter_force_over_step(&device, x[2], v[2], -1e9, states, h, 1, NULL);
      InerterForce high = inerter_force_over_step(&device, x[2], v[2], 1e9, states, h, 1, NULL);
      if (!(high.inertance >= low.inertance)) {
        fprintf(stderr, "round %d: %g falls to %g\n", round, low.inertance, high.inertance);
        return 4;
      }
    }
    char message[INERTER_MESSAGE_SIZE] = "";
    if (!inerter_valid(&device, x[3], states, message) && strlen(message) < 20) abort();
    double rest;
    if (!(inerter_inertance(&device, x[4], v[4], &rest) >= 0) && tame) abort();
    inerter_inertance(&device, x[4], v[4], NULL);
    inerter_evaluate(&device, N, x, v, a, z, result, rates);

    // at commands; whatever they are, the value stays within its bounds
    inerter_evaluate_commanded(&device, N, x, v, a, tame ? a : v, z, result, rates);
    inerter_along_commanded(&device, N, fabs(h), x, v, a, v, states, result, result + N, rates);
    int controlled = inerter_controlled(&device);
    if (controlled >= 0) {
      InerterDevice present = device;
      inerter_command(&present, any(&source), below(&source, 2) ? states : NULL);
      double value =
          *(const double*)((const char*)&present + inerter_parameter(controlled)->offset);
      if (!(value >= device.control_lower && value <= device.control_upper)) return 6;
    }
    memcpy(states, z, sizeof(double) * (size_t)nstate);

    // along a motion; n = 0 and missing outputs are allowed
    inerter_along(&device, N, fabs(h), x, v, a, states, result, result + N, rates);
    inerter_along(&device, N, fabs(h), x, v, a, NULL, NULL, NULL, NULL);
    inerter_along(&device, 0, fabs(h), NULL, NULL, NULL, states, NULL, NULL, NULL);
    free(own);
    free(end);
    InerterDevice devices[DEVICES] = {device, device, device};
    inerter_along_many(devices, DEVICES, N, fabs(h), x, v, a, many);
    if (memcmp(many, many + N, sizeof(double) * N) != 0) {
      return 2;
    }
  }
  for (int i = 0; i <= WIDE; i++) {
    if (by_states[i] < 100) {
      fprintf(stderr, "%ld devices with %d states\n", by_states[i], i);
      return 5;
    }
  }
  printf("%ld devices\n", calls);
  return calls > 1000 ? 0 : 3;
}
