// Units in the messages of a device on a hinge: see units.h.

#include "mujoco/units.h"

#include <ctype.h>
#include <string.h>

// units along a line, those about an axis
static const char* const kUnits[][2] = {
    {"kg", "kg*m^2"},   {"N*s/m", "N*m*s/rad"}, {"N*s^2/m^2", "N*m*s^2/rad^2"},
    {"N/m", "N*m/rad"}, {"N/m^3", "N*m/rad^3"}, {"N", "N*m"},
    {"m", "rad"},       {"m/s", "rad/s"},       {"m/s^2", "rad/s^2"},
    {"1/m", "1/rad"},   {"1/m^2", "1/rad^2"},   {"s/m", "s/rad"},
    {"m^-n", "rad^-n"},
};

// whether all that the actuator moves are hinges
static int turns(const mjModel* m, int actuator) {
  int target = m->actuator_trnid[2 * actuator];
  if (m->actuator_trntype[actuator] == mjTRN_JOINT ||
      m->actuator_trntype[actuator] == mjTRN_JOINTINPARENT) {
    return m->jnt_type[target] == mjJNT_HINGE;
  }
  if (m->actuator_trntype[actuator] != mjTRN_TENDON) {
    return 0;
  }
  int first = m->tendon_adr[target], hinges = 1;
  for (int k = first; k < first + m->tendon_num[target]; k++) {
    hinges &= m->wrap_type[k] == mjWRAP_JOINT && m->jnt_type[m->wrap_objid[k]] == mjJNT_HINGE;
  }
  return hinges;
}

static int in_unit(char c) {
  return isalnum((unsigned char)c) || (c && strchr("*/^-_.", c));
}

// the unit about an axis for a word that is one along a line, else NULL
static const char* about_axis(const char* word, size_t length) {
  for (size_t i = 0; i < sizeof(kUnits) / sizeof(*kUnits); i++) {
    if (strlen(kUnits[i][0]) == length && !strncmp(word, kUnits[i][0], length)) {
      return kUnits[i][1];
    }
  }
  return NULL;
}

void units_of_actuator(const mjModel* m, int actuator, const char* text,
                       char message[INERTER_MESSAGE_SIZE]) {
  int rotates = actuator >= 0 && turns(m, actuator), quoted = 0;
  size_t used = 0;
  while (*text && used + 1 < INERTER_MESSAGE_SIZE) {
    size_t length = 0;
    while (in_unit(text[length])) {
      length++;
    }

    // what stands in quotes is the user's own
    quoted ^= *text == '"';
    const char* unit = rotates && !quoted && length ? about_axis(text, length) : NULL;
    const char* word = unit ? unit : text;
    size_t size = unit ? strlen(unit) : length ? length : 1;
    size = mjMIN(size, INERTER_MESSAGE_SIZE - 1 - used);
    memcpy(message + used, word, size);
    used += size;
    text += length ? length : 1;
  }
  message[used] = 0;
}
