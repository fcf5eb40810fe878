// Steps of a series element (series.c) whose flywheel slides: friction is even, and all else
// linear.
//
//   B w' + c_w w + D = F_s,   D = (D_0 + D_1) / 2
//
// D_0, D_1: force of the friction law (wheel_friction.c) at the start and at the end of the step,
// whose states see the mean velocity of the flywheel. With that drag a step has a closed form
// (series_exact.c). Found in two passes; where D is not even, or where a pass changes it by more
// than kSettles of what the drag was changed by, the flywheel does not slide, and the step is left
// to others.
//
// B, c_w, F_s, w: as in series.c. Why: a flywheel slides nearly always, and then neither its spring
// nor its bristle has to be resolved. Order: 2. Not modelled: load friction, slip.

#include <string.h>

#include "series.h"

enum { S, W, GAP };  // places in z

// by how much of a change of the drag friction answers that there is a next one
static const double kSettles = 0.1;

static double rubbing(const InerterDevice* p, double y, double w, const double* bristle) {
  return bristle ? friction_force(p, y, w, bristle, 0) : law_of(p)->force(p, y, w, 0, 0);
}

// a step with a drag: friction at its end, states of the law there; NAN where there is none
static double pass(const InerterDevice* p, SeriesExact* steps, double x, const Way* way,
                   double drag, double* bristle, double* z) {
  double start = x - z[S], end = x + way_travel(way, steps->h), w = z[W];
  steps->oscillator.push = drag;
  if (!series_exact(p, steps, way, z)) {
    return NAN;
  }
  end -= z[S];
  double mean = (end - start) / steps->h;
  if (!(mean * w > 0 && mean * z[W] > 0)) {
    return NAN;
  }
  if (bristle) {
    friction_step(p, 0.5 * (start + end), mean, bristle, steps->h, 0);
  }
  return rubbing(p, end, z[W], bristle);
}

int series_sliding(const InerterDevice* p, SeriesExact* steps, double x, const Way* way,
                   double* bristle, double* z) {
  int plain = steps->holds && steps->dashpot == 0 && !has(p, PART_CLUTCH);
  if (!plain || !(steps->h > 0) || inerter_has_load_friction(p)) {
    return 0;
  }
  double first = rubbing(p, x - z[S], z[W], bristle), drag = first, last = first;
  double states[INERTER_MAXFRICTION] = {0}, next[3] = {0};
  size_t size = sizeof(double) * (size_t)p->nfriction;
  size_t count = sizeof(double) * (size_t)series_count(p);
  for (int i = 0; i < 2; i++) {
    next[S] = z[S];
    next[W] = z[W];
    next[GAP] = series_count(p) > GAP ? z[GAP] : 0;
    if (bristle) {
      memcpy(states, bristle, size);
    }
    double before = last, changed = drag;
    drag = 0.5 * (first + last);
    changed = drag - changed;
    last = pass(p, steps, x, way, drag, bristle ? states : NULL, next);
    if (!friction_is_even(first, last) ||
        (i > 0 && fabs(last - before) > kSettles * fabs(changed) + 1e-12 * fabs(first))) {
      return 0;
    }
  }
  memcpy(z, next, count);
  if (bristle) {
    memcpy(bristle, states, size);
  }
  return 1;
}
