// Devices along a motion in blocks of samples that stay in the cache, part by part: the same
// numbers as sample by sample, in a fraction of the time.
//
// Most devices are b(x) a + R + T, or a series element beside T, with states that follow the motion
// and know nothing of each other: those of friction, of a series element with its flywheel and of
// viscoelastic branches. What hangs together at every instant, friction at the flywheel or raised
// by a load, a control, is taken sample by sample (motion.c).

#include <string.h>

#include "elementary.h"
#include "laws.h"
#include "series.h"

enum {
  // all that such a device may have
  BLOCK_PARTS = PART_VARYING | PART_FLYWHEEL | PART_PIPE | PART_GAS | PART_STOPS | PART_BRANCHES |
      PART_DAMPER | PART_DAMPER_SPRING | PART_FRICTION_CURVE | PART_FRICTION_BACK |
      PART_INERTANCE_CURVE | PART_INERTANCE_BACK | PART_FORCE_CURVE | PART_VISCOUS_CURVE |
      PART_FORCE_MAP | PART_SERIES | PART_BACKLASH | PART_CLUTCH,
  // what makes the force between the terminals more than a cubic spring and a quadratic damper
  BENT_PARTS = PART_STOPS | PART_DAMPER | PART_VISCOUS_CURVE | PART_FORCE_MAP
};

int fits_blocks(const InerterDevice* p) {
  return !p->ncontrol && !(p->parts & ~(uint32_t)BLOCK_PARTS) && !inerter_has_load_friction(p);
}

// the friction law along a path, behind its free play where it has one
static void friction_forces(const InerterDevice* p, const FrictionPath* path, double* z,
                            double* forces) {
  if (p->friction_backlash == 0) {
    law_of(p)->along(p, path, z, forces);
  } else {
    friction_along(p, path, z, forces, play_step, play_force);
  }
}

// force of the branches at the samples of a path, whose states are as those of friction
static void branches_along(const InerterDevice* p, const FrictionPath* path, const double* a,
                           double* e, double* restrict forces) {
  int size = path->last - path->first;
  memset(forces, 0, sizeof(double) * (size_t)size);
  for (int k = 0; k < p->nbranch; k++) {
    const double* branch = branch_element(p, k);
    double driven[RESPONSES], rate = branch[0] / branch[1], now = e[k];
    double left = elementary_exp(-rate * path->h);
    decay_driven(rate, path->h, driven);
    for (int i = path->first; i < path->last; i++) {
      if (i) {
        Way way = way_between(path->x + i - 1, path->v + i - 1, a + i - 1, path->h);
        now = left * now + driven[0] * way.v + driven[1] * way.a + driven[2] * way.jerk +
              driven[3] * way.snap + driven[4] * way.crackle;
      }
      forces[i - path->first] += branch[0] * now;
      if (path->states) {
        path->states[(size_t)i * (size_t)path->apart + (size_t)k] = now;
      }
    }
    e[k] = now;
  }
}

// Force of dampers behind a spring at the samples of a path; w: their state.
static void damper_spring_along(const InerterDevice* p, const FrictionPath* path, const double* a,
                                double* w, double* forces) {
  for (int i = path->first; i < path->last; i++) {
    if (i) {
      Way way = way_between(path->x + i - 1, path->v + i - 1, a + i - 1, path->h);
      damper_spring_follow(p, &way, w, path->h);
    }
    forces[i - path->first] = damper_spring_force(p, *w);
    if (path->states) {
      path->states[(size_t)i * (size_t)path->apart] = *w;
    }
  }
}

// Force of the series element at the samples of a path; z: its states.
static void series_along(const InerterDevice* p, const FrictionPath* path, const double* a,
                         SeriesExact* steps, double* z, double* forces) {
  const double *x = path->x, *v = path->v;
  double h = path->h;
  size_t count = (size_t)series_count(p);
  for (int i = path->first; i < path->last; i++) {
    if (i) {
      Way way = way_between(x + i - 1, v + i - 1, a + i - 1, h);
      if (!series_exact(p, steps, &way, z)) {
        series_step(p, stretch_of(p, x[i - 1]), &way, NULL, z, h);
      }
    }
    forces[i - path->first] = series_force(p, v[i], z);
    if (path->states) {
      memcpy(path->states + (size_t)i * (size_t)path->apart, z, sizeof(double) * count);
    }
  }
}

