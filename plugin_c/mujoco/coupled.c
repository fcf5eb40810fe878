// Forces that are found together with the acceleration: see coupled.h.

#include "mujoco/coupled.h"

#include <math.h>

#include "mujoco/engine_private.h"
#include "mujoco/metric.h"
#include "mujoco/monotone.h"

// most rounds with the engine's constraint solver, and the fit that ends them
enum { CONSTRAINT_ROUNDS = 60 };
static const double kFit = 1e-10, kLooseFit = 1e-7;

// one device in the equations of coupled.h
typedef struct Coupled_ {
  Instance* self;
  mjtNum constant;   // inertance that the engine's matrix holds already [kg]
  mjtNum mobility;   // acceleration of the terminals per force [1/kg]
  mjtNum h;          // length of the step, 0: the force of this instant (stages of RK4)
  mjtNum inertance;  // B(x, v), if of this instant [kg]
  mjtNum rest;       // force of the branch at a = 0 [N]
  mjtNum motion;     // force that does not depend on a [N]
  mjtNum load;       // load friction per force of the branch
} Coupled;

//------------------------------ laws --------------------------------------------------------------

static InerterForce force_at(const Coupled* c, double a) {
  const Instance* self = c->self;
  if (c->h > 0) {
    return inerter_force_over_step(&c->self->share, self->x, self->v, a, self->state, c->h,
                                   c->mobility, NULL);
  }
  InerterForce force;
  force.inertance = c->inertance * a + c->rest;
  force.friction = c->load * fabs(force.inertance);
  force.total = c->motion + force.inertance + force.friction;
  return force;
}

static double law(const void* devices, int i, double a) {
  const Coupled* c = (const Coupled*)devices + i;
  return force_at(c, a).total - c->constant * a;
}

int coupled_needed(const mjModel* m, const Instance* self) {
  const InerterDevice* share = &self->share;
  int series = instance_has_series(share);
  if (m->opt.integrator == mjINT_RK4) {
    return !series && (share->inertance > 0 || share->load_friction > 0);
  }
  return !self->native || series || share->inertance > 0 || share->load_friction > 0 ||
         instance_has_stop(share) || instance_has_sharp_friction(share);
}

// the devices to solve for
static int collect(const mjModel* m, const mjData* d, int last, Coupled* all) {
  int n = 0;
  for (int k = 0; k <= last; k++) {
    if (m->plugin[k] != m->plugin[last] || !instance_of(d, k)->solved) {
      continue;
    }
    Coupled* c = all + n++;
    Instance* self = c->self = instance_of(d, k);
    int whole = self->share.inertance > 0 && !instance_has_series(&self->share);
    c->constant = whole ? self->armature : 0;
    c->h = m->opt.integrator == mjINT_RK4 ? 0 : m->opt.timestep;
    if (c->h == 0) {
      c->inertance = inerter_inertance(&c->self->share, self->x, self->v, &c->rest);
      c->motion = inerter_force_motion(&c->self->share, self->x, self->v, self->state);
      c->load = inerter_load_factor(&c->self->share, self->v);
    }
  }
  return n;
}

//------------------------------ what the model answers --------------------------------------------

// the model seen from the devices
typedef struct Answer_ {
  int n;
  const Coupled* all;
  Metric metric;
  mjtNum* J;       // moment arms (n x nv)
  mjtNum* smooth;  // smooth force and acceleration without the devices' forces (nv each)
  mjtNum* free;
  mjtNum* plain;  // M^-1 J', which the constraint solver sees (n x nv)
  mjtNum* work;   // nv
} Answer;

// acceleration along the devices for the acceleration of the model
static void along(const mjModel* m, const Answer* answer, const mjtNum* qacc, mjtNum* a) {
  for (int i = 0; i < answer->n; i++) {
    a[i] = mju_dot(answer->J + i * m->nv, qacc, m->nv) + answer->all[i].self->bias;
  }
}

// acceleration along the devices when they pull with these forces, constraints answering
static void respond(const mjModel* m, mjData* d, const Answer* answer, const mjtNum* force,
                    mjtNum* a) {
  int nv = m->nv;
  mju_copy(d->qfrc_smooth, answer->smooth, nv);
  mju_copy(d->qacc_smooth, answer->free, nv);
  for (int i = 0; i < answer->n; i++) {
    mju_addToScl(d->qfrc_smooth, answer->J + i * nv, -force[i], nv);
    mju_addToScl(d->qacc_smooth, answer->plain + i * nv, -force[i], nv);
  }
  mj_fwdConstraint(m, d);
  if (!metric_moves_qacc(&answer->metric)) {
    along(m, answer, d->qacc, a);
    return;
  }
  mjtNum *total = answer->work, *qacc = answer->work + nv;
  mju_add(total, d->qfrc_smooth, d->qfrc_constraint, nv);
  metric_solve(m, d, &answer->metric, qacc, total, 1);
  along(m, answer, qacc, a);
}

