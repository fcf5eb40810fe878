// Devices along a measured motion: see motion.h.

#include "motion.h"

#include <string.h>

#include "laws.h"
#include "series.h"

// Force through the inertance that loads a bristle: in the middle between two samples, with a
// series element at the first.
static double middle_load(const InerterDevice* device, const double* x, const double* v,
                          const double* a, const double* z) {
  if (!inerter_load_bends(device)) {
    return 0;
  }
  if (has(device, PART_SERIES)) {
    return series_force(device, v[0], z + series_index(device));
  }
  double rest, middle = 0.5 * (x[0] + x[1]);
  double inertance = inerter_inertance(device, middle, 0.5 * (v[0] + v[1]), &rest);
  return 0.5 * inertance * (a[0] + a[1]) + rest;
}

// States from one sample to the next, h later. A bristle sees the mean velocity at the middle,
// which keeps its path, before and after the motion turns; a series element and branches see the
// quintic through both samples: a stiff shaft carries b a.
static void step_between(const InerterDevice* device, const double* x, const double* v,
                         const double* a, double* z, double h) {
  double start = stretch_of(device, x[0]);
  double before = middle_load(device, x, v, a, z);
  Way way = way_between(x, v, a, h);
  if (has(device, PART_BRANCHES)) {
    branches_follow(device, &way, z + branch_index(device), h);
  }
  if (has(device, PART_DAMPER_SPRING)) {
    damper_spring_follow(device, &way, z + damper_index(device), h);
  }
  if (has(device, PART_SERIES)) {
    series_step(device, start, &way, z, z + series_index(device), h);
  }
  if (has_bristle(device) && !has(device, PART_WHEEL_FRICTION)) {
    double carried = inerter_load_bends(device) && has(device, PART_SERIES)
                         ? 0.5 * (before + series_force(device, v[1], z + series_index(device)))
                         : before;
    Leg legs[2];
    int count = legs_between(x, v, h, legs);
    for (int i = 0; i < count; i++) {
      const Leg* leg = legs + i;
      double mean = mean_velocity(leg);
      friction_step(device, stretch_of(device, middle_of(leg)), mean, z, leg->time,
                    load_on_bristle(device, mean, carried));
    }
  }
  if (device->ncontrol) {
    z[control_index(device)] = control_step(device, z[control_index(device)], h);
  }
}

void inerter_along(const InerterDevice* device, int n, double h, const double* x, const double* v,
                   const double* a, double* z, double* total, double* friction, double* states) {
  double now[INERTER_MAXSTATE] = {0};
  size_t nstate = (size_t)inerter_nstate(device), size = nstate * sizeof(double);
  if (z) memcpy(now, z, size);
  if (fits_blocks(device)) {
    blocks_along(device, n, h, x, v, a, now, total, friction, states);
  } else {
    for (int i = 0; i < n; i++) {
      if (nstate && i) step_between(device, x + i - 1, v + i - 1, a + i - 1, now, h);
      InerterForce force = inerter_force(device, x[i], v[i], a[i], now);
      if (total) total[i] = force.total;
      if (friction) friction[i] = force.friction;
      if (states) memcpy(states + i * nstate, now, size);
    }
  }
  if (z) memcpy(z, now, size);
}

void inerter_along_commanded(const InerterDevice* device, int n, double h, const double* x,
                             const double* v, const double* a, const double* command, double* z,
                             double* total, double* friction, double* states) {
  if (!command || device->control == INERTER_CONTROL_force) {
    inerter_along(device, n, h, x, v, a, z, total, friction, states);
    return;
  }
  InerterDevice present = *device;
  double now[INERTER_MAXSTATE] = {0};
  size_t nstate = (size_t)inerter_nstate(device), size = nstate * sizeof(double);
  if (z) memcpy(now, z, size);
  for (int i = 0; i < n; i++) {
    // the step runs with the value of its start
    if (nstate && i) step_between(&present, x + i - 1, v + i - 1, a + i - 1, now, h);
    inerter_command(&present, command[i], now);
    InerterForce force = inerter_force(&present, x[i], v[i], a[i], now);
    if (total) total[i] = force.total;
    if (friction) friction[i] = force.friction;
    if (states) memcpy(states + i * nstate, now, size);
  }
  if (z) memcpy(z, now, size);
}

void inerter_along_many(const InerterDevice* devices, int ndevice, int n, double h, const double* x,
                        const double* v, const double* a, double* total) {
  for (int k = 0; k < ndevice; k++) {
    inerter_along(devices + k, n, h, x, v, a, 0, total + (size_t)k * n, 0, 0);
  }
}

static void evaluate(const InerterDevice* device, int n, int i, double x, double v, double a,
                     const double* z, double* result, double* rates) {
  InerterForce force = inerter_force(device, x, v, a, z);
  result[i] = force.total;
  result[n + i] = force.inertance;
  result[2 * n + i] = force.friction;
  result[3 * n + i] = inerter_stored_energy(device, x, v, z);
  result[4 * n + i] = inerter_dissipated_power(device, x, v, a, z);
  if (device->nstate) {
    inerter_state_rate(device, x, v, a, z, rates + (size_t)i * (size_t)device->nstate);
  }
}

void inerter_evaluate(const InerterDevice* device, int n, const double* x, const double* v,
                      const double* a, const double* z, double* result, double* rates) {
  int nstate = inerter_nstate(device);
  for (int i = 0; i < n; i++) {
    const double* state = nstate ? z + (size_t)i * nstate : NULL;
    evaluate(device, n, i, x[i], v[i], a[i], state, result, rates);
  }
}

void inerter_evaluate_commanded(const InerterDevice* device, int n, const double* x,
                                const double* v, const double* a, const double* command,
                                const double* z, double* result, double* rates) {
  InerterDevice present = *device;
  int nstate = inerter_nstate(device);
  for (int i = 0; i < n; i++) {
    const double* state = nstate ? z + (size_t)i * nstate : NULL;
    inerter_command(&present, command[i], state);
    evaluate(&present, n, i, x[i], v[i], a[i], state, result, rates);
    result[5 * n + i] = inerter_control_power(&present, x[i], v[i], state);
  }
}
