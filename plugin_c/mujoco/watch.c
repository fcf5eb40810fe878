// What goes wrong while a model runs: see watch.h.

#include "mujoco/watch.h"

#include <math.h>
#include <stdio.h>

#include "core/friction.h"

//------------------------------ numbers -----------------------------------------------------------

void watch_state(const mjModel* m, Instance* self, mjtNum* state) {
  int nstate = inerter_nstate(&self->device), bad = -1;
  for (int i = 0; i < nstate; i++) {
    bad = isfinite(state[i]) ? bad : i;
  }
  if (bad < 0) {
    return;
  }
  char message[INERTER_MESSAGE_SIZE];
  snprintf(message, sizeof(message),
           "%s is %g, no finite number: it goes on unloaded, with its states 0; either "
           "that was written into mjData.act, or the motion is unstable: shorten the timestep",
           inerter_state_name(&self->device, bad), state[bad]);
  instance_complain(m, self, COMPLAINT_STATE, message);
  mju_zero(state, nstate);
}

void watch_heat(const mjModel* m, Instance* self, mjtNum* heat) {
  if (isfinite(*heat)) {
    return;
  }
  char message[INERTER_MESSAGE_SIZE];
  snprintf(message, sizeof(message),
           "its dissipated energy is %g J, no finite number: it is counted from 0 again; either "
           "that was written into mjData.plugin_state, or the motion is unstable: shorten the "
           "timestep",
           *heat);
  instance_complain(m, self, COMPLAINT_HEAT, message);
  *heat = 0;
}

void watch_force(const mjModel* m, Instance* self, mjtNum force) {
  if (isfinite(force)) {
    return;
  }
  char message[INERTER_MESSAGE_SIZE];
  snprintf(message, sizeof(message),
           "its force is %g N, no finite number, at displacement %g m and velocity %g m/s: the "
           "motion is unstable, or a value of the model is absurd; shorten the timestep, look at "
           "the values",
           force, self->x, self->v);
  instance_complain(m, self, COMPLAINT_FORCE, message);
}

//------------------------------ laws --------------------------------------------------------------

void watch_validity(const mjModel* m, Instance* self, const mjtNum* state) {
  char message[INERTER_MESSAGE_SIZE];
  if (!(self->complained & COMPLAINT_VALIDITY) &&
      !inerter_valid(&self->device, self->x, state, message)) {
    instance_complain(m, self, COMPLAINT_VALIDITY, message);
  }
}

// The age of contacts moves at first far faster than on the mean of a step that does not resolve
// it; RK4 is stable up to 1.3 of the mean over half of one.
static void watch_age(const mjModel* m, Instance* self, double x, double v, const mjtNum* state,
                      mjtNum* rate) {
  double after[INERTER_MAXSTATE], half = 0.5 * m->opt.timestep;
  mju_copy(after, state, inerter_nstate(&self->device));
  inerter_state_step(&self->device, x, v, 0, after, half);
  double most = 1.3 * fabs(after[0] - state[0]) / half;
  if (!(fabs(rate[0]) > most)) {
    return;
  }
  rate[0] = copysign(most, rate[0]);
  char message[INERTER_MESSAGE_SIZE];
  snprintf(message, sizeof(message),
           "at %g m/s the contacts of friction \"rate_state\" are renewed faster than RK4 resolves "
           "with a timestep of %g s, and were slowed to that; for this law prefer "
           "integrator=\"implicitfast\", which steps it exactly, or shorten the timestep",
           v, m->opt.timestep);
  instance_complain(m, self, COMPLAINT_BRISTLE, message);
}

