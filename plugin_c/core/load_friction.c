// Friction that grows with the force through the gear, by the direction of power.
//
//   level = f_c + mu |N|,   mu = mu_forward where N v > 0,  mu_backward where N v < 0
//
// N [N] force through the inertance (what the gear transmits), v [m/s] velocity of the side where
// friction acts (friction_side). N v > 0: the motion drives the flywheel; N v < 0: the flywheel
// drives the motion. load_friction is one mu for both. In each friction law mu |N| [N] is added to
// f_c, so that it has the law's own shape:
//   none, coulomb, stribeck   + mu |N| tanh(v / v_t);  f_s rises with f_c
//   brown_mcphee              + mu |N| tanh(4 v / v_s): what the law gives as its width
//   rate_state                (f_c + mu |N|) (1 + A ln(V / v_0) + B z) tanh(v / v_t)
//   dahl, lugre, bouc_wen, maxwell_slip   the force at which the bristle yields; those of several
//                             elements in proportion
// A bristle keeps its stiffness: a change of the load does no work on it, and what it holds under a
// load that falls it gives back as it slides, so that the law stays passive whatever the load does.
// Efficiency of steady sliding with f_c -> 0: forward 1 / (1 + mu_forward), backward
// 1 - mu_backward. A screw of lead angle lambda and friction angle phi has
//   mu_forward = tan(lambda + phi) / tan(lambda) - 1,
//   mu_backward = 1 - tan(lambda - phi) / tan(lambda).
// Range: mu_backward < 1; at 1 (phi = lambda) the screw locks itself, and no force says how fast
// the flywheel turns; with rate_state mu_backward times the bracket is held below 0.999. N + F does
// not fall with N, so that the acceleration follows uniquely; with the damper of LuGre as long as
// mu sigma1 |v| < level: above it several accelerations may fit. One of them is found then, bounded
// and without giving energy, but another may be after a small change; the reference refuses.
// Passive as the law itself: that of LuGre where sigma1 |v| <= 4 (level + mu |N|), or as long as
// the bristle is within its level, whatever the load.
// Source: Coulomb's law with the load as normal force; the square-threaded screw of any textbook.
// Why not the whole bristle in proportion to the load (Canudas de Wit & Tsiotras 1999, for tyres):
// a load that rises on a bent bristle would give energy.
// Not modelled: load of other branches; of LuGre behind a series element the damper's part of N.

#include "laws.h"

// of rate_state, whose level has no upper end: what old contacts leave of the flywheel's force
static const double kMostBackward = 0.999;

static double share_of(const InerterDevice* p, double v, double carried) {
  return carried * v < 0 ? p->mu_backward : p->mu_forward;
}

double inerter_load_factor(const InerterDevice* p, double v, const double* z, double carried) {
  if (!inerter_has_load_friction(p) || inerter_load_bends(p)) {
    return 0;
  }
  double mu = share_of(p, v, carried);
  if (p->friction != INERTER_FRICTION_none && law_of(p)->width) {
    return mu * elementary_tanh(v / law_of(p)->width(p));
  }
  if (p->friction == INERTER_FRICTION_rate_state) {
    mu *= rate_state_factor(p, v, z ? z[0] : 0);
    mu = carried * v < 0 ? fmin(kMostBackward, mu) : mu;
  }
  return mu * friction_direction(p, v);
}

int inerter_load_bends(const InerterDevice* p) {
  return inerter_has_load_friction(p) && has_bristle(p) &&
         p->friction != INERTER_FRICTION_rate_state;
}

double load_on_bristle(const InerterDevice* p, double v, double carried) {
  return inerter_load_bends(p) ? share_of(p, v, carried) * fabs(carried) : 0;
}
