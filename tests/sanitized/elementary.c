// The functions of elementary.h over arrays, as the core's loops take them.

#include "core/elementary.h"

void over_array(int which, int n, const double *x, double *y) {
  if (which == 0) {
    for (int i = 0; i < n; i++)
      y[i] = elementary_exp(x[i]);
  } else if (which == 1) {
    for (int i = 0; i < n; i++)
      y[i] = elementary_expm1(x[i]);
  } else {
    for (int i = 0; i < n; i++)
      y[i] = elementary_tanh(x[i]);
  }
}