static void watch_bristle(const mjModel* m, Instance* self, double x, double v, double a,
                          const mjtNum* state, mjtNum* rate) {
  const InerterDevice* device = &self->device;
  if (m->opt.integrator != mjINT_RK4 || !instance_has_bristle(device)) {
    return;
  }
  if (device->friction == INERTER_FRICTION_rate_state) {
    watch_age(m, self, x, v, state, rate);
    return;
  }
  if (v == 0) {
    return;
  }

  // velocity of the friction
  double w = instance_rubs_flywheel(device) ? state[device->nfriction + 1] : v;

  // slope of the rate over the state, a little beyond the state
  double there[INERTER_MAXSTATE], beyond[INERTER_MAXSTATE];
  double step = 1e-6 * fabs(state[0]) + 1e-15;
  if (device->friction_backlash > 0) {
    // away from the play, in which nothing relaxes
    if (fabs(state[0]) <= device->friction_backlash) {
      return;
    }
    step = copysign(step, state[0]);
  }
  mju_copy(there, state, inerter_nstate(device));
  int slips = device->friction == INERTER_FRICTION_maxwell_slip;
  for (int i = 0; i < device->nfriction; i++) {
    // outwards, for an element at its limit sticks on the inner side
    double outwards = copysign(1e-6 * fabs(state[i]) + 1e-15, state[i]);
    there[i] += slips ? outwards : step;
  }
  inerter_state_rate(device, x, v, a, there, beyond);
  double decay = 0, fastest = 2 / m->opt.timestep;
  for (int i = 0; i < device->nfriction; i++) {
    if (slips && rate[i] == w) {
      continue;  // it sticks, and does not relax
    }
    double each = (rate[i] - beyond[i]) / (there[i] - state[i]);
    rate[i] *= each > fastest ? fastest / each : 1;
    decay = fmax(decay, each);
  }
  if (!(decay > fastest)) {
    return;
  }
  char message[INERTER_MESSAGE_SIZE];
  snprintf(message, sizeof(message),
           "at %g m/s the state of friction \"%s\" relaxes within %.2g s, faster than RK4 resolves "
           "with a timestep of %g s, and was slowed to that; for this law prefer "
           "integrator=\"implicitfast\", which steps it exactly, or shorten the timestep",
           w, inerter_friction_name(device->friction), 1 / decay, m->opt.timestep);
  instance_complain(m, self, COMPLAINT_BRISTLE, message);
}

void watch_rates(const mjModel* m, Instance* self, mjtNum a, mjtNum* rate) {
  mjtNum x = self->rate_x, v = self->rate_v;
  inerter_state_rate(&self->device, x, v, a, self->rate_state, self->rate);
  mju_copy(rate, self->rate, inerter_nstate(&self->device));
  watch_bristle(m, self, x, v, a, self->rate_state, rate);
}

//------------------------------ stiffness ---------------------------------------------------------

// acceleration per force along the actuator, in the initial configuration, a native inertance
// included [1/kg]
static double mobility(const mjModel* m, int actuator) {
  double gear = m->actuator_gear[6 * m->actuator_outadr[actuator]];
  int target = m->actuator_trnid[2 * actuator];
  if (m->actuator_trntype[actuator] == mjTRN_TENDON) {
    return gear * gear * m->tendon_invweight0[target];
  }
  double weight = gear * gear * m->dof_invweight0[m->jnt_dofadr[target]];

  // for bodies that only slide the engine takes 1 / mass, without armature
  int sliding = m->body_simple[m->jnt_bodyid[target]] == 2;
  return sliding ? weight / (1 + weight * m->actuator_armature[actuator]) : weight;
}

// slope of the friction force over velocity at rest, for laws without memory [N s/m]
static double friction_slope(const InerterDevice* device) {
  const double small = 1e-9;
  double state[INERTER_MAXSTATE] = {0};
  if (instance_rubs_flywheel(device)) {
    state[device->nfriction + 1] = small;  // the velocity of the flywheel
  }
  return instance_has_sharp_friction(device)
             ? inerter_friction_force(device, 0, small, state) / small
             : 0;
}

// the fastest motion so far, and what causes it
typedef struct Fastest_ {
  double rate;  // over what the integrator resolves
  const char* cause;
  const char* remedy;  // beside a shorter step
} Fastest;

