"""How fast a flywheel turns where a run begins with its clutch slipping.

Nothing measures that: the force of a clutch that slips does not go with how fast. But the force
that comes through drives the flywheel, and where the clutch holds for the first time it turns with
the terminals:

    w(0) = v(t) - F_s'(t) / k_s - (1 / b) integral of F_s from 0 to t

F_s is the measured force without what stands beside the inertance; the median over all t at which
it holds soon, for a low-pass smears where it begins to, and leaves the integral. Not counted:
damping of the flywheel, a bristle between the terminals that is bent as the run begins.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import cumulative_trapezoid

from inerter.core import Device
from inerter.identify.runs import BenchRun

Array = NDArray[np.float64]

# share of what a clutch bears from which on it may slip
_SLIPS = 0.95
# times the first slip, and samples at least, within which it is asked where it holds
_TIMES, _LEAST = 4, 60


def flywheel_speed(device: Device, run: BenchRun) -> float:
    """Velocity of the flywheel [m/s] at the run's first sample; that of the terminals if it holds.

    Parameters
    ----------
    device : Device
        One with a clutch.
    run : BenchRun
        Thinned, its motion and force in the same band.
    """
    first = run.first
    x, v, a = (c[first:] for c in (run.displacement, run.velocity, run.acceleration))
    states = np.zeros((v.size, device.nstate))
    states[:, device.state_names.index("flywheel_velocity")] = v
    through = run.force[first:] - device.evaluate(x, v, a, states)["total"]
    uneven = np.sign(through) * device.clutch_asymmetry
    held = np.abs(through) < _SLIPS * device.clutch_force * (1.0 + uneven)
    if held[0] or not held.any():
        return float(v[0])
    end = max(_TIMES * int(np.argmax(held)), _LEAST)
    through, held = through[:end], held[:end]
    impulse = cumulative_trapezoid(through, dx=run.spacing, initial=0.0)
    speed = v[:end] - impulse / device.inertance
    if device.series_stiffness:
        speed = speed - np.gradient(through, run.spacing) / device.series_stiffness
    return float(np.median(speed[held]))
