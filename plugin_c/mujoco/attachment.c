// Whether an actuator can carry a device: see attachment.h.

#include "mujoco/attachment.h"

#include <math.h>
#include <stdio.h>

#include "mujoco/instance.h"

const char* attachment_name(const mjModel* m, mjtObj type, int id) {
  const char* name = mj_id2name(m, type, id);
  return name && *name ? name : "(unnamed)";
}

int attachment_wrapped_geom(const mjModel* m, int tendon) {
  for (int k = m->tendon_adr[tendon]; k < m->tendon_adr[tendon] + m->tendon_num[tendon]; k++) {
    if (m->wrap_type[k] == mjWRAP_SPHERE || m->wrap_type[k] == mjWRAP_CYLINDER) {
      return m->wrap_objid[k];
    }
  }
  return -1;
}

int attachment_find(const mjModel* m, int instance, int* actuator,
                    char message[INERTER_MESSAGE_SIZE]) {
  int count;
  *actuator = instance_actuator(m, instance, &count);
  if (count == 1) {
    return 0;
  }
  for (int body = 0; body < m->nbody; body++) {
    if (m->body_plugin[body] == instance) {
      snprintf(message, INERTER_MESSAGE_SIZE,
               "body \"%.60s\" refers to it, but a device acts between two points: take <plugin> "
               "out of the body, and write <actuator><plugin plugin=\"inerter.device\" "
               "tendon=\"...\"/></actuator> with a tendon from one to the other",
               attachment_name(m, mjOBJ_BODY, body));
      return -1;
    }
  }
  if (count) {
    snprintf(message, INERTER_MESSAGE_SIZE,
             "%d actuators refer to it; give every actuator an instance of its own", count);
  } else if (instance_sensed(m, instance) && !mj_id2name(m, mjOBJ_PLUGIN, instance)) {
    snprintf(message, INERTER_MESSAGE_SIZE,
             "it names no instance, so that it reads a device of its own; configure the device as "
             "<extension><plugin plugin=\"inerter.device\"><instance name=\"NAME\">, and write "
             "instance=\"NAME\" in its actuator and in this sensor");
  } else {
    snprintf(message, INERTER_MESSAGE_SIZE,
             "no actuator refers to it; add <actuator><plugin plugin=\"inerter.device\" "
             "instance=\"...\" tendon=\"...\"/></actuator>, or take it out (where an MjSpec "
             "has lost the actuator: inerter.remove_device)");
  }
  return -1;
}

// refuse a transmission that is not a single distance or angle
static int check_transmission(const mjModel* m, int actuator, const InerterDevice* device, int live,
                              char message[INERTER_MESSAGE_SIZE]) {
  int target = m->actuator_trnid[2 * actuator], geom;
  switch (m->actuator_trntype[actuator]) {
    case mjTRN_TENDON:
      geom = attachment_wrapped_geom(m, target);
      if (geom >= 0 && (device->inertance > 0 || live) && !instance_has_series(device)) {
        snprintf(
            message, INERTER_MESSAGE_SIZE,
            "inertance is %g kg%s, but tendon \"%.40s\" wraps around geom \"%.40s\": the engine "
            "does not know how such a tendon accelerates; route it through sites and pulleys, "
            "or state the elasticity (series_stiffness) that a wrapping tendon has",
            device->inertance, live ? " and live" : "", attachment_name(m, mjOBJ_TENDON, target),
            attachment_name(m, mjOBJ_GEOM, geom));
        return -1;
      }
      return 0;
    case mjTRN_JOINT:
    case mjTRN_JOINTINPARENT:
      if (m->jnt_type[target] == mjJNT_SLIDE || m->jnt_type[target] == mjJNT_HINGE) {
        return 0;
      }
      snprintf(message, INERTER_MESSAGE_SIZE,
               "joint \"%.60s\" is a %s joint; a device needs a slide or hinge joint, or a tendon",
               attachment_name(m, mjOBJ_JOINT, target),
               m->jnt_type[target] == mjJNT_FREE ? "free" : "ball");
      return -1;
    default:
      snprintf(message, INERTER_MESSAGE_SIZE,
               "the transmission is neither a tendon nor a joint; give tendon=\"...\" or "
               "joint=\"...\" (slide or hinge)");
      return -1;
  }
}

// whether a tendon goes over joints, or over points of bodies that move against each other
static int joins_two(const mjModel* m, int tendon) {
  int first = m->tendon_adr[tendon], body = -1;
  for (int k = first; k < first + m->tendon_num[tendon]; k++) {
    int type = m->wrap_type[k], object = m->wrap_objid[k];
    int geom = type == mjWRAP_SPHERE || type == mjWRAP_CYLINDER;
    if (type == mjWRAP_JOINT) {
      return 1;
    }
    if (type == mjWRAP_SITE || geom) {
      int here = m->body_weldid[geom ? m->geom_bodyid[object] : m->site_bodyid[object]];
      if (body >= 0 && here != body) {
        return 1;
      }
      body = here;
    }
  }
  return 0;
}

