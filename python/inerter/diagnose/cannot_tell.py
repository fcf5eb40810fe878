"""What a motion cannot tell, whatever is found along it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence, Set
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inerter.catalogue.along_stroke import TURN
from inerter.catalogue.scales import Scales
from inerter.identify.channel_filter import filters_of
from inerter.identify.model import Model
from inerter.identify.runs import BenchRun
from inerter.motion_units import ROTATION
from inerter.records import Record

# strokes from which on time and place are told apart; share of the largest speed from which on a
# device moves; share of the travel that is left between two stops; share of a period by which a
# low-pass is late at most
FEW_STROKES, _MOVING, _ROOM, _TURNED = 4, 0.05, 0.1, 0.15


@dataclass(frozen=True)
class CannotTell:
    """Effects that are the same force along a motion as something else.

    Attributes
    ----------
    effects : tuple of str
        What is found of one of these holds for the other force as well.
    same_as : str
        What their force is along this motion, in words.
    experiment : str
        What would tell, in words.
    """

    effects: tuple[str, ...]
    same_as: str
    experiment: str

    def json(self) -> dict[str, Any]:
        """As in diagnosis.json."""
        return {**asdict(self), "effects": list(self.effects)}


_SECOND = "a record at a second frequency"
# with a = -w^2 x a spring is an inertance of -k / w^2, and b tau a' is a damper of -b tau w^2
ONE_SINE = (
    CannotTell(
        ("parallel_stiffness", "series_elasticity"), "an inertance of another size", _SECOND
    ),
    CannotTell(("sensor_delay",), "viscous friction", _SECOND),
    CannotTell(("viscoelasticity",), "an inertance of another size and viscous friction", _SECOND),
)
IN_WORDS = (
    "The motion is nearly one sine. Along it a parallel stiffness and a series elasticity are an "
    "inertance of another size, a delay is viscous friction, and a spring that relaxes is both: "
    "what is said of one of them holds for all together, and a record at a second frequency tells "
    "them apart. "
)
"""The same of one sine, as a verdict says it."""
_DRIFTS = ("viscous_drift", "friction_drift", "force_drift")
FEW = CannotTell(
    (*_DRIFTS, "zero_settling"),
    "damping, friction and a force that change along the stroke",
    "strokes there and back, several of them",
)
FEW_IN_WORDS = (
    "There are few strokes. What changes with the time changes with the place along them, and no "
    "drift of damping, friction or force was looked for: several strokes there and back would "
    "tell. "
)
SWEEP = CannotTell(
    _DRIFTS,
    "damping and friction that change with the frequency",
    "the same sweep in the other direction, or one frequency for as long",
)
SWEEP_IN_WORDS = (
    "The frequency goes one way with the time. What changes with the time changes with the "
    "frequency along such a sweep: one in the other direction would tell. "
)


ONE_WAY = CannotTell(
    (
        "coulomb_friction", "force_offset", "asymmetric_friction", "asymmetric_damping",
        "hysteretic_friction", "friction_play",
    ),
    "dry friction, and where the acceleration hardly changes an inertance of another size",
    "strokes there and back",
)  # fmt: skip
RUN_UP = CannotTell(
    (
        "viscous_friction", "force_drift", "friction_drift", "viscous_drift", "backlash",
        "series_elasticity", "grip_mass", "viscoelasticity", "rate_state_friction",
        "sensor_delay", "sensor_filter", "sensor_coupling", "zero_settling",
    ),
    "damping and an inertance of another size",
    "a speed that rises and falls, quickly and slowly",
)  # fmt: skip
"""Of a speed that only rises or only falls: with it everything does that goes with time."""
ONE_WAY_IN_WORDS = (
    "The motion never turns back. Along it dry friction is a constant force and, where the "
    "acceleration hardly changes, either is an inertance of another size: strokes there and back "
    "would tell. "
)
RUN_UP_IN_WORDS = (
    "The speed only rises or only falls. What goes with the time, lags or gives goes with the "
    "speed then, and was not looked for; damping, friction and inertance may be shared out "
    "otherwise: a speed that rises and falls, quickly and slowly, would tell. "
)
# strokes of a sweep at least, how surely their lengths go one way (rank correlation), and by what
# factor
_OF_A_SWEEP, _ORDERED, _WIDE = 8, 0.95, 1.5
# share of the range of a speed by which it goes back where it only rises
_BACK = 0.05
# values that a force has which is switched, at most
_VALUES = 8


def goes_one_way(runs: Iterable[BenchRun]) -> bool:
    """Whether the device moves in the same direction in all of some runs."""
    speeds = [run.velocity[run.inner] for run in runs]
    v = np.concatenate(speeds) if speeds else np.empty(0)
    slow = _MOVING * np.max(np.abs(v), initial=0.0)
    return bool(v.size and (v.min() >= -slow or v.max() <= slow))


def runs_up(runs: Sequence[BenchRun]) -> bool:
    """Whether the speed only rises, or only falls, in every run, in the same direction."""

    def only_rises(speed: NDArray[np.float64]) -> bool:
        back = np.maximum.accumulate(speed) - speed
        return bool(back.max() < _BACK * np.ptp(speed))

    speeds = [np.abs(run.velocity[run.inner]) for run in runs if run.inner.any()]
    monotone = all(only_rises(speed) or only_rises(-speed) for speed in speeds)
    return bool(speeds) and monotone and goes_one_way(runs)


def sweeps(runs: Sequence[BenchRun]) -> bool:
    """Whether the strokes of every run grow ever shorter, or in every run ever longer."""
    ways = [_way_of_strokes(run) for run in runs]
    return bool(ways) and ways[0] != 0 and all(way == ways[0] for way in ways)


def _way_of_strokes(run: BenchRun) -> int:
    """1 where the strokes of a run grow longer with the time, -1 shorter, 0 neither."""
    v = run.velocity[run.inner]
    moving = np.flatnonzero(np.abs(v) > _MOVING * np.max(np.abs(v), initial=0.0))
    turns = moving[1:][np.diff(np.sign(v[moving])) != 0]
    lengths = np.diff(turns)
    if lengths.size < _OF_A_SWEEP:
        return 0
    count = lengths.size // 4
    first, last = float(np.median(lengths[:count])), float(np.median(lengths[-count:]))
    if max(first, last) < _WIDE * min(first, last):
        return 0
    ranks = np.argsort(np.argsort(lengths, kind="stable"))
    order = float(np.corrcoef(np.arange(lengths.size), ranks)[0, 1])
    return int(np.sign(order)) if abs(order) > _ORDERED else 0


def hidden_by(runs: Sequence[BenchRun]) -> frozenset[str]:
    """Effects that are not looked for along some runs, for others do the same there.

    Of dry friction and a constant force the one that real devices have is.
    """
    hidden = {*ONE_WAY.effects} - {"coulomb_friction"} if goes_one_way(runs) else set()
    hidden |= {*RUN_UP.effects} - {"viscous_friction"} if runs_up(runs) else set()
    return frozenset(hidden)


def hidden_by_force(records: Sequence[Record]) -> frozenset[str]:
    """Effects that are not looked for: a channel that clips, where the force was commanded.

    A force that has a few values alone was switched between them, and nobody measured it.
    """
    commanded = all(np.unique(record.force).size <= _VALUES for record in records)
    return frozenset({"sensor_saturation"}) if commanded else frozenset()


def strokes_of(runs: Iterable[BenchRun]) -> int:
    """In how many strokes some runs go: one each, and one more where they turn back.

    And for each turn about an axis, after which a device is where it was.
    """
    count = 0
    for run in runs:
        v = run.velocity[run.inner]
        moving = v[np.abs(v) > _MOVING * np.max(np.abs(v), initial=0.0)]
        count += 1 + int(np.count_nonzero(np.diff(np.sign(moving))))
        if run.motion == ROTATION:
            count += int(np.ptp(run.displacement[run.inner]) / TURN) if run.inner.any() else 0
    return count


def is_hidden(
    effects: Set[str], model: Model, sizes: Scales, strokes: int, also: Iterable[str] = ()
) -> bool:
    """Whether a motion hides one of a model's effects, or has another one do the same.

    Along one sine a shaft is an inertance of another size, and a low-pass with a delay is as late
    as the one that it takes back; one that turns the only frequency by much makes a damper of an
    inertance. Along few strokes what changes with the time changes with the
    place. Two stops with no room between them are a spring. A mass before a device that neither
    gives nor has play is inertance. What is hidden `also` is hidden whatever the model.
    """
    if not effects.isdisjoint(also):
        return True
    if "grip_mass" in effects and (sizes.one_tone or not model.has_series):
        return True
    if sizes.one_tone:
        shaft = "series_elasticity" in effects and "inertance" in model.free
        found = filters_of(model.values).values() if "sensor_filter" in effects else ()
        turned = any(
            each.cutoff < sizes.frequency or each.lateness * sizes.frequency > _TURNED
            for each in found
        )
        if shaft or turned or {"sensor_filter", "sensor_delay"} <= effects:
            return True
    if strokes < FEW_STROKES and not effects.isdisjoint(FEW.effects):
        return True
    if {"stop_lower", "stop_upper"} <= set(model.free):
        room = model.values["stop_upper"] - model.values["stop_lower"]
        return room < _ROOM * (sizes.travel[1] - sizes.travel[0])
    return False


def of_a_tone(frequency: float) -> CannotTell:
    """Of a tone in the force [Hz] above the band in which the motion is told from noise."""
    return CannotTell(
        ("periodic_disturbance",),
        f"a ringing of the drive at {frequency:.3g} Hz that the displacement does not show",
        "a record of the force while nothing is driven, or a displacement with less noise",
    )
