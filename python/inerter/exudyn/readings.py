"""What can be read off a device at some coordinates, recorded once and evaluated in C."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from typing import Any

from inerter.exudyn import control
from inerter.exudyn import device as law
from inerter.exudyn.element import HEAT, Element
from inerter.exudyn.functions import Functions, Value
from inerter.exudyn.tape import Tape

FORCES = ("total", "inertance", "friction")
READINGS = (
    "displacement", "velocity", "acceleration", *FORCES, "dissipated_power", "length",
    "stored_energy",
)  # fmt: skip
"""What can be read, and a sensor can measure, beside the states."""


class Readings:
    """`READINGS` and the states of an element, by name."""

    def __init__(self, element: Element) -> None:
        self.size = n = element.size
        tape = Tape(3 * n)
        parts = (tape.inputs[i * n : (i + 1) * n] for i in range(3))
        told = _told(element, tape.functions, *parts)
        self._keys = {name: tape.key(value) for name, value in told.items()}
        self._finished = tape.finish()
        self._slices = tuple(slice(i * n, (i + 1) * n) for i in range(3))
        self._places = {name: self._finished.place(key) for name, key in self._keys.items()}

    def needs(self, names: Sequence[str]) -> tuple[bool, bool, bool]:
        """Whether those named depend on coordinates, velocities, accelerations."""
        beneath = self._finished.beneath([self._keys[name] for name in names])
        inputs = {number for kind, number in beneath if kind == "input"}
        first, second, third = (
            not inputs.isdisjoint(range(each.start, each.stop)) for each in self._slices
        )
        return first, second, third

    @property
    def tape(self) -> int:
        """Address of the tape; its inputs are coordinates, velocities, accelerations."""
        return ctypes.addressof(self._finished.c)

    def place(self, name: str) -> int:
        """Where a reading lies among the values of the tape."""
        return self._places[name]

    def at(self, *parts: Any, names: Sequence[str] = ()) -> list[float]:
        """Those named, at coordinates, velocities and accelerations, each of shape (size,).

        What they do not need may be None.
        """
        values = self._finished.values
        for where, part in zip(self._slices, parts, strict=True):
            if part is not None:
                values[where] = part
        found = self._finished.rerun()
        return [found.item(self._places[name]) for name in names]

    @property
    def names(self) -> tuple[str, ...]:
        """All that can be read."""
        return tuple(self._places)


def _told(
    element: Element,
    f: Functions,
    q: Sequence[Value],
    q_t: Sequence[Value],
    q_tt: Sequence[Value],
) -> dict[str, Value]:
    p, motion = element.device, element.motion(f, q, q_t)
    x, v = motion.length - p.rest_length, motion.rate
    a = motion.bias
    for share, latest in zip(motion.row, q_tt, strict=False):
        a = a + share * latest
    z = element.states(x, q, q_t)
    if p.backlash:
        # within the play, past whose edge a last step may have gone; without a damper the
        # position follows from the deflection
        gap, slide = (p.state_names.index(n) for n in ("gap_position", "series_deflection"))
        place = z[gap] if p.series_damping else z[slide]
        z[gap] = f.least(p.backlash, f.greatest(-p.backlash, place))
    p = control.present(f, p, z)
    forces = law.forces(p, x, v, a, z, f)
    heat = law.dissipated_power(f, p, x, v, z, forces["inertance"])
    told = {"length": motion.length, "displacement": x, "velocity": v, "acceleration": a, **forces}
    told |= {"dissipated_power": heat, "stored_energy": law.stored_energy(p, x, v, z, f)}
    told |= dict(zip(p.state_names, z, strict=True))
    return told | ({HEAT: q_t[element.first + element.own.index(HEAT)]} if element.heat else {})
