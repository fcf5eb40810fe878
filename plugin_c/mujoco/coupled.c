// Forces that are found together with the acceleration: see coupled.h.
//
// Group by group (groups.h): without constraints as the few numbers that the devices' accelerations
// are (monotone.h), with constraints in the dofs of the group (constrained.h), whose solution the
// engine's solver starts from. Where it leaves it (noslip, no warm start, gyroscopic terms of
// `discrete`) it is asked what it makes of the forces, some rounds long, so that they fit the
// acceleration that it ends with.

#include "mujoco/coupled.h"

#include <math.h>

#include "mujoco/constrained.h"
#include "mujoco/engine_private.h"
#include "mujoco/groups.h"
#include "mujoco/metric.h"
#include "mujoco/monotone.h"
#include "mujoco/smooth.h"

// most rounds with the engine's constraint solver, the fit that ends them, and the worst that is
// one
enum { ENGINE_ROUNDS = 12 };
static const double kFit = 1e-9, kLooseFit = 1e-6;

// share of the largest acceleration of the model that counts beside those along a device
static const double kRounding = 1e-3;

// one device in the equations of coupled.h
typedef struct Coupled_ {
  Instance* self;
  mjtNum constant;  // inertance that the engine's matrix holds already [kg]
  InerterStep step;
} Coupled;

//------------------------------ laws --------------------------------------------------------------

static double law(const void* devices, int i, double a, double* rise) {
  const Coupled* c = (const Coupled*)devices + i;
  double force = inerter_step_force(&c->step, a, rise) - c->constant * a;
  *rise -= c->constant;
  return force;
}

// what of a device is the plugin's now
static const InerterDevice* present(const Instance* self) {
  return self->disabled ? &self->matter : &self->share;
}

static mjtNum length_of_step(const mjModel* m) {
  return m->opt.integrator == mjINT_RK4 ? 0 : m->opt.timestep;
}

int coupled_needed(const mjModel* m, const Instance* self) {
  const InerterDevice* share = present(self);
  int series = instance_has_series(share), inertance = share->inertance > 0 || self->replaced > 0;
  if (m->opt.integrator == mjINT_RK4) {
    return !series && (inertance || share->load_friction > 0);
  }
  return !self->native || series || inertance || share->load_friction > 0 ||
         instance_has_stop(share) || instance_has_sharp_friction(share) || self->stiff_bristle;
}

// whether the force over a step depends on how easily the terminals give way
static int asks_mobility(const Coupled* c) {
  const InerterDevice* device = present(c->self);
  return instance_has_series(device) || instance_has_bristle(device);
}

// the law of a device, its mobility known
static void begin(const mjModel* m, Coupled* c, mjtNum mobility) {
  Instance* self = c->self;
  mjtNum h = length_of_step(m);
  c->constant = self->replaced;
  self->mobility = mobility;
  if (h == 0) {
    mjtNum motion = self->disabled ? inerter_force_motion(&self->matter, self->x, self->v, NULL)
                                   : instance_force_motion(self);
    inerter_step_instant(&c->step, present(self), self->x, self->v, motion);
  } else {
    inerter_step_begin(&c->step, present(self), self->x, self->v, self->state, h, mobility);
  }
}

InerterForce coupled_force(const mjModel* m, const Instance* self) {
  mjtNum h = length_of_step(m), a = self->acceleration;
  return inerter_force_over_step(present(self), self->x, self->v, a, self->state, h, self->mobility,
                                 NULL);
}

//------------------------------ groups ------------------------------------------------------------

// all devices to solve for, and what is found of them
typedef struct Solution_ {
  int n;
  Coupled* all;
  int* moment;   // their rows of mjData.actuator_moment
  mjtNum* bias;  // acceleration that qvel alone causes
  mjtNum* a;     // acceleration along them
  mjtNum* force;
  mjtNum* smooth;  // smooth force of the model without theirs (nv), the shift in it
  mjtNum* shift;   // what the metric of the discrete integrator adds to it (nv)
  Metric metric;
  int ngroup;
  Group* groups;
  mjtNum** W;       // of each group: how its accelerations fall with its forces
  int constrained;  // 1: constraints act on some group
  int large;        // 1: on one too large to be solved here
} Solution;

