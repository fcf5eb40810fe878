// Rate-and-state friction: a level that falls with the logarithm of speed and grows with that of
// the time at rest.
//
//   F  = f_c max(0.001, 1 + A ln(sqrt(v^2 + v_t^2) / v_0) + B z) tanh(v / v_t)
//   z' = (v_0 / L) exp(-z) - |v| / L          (theta' = 1 - |v| theta / L,  z = ln(theta v_0 / L))
//
// z [1] logarithm of the age theta [s] of the contacts, of which it is 0 where they slide steadily
// at v_0; f_c [N] coulomb_force, the level there (times the level of friction.h); A [1]
// rate_effect, B [1] age_effect; v_0 [m/s] rate_velocity, L [m] age_distance, the way that renews
// the contacts; v_t [m/s] transition_velocity, at which the logarithm ends. Stored energy 0:
// passive. Steady sliding: f_c (1 + (A - B) ln(v / v_0)), which falls with the speed where B > A.
// From v_1 to v_2 at once: a jump of f_c A ln(v_2 / v_1), then back by f_c B over the way L. At
// rest for a time t theta grows by t: the next breakaway is higher by f_c B ln(1 + t / theta).
// Exact at constant v. The force rises with v at a given z: a step takes z at its start.
// Source: Dieterich 1979, Ruina 1983 (aging law); the regularisation is that of the other laws'
// sign(v) and no thermally activated creep (Rice, Lapusta, Ranjith 2001).
// Not modelled: pre-sliding displacement, effects of the normal force's changes (Linker-Dieterich).

#include "friction_block.h"

static const double kLeast = 1e-3;
static const double kYoungest = -300;  // of z; its rate stays a number
static const double kPlain = 600;      // of |z|, beyond which exp(z) comes near to no number

// what the logarithms make of the level
static double factor(const InerterDevice* p, double v, double z) {
  double speed = sqrt(v * v + p->transition_velocity * p->transition_velocity);
  return 1 + p->rate_effect * log(speed / p->rate_velocity) + p->age_effect * z;
}

double rate_state_factor(const InerterDevice* p, double v, double z) {
  return fmax(kLeast, factor(p, v, z));
}

static double rate(const InerterDevice* p, double x, double v, double z, double load) {
  (void)x;
  (void)load;
  return (p->rate_velocity * exp(-fmax(kYoungest, z)) - fabs(v)) / p->age_distance;
}

// exact at constant v: theta decays towards L / |v|, or grows with the time
static double step(const InerterDevice* p, double x, double v, double z, double h, double load) {
  (void)x;
  (void)load;
  if (h == 0) {
    return z;
  }
  double way = fabs(v) * h / p->age_distance, fresh = p->rate_velocity * h / p->age_distance;
  fresh *= way > 0 ? -expm1(-way) / way : 1;

  // ln(exp(old) + fresh)
  double old = z - way, young = log(fresh);
  double most = fmax(old, young);
  return most + log1p(exp(fmin(old, young) - most));
}

static double force(const InerterDevice* p, double x, double v, double z, double load) {
  (void)load;
  double level = p->coulomb_force * friction_level(p, x, v);
  return level * fmax(kLeast, factor(p, v, z)) * friction_direction(p, v);
}

// the force at the state of the start, with its slope over v but for that of the level's asymmetry
static double over_step(const InerterDevice* p, double x, double v, double z, double h,
                        double share, double* slope) {
  (void)h;
  (void)share;
  double level = p->coulomb_force * friction_level(p, x, v), width = p->transition_velocity;
  double direction = friction_direction(p, v), bare = factor(p, v, z), size = fmax(kLeast, bare);
  double turn = bare > kLeast ? p->rate_effect * v / (v * v + width * width) : 0;
  *slope = level * (turn * direction + size * (1 - direction * direction) / width);
  return level * size * direction;
}

static double energy(const InerterDevice* p, double x, double z) {
  (void)p;
  (void)x;
  (void)z;
  return 0;
}

static double stiffness(const InerterDevice* p) {
  (void)p;
  return 0;
}

// as step and force, in exp(z), of which every sample takes a share and to which it adds
static SEVERAL_AT_ONCE void along(const InerterDevice* p, const FrictionPath* path, double* z,
                                  double* forces) {
  if (!(fabs(*z) < kPlain)) {
    friction_along(p, path, z, forces, step, force);
    return;
  }
  FrictionSamples to, at;
  double left[FRICTION_BLOCK] = {0}, fresh[FRICTION_BLOCK] = {0}, level[FRICTION_BLOCK];
  double aged = p->rate_velocity * path->h / p->age_distance;
  samples_between(p, path, &to);
  for (int i = 0; i < to.size; i++) {
    double way = fabs(to.v[i]) * path->h / p->age_distance;
    left[i] = elementary_exp(-way);
    fresh[i] = way > 0 ? aged * (-elementary_expm1(-way) / way) : aged;
  }
  if (path->first == 0) {
    left[0] = 1;
    fresh[0] = 0;
  }
  double state[FRICTION_BLOCK] = {0}, now = exp(*z);
  for (int i = 0; i < to.size; i++) {
    now = may_turn(path, i) ? exp(step_to(p, path, i, log(now), step)) : now * left[i] + fresh[i];
    state[i] = now;
  }
  samples_at(p, path, &at);
  levels_at(p, &at, level);
  double width = p->transition_velocity;
  for (int i = 0; i < at.size; i++) {
    double speed = sqrt(at.v[i] * at.v[i] + width * width);
    state[i] = log(state[i]);
    double raised = p->rate_effect * log(speed / p->rate_velocity) + p->age_effect * state[i];
    forces[i] = p->coulomb_force * level[i] * larger(kLeast, 1 + raised);
  }
  for (int i = 0; i < at.size; i++) {
    forces[i] *= friction_direction(p, at.v[i]);
  }
  if (path->first > 0 || to.size > 1) {
    *z = log(now);
  }
  keep_states(path, state);
}

const FrictionLaw inerter_rate_state = {
    .rate = rate,
    .step = step,
    .force = force,
    .energy = energy,
    .stiffness = stiffness,
    .along = along,
    .over_step = over_step,
};
