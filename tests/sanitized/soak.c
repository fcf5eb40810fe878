// A great many steps of the plugin in the engine: states and energies stay
// where they belong.
//
//   soak PLUGIN STEPS
//
// Without losses, semi-implicit Euler keeps H = v'Mv / 2 + x'Kx / 2 - h x'Kv /
// 2 of a linear model exactly: what drifts is the plugin's or rounding. With
// losses, driven periodically, every state stays within what its law can hold,
// and the heat of a later stretch is that of an earlier one.

#include <math.h>
#include <mujoco/mujoco.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PERIOD = 500, MAXSTATE = 4 };

static const double kInertance = 4, kLower = 2,
                    kUpper = 3;                              // kg: device, bodies
static const double kLowerSpring = 800, kUpperSpring = 500;  // N/m
static const double kSwing = 20;                             // N

typedef struct Case_ {
  const char* name;
  const char* keys;  // key value key value ...
  int nstate;
  double bound[MAXSTATE];  // of the states; 0: of the motion's own size
} Case;

// f_s / sigma0 = 2e-3 m; (alpha / (beta + gamma))^(1/n) = 2e-3 m
static const Case kCases[] = {
    {"inertance", "", 0, {0}},
    {"coulomb", "friction coulomb coulomb_force 5 transition_velocity 1e-2", 0, {0}},
    {"stribeck",
     "friction stribeck coulomb_force 5 static_force 8 transition_velocity "
     "1e-2",
     0,
     {0}},
    {"dahl", "friction dahl coulomb_force 5 bristle_stiffness 5e3", 1, {1e-3}},
    {"lugre", "friction lugre coulomb_force 5 static_force 10 bristle_stiffness 5e3", 1, {2e-3}},
    {"bouc_wen", "friction bouc_wen bw_beta 300 bw_gamma 200 bw_stiffness 5e3", 1, {2e-3}},
    {"brown_mcphee", "friction brown_mcphee coulomb_force 5 static_force 8", 0, {0}},
    {"friction play",
     "friction dahl coulomb_force 5 bristle_stiffness 5e3 friction_backlash "
     "1e-3",
     1,
     {2e-3}},
    {"series", "series_stiffness 2e4 series_damping 20 viscous 5", 2, {0}},
    {"backlash",
     "series_stiffness 2e4 series_damping 20 backlash 1e-3 friction lugre "
     "coulomb_force 5 "
     "bristle_stiffness 5e3",
     4,
     {1e-3, 0, 0, 1e-3}},
    {"stops",
     "stop_lower -0.02 stop_upper 0.02 stop_stiffness 2e4 stop_damping 1 "
     "viscous 5",
     0,
     {0}},
    {"gas", "gas_pressure 1e5 gas_area 1e-4 gas_volume 1e-4 viscous 20", 0, {0}},
    {"channel",
     "piston_area 2e-3 channel_area 1e-3 channel_length 1 fluid_viscosity 1e-3 "
     "minor_loss 2",
     0,
     {0}},
    {"varying", "inertance_gradient 0.5 load_friction 0.05 viscous 5", 0, {0}},
};
enum { CASES = sizeof(kCases) / sizeof(*kCases) };

//------------------------------ model
//-------------------------------------------------------------

static mjModel* make(const Case* c, int siblings, const char* integrator) {
  char xml[4000], config[2000] = "", words[1000], error[1000] = "";
  snprintf(words, sizeof(words), "%s", c->keys);
  if (!strstr(words, "channel_area")) {
    snprintf(config, sizeof(config), "<config key=\"inertance\" value=\"%g\"/>", kInertance);
  }
  char* rest = NULL;
  for (char* key = strtok_r(words, " ", &rest); key; key = strtok_r(NULL, " ", &rest)) {
    size_t length = strlen(config);
    snprintf(config + length, sizeof(config) - length, "<config key=\"%s\" value=\"%s\"/>", key,
             strtok_r(NULL, " ", &rest));
  }
  snprintf(xml, sizeof(xml),
           "<mujoco><option gravity=\"0 0 0\" timestep=\"1e-3\" integrator=\"%s\"/>"
           "<extension><plugin plugin=\"inerter.device\"><instance "
           "name=\"d\">%s</instance></plugin>"
           "</extension><worldbody>"
           "<body><joint name=\"lower\" type=\"slide\" axis=\"0 0 1\" "
           "stiffness=\"%g\" damping=\"%d\"/>"
           "<geom size=\"0.1\" mass=\"%g\" contype=\"0\"/>%s"
           "<body><joint name=\"upper\" type=\"slide\" axis=\"0 0 1\" "
           "stiffness=\"%g\"/>"
           "<geom size=\"0.1\" mass=\"%g\" contype=\"0\"/></body>%s</worldbody>"
           "<tendon><fixed name=\"t\"><joint joint=\"upper\" "
           "coef=\"1\"/>%s</fixed></tendon>"
           "<actuator><plugin plugin=\"inerter.device\" instance=\"d\" tendon=\"t\" "
           "actdim=\"%d\"/>"
           "</actuator><sensor><plugin plugin=\"inerter.device\" "
           "instance=\"d\"/></sensor></mujoco>",
           integrator, config, kLowerSpring, *c->keys ? 20 : 0, kLower, siblings ? "</body>" : "",
           kUpperSpring, kUpper, siblings ? "" : "</body>",
           siblings ? "<joint joint=\"lower\" coef=\"-1\"/>" : "", c->nstate);
  mjSpec* spec = mj_parseXMLString(xml, NULL, error, sizeof(error));
  mjModel* m = spec ? mj_compile(spec, NULL) : NULL;
  if (!m) {
    fprintf(stderr, "%s: %s\n", c->name, spec ? mjs_getError(spec) : error);
    exit(1);
  }
  mj_deleteSpec(spec);
  return m;
}

