// A configuration of any bytes: lines `key value`. Each is taken, or refused
// with a message that names the key and leaves the device as it was; a device
// that is finished can be evaluated.

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/device.h"

#define REQUIRE(condition)                                                         \
  do {                                                                             \
    if (!(condition)) {                                                            \
      fprintf(stderr, "%s:%d: %s: %s\n", __FILE__, __LINE__, #condition, message); \
      abort();                                                                     \
    }                                                                              \
  } while (0)

// A key: its first byte, if it is no letter, chooses one that exists.
static const char* key_of(char* line) {
  unsigned choice = (unsigned char)*line;
  if (choice >= 0x80) {
    int i = (int)(choice - 0x80) % (INERTER_NPARAMETER + 3 + INERTER_NLIST);
    const InerterParameter* p = inerter_parameter(i);
    if (i >= INERTER_NPARAMETER + 3) {
      return inerter_list(i - INERTER_NPARAMETER - 3)->name;
    }
    const char* names[] = {"friction", "gas_law", "friction_side"};
    return p ? p->name : names[i - INERTER_NPARAMETER];
  }
  return line;
}

// the text of a value: its first byte, if it is no ASCII, chooses the name of a
// law
static const char* value_of_line(const char* text) {
  unsigned choice = (unsigned char)*text;
  if (choice < 0x80) {
    return text;
  }
  int i = (int)(choice - 0x80) % (INERTER_NFRICTION + INERTER_NGAS + INERTER_NSIDE);
  if (i < INERTER_NFRICTION) {
    return inerter_friction_name(i);
  }
  i -= INERTER_NFRICTION;
  return i < INERTER_NGAS ? inerter_gas_law_name(i) : inerter_friction_side_name(i - INERTER_NGAS);
}

// every value a finite number within its bounds, or unset
static void check_values(const InerterDevice* device, const char* message) {
  for (int i = 0; i < INERTER_NPARAMETER; i++) {
    const InerterParameter* p = inerter_parameter(i);
    double value = *(const double*)((const char*)device + p->offset);
    if (inerter_is_given(device, i)) {
      REQUIRE(isfinite(value) && value >= p->lower && value <= p->upper);
      REQUIRE(!p->lower_open || value > p->lower);
    }
  }
}

int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  char message[INERTER_MESSAGE_SIZE] = "";
  char* text = malloc(size + 1);
  if (!text) {
    abort();
  }
  memcpy(text, bytes, size);
  text[size] = 0;
  InerterDevice device;
  inerter_default(&device);
  char* rest = NULL;
  for (char* line = strtok_r(text, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest)) {
    char* split = strchr(line, ' ');
    if (!split) {
      split = line + strlen(line);
    } else {
      *split++ = 0;
    }
    InerterDevice before = device;
    const char* key = key_of(line);
    memset(message, 1, sizeof(message));
    if (inerter_set(&device, key, value_of_line(split), message)) {
      REQUIRE(memchr(message, 0, sizeof(message)) && strlen(message) > 20);
      REQUIRE(strlen(key) > 60 || strstr(message, key));
      REQUIRE(!memcmp(&before, &device, sizeof(device)));
    }
  }
  free(text);
  check_values(&device, message);
  memset(message, 1, sizeof(message));
  if (inerter_finish(&device, message)) {
    REQUIRE(memchr(message, 0, sizeof(message)) && strlen(message) > 20);
    return 0;
  }

  // a second time changes nothing but what the channel has given
  REQUIRE(inerter_nstate(&device) >= 0 && inerter_nstate(&device) <= INERTER_MAXSTATE);
  double z[INERTER_MAXSTATE] = {0};
  *message = 0;
  REQUIRE(inerter_valid(&device, device.rest_length, z, message));
  inerter_state_step(&device, device.rest_length, 0.1, 1.0, z, 1e-3);
  inerter_force(&device, device.rest_length, 0.1, 1, z);
  return 0;
}
