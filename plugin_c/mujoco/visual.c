// The picture of a device in a viewer: see visual.h.

#include "mujoco/visual.h"

#include <math.h>

#include "mujoco/instance.h"
#include "mujoco/sensor.h"

static const mjtNum kLead = 0.02;                      // displacement of one revolution [m, rad]
static const mjtNum kBarrel = 0.09, kRod = 0.035;      // radii over length
static const mjtNum kWheel = 0.20, kThickness = 0.05;  // flywheel over length

static void add(mjvScene* scene, int type, const mjtNum size[3], const mjtNum pos[3],
                const mjtNum mat[9], const float rgba[4], int actuator) {
  if (scene->ngeom >= scene->maxgeom) {
    return;
  }
  mjvGeom* geom = scene->geoms + scene->ngeom++;
  mjv_initGeom(geom, type, size, pos, mat, rgba);
  geom->objtype = mjOBJ_ACTUATOR;
  geom->objid = actuator;
  geom->category = mjCAT_DECOR;
}

// terminals of a device: ends of a tendon, or a span around a joint's anchor along its axis;
// returns 0 if there is nothing to draw
static int terminals(const mjModel* m, const mjData* d, int actuator, mjtNum from[3],
                     mjtNum to[3]) {
  int target = m->actuator_trnid[2 * actuator];
  if (m->actuator_trntype[actuator] == mjTRN_TENDON) {
    int first = d->ten_wrapadr[target], last = first + d->ten_wrapnum[target] - 1;
    if (last <= first) {
      return 0;
    }
    mju_copy3(from, d->wrap_xpos + 3 * first);
    mju_copy3(to, d->wrap_xpos + 3 * last);
    return 1;
  }
  mjtNum half = 0.5 * m->stat.meansize;
  mju_addScl3(from, d->xanchor + 3 * target, d->xaxis + 3 * target, -half);
  mju_addScl3(to, d->xanchor + 3 * target, d->xaxis + 3 * target, half);
  return 1;
}

// colour of the barrel: red in tension, blue in compression
static void force_colour(const mjModel* m, mjtNum force, mjtNum length, float rgba[4]) {
  float t = (float)tanh(force * m->vis.map.force / fmax(length, mjMINVAL));
  rgba[0] = 0.55f + 0.4f * (t > 0 ? t : 0.6f * t);
  rgba[1] = 0.57f - 0.42f * fabsf(t);
  rgba[2] = 0.60f + 0.35f * (t < 0 ? -t : -1.2f * t);
  rgba[3] = 1;
}

// displacement of the flywheel; *loose: it lies free in its play
static mjtNum flywheel(const mjModel* m, const mjData* d, const Instance* self, int* loose) {
  const InerterDevice* device = &self->device;
  mjtNum x = instance_displacement(m, d, self);
  *loose = 0;
  if (!instance_has_series(device)) {
    return x;
  }
  const mjtNum* series = d->act + instance_act(m, self) + device->nfriction;
  if (device->backlash > 0) {
    *loose = fabs(series[2]) < device->backlash;
  }
  return x - series[0];
}

void visual_draw(const mjModel* m, mjData* d, const mjvOption* option, mjvScene* scene,
                 int instance) {
  const Instance* self = instance_of(d, instance);
  mjtNum from[3], to[3], axis[3], quat[4], mat[9], pos[3];
  if (instance_absent(d, instance)) {
    return;
  }
  if (!option->flags[mjVIS_ACTUATOR] && !option->flags[mjVIS_TENDON]) {
    return;
  }
  if (!terminals(m, d, self->actuator, from, to)) {
    return;
  }
  mju_sub3(axis, to, from);
  mjtNum length = mju_normalize3(axis);
  mju_quatZ2Vec(quat, axis);
  mju_quat2Mat(mat, quat);

  // barrel and rod
  float colour[4], steel[4] = {0.75f, 0.76f, 0.78f, 1};
  force_colour(m, sensor_force(m, d, self).total, length, colour);
  mjtNum barrel[3] = {kBarrel * length, 0.25 * length, 0};
  mju_addScl3(pos, from, axis, 0.27 * length);
  add(scene, mjGEOM_CYLINDER, barrel, pos, mat, colour, self->actuator);
  mjtNum rod[3] = {kRod * length, 0.5 * length, 0};
  mju_addScl3(pos, from, axis, 0.5 * length);
  add(scene, mjGEOM_CYLINDER, rod, pos, mat, steel, self->actuator);

  // flywheel: a disc, with a bar that shows how it turns
  int loose;
  mjtNum angle = 2 * mjPI * flywheel(m, d, self, &loose) / kLead;
  float brass[4] = {0.83f, 0.66f, 0.30f, loose ? 0.4f : 1}, dark[4] = {0.25f, 0.2f, 0.1f, 1};
  mjtNum disc[3] = {kWheel * length, kThickness * length, 0};
  mju_addScl3(pos, from, axis, 0.62 * length);
  add(scene, mjGEOM_CYLINDER, disc, pos, mat, brass, self->actuator);
  mjtNum turn[4], zaxis[3] = {0, 0, 1};
  mju_axisAngle2Quat(turn, zaxis, angle);
  mju_mulQuat(quat, quat, turn);
  mju_quat2Mat(mat, quat);
  mjtNum bar[3] = {0.9 * kWheel * length, 0.15 * kWheel * length, 1.1 * kThickness * length};
  add(scene, mjGEOM_BOX, bar, pos, mat, dark, self->actuator);
}
