// Acceleration of a tendon's length by velocities alone: see bias.h.

#include "mujoco/bias.h"

// velocity of a site, and its acceleration while no joint accelerates
static void move_of_site(const mjModel* m, const mjData* d, int site, mjtNum velocity[3],
                         mjtNum acceleration[3]) {
  int body = m->site_bodyid[site], moving = m->body_weldid[body];
  mju_zero3(velocity);
  mju_zero3(acceleration);
  if (!moving) {
    return;
  }

  // spatial (rotation, translation) about the tree's centre of mass, summed over the dofs that
  // carry the body
  mjtNum turn[6] = {0};
  int dof = m->body_dofadr[moving] + m->body_dofnum[moving] - 1;
  for (; dof >= 0; dof = m->dof_parentid[dof]) {
    mju_addToScl(turn, d->cdof_dot + 6 * dof, d->qvel[dof], 6);
  }

  // both at the site; the second also turns with the body
  mjtNum arm[3], crossed[3];
  const mjtNum* spin = d->cvel + 6 * body;
  mju_sub3(arm, d->site_xpos + 3 * site, d->subtree_com + 3 * m->body_rootid[body]);
  mju_cross(velocity, spin, arm);
  mju_addTo3(velocity, spin + 3);
  mju_cross(acceleration, turn, arm);
  mju_addTo3(acceleration, turn + 3);
  mju_cross(crossed, spin, velocity);
  mju_addTo3(acceleration, crossed);
}

mjtNum bias_of_tendon(const mjModel* m, const mjData* d, int tendon) {
  int start = m->tendon_adr[tendon], end = start + m->tendon_num[tendon];
  mjtNum sum = 0, divisor = 1, velocity[2][3], acceleration[2][3];
  for (int k = start; k < end; k++) {
    if (m->wrap_type[k] == mjWRAP_PULLEY) {
      divisor = m->wrap_prm[k];
      continue;
    }
    if (m->wrap_type[k] != mjWRAP_SITE) {
      return 0;
    }

    // the second site of a piece is the first one of the next
    int last = k == start || m->wrap_type[k - 1] == mjWRAP_PULLEY ? -1 : m->wrap_objid[k - 1];
    int site = m->wrap_objid[k], now = k % 2;
    move_of_site(m, d, site, velocity[now], acceleration[now]);
    if (last < 0) {
      continue;
    }
    mjtNum along[3], relative[3], change[3];
    mju_sub3(along, d->site_xpos + 3 * site, d->site_xpos + 3 * last);
    mjtNum length = mju_normalize3(along);
    mju_sub3(relative, velocity[now], velocity[1 - now]);
    mju_sub3(change, acceleration[now], acceleration[1 - now]);
    mjtNum rate = mju_dot3(along, relative);
    mjtNum across = mju_dot3(relative, relative) - rate * rate;
    sum += (mju_dot3(along, change) + (length > mjMINVAL ? across / length : 0)) / divisor;
  }
  return sum;
}