// Broyden's update: W such that it explains the last change of a by the last change of force
static void learn(int n, mjtNum* W, const mjtNum* da, const mjtNum* dforce) {
  mjtNum square = mju_dot(dforce, dforce, n);
  for (int i = 0; square > 0 && i < n; i++) {
    mjtNum missing = -da[i];
    for (int j = 0; j < n; j++) {
      missing -= W[i * n + j] * dforce[j];
    }
    for (int j = 0; j < n; j++) {
      W[i * n + j] += missing * dforce[j] / square;
    }
  }
}

// With constraints: ask for the answer to a set of forces, take it as linear, solve, ask again.
// The answer's slope lies between 0 and W, so this converges even with the plain W; the update
// makes it fast. scale: size of the accelerations that the answer is a difference of.
static int solve_constrained(const mjModel* m, mjData* d, const Answer* answer, const mjtNum* W,
                             const mjtNum* scale, const mjtNum* start, mjtNum* a, mjtNum* force) {
  int n = answer->n;
  mj_markStack(d);
  mjtNum* slope = mj_stackAllocNum(d, n * n);
  mjtNum* p = mj_stackAllocNum(d, n);
  mjtNum* asked = mj_stackAllocNum(d, n);
  mjtNum* answered = mj_stackAllocNum(d, n);
  mjtNum* change = mj_stackAllocNum(d, 2 * n);
  mjtNum* scratch = mj_stackAllocNum(d, n * (n + 4));
  mju_copy(slope, W, n * n);
  mju_copy(force, start, n);
  mju_zero(asked, n);
  mju_zero(answered, n);

  int fits = 0;
  for (int round = 0; !fits && round < CONSTRAINT_ROUNDS; round++) {
    mju_sub(change, force, asked, n);
    mju_copy(change + n, answered, n);
    mju_copy(asked, force, n);
    respond(m, d, answer, asked, answered);
    if (round) {
      mju_sub(change + n, answered, change + n, n);
      learn(n, slope, change + n, change);
    }
    if (round % 20 == 19 || (n == 1 && !(slope[0] >= 0 && slope[0] <= W[0]))) {
      mju_copy(slope, W, n * n);
    }

    // a = p - slope force near the forces asked for
    for (int i = 0; i < n; i++) {
      p[i] = answered[i] + mju_dot(slope + i * n, asked, n);
      a[i] = answered[i];
    }
    monotone_solve(law, answer->all, n, slope, p, a, force, scratch);

    // the engine's solver leaves an error of its own: what does not get better is good enough
    double allowed = round < 12 ? kFit : kLooseFit;
    fits = 1;
    for (int i = 0; i < n; i++) {
      mjtNum size = fabs(a[i]) + fabs(answered[i]) + scale[i], miss = 0;
      for (int j = 0; j < n; j++) {
        size += fabs(W[i * n + j] * force[j]);
        miss += W[i * n + j] * fabs(force[j] - asked[j]);
      }
      fits &= fabs(miss) <= allowed * size;
    }
  }
  mj_freeStack(d);
  return fits;
}

//------------------------------ solution ----------------------------------------------------------

// The forward pass from actuation on, without the forces that are sought, so that every other force
// is the engine's own. The engine comes back to this plugin on the way, which leaves the forces out
// then (Instance.probing). The discrete integrator builds its metric and its constraint rows in a
// place that only the whole pass reaches (a control callback is called once more then).
static void forward_without(const mjModel* m, mjData* d, int last) {
  mj_markStack(d);
  mjtNum* force = mj_stackAllocNum(d, m->nout);
  mju_copy(force, d->actuator_force, m->nout);
  Instance* self = instance_of(d, last);
  self->probing = 1;
  if (m->opt.integrator == mjINT_DISCRETE) {
    mj_forwardSkip(m, d, mjSTAGE_VEL, 1);
  } else {
    mj_fwdActuation(m, d);
    mj_fwdAcceleration(m, d);
  }
  self->probing = 0;

  // the outer pass goes on with the forces that it had
  mju_copy(d->actuator_force, force, m->nout);
  mj_freeStack(d);
}