// the devices to solve for
static void collect(const mjModel* m, mjData* d, int last, Solution* s) {
  s->n = 0;
  for (int k = 0; k <= last; k++) {
    if (!instance_is_device(m, k) || !instance_of(d, k)->solved) {
      continue;
    }
    Instance* self = instance_of(d, k);
    s->all[s->n].self = self;
    s->moment[s->n] = m->actuator_outadr[self->actuator];
    s->bias[s->n] = self->bias;
    s->n++;
  }
}

// all devices in one group: nothing to sort
static int is_whole(const Solution* s, const Group* group) {
  return group->n == s->n;
}

// the same for one group, its devices one after another
static Solution part_of(mjData* d, const Solution* s, const Group* group) {
  Solution part = *s;
  if (is_whole(s, group)) {
    return part;
  }
  int n = part.n = group->n;
  part.all = mj_stackAllocByte(d, (size_t)n * sizeof(Coupled), _Alignof(Coupled));
  part.moment = mj_stackAllocInt(d, n);
  part.bias = mj_stackAllocNum(d, n);
  part.a = mj_stackAllocNum(d, n);
  part.force = mj_stackAllocNum(d, n);
  for (int i = 0; i < n; i++) {
    part.all[i] = s->all[group->device[i]];
    part.moment[i] = s->moment[group->device[i]];
    part.bias[i] = s->bias[group->device[i]];
  }
  return part;
}

static void give_back(const Solution* part, const Group* group, Solution* s) {
  if (is_whole(s, group)) {
    return;
  }
  for (int i = 0; i < group->n; i++) {
    int k = group->device[i];
    s->all[k] = part->all[i];
    s->a[k] = part->a[i];
    s->force[k] = part->force[i];
  }
}

// W of the metric alone
static void find_mobilities(const mjModel* m, mjData* d, const Solution* part, const Group* group,
                            mjtNum* W) {
  int n = part->n;
  mj_markStack(d);
  mjtNum* J = mj_stackAllocNum(d, m->nv);
  mjtNum* x = mj_stackAllocNum(d, m->nv);
  for (int j = 0; j < n; j++) {
    for (int c = 0; c < group->ndof; c++) {
      J[group->dof[c]] = 0;
    }
    instance_add_moment(m, d, part->all[j].self, 1, J);
    metric_solve(m, d, &part->metric, group->ndof, group->dof, J, x);
    for (int i = 0; i < n; i++) {
      W[i * n + j] = instance_along(m, d, part->all[i].self, x);
    }
  }
  mj_freeStack(d);
}

static void begin_all(const mjModel* m, const Solution* part, const mjtNum* W) {
  for (int i = 0; i < part->n; i++) {
    mjtNum mobility = 0;
    for (int j = 0; W && j < part->n; j++) {
      mobility += fabs(W[i * part->n + j]);
    }
    begin(m, part->all + i, mobility);
  }
}

// acceleration of the last step, in its metric
static const mjtNum* last_acceleration(const mjModel* m, mjData* d, const Solution* part,
                                       const Group* group) {
  if (!metric_moves_qacc(&part->metric)) {
    return d->qacc_warmstart;
  }
  mjtNum* force = mj_stackAllocNum(d, m->nv);
  mjtNum* moved = mj_stackAllocNum(d, m->nv);
  mj_mulM(m, d, force, d->qacc_warmstart);
  metric_solve(m, d, &part->metric, group->ndof, group->dof, force, moved);
  return moved;
}

