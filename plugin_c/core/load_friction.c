// Friction that grows with the force through the gear, by the direction of power.
//
//   F = mu |N| sign(v),   mu = mu_forward where N v > 0,  mu_backward where N v < 0
//
// N [N] force through the inertance (what the gear transmits), v [m/s] velocity of the side where
// friction acts (friction_side), sign(v) = tanh(v / v_t), v_t transition_velocity. N v > 0: the
// motion drives the flywheel; N v < 0: the flywheel drives the motion. load_friction is one mu for
// both. Efficiency: forward 1 / (1 + mu_forward), backward 1 - mu_backward. A screw of lead angle
// lambda and friction angle phi has  mu_forward = tan(lambda + phi) / tan(lambda) - 1  and
// mu_backward = 1 - tan(lambda - phi) / tan(lambda).
// Range: mu_backward < 1; at 1 (phi = lambda) the screw locks itself, and no force says how fast
// the flywheel turns. N + F does not fall with N, so that the acceleration follows uniquely.
// Source: Coulomb's law with the load as normal force; the square-threaded screw of any textbook.
// Not modelled: load of other branches, memory of the load friction: it follows sign(v) beside
// every friction law, also beside one with a bristle.

#include "laws.h"

double inerter_load_factor(const InerterDevice* p, double v, double carried) {
  if (!inerter_has_load_friction(p)) {
    return 0;
  }
  return (carried * v < 0 ? p->mu_backward : p->mu_forward) * friction_direction(p, v);
}
