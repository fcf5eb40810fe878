// Where the inertance and the viscous damping live.
//
//   native   M = M_bodies + b J'J,   qfrc_bias += b J' (dJ/dt v),   qfrc_passive -= c J'J v
//   plugin   a force that is found together with the acceleration (coupled.c)
//
// J: row of the actuator's moment arms, v = qvel, b = actuator_armature, c = actuator_damping.
//
// The engine stores M in the sparsity of the kinematic tree and drops what falls outside without a
// word: between two branches (wheel and body both in the world, two floors, two free bodies) its
// armature simulates another device. There, and where a body is "simple" (its part of M is
// diagonal), the plugin carries the inertance. A device with a series element has no inertance at
// its terminals: the flywheel is a state.
//
// Why native where it fits: no cost, and contacts, inverse dynamics and derivatives see it.

#include "mujoco/placement.h"

#include <math.h>
#include <stdio.h>

#include "mujoco/instance.h"

// Slot of actuator_gainprm, unused by plugin actuators, that says where they are. It goes with the
// model through copies and MJB files, so that later edits of actuator_armature count.
static const int kPlacedSlot = mjNGAIN - 1;
enum { PLACED_NATIVE = 1, PLACED_PLUGIN = 2 };

static const char* name_of(const mjModel* m, mjtObj type, int id) {
  const char* name = mj_id2name(m, type, id);
  return name && *name ? name : "(unnamed)";
}

//------------------------------ transmission ------------------------------------------------------

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

// the geom that a tendon wraps around, or -1
static int wrapped_geom(const mjModel* m, int tendon) {
  for (int k = m->tendon_adr[tendon]; k < m->tendon_adr[tendon] + m->tendon_num[tendon]; k++) {
    if (m->wrap_type[k] == mjWRAP_SPHERE || m->wrap_type[k] == mjWRAP_CYLINDER) {
      return m->wrap_objid[k];
    }
  }
  return -1;
}

// whether every pair of dofs that the actuator couples has its place in the inertia matrix
static int fits_inertia(const mjModel* m, int actuator) {
  if (m->actuator_trntype[actuator] != mjTRN_TENDON) {
    return 1;
  }
  int tendon = m->actuator_trnid[2 * actuator];
  if (wrapped_geom(m, tendon) >= 0) {
    return 0;
  }
  int start = m->ten_J_rowadr[tendon], end = start + m->ten_J_rownnz[tendon];
  for (int k = start; k < end; k++) {
    for (int l = start; l < k; l++) {
      if (!in_inertia(m, m->ten_J_colind[l], m->ten_J_colind[k])) {
        return 0;
      }
    }
  }
  return 1;
}

