"""Coordinates of what changes along the stroke: periods and free curves of a device's lists.

    force_period_1, _cosine_1, _sine_1     length [m] and amplitudes [N] of a force of the place
    force_node_1 ... force_node_33         that force at evenly spaced places [N], curve_lower to
                                           curve_upper, with a smooth curve between them
    friction_..., inertance_...            the same of the friction level and of the inertance,
                                           relative to what they are
    inertance_back_node_1 ...              of the inertance for v < 0, where it differs

A device has them as lists (`force_periods`: length, amplitude, phase of each; `force_curve`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.interpolate import BSpline, make_interp_spline

from inerter.catalogue.combinations import Values
from inerter.catalogue.coordinate import Coordinate, OfScales

PERIODS, NODES = 3, 33
"""Largest numbers of periods and of nodes that a fit has."""
TURN = 2 * np.pi
"""The period about an axis of a weight out of balance [rad]."""


@dataclass(frozen=True)
class Quantity:
    """What changes along the stroke.

    Attributes
    ----------
    name
        First word of its parameters.
    effect
        The effect that it is named as.
    unit, words
        Of its amplitude.
    size, bound
        Typical size of an amplitude, and the largest; both of the sizes of the data.
    stands_for
        Coordinates whose part in the force curves have too, and that go where one comes.
    nodes_zero
        Coordinates by which nodes of a curve are held at 0: the middle one by the first, the last
        one by the second.
    flanks
        Whether a curve may be another one for v < 0: where two flanks of a tooth carry in turn.
    """

    name: str
    effect: str
    unit: str
    words: str
    size: OfScales
    bound: OfScales
    stands_for: tuple[str, ...] = ()
    nodes_zero: tuple[str, ...] = ()
    flanks: bool = False

    def period(self, number: int) -> tuple[str, str, str]:
        """Coordinates of a period: length, amplitude of the cosine and of the sine."""
        name = self.name
        return f"{name}_period_{number}", f"{name}_cosine_{number}", f"{name}_sine_{number}"

    def period_of_a_turn(self, values: Mapping[str, float]) -> tuple[str, str, str] | None:
        """Coordinates that a period of one turn may have; None where it is there, or no place."""
        periods = [self.period(i) for i in range(1, PERIODS + 1)]
        if any(values.get(length) == TURN for length, *_ in periods):
            return None
        return next((each for each in periods if each[0] not in values), None)

    def node(self, number: int) -> str:
        """Coordinate of a curve's node, from 1 on."""
        return self.nodes[number - 1]

    @cached_property
    def nodes(self) -> tuple[str, ...]:
        """Coordinates of a curve's nodes."""
        return tuple(f"{self.name}_node_{i}" for i in range(1, NODES + 1))

    @cached_property
    def back_nodes(self) -> tuple[str, ...]:
        """Coordinates of the nodes of its curve for v < 0, if it may have one."""
        numbers = range(1, NODES + 1) if self.flanks else ()
        return tuple(f"{self.name}_back_node_{i}" for i in numbers)

    @cached_property
    def coordinates(self) -> tuple[str, ...]:
        """Every coordinate."""
        periods = (name for i in range(1, PERIODS + 1) for name in self.period(i))
        return (*periods, *self.nodes, *self.back_nodes)

    @property
    def amplitudes(self) -> tuple[str, ...]:
        """Coordinates that are 0 where nothing changes."""
        return tuple(name for name in self.coordinates if "_period_" not in name)

    @property
    def reported(self) -> tuple[str, ...]:
        """What a finding reports."""
        return (
            *(name for names in self.told_periods for name in names),
            *self.nodes,
            *self.back_nodes,
        )

    @cached_property
    def told_periods(self) -> tuple[tuple[str, ...], ...]:
        """Length, amplitude and phase of each period."""
        words = ("period", "amplitude", "phase")
        return tuple(
            tuple(f"{self.name}_{word}_{i}" for word in words) for i in range(1, PERIODS + 1)
        )

    def form(self, names: set[str]) -> str | None:
        """What some coordinates are of it: "flanks", "curve", "period" or nothing."""
        if not names.isdisjoint(self.back_nodes):
            return "flanks"
        if any(name.startswith(f"{self.name}_node_") for name in names):
            return "curve"
        periods = {name for i in range(1, PERIODS + 1) for name in self.period(i)}
        return None if names.isdisjoint(periods) else "period"


QUANTITIES = (
    Quantity(
        "force", "position_force", "N", "force",
        lambda s: 0.05 * s.force, lambda s: 3 * s.force, ("stiffness_cubic",),
        ("force_offset", "stiffness"),
    ),
    # with three periods at their bounds there is still some left
    Quantity(
        "inertance", "variable_inertance", "1", "inertance",
        lambda s: 0.02, lambda s: 0.2, ("inertance_gradient", "inertance_curvature"),
        ("inertance",), flanks=True,
    ),
    Quantity(
        "friction", "position_dependent_friction", "1", "friction level",
        lambda s: 0.1, lambda s: 0.6, ("friction_gradient", "friction_curvature"),
        ("coulomb_force",),
    ),
)  # fmt: skip
"""What can change along the stroke."""


