// Bouc-Wen hysteresis.
//
//   z' = alpha v - beta |v| z |z|^(n-1) - gamma v |z|^n
//   F  = A k0 x + (1 - A) k0 z
//
// z [m]; alpha [-] bw_alpha, beta, gamma [m^-n] bw_beta, bw_gamma, n bw_exponent; k0 [N/m]
// bw_stiffness, A [-] bw_ratio. Stored energy A k0 x^2 / 2 + (1 - A) k0 z^2 / (2 alpha).
// With beta >= 0 and beta + gamma > 0, |z| stays below (alpha / (beta + gamma))^(1/n); passive for
// beta >= |gamma| and 0 <= A <= 1.
// Source: Bouc 1967, Wen 1976; eq. (12)-(13) of the hysteretic inerter paper. The parameters are
// redundant: scaling z changes alpha, beta, gamma, k0 and leaves F alone.
// Along the stroke (friction.h), and under a load (load_friction.c), which raises the yield force
// abs(1 - A) k0 (alpha / (beta + gamma))^(1/n), beta and gamma are divided by level^n: |z| yields
// at that share of where it did, with the same stiffness and the same stored energy. Where the
// level has fallen below |z|, z comes back no slower than from the level: for gamma > beta the law
// by itself would let it run away. Free play before the yielding share: friction_play.c. Not
// modelled: pinching, degradation.

#include "friction_block.h"

// share of the limit of z that it may be off to slide: less than what the sub-steps leave
#define SLIDING 1e-14

// how beta and gamma slow z down that grows, or that comes back, for a level of 1
static INLINED double slowing(const InerterDevice* p, int loading) {
  return loading ? p->bw_gamma + p->bw_beta : p->bw_gamma - p->bw_beta;
}

// the least slope with which z comes back where gamma > beta: that at its level
static INLINED double least_return(const InerterDevice* p) {
  double limit = slowing(p, 1), back = slowing(p, 0);
  return limit > 0 && back > 0 ? p->bw_alpha * (1 - back / limit) : -INFINITY;
}

// |z| at which it yields
static double bound_of(const InerterDevice* p, double narrow) {
  return pow(p->bw_alpha / (slowing(p, 1) * narrow), 1 / p->bw_exponent);
}

double bouc_wen_level(const InerterDevice* p) {
  return fabs(1 - p->bw_ratio) * p->bw_stiffness * bound_of(p, 1);
}

// z' along the path: rate per unit |v| in direction s = sgn(v), and its slope over z. `loading`: z
// has the direction of s, or is 0 and about to have it; else it has the other one.
// c: narrowing of the law, `narrow` that of the level.
static double slope(const InerterDevice* p, double narrow, double s, double z, int loading,
                    double* derivative) {
  double n = p->bw_exponent;
  double c = slowing(p, loading) * narrow;
  double power = n == 1 ? 1 : pow(fabs(z), n - 1);
  *derivative = (loading ? -c : c) * n * power;
  return s * (p->bw_alpha - c * power * fabs(z));
}

// level, raised by a load, and what it makes of beta and gamma
static double level_at(const InerterDevice* p, double x, double v, double load) {
  double level = p->parts & PART_FRICTION_CURVE ? friction_level(p, x, v) : 1;
  return load == 0 ? level : level + load / bouc_wen_level(p);
}
static double narrowing(const InerterDevice* p, double level) {
  return level == 1 ? 1 : pow(level, -p->bw_exponent);
}

static double rate(const InerterDevice* p, double x, double v, double z, double load) {
  double derivative, narrow = narrowing(p, level_at(p, x, v, load));
  double s = sign(v), value = slope(p, narrow, s, z, v * z >= 0, &derivative);
  return fabs(v) * (v * z >= 0 ? value : s * fmax(s * value, least_return(p)));
}

// (e^x - 1) / x
static INLINED double growth(double x) {
  int small = fabs(x) < 1e-8;
  double some = small ? 1 : x, ratio = elementary_expm1(some) / some;
  return small ? 1 + 0.5 * x : ratio;
}

// Exponential step along a path in direction s: exact where the slope is linear in z, that is for
// n = 1 within one sign of z. The change of slope at z = 0 is found on the way.
static double advance(const InerterDevice* p, double narrow, double s, double z, double path) {
  double derivative;
  if (z * s < 0) {
    double value = slope(p, narrow, s, z, 0, &derivative), least = least_return(p);
    if (s * value < least) {
      double bound = bound_of(p, narrow), beyond = fmax(0, fabs(z) - bound);
      if (path * least <= beyond) {
        return z + s * path * least;
      }
      path -= beyond / least;
      z = -s * bound;
      value = slope(p, narrow, s, z, 0, &derivative);
    }
    double next = z + path * growth(derivative * path) * value;
    if (next * s < 0) {
      return next;
    }

    // unloading ends on this step: z = 0 where e^(derivative * path) = 1 - derivative * z / value
    double x = -derivative * z / value;
    path -= fabs(x) < 1e-8 ? -z / value : log1p(x) / derivative;
    z = 0;
  }
  double value = slope(p, narrow, s, z, 1, &derivative);
  return z + fmax(path, 0) * growth(derivative * fmax(path, 0)) * value;
}

