#include "exudyn/tape.h"

#include <math.h>

void inerter_tape_run(const InerterTape* tape) {
  double* values = tape->values;
  double* value = values + tape->ninput + tape->nconstant;
  const InerterTapeStep* step = tape->steps;
  const InerterTapeStep* end = step + tape->nstep;
  while (step < end) {
    const int32_t operation = step->operation;
    // a row of the same operation in one loop, which a processor foresees
    switch ((InerterOperation)operation) {
#define X(name, expression)                                                 \
  case INERTER_OPERATION_##name:                                            \
    do {                                                                    \
      double a = values[step->a], b = values[step->b], c = values[step->c]; \
      *value++ = (expression);                                              \
      (void)b, (void)c;                                                     \
      step++;                                                               \
    } while (step < end && step->operation == operation);                   \
    break;
      INERTER_OPERATIONS(X)
#undef X
      case INERTER_NOPERATION:
        return;
    }
  }
}

// partial derivatives of a step by a and b; `choose` is no matter of these
static void partials(InerterOperation operation, double a, double b, double y, double p[2]) {
  p[0] = p[1] = 0.0;
  switch (operation) {
    case INERTER_OPERATION_add:
      p[0] = p[1] = 1.0;
      break;
    case INERTER_OPERATION_subtract:
      p[0] = 1.0, p[1] = -1.0;
      break;
    case INERTER_OPERATION_multiply:
      p[0] = b, p[1] = a;
      break;
    case INERTER_OPERATION_divide:
      p[0] = 1.0 / b, p[1] = -y / b;
      break;
    case INERTER_OPERATION_negate:
      p[0] = -1.0;
      break;
    case INERTER_OPERATION_abs:
      p[0] = (double)(a > 0.0) - (double)(a < 0.0);
      break;
    case INERTER_OPERATION_sqrt:
      p[0] = y > 0.0 ? 0.5 / y : 0.0;
      break;
    case INERTER_OPERATION_sin:
      p[0] = cos(a);
      break;
    case INERTER_OPERATION_cos:
      p[0] = -sin(a);
      break;
    case INERTER_OPERATION_exp:
      p[0] = y;
      break;
    case INERTER_OPERATION_log:
      p[0] = 1.0 / a;
      break;
    case INERTER_OPERATION_log1p:
      p[0] = 1.0 / (1.0 + a);
      break;
    case INERTER_OPERATION_expm1:
      p[0] = y + 1.0;
      break;
    case INERTER_OPERATION_tanh:
      p[0] = 1.0 - y * y;
      break;
    case INERTER_OPERATION_power:
      p[0] = b == 0.0 ? 0.0 : b * pow(a, b - 1.0);
      p[1] = a > 0.0 ? y * log(a) : 0.0;
      break;
    case INERTER_OPERATION_arctan2: {
      double square = a * a + b * b;
      p[0] = square > 0.0 ? b / square : 0.0;
      p[1] = square > 0.0 ? -a / square : 0.0;
      break;
    }
    case INERTER_OPERATION_least:
      p[b < a] = 1.0;
      break;
    case INERTER_OPERATION_greatest:
      p[b > a] = 1.0;
      break;
    default:  // steps and comparisons are flat
      break;
  }
}

// slope[k] = p[0] by_a[k] + p[1] by_b[k] over a span; nothing times an infinite slope is nothing
static void chain(const double p[2], const double* by_a, const double* by_b, InerterTapeSpan span,
                  double* restrict slope) {
  const double pa = p[0], pb = p[1];
  if (!isfinite(pa) || !isfinite(pb)) {
    for (int32_t k = span.first; k < span.end; k++) {
      slope[k] = (by_a[k] != 0.0 ? pa * by_a[k] : 0.0) + (by_b[k] != 0.0 ? pb * by_b[k] : 0.0);
    }
  } else if (pa == 0.0 && pb == 0.0) {
    for (int32_t k = span.first; k < span.end; k++) slope[k] = 0.0;
  } else if (pb == 0.0) {
    for (int32_t k = span.first; k < span.end; k++) slope[k] = pa * by_a[k];
  } else if (pa == 0.0) {
    for (int32_t k = span.first; k < span.end; k++) slope[k] = pb * by_b[k];
  } else {
    for (int32_t k = span.first; k < span.end; k++) slope[k] = pa * by_a[k] + pb * by_b[k];
  }
}

void inerter_tape_slopes(const InerterTape* tape) {
  const size_t n = (size_t)tape->ninput;
  const double* values = tape->values;
  const int32_t first = tape->ninput + tape->nconstant;
  for (int32_t i = 0; i < tape->nstep; i++) {
    const InerterTapeStep* step = tape->steps + i;
    const InerterTapeSpan span = tape->spans[i];
    if (span.first >= span.end) {
      continue;
    }
    double p[2] = {1.0, 0.0};
    int32_t a = step->a;
    if (step->operation == INERTER_OPERATION_choose) {
      a = values[step->a] != 0.0 ? step->b : step->c;
    } else {
      partials((InerterOperation)step->operation, values[step->a], values[step->b],
               values[first + i], p);
    }
    chain(p, tape->slopes + n * (size_t)a, tape->slopes + n * (size_t)step->b, span,
          tape->slopes + n * (size_t)(first + i));
  }
}
