// The functions of elementary.h over arrays, as the core's loops take them.

#include "core/elementary.h"

void over_array(int which, int n, const double* x, double* y) {
  switch (which) {
    case 0:
      for (int i = 0; i < n; i++) y[i] = elementary_exp(x[i]);
      break;
    case 1:
      for (int i = 0; i < n; i++) y[i] = elementary_expm1(x[i]);
      break;
    case 2:
      for (int i = 0; i < n; i++) y[i] = elementary_tanh(x[i]);
      break;
    default:
      for (int i = 0; i < n; i++) {
        double cosine, sine = elementary_sin_cos(x[i], &cosine);
        y[i] = which == 3 ? sine : cosine;
      }
  }
}
