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

#include "mujoco/attachment.h"
#include "mujoco/instance.h"
#include "mujoco/servo.h"

// Slot of actuator_gainprm, unused by plugin actuators, that says where they are. It goes with the
// model through copies and MJB files, so that later edits of actuator_armature count. Its sign is
// what says it: gains may be scaled as a whole.
static const int kPlacedSlot = mjNGAIN - 1;
enum { PLACED_NATIVE = 1, PLACED_PLUGIN = -1 };

// Slots of actuator_dynprm, unused where dyntype is none, with the inertance and the viscous
// damping as configured when the model received them. The engine saves them in XML beside armature
// and damping: what stands there as it was written is the plugin's own statement, not a second one.
static const int kInertanceSlot = mjNDYN - 2, kViscousSlot = mjNDYN - 1;

// relative, of a number with six digits
static const mjtNum kXmlRounding = 5e-6;

static int same_in_xml(mjtNum a, mjtNum b) {
  return fabs(a - b) <= kXmlRounding * mju_max(fabs(a), fabs(b));
}

static mjtNum* written(const mjModel* m, int actuator, int slot) {
  return (mjtNum*)m->actuator_dynprm + mjNDYN * actuator + slot;
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

// whether every pair of dofs that the actuator couples has its place in the inertia matrix
static int fits_inertia(const mjModel* m, int actuator) {
  if (m->actuator_trntype[actuator] != mjTRN_TENDON) {
    return 1;
  }
  int tendon = m->actuator_trnid[2 * actuator];
  if (attachment_wrapped_geom(m, tendon) >= 0) {
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

// refuse what states an inertance or damping twice, or where the engine cannot hold it
static int check_attributes(const mjModel* m, int actuator, const InerterDevice* device,
                            char message[INERTER_MESSAGE_SIZE]) {
  mjtNum armature = m->actuator_armature[actuator], damping = m->actuator_damping[actuator];
  int tendon = m->actuator_trnid[2 * actuator];
  if (armature != 0 || damping != 0) {
    snprintf(message, INERTER_MESSAGE_SIZE,
             "the actuator's %s is %g, but the engine's inertia matrix cannot hold this device (it "
             "joins two branches of the tree, a body with a diagonal inertia matrix, or has a "
             "series element); remove the attribute and state the key %s",
             armature != 0 ? "armature" : "damping", armature != 0 ? armature : damping,
             armature != 0 ? "inertance" : "viscous");
    return -1;
  }
  if (!instance_has_series(device) && m->actuator_trntype[actuator] == mjTRN_TENDON &&
      m->tendon_armature[tendon] != 0) {
    snprintf(message, INERTER_MESSAGE_SIZE,
             "armature of tendon \"%.60s\" is %g, but it joins two branches of the tree, where the "
             "engine drops part of it without a word; remove it and add it to the key inertance",
             attachment_name(m, mjOBJ_TENDON, tendon), m->tendon_armature[tendon]);
    return -1;
  }
  return 0;
}

int placement_is_new(const mjModel* m, int actuator) {
  return m->actuator_gainprm[mjNGAIN * actuator + kPlacedSlot] == 0;
}

// Value that the model is to hold: the configured one, unless only the attribute states it. In XML
// that the engine has saved both stand, as they were written: then the one that was edited counts.
// Return 0, or -1 with a message if both are stated and differ.
static int merge(const mjModel* m, int actuator, const InerterDevice* device, int index, int slot,
                 mjtNum configured, const char* attribute, mjtNum* value,
                 char message[INERTER_MESSAGE_SIZE]) {
  const InerterParameter* parameter = inerter_parameter(index);
  int given = inerter_is_given(device, index);
  mjtNum* mark = written(m, actuator, slot);
  int own = *mark != 0 && same_in_xml(*value, *mark);
  int edited = *mark != 0 && *value != 0 && !own && given && same_in_xml(configured, *mark);
  *mark = given ? configured : 0;
  if (own || (given && !edited)) {
    if (!own && *value != 0 && !same_in_xml(*value, configured)) {
      snprintf(message, INERTER_MESSAGE_SIZE,
               "%s is %g %s, but the actuator's %s is %g: both mean the same; state one of them",
               parameter->name, configured, parameter->unit, attribute, *value);
      return -1;
    }
    *value = configured;
  }
  if (*value < 0) {
    snprintf(message, INERTER_MESSAGE_SIZE, "the actuator's %s is %g; give a value >= 0 %s",
             attribute, *value, parameter->unit);
    return -1;
  }
  return 0;
}

// take back what an earlier compilation wrote, where the device has moved to the plugin since
static void forget(const mjModel* m, int actuator) {
  mjtNum* values[] = {m->actuator_armature + actuator, m->actuator_damping + actuator};
  const int slots[] = {kInertanceSlot, kViscousSlot};
  for (int k = 0; k < 2; k++) {
    mjtNum* mark = written(m, actuator, slots[k]);
    if (*mark != 0 && same_in_xml(*values[k], *mark)) {
      *values[k] = 0;
    }
    *mark = 0;
  }
}

// Inverse weights, and which actuators act on which joint or tendon. The statistics stay as they
// are; no computation reads the mean inertia. It takes long in large models: once for all devices.
static void derive(mjModel* m) {
  mjtSize nplugin = m->nplugin;
  int enableflags = m->opt.enableflags;

  // in a workspace of its own, without plugins (this is inside an init) and with everything awake
  m->nplugin = 0;
  m->opt.enableflags &= ~mjENBL_SLEEP;
  mjData* workspace = mj_makeData(m);
  mjStatistic statistic = m->stat;
  mjtNum* M0 = mju_malloc(sizeof(mjtNum) * (size_t)m->nv);
  mju_copy(M0, m->dof_M0, (int)m->nv);
  mj_setConst(m, workspace);
  m->stat = statistic;
  servo_warn(m, workspace, M0);
  mju_free(M0);
  mj_deleteData(workspace);
  m->opt.enableflags = enableflags;
  m->nplugin = nplugin;
}

// Gains and bias that a class of defaults gives an actuator say nothing to a device, but the
// engine's implicit integrators would read them.
static void without_gains(mjModel* m, int actuator) {
  m->actuator_gaintype[actuator] = mjGAIN_FIXED;
  m->actuator_biastype[actuator] = mjBIAS_NONE;
  mju_zero(m->actuator_gainprm + mjNGAIN * actuator, mjNGAIN);
  mju_zero(m->actuator_biasprm + mjNBIAS * actuator, mjNBIAS);
  m->actuator_gainprm[mjNGAIN * actuator] = 1;
}

int placement_decide(const mjModel* m, int actuator, const InerterDevice* device, int* native,
                     char message[INERTER_MESSAGE_SIZE]) {
  mjtNum mark = m->actuator_gainprm[mjNGAIN * actuator + kPlacedSlot];
  *native = mark > 0;
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
  if (!*native || (series && *written(m, actuator, kInertanceSlot) != 0)) {
    forget(m, actuator);
  }
  if (!*native || (series && m->actuator_armature[actuator] != 0)) {
    *native = 0;
    if (check_attributes(m, actuator, device, message)) {
      return -1;
    }
  } else {
    mjtNum armature = m->actuator_armature[actuator], damping = m->actuator_damping[actuator];
    mjtNum inertance = armature, viscous = damping;
    // a damping that the control sets, or that is no straight line, is the plugin's as a whole
    int own = device->control == INERTER_CONTROL_viscous || inerter_shapes_damping(device);
    double own_viscous = own ? 0 : device->viscous;
    if ((!series && merge(m, actuator, device, INERTER_INDEX_inertance, kInertanceSlot,
                          device->inertance, "armature", &inertance, message)) ||
        merge(m, actuator, device, INERTER_INDEX_viscous, kViscousSlot, own_viscous, "damping",
              &viscous, message)) {
      return -1;
    }
    model->actuator_armature[actuator] = inertance;
    model->actuator_damping[actuator] = viscous;
  }
  without_gains(model, actuator);
  model->actuator_gainprm[mjNGAIN * actuator + kPlacedSlot] =
      *native ? PLACED_NATIVE : PLACED_PLUGIN;
  return 0;
}

void placement_finish(const mjModel* m) {
  for (int i = 0; i < m->nactuator; i++) {
    if (m->actuator_gainprm[mjNGAIN * i + kPlacedSlot] > 0 &&
        (m->actuator_armature[i] != 0 || m->actuator_damping[i] != 0)) {
      derive((mjModel*)m);
      return;
    }
  }
}
