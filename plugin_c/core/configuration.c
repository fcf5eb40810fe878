// Reading a configuration: one key and its text at a time. check.c sees that all of it fits.

#include "configuration.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void inerter_default(InerterDevice* device) {
  memset(device, 0, sizeof(*device));
#define X(name, unit, initial, ...) device->name = (initial);
  INERTER_PARAMETERS(X)
#undef X
}

double* value_of(InerterDevice* device, int i) {
  return (double*)(void*)((char*)device + inerter_parameter(i)->offset);
}

const char* range_text(const InerterParameter* p, char text[128]) {
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

int allowed(const InerterParameter* p, double value) {
  return isfinite(value) && value <= p->upper &&
         (p->lower_open ? value > p->lower : value >= p->lower);
}

// strtod that wants a decimal point whatever the program's locale; localeconv would write into one
// place for all threads
static double number(const char* text, const char** end) {
  char half[16], local[128], point[16] = "";
  int written = snprintf(half, sizeof(half), "%.1f", 0.5);
  memcpy(point, half + 1, (size_t)(written - 2));
  size_t before = strcspn(text, "."), width = strlen(point);
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
    memcpy(local + before + width, text + before + 1, strlen(text + before));
  } else {
    local[before] = 0;
  }
  double value = strtod(local, &stop);
  size_t length = (size_t)(stop - local);
  *end = text + (length > before ? length - width + 1 : length);
  return value;
}

// set one of several laws by name
static int set_law(const char* key, const char* text, const char* (*name)(int), int* law,
                   char* message) {
  for (int i = 0; name(i); i++) {
    if (!strcmp(text, name(i))) {
      *law = i;
      return 0;
    }
  }
  const char* kind = !strcmp(key, "friction_side") ? "side" : !strcmp(key, "control") ? key : "law";
  int length = snprintf(message, INERTER_MESSAGE_SIZE, "%s is \"%.60s\": no such %s; choose one of",
                        key, text, kind);
  for (int i = 0; name(i) && length < INERTER_MESSAGE_SIZE; i++) {
    length += snprintf(message + length, INERTER_MESSAGE_SIZE - length, " %s", name(i));
  }
  return -1;
}

const double* inerter_list_values(const InerterDevice* device, int i, int* count) {
  if (i == INERTER_LIST_force_map) {
    *count = device->map.nvalue;
    return device->map.value;
  }
  const InerterCurve* curve = &device->curve[i / 2];
  *count = i % 2 ? 3 * curve->nperiod : curve->nvalue;
  return i % 2 ? curve->period : curve->value;
}

// what lists may hold, so that sums and angles stay numbers
static const double kLargest = 1e150, kShortest = 1e-9;

int inerter_set_list(InerterDevice* device, int i, int count, const double* values,
                     char message[INERTER_MESSAGE_SIZE]) {
  const InerterList* list = inerter_list(i);
  if (count > list->most || (list->periods ? count % 3 : count == 1)) {
    snprintf(message, INERTER_MESSAGE_SIZE, "%s has %d numbers; give %s", list->name, count,
             list->periods ? "three for each period (length [m] > 0, amplitude, phase [rad]), at "
                             "most 8 periods"
             : list->most == INERTER_MAXMAP ? "4 to 384, row by row"
                                            : "2 to 64");
    return -1;
  }
  for (int k = 0; k < count; k++) {
    int length = list->periods && k % 3 == 0;
    if (!(fabs(values[k]) <= kLargest) || (length && values[k] < kShortest)) {
      snprintf(message, INERTER_MESSAGE_SIZE,
               length ? "%s: number %d is %g, the length of a period in m; give one >= %g"
                      : "%s: number %d is %g; give a finite number of size <= %g",
               list->name, k + 1, values[k], length ? kShortest : kLargest);
      return -1;
    }
  }
  if (i == INERTER_LIST_force_map) {
    device->map.nvalue = count;
    memcpy(device->map.value, values, sizeof(double) * (size_t)count);
    return 0;
  }
  InerterCurve* curve = &device->curve[i / 2];
  *(list->periods ? &curve->nperiod : &curve->nvalue) = list->periods ? count / 3 : count;
  if (count) {
    memcpy(list->periods ? curve->period : curve->value, values, sizeof(double) * (size_t)count);
  }
  return 0;
}

// numbers separated by blanks
static int set_list(InerterDevice* device, int i, const char* text, char* message) {
  const InerterList* list = inerter_list(i);
  double values[INERTER_MAXMAP];
  int count = 0;
  for (const char* at = text;;) {
    while (isspace((unsigned char)*at)) {
      at++;
    }
    if (!*at) {
      break;
    }
    char word[64];
    size_t length = 0;
    while (at[length] && !isspace((unsigned char)at[length])) {
      length++;
    }
    const char* end = word;
    if (length < sizeof(word)) {
      memcpy(word, at, length);
      word[length] = 0;
    } else {
      word[0] = 0;
    }
    double value = number(word, &end);
    if (!*word || *end) {
      snprintf(message, INERTER_MESSAGE_SIZE,
               "%s: \"%.*s\" is not a number; give numbers separated by blanks (%s)", list->name,
               (int)(length < 60 ? length : 60), at, list->meaning);
      return -1;
    }
    if (count < INERTER_MAXMAP) {
      values[count] = value;
    }
    count++;
    at += length;
  }
  if (count == 0) {
    snprintf(message, INERTER_MESSAGE_SIZE, "%s is empty; give numbers separated by blanks (%s)",
             list->name, list->meaning);
    return -1;
  }
  return inerter_set_list(device, i, count, values, message);
}

int inerter_set_number(InerterDevice* device, int i, double value) {
  if (!allowed(inerter_parameter(i), value)) {
    return -1;
  }
  *value_of(device, i) = value;
  inerter_mark_given(device, i);
  return 0;
}

int inerter_set(InerterDevice* device, const char* key, const char* text,
                char message[INERTER_MESSAGE_SIZE]) {
  char range[128];
  if (!strcmp(key, "friction")) {
    return set_law(key, text, inerter_friction_name, &device->friction, message);
  }
  if (!strcmp(key, "gas_law")) {
    if (set_law(key, text, inerter_gas_law_name, &device->gas_law, message)) {
      return -1;
    }
    inerter_mark_given(device, INERTER_INDEX_gas_law);
    return 0;
  }
  if (!strcmp(key, "friction_side")) {
    if (set_law(key, text, inerter_friction_side_name, &device->friction_side, message)) {
      return -1;
    }
    inerter_mark_given(device, INERTER_INDEX_friction_side);
    return 0;
  }
  if (!strcmp(key, "control")) {
    if (set_law(key, text, inerter_control_name, &device->control, message)) {
      return -1;
    }
    inerter_mark_given(device, INERTER_INDEX_control);
    return 0;
  }
  for (int i = 0; i < INERTER_NLIST; i++) {
    if (!strcmp(key, inerter_list(i)->name)) {
      return set_list(device, i, text, message);
    }
  }
  for (int i = 0; i < INERTER_NPARAMETER; i++) {
    const InerterParameter* p = inerter_parameter(i);
    if (strcmp(key, p->name) != 0) {
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
    if (inerter_set_number(device, i, value)) {
      snprintf(message, INERTER_MESSAGE_SIZE, "%s is \"%.60s\": out of range; give %s (%s)", key,
               text, range_text(p, range), p->meaning);
      return -1;
    }
    return 0;
  }
  snprintf(message, INERTER_MESSAGE_SIZE, "\"%.60s\" is not a parameter of the device", key);
  return -1;
}