static void consider(Fastest* fastest, double rate, double limit, const char* cause,
                     const char* remedy) {
  if (rate / limit > fastest->rate) {
    *fastest = (Fastest){rate / limit, cause, remedy};
  }
}

// share of what a step can bear up to which a bristle is taken at its start
static const double kResolvedBristle = 0.25;

void watch_stiffness(const mjModel* m, Instance* self) {
  if (self->integrator == m->opt.integrator + 1 && self->timestep == m->opt.timestep) {
    return;
  }
  self->integrator = m->opt.integrator + 1;  // 0: not looked at yet
  self->timestep = m->opt.timestep;

  // masses at the terminals and at the flywheel
  InerterDevice worst = self->device;
  worst.ncontrol = 0;  // without lag
  inerter_command(&worst, worst.control == INERTER_CONTROL_inertance ? -INFINITY : INFINITY, NULL);
  const InerterDevice* p = &worst;
  int series = instance_has_series(p), stages = m->opt.integrator == mjINT_RK4;
  double light = mobility(m, self->actuator);
  if (!series && !self->native) {
    light /= 1 + light * p->inertance;
  }
  double wheel = series ? 1 / p->inertance : light;
  double bristle_damping, bristle = inerter_bristle(p, &bristle_damping);
  double h = m->opt.timestep;
  self->light = light;
  self->bristle_rate = h * (bristle_damping + h * bristle);
  double gas = p->gas_pressure > 0
                   ? p->gas_exponent * p->gas_pressure * p->gas_area * p->gas_area / p->gas_volume
                   : 0;

  // an oscillation of omega h < 2 (one stage), 2.8 (RK4); a decay of lambda h < 2.7
  double swing = (stages ? 2.8 : 2) / h, decay = 2.7 / h;
  const char* tendon =
      ", or give the stiffness to the tendon or joint, with integrator=\"discrete\"";
  const char* implicit = ", or integrator=\"implicitfast\"";
  const char* width = p->friction ? inerter_friction_law[p->friction]->width_parameter : NULL;
  char turn[128];
  snprintf(turn, sizeof(turn), "the change of sign of friction within %s",
           width ? width : "transition_velocity");
  Fastest fastest = {1, NULL, NULL};
  consider(&fastest, sqrt(fabs(p->stiffness) * light), swing, "stiffness", tendon);
  double steepest = inerter_curve_steepest(p, INERTER_STROKE_force);
  consider(&fastest, sqrt(steepest * light), swing, "force along the stroke", tendon);
  double rise, over_place = inerter_map_steepest(p, &rise);
  consider(&fastest, sqrt(over_place * light), swing, "force_map along the stroke", tendon);
  consider(&fastest, sqrt(gas * wheel), swing, "the gas spring", "");
  // Euler takes the damping of a tendon at the start of a step, that of a joint without eulerdamp
  int tendon_damps = m->actuator_trntype[self->actuator] == mjTRN_TENDON;
  if (m->opt.integrator == mjINT_EULER && self->native &&
      (tendon_damps || m->opt.disableflags & mjDSBL_EULERDAMP)) {
    consider(&fastest, self->viscous * light, 2 / h, "viscous", implicit);
  }
  if (stages) {
    double both = light + wheel;
    if (p->damper_stiffness > 0) {
      consider(&fastest, sqrt(p->damper_stiffness * light), swing, "damper_stiffness", implicit);
      double flattest = inerter_flattest_damping(p);
      consider(&fastest, flattest > 0 ? p->damper_stiffness / flattest : 0, decay,
               "the relaxation of the dampers behind damper_stiffness", implicit);
    } else {
      consider(&fastest, inerter_steepest_damping(p) * light, decay, "viscous", implicit);
    }
    consider(&fastest, p->flywheel_viscous * wheel, decay, "flywheel_viscous", implicit);
    consider(&fastest, rise * light, decay, "force_map over velocity", implicit);
    consider(&fastest, sqrt(p->stop_stiffness * light), swing, "stop_stiffness", implicit);
    consider(&fastest, friction_slope(p) * (instance_rubs_flywheel(p) ? wheel : light), decay, turn,
             implicit);
    double branches = p->branch_stiffness_1 + p->branch_stiffness_2 + p->branch_stiffness_3;
    consider(&fastest, sqrt(branches * light), swing, "branch_stiffness", implicit);
    for (int i = 0; i < p->nbranch; i++) {
      const double stiffness[] = {p->branch_stiffness_1, p->branch_stiffness_2,
                                  p->branch_stiffness_3};
      const double damping[] = {p->branch_damping_1, p->branch_damping_2, p->branch_damping_3};
      consider(&fastest, stiffness[i] / damping[i], decay,
               "the relaxation of a viscoelastic branch", implicit);
    }
    if (series) {
      consider(&fastest, sqrt(p->series_stiffness * both), swing, "series_stiffness", implicit);
      consider(&fastest, p->series_damping * both, decay, "series_damping", implicit);
    }
    if (series && p->series_stiffness == 0 && p->series_damping == 0) {
      consider(&fastest, p->leak_damping * both, decay, "leak_damping", implicit);
    } else if (p->leak_damping > 0) {
      consider(&fastest, p->series_stiffness / (p->leak_damping + p->series_damping), decay,
               "the relaxation of the series element that slips", implicit);
    } else if (p->clutch_force > 0 && p->series_damping > 0) {
      consider(&fastest, p->series_stiffness / p->series_damping, decay,
               "the relaxation of the series element where it slips", implicit);
    }
    if (p->backlash > 0 && p->series_damping > 0) {
      consider(&fastest, p->series_stiffness / p->series_damping, decay,
               "the relaxation of the series element in its play", implicit);
    }
  }
  if (fastest.cause) {
    char message[INERTER_MESSAGE_SIZE];
    snprintf(
        message, sizeof(message),
        "%s is too stiff for %s with a timestep of %g s and the masses it acts on; set timestep "
        "<= %.2g%s",
        fastest.cause, stages ? "RK4" : "this integrator", h, 0.9 * h / fastest.rate,
        fastest.remedy);
    instance_complain(m, self, COMPLAINT_STIFF, message);
  }
}

