"""The user functions of sensors, built-in functions of the C library."""

from __future__ import annotations

from typing import Any

import numpy as np

from inerter.exudyn.library import CSensor, built_in
from inerter.exudyn.readings import Readings

MOST = 2000
"""Up to so many coordinates of a system all of them are quicker to have than those of an object."""

QUESTIONS = ("GetODE2Coordinates", "GetODE2Coordinates_t", "GetODE2Coordinates_tt")


class Sensor:
    """What the user function of a sensor reads, which others hold.

    Parameters
    ----------
    whole
        A function of the same arguments in Python. It is called where the object's coordinates are
        not yet known among those of the system, and where what is read is not finite.
    """

    def __init__(self, readings: Readings, names: tuple[str, ...], whole: Any) -> None:
        self._names = names
        self._c = CSensor(data="systemData", question=QUESTIONS, whole=whole)
        self.take(readings)

    def function(self) -> Any:
        """The user function; as long as it lives, so does what it reads."""
        return built_in("sensor", self._c, self)

    def take(self, readings: Readings) -> None:
        """Read these from now on; they are of the same coordinates."""
        tape, size = readings.tape, readings.size
        self._places = np.array([readings.place(name) for name in self._names], dtype=np.int32)
        self._kept = readings
        c = self._c
        c.tape, c.size, c.ntold = tape, size, len(self._places)
        c.needed[:] = readings.needs(self._names)
        c.places = self._places.ctypes.data

    def locate(self, mbs: Any, objectNumber: Any) -> None:
        """Find the object's coordinates among those of an assembled system."""
        data = mbs.systemData
        found = np.array(data.GetObjectLTGODE2(objectNumber), dtype=np.int32)
        total = len(np.atleast_1d(data.GetODE2Coordinates()))
        if total <= MOST and len(found) == self._c.size and found.max(initial=-1) < total:
            self._numbers = found
            self._c.total, self._c.coordinates = total, found.ctypes.data

    def forget(self) -> None:
        """The system is assembled anew."""
        self._c.coordinates = None
