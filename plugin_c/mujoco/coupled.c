// Forces that are found together with the acceleration: see coupled.h.

#include "mujoco/coupled.h"

#include <math.h>

#include "mujoco/engine_private.h"
#include "mujoco/groups.h"
#include "mujoco/metric.h"
#include "mujoco/monotone.h"
#include "mujoco/smooth.h"

// most rounds with the engine's constraint solver, and the fits that end them, early and late
enum { CONSTRAINT_ROUNDS = 60 };
static const double kFit = 1e-10, kStalledFit = 1e-8, kLooseFit = 1e-7;

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
  int affine;        // 1: its force is start + rise a
  mjtNum start, rise;
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
  return c->affine ? c->start + c->rise * a : force_at(c, a).total - c->constant * a;
}

static double law_slope(const void* devices, int i, double a, double force) {
  const Coupled* c = (const Coupled*)devices + i;
  double difference = 1e-6 * (1 + fabs(a));
  return c->affine ? c->rise : (law(devices, i, a + difference) - force) / difference;
}

// the force as a line, where it is one
static void draw_line(Coupled* c) {
  const Instance* self = c->self;
  if (c->h > 0) {
    c->affine = inerter_line_over_step(&self->share, self->x, self->v, c->h, &c->start, &c->rise);
  } else {
    c->affine = c->load == 0;
    c->start = c->motion + c->rest;
    c->rise = c->inertance;
  }
  c->rise -= c->constant;
}

int coupled_needed(const mjModel* m, const Instance* self) {
  const InerterDevice* share = &self->share;
  int series = instance_has_series(share), inertance = share->inertance > 0 || self->replaced > 0;
  if (m->opt.integrator == mjINT_RK4) {
    return !series && (inertance || share->load_friction > 0);
  }
  return !self->native || series || inertance || share->load_friction > 0 ||
         instance_has_stop(share) || instance_has_sharp_friction(share);
}

// a device at the last evaluation, its mobility not known yet
static Coupled at_present(const mjModel* m, Instance* self) {
  Coupled c = {.self = self, .constant = self->replaced};
  c.h = m->opt.integrator == mjINT_RK4 ? 0 : m->opt.timestep;
  if (c.h == 0) {
    c.inertance = inerter_inertance(&self->share, self->x, self->v, &c.rest);
    c.motion = instance_force_motion(self);
    c.load = inerter_load_factor(&self->share, self->v);
  }
  return c;
}

// the devices to solve for
static int collect(const mjModel* m, const mjData* d, int last, Coupled* all) {
  int n = 0;
  for (int k = 0; k <= last; k++) {
    if (instance_is_device(m, k) && instance_of(d, k)->solved) {
      all[n] = at_present(m, instance_of(d, k));
      draw_line(all + n++);
    }
  }
  return n;
}

//------------------------------ what the model answers --------------------------------------------

// the model seen from the devices, which stand group by group
typedef struct Answer_ {
  int n;
  const Coupled* all;
  int ngroup;
  const Group* groups;
  Metric metric;
  mjtNum* W;       // acceleration that the forces take away, n_g x n_g for each group [1/kg]
  mjtNum* smooth;  // smooth force and acceleration without the devices' forces (nv each)
  mjtNum* free;
  mjtNum* work;  // 2 nv
} Answer;

// acceleration along the devices for the acceleration of the model
static void along(const mjModel* m, const mjData* d, const Answer* answer, const mjtNum* qacc,
                  mjtNum* a) {
  for (int i = 0; i < answer->n; i++) {
    const Instance* self = answer->all[i].self;
    a[i] = instance_along(m, d, self, qacc) + self->bias;
  }
}

// acceleration along the devices when they pull with these forces, constraints answering
static void respond(const mjModel* m, mjData* d, const Answer* answer, const mjtNum* force,
                    mjtNum* a) {
  int nv = m->nv;
  mjtNum *pull = answer->work, *qacc = answer->work + nv;
  mju_zero(pull, nv);
  for (int i = 0; i < answer->n; i++) {
    instance_add_moment(m, d, answer->all[i].self, force[i], pull);
  }
  mju_sub(d->qfrc_smooth, answer->smooth, pull, nv);

  // what the constraint solver sees: the metric of the discrete integrator, else the inertia
  if (metric_moves_qacc(&answer->metric)) {
    mj_solveM(m, d, qacc, pull, 1);
  } else {
    metric_solve(m, d, &answer->metric, qacc, pull, 1);
  }
  mju_sub(d->qacc_smooth, answer->free, qacc, nv);
  mj_fwdConstraint(m, d);
  if (!metric_moves_qacc(&answer->metric)) {
    along(m, d, answer, d->qacc, a);
    return;
  }
  mjtNum* total = answer->work;
  mju_add(total, d->qfrc_smooth, d->qfrc_constraint, nv);
  metric_solve(m, d, &answer->metric, qacc, total, 1);
  along(m, d, answer, qacc, a);
}

