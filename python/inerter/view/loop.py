"""The last seconds of a device's force, displacement and velocity."""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from inerter.device_in_model import DeviceInModel
from inerter.motion_units import TRANSLATION, Kind, force_word, unit, words

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Axes:
    """Units in which a loop is shown; `per_length` of them in an SI unit of displacement."""

    length: str
    per_length: float
    speed: str
    force: str
    newton: str

    @classmethod
    def of(cls, motion: Kind) -> Axes:
        """Those of a device that moves along a line, or turns."""
        length, per_length = ("mm", 1e3) if motion == TRANSLATION else ("rad", 1.0)
        return cls(length, per_length, unit(motion, "m/s"), force_word(motion), words(motion, "N"))


class Loop:
    """A ring of samples (time, displacement, velocity, force), the oldest overwritten.

    Parameters
    ----------
    capacity : int
        Samples kept.
    """

    def __init__(self, capacity: int = 4000) -> None:
        self._rows = np.empty((capacity, 4))
        self._count = 0

    def __len__(self) -> int:
        return min(self._count, len(self._rows))

    def append(self, time: float, x: float, v: float, force: float) -> None:
        """Add a sample. A time before the last one is a run that began anew: the old one goes.

        A sample at the time of the last one (a pause) is left out.
        """
        last = self._rows[(self._count - 1) % len(self._rows), 0] if self._count else -np.inf
        if time == last:
            return
        if time < last:
            self.clear()
        self._rows[self._count % len(self._rows)] = time, x, v, force
        self._count += 1

    def clear(self) -> None:
        """Forget everything."""
        self._count = 0

    def last(self, seconds: float) -> Array:
        """The samples of the last seconds in order of time, shape (4, n): time, x, v, force."""
        rows = self._rows[: len(self)]
        if self._count > len(self._rows):
            rows = np.roll(rows, -(self._count % len(self._rows)), axis=0)
        if not len(rows):
            return np.empty((4, 0))
        return rows[rows[:, 0] >= rows[-1, 0] - seconds].T.copy()


def instant(
    place: DeviceInModel, model: mujoco.MjModel, data: mujoco.MjData
) -> tuple[float, float, float, float]:
    """Time, displacement, velocity and force of a device after a step.

    Length, velocity and sensor are those of the step's evaluation, all of one instant.
    """
    row = int(model.actuator_outadr[place.actuator])
    return (
        float(data.time),
        float(data.actuator_length[row]) - place.rest_length(model),
        float(data.actuator_velocity[row]),
        float(data.sensordata[place.sensor["total"]]),
    )
