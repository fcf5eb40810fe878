// A device from its parts: see device.h for the equation.

#include "device.h"

#include <stdio.h>

#include "laws.h"
#include "series.h"

//------------------------------ friction ----------------------------------------------------------

// where the friction acts: displacement and velocity
typedef struct Place_ {
  double x, v;
} Place;

static Place place_of_friction(const InerterDevice* device, double stretch, double v,
                               const double* z) {
  if (!has(device, PART_WHEEL_FRICTION)) {
    return (Place){stretch, v};
  }
  const double* series = z + series_index(device);
  return (Place){stretch - series[0], series[1]};
}

// N; F_s with a series element
static double branch_force(const InerterDevice* device, double x, double v, double a,
                           const double* z) {
  if (has(device, PART_SERIES)) {
    return series_force(device, v, z + series_index(device));
  }
  double rest, inertance = inerter_inertance(device, x, v, &rest);
  return inertance * a + rest;
}

// the load there
static double law_load(const InerterDevice* device, double x, double v, double a, const double* z) {
  if (!inerter_load_bends(device)) {
    return 0;
  }
  Place place = place_of_friction(device, stretch_of(device, x), v, z);
  double carried = branch_force(device, x, v, a, z);
  if (has(device, PART_WHEEL_FRICTION)) {
    carried -= bristle_spring(device, place.x, place.v, z);
  }
  return load_on_bristle(device, place.v, carried);
}

// force of the friction law there
static double law_force(const InerterDevice* device, double stretch, double v, const double* z,
                        double load) {
  if (device->friction == INERTER_FRICTION_none) {
    return 0;
  }
  Place place = place_of_friction(device, stretch, v, z);
  if (has_bristle(device)) {
    return friction_force(device, place.x, place.v, z, load);
  }
  return law_of(device)->force(device, place.x, place.v, 0, 0);
}

// what friction at the flywheel takes of the force that comes through the series element
static double wheel_drag(const InerterDevice* device, double x, double v, const double* z) {
  if (!has(device, PART_WHEEL_FRICTION)) {
    return 0;
  }
  const double* series = z + series_index(device);
  double load = law_load(device, x, v, 0, z), force = series_force(device, v, series);
  double friction = law_force(device, stretch_of(device, x), v, z, load);
  if (inerter_load_bends(device)) {
    return friction;
  }
  return force - wheel_carried(device, series[1], z, force, friction);
}

// load friction per force at the terminals
static double load_at_terminals(const InerterDevice* device, double v, const double* z,
                                double carried) {
  return has(device, PART_WHEEL_FRICTION) ? 0 : inerter_load_factor(device, v, z, carried);
}

// whether the friction law has several states
static int slips(const InerterDevice* device) {
  return has_bristle(device) && law_of(device)->several;
}

// T without friction
static double beside_force(const InerterDevice* device, double stretch, double v, const double* z) {
  double force = parallel_force(device, stretch, v);
  if (has(device, PART_DAMPER_SPRING)) {
    force += damper_spring_force(device, z[damper_index(device)]);
  }
  return has(device, PART_BRANCHES) ? force + branches_force(device, z + branch_index(device))
                                    : force;
}

//------------------------------ states ------------------------------------------------------------

int inerter_nstate(const InerterDevice* device) {
  return device->nstate;
}

void inerter_state_rate(const InerterDevice* device, double x, double v, double a, const double* z,
                        double* rate) {
  double stretch = stretch_of(device, x);
  Place place = place_of_friction(device, stretch, v, z);
  if (has_bristle(device)) {
    friction_rates(device, place.x, place.v, z, law_load(device, x, v, a, z), rate);
  }
  if (has(device, PART_SERIES)) {
    int first = series_index(device);
    double drag = wheel_drag(device, x, v, z);
    series_rate(device, stretch, v, z + first, drag, rate + first);
  }
  if (has(device, PART_BRANCHES)) {
    branches_rate(device, v, z + branch_index(device), rate + branch_index(device));
  }
  if (has(device, PART_DAMPER_SPRING)) {
    int at = damper_index(device);
    rate[at] = damper_spring_rate(device, v, z[at]);
  }
  if (device->ncontrol) {
    rate[control_index(device)] = control_rate(device, z[control_index(device)]);
  }
}