static int solve_free(const mjModel* m, mjData* d, Solution* part, const Group* group, mjtNum* W) {
  int n = part->n;
  find_mobilities(m, d, part, group, W);
  begin_all(m, part, W);

  // without the forces, and where the last step was
  mjtNum* p = mj_stackAllocNum(d, n);
  mjtNum* x = mj_stackAllocNum(d, m->nv);
  metric_solve(m, d, &part->metric, group->ndof, group->dof, part->smooth, x);
  int lines = 1;
  for (int i = 0; i < n; i++) {
    const Instance* self = part->all[i].self;
    p[i] = instance_along(m, d, self, x) + self->bias;
    lines &= inerter_step_is_line(&part->all[i].step);
  }
  mjtNum* scratch = mj_stackAllocNum(d, n * (n + 9));
  if (lines) {
    mjtNum *start = scratch, *rise = scratch + n;
    for (int i = 0; i < n; i++) {
      start[i] = law(part->all, i, 0, rise + i);
    }
    monotone_solve_lines(n, start, rise, W, p, part->a, part->force, scratch + 2 * n);
    return 0;
  }
  const mjtNum* last = last_acceleration(m, d, part, group);
  for (int i = 0; i < n; i++) {
    const Instance* self = part->all[i].self;
    part->a[i] = instance_along(m, d, self, last) + self->bias;
  }
  return monotone_solve(law, part->all, n, W, p, part->a, part->force, scratch);
}

static int solve_constrained(const mjModel* m, mjData* d, Solution* part, const Group* group,
                             mjtNum* W) {
  int asked = 0;
  for (int i = 0; i < part->n; i++) {
    asked |= asks_mobility(part->all + i);
  }
  if (asked) {
    find_mobilities(m, d, part, group, W);
  }
  begin_all(m, part, asked ? W : NULL);
  Constrained problem = {part->n, part->all, law, part->moment, part->bias};
  if (constrained_fits(m, d, group, part->n)) {
    return constrained_solve(m, d, &part->metric, group, &problem, part->smooth, part->a,
                             part->force, W);
  }

  // the engine is asked from the last step on
  part->large = 1;
  if (!asked) {
    find_mobilities(m, d, part, group, W);
  }
  for (int i = 0; i < part->n; i++) {
    mjtNum rise;
    const Instance* self = part->all[i].self;
    part->a[i] = instance_along(m, d, self, d->qacc_warmstart) + self->bias;
    part->force[i] = law(part->all, i, part->a[i], &rise);
  }
  return 0;
}

static void solve_groups(const mjModel* m, mjData* d, Solution* s) {
  for (int g = 0; g < s->ngroup; g++) {
    const Group* group = s->groups + g;
    mj_markStack(d);
    Solution part = part_of(d, s, group);
    int rounds = group->nrow ? solve_constrained(m, d, &part, group, s->W[g])
                             : solve_free(m, d, &part, group, s->W[g]);
    s->constrained |= group->nrow > 0;
    s->large |= part.large;
    for (int i = 0; i < part.n; i++) {
      part.all[i].self->solves++;
      part.all[i].self->stops += rounds < 0;
    }
    give_back(&part, group, s);
    mj_freeStack(d);
  }
}

//------------------------------ with the engine's solver ------------------------------------------

// whether the engine's acceleration is that of the solution, from which its solver starts
static int engine_is_exact(const mjModel* m, const Solution* s) {
  if (m->opt.disableflags & mjDSBL_ACTUATION) {
    return 1;  // it cannot be asked before it has added up its forces
  }
  if (s->metric.kind == METRIC_DISCRETE) {
    // free bodies: gyroscopic terms come after the constraints
    for (int j = 0; j < m->njnt; j++) {
      if (m->jnt_type[j] == mjJNT_FREE) {
        return 0;
      }
    }
  }
  return !s->constrained || !(m->opt.noslip_iterations || m->opt.disableflags & mjDSBL_WARMSTART);
}