// b(x) a + R + G at n samples
static SEVERAL_AT_ONCE void add_flywheel(const InerterDevice* p, int n, const double* stretch,
                                         const double* v, const double* a, double* restrict total) {
  if (has(p, PART_VARYING)) {
    forces_of_inertance(p, n, stretch, v, a, total);
  } else {
    for (int i = 0; i < n; i++) {
      total[i] = p->inertance * a[i];
    }
  }
  for (int i = 0; has(p, PART_FLYWHEEL) && i < n; i++) {
    total[i] += flywheel_force(p, stretch[i], v[i]);
  }
}

// T without states, added to `total`
static SEVERAL_AT_ONCE void add_parallel(const InerterDevice* p, int n, const double* stretch,
                                         const double* v, double* restrict total) {
  if (p->parts & BENT_PARTS) {
    for (int i = 0; i < n; i++) {
      total[i] += parallel_force(p, stretch[i], v[i]);
    }
    return;
  }
  double curve[FRICTION_BLOCK], slope[FRICTION_BLOCK];
  int curved = has(p, PART_FORCE_CURVE);
  if (curved) {
    curve_at_samples(&p->curve[INERTER_STROKE_force], n, stretch, curve, slope);
  }
  for (int i = 0; i < n; i++) {
    double spring = cubic_spring(p, stretch[i]) + (curved ? curve[i] : 0);
    total[i] += spring + quadratic_damper(p, p->viscous, v[i]) + p->force_offset;
  }
}

static SEVERAL_AT_ONCE void add(int n, const double* some, double* restrict total) {
  for (int i = 0; i < n; i++) {
    total[i] += some[i];
  }
}

static SEVERAL_AT_ONCE void stretches(const InerterDevice* p, int n, const double* x,
                                      double* restrict stretch) {
  for (int i = 0; i < n; i++) {
    stretch[i] = stretch_of(p, x[i]);
  }
}

void blocks_along(const InerterDevice* p, int n, double h, const double* x, const double* v,
                  const double* a, double* z, double* total, double* friction, double* states) {
  double block[FRICTION_BLOCK] = {0}, stretch[FRICTION_BLOCK], relaxing[FRICTION_BLOCK],
         damping[FRICTION_BLOCK], carried[FRICTION_BLOCK] = {0};
  int branch = branch_index(p), series = series_index(p), damper = damper_index(p);
  SeriesExact steps;
  series_exact_steps(p, h, &steps);
  for (int first = 0; first < n; first += FRICTION_BLOCK) {
    int last = n - first < FRICTION_BLOCK ? n : first + FRICTION_BLOCK, size = last - first;
    double* forces = friction ? friction + first : block;
    FrictionPath path = {first, last, p->nstate, h, x, v, states};
    if (p->friction != INERTER_FRICTION_none) {
      friction_forces(p, &path, z, forces);
    } else if (friction) {
      memset(forces, 0, sizeof(double) * (size_t)size);
    }
    if (has(p, PART_BRANCHES)) {
      path.states = states ? states + branch : NULL;
      branches_along(p, &path, a, z + branch, relaxing);
    }
    if (has(p, PART_DAMPER_SPRING)) {
      path.states = states ? states + damper : NULL;
      damper_spring_along(p, &path, a, z + damper, damping);
    }
    double* sum = total ? total + first : carried;
    if (has(p, PART_SERIES)) {
      path.states = states ? states + series : NULL;
      series_along(p, &path, a, &steps, z + series, sum);
    }
    if (!total) {
      continue;
    }
    stretches(p, size, x + first, stretch);
    if (!has(p, PART_SERIES)) {
      add_flywheel(p, size, stretch, v + first, a + first, sum);
    }
    add_parallel(p, size, stretch, v + first, sum);
    if (has(p, PART_BRANCHES)) {
      add(size, relaxing, sum);
    }
    if (has(p, PART_DAMPER_SPRING)) {
      add(size, damping, sum);
    }
    if (p->friction != INERTER_FRICTION_none) {
      add(size, forces, sum);
    }
  }
}
