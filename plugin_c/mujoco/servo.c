// Servos whose damping lacks an inertance: see servo.h.

#include "mujoco/servo.h"

#include <math.h>

#include "mujoco/attachment.h"

// The compiler has replaced the ratio by the damping. That it was a ratio shows in the number: who
// writes a ratio writes few digits, and a damping of one's own gives many.
static int is_written_by_hand(mjtNum ratio) {
  mjtNum digits = 1e4 * ratio;
  return ratio > 0 && ratio < 100 && fabs(digits - round(digits)) < 1e-9 * fmax(digits, 1);
}

// mass that the engine takes for an actuator [kg, kg m^2]
static mjtNum reflected_mass(const mjModel* m, const mjData* d, int actuator, const mjtNum* M0) {
  int row = m->actuator_outadr[actuator];
  int start = d->moment_rowadr[row], end = start + d->moment_rownnz[row];
  mjtNum mobility = 0;
  for (int k = start; k < end; k++) {
    mobility += d->actuator_moment[k] * d->actuator_moment[k] / M0[d->moment_colind[k]];
  }
  return 1 / mobility;
}

void servo_warn(const mjModel* m, const mjData* d, const mjtNum* M0) {
  for (int i = 0; i < m->nactuator; i++) {
    // kp (length - ctrl) and a damping
    const mjtNum* bias = m->actuator_biasprm + mjNBIAS * i;
    mjtNum kp = -bias[1], kv = -bias[2];
    int pid = m->actuator_gaintype[i] == mjGAIN_PID;
    if (!(kp > 0 && kv > 0) || (!pid && m->actuator_gainprm[mjNGAIN * i] != kp)) {
      continue;
    }
    mjtNum before = reflected_mass(m, d, i, M0), now = reflected_mass(m, d, i, m->dof_M0);
    mjtNum ratio = kv / (2 * sqrt(kp * before));
    if (!(fabs(now - before) > 1e-6 * before) || !is_written_by_hand(ratio)) {
      continue;
    }
    mju_warning(
        "inerter.device: actuator \"%.60s\" has kv = %.6g, which is dampratio %g of masses without "
        "the "
        "inertance of a device; with it dampratio %g is kv=\"%.6g\": write that in place of "
        "dampratio",
        attachment_name(m, mjOBJ_ACTUATOR, i), kv, ratio, ratio, 2 * ratio * sqrt(kp * now));
  }
}
