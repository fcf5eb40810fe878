// The devices' forces at a given acceleration: see inverse.h.

#include "mujoco/inverse.h"

#include <math.h>
#include <stdio.h>

#include "mujoco/command.h"
#include "mujoco/coupled.h"
#include "mujoco/live.h"
#include "mujoco/metric.h"

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

int inerter_device_force(const mjModel* m, mjData* d, const mjtNum* qacc, mjtNum* force,
                         mjtNum* qfrc, char message[INERTER_MESSAGE_SIZE]) {
  Now* all = mju_malloc(sizeof(Now) * (size_t)(m->nplugin + 1));
  int n = 0, bad = 0;
  for (int k = 0; !bad && k < m->nplugin; k++) {
    if (instance_is_device(m, k)) {
      bad = look(m, d, k, all + n++, message);
    }
  }
  mju_zero(qfrc, (int)m->nv);
  if (n && !bad) {
    move(m, d, qacc, n, all);
    for (int i = 0; i < n; i++) {
      const Instance* self = &all[i].self;
      mjtNum share = share_of_force(m, all + i);
      instance_add_moment(m, d, self, self->detour - share, qfrc);

      // and what the engine holds of it
      mjtNum a = instance_along(m, d, self, qacc) + self->bias;
      force[i] = share + self->armature * a + self->damping * self->v;
    }
  }
  mju_free(all);
  return bad;
}
