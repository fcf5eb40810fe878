// Maxwell-slip friction: springs side by side, each of which slips at a force of its own.
//
//   z_i' = v                       while element i sticks: u_i > 0
//   z_i' = v min(u_i, 0)           at its limit, or beyond
//   u_i  = 1 - k_i z_i sgn(v) / (f_i level),  level + load / sum of f_i under a load
//   F    = sum of k_i z_i
//
// z_i [m] deflection of element i; k_i [N/m] slip_stiffness_i, f_i [N] slip_force_i, level:
// friction.h, load [N]: load_friction.c. Elements 1 to 8, numbered without a gap. Stored energy:
// sum of k_i z_i^2 / 2. Breakaway and sliding: sum of f_i. From rest F(x) is a polygon with corners
// at f_i / k_i. Why: one bristle (dahl.c, lugre.c, bouc_wen.c) has one number of memory, and
// forgets a loop within a loop. Here every reversal is remembered until a larger one wipes it out,
// and loops between the same ends are congruent: hysteresis with non-local memory (Masing's rules).
// Rate-independent. An element is beyond its limit only where the level has just fallen (along the
// stroke, with the direction); it comes back along a path of f_i / k_i, without giving energy.
// Exact at constant v and level. Passive.
// Source: Iwan 1966; Lampaert, Al-Bender, Swevers 2003 (without its sliding dynamics); Masing 1926.
// Not modelled: Stribeck effect, micro-damping, free play before the elements.

#include "laws.h"

// u of an element at its limit, but for rounding: it stays there
static const double kReached = 1e-12;

double slip_level(const InerterDevice* p) {
  double sum = 0;
  for (int i = 0; i < slip_count(p); i++) {
    sum += slip_element(p, i)[1];
  }
  return sum;
}

int slip_count(const InerterDevice* p) {
  int count = 0;
  while (count < INERTER_MAXSLIP && slip_element(p, count)[0] > 0) {
    count++;
  }
  return count;
}

// level of every element; a load raises the sum of the slip forces
static double level_at(const InerterDevice* p, double x, double v, double load) {
  double level = friction_level(p, x, v);
  return load == 0 ? level : level + load / slip_level(p);
}

static void rate(const InerterDevice* p, double x, double v, const double* z, double load,
                 double* rates) {
  double level = level_at(p, x, v, load), side = sign(v);
  for (int i = 0; i < p->nfriction; i++) {
    const double* element = slip_element(p, i);
    double u = 1 - element[0] * z[i] * side / (element[1] * level);
    rates[i] = u > kReached ? v : v * u;
  }
}

static void step(const InerterDevice* p, double x, double v, double* z, double h, double load) {
  if (v == 0) {
    return;
  }
  double level = level_at(p, x, v, load), side = sign(v), path = fabs(v) * h;
  for (int i = 0; i < p->nfriction; i++) {
    const double* element = slip_element(p, i);
    double limit = element[1] * level / element[0], q = side * z[i];
    z[i] = side * (q > limit ? limit + (q - limit) * exp(-path / limit) : fmin(q + path, limit));
  }
}

static double force(const InerterDevice* p, const double* z) {
  double sum = 0;
  for (int i = 0; i < p->nfriction; i++) {
    sum += slip_element(p, i)[0] * z[i];
  }
  return sum;
}

static double energy(const InerterDevice* p, const double* z) {
  double sum = 0;
  for (int i = 0; i < p->nfriction; i++) {
    sum += 0.5 * slip_element(p, i)[0] * z[i] * z[i];
  }
  return sum;
}

static double stored_power(const InerterDevice* p, const double* z, const double* rates) {
  double sum = 0;
  for (int i = 0; i < p->nfriction; i++) {
    sum += slip_element(p, i)[0] * z[i] * rates[i];
  }
  return sum;
}

// An element slips by what the path has more than its deflection. Its limit goes in a line from
// that of the start to where it ends, and it slips at that force from where it reaches it; from
// beyond its limit l it comes back with q = l (1 - q') over the path. The power of an instant tells
// none of that: where the limit has just risen, no element is at it.
static double heat(const InerterDevice* p, double x, double path, const double* z,
                   const double* end, double load) {
  double level = level_at(p, x, path, load), side = sign(path), length = fabs(path), sum = 0;
  for (int i = 0; i < p->nfriction; i++) {
    const double* element = slip_element(p, i);
    double first = side * z[i], last = side * end[i], limit = element[1] * level / element[0];
    double slip = length - (last - first);
    if (slip <= kReached * length) {
      continue;
    }
    if (first > last) {
      double toward = fmin(last, 0.5 * (first + last) * length / slip);
      sum += element[0] * (toward * slip + 0.5 * (first * first - last * last));
      continue;
    }
    double reached = first;
    if (first < limit) {
      double approach = 1 - (last - limit) / length;
      reached = approach > 0 ? clamp(first + (limit - first) / approach, first, last) : last;
    }
    sum += element[0] * 0.5 * (reached + last) * slip;
  }
  return sum;
}

static double stiffness(const InerterDevice* p) {
  double sum = 0;
  for (int i = 0; i < p->nfriction; i++) {
    sum += slip_element(p, i)[0];
  }
  return sum;
}

// on the curve from rest: one deflection for all, those at their limit left behind
static void of_force(const InerterDevice* p, double x, double v, double wanted, double load,
                     double* z) {
  double level = level_at(p, x, v, load), side = sign(wanted), deflection = 0;
  for (int round = 0; round <= p->nfriction; round++) {
    double rest = fabs(wanted), stiff = 0;
    for (int i = 0; i < p->nfriction; i++) {
      const double* element = slip_element(p, i);
      if (element[0] * deflection >= element[1] * level && round) {
        rest -= element[1] * level;
      } else {
        stiff += element[0];
      }
    }
    deflection = stiff > 0 && isfinite(rest) ? fmax(deflection, rest / stiff) : deflection;
  }
  for (int i = 0; i < p->nfriction; i++) {
    const double* element = slip_element(p, i);
    z[i] = side * fmin(deflection, element[1] * level / element[0]);
  }
}

static void along(const InerterDevice* p, const FrictionPath* path, double* z, double* forces) {
  const double *x = path->x, *v = path->v;
  double rest = p->rest_length;
  int n = p->nfriction;
  for (int i = path->first; i < path->last; i++) {
    if (i) {
      Leg legs[2];
      int count = legs_between(x + i - 1, v + i - 1, path->h, legs);
      for (int k = 0; k < count; k++) {
        const Leg* leg = legs + k;
        step(p, middle_of(leg) - rest, mean_velocity(leg), z, leg->time, 0);
      }
    }
    forces[i - path->first] = force(p, z);
    for (int k = 0; k < n && path->states; k++) {
      path->states[(size_t)i * (size_t)path->apart + (size_t)k] = z[k];
    }
  }
}

static const FrictionStates kStates = {
    .rate = rate,
    .step = step,
    .force = force,
    .energy = energy,
    .stored_power = stored_power,
    .heat = heat,
    .of_force = of_force,
};

const FrictionLaw inerter_maxwell_slip = {
    .stiffness = stiffness, .along = along, .several = &kStates};