// refuse a transmission that is not a single distance or angle
static int check_transmission(const mjModel* m, int actuator, const InerterDevice* device,
                              char message[INERTER_MESSAGE_SIZE]) {
  int target = m->actuator_trnid[2 * actuator], geom;
  switch (m->actuator_trntype[actuator]) {
    case mjTRN_TENDON:
      geom = wrapped_geom(m, target);
      if (geom >= 0 && device->inertance > 0 && !instance_has_series(device)) {
        snprintf(message, INERTER_MESSAGE_SIZE,
                 "inertance is %g kg, but tendon \"%.40s\" wraps around geom \"%.40s\": the engine "
                 "does not know how such a tendon accelerates; route it through sites and pulleys, "
                 "or state the elasticity (series_stiffness) that a wrapping tendon has",
                 device->inertance, name_of(m, mjOBJ_TENDON, target), name_of(m, mjOBJ_GEOM, geom));
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

// the states a device needs, in words
static void states_text(const InerterDevice* device, char text[160]) {
  int length = 0;
  text[0] = 0;
  for (int i = 0; i < inerter_nstate(device); i++) {
    length += snprintf(text + length, 160 - length, "%s%s", i ? ", " : ": ",
                       inerter_state_name(device, i));
  }
}

int placement_check(const mjModel* m, int actuator, const InerterDevice* device,
                    char message[INERTER_MESSAGE_SIZE]) {
  if (m->actuator_dyntype[actuator] != mjDYN_NONE) {
    snprintf(message, INERTER_MESSAGE_SIZE,
             "dyntype is given; a device has no other dynamics than its own: remove dyntype");
    return -1;
  }
  int nstate = inerter_nstate(device);
  if (m->actuator_actnum[actuator] != nstate) {
    char states[160];
    states_text(device, states);
    snprintf(message, INERTER_MESSAGE_SIZE,
             "actdim is %d, but the device (friction \"%s\"%s) has %d state%s%s; %s actdim=\"%d\" "
             "in <plugin>",
             m->actuator_actnum[actuator], inerter_friction_name(device->friction),
             instance_has_series(device) ? ", series element" : "", nstate, nstate == 1 ? "" : "s",
             states, nstate ? "write" : "remove it or write", nstate);
    return -1;
  }
  return check_transmission(m, actuator, device, message);
}

//------------------------------ placement ---------------------------------------------------------

int placement_is_new(const mjModel* m, int actuator) {
  return m->actuator_gainprm[mjNGAIN * actuator + kPlacedSlot] == 0;
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

// what would cut or double a force that the plugin has to apply in full
static int check_plugin_force(const mjModel* m, int actuator, char message[INERTER_MESSAGE_SIZE]) {
  mjtNum armature = m->actuator_armature[actuator], damping = m->actuator_damping[actuator];
  if (armature != 0 || damping != 0) {
    snprintf(message, INERTER_MESSAGE_SIZE,
             "the actuator's %s is %g, but the engine's inertia matrix cannot hold this device (it "
             "joins two branches of the tree, a body with a diagonal inertia matrix, or has a "
             "series element); remove the attribute and state the key %s",
             armature != 0 ? "armature" : "damping", armature != 0 ? armature : damping,
             armature != 0 ? "inertance" : "viscous");
    return -1;
  }
  if (m->actuator_trntype[actuator] != mjTRN_TENDON) {
    return 0;
  }
  int tendon = m->actuator_trnid[2 * actuator], limited = m->tendon_actfrclimited[tendon];
  if (m->actuator_forcelimited[actuator] || limited) {
    snprintf(message, INERTER_MESSAGE_SIZE,
             "%s is given, but the inertance is a force of this actuator (the engine's inertia "
             "matrix cannot hold it) and would be cut; remove it",
             limited ? "actuatorfrcrange of the tendon" : "forcerange");
    return -1;
  }
  int start = m->ten_J_rowadr[tendon], end = start + m->ten_J_rownnz[tendon];
  for (int k = start; k < end; k++) {
    int joint = m->dof_jntid[m->ten_J_colind[k]];
    if (m->jnt_actfrclimited[joint]) {
      snprintf(message, INERTER_MESSAGE_SIZE,
               "actuatorfrcrange of joint \"%.60s\" is given, but the inertance is a force of an "
               "actuator (the engine's inertia matrix cannot hold it) and would be cut; remove it",
               name_of(m, mjOBJ_JOINT, joint));
      return -1;
    }
  }
  return 0;
}

int placement_decide(const mjModel* m, int actuator, const InerterDevice* device, int* native,
                     char message[INERTER_MESSAGE_SIZE]) {
  mjtNum mark = m->actuator_gainprm[mjNGAIN * actuator + kPlacedSlot];
  *native = mark == PLACED_NATIVE;
  if (mark != 0) {
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

  // The model is const to a plugin. It is written here nevertheless, and only here: init runs in
  // the compiler, on a heap object that no other thread knows yet. Every later mj_makeData finds
  // the mark above and only reads.
  mjModel* model = (mjModel*)m;
  int series = instance_has_series(device);
  *native = fits_inertia(m, actuator);
  if (!*native || (series && m->actuator_armature[actuator] != 0)) {
    *native = 0;
    if (check_plugin_force(m, actuator, message)) {
      return -1;
    }
  } else {
    mjtNum armature = m->actuator_armature[actuator], damping = m->actuator_damping[actuator];
    mjtNum inertance = armature, viscous = damping;
    if ((!series && merge(device, INERTER_INDEX_inertance, device->inertance, "armature",
                          &inertance, message)) ||
        merge(device, INERTER_INDEX_viscous, device->viscous, "damping", &viscous, message)) {
      return -1;
    }
    model->actuator_armature[actuator] = inertance;
    model->actuator_damping[actuator] = viscous;
    if (inertance != armature || viscous != damping) {
      derive(model);
    }
  }
  model->actuator_gainprm[mjNGAIN * actuator + kPlacedSlot] =
      *native ? PLACED_NATIVE : PLACED_PLUGIN;
  return 0;
}

//------------------------------ doubts ------------------------------------------------------------

// acceleration per force along the actuator, in the initial configuration [1/kg]
static mjtNum mobility(const mjModel* m, int actuator) {
  mjtNum gear = m->actuator_gear[6 * m->actuator_outadr[actuator]];
  int target = m->actuator_trnid[2 * actuator];
  mjtNum weight = m->actuator_trntype[actuator] == mjTRN_TENDON
                      ? m->tendon_invweight0[target]
                      : m->dof_invweight0[m->jnt_dofadr[target]];
  return gear * gear * weight;
}

// slope of the friction force over velocity at rest, for laws without memory [N s/m]
static double friction_slope(const InerterDevice* device) {
  const double none[INERTER_MAXSTATE] = {0}, small = 1e-9;
  int memory = device->friction == INERTER_FRICTION_dahl ||
               device->friction == INERTER_FRICTION_lugre ||
               device->friction == INERTER_FRICTION_bouc_wen;
  return memory ? 0 : inerter_friction_force(device, 0, small, none) / small;
}

int placement_doubt(const mjModel* m, int actuator, const InerterDevice* device, int native,
                    char message[INERTER_MESSAGE_SIZE]) {
  if (m->opt.integrator != mjINT_RK4) {
    return 0;
  }

  // explicit stages resolve an oscillation of omega h < 2.8 and a decay of lambda h < 2.7
  mjtNum h = m->opt.timestep, light = mobility(m, actuator);
  if (instance_has_series(device)) {
    mjtNum both = 1 / device->inertance + light;
    mjtNum rate = fmax(sqrt(device->series_stiffness * both), device->series_damping * both);
    if (device->backlash > 0 && device->series_damping > 0) {
      rate = fmax(rate, device->series_stiffness / device->series_damping);
    }
    if (h * rate > 2.5) {
      snprintf(message, INERTER_MESSAGE_SIZE,
               "series_stiffness %g N/m and series_damping %g N*s/m are too stiff for RK4 with a "
               "timestep of %g s; set timestep <= %.2g, or integrator=\"implicitfast\"",
               device->series_stiffness, device->series_damping, h, 2.5 / rate);
      return 1;
    }
  } else if (!native) {
    light /= 1 + light * device->inertance;
  }
  mjtNum rate = friction_slope(device) * light;
  if (h * rate > 2.5) {
    snprintf(
        message, INERTER_MESSAGE_SIZE,
        "friction \"%s\" changes its sign too sharply for RK4 with a timestep of %g s and will "
        "chatter within its level; raise %s %.2g times, or set integrator=\"implicitfast\"",
        inerter_friction_name(device->friction), h,
        device->friction == INERTER_FRICTION_brown_mcphee ? "stribeck_velocity"
                                                          : "transition_velocity",
        ceil(h * rate / 2.5));
    return 1;
  }
  return 0;
}
