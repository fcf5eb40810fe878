// Devices along a measured motion: what identification runs on.

#ifndef INERTER_CORE_MOTION_H_
#define INERTER_CORE_MOTION_H_

#include "device.h"

#ifdef __cplusplus
extern "C" {
#endif

// Force of one device at each sample of a motion x, v, a (n samples each), sample spacing h [s].
// The state starts at *z (in: initial, out: final) and is stepped from sample to sample at the mean
// velocity (x[i+1] - x[i]) / h, which is second order and keeps the path of rate-independent laws.
// total, friction, state (n each) may be NULL.
INERTER_API void inerter_along(const InerterDevice* device, int n, double h, const double* x,
                               const double* v, const double* a, double* z, double* total,
                               double* friction, double* state);

// The same for ndevice parameter sets; total is ndevice x n, states start at 0.
INERTER_API void inerter_along_many(const InerterDevice* devices, int ndevice, int n, double h,
                                    const double* x, const double* v, const double* a,
                                    double* total);

// Total, inertance and friction force, state rate, stored energy and dissipated power at n
// independent points x, v, a, z; result is 6 x n.
INERTER_API void inerter_evaluate(const InerterDevice* device, int n, const double* x,
                                  const double* v, const double* a, const double* z,
                                  double* result);

#ifdef __cplusplus
}
#endif

#endif  // INERTER_CORE_MOTION_H_
