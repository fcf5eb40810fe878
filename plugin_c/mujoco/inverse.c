// The devices' forces at a given acceleration: see inverse.h.

#include "mujoco/inverse.h"

#include <math.h>
#include <stdio.h>

#include "mujoco/command.h"
#include "mujoco/coupled.h"
#include "mujoco/live.h"
#include "mujoco/metric.h"
#include "mujoco/monotone.h"
#include "mujoco/solution.h"
#include "mujoco/watch.h"

// one device now, without the trace that an evaluation leaves in its instance
typedef struct Now_ {
  Instance self;
  mjtNum a;         // acceleration of the step along it [m/s^2]
  mjtNum mobility;  // as in coupled.c [1/kg]
  int asleep;
} Now;

static int look(const mjModel* m, const mjData* d, int instance, Now* now,
                char message[INERTER_MESSAGE_SIZE]) {
  Instance* self = &now->self;
  *self = *instance_of(d, instance);
  if (!self->native && m->actuator_armature[self->actuator] != 0) {
    snprintf(
        message, INERTER_MESSAGE_SIZE,
        "actuator_armature of device %d is %g, but the engine's inertia matrix cannot hold its "
        "inertance; leave it 0",
        instance, m->actuator_armature[self->actuator]);
    return -1;
  }
  if (live_derive(m, self, message)) {
    return -1;
  }
  self->x = instance_displacement(m, d, self);
  self->v = instance_velocity(m, d, self);
  self->bias = instance_bias_acceleration(m, d, self);
  command_take(m, d, self);
  int nstate = inerter_nstate(&self->device);
  mju_copy(self->state, d->act + (nstate ? instance_act(m, self) : 0), nstate);
  self->disabled = instance_disabled(m, self);
  watch_resolution(m, d, self);
  now->asleep = instance_asleep(m, d, self);
  return 0;
}

// what the plugin brings: the share at the acceleration of the step, less the engine's part of it
static mjtNum share_of_force(const mjModel* m, const Now* now) {
  const Instance* self = &now->self;
  const InerterDevice* share = self->disabled ? &self->matter : &self->share;
  mjtNum a = now->a;
  if (now->asleep || self->forceless) {
    return 0;
  }
  if (coupled_needed(m, self) && m->opt.integrator != mjINT_RK4) {
    InerterForce force = inerter_force_over_step(share, self->x, self->v, a, self->state,
                                                 m->opt.timestep, now->mobility, NULL);
    return force.total - self->replaced * a;
  }
  return inerter_force(share, self->x, self->v, a, self->state).total - self->replaced * a;
}

// acceleration of each device over the step that has this qacc, and mobility of the terminals
static void move(const mjModel* m, mjData* d, const mjtNum* qacc, int n, Now* all) {
  int nv = (int)m->nv;
  mj_markStack(d);
  Metric metric = metric_of_step(m, d);
  metric_factor(m, d, &metric);
  mjtNum* J = mj_stackAllocNum(d, (size_t)n * nv);
  mjtNum* X = mj_stackAllocNum(d, (size_t)n * nv);
  mjtNum* pull = mj_stackAllocNum(d, nv);
  int* dof = mj_stackAllocInt(d, nv);
  for (int i = 0; i < nv; i++) {
    dof[i] = i;
  }
  mjtNum* step = mj_stackAllocNum(d, nv);
  mju_copy(step, qacc, nv);
  if (metric_moves_qacc(&metric)) {
    mj_mulM(m, d, pull, qacc);
    metric_solve(m, d, &metric, nv, dof, pull, step);
  }
  mju_zero(J, n * nv);
  for (int i = 0; i < n; i++) {
    instance_add_moment(m, d, &all[i].self, 1, J + i * nv);
    metric_solve(m, d, &metric, nv, dof, J + i * nv, X + i * nv);
  }
  for (int i = 0; i < n; i++) {
    all[i].a = instance_along(m, d, &all[i].self, step) + all[i].self.bias;
    all[i].mobility = 0;
    for (int j = 0; j < n; j++) {
      all[i].mobility += fabs(instance_along(m, d, &all[i].self, X + j * nv));
    }
  }
  mj_freeStack(d);
}

