// What reading a configuration and checking it share.

#ifndef INERTER_CORE_CONFIGURATION_H_
#define INERTER_CORE_CONFIGURATION_H_

#include "device.h"

// parameter i of a device
double* value_of(InerterDevice* device, int i);

// the allowed range in words, such as "a finite number > 0 m/s"
const char* range_text(const InerterParameter* p, char text[128]);

// whether a value is in that range
int allowed(const InerterParameter* p, double value);

// write a message; -1
int refuse(char* message, const char* format, ...);

// series_check.c: whether a series element's parameters fit together; -1 with a message if not
int series_check(const InerterDevice* device, char* message);

#endif  // INERTER_CORE_CONFIGURATION_H_