void inerter_state_step(const InerterDevice* device, double x, double v, double a, double* z,
                        double h) {
  double stretch = stretch_of(device, x), carried = 0;
  int bends = inerter_load_bends(device);
  if (bends) {
    carried = branch_force(device, x, v, a, z);
  }
  if (has(device, PART_SERIES)) {
    series_step(device, stretch, &(Way){.v = v}, z, z + series_index(device), h);
    carried = bends ? 0.5 * (carried + branch_force(device, x, v, a, z)) : 0;
  }
  if (has_bristle(device) && !has(device, PART_WHEEL_FRICTION)) {
    friction_step(device, stretch, v, z, h, load_on_bristle(device, v, carried));
  }
  if (has(device, PART_BRANCHES)) {
    branches_step(device, v, z + branch_index(device), h);
  }
  if (has(device, PART_DAMPER_SPRING)) {
    damper_spring_follow(device, &(Way){.v = v}, z + damper_index(device), h);
  }
  if (device->ncontrol) {
    z[control_index(device)] = control_step(device, z[control_index(device)], h);
  }
}

// all states 0, but dampers behind a spring, which have followed
static void begin_states(const InerterDevice* device, double v, double* z) {
  for (int i = 0; i < device->nstate; i++) {
    z[i] = 0;
  }
  if (has(device, PART_DAMPER_SPRING)) {
    z[damper_index(device)] = v;
  }
}

// total force with the first state at a value, the others as above
static double force_with_first(const InerterDevice* device, double x, double v, double a,
                               double first) {
  double z[INERTER_MAXSTATE] = {0};
  begin_states(device, v, z);
  z[0] = first;
  return inerter_force(device, x, v, a, z).total;
}

// the bristle's state for a total force; every law is linear in its state
static double bristle_of_force(const InerterDevice* device, double x, double v, double a,
                               double force) {
  double at_zero = force_with_first(device, x, v, a, 0);
  double at_one = force_with_first(device, x, v, a, 1);
  double z = (force - at_zero) / (at_one - at_zero);
  if (at_one == at_zero || isnan(z)) {
    return 0;
  }

  // a state cannot be beyond where an endless slide in its direction leads, slow or fast: slow has
  // the Stribeck peak, fast the full asymmetry
  double speed = (z < 0 ? -10 : 10) * device->transition_velocity;
  double stretch = stretch_of(device, x);
  double load = fmax(law_load(device, x, v, a, (double[INERTER_MAXSTATE]){0}),
                     law_load(device, x, -v, a, (double[INERTER_MAXSTATE]){0}));
  double slow = law_of(device)->step(device, stretch, copysign(1e-200, z), 0, 1e215, load);
  double fast = law_of(device)->step(device, stretch, speed, 0, 1e15 / fabs(speed), load);
  double limit = fmax(fabs(slow), fabs(fast));
  return isfinite(limit) ? copysign(fmin(fabs(z), limit), z) : z;
}

// the same behind free play: at the side of the friction force that is wanted, 0 in the middle
static double play_of_force(const InerterDevice* device, double x, double v, double a,
                            double force) {
  if (device->friction_backlash == 0) {
    return bristle_of_force(device, x, v, a, force);
  }
  InerterDevice rigid = *device;
  rigid.friction_backlash = 0;
  double z = bristle_of_force(&rigid, x, v, a, force);
  double wanted = force - force_with_first(device, x, v, a, 0);
  if (device->friction == INERTER_FRICTION_lugre && z * wanted <= 0) {
    // its damper bears all of it where the contact begins
    return copysign(device->friction_backlash, wanted) * (wanted != 0);
  }
  return z + sign(z) * device->friction_backlash;
}

void inerter_state_of_force(const InerterDevice* device, double x, double v, double a, double force,
                            double* z) {
  begin_states(device, v, z);
  if (!has(device, PART_SERIES)) {
    if (law_of(device)->several && device->nfriction) {
      double wanted = force - inerter_force(device, x, v, a, z).total;
      law_of(device)->several->of_force(device, stretch_of(device, x), v, wanted,
                                        law_load(device, x, v, a, z), z);
    } else if (device->nfriction) {
      z[0] = play_of_force(device, x, v, a, force);
    }
    return;
  }
  double* series = z + series_index(device);
  series_of_force(device, v, 0, series);
  double rest = force - inerter_force_motion(device, x, v, z);

  // rest = F_s + load |F_s|
  double load = load_at_terminals(device, v, z, rest);
  double carried = rest / (1 + load * sign(rest));
  if (isfinite(carried)) {
    series_of_force(device, v, carried, series);
  }
}

//------------------------------ forces ------------------------------------------------------------

