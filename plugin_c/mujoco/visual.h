// The picture of a device in a viewer.

#ifndef INERTER_MUJOCO_VISUAL_H_
#define INERTER_MUJOCO_VISUAL_H_

#include "mujoco/engine.h"

// Add the device to a scene: a barrel on terminal 1, a rod on terminal 2, and the flywheel between
// them. The barrel turns from grey to red with tension and to blue with compression, fully at the
// force whose arrow would be as long as the strut (<visual><map force>); the flywheel turns with
// its displacement, one revolution per kLead, and pales while it is loose in its play.
void visual_draw(const mjModel* m, mjData* d, const mjvOption* option, mjvScene* scene,
                 int instance);

#endif  // INERTER_MUJOCO_VISUAL_H_