//------------------------------ energies
//----------------------------------------------------------

// what semi-implicit Euler keeps
static double kept(const mjData* d, int siblings, double h) {
  double x = d->qpos[0], y = d->qpos[1], v = d->qvel[0], w = d->qvel[1];
  double along = siblings ? w - v : w, upper = siblings ? w : v + w;
  double kinetic = kLower * v * v + kUpper * upper * upper + kInertance * along * along;
  double springs = kLowerSpring * x * x + kUpperSpring * y * y;
  double mixed = kLowerSpring * x * v + kUpperSpring * y * w;
  return 0.5 * (kinetic + springs - h * mixed);
}

static void lossless(long steps) {
  for (int siblings = 0; siblings < 2; siblings++) {
    mjModel* m = make(&kCases[0], siblings, "Euler");
    mjData* d = mj_makeData(m);
    d->qvel[0] = 0.3;
    d->qvel[1] = -0.5;
    double first = kept(d, siblings, m->opt.timestep), worst = 0;
    for (long i = 0; i < steps; i++) {
      mj_step(m, d);
      worst = fmax(worst, fabs(kept(d, siblings, m->opt.timestep) / first - 1));
    }
    printf("lossless, %s: energy kept within %.2g\n", siblings ? "branches" : "nested", worst);
    if (!(worst < 1e-9)) {
      fprintf(stderr, "energy drifts by %g\n", worst);
      exit(1);
    }
    mj_deleteData(d);
    mj_deleteModel(m);
  }
}

static void driven(const Case* c, int siblings, const char* integrator, long steps) {
  mjModel* m = make(c, siblings, integrator);
  mjData* d = mj_makeData(m);
  double reached[2 + MAXSTATE] = {0}, heat[3] = {0};
  const double* sensor = d->sensordata + m->nsensordata - 2;  // stored, dissipated
  double stored = 0;
  long stretch = steps / 3 / PERIOD * PERIOD;
  for (long i = 0; i < 3 * stretch; i++) {
    d->ctrl[0] = kSwing * sin(2 * mjPI * (double)(i % PERIOD) / PERIOD);
    mj_step(m, d);
    for (int k = 0; k < 2; k++) reached[k] = fmax(reached[k], fabs(d->qpos[k]));
    for (int k = 0; k < c->nstate; k++) reached[2 + k] = fmax(reached[2 + k], fabs(d->act[k]));
    stored = fmax(stored, sensor[0]);
    if ((i + 1) % stretch == 0) heat[(i + 1) / stretch - 1] = sensor[1];
  }
  double earlier = heat[1] - heat[0], later = heat[2] - heat[1];
  printf("%s, %s, %s: |x| <= %.2g %.2g, stored <= %.2g J, heat %.4g and %.4g J\n", c->name,
         siblings ? "branches" : "nested", integrator, reached[0], reached[1], stored, earlier,
         later);
  int bounded = reached[0] < 0.5 && reached[1] < 0.5 && isfinite(stored) && isfinite(later);
  for (int k = 0; k < c->nstate; k++) {
    bounded &= reached[2 + k] <= (c->bound[k] > 0 ? c->bound[k] * (1 + 1e-9) : 5);
  }
  for (int k = 0; k < mjNWARNING; k++) {
    bounded &= d->warning[k].number == 0;
  }

  // the heat of two periods may fall into either stretch, where the motion does
  // not repeat exactly
  if (!bounded || !(fabs(later - earlier) <= 2 * earlier * PERIOD / (double)stretch)) {
    fprintf(stderr, "%s, %s: not bounded, or not the same heat\n", c->name, integrator);
    for (int k = 0; k < c->nstate; k++) fprintf(stderr, "state %d reaches %g\n", k, reached[2 + k]);
    exit(1);
  }
  mj_deleteData(d);
  mj_deleteModel(m);
}

static void warn(const char* text) {
  fprintf(stderr, "%s\n", text);
  exit(1);
}

int main(int argc, char** argv) {
  if (argc < 3) {
    fprintf(stderr, "soak PLUGIN STEPS\n");
    return 2;
  }
  mju_user_warning = warn;
  mj_loadPluginLibrary(argv[1]);
  long each = atol(argv[2]) / (2 + CASES);
  lossless(each);
  const char* const integrators[] = {"implicitfast", "RK4", "Euler", "discrete", "implicit"};
  for (int i = 0; i < CASES; i++) {
    if (i) driven(kCases + i, i % 2, integrators[i % 5], each);
  }
  return 0;
}