// W of every group: the k-th devices of all groups are asked at once, since no force of one group
// moves another
static void find_mobilities(const mjModel* m, mjData* d, Coupled* all, const Answer* answer) {
  int nv = m->nv, most = 0;
  for (int g = 0; g < answer->ngroup; g++) {
    most = mjMAX(most, answer->groups[g].n);
  }
  mj_markStack(d);
  mjtNum* J = mj_stackAllocNum(d, most * nv);
  mjtNum* X = mj_stackAllocNum(d, most * nv);
  mju_zero(J, most * nv);
  for (int g = 0; g < answer->ngroup; g++) {
    const Group* group = answer->groups + g;
    for (int k = 0; k < group->n; k++) {
      instance_add_moment(m, d, all[group->first + k].self, 1, J + k * nv);
    }
  }
  metric_solve(m, d, &answer->metric, X, J, most);
  mjtNum* W = answer->W;
  for (int g = 0; g < answer->ngroup; g++) {
    Coupled* devices = all + answer->groups[g].first;
    int n = answer->groups[g].n;
    for (int i = 0; i < n; i++) {
      devices[i].mobility = 0;
      for (int j = 0; j < n; j++) {
        W[i * n + j] = instance_along(m, d, devices[i].self, X + j * nv);
        devices[i].mobility += fabs(W[i * n + j]);
      }
    }
    W += n * n;
  }
  mj_freeStack(d);
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
static int solve_constrained(const mjModel* m, mjData* d, const Answer* answer, int nW,
                             int nscratch, const mjtNum* scale, const mjtNum* start, mjtNum* a,
                             mjtNum* force) {
  int all = answer->n;
  mj_markStack(d);
  mjtNum* slopes = mj_stackAllocNum(d, nW);
  mjtNum* p = mj_stackAllocNum(d, all);
  mjtNum* asked = mj_stackAllocNum(d, all);
  mjtNum* answered = mj_stackAllocNum(d, all);
  mjtNum* change = mj_stackAllocNum(d, 2 * all);
  mjtNum* scratch = mj_stackAllocNum(d, nscratch);
  mju_copy(slopes, answer->W, nW);
  mju_copy(force, start, all);
  mju_zero(asked, all);
  mju_zero(answered, all);

  int fits = 0;
  for (int round = 0; !fits && round < CONSTRAINT_ROUNDS; round++) {
    mju_sub(change, force, asked, all);
    mju_copy(change + all, answered, all);
    mju_copy(asked, force, all);
    respond(m, d, answer, asked, answered);
    mju_sub(change + all, answered, change + all, all);

    // the engine's solver leaves an error of its own: what does not get better is good enough
    double allowed = round < 12 ? kFit : round < 24 ? kStalledFit : kLooseFit;
    fits = 1;
    mjtNum* slope = slopes;
    const mjtNum* W = answer->W;
    for (int g = 0; g < answer->ngroup; g++) {
      int first = answer->groups[g].first, n = answer->groups[g].n, end = first + n;
      if (round) {
        learn(n, slope, change + all + first, change + first);
      }
      if (round % 20 == 19 || (n == 1 && !(slope[0] >= 0 && slope[0] <= W[0]))) {
        mju_copy(slope, W, n * n);
      }

      // a = p - slope force near the forces asked for
      for (int i = first; i < end; i++) {
        p[i] = answered[i] + mju_dot(slope + (i - first) * n, asked + first, n);
        a[i] = answered[i];
      }
      monotone_solve(law, law_slope, answer->all + first, n, slope, p + first, a + first,
                     force + first, scratch);
      for (int i = first; i < end; i++) {
        const mjtNum* row = W + (i - first) * n;
        mjtNum size = fabs(a[i]) + fabs(answered[i]) + scale[i], miss = 0;
        for (int j = first; j < end; j++) {
          size += fabs(row[j - first] * force[j]);
          miss += row[j - first] * fabs(force[j] - asked[j]);
        }
        fits &= fabs(miss) <= allowed * size;
      }
      slope += n * n;
      W += n * n;
    }
  }
  mj_freeStack(d);
  return fits;
}

//------------------------------ solution ----------------------------------------------------------

// forces that the devices would have at the acceleration of the last step: a first guess for the
// constraint solver, which starts from the same place
static void guess(const mjModel* m, const mjData* d, const Answer* answer, mjtNum* force) {
  along(m, d, answer, d->qacc_warmstart, force);
  for (int i = 0; i < answer->n; i++) {
    force[i] = law(answer->all, i, force[i]);
  }
}

// hand the result to the actuator and remember it
static void apply(const mjModel* m, mjData* d, const Coupled* c, mjtNum a, mjtNum force) {
  Instance* self = c->self;
  d->actuator_force[m->actuator_outadr[self->actuator]] -= force;
  self->acceleration = a;
  self->mobility = c->mobility;
}

InerterForce coupled_force(const mjModel* m, const Instance* self) {
  Coupled c = at_present(m, (Instance*)self);
  c.mobility = self->mobility;
  InerterForce force = force_at(&c, self->acceleration);
  if (c.h == 0) {
    force.friction += inerter_friction_force(&self->share, self->x, self->v, self->state);
  }
  return force;
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

// the devices group by group; returns how many groups
static int grouped(const mjModel* m, mjData* d, const Metric* metric, int n, Coupled* all,
                   Group* groups) {
  mj_markStack(d);
  int* row = mj_stackAllocInt(d, n);
  int* order = mj_stackAllocInt(d, n);
  Coupled* before = mj_stackAllocByte(d, n * sizeof(Coupled), _Alignof(Coupled));
  for (int i = 0; i < n; i++) {
    row[i] = m->actuator_outadr[all[i].self->actuator];
    before[i] = all[i];
  }
  int count = groups_find(m, d, metric, n, row, order, groups);
  for (int i = 0; i < n; i++) {
    all[i] = before[order[i]];
  }
  mj_freeStack(d);
  return count;
}

void coupled_solve(const mjModel* m, mjData* d, int last) {
  int nv = m->nv, asked = 0;
  for (int k = 0; k <= last; k++) {
    asked |= instance_is_device(m, k) && instance_of(d, k)->solved;
  }
  if (!asked) {
    return;
  }
  mj_markStack(d);
  Coupled* all = mj_stackAllocByte(d, (last + 1) * sizeof(Coupled), _Alignof(Coupled));
  int n = collect(m, d, last, all);

  // the model without these forces
  Answer answer = {.n = n, .all = all};
  answer.smooth = mj_stackAllocNum(d, nv);
  answer.free = mj_stackAllocNum(d, nv);
  answer.work = mj_stackAllocNum(d, 2 * nv);
  mjtNum* p = mj_stackAllocNum(d, n);
  mjtNum* a = mj_stackAllocNum(d, n);
  mjtNum* force = mj_stackAllocNum(d, 2 * n);
  mjtNum* scale = mj_stackAllocNum(d, n);
  Group* groups = mj_stackAllocByte(d, n * sizeof(Group), _Alignof(Group));
  smooth_without(m, d, last, answer.smooth, answer.free);
  answer.metric = metric_of_step(m, d);
  answer.groups = groups;
  answer.ngroup = grouped(m, d, &answer.metric, n, all, groups);
  int nW = 0, nscratch = 0;
  for (int g = 0; g < answer.ngroup; g++) {
    nW += groups[g].n * groups[g].n;
    nscratch = mjMAX(nscratch, groups[g].n * (groups[g].n + 4));
  }
  answer.W = mj_stackAllocNum(d, nW);
  mjtNum* scratch = mj_stackAllocNum(d, nscratch);

  // acceleration along the devices: without the forces, and what each force takes away
  find_mobilities(m, d, all, &answer);
  if (metric_moves_qacc(&answer.metric)) {
    metric_solve(m, d, &answer.metric, answer.work, answer.smooth, 1);
    along(m, d, &answer, answer.work, p);
  } else {
    along(m, d, &answer, answer.free, p);
  }

  mju_copy(a, p, n);
  int fits = 1;
  if (is_linear(m, d, &answer.metric)) {
    const mjtNum* W = answer.W;
    for (int g = 0; g < answer.ngroup; g++) {
      int first = groups[g].first, size = groups[g].n;
      monotone_solve(law, law_slope, all + first, size, W, p + first, a + first, force + first,
                     scratch);
      W += size * size;
    }
  } else {
    for (int i = 0; i < n; i++) {
      const Instance* self = all[i].self;
      scale[i] = instance_along_size(m, d, self, answer.free) + fabs(self->bias);
    }
    guess(m, d, &answer, force + n);
    fits = solve_constrained(m, d, &answer, nW, nscratch, scale, force + n, a, force);
  }
  for (int i = 0; i < n; i++) {
    apply(m, d, all + i, a[i], force[i]);
    if (!fits) {
      instance_complain(m, all[i].self, COMPLAINT_FIT,
                        "force and acceleration of a step did not fit each other; shorten the "
                        "timestep or tighten <option tolerance> and iterations");
    }
  }
  mj_freeStack(d);
}