// Exact for n = 1. Second order for other n: sub-steps of a quarter of the yield distance as long
// as the slope changes, then one that ends at the limit of z. The tangent passes over a sharp knee,
// so that the limit has to be kept here.
static double step(const InerterDevice* p, double x, double v, double z, double h, double load) {
  double level = level_at(p, x, v, load), narrow = narrowing(p, level);
  double s = sign(v);
  double path = fabs(v) * h;
  double n = p->bw_exponent;
  double limit = p->bw_beta + p->bw_gamma;
  if (n == 1 || limit <= 0) {
    return advance(p, narrow, s, z, path);
  }
  double bound = bound_of(p, 1) * level;
  double part = 0.25 * bound / p->bw_alpha;
  int inside = s * z <= bound;
  for (int i = 0; i < 16 && path > part; i++) {
    if (fabs(bound - s * z) < SLIDING * bound) {
      return z;
    }
    z = advance(p, narrow, s, z, part);
    path -= part;
  }
  z = advance(p, narrow, s, z, path);
  return inside && s * z > bound ? s * bound : z;
}

// Time until z = 0, d|z|/dt = -|v| (alpha + (beta - gamma) |z|^n): closed for n = 1, else by the
// five-point rule of Gauss over |z|. Infinite where z does not come back.
static double straight(const InerterDevice* p, double x, double v, double z, double load) {
  const double points[] = {0.5384693101056831, 0.9061798459386640};
  const double weights[] = {0.4786286704993665, 0.2369268850561891};
  double n = p->bw_exponent, size = fabs(z), before = 0;
  double narrow = narrowing(p, level_at(p, x, v, load)), least = least_return(p);
  double rise = -slowing(p, 0) * narrow;
  if (least >= 0 && size > bound_of(p, narrow)) {
    before = least > 0 ? (size - bound_of(p, narrow)) / least : INFINITY;
    size = bound_of(p, narrow);
  }
  double ratio = rise * pow(size, n) / p->bw_alpha;
  if (!(ratio > -1)) {
    return INFINITY;
  }
  double path = size / p->bw_alpha;
  if (n == 1) {
    path *= fabs(ratio) < 1e-8 ? 1 - 0.5 * ratio : log1p(ratio) / ratio;
  } else {
    double sum = 0.5688888888888889 / (1 + ratio * pow(0.5, n));
    for (int i = 0; i < 4; i++) {
      double place = 0.5 + (i < 2 ? -0.5 : 0.5) * points[i % 2];
      sum += weights[i % 2] / (1 + ratio * pow(place, n));
    }
    path *= 0.5 * sum;
  }
  return (before + path) / fabs(v);
}

static double force(const InerterDevice* p, double x, double v, double z, double load) {
  (void)load;
  (void)v;
  return p->bw_stiffness * (p->bw_ratio * x + (1 - p->bw_ratio) * z);
}

static double energy(const InerterDevice* p, double x, double z) {
  double share = p->bw_ratio;
  return 0.5 * p->bw_stiffness * (share * x * x + (1 - share) * z * z / p->bw_alpha);
}

static double stiffness(const InerterDevice* p) {
  return fmax(0, 1 - p->bw_ratio) * p->bw_stiffness * p->bw_alpha;
}

// for n = 1 and a level of 1: how far a slope takes z on the way to each sample depends on the way
// alone
static SEVERAL_AT_ONCE void along(const InerterDevice* p, const FrictionPath* path, double* z,
                                  double* forces) {
  int beyond = fabs(*z) * slowing(p, 1) > p->bw_alpha;
  if (p->bw_exponent != 1 || !friction_level_is_one(p) || beyond) {
    friction_along(p, path, z, forces, step, force);
    return;
  }
  FrictionSamples samples;
  double side[FRICTION_BLOCK], forth[FRICTION_BLOCK], back[FRICTION_BLOCK];
  samples_between(p, path, &samples);
  double slow_forth = slowing(p, 1), slow_back = slowing(p, 0);
  for (int i = 0; i < samples.size; i++) {
    double way = fabs(samples.v[i]) * path->h;
    side[i] = sign(samples.v[i]);
    forth[i] = way * growth(-slow_forth * way);
    back[i] = way * growth(slow_back * way);
  }
  double now = *z, state[FRICTION_BLOCK] = {0};
  for (int i = 0; i < samples.size; i++) {
    double push = side[i] * p->bw_alpha;
    if (may_turn(path, i)) {
      now = step_to(p, path, i, now, step);
    } else if (now * side[i] >= 0) {
      now += forth[i] * (push - slow_forth * now);
    } else {
      double next = now + back[i] * (push + slow_back * now);
      now = next * side[i] < 0 ? next : advance(p, 1, side[i], now, fabs(samples.v[i]) * path->h);
    }
    state[i] = now;
  }
  *z = now;
  keep_states(path, state);
  samples_at(p, path, &samples);
  for (int i = 0; i < samples.size; i++) {
    forces[i] = force(p, samples.x[i], samples.v[i], state[i], 0);
  }
}

const FrictionLaw inerter_bouc_wen = {
    .rate = rate,
    .step = step,
    .straight = straight,
    .force = force,
    .energy = energy,
    .stiffness = stiffness,
    .along = along,
};
