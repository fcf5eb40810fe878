// Forces that are found together with the acceleration: see coupled.h.
//
// Group by group (groups.h): devices on joints, without constraints, in their dofs (joints.h);
// without constraints as the few numbers that the devices' accelerations are (monotone.h), with
// constraints in the dofs of the group (constrained.h), whose solution the engine's solver starts
// from. Where it leaves it (noslip, no warm start, gyroscopic terms of `discrete`) it is asked what
// it makes of the forces, some rounds long, so that they fit the acceleration that it ends with.

#include "mujoco/coupled.h"

#include <math.h>

#include "mujoco/constrained.h"
#include "mujoco/damped.h"
#include "mujoco/engine_fit.h"
#include "mujoco/joints.h"
#include "mujoco/smooth.h"
#include "mujoco/solution.h"

// worst misfit of the acceleration of a step, over the size of its terms; of a velocity, its
// rounding over that
static const double kMisfit = 1e-6, kVelocityRounding = 1e-8;
// an acceleration that is none [m/s^2, rad/s^2]: of what rests all terms are rounding
static const double kAtRest = 1e-10;

//------------------------------ laws --------------------------------------------------------------

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
    return !series && (inertance || inerter_has_load_friction(share));
  }
  return !self->native || series || inertance || inerter_has_load_friction(share) ||
         instance_has_stop(share) || instance_has_branches(share) ||
         instance_has_sharp_friction(share) || self->stiff_bristle ||
         inerter_has_curve(share, INERTER_STROKE_viscous) || share->map.nvalue > 0 ||
         share->control == INERTER_CONTROL_viscous || inerter_shapes_damping(share);
}

// whether the force over a step depends on how easily the terminals give way
static int asks_mobility(const Coupled* c) {
  const InerterDevice* device = present(c->self);
  return instance_has_series(device) || instance_has_bristle(device) ||
         instance_has_branches(device);
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
    inerter_step_instant(&c->step, present(self), self->x, self->v, self->state, motion);
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

// the devices to solve for
static void collect(const mjModel* m, const mjData* d, int last, Solution* s) {
  s->n = 0;
  for (int k = 0; k <= last; k++) {
    if (!instance_is_device(m, k) || !instance_of(d, k)->solved) {
      continue;
    }
    Instance* self = instance_of(d, k);
    s->all[s->n] = (Coupled){.self = self};
    s->moment[s->n] = m->actuator_outadr[self->actuator];
    s->bias[s->n] = self->bias;
    s->n++;
  }
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
  solution_mobilities(m, d, part, group, W);
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
      start[i] = solution_law(part->all, i, 0, rise + i);
    }
    monotone_solve_lines(n, start, rise, W, p, part->a, part->force, scratch + 2 * n);
    return 0;
  }
  const mjtNum* last = last_acceleration(m, d, part, group);
  for (int i = 0; i < n; i++) {
    const Instance* self = part->all[i].self;
    part->a[i] = instance_along(m, d, self, last) + self->bias;
  }
  return monotone_solve(solution_law, part->all, n, W, p, solution_grains(d, part->all, n), part->a,
                        part->force, scratch);
}

static int solve_joints(const mjModel* m, mjData* d, Solution* part, const Group* group) {
  begin_all(m, part, NULL);
  Joints problem = {part->n, part->all, solution_law, 1, part->moment, part->bias};
  for (int i = 0; i < part->n; i++) {
    const Instance* self = part->all[i].self;
    problem.lines &= inerter_step_is_line(&part->all[i].step);
    part->a[i] = instance_along(m, d, self, d->qacc_warmstart) + self->bias;
  }
  return joints_solve(m, d, &part->metric, group, &problem, part->smooth, part->a, part->force);
}

static int solve_constrained(const mjModel* m, mjData* d, Solution* part, const Group* group,
                             mjtNum* W) {
  int asked = 0;
  for (int i = 0; i < part->n; i++) {
    asked |= asks_mobility(part->all + i);
  }
  if (asked) {
    solution_mobilities(m, d, part, group, W);
  }
  begin_all(m, part, asked ? W : NULL);
  Constrained problem = {part->n,      part->all,  solution_law,
                         part->moment, part->bias, solution_grains(d, part->all, part->n)};
  if (constrained_fits(m, d, group, part->n)) {
    return constrained_solve(m, d, &part->metric, group, &problem, part->smooth, part->a,
                             part->force, W);
  }

  // the engine is asked from the last step on
  part->large = 1;
  if (!asked) {
    solution_mobilities(m, d, part, group, W);
  }
  for (int i = 0; i < part->n; i++) {
    mjtNum rise;
    const Instance* self = part->all[i].self;
    part->a[i] = instance_along(m, d, self, d->qacc_warmstart) + self->bias;
    part->force[i] = solution_law(part->all, i, part->a[i], &rise);
  }
  return 0;
}

static void solve_groups(const mjModel* m, mjData* d, Solution* s) {
  for (int g = 0; g < s->ngroup; g++) {
    const Group* group = s->groups + g;
    mj_markStack(d);
    Solution part = solution_part(d, s, group);
    int rounds = s->on_joints  ? solve_joints(m, d, &part, group)
                 : group->nrow ? solve_constrained(m, d, &part, group, s->W[g])
                               : solve_free(m, d, &part, group, s->W[g]);
    s->constrained |= group->nrow > 0;
    s->large |= part.large;
    for (int i = 0; i < part.n; i++) {
      part.all[i].constrained = group->nrow > 0;
      part.all[i].stopped = rounds < 0;
    }
    solution_take(&part, group, s);
    mj_freeStack(d);
  }
}

