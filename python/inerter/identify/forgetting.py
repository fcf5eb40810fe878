"""How a bristle forgets how it was bent as a record began."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inerter.core import Device
from inerter.identify.runs import BenchRun

Array = NDArray[np.float64]

# ways that renew contacts, along which it is forgotten what a rest of some seconds had made of
# them: the logarithm of their age falls evenly over the first few. With 1 as with 2.5 seven drawn
# devices are named alike; with 6 two of them are Coulomb friction
_AGES = 2.5


def held(device: Device) -> float:
    """Deflection of the bristle [m] at which it slides; for Bouc-Wen without one, a play."""
    if device.friction != "bouc_wen":
        return device.coulomb_force / device.bristle_stiffness
    narrowing = device.bw_beta + device.bw_gamma
    if narrowing <= 0:
        return device.friction_backlash
    return float((device.bw_alpha / narrowing) ** (1 / device.bw_exponent))


@dataclass(frozen=True)
class Forgetting:
    """Along what path a bristle forgets how it was bent.

    Behind a larger play it begins somewhere in that, which says how it was bent. Contacts that age
    forget so how long they had been at rest, which no force at rest tells.

    reach: path slid without a load that leaves 1/e of it [m]; 0 without one bristle alone.
    forth, back: share of the reach that an acceleration of 1 m/s^2 adds, as the force through the
        inertance raises the level at which the bristle yields; where the motion drives the flywheel
        and where that drives the motion [s^2/m].
    """

    reach: float
    forth: float = 0.0
    back: float = 0.0

    @classmethod
    def of(cls, device: Device) -> Forgetting:
        """How a device's bristle does."""
        if device.friction == "rate_state":
            return cls(_AGES * device.age_distance)
        if device.friction not in ("dahl", "lugre", "bouc_wen"):
            return cls(0.0)
        reach = held(device)
        if reach <= 0.0 or device.friction_backlash > reach:
            return cls(0.0)
        level = device.coulomb_force
        if device.friction == "bouc_wen":
            level = abs(1.0 - device.bw_ratio) * device.bw_stiffness * reach
        per_load = device.inertance / level if level else 0.0
        return cls(reach, device.mu_forward * per_load, device.mu_backward * per_load)

    def path(self, run: BenchRun) -> Array:
        """Path since a run's sample `first` in which a reach of it forgets as much [m], (n,)."""
        if not (self.forth or self.back):
            return run.path
        forth = run.acceleration * run.velocity > 0.0
        load = np.abs(run.acceleration) * np.where(forth, self.forth, self.back)
        slid = np.cumsum(np.abs(run.velocity) / (1.0 + load)) * run.spacing
        return np.maximum(slid - slid[run.first], 0.0)