double inerter_bristle(const InerterDevice* device, double* damping) {
  *damping = device->friction == INERTER_FRICTION_lugre ? device->bristle_damping : 0;
  return has_bristle(device) ? law_of(device)->stiffness(device) : 0;
}

double inerter_viscous(const InerterDevice* device, double x) {
  return damping_at(device, stretch_of(device, x));
}

double inerter_friction_force(const InerterDevice* device, double x, double v, const double* z) {
  return law_force(device, stretch_of(device, x), v, z, 0);
}

double inerter_inertance(const InerterDevice* device, double x, double v, double* rest) {
  double carried = 0, inertance = has(device, PART_SERIES) ? 0 : device->inertance;
  if (has(device, PART_VARYING) && !has(device, PART_SERIES)) {
    inertance = inertance_felt(device, stretch_of(device, x), v, &carried);
  }
  if (has(device, PART_FLYWHEEL) && !has(device, PART_SERIES)) {
    carried += flywheel_force(device, stretch_of(device, x), v);
  }
  if (rest) {
    *rest = carried;
  }
  return inertance;
}

double inerter_force_motion(const InerterDevice* device, double x, double v, const double* z) {
  double force = beside_force(device, stretch_of(device, x), v, z);
  if (has(device, PART_WHEEL_FRICTION)) {
    return force + branch_force(device, x, v, 0, z);
  }
  force += law_force(device, stretch_of(device, x), v, z, law_load(device, x, v, 0, z));
  if (has(device, PART_SERIES)) {
    double carried = branch_force(device, x, v, 0, z);
    force += carried + inerter_load_factor(device, v, z, carried) * fabs(carried);
  }
  return force;
}

double inerter_force_motion_of_rate(const InerterDevice* device, double x, double v,
                                    const double* z, const double* rate) {
  if (!has_bristle(device) || !law_of(device)->force_of_rate || device->friction_backlash != 0 ||
      has(device, PART_SERIES) || inerter_load_bends(device)) {
    return inerter_force_motion(device, x, v, z);
  }
  double friction = law_of(device)->force_of_rate(device, z[0], rate[0]);
  return beside_force(device, stretch_of(device, x), v, z) + friction;
}

InerterForce inerter_force(const InerterDevice* device, double x, double v, double a,
                           const double* z) {
  InerterForce force;
  force.inertance = branch_force(device, x, v, a, z);
  if (has(device, PART_WHEEL_FRICTION)) {
    force.friction = wheel_drag(device, x, v, z);
    force.total = force.inertance + beside_force(device, stretch_of(device, x), v, z);
    force.inertance -= force.friction;
    return force;
  }
  double load = law_load(device, x, v, a, z);
  force.friction = law_force(device, stretch_of(device, x), v, z, load) +
                   inerter_load_factor(device, v, z, force.inertance) * fabs(force.inertance);
  force.total =
      force.inertance + beside_force(device, stretch_of(device, x), v, z) + force.friction;
  return force;
}

//------------------------------ energy ------------------------------------------------------------

double inerter_stored_energy(const InerterDevice* device, double x, double v, const double* z) {
  double stretch = stretch_of(device, x), square = stretch * stretch;
  double energy = (0.5 * device->stiffness + 0.25 * device->stiffness_cubic * square) * square;
  if (has(device, PART_FORCE_CURVE)) {
    energy += curve_integral(&device->curve[INERTER_STROKE_force], stretch);
  }
  if (has(device, PART_FORCE_MAP)) {
    energy += map_energy(device, stretch);
  }
  double y = stretch, w = v;
  if (has_bristle(device)) {
    energy += friction_energy(device, place_of_friction(device, stretch, v, z).x, z);
  }
  if (has(device, PART_SERIES)) {
    const double* series = z + series_index(device);
    y = stretch - series[0];
    w = series[1];
    energy += series_energy(device, series);
  }
  energy += inertance_energy(device, y, w);
  if (has(device, PART_GAS)) {
    energy += gas_energy(device, y);
  }
  if (has(device, PART_BRANCHES)) {
    energy += branches_energy(device, z + branch_index(device));
  }
  if (has(device, PART_DAMPER_SPRING)) {
    energy += damper_spring_energy(device, z[damper_index(device)]);
  }
  return has(device, PART_STOPS) ? energy + stop_energy(device, stretch) : energy;
}