void watch_resolution(const mjModel* m, const mjData* d, Instance* self) {
  mjtNum light = self->light;
  if (m->actuator_trntype[self->actuator] == mjTRN_TENDON && self->bristle_rate > 0) {
    // how easily the terminals give way changes with the direction of the tendon
    int row = m->actuator_outadr[self->actuator];
    int start = d->moment_rowadr[row], end = start + d->moment_rownnz[row];
    mjtNum now = 0;
    for (int k = start; k < end; k++) {
      mjtNum moment = d->actuator_moment[k];
      now += moment * moment * m->dof_invweight0[d->moment_colind[k]];
    }
    light = mjMAX(light, now / (1 + now * m->actuator_armature[self->actuator]));
  }
  self->stiff_bristle = self->bristle_rate * light > kResolvedBristle;
}

//------------------------------ sites -------------------------------------------------------------

void watch_sites(const mjModel* m, const mjData* d, Instance* self) {
  int tendon = m->actuator_trnid[2 * self->actuator];
  if (self->complained & COMPLAINT_SITES || m->actuator_trntype[self->actuator] != mjTRN_TENDON ||
      m->wrap_type[m->tendon_adr[tendon]] == mjWRAP_JOINT ||
      !(d->ten_length[tendon] <= 1e-6 * m->stat.meansize)) {
    return;
  }
  instance_complain(
      m, self, COMPLAINT_SITES,
      "the sites of its tendon meet: the line between them has no direction there, and "
      "its length cannot change sign; set the sites apart and state rest_length");
}
