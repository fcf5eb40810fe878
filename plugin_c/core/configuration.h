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

#endif  // INERTER_CORE_CONFIGURATION_H_