// refuse an actuator that moves nothing
static int check_moves(const mjModel* m, int actuator, char message[INERTER_MESSAGE_SIZE]) {
  int tendon = m->actuator_trnid[2 * actuator];
  const mjtNum* gear = m->actuator_gear + 6 * m->actuator_outadr[actuator];
  if (gear[0] == 0) {
    snprintf(message, INERTER_MESSAGE_SIZE, "gear is 0: the device would do nothing; give another");
    return -1;
  }
  if (!isfinite(gear[0])) {
    snprintf(message, INERTER_MESSAGE_SIZE, "gear is %g; give a number that is finite", gear[0]);
    return -1;
  }
  for (int k = 1; k < 6; k++) {
    if (gear[k] != 0) {
      snprintf(message, INERTER_MESSAGE_SIZE,
               "gear is \"%g %g %g %g %g %g\", but a device acts along one line or about one axis: "
               "give one number, gear=\"%g\"",
               gear[0], gear[1], gear[2], gear[3], gear[4], gear[5], gear[0]);
      return -1;
    }
  }
  if (m->actuator_trntype[actuator] == mjTRN_TENDON && !joins_two(m, tendon)) {
    snprintf(
        message, INERTER_MESSAGE_SIZE,
        "tendon \"%.60s\" joins points that do not move against each other (both on one body or "
        "in the world): the device would do nothing; attach it to two bodies",
        attachment_name(m, mjOBJ_TENDON, tendon));
    return -1;
  }
  return 0;
}

int attachment_check_sleep(const mjModel* m, int actuator, char message[INERTER_MESSAGE_SIZE]) {
  int tendon = m->actuator_trnid[2 * actuator];
  if (!(m->opt.enableflags & mjENBL_SLEEP) || m->actuator_trntype[actuator] != mjTRN_TENDON) {
    return 0;
  }
  int trees = 0, sleeper = -1, last = -1;
  for (int k = 0; k < m->ten_J_rownnz[tendon]; k++) {
    int dof = m->ten_J_colind[m->ten_J_rowadr[tendon] + k], tree = m->dof_treeid[dof];
    int policy = m->tree_sleep_policy[tree];
    trees += tree != last;
    last = tree;
    if (policy != mjSLEEP_AUTO_NEVER && policy != mjSLEEP_NEVER) {
      sleeper = m->dof_bodyid[dof];
    }
  }
  if (trees > 1 && sleeper >= 0) {
    snprintf(message, INERTER_MESSAGE_SIZE,
             "sleep is enabled and body \"%.60s\" may fall asleep while the device moves its other "
             "end, for which the engine does not wake it; write sleep=\"never\" on its tree",
             attachment_name(m, mjOBJ_BODY, sleeper));
    return -1;
  }
  return 0;
}

enum { STATES_TEXT = 320 };

// the states a device needs, in words
static void states_text(const InerterDevice* device, char text[STATES_TEXT]) {
  int length = 0;
  text[0] = 0;
  for (int i = 0; i < inerter_nstate(device) && length < STATES_TEXT; i++) {
    length += snprintf(text + length, (size_t)(STATES_TEXT - length), "%s%s", i ? ", " : ": ",
                       inerter_state_name(device, i));
  }
}

int attachment_check(const mjModel* m, int actuator, const InerterDevice* device, int live,
                     char message[INERTER_MESSAGE_SIZE]) {
  if (m->actuator_dyntype[actuator] != mjDYN_NONE) {
    snprintf(message, INERTER_MESSAGE_SIZE,
             "dyntype is given; a device has no other dynamics than its own: remove dyntype");
    return -1;
  }
  int nstate = inerter_nstate(device);
  if (m->actuator_actnum[actuator] != nstate) {
    char states[STATES_TEXT];
    states_text(device, states);
    snprintf(message, INERTER_MESSAGE_SIZE,
             "actdim is %d, but the device (friction \"%s\"%s) has %d state%s%s; %s actdim=\"%d\" "
             "in <plugin>",
             m->actuator_actnum[actuator], inerter_friction_name(device->friction),
             instance_has_series(device) ? ", series element" : "", nstate, nstate == 1 ? "" : "s",
             states, nstate ? "write" : "remove it or write", nstate);
    return -1;
  }
  return check_transmission(m, actuator, device, live, message) ||
                 check_moves(m, actuator, message) || attachment_check_sleep(m, actuator, message)
             ? -1
             : 0;
}

int attachment_limited(const mjModel* m, int actuator) {
  int target = m->actuator_trnid[2 * actuator];
  if (m->actuator_forcelimited[actuator]) {
    return 1;
  }
  if (m->actuator_trntype[actuator] != mjTRN_TENDON) {
    return m->jnt_actfrclimited[target];
  }
  for (int k = 0; k < m->ten_J_rownnz[target]; k++) {
    if (m->jnt_actfrclimited[m->dof_jntid[m->ten_J_colind[m->ten_J_rowadr[target] + k]]]) {
      return 1;
    }
  }
  return m->tendon_actfrclimited[target];
}
