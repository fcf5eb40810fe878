// Devices along a measured motion: what identification runs on.

#ifndef INERTER_CORE_MOTION_H_
#define INERTER_CORE_MOTION_H_

#include "device.h"

#ifdef __cplusplus
extern "C" {
#endif

// Force of one device at each sample of a motion x, v, a (n samples each), sample spacing h [s].
// The states start at z (in: initial, out: final; NULL: 0) and are stepped from sample to sample,
// a bristle to second order, at the mean velocity (x[i+1] - x[i]) / h, which keeps the path of
// rate-independent laws; a series element and branches along the quintic through x, v and a of both
// samples. total, friction (n each), states (n x nstate) may be NULL.
INERTER_API void inerter_along(const InerterDevice* device, int n, double h, const double* x,
                               const double* v, const double* a, double* z, double* total,
                               double* friction, double* states);

// The same with commands of the control, one at each sample, held until the next; NULL: none.
INERTER_API void inerter_along_commanded(const InerterDevice* device, int n, double h,
                                         const double* x, const double* v, const double* a,
                                         const double* command, double* z, double* total,
                                         double* friction, double* states);

// The same for ndevice parameter sets; total is ndevice x n, states start at 0.
INERTER_API void inerter_along_many(const InerterDevice* devices, int ndevice, int n, double h,
                                    const double* x, const double* v, const double* a,
                                    double* total);

// A signal of n samples through the low-pass 1 / (1 + (f / f_c)^6) of measured records, every
// `step`th sample of it, 1 + (n - 1) / step; angle: 2 pi f_c per sample rate.
INERTER_API void inerter_low_pass(int n, int step, double angle, const double* x, double* result);

// Total, inertance and friction force, stored energy and dissipated power at n independent points
// x, v, a, z (n x nstate); result is 5 x n, rates n x nstate.
INERTER_API void inerter_evaluate(const InerterDevice* device, int n, const double* x,
                                  const double* v, const double* a, const double* z, double* result,
                                  double* rates);

// The same with a command of the control at each of them; result is 6 x n, last the power of the
// control's actuator.
INERTER_API void inerter_evaluate_commanded(const InerterDevice* device, int n, const double* x,
                                            const double* v, const double* a, const double* command,
                                            const double* z, double* result, double* rates);

#ifdef __cplusplus
}
#endif

#endif  // INERTER_CORE_MOTION_H_