// acceleration along the devices when they pull with these forces, in the engine's own words; size:
// of the accelerations that it is a difference of
static void respond(const mjModel* m, mjData* d, const Solution* s, const mjtNum* force, mjtNum* a,
                    mjtNum* size) {
  int nv = m->nv;
  mj_markStack(d);
  int* all = mj_stackAllocInt(d, nv);
  mjtNum* pull = mj_stackAllocNum(d, nv);
  mjtNum* qacc = mj_stackAllocNum(d, nv);
  for (int i = 0; i < nv; i++) {
    all[i] = i;
  }
  mju_zero(pull, nv);
  for (int i = 0; i < s->n; i++) {
    instance_add_moment(m, d, s->all[i].self, force[i], pull);
  }
  mju_sub(d->qfrc_smooth, s->smooth, pull, nv);
  int moves = metric_moves_qacc(&s->metric);
  if (moves) {
    mj_solveM(m, d, d->qacc_smooth, d->qfrc_smooth, 1);
  } else {
    metric_solve(m, d, &s->metric, nv, all, d->qfrc_smooth, d->qacc_smooth);
    mju_subFrom(d->qfrc_smooth, s->shift, nv);
  }
  mj_fwdConstraint(m, d);
  const mjtNum* found = d->qacc;
  if (moves) {
    mju_add(pull, d->qfrc_smooth, d->qfrc_constraint, nv);
    metric_solve(m, d, &s->metric, nv, all, pull, qacc);
    found = qacc;
  }
  // a body in free fall accelerates its joints by the rounding of its own acceleration alone
  mjtNum largest = 0;
  for (int i = 0; i < nv; i++) {
    largest = mju_max(largest, fabs(found[i]));
  }
  mju_fill(pull, kRounding * largest, nv);
  for (int i = 0; i < s->n; i++) {
    const Instance* self = s->all[i].self;
    a[i] = instance_along(m, d, self, found) + self->bias;
    size[i] = instance_along_size(m, d, self, found) + fabs(self->bias) +
              instance_along_size(m, d, self, pull);
  }
  mj_freeStack(d);
}

// Broyden's update: W such that it explains the last change of a by the last change of force
static void learn(int n, mjtNum* W, const mjtNum* da, const mjtNum* dforce) {
  mjtNum square = mju_dot(dforce, dforce, n);
  for (int i = 0; square > 0 && i < n; i++) {
    mjtNum missing = -da[i] - mju_dot(W + i * n, dforce, n);
    mju_addToScl(W + i * n, dforce, missing / square, n);
  }
}

// The forces of a group that fit the engine's answer to those asked, taken as linear; returns how
// far they are off, beside the accelerations and their size. part: a, force in: asked and answered;
// out: those that fit.
static double refit(mjData* d, Solution* part, const mjtNum* W, const mjtNum* scale) {
  int n = part->n;
  mjtNum* p = mj_stackAllocNum(d, n);
  mjtNum* asked = mj_stackAllocNum(d, n);
  mjtNum* answered = mj_stackAllocNum(d, n);
  mjtNum* scratch = mj_stackAllocNum(d, n * (n + 9));
  mju_copy(asked, part->force, n);
  mju_copy(answered, part->a, n);
  for (int i = 0; i < n; i++) {
    p[i] = answered[i] + mju_dot(W + i * n, asked, n);
  }
  monotone_solve(law, part->all, n, W, p, part->a, part->force, scratch);
  double worst = 0;
  for (int i = 0; i < n; i++) {
    double size = fabs(p[i]) + fabs(answered[i]) + scale[i] + mjMINVAL, miss = 0;
    for (int j = 0; j < n; j++) {
      size += fabs(W[i * n + j] * asked[j]);
      miss += W[i * n + j] * (part->force[j] - asked[j]);
    }
    worst = fmax(worst, fabs(miss) / size);
  }
  return worst;
}

