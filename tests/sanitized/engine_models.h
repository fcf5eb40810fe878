// Random models with many devices: every law, native and between branches, with
// contacts, a free body, a wrapped tendon, a live parameter, sensors and a
// keyframe.

#ifndef TESTS_SANITIZED_ENGINE_MODELS_H_
#define TESTS_SANITIZED_ENGINE_MODELS_H_

#include "random.h"

enum { LAWS = 7, VARIANTS = 10, INTEGRATORS = 5 };

// MJCF text to be freed: devices of consecutive laws and variants, from number
// `first` on.
char* engine_model(Random* random, int devices, int first, const char* integrator);

extern const char* const kIntegrators[INTEGRATORS];

#endif  // TESTS_SANITIZED_ENGINE_MODELS_H_