// all devices now and at an acceleration; returns their number, or -1 with a message
static int look_at_all(const mjModel* m, mjData* d, const mjtNum* qacc, Now* all,
                       char message[INERTER_MESSAGE_SIZE]) {
  int n = 0;
  for (int k = 0; k < m->nplugin; k++) {
    if (instance_is_device(m, k) && look(m, d, k, all + n++, message)) {
      return -1;
    }
  }
  if (n) {
    move(m, d, qacc, n, all);
  }
  return n;
}

int inerter_device_force(const mjModel* m, mjData* d, const mjtNum* qacc, mjtNum* force,
                         mjtNum* qfrc, char message[INERTER_MESSAGE_SIZE]) {
  Now* all = mju_malloc(sizeof(Now) * (size_t)(m->nplugin + 1));
  int n = look_at_all(m, d, qacc, all, message);
  mju_zero(qfrc, (int)m->nv);
  for (int i = 0; i < n; i++) {
    const Instance* self = &all[i].self;
    mjtNum share = share_of_force(m, all + i);
    instance_add_moment(m, d, self, self->detour - share, qfrc);

    // and what the engine holds of it
    mjtNum a = instance_along(m, d, self, qacc) + self->bias;
    force[i] = share + self->armature * a + self->damping * self->v;
  }
  mju_free(all);
  return n < 0 ? -1 : 0;
}

// q = qacc + A^-1 P' (F - F(P q + bias)), F the forces of the step (damped.h)
static void feel(const mjModel* m, mjData* d, const mjtNum* qacc, int n, Now* all, mjtNum* felt) {
  int nv = (int)m->nv, k = 0;
  mj_markStack(d);
  int* dof = mj_stackAllocInt(d, nv);
  for (int i = 0; i < nv; i++) {
    dof[i] = i;
  }
  Coupled* part = mj_stackAllocByte(d, (size_t)n * sizeof(Coupled), _Alignof(Coupled));
  mjtNum* J = mj_stackAllocNum(d, nv);
  mjtNum* X = mj_stackAllocNum(d, (size_t)n * nv);
  mjtNum* W = mj_stackAllocNum(d, n * n);
  mjtNum *p = mj_stackAllocNum(d, 4 * n), *a = p + n, *force = a + n, *of_step = force + n;
  mjtNum* scratch = mj_stackAllocNum(d, n * (n + 9));
  const Metric inertia = {METRIC_INERTIA, NULL, NULL, NULL};
  for (int i = 0; i < n; i++) {
    Instance* self = &all[i].self;
    if (all[i].asleep || self->forceless || !coupled_needed(m, self)) {
      continue;
    }
    part[k] = (Coupled){.self = self, .constant = self->replaced};
    inerter_step_begin(&part[k].step, self->disabled ? &self->matter : &self->share, self->x,
                       self->v, self->state, m->opt.timestep, all[i].mobility);
    of_step[k] = share_of_force(m, all + i);
    mju_zero(J, nv);
    instance_add_moment(m, d, self, 1, J);
    metric_solve(m, d, &inertia, nv, dof, J, X + k * nv);
    k++;
  }
  for (int i = 0; i < k; i++) {
    a[i] = p[i] = instance_along(m, d, part[i].self, qacc) + part[i].self->bias;
    for (int j = 0; j < k; j++) {
      W[i * k + j] = instance_along(m, d, part[i].self, X + j * nv);
      p[i] += W[i * k + j] * of_step[j];
    }
  }
  if (k) {
    monotone_solve(solution_law, part, k, W, p, solution_grains(d, part, k), a, force, scratch);
  }
  for (int i = 0; i < k; i++) {
    mju_addToScl(felt, X + i * nv, of_step[i] - force[i], nv);
  }
  mj_freeStack(d);
}

int inerter_felt_acceleration(const mjModel* m, mjData* d, const mjtNum* qacc, mjtNum* felt,
                              char message[INERTER_MESSAGE_SIZE]) {
  mju_copy(felt, qacc, (int)m->nv);
  mj_markStack(d);
  Metric metric = metric_of_step(m, d);
  mj_freeStack(d);
  if (m->opt.integrator == mjINT_RK4 || !metric_moves_qacc(&metric) ||
      m->opt.disableflags & mjDSBL_ACTUATION) {
    return 0;
  }
  Now* all = mju_malloc(sizeof(Now) * (size_t)(m->nplugin + 1));
  int n = look_at_all(m, d, qacc, all, message);
  if (n > 0) {
    feel(m, d, qacc, n, all, felt);
  }
  mju_free(all);
  return n < 0 ? -1 : 0;
}
