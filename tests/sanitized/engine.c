// The plugin inside the engine, driven as hard as the engine lets: many
// devices, mjData copied, reset, restored and freed in every order, threads,
// batches, recompiled models, numbers that are none. A sanitizer's report or a
// broken promise ends it with an error.
//
//   engine PLUGIN ROUNDS [SCENARIO]

#include <mujoco/mjbatch.h>
#include <mujoco/mujoco.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "engine_models.h"

#define REQUIRE(condition)                                                         \
  do {                                                                             \
    if (!(condition)) {                                                            \
      fprintf(stderr, "engine.c:%d: %s; last message: %s\n", __LINE__, #condition, \
              last_message());                                                     \
      exit(1);                                                                     \
    }                                                                              \
  } while (0)

//------------------------------ messages
//----------------------------------------------------------

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static char last[1024];
static long count;

static void hear(const mjLogMessage* message) {
  if (message->level < mjLOG_WARNING) {
    return;
  }
  pthread_mutex_lock(&lock);
  snprintf(last, sizeof(last), "%s", message->subject);
  count++;
  pthread_mutex_unlock(&lock);
}

static const char* last_message(void) {
  return last;
}

static long message_count(void) {
  pthread_mutex_lock(&lock);
  long found = count;
  pthread_mutex_unlock(&lock);
  return found;
}

//------------------------------ helpers
//-----------------------------------------------------------

static mjModel* compile_text(const char* text) {
  char error[1000] = "";
  mjSpec* spec = mj_parseXMLString(text, NULL, error, sizeof(error));
  mjModel* m = spec ? mj_compile(spec, NULL) : NULL;
  if (!m) {
    fprintf(stderr, "%s\n%s\n", text, spec ? mjs_getError(spec) : error);
    exit(1);
  }
  mj_deleteSpec(spec);
  return m;
}

static mjModel* random_model(Random* random, int devices) {
  int first = below(random, LAWS * VARIANTS);
  char* text = engine_model(random, devices, first, kIntegrators[below(random, INTEGRATORS)]);
  mjModel* m = compile_text(text);
  free(text);
  return m;
}

static void kick(const mjModel* m, mjData* d, Random* random) {
  for (int i = 0; i < m->nv; i++) {
    d->qvel[i] = 0.5 * (uniform(random) - 0.5);
  }
}

static void steps(const mjModel* m, mjData* d, int n) {
  for (int i = 0; i < n; i++) {
    mj_step(m, d);
  }
}

// whether two mjData are at the same state, bit for bit
static int same_state(const mjModel* m, const mjData* a, const mjData* b) {
  int size = mj_stateSize(m, mjSTATE_INTEGRATION);
  mjtNum* states = malloc(2 * sizeof(mjtNum) * (size_t)size);
  mj_getState(m, a, states, mjSTATE_INTEGRATION);
  mj_getState(m, b, states + size, mjSTATE_INTEGRATION);
  int same = !memcmp(states, states + size, sizeof(mjtNum) * (size_t)size);
  free(states);
  return same;
}

static int finite_state(const mjModel* m, const mjData* d) {
  int finite = 1;
  for (int i = 0; i < m->nq; i++) finite &= isfinite(d->qpos[i]);
  for (int i = 0; i < m->nv; i++) finite &= isfinite(d->qvel[i]);
  for (int i = 0; i < m->na; i++) finite &= isfinite(d->act[i]);
  for (int i = 0; i < m->nsensordata; i++) finite &= isfinite(d->sensordata[i]);
  for (int i = 0; i < m->npluginstate; i++) finite &= isfinite(d->plugin_state[i]);
  return finite;
}

//------------------------------ scenarios
//---------------------------------------------------------

