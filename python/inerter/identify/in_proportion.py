"""What one of a coordinate adds to the force, where that is in proportion to the coordinate.

It is a function of the motion alone. Of a node of a curve along the stroke it is what the core
gives of a device that has nothing else. What a run's channel shows of it is kept, for every problem
that has the run.
"""

from __future__ import annotations

import functools
from collections.abc import Hashable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from inerter.catalogue.along_stroke import Quantity, node_of
from inerter.catalogue.coordinates import BENDS, COORDINATES, ENTANGLED, device_values
from inerter.core import Device
from inerter.identify.channel import LINEAR, through_channel
from inerter.identify.kept import Kept
from inerter.identify.model import Model
from inerter.identify.runs import BenchRun, forces_along

Array = NDArray[np.float64]

# arrays [bytes] that are kept of all runs in a process: of use to every problem that has the run
_OF_RUNS: Kept[np.float64] = Kept(2**26)

# samples that are worked on at once, of all coordinates together
_AT_ONCE = 2**20

Rows = Sequence[tuple[str, Model]]
"""Coordinates, each with the model that its column is of."""

PLACES = ("rest_length", "curve_lower", "curve_upper")
"""What beside a node says what its curve adds to the force."""
BY_SPEED = "inertance_speed_gradient"
"""What every node of the inertance is multiplied by too."""


def column_keys(rows: Rows, channel: Sequence[str] = ()) -> list[tuple[Hashable, ...]]:
    """What of models coordinates' columns depend on; `channel`: what the channel does to them."""
    keys: list[tuple[Hashable, ...]] = []
    last, told, names = None, ((), ()), frozenset()
    for name, model in rows:
        if model is not last:
            last, names = model, frozenset(model.values)
            shown = tuple(model.values.get(each, 0.0) for each in (*PLACES, *channel))
            told = (model.values.get(PLACES[0], 0.0), *shown[len(PLACES) :]), shown
        quantity = curve_of(name)
        if quantity is None:
            keys.append((name, *told[0]))
            continue
        by_speed = model.values.get(BY_SPEED, 0.0) if times_inertance(name) else 0.0
        keys.append((name, *_nodes(quantity, names), by_speed, *told[1]))
    return keys


def curve_of(name: str) -> Quantity | None:
    """What a coordinate is a node of, where the force is in proportion to it."""
    quantity = node_of(name)
    return quantity if quantity and quantity.name in ("force", "inertance") else None


def entangling(name: str) -> Sequence[str]:
    """Coordinates beside which the force is not in proportion to this one."""
    quantity = curve_of(name)
    if quantity is None:
        return ENTANGLED.get(name, ())
    if quantity.name == "force":
        return ()
    # what the inertance gains along the stroke adds up, and of the speed see `at_speeds`
    added = {*quantity.coordinates, *quantity.stands_for, BY_SPEED}
    return tuple(each for each in ENTANGLED["inertance"] if each not in added)


def factor_of(name: str, model: Model) -> float:
    """What a column is multiplied by in this model."""
    return model.values["inertance"] if times_inertance(name) else 1.0


def at_speeds(model: Model) -> list[tuple[float, Model]]:
    """Models by whose columns, times a share each, those of nodes of an inertance are known.

    What a node adds to the force is linear in the gradient of the inertance along the speed.
    """
    by_speed = model.values.get(BY_SPEED, 0.0)
    if not by_speed:
        return [(1.0, model)]
    pair = ((1.0 - by_speed, 0.0), (by_speed, 1.0))
    return [(share, model.holding(**{BY_SPEED: at})) for share, at in pair]


def times_inertance(name: str) -> bool:
    """Whether a coordinate's column is one of each kilogram of the inertance."""
    quantity = curve_of(name)
    return quantity is not None and quantity.name == "inertance"


@functools.lru_cache(maxsize=64)
def _nodes(quantity: Quantity, names: frozenset[str]) -> tuple[int, int]:
    """How many nodes coordinates have of a curve, and of that for v < 0."""
    return len(names & set(quantity.nodes)), len(names & set(quantity.back_nodes))


def shown_by(rows: Rows, run: BenchRun) -> Array:
    """What a run's force channel shows of one of each coordinate, (m, n)."""
    values = rows[0][1].values if rows else {}
    channel = {each: values[each] for each in LINEAR if each in values}
    plain = column_keys(rows)

    def shown(missing: list[int]) -> list[Array]:
        found: list[Array] = []
        for some in _few(missing, run.force.size):
            columns = _OF_RUNS.all_found(
                [(run.identity, _in_band_of, *plain[i]) for i in some],
                lambda new, some=some: [_in_band_of(*rows[some[k]], run) for k in new],
            )
            found += list(through_channel(channel, columns, run.elapsed - run.zero, run.spacing))
        return found

    return _OF_RUNS.all_found([(run.identity, *key) for key in column_keys(rows, LINEAR)], shown)


