// Devices along a measured motion: see motion.h.

#include "motion.h"

void inerter_along(const InerterDevice* device, int n, double h, const double* x, const double* v,
                   const double* a, double* z, double* total, double* friction, double* state) {
  double z_now = z ? *z : 0;
  int nstate = inerter_nstate(device);
  for (int i = 0; i < n; i++) {
    if (nstate && i) {
      double middle = 0.5 * (x[i] + x[i - 1]);
      z_now = inerter_state_step(device, middle, (x[i] - x[i - 1]) / h, z_now, h);
    }
    InerterForce force = inerter_force(device, x[i], v[i], a[i], z_now);
    if (total) total[i] = force.total;
    if (friction) friction[i] = force.friction;
    if (state) state[i] = z_now;
  }
  if (z) *z = z_now;
}

void inerter_along_many(const InerterDevice* devices, int ndevice, int n, double h, const double* x,
                        const double* v, const double* a, double* total) {
  for (int k = 0; k < ndevice; k++) {
    inerter_along(devices + k, n, h, x, v, a, 0, total + (size_t)k * n, 0, 0);
  }
}

void inerter_evaluate(const InerterDevice* device, int n, const double* x, const double* v,
                      const double* a, const double* z, double* result) {
  for (int i = 0; i < n; i++) {
    InerterForce force = inerter_force(device, x[i], v[i], a[i], z[i]);
    result[i] = force.total;
    result[n + i] = force.inertance;
    result[2 * n + i] = force.friction;
    result[3 * n + i] = inerter_state_rate(device, x[i], v[i], z[i]);
    result[4 * n + i] = inerter_stored_energy(device, x[i], v[i], z[i]);
    result[5 * n + i] = inerter_dissipated_power(device, x[i], v[i], a[i], z[i]);
  }
}
