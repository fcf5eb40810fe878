// See engine_models.h.

#include "engine_models.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

const char* const kIntegrators[INTEGRATORS] = {"Euler", "implicit", "implicitfast", "discrete",
                                               "RK4"};

//------------------------------ text
//--------------------------------------------------------------

typedef struct Text_ {
  char* bytes;
  size_t length, size;
} Text;

static void add(Text* text, const char* format, ...) {
  if (text->size - text->length < 4096) {
    text->size += 65536;
    text->bytes = realloc(text->bytes, text->size);
    if (!text->bytes) {
      abort();
    }
  }
  va_list values;
  va_start(values, format);
  text->length += (size_t)vsnprintf(text->bytes + text->length, 4096, format, values);
  va_end(values);
}

static void key(Text* text, const char* name, double value) {
  add(text, "<config key=\"%s\" value=\"%.17g\"/>", name, value);
}

//------------------------------ devices
//-----------------------------------------------------------

enum { NONE, COULOMB, STRIBECK, DAHL, LUGRE, BOUC_WEN, BROWN_MCPHEE };
enum {
  RIGID,
  SERIES,
  BACKLASH,
  STOPS,
  CHANNEL,
  VARYING,
  FRICTION_PLAY,
  DAMPER_ONLY,
  COMMANDED,
  LAGGING
};

static int has_memory(int law) {
  return law == DAHL || law == LUGRE || law == BOUC_WEN;
}

static int count_states(int law, int variant) {
  int series = variant == SERIES || variant == BACKLASH;
  return has_memory(law) + 2 * series + (variant == BACKLASH) + (variant == LAGGING);
}

static void friction(Text* text, int law) {
  const char* const names[LAWS] = {"none",  "coulomb",  "stribeck",    "dahl",
                                   "lugre", "bouc_wen", "brown_mcphee"};
  add(text, "<config key=\"friction\" value=\"%s\"/>", names[law]);
  if (law == BOUC_WEN) {
    key(text, "bw_stiffness", 2e3);
    key(text, "bw_beta", 300);
    key(text, "bw_gamma", 200);
    key(text, "bw_ratio", 0.2);
  } else if (law != NONE) {
    key(text, "coulomb_force", 5);
  }
  if (law == STRIBECK || law == LUGRE || law == BROWN_MCPHEE) {
    key(text, "static_force", 8);
  }
  if (law == COULOMB || law == STRIBECK) {
    key(text, "transition_velocity", 1e-2);
  }
  if (law == DAHL || law == LUGRE) {
    key(text, "bristle_stiffness", 5e3);
  }
}

static void configuration(Text* text, int law, int variant, double rest_length) {
  friction(text, law);
  key(text, "rest_length", rest_length);
  if (variant != CHANNEL) {
    key(text, "inertance", variant == DAMPER_ONLY ? 0 : 3);
  }
  switch (variant) {
    case BACKLASH:
      key(text, "backlash", 1e-3);
      // fall through
    case SERIES:
      key(text, "series_stiffness", 2e4);
      key(text, "series_damping", 50);
      key(text, "flywheel_viscous", 1);
      break;
    case STOPS:
      key(text, "stop_lower", -0.02);
      key(text, "stop_upper", 0.02);
      key(text, "stop_stiffness", 2e4);
      key(text, "stop_damping", 0.5);
      key(text, "stop_stiffness_cubic", 1e7);
      key(text, "gas_pressure", 1e5);
      key(text, "gas_area", 1e-4);
      key(text, "gas_volume", 1e-4);
      break;
    case CHANNEL:
      key(text, "piston_area", 1e-3);
      key(text, "channel_area", 5e-4);
      key(text, "channel_length", 1);
      key(text, "fluid_viscosity", 1e-3);
      key(text, "minor_loss", 1.5);
      break;
    case VARYING:
      key(text, "inertance_gradient", 0.5);
      key(text, "load_friction", 0.05);
      break;
    case FRICTION_PLAY:
      key(text, has_memory(law) ? "friction_backlash" : "stiffness_cubic", 1e-3);
      break;
    case DAMPER_ONLY:
      key(text, "viscous", 10);
      key(text, "quadratic_damping", 10);
      break;
    case COMMANDED:
    case LAGGING:
      add(text, "<config key=\"control\" value=\"%s\"/>",
          variant == LAGGING ? "inertance" : "viscous");
      key(text, "control_lower", variant == LAGGING ? 1 : 0);
      key(text, "control_upper", 20);
      key(text, "control_lag", variant == LAGGING ? 0.02 : 0);
      break;
    default:
      break;
  }
}