// power turned into heat without a friction law with several states
static double power_beside_slip(const InerterDevice* device, double x, double v, double a,
                                const double* z) {
  double stretch = stretch_of(device, x), w = v;
  double damper = damper_force(device, stretch, v);
  double carried = branch_force(device, x, v, a, z);
  double load = load_at_terminals(device, v, z, carried) * fabs(carried);
  double on_bristle = law_load(device, x, v, a, z);
  Place rubbing = place_of_friction(device, stretch, v, z);
  double power = (damper + load) * v;
  const FrictionLaw* law = law_of(device);
  if (!slips(device)) {
    power += rubbing.v * (has(device, PART_WHEEL_FRICTION)
                              ? wheel_drag(device, x, v, z)
                              : law_force(device, stretch, v, z, on_bristle));
  }

  // what the law stores: dE/dt = dE/dx v + dE/dz z'; E is quadratic in x and z without cross term
  if (has_bristle(device) && !law->several) {
    double bristle = bristle_deflection(device, z[0]);
    double rate = law->rate(device, rubbing.x, rubbing.v, bristle, on_bristle);
    power -= 2 * law->energy(device, 0, 1) * bristle * rate;
    power -= 2 * law->energy(device, 1, 0) * rubbing.x * rubbing.v;
  }
  if (has(device, PART_SERIES)) {
    const double* series = z + series_index(device);
    w = series[1];
    power += series_heat(device, v, series);
  }
  if (has(device, PART_FLYWHEEL)) {
    power += flywheel_damper(device, w).value * w;
  }
  if (has(device, PART_BRANCHES)) {
    power += branches_heat(device, z + branch_index(device));
  }
  if (has(device, PART_DAMPER_SPRING)) {
    power += damper_spring_heat(device, z[damper_index(device)]);
  }
  if (has(device, PART_FORCE_MAP)) {
    power += map_heat(device, stretch, v);
  }
  return has(device, PART_STOPS) ? power + stop_heat(device, stretch, v) : power;
}

// power of a friction law with several states
static double power_of_slip(const InerterDevice* device, double x, double v, double a,
                            const double* z) {
  if (!slips(device)) {
    return 0;
  }
  double load = law_load(device, x, v, a, z), rate[INERTER_MAXFRICTION];
  Place rubbing = place_of_friction(device, stretch_of(device, x), v, z);
  friction_rates(device, rubbing.x, rubbing.v, z, load, rate);
  return friction_force(device, rubbing.x, rubbing.v, z, load) * rubbing.v -
         law_of(device)->several->stored_power(device, z, rate);
}

double inerter_dissipated_power(const InerterDevice* device, double x, double v, double a,
                                const double* z) {
  return power_beside_slip(device, x, v, a, z) + power_of_slip(device, x, v, a, z);
}

// what the elements of such a law turn into heat in a step to the velocity v1 and the states `end`
static double slip_heat(const InerterDevice* device, double x, double v, double a, const double* z,
                        double h, double v1, const double* end) {
  if (!slips(device)) {
    return 0;
  }
  Place before = place_of_friction(device, stretch_of(device, x), v, z);
  Place after = place_of_friction(device, stretch_of(device, x + h * v1), v1, end);
  return law_of(device)->several->heat(device, before.x, after.x - before.x, z, end,
                                       law_load(device, x, v, a, z));
}

double inerter_heat_over_step(InerterDevice* device, double x, double v, double a, const double* z,
                              double h, double v1, double a1, const double* end) {
  double slip = slip_heat(device, x, v, a, z, h, v1, end);
  double first = power_beside_slip(device, x, v, a, z);
  inerter_command(device, device->command, end);
  double last = power_beside_slip(device, x + h * v1, v1, a1, end);
  return 0.5 * h * (first + last) + slip;
}

int inerter_valid(const InerterDevice* device, double x, const double* z,
                  char message[INERTER_MESSAGE_SIZE]) {
  if (!isfinite(x)) {
    snprintf(message, INERTER_MESSAGE_SIZE, "displacement is %g m: give a finite number", x);
    return 0;
  }
  for (int i = 0; i < device->nstate; i++) {
    if (!isfinite(z[i])) {
      snprintf(message, INERTER_MESSAGE_SIZE, "%s is %g: give a finite number",
               inerter_state_name(device, i), z[i]);
      return 0;
    }
  }
  double y = stretch_of(device, x);
  if (has(device, PART_SERIES)) {
    const double* series = z + series_index(device);
    y -= series[0];
    if (!series_valid(device, series, message)) {
      return 0;
    }
  }
  if (has(device, PART_VARYING) && !inertance_valid(device, y, message)) {
    return 0;
  }
  return has(device, PART_GAS) ? gas_valid(device, y, message) : 1;
}
