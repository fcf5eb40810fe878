// What there is to configure: names, units, ranges and meanings, from the lists in parameters.h.

#include "device.h"
#include "laws.h"

enum { CLOSED = 0, OPEN = 1 };

static const InerterParameter kParameters[] = {
#define X(name, unit, initial, lower, upper, bound, laws, meaning) \
  {#name, unit, initial, lower, upper, bound, offsetof(InerterDevice, name), laws, meaning},
    INERTER_PARAMETERS(X)
#undef X
};

static const struct {
  const char* name;
  int nstate;
  const char* meaning;
} kFriction[] = {
#define X(identifier, nstate, meaning) {#identifier, nstate, meaning},
    INERTER_FRICTION_LAWS(X)
#undef X
};

static const struct {
  const char* name;
  const char* meaning;
} kGas[] = {
#define X(identifier, meaning) {#identifier, meaning},
    INERTER_GAS_LAWS(X)
#undef X
};

static const struct {
  const char* name;
  const char* meaning;
} kSide[] = {
#define X(identifier, meaning) {#identifier, meaning},
    INERTER_FRICTION_SIDES(X)
#undef X
};

static const struct {
  const char* name;
  const char* meaning;
} kControl[] = {
#define X(identifier, meaning) {#identifier, meaning},
    INERTER_CONTROLS(X)
#undef X
};

const FrictionLaw* const inerter_friction_law[] = {
#define inerter_none inerter_coulomb  // never called: "none" is tested first
#define X(identifier, nstate, meaning) &inerter_##identifier,
    INERTER_FRICTION_LAWS(X)
#undef X
#undef inerter_none
};

static const InerterList kLists[] = {
#define X(name, unit, laws, meaning)                                \
  {#name "_curve",                                                  \
   unit,                                                            \
   INERTER_MAXCURVE,                                                \
   0,                                                               \
   laws,                                                            \
   meaning ", at evenly spaced x from curve_lower to curve_upper"}, \
      {#name "_periods",                                            \
       unit,                                                        \
       3 * INERTER_MAXPERIOD,                                       \
       1,                                                           \
       laws,                                                        \
       meaning ", length [m], amplitude and phase [rad] of each sine of x"},
    INERTER_STROKES(X)
#undef X
        {"force_map", "N", INERTER_MAXMAP, 0, "",
         "force over displacement (rows) and velocity (columns), row by row"},
};

const InerterList* inerter_list(int i) {
  return i >= 0 && i < INERTER_NLIST ? &kLists[i] : NULL;
}

size_t inerter_device_size(void) {
  return sizeof(InerterDevice);
}

const InerterParameter* inerter_parameter(int i) {
  return i >= 0 && i < INERTER_NPARAMETER ? &kParameters[i] : NULL;
}

const char* inerter_friction_name(int i) {
  return i >= 0 && i < INERTER_NFRICTION ? kFriction[i].name : NULL;
}

const char* inerter_friction_meaning(int i) {
  return i >= 0 && i < INERTER_NFRICTION ? kFriction[i].meaning : NULL;
}

int inerter_friction_nstate(int i) {
  return i >= 0 && i < INERTER_NFRICTION ? kFriction[i].nstate : -1;
}

const char* inerter_gas_law_name(int i) {
  return i >= 0 && i < INERTER_NGAS ? kGas[i].name : NULL;
}

const char* inerter_gas_law_meaning(int i) {
  return i >= 0 && i < INERTER_NGAS ? kGas[i].meaning : NULL;
}

const char* inerter_friction_side_name(int i) {
  return i >= 0 && i < INERTER_NSIDE ? kSide[i].name : NULL;
}

const char* inerter_friction_side_meaning(int i) {
  return i >= 0 && i < INERTER_NSIDE ? kSide[i].meaning : NULL;
}

const char* inerter_control_name(int i) {
  return i >= 0 && i < INERTER_NCONTROL ? kControl[i].name : NULL;
}

const char* inerter_control_meaning(int i) {
  return i >= 0 && i < INERTER_NCONTROL ? kControl[i].meaning : NULL;
}

const char* inerter_state_name(const InerterDevice* device, int i) {
  static const char* const kSeries[] = {"series_deflection", "flywheel_velocity", "gap_position"};
  if (i < 0 || i >= device->nstate) {
    return NULL;
  }
  static const char* const kSlip[] = {"friction_state_1", "friction_state_2", "friction_state_3",
                                      "friction_state_4", "friction_state_5", "friction_state_6",
                                      "friction_state_7", "friction_state_8"};
  static const char* const kBranch[] = {"branch_deflection_1", "branch_deflection_2",
                                        "branch_deflection_3"};
  if (device->ncontrol && i == device->nstate - 1) {
    return "control_change";
  }
  if (device->ndamper && i == damper_index(device)) {
    return "damper_velocity";
  }
  if (i >= branch_index(device)) {
    return kBranch[i - branch_index(device)];
  }
  if (i == device->nfriction + 2 && has(device, PART_CLUTCH)) {
    return "slip_position";
  }
  if (i >= device->nfriction) {
    return kSeries[i - device->nfriction];
  }
  return device->friction == INERTER_FRICTION_maxwell_slip ? kSlip[i] : "friction_state";
}

const char* inerter_compiler(void) {
#if defined(__clang__)
  return "clang " __clang_version__;
#elif defined(__GNUC__)
  return "gcc " __VERSION__;
#else
  return "unknown";
#endif
}
