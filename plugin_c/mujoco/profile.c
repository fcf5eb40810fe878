// Cholesky factor of a symmetric matrix whose rows begin late: see profile.h.

#include "mujoco/profile.h"

#include <math.h>

mjtNum profile_dot(const mjtNum* a, const mjtNum* b, int n) {
  mjtNum s0 = 0, s1 = 0, s2 = 0, s3 = 0;
  int i = 0;
  for (; i + 4 <= n; i += 4) {
    s0 += a[i] * b[i];
    s1 += a[i + 1] * b[i + 1];
    s2 += a[i + 2] * b[i + 2];
    s3 += a[i + 3] * b[i + 3];
  }
  for (; i < n; i++) {
    s0 += a[i] * b[i];
  }
  return (s0 + s1) + (s2 + s3);
}

int profile_factor(int n, const int* first, mjtNum* matrix) {
  for (int i = 0; i < n; i++) {
    mjtNum* row = matrix + i * n;
    for (int c = first[i]; c < i; c++) {
      const mjtNum* above = matrix + c * n;
      int from = mjMAX(first[i], first[c]);
      row[c] = (row[c] - profile_dot(row + from, above + from, mjMAX(0, c - from))) * above[c];
    }
    int from = first[i];
    mjtNum pivot = row[i] - profile_dot(row + from, row + from, i - from);
    if (!(pivot > 0)) {
      return 0;
    }
    row[i] = 1 / sqrt(pivot);
  }
  return 1;
}

void profile_solve(int n, const int* first, const mjtNum* factor, mjtNum* x) {
  for (int i = 0; i < n; i++) {
    const mjtNum* row = factor + i * n;
    int from = first[i];
    x[i] = (x[i] - profile_dot(row + from, x + from, i - from)) * row[i];
  }
  for (int i = n - 1; i >= 0; i--) {
    const mjtNum* row = factor + i * n;
    x[i] *= row[i];
    for (int c = first[i]; c < i; c++) {
      x[c] -= row[c] * x[i];
    }
  }
}