def clipped(rows: Rows, run: BenchRun, beyond: NDArray[np.bool_]) -> Array:
    """What of these it does not show where the channel has come to a limit, (m, n).

    `beyond` is told at the rate at which the force passes the channel, see `beyond_limits`.
    """
    values = rows[0][1].values if rows else {}
    channel = {each: values[each] for each in LINEAR if each in values}
    keys, fine, found = column_keys(rows), np.isfinite(run.cutoff), []
    of = _force_of if fine else _column_of
    for some in _few(range(len(rows)), beyond.size):
        forces = _OF_RUNS.all_found(
            [(run.identity, of, *keys[i]) for i in some],
            lambda new, some=some: [of(*rows[some[k]], run) for k in new],
        )
        lost = np.where(beyond, _passed(channel, forces, run), 0.0)
        found.append(run.in_band(lost) if fine else lost)
    return np.concatenate(found)


def _few(which: Sequence[int], size: int) -> list[Sequence[int]]:
    """As many at a time as have columns of a size that do not take too much memory."""
    count = max(1, _AT_ONCE // size)
    return [which[i : i + count] for i in range(0, len(which), count)]


def first_shares(rows: Rows, run: BenchRun) -> Array:
    """What one of each coordinate is of a run's first force, (m,); 0 of one that begins later."""

    def shares(missing: list[int]) -> list[Array]:
        at = slice(run.first, run.first + 1)
        return [_column_of(*rows[i], run)[at].copy() for i in missing]

    keys = [(run.identity, "first", *key) for key in column_keys(rows)]
    found = _OF_RUNS.all_found(keys, shares)[:, 0]
    return np.where([name != "force_drift" for name, _ in rows], found, 0.0)


def _bends(name: str, run: BenchRun) -> bool:
    """Whether a coordinate's force bends more sharply than the motion.

    Then it passes the low-pass of the measured force, and is asked for at the measured rate.
    """
    return bool((curve_of(name) or name in BENDS) and np.isfinite(run.cutoff))


def _in_band_of(name: str, model: Model, run: BenchRun) -> Array:
    """What one of a coordinate adds to a device's force in a run's band, shape (n,)."""
    if _bends(name, run):
        return run.in_band(_force_of(name, model, run))
    return _column_of(name, model, run)


def _force_of(name: str, model: Model, run: BenchRun) -> Array:
    """What one of a coordinate adds to a device's force at the measured rate, (m,)."""
    column = COORDINATES[name].column
    if column and name not in BENDS and run.measured is not None:
        x, v, a = run.measured
        return column(x - model.values.get("rest_length", 0.0), v, a, run.fine_elapsed - run.zero)
    device, less = _alone(name, model)
    fine = run.at_measured_rate(device, 0.0)["total"]
    return fine - run.at_measured_rate(less, 0.0)["total"] if less else fine


def through(channel: Mapping[str, float], force: Array, run: BenchRun) -> Array:
    """Forces that bend sharply, (..., m), as the channel shows them in a run's band, (..., n)."""
    shown = force if np.isinf(run.cutoff) else run.in_band(force)
    return through_channel(channel, shown, run.elapsed - run.zero, run.spacing)


def _passed(channel: Mapping[str, float], force: Array, run: BenchRun) -> Array:
    """The same at the rate at which they pass the channel, (..., m)."""
    if np.isinf(run.cutoff):
        return through_channel(channel, force, run.elapsed - run.zero, run.spacing)
    return through_channel(channel, force, run.fine_elapsed - run.zero, run.fine_spacing)


def _column_of(name: str, model: Model, run: BenchRun) -> Array:
    """What one of a coordinate adds to a device's force along a run, shape (n,)."""
    column = COORDINATES[name].column
    if column is None:
        pair = (each for each in _alone(name, model) if each)
        totals = [
            forces_along(each, run.spacing, run.followed, 0.0, run.force.size)["total"]
            for each in pair
        ]
        return totals[0] - totals[1] if len(totals) > 1 else totals[0]
    stretch = run.displacement - model.values.get("rest_length", 0.0)
    return column(stretch, run.velocity, run.acceleration, run.elapsed - run.zero)


def _alone(name: str, model: Model) -> tuple[Device, Device | None]:
    """A device whose only force is that of one coordinate, or that and the other one's.

    The coordinate is a node of a curve, or a parameter of a device.
    """
    quantity = curve_of(name)
    if quantity is None:
        places = {n: model.values[n] for n in PLACES[:1] if n in model.values}
        return Device(friction="none", **device_values({**places, name: 1.0})), None
    values = {each: 0.0 for each in model.values if node_of(each) is quantity}
    values |= {each: model.values[each] for each in PLACES if each in model.values}
    if quantity.name == "force":
        return Device(friction="none", **device_values({**values, name: 1.0})), None
    alone = {"inertance": 1.0, BY_SPEED: model.values.get(BY_SPEED, 0.0)}
    plain = Device(friction="none", **device_values(alone))
    return Device(friction="none", **device_values({**values, **alone, name: 1.0})), plain
