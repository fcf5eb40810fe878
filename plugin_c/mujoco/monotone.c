// Forces and accelerations that fit each other: see monotone.h.
//
// With a = p - W y the solution y = F(a) is where the convex function
//   psi(y) = y'W y / 2 + sum_i (integral of F_i)(p - W y)_i,   grad psi = W (y - F)
// is least. Newton's step (I + S W) dy = F - y, S the rises of F, leads downhill; where it goes too
// far (past the corner of a friction law) the line is searched for the zero of psi's slope along
// it, which rises. So no step can lead away, however sharp the laws are.

#include "mujoco/monotone.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "mujoco/downhill.h"

enum { ROUNDS = 100 };

// change of a, over the size of its terms, from which on rounds that come no nearer are rounding
static const double kEnough = 1e-9;

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

void monotone_solve_lines(int n, const mjtNum* start, const mjtNum* rise, const mjtNum* W,
                          const mjtNum* p, mjtNum* a, mjtNum* force, mjtNum* scratch) {
  mjtNum *A = scratch, *r = A + n * n;
  for (int i = 0; i < n; i++) {
    r[i] = p[i];
    for (int j = 0; j < n; j++) {
      A[i * n + j] = (i == j) + W[i * n + j] * rise[j];
      r[i] -= W[i * n + j] * start[j];
    }
  }
  solve_dense(n, A, r, a);
  for (int i = 0; i < n; i++) {
    force[i] = start[i] + rise[i] * a[i];
  }
}

// where y is, and what the laws say there
typedef struct Point_ {
  mjtNum* y;
  mjtNum* a;      // p - W y
  mjtNum* force;  // F(a)
  mjtNum* rise;
} Point;

static void evaluate(MonotoneLaw law, const void* devices, int n, Point* at) {
  for (int i = 0; i < n; i++) {
    at->force[i] = law(devices, i, at->a[i], at->rise + i);
  }
}

// W x
static void multiply(int n, const mjtNum* W, const mjtNum* x, mjtNum* product) {
  for (int i = 0; i < n; i++) {
    product[i] = 0;
    for (int j = 0; j < n; j++) {
      product[i] += W[i * n + j] * x[j];
    }
  }
}

// I + S W
static void newton_matrix(int n, const mjtNum* W, const mjtNum* rise, mjtNum* A) {
  for (int i = 0; i < n; i++) {
    for (int j = 0; j < n; j++) {
      A[i * n + j] = (i == j) + rise[i] * W[i * n + j];
    }
  }
}

// what rounding leaves of the terms of a, over their size
static const double kRounding = 64 * DBL_EPSILON;

// largest of the changes of a over what rounding leaves of its terms, 1 or less is nothing
static double largest(int n, const mjtNum* W, const mjtNum* p, const mjtNum* grain, const Point* at,
                      const mjtNum* change) {
  double worst = 0;
  for (int i = 0; i < n; i++) {
    double size = fabs(p[i]) + fabs(at->a[i]) + grain[i] + DBL_MIN;
    for (int j = 0; j < n; j++) {
      size += fabs(W[i * n + j] * at->y[j]);
    }
    worst = fmax(worst, fabs(change[i]) / (kRounding * size));
  }
  return worst;
}

// from a point along dy, u = W dy, to another
typedef struct Line_ {
  MonotoneLaw law;
  const void* devices;
  int n;
  const Point* from;
  const mjtNum *dy, *u;
  Point* to;
} Line;

// go the part t of the line; slope of psi there
static double go(void* context, double t) {
  Line* line = context;
  double slope = 0;
  for (int i = 0; i < line->n; i++) {
    line->to->y[i] = line->from->y[i] + t * line->dy[i];
    line->to->a[i] = line->from->a[i] - t * line->u[i];
  }
  evaluate(line->law, line->devices, line->n, line->to);
  for (int i = 0; i < line->n; i++) {
    slope += line->u[i] * (line->to->y[i] - line->to->force[i]);
  }
  return slope;
}

// Whether the laws, asked at their own forces, say the same: then these are the solution. Where
// they do not, a step that was cut short lies between two corners, and the point stays as it is.
static int fits_itself(MonotoneLaw law, const void* devices, int n, const mjtNum* W,
                       const mjtNum* p, Point* now, Point* next) {
  mju_copy(next->y, now->force, n);
  multiply(n, W, next->y, next->a);
  mju_sub(next->a, p, next->a, n);
  evaluate(law, devices, n, next);
  if (memcmp(now->force, next->force, sizeof(mjtNum) * (size_t)n) != 0) {
    return 0;
  }
  mju_copy(now->y, next->y, n);
  mju_copy(now->a, next->a, n);
  return 1;
}

int monotone_solve(MonotoneLaw law, const void* devices, int n, const mjtNum* W, const mjtNum* p,
                   const mjtNum* grain, mjtNum* a, mjtNum* force, mjtNum* scratch) {
  mjtNum *A = scratch, *r = A + n * n, *dy = r + n, *u = dy + n;
  Point now = {force, a, u + n, u + 2 * n};
  Point next = {u + 3 * n, u + 4 * n, u + 5 * n, u + 6 * n};

  // the laws as lines through the guess: (I + S W) y = F + S (p - a)
  evaluate(law, devices, n, &now);
  for (int i = 0; i < n; i++) {
    r[i] = now.force[i] + now.rise[i] * (p[i] - a[i]);
  }
  newton_matrix(n, W, now.rise, A);
  solve_dense(n, A, r, now.y);
  multiply(n, W, now.y, u);
  mju_sub(a, p, u, n);
  evaluate(law, devices, n, &now);

  double before = INFINITY;
  for (int round = 0; round < ROUNDS; round++) {
    mju_sub(r, now.force, now.y, n);
    multiply(n, W, r, u);
    double left = largest(n, W, p, grain, &now, u);
    if (!(left > 1) || (kRounding * left <= kEnough && left >= 0.5 * before)) {
      return round;
    }
    before = left;
    newton_matrix(n, W, now.rise, A);
    solve_dense(n, A, r, dy);
    multiply(n, W, dy, u);
    Line line = {law, devices, n, &now, dy, u, &next};
    downhill_search(go, &line, mju_dot(u, now.y, n) - mju_dot(u, now.force, n));
    int last = !(largest(n, W, p, grain, &now, u) > 1);
    int flat = memcmp(now.force, next.force, sizeof(mjtNum) * (size_t)n) == 0;
    mju_copy(now.y, next.y, n);
    mju_copy(now.a, next.a, n);
    mju_copy(now.force, next.force, n);
    mju_copy(now.rise, next.rise, n);

    // laws so steep that the rounding of a moves their force
    if (last) {
      return round + 1;
    }
    // forces that are small beside what they are the sum of: what is left is less than its rounding
    if (flat && fits_itself(law, devices, n, W, p, &now, &next)) {
      return round + 1;
    }
  }
  return -ROUNDS;
}