def _of(quantity: Quantity) -> tuple[Coordinate, ...]:
    n, bound = quantity.name, quantity.bound
    how = {
        "unit": quantity.unit, "size": quantity.size, "entangled": n == "inertance",
        "lower": lambda s: -bound(s), "upper": bound,
    }  # fmt: skip
    found = []
    for i in range(1, PERIODS + 1):
        length, *amplitudes = quantity.period(i)
        found.append(
            Coordinate(
                name=length,
                unit="m",
                logarithmic=True,
                none=None,
                size=lambda s: s.displacement,
                lower=lambda s: 1e-4 * s.displacement,
                upper=lambda s: 30 * s.displacement,
                words={
                    length: f"period of the {quantity.words} along the stroke",
                    f"{n}_amplitude_{i}": "its amplitude",
                    f"{n}_phase_{i}": "its phase",
                },
            )
        )
        found += [Coordinate(name=name, **how) for name in amplitudes]
    nodes = (*quantity.nodes, *quantity.back_nodes)
    return (*found, *(Coordinate(name=n, words={n: n.replace("_", " ")}, **how) for n in nodes))


COORDINATES = tuple(each for quantity in QUANTITIES for each in _of(quantity))
"""Every coordinate of a change along the stroke."""

REPORTED_UNITS: Mapping[str, str] = {
    name: unit
    for q in QUANTITIES
    for name, unit in (
        *((name, q.unit) for name in (*q.nodes, *q.back_nodes)),
        *(
            pair
            for i in range(1, PERIODS + 1)
            for pair in (
                (q.period(i)[0], "m"),
                (f"{q.name}_amplitude_{i}", q.unit),
                (f"{q.name}_phase_{i}", "rad"),
            )
        ),
    )
}
"""Units of what findings report of it and no device has a parameter for."""


_QUANTITY_OF = {name: q for q in QUANTITIES for name in (*q.nodes, *q.back_nodes)}
_NAMES = {name for q in QUANTITIES for name in (*q.coordinates, *q.reported)}

FORMS: Mapping[str, str] = {
    "period": "periodic along the stroke",
    "curve": "a curve along the stroke",
    "flanks": "a curve along the stroke in each direction of motion",
    "speed": "with the speed",
}
"""What the law of such a finding is in running text."""


def curves_of_nodes(lower: float, upper: float, nodes: int) -> BSpline:
    """The curves (nodes,) over the place [m] of which each is 1 at one node and 0 at the others.

    A device's curve: a cubic spline whose slope is 0 at both ends.
    """
    places = np.linspace(lower, upper, nodes)
    return make_interp_spline(places, np.eye(nodes), k=3, bc_type="clamped")


def node_of(parameter: str) -> Quantity | None:
    """The quantity whose curve has a node of this name."""
    return _QUANTITY_OF.get(parameter)


def told(values: Values) -> None:
    """Amplitude and phase in the place of cosine and sine."""
    if values.keys().isdisjoint(_NAMES):
        return
    for quantity in QUANTITIES:
        for i in range(1, PERIODS + 1):
            _, cosine, sine = quantity.period(i)
            if cosine in values and sine in values:
                c, s = values.pop(cosine), values.pop(sine)
                values[f"{quantity.name}_amplitude_{i}"] = float(np.hypot(c, s))
                values[f"{quantity.name}_phase_{i}"] = float(np.arctan2(c, s))


def lists(values: Values) -> dict[str, tuple[float, ...]]:
    """Lists of a device that told parameters stand for; these are taken out of the values."""
    found: dict[str, tuple[float, ...]] = {}
    present = values.keys() & _NAMES
    if not present:
        return found
    for quantity in QUANTITIES:
        rows: list[float] = []
        for names in quantity.told_periods:
            if not present.isdisjoint(names):
                row = [values.pop(name, 0.0) for name in names]
                rows += row if row[1] else []
        if rows:
            found[f"{quantity.name}_periods"] = tuple(rows)
        forth, back = f"{quantity.name}_curve", f"{quantity.name}_back_curve"
        for name, names in ((forth, quantity.nodes), (back, quantity.back_nodes)):
            known = [i for i, each in enumerate(names) if each in present]
            if not known:
                continue
            curve = [0.0] * (known[-1] + 1)
            for i in known:
                curve[i] = float(values.pop(names[i]))
            # none for v < 0 would be that for v > 0
            if any(curve) or name == back:
                found[name] = tuple(curve)
    return found