// make, copy, reset, restore, step and free in random order
static void lifetimes(Random* random) {
  enum { POOL = 5 };
  mjData* pool[POOL] = {NULL};
  mjModel* m = random_model(random, 1 + below(random, 12));
  int size = mj_stateSize(m, mjSTATE_INTEGRATION);
  mjtNum* state = malloc(sizeof(mjtNum) * (size_t)size);
  for (int turn = 0; turn < 60; turn++) {
    int i = below(random, POOL), j = below(random, POOL);
    if (!pool[i]) {
      pool[i] = pool[j] && below(random, 2) ? mj_copyData(NULL, m, pool[j]) : mj_makeData(m);
      kick(m, pool[i], random);
      continue;
    }
    switch (below(random, 8)) {
      case 0:
        mj_deleteData(pool[i]);
        pool[i] = NULL;
        break;
      case 1:
        mj_resetData(m, pool[i]);
        break;
      case 2:
        mj_resetDataKeyframe(m, pool[i], 0);
        kick(m, pool[i], random);
        break;
      case 3:
        if (pool[j] && i != j) {
          mj_copyData(pool[i], m, pool[j]);
          steps(m, pool[i], 2);
          steps(m, pool[j], 2);
          REQUIRE(same_state(m, pool[i], pool[j]));
        }
        break;
      case 4:
        if (pool[j] && i != j) {
          mj_getState(m, pool[j], state, mjSTATE_INTEGRATION);
          mj_setState(m, pool[i], state, mjSTATE_INTEGRATION);
          steps(m, pool[i], 2);
          steps(m, pool[j], 2);
          REQUIRE(same_state(m, pool[i], pool[j]));
        }
        break;
      case 5:
        mj_step1(m, pool[i]);
        mj_step2(m, pool[i]);
        break;
      default:
        steps(m, pool[i], 3);
        REQUIRE(finite_state(m, pool[i]));
        break;
    }
  }
  free(state);

  // the model before the data, or after
  int model_first = below(random, 2);
  if (model_first) {
    mj_deleteModel(m);
  }
  for (int i = 0; i < POOL; i++) {
    mj_deleteData(pool[i]);
  }
  if (!model_first) {
    mj_deleteModel(m);
  }
}

// copies and files of the model step as the model does, also with mjData of the
// other
static void models(Random* random) {
  mjModel* m = random_model(random, 1 + below(random, 8));
  mjtSize size = mj_sizeModel(m);
  void* file = malloc((size_t)size);
  mj_saveModel(m, NULL, file, size);
  mjModel* others[] = {mj_copyModel(NULL, m), mj_loadModelBuffer(file, size)};
  free(file);
  mjData* d = mj_makeData(m);
  kick(m, d, random);
  mjData* swapped = mj_copyData(NULL, m, d);
  steps(m, d, 10);
  for (int i = 0; i < 2; i++) {
    REQUIRE(others[i]);
    steps(others[i], swapped, 5);
  }
  REQUIRE(same_state(m, d, swapped));
  mj_deleteModel(m);
  mj_deleteModel(others[0]);
  steps(others[1], d, 2);
  mj_deleteData(d);
  mj_deleteData(swapped);
  mj_deleteModel(others[1]);
}

// a specification edited and compiled again in place, also into what cannot be
static void recompile(Random* random) {
  char error[1000] = "";
  int devices = 2 + below(random, 6);
  const char* integrator = kIntegrators[below(random, INTEGRATORS)];
  char* text = engine_model(random, devices, below(random, LAWS * VARIANTS), integrator);
  mjSpec* spec = mj_parseXMLString(text, NULL, error, sizeof(error));
  free(text);
  REQUIRE(spec);
  mjModel* m = mj_compile(spec, NULL);
  REQUIRE(m);
  mjData* d = mj_makeData(m);
  kick(m, d, random);
  steps(m, d, 5);
  mjData* plain = mj_copyData(NULL, m, d);

  // nothing changed: goes on as if it had not been
  REQUIRE(mj_recompile(spec, NULL, m, d) == 0);
  steps(m, d, 5);
  REQUIRE(finite_state(m, d));
  mj_deleteData(plain);

  // a device goes
  char name[32];
  snprintf(name, sizeof(name), "a%d", 1 + below(random, devices - 1));
  mjsElement* actuator = mjs_findElement(spec, mjOBJ_ACTUATOR, name);
  REQUIRE(actuator);
  mjsElement* sensor = mjs_firstElement(spec, mjOBJ_SENSOR);
  if (below(random, 2) && sensor) {
    REQUIRE(mjs_delete(spec, sensor) == 0);
  }
  REQUIRE(mj_recompile(spec, NULL, m, d) == 0);
  steps(m, d, 5);
  REQUIRE(finite_state(m, d));

  // a device that is refused: the specification cannot be compiled, nothing is
  // lost
  mjs_asActuator(actuator)->actdim = 17;
  long before = message_count();
  mjModel* refused = mj_compile(spec, NULL);
  REQUIRE(!refused && (message_count() > before || *mjs_getError(spec)));
  steps(m, d, 2);
  mj_deleteData(d);
  mj_deleteModel(m);
  mj_deleteSpec(spec);
}

