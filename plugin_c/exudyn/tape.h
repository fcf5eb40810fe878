// A tape: expressions written down in Python, evaluated here with their derivatives.
//
// Values lie in one array: inputs, then constants, then one value per operation, in order. A tape
// holds no law and no geometry; the Python package records both on it, each once.

#ifndef INERTER_EXUDYN_TAPE_H_
#define INERTER_EXUDYN_TAPE_H_

#include <stddef.h>
#include <stdint.h>

// operations: their name in Python, and the value of (a, b, c)
#define INERTER_OPERATIONS(X)                    \
  X(add, a + b)                                  \
  X(subtract, a - b)                             \
  X(multiply, a* b)                              \
  X(divide, a / b)                               \
  X(negate, -a)                                  \
  X(abs, fabs(a))                                \
  X(sign, (double)(a > 0.0) - (double)(a < 0.0)) \
  X(sqrt, sqrt(a))                               \
  X(sin, sin(a))                                 \
  X(cos, cos(a))                                 \
  X(exp, exp(a))                                 \
  X(log, log(a))                                 \
  X(log1p, log1p(a))                             \
  X(expm1, expm1(a))                             \
  X(tanh, tanh(a))                               \
  X(power, pow(a, b))                            \
  X(arctan2, atan2(a, b))                        \
  X(round, nearbyint(a))                         \
  X(least, b < a ? b : a)                        \
  X(greatest, b > a ? b : a)                     \
  X(less, (double)(a < b))                       \
  X(not_above, (double)(a <= b))                 \
  X(choose, a != 0.0 ? b : c)

typedef enum InerterOperation_ {
#define X(name, value) INERTER_OPERATION_##name,
  INERTER_OPERATIONS(X)
#undef X
      INERTER_NOPERATION
} InerterOperation;

// one operation and the places of what it works on
typedef struct InerterTapeStep_ {
  int32_t operation, a, b, c;
} InerterTapeStep;

// the inputs first <= k < end that a step depends on; none where no slope is wanted
typedef struct InerterTapeSpan_ {
  int32_t first, end;
} InerterTapeSpan;

typedef struct InerterTape_ {
  int32_t ninput, nconstant, nstep;
  const InerterTapeStep* steps;  // nstep; quick where the same operations stand together
  const InerterTapeSpan* spans;  // nstep
  double* values;                // ninput + nconstant + nstep; constants are in place
  double* slopes;  // the same number of rows of `ninput` derivatives, inputs' in place, 0 elsewhere
} InerterTape;

// evaluate every step at the inputs that are in place
void inerter_tape_run(const InerterTape* tape);

// the derivatives of the steps by the inputs, after inerter_tape_run; corners count as flat
void inerter_tape_slopes(const InerterTape* tape);

#endif  // INERTER_EXUDYN_TAPE_H_