// forces that the devices would have at the acceleration of the last step: a first guess for the
// constraint solver, which starts from the same place
static void guess(const mjModel* m, const mjData* d, const Answer* answer, mjtNum* force) {
  along(m, answer, d->qacc_warmstart, force);
  for (int i = 0; i < answer->n; i++) {
    force[i] = law(answer->all, i, force[i]);
  }
}

// hand the result to the actuator and remember it
static void apply(const mjModel* m, mjData* d, const Coupled* c, mjtNum a) {
  Instance* self = c->self;
  InerterForce force = force_at(c, a);
  d->actuator_force[m->actuator_outadr[self->actuator]] -= force.total - c->constant * a;
  if (c->h == 0) {
    force.friction += inerter_friction_force(&c->self->share, self->x, self->v, self->state);
  }
  self->applied = force;
  self->acceleration = a;
  self->mobility = c->mobility;
}

// whether the acceleration answers the forces by the metric alone: no constraints, and no free
// bodies whose gyroscopic terms the discrete integrator adds after its constraint solver
static int is_linear(const mjModel* m, const mjData* d, const Metric* metric) {
  int linear = !d->nefc;
  for (int j = 0; metric->kind == METRIC_DISCRETE && j < m->njnt; j++) {
    linear &= m->jnt_type[j] != mjJNT_FREE;
  }
  return linear;
}

void coupled_solve(const mjModel* m, mjData* d, int last) {
  int nv = m->nv;
  mj_markStack(d);
  Coupled* all = mj_stackAllocByte(d, (last + 1) * sizeof(Coupled), _Alignof(Coupled));
  int n = collect(m, d, last, all);
  if (!n) {
    mj_freeStack(d);
    return;
  }

  // the model without these forces
  Answer answer = {.n = n, .all = all};
  answer.J = mj_stackAllocNum(d, n * nv);
  answer.plain = mj_stackAllocNum(d, n * nv);
  answer.smooth = mj_stackAllocNum(d, nv);
  answer.free = mj_stackAllocNum(d, nv);
  answer.work = mj_stackAllocNum(d, 2 * nv);
  mjtNum* X = mj_stackAllocNum(d, n * nv);
  mjtNum* W = mj_stackAllocNum(d, n * n);
  mjtNum* p = mj_stackAllocNum(d, n);
  mjtNum* a = mj_stackAllocNum(d, n);
  mjtNum* force = mj_stackAllocNum(d, 2 * n);
  mjtNum* scale = mj_stackAllocNum(d, n);
  mjtNum* scratch = mj_stackAllocNum(d, n * (n + 4));
  forward_without(m, d, last);
  mju_copy(answer.smooth, d->qfrc_smooth, nv);
  mju_copy(answer.free, d->qacc_smooth, nv);
  answer.metric = metric_of_step(m, d);

  // acceleration along the devices: without the forces, and what each force takes away
  for (int i = 0; i < n; i++) {
    instance_moment(m, d, all[i].self, answer.J + i * nv);
  }
  metric_solve(m, d, &answer.metric, X, answer.J, n);
  if (metric_moves_qacc(&answer.metric)) {
    metric_solve(m, d, &answer.metric, answer.work, answer.smooth, 1);
    along(m, &answer, answer.work, p);
  } else {
    along(m, &answer, answer.free, p);
  }
  for (int i = 0; i < n; i++) {
    all[i].mobility = 0;
    for (int j = 0; j < n; j++) {
      W[i * n + j] = mju_dot(answer.J + i * nv, X + j * nv, nv);
      all[i].mobility += fabs(W[i * n + j]);
    }
  }

  mju_copy(a, p, n);
  int fits = 1;
  if (is_linear(m, d, &answer.metric)) {
    monotone_solve(law, all, n, W, p, a, force, scratch);
  } else {
    if (metric_moves_qacc(&answer.metric)) {
      mj_solveM(m, d, answer.plain, answer.J, n);
    } else {
      mju_copy(answer.plain, X, n * nv);
    }
    for (int i = 0; i < n; i++) {
      scale[i] = fabs(all[i].self->bias);
      for (int k = 0; k < nv; k++) {
        scale[i] += fabs(answer.J[i * nv + k] * answer.free[k]);
      }
    }
    guess(m, d, &answer, force + n);
    fits = solve_constrained(m, d, &answer, W, scale, force + n, a, force);
  }
  for (int i = 0; i < n; i++) {
    apply(m, d, all + i, a[i]);
    if (!fits) {
      instance_complain(m, all[i].self, COMPLAINT_FIT,
                        "force and acceleration of a step did not fit each other; shorten the "
                        "timestep or tighten <option tolerance> and iterations");
    }
  }
  mj_freeStack(d);
}
