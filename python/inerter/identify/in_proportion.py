"""What one of a coordinate adds to the force, where that is in proportion to the coordinate.

It is a function of the motion alone. Of a node of a curve along the stroke it is what the core
gives of a device that has nothing else.
"""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from inerter.catalogue.along_stroke import Quantity, node_of
from inerter.catalogue.coordinates import BENDS, COORDINATES, ENTANGLED, device_values
from inerter.core import Device
from inerter.identify.channel import LINEAR, through_channel
from inerter.identify.model import Model
from inerter.identify.runs import BenchRun, forces_along

Array = NDArray[np.float64]

PLACES = ("rest_length", "curve_lower", "curve_upper")
"""What beside a node says what its curve adds to the force."""
BY_SPEED = "inertance_speed_gradient"
"""What every node of the inertance is multiplied by too."""


def column_key(name: str, model: Model, channel: Sequence[str] = ()) -> tuple[Hashable, ...]:
    """What of a model a coordinate's column depends on; `channel`: what the channel does to it."""
    places = PLACES if curve_of(name) else PLACES[:1]
    also = (BY_SPEED,) if times_inertance(name) else ()
    values = (model.values.get(each, 0.0) for each in (*places, *also, *channel))
    return name, _nodes(name, model), *values


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


def at_speeds(name: str, model: Model) -> list[tuple[float, Model]]:
    """Models by whose columns, times a share each, the column of a coordinate is known.

    What a node adds to the force is linear in the gradient of the inertance along the speed.
    """
    by_speed = model.values.get(BY_SPEED, 0.0)
    if not by_speed or not times_inertance(name):
        return [(1.0, model)]
    pair = ((1.0 - by_speed, 0.0), (by_speed, 1.0))
    return [(share, model.holding(**{BY_SPEED: at})) for share, at in pair]


def times_inertance(name: str) -> bool:
    """Whether a coordinate's column is one of each kilogram of the inertance."""
    quantity = curve_of(name)
    return quantity is not None and quantity.name == "inertance"


def _nodes(name: str, model: Model) -> tuple[int, ...]:
    """Numbers of nodes of the curve that a coordinate is a node of, and of that for v < 0."""
    if (quantity := curve_of(name)) is None:
        return ()
    names = model.values.keys()
    return tuple(len(names & set(each)) for each in (quantity.nodes, quantity.back_nodes))


def shown_by(name: str, model: Model, run: BenchRun) -> Array:
    """What one of a coordinate adds to a run's force channel, shape (n,)."""
    channel = {each: model.values[each] for each in LINEAR if each in model.values}
    if (curve_of(name) or name in BENDS) and np.isfinite(run.cutoff):
        # what bends more sharply than the motion passes the low-pass of the measured force
        device, less = _alone(name, model)
        fine = run.at_measured_rate(device, 0.0)["total"]
        if less:
            fine = fine - run.at_measured_rate(less, 0.0)["total"]
        return through(channel, fine, run)
    return through_channel(channel, column_of(name, model, run), run.elapsed, run.spacing)


def through(channel: Mapping[str, float], force: Array, run: BenchRun) -> Array:
    """A force that bends sharply, (m,), as the force channel shows it in the run's band, (n,)."""
    if np.isinf(run.cutoff):
        return through_channel(channel, force, run.elapsed, run.spacing)
    return run.in_band(through_channel(channel, force, run.fine_elapsed, run.fine_spacing))


def column_of(name: str, model: Model, run: BenchRun) -> Array:
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
    return column(stretch, run.velocity, run.acceleration, run.elapsed)


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