// Ask the engine for the answer to a set of forces, solve with it, ask again; the best forces stay.
// Returns whether they fit.
static int fit_engine(const mjModel* m, mjData* d, Solution* s) {
  int n = s->n;
  mjtNum* asked = mj_stackAllocNum(d, n);
  mjtNum* answered = mj_stackAllocNum(d, n);
  mjtNum* before = mj_stackAllocNum(d, 2 * n);
  mjtNum* best = mj_stackAllocNum(d, 2 * n);
  mjtNum* size = mj_stackAllocNum(d, n);
  double least = INFINITY;
  mju_copy(asked, s->force, n);
  for (int round = 0; round < ENGINE_ROUNDS; round++) {
    respond(m, d, s, asked, answered, size);
    double worst = 0;
    for (int g = 0; g < s->ngroup; g++) {
      const Group* group = s->groups + g;
      mj_markStack(d);
      Solution part = part_of(d, s, group);
      mjtNum* da = mj_stackAllocNum(d, part.n);
      mjtNum* dforce = mj_stackAllocNum(d, part.n);
      mjtNum* scale = mj_stackAllocNum(d, part.n);
      for (int i = 0; i < part.n; i++) {
        int k = group->device[i];
        part.a[i] = answered[k];
        part.force[i] = asked[k];
        da[i] = answered[k] - before[k];
        dforce[i] = asked[k] - before[n + k];
        scale[i] = size[k];
      }
      if (round) {
        learn(part.n, s->W[g], da, dforce);
      }
      worst = fmax(worst, refit(d, &part, s->W[g], scale));
      give_back(&part, group, s);
      mj_freeStack(d);
    }
    if (worst < least) {
      least = worst;
      mju_copy(best, answered, n);
      mju_copy(best + n, asked, n);
    }
    if (least <= kFit) {
      break;
    }
    mju_copy(before, answered, n);
    mju_copy(before + n, asked, n);
    mju_copy(asked, s->force, n);
  }
  mju_copy(s->a, best, n);
  mju_copy(s->force, best + n, n);
  return least <= kLooseFit;
}

//------------------------------ solution ----------------------------------------------------------

static Solution prepare(const mjModel* m, mjData* d, int last) {
  int most = last + 1;
  Solution s = {0};
  s.all = mj_stackAllocByte(d, (size_t)most * sizeof(Coupled), _Alignof(Coupled));
  s.moment = mj_stackAllocInt(d, most);
  s.bias = mj_stackAllocNum(d, most);
  collect(m, d, last, &s);
  s.a = mj_stackAllocNum(d, s.n);
  s.force = mj_stackAllocNum(d, s.n);
  s.smooth = mj_stackAllocNum(d, m->nv);
  s.shift = mj_stackAllocNum(d, m->nv);
  smooth_without(m, d, last, s.smooth, s.shift);
  mju_addTo(s.smooth, s.shift, m->nv);
  s.metric = metric_of_step(m, d);
  s.groups = mj_stackAllocByte(d, (size_t)s.n * sizeof(Group), _Alignof(Group));
  s.ngroup = groups_find(m, d, &s.metric, s.n, s.moment, s.groups);
  s.W = mj_stackAllocByte(d, (size_t)s.ngroup * sizeof(mjtNum*), _Alignof(mjtNum*));
  for (int g = 0; g < s.ngroup; g++) {
    s.W[g] = mj_stackAllocNum(d, s.groups[g].n * s.groups[g].n);
  }
  return s;
}

void coupled_solve(const mjModel* m, mjData* d, int last) {
  int asked = 0;
  for (int k = 0; k <= last; k++) {
    asked |= instance_is_device(m, k) && instance_of(d, k)->solved;
  }
  if (!asked) {
    return;
  }
  mj_markStack(d);
  Solution s = prepare(m, d, last);
  solve_groups(m, d, &s);
  int fits = !s.large && engine_is_exact(m, &s) ? 1 : fit_engine(m, d, &s);
  for (int i = 0; i < s.n; i++) {
    Instance* self = s.all[i].self;
    self->acceleration = s.a[i];
    instance_pull(m, d, self, s.force[i]);
    if (!fits) {
      self->misfits++;
      instance_complain(m, self, COMPLAINT_FIT,
                        "force and acceleration of a step did not fit each other as well as they "
                        "should, because the engine's constraint solver stopped before its end; "
                        "raise <option iterations>, lower tolerance, or shorten the timestep");
    }
  }
  mj_freeStack(d);
}
