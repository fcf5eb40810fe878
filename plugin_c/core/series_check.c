// Whether the parameters of a series element fit together.

#include "configuration.h"
#include "series.h"

// what slips in series with the inertance
static int check_slipping(const InerterDevice* p, char* message) {
  const int each[] = {INERTER_INDEX_clutch_force, INERTER_INDEX_leak_damping,
                      INERTER_INDEX_leak_quadratic_damping};
  const double values[] = {p->clutch_force, p->leak_damping, p->leak_quadratic_damping};
  const InerterParameter* found = NULL;
  double value = 0;
  for (int i = 0; i < 3 && !found; i++) {
    value = values[i];
    found = value > 0 ? inerter_parameter(each[i]) : NULL;
  }
  if (p->clutch_asymmetry != 0 && p->clutch_force == 0) {
    return refuse(message,
                  "clutch_asymmetry is %g, but clutch_force is 0 N: there is no clutch; give "
                  "clutch_force > 0 N or remove clutch_asymmetry",
                  p->clutch_asymmetry);
  }
  if (!found) {
    return 0;
  }
  if (p->inertance == 0) {
    return refuse(message,
                  "%s is %g %s, but inertance is 0 kg: there is nothing behind what slips; give "
                  "inertance > 0 kg or remove %s",
                  found->name, value, found->unit, found->name);
  }
  if (p->backlash > 0) {
    return refuse(message,
                  "%s is %g %s and backlash %g m: a series element has free play or slips, not "
                  "both; remove one of them",
                  found->name, value, found->unit, p->backlash);
  }
  if (p->clutch_force > 0 && p->series_damping == 0) {
    int bears = p->series_stiffness > 0;
    if (!bears || (p->leak_damping == 0 && p->leak_quadratic_damping == 0)) {
      return refuse(message, "clutch_force is %g N, but series_%s is 0 %s: %s; give %s > 0",
                    p->clutch_force, bears ? "damping" : "stiffness", bears ? "N*s/m" : "N/m",
                    bears ? "how fast it slips would not be determined"
                          : "while the clutch holds, nothing bears the force",
                    bears ? "series_damping" : "series_stiffness and series_damping");
    }
  }
  return 0;
}

int series_check(const InerterDevice* device, char* message) {
  if (device->friction_side == INERTER_SIDE_flywheel && device->mu_backward >= 1) {
    const char* name = device->load_friction >= 1 ? "load_friction" : "mu_backward";
    return refuse(message,
                  "%s is %g and friction_side is \"flywheel\": the flywheel would lock; "
                  "give %s < 1",
                  name, device->mu_backward, name);
  }
  const int needy[] = {INERTER_INDEX_series_hardening, INERTER_INDEX_backlash};
  const double values[] = {device->series_hardening, device->backlash};
  for (int i = 0; i < 2; i++) {
    const InerterParameter* p = inerter_parameter(needy[i]);
    if (values[i] != 0 && device->series_stiffness == 0) {
      return refuse(message,
                    "%s is %g %s, but series_stiffness is 0 N/m; give series_stiffness > 0 N/m or "
                    "remove %s",
                    p->name, values[i], p->unit, p->name);
    }
  }
  if (device->inertance == 0 && (device->series_stiffness > 0 || device->series_damping > 0)) {
    int stiff = device->series_stiffness > 0;
    return refuse(message,
                  "%s is %g %s, but inertance is 0 kg: there is nothing behind the series element; "
                  "give inertance > 0 kg or remove %s",
                  stiff ? "series_stiffness" : "series_damping",
                  stiff ? device->series_stiffness : device->series_damping,
                  stiff ? "N/m" : "N*s/m", stiff ? "series_stiffness" : "series_damping");
  }
  return check_slipping(device, message);
}
