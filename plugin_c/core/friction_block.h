// Friction laws at several samples of a motion at once: what a law computes for each sample alone,
// in loops that the compiler turns into instructions on several numbers. Only a bristle goes from
// sample to sample, with what it is pulled by computed before. The same numbers as sample by
// sample.

#ifndef INERTER_CORE_FRICTION_BLOCK_H_
#define INERTER_CORE_FRICTION_BLOCK_H_

#include "elementary.h"
#include "friction.h"

// displacement, from the rest length on, and velocity at samples: of them, or on the way to each
// from the one before it, at the mean velocity and in the middle; there is no way to sample 0
typedef struct FrictionSamples_ {
  int size;
  double x[FRICTION_BLOCK];
  double v[FRICTION_BLOCK];
} FrictionSamples;

static INLINED void samples_at(const InerterDevice* p, const FrictionPath* path,
                               FrictionSamples* at) {
  at->size = path->last - path->first;
  for (int i = 0; i < at->size; i++) {
    at->x[i] = path->x[path->first + i] - p->rest_length;
    at->v[i] = path->v[path->first + i];
  }
}

static INLINED void samples_between(const InerterDevice* p, const FrictionPath* path,
                                    FrictionSamples* to) {
  int begin = path->first == 0;
  to->size = path->last - path->first;
  if (begin) {
    to->x[0] = path->x[0] - p->rest_length;
    to->v[0] = 0;
  }
  for (int i = begin; i < to->size; i++) {
    double here = path->x[path->first + i], before = path->x[path->first + i - 1];
    to->x[i] = 0.5 * (here + before) - p->rest_length;
    to->v[i] = (here - before) / path->h;
  }
}

// friction_level at samples
static INLINED void levels_at(const InerterDevice* p, const FrictionSamples* at, double* level) {
  if (friction_level_is_one(p)) {
    for (int i = 0; i < at->size; i++) {
      level[i] = 1;
    }
  } else if (p->parts & PART_FRICTION_CURVE) {
    double lean[FRICTION_BLOCK];
    friction_curve_levels(p, at->size, at->x, level, lean);
    for (int i = 0; i < at->size; i++) {
      level[i] *= 1 + lean[i] * friction_direction(p, at->v[i]);
    }
  } else {
    for (int i = 0; i < at->size; i++) {
      double x = at->x[i], rise = (p->friction_gradient + p->friction_curvature * x) * x;
      level[i] =
          larger(1e-3, 1 + rise) * (1 + p->friction_asymmetry * friction_direction(p, at->v[i]));
    }
  }
}

// friction_stribeck_curve at samples
static INLINED void stribeck_curves_at(const InerterDevice* p, const FrictionSamples* at,
                                       double* curve) {
  double low = p->coulomb_force, excess = p->static_force - low, slow = p->stribeck_velocity;
  if (excess == 0) {
    for (int i = 0; i < at->size; i++) {
      curve[i] = low;
    }
  } else if (p->stribeck_exponent == 2) {
    for (int i = 0; i < at->size; i++) {
      double ratio = fabs(at->v[i]) / slow;
      curve[i] = low + excess * elementary_exp(-(ratio * ratio));
    }
  } else {
    for (int i = 0; i < at->size; i++) {
      curve[i] = friction_stribeck_curve(p, at->v[i]);
    }
  }
}

// Forces of a law without states, whose level times `shaped` they are.
static INLINED void memoryless_along(const InerterDevice* p, const FrictionPath* path,
                                     double* forces,
                                     double (*shaped)(const InerterDevice* p, double v)) {
  FrictionSamples at;
  double level[FRICTION_BLOCK];
  samples_at(p, path, &at);
  levels_at(p, &at, level);
  for (int i = 0; i < at.size; i++) {
    forces[i] = level[i] * shaped(p, at.v[i]);
  }
}

// the states of a law at the samples of a path, where they are asked for
static INLINED void keep_states(const FrictionPath* path, const double* state) {
  for (int i = path->first; path->states && i < path->last; i++) {
    path->states[(size_t)i * (size_t)path->apart] = state[i - path->first];
  }
}

// whether a motion may turn on the way to sample i of a block, which is then taken by itself
static INLINED int may_turn(const FrictionPath* path, int i) {
  int at = path->first + i;
  return at > 0 && path->v[at - 1] * path->v[at] < 0;
}

// the step of a law on the way to sample i of a block
static INLINED double step_to(const InerterDevice* p, const FrictionPath* path, int i, double z,
                              StateStep* step) {
  int before = path->first + i - 1;
  return step_to_next(p, path->x + before, path->v + before, path->h, z, step);
}

// A bristle from sample to sample, pulled by a share towards the end of its way: its state at each.
static INLINED void bristle_along(const InerterDevice* p, const FrictionPath* path,
                                  const double* share, const double* end, double* z, double* state,
                                  StateStep* step) {
  int size = path->last - path->first;
  double now = *z;
  for (int i = 0; i < size; i++) {
    now = may_turn(path, i) ? step_to(p, path, i, now, step) : now + share[i] * (end[i] - now);
    state[i] = now;
  }
  *z = now;
  keep_states(path, state);
}

#endif  // INERTER_CORE_FRICTION_BLOCK_H_
