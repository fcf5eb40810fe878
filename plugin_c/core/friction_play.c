// Free play before a friction law with a bristle (dahl.c, lugre.c, bouc_wen.c).
//
//   z = s - clamp(s, -eps, eps):  the play and the bristle are one state s
//   s' = v                        |s| < eps, and at an edge while it is left inwards
//   s' = z'(v, z)                 else: the law's own rate
//   F  = F_law(z), its damper sigma1 z' only while engaged (|s| > eps, or at an edge, outwards)
//   s > 0: sigma0 z + sigma1 z' >= 0;  s < 0: <= 0
//
// s [m] place in the play plus deflection of the bristle; eps [m] friction_backlash, half of the
// play. One state is enough, since the force is 0 exactly where the bristle is straight. The
// bound on the sign is that of a contact: a damper does not pull the sides together as they part.
// With it LuGre dissipates at every speed. The elastic share A k0 x of Bouc-Wen is beside the play.
// Stored energy: that of the law at z. Without play (eps = 0) every function is the law's own.
// Source: dead zone in series with a bristle; sign of the contact force as in series.c.
// Not modelled: friction and damping within the play, impact, a mass between play and bristle.

#include "friction.h"
#include "laws.h"

double play_deflection(const InerterDevice* p, double s) {
  return s - clamp(s, -p->friction_backlash, p->friction_backlash);
}

static int engaged(const InerterDevice* p, double v, double s) {
  return fabs(s) > p->friction_backlash || (fabs(s) == p->friction_backlash && s * v > 0);
}

double play_rate(const InerterDevice* p, double x, double v, double s, double load) {
  return engaged(p, v, s) ? law_of(p)->rate(p, x, v, play_deflection(p, s), load) : v;
}

// Exact at constant v as far as the law is: the bristle straightens, the play is crossed, the
// bristle bends on the other side, each for its share of the time.
double play_step(const InerterDevice* p, double x, double v, double s, double h, double load) {
  const FrictionLaw* law = law_of(p);
  double eps = p->friction_backlash, side = sign(v);
  if (v == 0) {
    return s;
  }
  if (side * s < -eps) {
    double z = play_deflection(p, s), straight = law->straight(p, x, v, z, load);
    if (!(straight < h)) {
      double end = law->step(p, x, v, z, h, load);
      return side * end < 0 ? end - side * eps : -side * eps;
    }
    h -= straight;
    s = -side * eps;
  }
  if (side * s < eps) {
    double across = (eps - side * s) / fabs(v);
    if (!(across < h)) {
      return clamp(s + v * h, -eps, eps);
    }
    h -= across;
    s = side * eps;
  }
  return side * eps + law->step(p, x, v, play_deflection(p, s), h, load);
}

// force at deflection z of the bristle and its rate: nothing that pulls across the play
static double contact_force(const InerterDevice* p, double x, double z, double rate) {
  if (p->friction != INERTER_FRICTION_lugre) {
    return law_of(p)->force(p, x, 0, z, 0);
  }
  double force = p->bristle_stiffness * z + p->bristle_damping * rate;
  return z > 0 ? fmax(0, force) : z < 0 ? fmin(0, force) : force;
}

double play_force(const InerterDevice* p, double x, double v, double s, double load) {
  double z = play_deflection(p, s);
  return contact_force(p, x, z, engaged(p, v, s) ? law_of(p)->rate(p, x, v, z, load) : 0);
}

// Over a step: each side's damper at the mean rate of its bristle, so that the force does not
// jump with v where the step reaches the contact, and with the spring's share of the change.
double play_force_over_step(const InerterDevice* p, double x, double v, double s, double end,
                            double share, double h) {
  double eps = p->friction_backlash;
  double push = fmax(0, s - eps), pushing = fmax(0, end - eps) - push;
  double pull = fmin(0, s + eps), pulling = fmin(0, end + eps) - pull;
  double z = push + share * pushing + pull + share * pulling;
  if (p->friction != INERTER_FRICTION_lugre) {
    return law_of(p)->force(p, x, v, z, 0);
  }
  double upper = p->bristle_stiffness * (push + share * pushing) + p->bristle_damping * pushing / h;
  double lower = p->bristle_stiffness * (pull + share * pulling) + p->bristle_damping * pulling / h;
  return fmax(0, upper) + fmin(0, lower);
}