// the engine's batch: threads of its own, live values per simulation, one of
// them bad
static void batch(Random* random) {
  enum { SIMULATIONS = 9 };
  char error[1000] = "";
  mjModel* m = random_model(random, 1 + below(random, 6));
  mjBatchConfig config;
  mjb_defaultConfig(&config);
  config.nthread = 3;
  config.persistent = below(random, 2);
  mjBatch* b = mjb_makeBatch(m, SIMULATIONS, &config, error, sizeof(error));
  REQUIRE(b);
  int size = 0;
  mjtNum* live = mjb_expand(b, "numeric_data", &size, NULL);
  REQUIRE(live && size == m->nnumericdata);
  for (int i = 0; i < SIMULATIONS; i++) {
    live[i * size] = i;
  }
  REQUIRE(mjb_step(b, NULL, 0, 20, mjSTAGE_ACC) == 0);
  int ids[] = {2, 5};
  REQUIRE(mjb_reset(b, ids, 2, NULL, mjSTAGE_ACC) == 0);
  live[4 * size] = NAN;
  REQUIRE(mjb_step(b, NULL, 0, 5, mjSTAGE_ACC) == 1);
  REQUIRE(strstr(mjb_error(b, 4), "viscous"));
  live[4 * size] = 1;
  REQUIRE(mjb_step(b, NULL, 0, 5, mjSTAGE_ACC) == 0);
  mjb_deleteBatch(b);
  mj_deleteModel(m);
}

// threads of ours: one model for all, each with its own data; each compiles a
// model, too
typedef struct Task_ {
  const mjModel* m;
  uint64_t seed;
  mjtNum sum;
} Task;

static mjtNum run_alone(const mjModel* m, uint64_t seed) {
  Random random = {seed};
  mjData* d = mj_makeData(m);
  kick(m, d, &random);
  steps(m, d, 20);
  mjData* duplicate = mj_copyData(NULL, m, d);
  mj_resetData(m, d);
  mj_deleteData(d);
  steps(m, duplicate, 5);
  mjtNum sum = 0;
  for (int i = 0; i < m->nq; i++) sum += duplicate->qpos[i];
  for (int i = 0; i < m->na; i++) sum += duplicate->act[i];
  mj_deleteData(duplicate);
  return sum;
}

static void* run_task(void* argument) {
  Task* task = argument;
  task->sum = run_alone(task->m, task->seed);
  Random random = {task->seed};
  mjModel* own = random_model(&random, 3);
  run_alone(own, task->seed);
  mj_deleteModel(own);
  return NULL;
}

static void threads(Random* random) {
  enum { THREADS = 4 };
  mjModel* m = random_model(random, 1 + below(random, 10));
  pthread_t thread[THREADS];
  Task task[THREADS];
  for (int i = 0; i < THREADS; i++) {
    task[i] = (Task){m, 1 + (uint64_t)below(random, 1000), 0};
    REQUIRE(!pthread_create(thread + i, NULL, run_task, task + i));
  }
  for (int i = 0; i < THREADS; i++) {
    pthread_join(thread[i], NULL);
    REQUIRE(task[i].sum == run_alone(m, task[i].seed));
  }
  mj_deleteModel(m);
}

