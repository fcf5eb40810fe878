// Where the inertance and the viscous damping live.
//
//   M = M_bodies + b J'J,   qfrc_bias += b J' (dJ/dt v),   qfrc_passive -= c J'J v
//
// J: row of the actuator's moment arms, v = qvel, b = actuator_armature, c = actuator_damping. With
// the inertance in the engine's own inertia matrix, contacts, limits, equality constraints,
// friction loss, implicit integrators, inverse dynamics and derivatives all see the right effective
// mass. What varies of the inertance along the stroke is a force (acceleration_forces.c).
//
// Why not a force -b a: a is not known before the forces are; the acceleration of the last step in
// its place diverges as soon as b exceeds the effective mass.
//
// Not modelled: an inertance between two branches of the kinematic tree. The engine stores M in the
// sparsity of the tree and drops what falls outside without a word; it is refused here.

#include "mujoco/coupling.h"

#include <stdio.h>

// Slot of actuator_gainprm, unused by plugin actuators, that says the values are in place. It goes
// with the model through copies and MJB files, so that later edits of actuator_armature count.
static const int kPlacedSlot = mjNGAIN - 1;

static const char* name_of(const mjModel* m, mjtObj type, int id) {
  const char* name = mj_id2name(m, type, id);
  return name && *name ? name : "(unnamed)";
}

// whether the inertia matrix has an entry for a pair of dofs
static int in_inertia(const mjModel* m, int a, int b) {
  int row = a > b ? a : b, column = a > b ? b : a;
  for (int k = m->M_rowadr[row]; k < m->M_rowadr[row] + m->M_rownnz[row]; k++) {
    if (m->M_colind[k] == column) {
      return 1;
    }
  }
  return 0;
}

// whether dof b is an ancestor of dof a or the other way round
static int in_line(const mjModel* m, int a, int b) {
  int low = a < b ? a : b;
  for (int dof = a > b ? a : b; dof >= low; dof = m->dof_parentid[dof]) {
    if (dof == low) {
      return 1;
    }
  }
  return 0;
}

// refuse a tendon whose inertance does not fit into the inertia matrix
static int check_tendon(const mjModel* m, int tendon, mjtNum inertance,
                        char message[INERTER_MESSAGE_SIZE]) {
  // the engine has no time derivative of a tendon that wraps around geoms
  for (int k = m->tendon_adr[tendon]; k < m->tendon_adr[tendon] + m->tendon_num[tendon]; k++) {
    if (m->wrap_type[k] == mjWRAP_SPHERE || m->wrap_type[k] == mjWRAP_CYLINDER) {
      snprintf(message, INERTER_MESSAGE_SIZE,
               "inertance is %g kg, but tendon \"%.40s\" wraps around geom \"%.40s\": the engine "
               "knows no inertia of wrapping tendons; route it through sites only",
               inertance, name_of(m, mjOBJ_TENDON, tendon),
               name_of(m, mjOBJ_GEOM, m->wrap_objid[k]));
      return -1;
    }
  }

  // every pair of dofs that the tendon couples needs its place
  int start = m->ten_J_rowadr[tendon], end = start + m->ten_J_rownnz[tendon];
  for (int k = start; k < end; k++) {
    for (int l = start; l < k; l++) {
      int a = m->ten_J_colind[l], b = m->ten_J_colind[k];
      if (in_inertia(m, a, b)) {
        continue;
      }
      const char* body_a = name_of(m, mjOBJ_BODY, m->dof_bodyid[a]);
      const char* body_b = name_of(m, mjOBJ_BODY, m->dof_bodyid[b]);
      if (in_line(m, a, b)) {
        snprintf(message, INERTER_MESSAGE_SIZE,
                 "inertance is %g kg, but tendon \"%.40s\" pulls at body \"%.40s\", which the "
                 "compiler has given a diagonal inertia matrix: part of the inertance would be "
                 "lost. Write <body name=\"%.40s\" simple=\"false\">",
                 inertance, name_of(m, mjOBJ_TENDON, tendon), body_b, body_b);
      } else {
        snprintf(message, INERTER_MESSAGE_SIZE,
                 "inertance is %g kg, but tendon \"%.40s\" joins body \"%.40s\" and body "
                 "\"%.40s\", two branches of the tree: the engine's inertia matrix has no entry "
                 "for them and would silently simulate another device. Nest one body in the other "
                 "(its joint then is their relative motion), or set inertance 0",
                 inertance, name_of(m, mjOBJ_TENDON, tendon), body_a, body_b);
      }
      return -1;
    }
  }
  return 0;
}

