// Forces and accelerations that fit each other: see monotone.h.
//
// Newton's method: laws that are linear in a take one round. Where a step does not shrink the
// residual (the corner of a friction law), one device after the other is solved for alone within a
// bracket; such sweeps always converge.

#include "mujoco/monotone.h"

#include <float.h>
#include <math.h>

enum { NEWTON_ROUNDS = 12, SWEEPS = 200, BISECTIONS = 120 };

// residual over the rounding of its terms that is not worth sweeps
static const double ENOUGH = 1e3;

// solve the n x n system A x = y by elimination with row exchange; A and y are destroyed
static void solve_dense(int n, mjtNum* A, mjtNum* y, mjtNum* x) {
  for (int c = 0; c < n; c++) {
    int pivot = c;
    for (int r = c + 1; r < n; r++) {
      pivot = fabs(A[r * n + c]) > fabs(A[pivot * n + c]) ? r : pivot;
    }
    for (int k = 0; pivot != c && k < n; k++) {
      mjtNum swapped = A[c * n + k];
      A[c * n + k] = A[pivot * n + k];
      A[pivot * n + k] = swapped;
    }
    mjtNum swapped = y[c];
    y[c] = y[pivot];
    y[pivot] = swapped;
    for (int r = c + 1; r < n; r++) {
      if (A[r * n + c] == 0) {
        continue;
      }
      mjtNum factor = A[r * n + c] / A[c * n + c];
      for (int k = c; k < n; k++) {
        A[r * n + k] -= factor * A[c * n + k];
      }
      y[r] -= factor * y[c];
    }
  }
  for (int r = n - 1; r >= 0; r--) {
    x[r] = y[r];
    for (int k = r + 1; k < n; k++) {
      x[r] -= A[r * n + k] * x[k];
    }
    x[r] /= A[r * n + r];
  }
}

// residual a + W F - p; returns its size relative to what rounding leaves, 1 or less is done
static double residual(int n, const mjtNum* W, const mjtNum* p, const mjtNum* a,
                       const mjtNum* force, mjtNum* r) {
  double worst = 0;
  for (int i = 0; i < n; i++) {
    double size = fabs(p[i]) + fabs(a[i]) + DBL_MIN;
    r[i] = a[i] - p[i];
    for (int j = 0; j < n; j++) {
      r[i] += W[i * n + j] * force[j];
      size += fabs(W[i * n + j] * force[j]);
    }
    worst = fmax(worst, fabs(r[i]) / (64 * DBL_EPSILON * size));
  }
  return worst;
}

// the root of a + w F_i(a) = q, which grows with a at a rate of at least 1
static double solve_alone(MonotoneForce law, const void* devices, int i, double w, double q,
                          double a) {
  double value = a + w * law(devices, i, a) - q;
  double low = a - fmax(value, 0), high = a - fmin(value, 0);
  double at_low = value > 0 ? low + w * law(devices, i, low) - q : value;
  double at_high = value > 0 ? value : high + w * law(devices, i, high) - q;

  // false position that halves a retained end (Illinois), until the bracket is rounding
  int side = 0;
  for (int k = 0; k < BISECTIONS && high - low > 2 * DBL_EPSILON * (fabs(low) + fabs(high)); k++) {
    double middle = (low * at_high - high * at_low) / (at_high - at_low);
    if (!(middle > low && middle < high) || k % 4 == 3) {
      middle = 0.5 * (low + high);
    }
    double at = middle + w * law(devices, i, middle) - q;
    if (at == 0) {
      return middle;
    }
    if (at > 0) {
      high = middle;
      at_high = at;
      at_low = side > 0 ? 0.5 * at_low : at_low;
      side = 1;
    } else {
      low = middle;
      at_low = at;
      at_high = side < 0 ? 0.5 * at_high : at_high;
      side = -1;
    }
  }
  return fabs(at_low) < fabs(at_high) ? low : high;
}

void monotone_solve(MonotoneForce law, MonotoneSlope slope, const void* devices, int n,
                    const mjtNum* W, const mjtNum* p, mjtNum* a, mjtNum* force, mjtNum* scratch) {
  mjtNum *A = scratch, *r = A + n * n, *step = r + n, *trial = step + n, *other = trial + n;
  for (int i = 0; i < n; i++) {
    force[i] = law(devices, i, a[i]);
  }
  double size = residual(n, W, p, a, force, r);

  for (int round = 0; round < NEWTON_ROUNDS && size > 1; round++) {
    for (int j = 0; j < n; j++) {
      double rise = slope(devices, j, a[j], force[j]);
      for (int i = 0; i < n; i++) {
        A[i * n + j] = (i == j) + W[i * n + j] * rise;
      }
    }
    solve_dense(n, A, r, step);
    for (int i = 0; i < n; i++) {
      trial[i] = a[i] - step[i];
      other[i] = law(devices, i, trial[i]);
    }
    double reached = residual(n, W, p, trial, other, r);
    if (!(reached < 0.9 * size)) {
      break;
    }
    size = reached;
    mju_copy(a, trial, n);
    mju_copy(force, other, n);
  }

  // one after the other
  for (int sweep = 0; sweep < SWEEPS && size > ENOUGH; sweep++) {
    for (int i = 0; i < n; i++) {
      double q = p[i];
      for (int j = 0; j < n; j++) {
        q -= i == j ? 0 : W[i * n + j] * force[j];
      }
      a[i] = solve_alone(law, devices, i, W[i * n + i], q, a[i]);
      force[i] = law(devices, i, a[i]);
    }
    double reached = residual(n, W, p, a, force, r);
    if (sweep > 2 && reached > 0.9999 * size) {
      break;
    }
    size = reached;
  }
}