//------------------------------ model
//-------------------------------------------------------------

char* engine_model(Random* random, int devices, int first, const char* integrator) {
  Text bodies = {0}, instances = {0}, tendons = {0}, actuators = {0}, sensors = {0}, all = {0};
  int depth = 0;
  for (int k = 0; k <= devices; k++) {
    // a body in the world, or on the one before it: between branches, or within
    // one
    for (int in_world = depth && below(random, 2); in_world && depth; depth--) {
      add(&bodies, "</body>\n");
    }
    add(&bodies, "<body pos=\"%g 0 %g\">", depth ? 0.3 : 0.3 * k, depth ? 0 : 0.5);
    if (k == devices) {
      add(&bodies, depth ? "<joint type=\"ball\"/>" : "<freejoint/>");
    } else {
      add(&bodies,
          "<joint name=\"j%d\" type=\"slide\" axis=\"0 0 1\" "
          "stiffness=\"2000\"",
          k);
      add(&bodies, " damping=\"%d\"/>", below(random, 2) * 5);
    }
    add(&bodies, "<geom size=\"0.1\" mass=\"%g\" contype=\"%d\"/>", 1 + uniform(random),
        k % 4 == 0);
    add(&bodies, "<site name=\"s%d\" pos=\"0 0 0.05\"/>\n", k);
    depth++;
  }
  for (; depth; depth--) {
    add(&bodies, "</body>\n");
  }
  for (int k = 0; k < devices; k++) {
    int law = (first + k) % LAWS, variant = (first + k) / LAWS % VARIANTS, joint = k % 5 == 4;
    add(&instances, "<instance name=\"d%d\">", k);
    configuration(&instances, law, variant, joint ? 0 : 0.3);
    add(&instances, "</instance>\n");
    add(&tendons, "<spatial name=\"t%d\">", k);
    add(&tendons, "<site site=\"s%d\"/><site site=\"s%d\"/></spatial>\n", k, k + 1);
    add(&actuators, "<plugin name=\"a%d\" plugin=\"inerter.device\" instance=\"d%d\"", k, k);
    add(&actuators, " %s=\"%c%d\"", joint ? "joint" : "tendon", joint ? 'j' : 't', k);
    int states = count_states(law, variant);
    if (states) {
      add(&actuators, " actdim=\"%d\"", states);
    }
    add(&actuators, "/>\n");
    if (k % 3) {
      add(&sensors, "<plugin plugin=\"inerter.device\" instance=\"d%d\"/>\n", k);
    }
  }

  // a tendon around a geom, whose device needs a series element
  add(&bodies,
      "<body pos=\"-2 0 1\"><joint type=\"slide\" axis=\"0 0 1\" "
      "stiffness=\"500\"/>"
      "<geom size=\"0.1\" mass=\"1\"/><site name=\"hung\"/></body>"
      "<geom name=\"drum\" pos=\"-1.5 0 1.5\" size=\"0.2\"/><site "
      "name=\"post\" pos=\"-1 0 "
      "1\"/>\n");
  add(&instances, "<instance name=\"around\">");
  configuration(&instances, LUGRE, SERIES, 1.5);
  add(&instances, "</instance>\n");
  add(&tendons,
      "<spatial name=\"around\"><site site=\"hung\"/><geom "
      "geom=\"drum\"/><site site=\"post\"/>"
      "</spatial>\n");
  add(&actuators,
      "<plugin name=\"around\" plugin=\"inerter.device\" "
      "instance=\"around\" tendon=\"around\""
      " actdim=\"3\"/>\n");

  add(&all, "<mujoco><option timestep=\"1e-3\" integrator=\"%s\"/>\n", integrator);
  const char* const ground = "<geom type=\"plane\" size=\"9 9 1\" pos=\"0 0 0.35\"/>";
  const Text* parts[] = {&instances, &bodies, &tendons, &actuators, &sensors};
  const char* const before[] = {"<extension><plugin plugin=\"inerter.device\">",
                                "</plugin></extension><worldbody>", "</worldbody><tendon>",
                                "</tendon><actuator>", "</actuator><sensor>"};
  for (int i = 0; i < 5; i++) {
    add(&all, "%s%s\n", before[i], i == 1 ? ground : "");
    for (size_t at = 0; at < parts[i]->length; at += 4000) {
      add(&all, "%.4000s", parts[i]->bytes + at);
    }
    free(parts[i]->bytes);
  }
  add(&all, "</sensor><custom><numeric name=\"a0.viscous\" data=\"2\"/></custom>");
  add(&all, "<keyframe><key time=\"0.5\"/></keyframe></mujoco>");
  return all.bytes;
}