// refuse a transmission that is not a single distance or angle
static int check_transmission(const mjModel* m, int actuator, mjtNum inertance,
                              char message[INERTER_MESSAGE_SIZE]) {
  int target = m->actuator_trnid[2 * actuator];
  switch (m->actuator_trntype[actuator]) {
    case mjTRN_TENDON:
      return inertance > 0 ? check_tendon(m, target, inertance, message) : 0;
    case mjTRN_JOINT:
    case mjTRN_JOINTINPARENT:
      if (m->jnt_type[target] == mjJNT_SLIDE || m->jnt_type[target] == mjJNT_HINGE) {
        return 0;
      }
      snprintf(message, INERTER_MESSAGE_SIZE,
               "joint \"%.60s\" is a %s joint; a device needs a slide or hinge joint, or a tendon",
               name_of(m, mjOBJ_JOINT, target),
               m->jnt_type[target] == mjJNT_FREE ? "free" : "ball");
      return -1;
    default:
      snprintf(message, INERTER_MESSAGE_SIZE,
               "the transmission is neither a tendon nor a joint; give tendon=\"...\" or "
               "joint=\"...\" (slide or hinge)");
      return -1;
  }
}

int coupling_check(const mjModel* m, int actuator, const InerterDevice* device,
                   char message[INERTER_MESSAGE_SIZE]) {
  // one state per device, and no dynamics of the engine's own
  if (m->actuator_dyntype[actuator] != mjDYN_NONE) {
    snprintf(message, INERTER_MESSAGE_SIZE,
             "dyntype is given; a device has no other dynamics than its own: remove dyntype");
    return -1;
  }
  int nstate = inerter_nstate(device);
  if (m->actuator_actnum[actuator] != nstate) {
    snprintf(message, INERTER_MESSAGE_SIZE,
             "actdim is %d, but friction \"%s\" has %d state%s; %s actdim=\"%d\" in <plugin>",
             m->actuator_actnum[actuator], inerter_friction_name(device->friction), nstate,
             nstate == 1 ? "" : "s", nstate ? "write" : "remove it or write", nstate);
    return -1;
  }
  return check_transmission(m, actuator, m->actuator_armature[actuator], message);
}

// Value that the model is to hold: the configured one, unless only the attribute states it.
// Return 0, or -1 with a message if both are stated and differ.
static int merge(const InerterDevice* device, int index, mjtNum configured, const char* attribute,
                 mjtNum* value, char message[INERTER_MESSAGE_SIZE]) {
  const InerterParameter* parameter = inerter_parameter(index);
  int given = (int)(device->given >> index & 1);
  if (*value != 0 && given && *value != configured) {
    snprintf(message, INERTER_MESSAGE_SIZE,
             "%s is %g %s, but the actuator's %s is %g: both mean the same; state one of them",
             parameter->name, configured, parameter->unit, attribute, *value);
    return -1;
  }
  if (given) {
    *value = configured;
  }
  if (*value < 0) {
    snprintf(message, INERTER_MESSAGE_SIZE, "the actuator's %s is %g; give a value >= 0 %s",
             attribute, *value, parameter->unit);
    return -1;
  }
  return 0;
}

// Derive again what depends on armature and damping: inverse weights, which actuators act on which
// joint or tendon. The statistics stay as they are; no computation reads the mean inertia.
static void derive(mjModel* m) {
  mjtSize nplugin = m->nplugin;
  int enableflags = m->opt.enableflags;

  // in a workspace of its own, without plugins (this is inside an init) and with everything awake
  m->nplugin = 0;
  m->opt.enableflags &= ~mjENBL_SLEEP;
  mjData* workspace = mj_makeData(m);
  mj_setConst(m, workspace);
  mj_deleteData(workspace);
  m->opt.enableflags = enableflags;
  m->nplugin = nplugin;
}

int coupling_place(const mjModel* m, int actuator, const InerterDevice* device,
                   char message[INERTER_MESSAGE_SIZE]) {
  if (m->actuator_gainprm[mjNGAIN * actuator + kPlacedSlot] != 0) {
    return 0;
  }

  // the polynomial terms of native damping would be missing in the sensors
  const mjtNum* poly = m->actuator_dampingpoly + mjNPOLY * actuator;
  for (int k = 0; k < mjNPOLY; k++) {
    if (poly[k] != 0) {
      snprintf(message, INERTER_MESSAGE_SIZE,
               "damping has more than one coefficient; use the keys viscous and "
               "quadratic_damping, or give the others to the tendon or joint");
      return -1;
    }
  }

  mjtNum armature = m->actuator_armature[actuator], damping = m->actuator_damping[actuator];
  mjtNum inertance = armature, viscous = damping;
  if (merge(device, INERTER_INDEX_inertance, device->inertance, "armature", &inertance, message) ||
      merge(device, INERTER_INDEX_viscous, device->viscous, "damping", &viscous, message) ||
      check_transmission(m, actuator, inertance, message)) {
    return -1;
  }

  // The model is const to a plugin. It is written here nevertheless, and only here: init runs in
  // the compiler, on a heap object that no other thread knows yet. Every later mj_makeData finds
  // the mark above and only reads.
  mjModel* model = (mjModel*)m;
  model->actuator_armature[actuator] = inertance;
  model->actuator_damping[actuator] = viscous;
  model->actuator_gainprm[mjNGAIN * actuator + kPlacedSlot] = 1;
  if (inertance != armature || viscous != damping) {
    derive(model);
  }
  return 0;
}
