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
// Not modelled: pinching, degradation.

#include <float.h>

#include "friction.h"

// z' along the path: rate per unit |v| in direction s = sgn(v), and its slope over z
static double slope(const InerterDevice* p, double s, double z, double* derivative) {
  double n = p->bw_exponent;
  double c = p->bw_gamma * s + p->bw_beta * sign(z);
  double power = n == 1 ? 1 : pow(fabs(z), n - 1);
  *derivative = -c * n * power * (z < 0 ? -1 : 1);
  return p->bw_alpha * s - c * power * fabs(z);
}

static double rate(const InerterDevice* p, double x, double v, double z) {
  (void)x;
  double derivative;
  return fabs(v) * slope(p, sign(v), z, &derivative);
}

// exponential step along a path of length `path` within one sign of z; exact for n = 1
static double advance(const InerterDevice* p, double s, double z, double path) {
  double derivative;
  double value = slope(p, s, z, &derivative);
  double exponent = derivative * path;
  double growth =
      fabs(exponent) < 1e-8 ? path * (1 + 0.5 * exponent) : expm1(exponent) / derivative;
  return z + growth * value;
}

// one step along a path, the change of slope at z = 0 found on the way
static double advance_through_zero(const InerterDevice* p, double s, double z, double path) {
  if (z * s < 0) {
    double next = advance(p, s, z, path);
    if (next * s < 0) {
      return next;
    }

    // length of the path to z = 0, then on from there
    double low = 0, high = path;
    for (int i = 0; i < 60 && high - low > 1e-15 * path; i++) {
      double middle = 0.5 * (low + high);
      if (advance(p, s, z, middle) * s < 0) {
        low = middle;
      } else {
        high = middle;
      }
    }
    path -= high;
    z = 0;
  }
  return advance(p, s, z == 0 ? s * DBL_MIN : z, path);
}

// Exact for n = 1; second order for other n, with sub-steps of a quarter of the yield distance, so
// that a long step ends at the limit of z instead of beyond it.
static double step(const InerterDevice* p, double x, double v, double z, double h) {
  (void)x;
  double s = sign(v);
  double path = fabs(v) * h;
  double n = p->bw_exponent;
  double limit = p->bw_beta + p->bw_gamma;
  if (n == 1 || limit <= 0) {
    return advance_through_zero(p, s, z, path);
  }
  double bound = pow(p->bw_alpha / limit, 1 / n);
  double yield = bound / p->bw_alpha;
  double count = ceil(fmin(4 * path / yield, 80));
  double part = fmin(path, 20 * yield) / fmax(count, 1);
  for (int i = 0; i < (int)count; i++) {
    double next = advance_through_zero(p, s, z, part);

    // the tangent knows nothing of a sharp knee (large n) ahead: stop at the limit
    z = s * z <= bound ? s * fmin(s * next, bound) : next;
  }
  return z;
}

static double force(const InerterDevice* p, double x, double v, double z) {
  (void)v;
  return p->bw_stiffness * (p->bw_ratio * x + (1 - p->bw_ratio) * z);
}

static double energy(const InerterDevice* p, double x, double z) {
  double share = p->bw_ratio;
  return 0.5 * p->bw_stiffness * (share * x * x + (1 - share) * z * z / p->bw_alpha);
}

const FrictionLaw inerter_bouc_wen = {rate, step, force, energy};
