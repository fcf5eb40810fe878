// A device from its parts: see device.h for the equation.

#include "device.h"

#include <ctype.h>
#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "friction.h"

enum { CLOSED = 0, OPEN = 1 };

static const InerterParameter kParameters[] = {
#define X(name, unit, initial, lower, upper, bound, laws, meaning) \
  {#name, unit, initial, lower, upper, bound, offsetof(InerterDevice, name), laws, meaning},
    INERTER_PARAMETERS(X)
#undef X
};

static const struct {
  const char* name;
  int nstate;
  const char* meaning;
  const FrictionLaw* law;
} kFriction[] = {
#define inerter_none inerter_coulomb  // never called: "none" is tested first
#define X(identifier, nstate, meaning) {#identifier, nstate, meaning, &inerter_##identifier},
    INERTER_FRICTION_LAWS(X)
#undef X
#undef inerter_none
};

//------------------------------ description -------------------------------------------------------

const InerterParameter* inerter_parameter(int i) {
  return i >= 0 && i < INERTER_NPARAMETER ? &kParameters[i] : NULL;
}

const char* inerter_friction_name(int i) {
  return i >= 0 && i < INERTER_NFRICTION ? kFriction[i].name : NULL;
}

const char* inerter_friction_meaning(int i) {
  return i >= 0 && i < INERTER_NFRICTION ? kFriction[i].meaning : NULL;
}

int inerter_friction_nstate(int i) {
  return i >= 0 && i < INERTER_NFRICTION ? kFriction[i].nstate : -1;
}

//------------------------------ configuration -----------------------------------------------------

void inerter_default(InerterDevice* device) {
  memset(device, 0, sizeof(*device));
#define X(name, unit, initial, ...) device->name = (initial);
  INERTER_PARAMETERS(X)
#undef X
}

static double* value_of(InerterDevice* device, int i) {
  return (double*)((char*)device + kParameters[i].offset);
}

// the allowed range in words, such as "a finite value > 0 m/s"
static const char* range_text(const InerterParameter* p, char text[128]) {
  const char* unit = strcmp(p->unit, "1") ? p->unit : "";
  if (isinf(p->lower) && isinf(p->upper)) {
    snprintf(text, 128, "any finite number%s%s", *unit ? " in " : "", unit);
  } else if (isinf(p->upper)) {
    snprintf(text, 128, "a finite number %s %g%s%s", p->lower_open ? ">" : ">=", p->lower,
             *unit ? " " : "", unit);
  } else {
    snprintf(text, 128, "a number %s %g and <= %g%s%s", p->lower_open ? ">" : ">=", p->lower,
             p->upper, *unit ? " " : "", unit);
  }
  return text;
}

static int allowed(const InerterParameter* p, double value) {
  return isfinite(value) && value <= p->upper &&
         (p->lower_open ? value > p->lower : value >= p->lower);
}

// strtod that wants a decimal point whatever the program's locale
static double number(const char* text, const char** end) {
  const char* point = localeconv()->decimal_point;
  size_t before = strcspn(text, "."), width = strlen(point);
  char local[128];
  char* stop;
  *end = text;
  if (!strcmp(point, ".")) {
    double value = strtod(text, &stop);
    *end = stop;
    return value;
  }
  if (strstr(text, point) || strlen(text) + width >= sizeof(local)) {
    return 0;
  }

  // the locale's point in place of ours
  memcpy(local, text, before);
  if (text[before]) {
    memcpy(local + before, point, width);
    strcpy(local + before + width, text + before + 1);
  } else {
    local[before] = 0;
  }
  double value = strtod(local, &stop);
  size_t length = (size_t)(stop - local);
  *end = text + (length > before ? length - width + 1 : length);
  return value;
}

// set the friction law by name
static int set_friction(InerterDevice* device, const char* text, char* message) {
  for (int i = 0; i < INERTER_NFRICTION; i++) {
    if (!strcmp(text, kFriction[i].name)) {
      device->friction = i;
      return 0;
    }
  }
  int length = snprintf(message, INERTER_MESSAGE_SIZE,
                        "friction is \"%.60s\": no such law; choose one of", text);
  for (int i = 0; i < INERTER_NFRICTION && length < INERTER_MESSAGE_SIZE; i++) {
    length += snprintf(message + length, INERTER_MESSAGE_SIZE - length, " %s", kFriction[i].name);
  }
  return -1;
}

int inerter_set(InerterDevice* device, const char* key, const char* text,
                char message[INERTER_MESSAGE_SIZE]) {
  char range[128];
  if (!strcmp(key, "friction")) {
    return set_friction(device, text, message);
  }
  for (int i = 0; i < INERTER_NPARAMETER; i++) {
    const InerterParameter* p = &kParameters[i];
    if (strcmp(key, p->name)) {
      continue;
    }
    const char* end;
    double value = number(text, &end);
    int empty = end == text;
    while (isspace((unsigned char)*end)) {
      end++;
    }
    if (empty || *end) {
      snprintf(message, INERTER_MESSAGE_SIZE, "%s is \"%.60s\": not a number; give %s (%s)", key,
               text, range_text(p, range), p->meaning);
      return -1;
    }
    if (!allowed(p, value)) {
      snprintf(message, INERTER_MESSAGE_SIZE, "%s is \"%.60s\": out of range; give %s (%s)", key,
               text, range_text(p, range), p->meaning);
      return -1;
    }
    *value_of(device, i) = value;
    device->given |= UINT64_C(1) << i;
    return 0;
  }
  snprintf(message, INERTER_MESSAGE_SIZE, "\"%.60s\" is not a parameter of the device", key);
  return -1;
}

// whether a word stands in a list separated by blanks
static int listed(const char* list, const char* word) {
  size_t length = strlen(word);
  for (const char* at = list; (at = strstr(at, word)); at += length) {
    if ((at == list || at[-1] == ' ') && (at[length] == ' ' || !at[length])) {
      return 1;
    }
  }
  return 0;
}

static int is_given(const InerterDevice* device, int i) {
  return (int)(device->given >> i & 1);
}

int inerter_finish(InerterDevice* device, char message[INERTER_MESSAGE_SIZE]) {
  char range[128];
  if (device->friction < 0 || device->friction >= INERTER_NFRICTION) {
    snprintf(message, INERTER_MESSAGE_SIZE, "friction is %d: no such law", device->friction);
    return -1;
  }
  const char* law = kFriction[device->friction].name;

  // a parameter of another law is a mistake, not a wish to ignore
  for (int i = 0; i < INERTER_NPARAMETER; i++) {
    const InerterParameter* p = &kParameters[i];
    if (*p->laws && is_given(device, i) && !listed(p->laws, law)) {
      snprintf(message, INERTER_MESSAGE_SIZE,
               "%s is given, but friction is \"%s\", which does not read it; remove it or choose "
               "friction from: %s",
               p->name, law, p->laws);
      return -1;
    }
  }

  // derive what was not set
  if (isnan(device->static_force)) {
    device->static_force = device->coulomb_force;
  }

  // each value on its own
  for (int i = 0; i < INERTER_NPARAMETER; i++) {
    double value = *value_of(device, i);
    if (!allowed(&kParameters[i], value)) {
      snprintf(message, INERTER_MESSAGE_SIZE, "%s is %g: out of range; give %s (%s)",
               kParameters[i].name, value, range_text(&kParameters[i], range),
               kParameters[i].meaning);
      return -1;
    }
  }

  // values together
  if (device->static_force < device->coulomb_force) {
    snprintf(message, INERTER_MESSAGE_SIZE,
             "static_force is %g N, below coulomb_force %g N; give static_force >= coulomb_force",
             device->static_force, device->coulomb_force);
    return -1;
  }
  const int sliding[] = {INERTER_FRICTION_coulomb, INERTER_FRICTION_stribeck, INERTER_FRICTION_dahl,
                         INERTER_FRICTION_lugre, INERTER_FRICTION_brown_mcphee};
  for (size_t i = 0; i < sizeof(sliding) / sizeof(*sliding); i++) {
    int bristle =
        device->friction == INERTER_FRICTION_dahl || device->friction == INERTER_FRICTION_lugre;
    double level = bristle ? device->coulomb_force : device->static_force;
    if (device->friction == sliding[i] && level <= 0) {
      snprintf(message, INERTER_MESSAGE_SIZE,
               "coulomb_force is 0 N, but friction is \"%s\"; give coulomb_force > 0 N or "
               "friction \"none\"",
               law);
      return -1;
    }
  }
  if (device->friction == INERTER_FRICTION_bouc_wen && device->bw_stiffness <= 0) {
    snprintf(message, INERTER_MESSAGE_SIZE,
             "bw_stiffness is 0 N/m, but friction is \"bouc_wen\"; give bw_stiffness > 0 N/m or "
             "friction \"none\"");
    return -1;
  }
  return 0;
}

//------------------------------ states ------------------------------------------------------------

// displacement that the laws see
static double stretch_of(const InerterDevice* device, double length) {
  return length - device->rest_length;
}

static const FrictionLaw* law_of(const InerterDevice* device) {
  return kFriction[device->friction].law;
}

int inerter_nstate(const InerterDevice* device) {
  return kFriction[device->friction].nstate;
}

double inerter_state_rate(const InerterDevice* device, double x, double v, double z) {
  return inerter_nstate(device) ? law_of(device)->rate(device, stretch_of(device, x), v, z) : 0;
}

double inerter_state_step(const InerterDevice* device, double x, double v, double z, double h) {
  return inerter_nstate(device) ? law_of(device)->step(device, stretch_of(device, x), v, z, h) : 0;
}

double inerter_state_of_force(const InerterDevice* device, double x, double v, double a,
                              double force) {
  if (!inerter_nstate(device)) {
    return 0;
  }

  // every law is linear in its state
  double at_zero = inerter_force(device, x, v, a, 0).total;
  double at_one = inerter_force(device, x, v, a, 1).total;
  double z = (force - at_zero) / (at_one - at_zero);
  if (at_one == at_zero || isnan(z)) {
    return 0;
  }

  // a state cannot be beyond where an endless slide in its direction leads, slow or fast: slow has
  // the Stribeck peak, fast the full asymmetry
  double speed = (z < 0 ? -10 : 10) * device->transition_velocity;
  double slow = law_of(device)->step(device, x, copysign(1e-200, z), 0, 1e215);
  double fast = law_of(device)->step(device, x, speed, 0, 1e15 / fabs(speed));
  double limit = fmax(fabs(slow), fabs(fast));
  return isfinite(limit) ? copysign(fmin(fabs(z), limit), z) : z;
}

//------------------------------ forces and energy -------------------------------------------------

double inerter_friction_force(const InerterDevice* device, double x, double v, double z) {
  if (device->friction == INERTER_FRICTION_none) {
    return 0;
  }
  return law_of(device)->force(device, stretch_of(device, x), v, z);
}

double inerter_force_motion(const InerterDevice* device, double x, double v, double z) {
  double stretch = stretch_of(device, x);
  double spring = (device->stiffness + device->stiffness_cubic * stretch * stretch) * stretch;
  double damper = (device->viscous + device->quadratic_damping * fabs(v)) * v;
  return spring + damper + device->force_offset + inerter_friction_force(device, x, v, z);
}

double inerter_inertance(const InerterDevice* device, double x, double* slope) {
  double linear = device->inertance_gradient, square = device->inertance_curvature;
  double stretch = stretch_of(device, x);
  double factor = 1 + (linear + square * stretch) * stretch;
  int floored = factor < 0.01;
  if (slope) {
    *slope = floored ? 0 : device->inertance * (linear + 2 * square * stretch);
  }
  return device->inertance * (floored ? 0.01 : factor);
}

// b(x) a + b'(x) v^2 / 2
static double inertance_force(const InerterDevice* device, double x, double v, double a) {
  double slope;
  double inertance = inerter_inertance(device, x, &slope);
  return inertance * a + 0.5 * slope * v * v;
}

double inerter_load_factor(const InerterDevice* device, double v) {
  return device->load_friction ? device->load_friction * friction_direction(device, v) : 0;
}

InerterForce inerter_force(const InerterDevice* device, double x, double v, double a, double z) {
  InerterForce force;
  double load = inerter_load_factor(device, v);
  force.inertance = inertance_force(device, x, v, a);
  force.friction = inerter_friction_force(device, x, v, z) + load * fabs(force.inertance);
  force.total =
      force.inertance + inerter_force_motion(device, x, v, z) + load * fabs(force.inertance);
  return force;
}

double inerter_stored_energy(const InerterDevice* device, double x, double v, double z) {
  double stretch = stretch_of(device, x);
  double square = stretch * stretch;
  double energy = 0.5 * inerter_inertance(device, x, NULL) * v * v +
                  (0.5 * device->stiffness + 0.25 * device->stiffness_cubic * square) * square;
  if (inerter_nstate(device)) {
    energy += law_of(device)->energy(device, stretch, z);
  }
  return energy;
}

double inerter_dissipated_power(const InerterDevice* device, double x, double v, double a,
                                double z) {
  double damper = (device->viscous + device->quadratic_damping * fabs(v)) * v;
  double load = inerter_load_factor(device, v) * fabs(inertance_force(device, x, v, a));
  double power = (damper + load + inerter_friction_force(device, x, v, z)) * v;

  // what the law stores: dE/dt = dE/dx v + dE/dz z'; E is quadratic in x and z without cross term
  if (inerter_nstate(device)) {
    const FrictionLaw* law = law_of(device);
    double rate = law->rate(device, stretch_of(device, x), v, z);
    power -= 2 * law->energy(device, 0, 1) * z * rate;
    power -= 2 * law->energy(device, 1, 0) * stretch_of(device, x) * v;
  }
  return power;
}