// From the forces that constraints feel to those of the step, where its damping is in between.
static void take_damped_step(const mjModel* m, mjData* d, Solution* s) {
  for (int g = 0; g < s->ngroup; g++) {
    const Group* group = s->groups + g;
    mj_markStack(d);
    Solution part = solution_part(d, s, group);
    if (group->nrow) {
      for (int i = 0; i < part.n; i++) {
        part.a[i] = s->a[group->device[i]];
        part.force[i] = s->force[group->device[i]];
      }
      int rounds = damped_step(m, d, &part, group, s->W[g]);
      for (int i = 0; i < part.n; i++) {
        part.all[i].stopped |= rounds < 0;
        part.all[i].constrained = 0;
      }
      solution_take(&part, group, s);
    }
    mj_freeStack(d);
  }
}

//------------------------------ solution ----------------------------------------------------------

// whether every group can do without W; one that has constraints makes the others want theirs
static int all_on_joints(const mjModel* m, const mjData* d, const Solution* s) {
  for (int i = 0; i < s->n; i++) {
    if (asks_mobility(s->all + i)) {
      return 0;
    }
  }
  for (int g = 0; g < s->ngroup; g++) {
    if (!joints_fit(m, d, &s->metric, s->groups + g, s->moment)) {
      return 0;
    }
  }
  return 1;
}

static Solution prepare(const mjModel* m, mjData* d, int last) {
  int most = last + 1;
  Solution s = {0};
  s.all = mj_stackAllocByte(d, (size_t)most * sizeof(Coupled), _Alignof(Coupled));
  s.groups = mj_stackAllocByte(d, (size_t)most * sizeof(Group), _Alignof(Group));
  s.moment = mj_stackAllocInt(d, most);
  s.bias = mj_stackAllocNum(d, 3 * most + 2 * m->nv);
  s.a = s.bias + most;
  s.force = s.a + most;
  s.smooth = s.force + most;
  s.shift = s.smooth + m->nv;
  collect(m, d, last, &s);
  smooth_without(m, d, last, s.smooth, s.shift);
  mju_addTo(s.smooth, s.shift, m->nv);
  s.metric = metric_of_step(m, d);
  s.ngroup = groups_find(m, d, &s.metric, s.n, s.moment, s.groups);
  s.on_joints = all_on_joints(m, d, &s);
  if (s.on_joints) {
    return s;
  }
  metric_factor(m, d, &s.metric);
  s.W = (mjtNum**)mj_stackAllocByte(d, (size_t)s.ngroup * sizeof(mjtNum*), _Alignof(mjtNum*));
  for (int g = 0; g < s.ngroup; g++) {
    s.W[g] = mj_stackAllocNum(d, s.groups[g].n * s.groups[g].n);
  }
  return s;
}

static void count_misfit(const mjModel* m, Instance* self) {
  self->misfits++;
  self->misfit = 1;
  const char* text =
      "force and acceleration of a step did not fit each other as well as they should, because the "
      "engine's constraint solver stopped before its end; raise <option iterations>, lower "
      "tolerance, or shorten the timestep";
  if (m->opt.disableflags & mjDSBL_ACTUATION) {
    text =
        "force and acceleration of a step did not fit each other as well as they should: with all "
        "actuation disabled it is asked for its force before the engine knows what constraints "
        "answer; disable actuators by their groups, or take integrator RK4 or Euler without joint "
        "damping";
  }
  instance_complain(m, self, COMPLAINT_FIT, text);
}

void coupled_check(const mjModel* m, const mjData* d, Instance* self) {
  // trees that fall asleep stop
  int known = self->solved && m->opt.integrator != mjINT_RK4;
  if (!known || self->misfit || !d->nefc || m->opt.enableflags & mjENBL_SLEEP) {
    return;
  }
  mjtNum h = m->opt.timestep;
  mjtNum a = (instance_velocity(m, d, self) - self->v) / h + self->bias;
  mjtNum size = fabs(self->bias) + instance_along_size(m, d, self, d->qacc) +
                instance_along_size(m, d, self, d->qacc_smooth) +
                kVelocityRounding * instance_along_size(m, d, self, d->qvel) / h;
  if (fabs(a - self->acceleration) > kMisfit * size + kAtRest) {
    count_misfit(m, self);
  }
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
  Instance* keeper = instance_of(d, last);
  if (keeper->shifted) {
    mj_referenceConstraint(m, d);
    keeper->shifted = 0;
  }
  Solution s = prepare(m, d, last);
  solve_groups(m, d, &s);
  int fits = !s.large && engine_fit_is_exact(m, &s) ? 1 : engine_fit(m, d, &s);
  keeper->shifted = s.constrained && metric_moves_qacc(&s.metric);
  if (keeper->shifted) {
    take_damped_step(m, d, &s);
    fits = !s.large && engine_fit_is_exact(m, &s) ? 1 : engine_fit(m, d, &s);
  }
  for (int i = 0; i < s.n; i++) {
    Instance* self = s.all[i].self;
    self->solves++;
    self->stops += s.all[i].stopped;
    self->acceleration = s.a[i];
    instance_pull(m, d, self, s.force[i]);
    self->misfit = 0;
    if (!fits) {
      count_misfit(m, self);
    }
  }
  mj_freeStack(d);
}
