// Friction behind the series element, beside the inertance (friction_side = flywheel).
//
//   F_s = N + F_f(y, w, z) + lambda |N|,   N = B w' + R + G
//   N = (F_s - F_f) / (1 + lambda sgn(F_s - F_f))
//
// F_s [N] force of the series element (series.c), F_f [N] friction law at the flywheel's
// displacement y = x - s [m], velocity w [m/s] and its own state z; N [N] force through the
// inertance; lambda that of load_friction.c, 0 where the load raises the level of a bristle in F_f,
// by |N| without LuGre's damper. Without a series element y = x, w = v, F_s
// is the force between the terminals, and there is nothing to tell the sides apart: the same
// calculation then. Steps: series_step.c solves for the friction together with the flywheel's
// velocity. Why: friction of the nut's bearing and of the flywheel sits behind the elastic shaft;
// the terminals feel it through the spring, so that a device held still at its ends still rings on
// its flywheel. Source: Wang & Su 2008, eq. (9): k_s x_s + c_s x_s' = b (z_b - z_w)'' + f sign((z_b
// - z_w)'). Range: mu < 1, else the flywheel locks. Not modelled: friction on both sides at once.

#include "laws.h"

double wheel_carried(const InerterDevice* p, double w, const double* z, double force,
                     double friction) {
  double rest = force - friction;
  return rest / (1 + inerter_load_factor(p, w, z, rest) * sign(rest));
}
