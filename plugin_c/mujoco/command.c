// The force that a control commands: see command.h.

#include "mujoco/command.h"

#include "mujoco/engine_private.h"

mjtNum command_force(const mjModel* m, const mjData* d, int actuator) {
  if (!m->actuator_ctrlnum[actuator]) {
    return 0;
  }
  int address = m->actuator_ctrladr[actuator];
  mjtNum ctrl = d->ctrl[address];
  if (m->actuator_delay[actuator]) {
    const mjtNum* found =
        mj_readCtrl(m, d, actuator, d->time, &ctrl, m->actuator_history[2 * actuator + 1]);
    ctrl = found ? *found : ctrl;
  }
  if (m->actuator_ctrllimited[address] && !(m->opt.disableflags & mjDSBL_CLAMPCTRL)) {
    ctrl =
        mju_clip(ctrl, m->actuator_ctrlrange[2 * address], m->actuator_ctrlrange[2 * address + 1]);
  }
  return mju_isBad(ctrl) ? 0 : ctrl;
}
