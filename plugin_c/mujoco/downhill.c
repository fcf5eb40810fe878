// How far to go downhill: see downhill.h.
//
// False position that halves a retained end (Illinois), with a bisection now and then.

#include "mujoco/downhill.h"

#include <math.h>

enum { SEARCHES = 40 };

// slope over that at the start: the whole line is taken below the first, a search ends below the
// second
static const double kWhole = 0.5, kSearched = 0.1;

double downhill_search(DownhillSlope slope, void* line, double start) {
  double low = 0, high = 1, at_low = start, at_high = slope(line, 1);
  if (!(at_high > kWhole * fabs(start))) {
    return 1;
  }
  double t = 1;
  int side = 0;
  for (int k = 0; k < SEARCHES; k++) {
    t = (low * at_high - high * at_low) / (at_high - at_low);
    if (!(t > low && t < high) || k % 4 == 3) {
      t = 0.5 * (low + high);
    }
    double here = slope(line, t);
    if (fabs(here) <= kSearched * fabs(start)) {
      break;
    }
    if (here > 0) {
      high = t;
      at_high = here;
      at_low = side > 0 ? 0.5 * at_low : at_low;
      side = 1;
    } else {
      low = t;
      at_low = here;
      at_high = side < 0 ? 0.5 * at_high : at_high;
      side = -1;
    }
  }
  return t;
}