// derivatives, inverse dynamics, a scene, disabled actuation: other ways into
// the callbacks
static void other_ways(Random* random) {
  mjModel* m = random_model(random, 1 + below(random, 5));
  mjData* d = mj_makeData(m);
  kick(m, d, random);
  steps(m, d, 3);
  int n = 2 * m->nv + m->na;
  mjtNum* A = malloc(sizeof(mjtNum) * (size_t)(n * n));
  mjtNum* B = malloc(sizeof(mjtNum) * (size_t)(n * m->nu));
  if (m->opt.integrator != mjINT_DISCRETE) {
    mjd_transitionFD(m, d, 1e-6, 1, A, B, NULL, NULL);
  }
  free(A);
  free(B);
  mj_inverse(m, d);
  mjvScene scene;
  mjvOption option;
  mjvCamera camera;
  mjv_defaultScene(&scene);
  mjv_defaultOption(&option);
  mjv_defaultCamera(&camera);
  mjv_makeScene(m, &scene, 20 + below(random, 200));  // too few now and then
  mjv_updateScene(m, d, &option, NULL, &camera, mjCAT_ALL, &scene);
  mjv_freeScene(&scene);
  m->opt.disableflags |= mjDSBL_ACTUATION;
  steps(m, d, 2);
  m->opt.disableflags = mjDSBL_DAMPER;
  m->opt.integrator = below(random, INTEGRATORS);
  steps(m, d, 2);
  mj_forwardSkip(m, d, mjSTAGE_POS, 0);
  REQUIRE(finite_state(m, d));
  mj_deleteData(d);
  mj_deleteModel(m);
}

// numbers that are none, or absurd, put where users can put them: what is no
// number gives a message and is gone three steps later; nothing turns into such
// without a message
static void bad_numbers(Random* random) {
  mjModel* m = random_model(random, 1 + below(random, 6));
  for (int turn = 0; turn < 10; turn++) {
    mjData* d = mj_makeData(m);
    kick(m, d, random);
    steps(m, d, 2);
    const char* const name[] = {"qpos", "qvel", "act", "ctrl", "plugin_state", "qacc_warmstart"};
    mjtNum* place[] = {d->qpos, d->qvel, d->act, d->ctrl, d->plugin_state, d->qacc_warmstart};
    int size[] = {m->nq, m->nv, m->na, m->nu, m->npluginstate, m->nv}, which = below(random, 6);
    if (size[which]) {
      const double bad[] = {NAN, INFINITY, -INFINITY, 1e300, 5e-324};
      double value = below(random, 2) ? bad[below(random, 5)] : any(random);
      int index = below(random, size[which]);
      long before = message_count();
      place[which][index] = value;
      steps(m, d, 3);
      int told = message_count() > before, finite = finite_state(m, d);
      int guess = place[which] == d->qacc_warmstart;  // which the solver is free to throw away
      if (isfinite(value) ? !finite && !told : !finite || (!told && !guess)) {
        fprintf(stderr, "%s[%d] = %g under %s: %sfinite later, %stold\n", name[which], index, value,
                kIntegrators[m->opt.integrator], finite ? "" : "not ", told ? "" : "not ");
        exit(1);
      }
    }
    mj_deleteData(d);
  }
  mj_deleteModel(m);
}

//------------------------------ all of them
//-------------------------------------------------------

int main(int argc, char** argv) {
  const struct {
    const char* name;
    void (*run)(Random* random);
  } scenarios[] = {{"lifetimes", lifetimes},    {"models", models},
                   {"recompile", recompile},    {"batch", batch},
                   {"threads", threads},        {"other_ways", other_ways},
                   {"bad_numbers", bad_numbers}};
  if (argc < 3) {
    fprintf(stderr, "engine PLUGIN ROUNDS [SCENARIO]\n");
    return 2;
  }
  mju_setLogHandler(hear);
  mj_loadPluginLibrary(argv[1]);
  REQUIRE(mjp_getPlugin("inerter.device", NULL));
  int rounds = atoi(argv[2]);
  for (size_t i = 0; i < sizeof(scenarios) / sizeof(*scenarios); i++) {
    if (argc > 3 && strcmp(argv[3], scenarios[i].name)) {
      continue;
    }
    for (int round = 0; round < rounds; round++) {
      Random random = {20261122 + 1000003 * (uint64_t)round};
      scenarios[i].run(&random);
    }
    printf("%s: %d rounds, %ld messages so far\n", scenarios[i].name, rounds, message_count());
    fflush(stdout);
  }
  return 0;
}
