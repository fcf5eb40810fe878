"""The force of a device in parts that know nothing of each other.

    smooth     what is smooth in the motion: at the rate of a thinned run
    friction   the friction law between the terminals: at the measured rate, through the low-pass
    abrupt     stops, free play and what changes along the stroke: likewise

A fit moves one coordinate after another, and most act on one part alone: the others are kept. What
hangs together, friction at the flywheel or raised by a load, a channel that clips, is no sum.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Hashable

import numpy as np
from numpy.typing import NDArray

from inerter.identify.channel import clips
from inerter.identify.kept import Kept
from inerter.identify.model import Model, Part
from inerter.identify.runs import BenchRun

Array = NDArray[np.float64]
State = float | Array

# forces of runs [bytes] that are kept in a process: those of some points of a fit
_KEPT: Kept[np.float64] = Kept(2**24)
# friction beyond this [N] is that of a state that has run away
RUNAWAY = 1e30


def is_sum(model: Model) -> bool:
    """Whether a model's force is the sum of its parts."""
    device = model.device()
    return not (
        device.has_load_friction or device.friction_side != "terminals" or clips(model.values)
    )


def smooth_force(model: Model, run: BenchRun, state: State) -> Array:
    """Force of the smooth part along a run [N], shape (n,); `state` is that of the whole."""
    part, rest = model.smooth_part, states_of(model.smooth_part, model, state)

    def force() -> Array:
        return run.thinned_force(part.device, rest)

    return _found(run, ("smooth", part.stated, _key(rest)), force)


def sharp_force(model: Model, run: BenchRun, state: State, drift: float) -> Array:
    """Force of the other parts in a run's band [N], shape (n,), not finite if it has run away.

    `drift` [1/s] is that of the friction level.
    """
    total = np.zeros(run.force.size)
    if model.friction != "none":
        law, bent = model.friction_part, states_of(model.friction_part, model, state)

        def friction() -> Array:
            return run.force_at_measured_rate(law.device, bent, "friction")

        total = total + _in_band(run, ("friction", law.stated, _key(bent)), friction)
        if drift:
            total = total + drift * run.elapsed * total
    if model.has_jumps:
        for part, smooth in model.abrupt_parts:
            total = total + _abrupt(part, smooth, model, run, state)
    return total


def _abrupt(part: Part, smooth: Part, model: Model, run: BenchRun, state: State) -> Array:
    """What a part adds to what of it is smooth."""
    before, less = (states_of(each, model, state) for each in (part, smooth))

    def difference() -> Array:
        whole = run.force_at_measured_rate(part.device, before, "total")
        if not smooth.stated:
            return whole
        return whole - run.force_at_measured_rate(smooth.device, less, "total")

    return _in_band(run, ("difference", part.stated, smooth.stated, _key(before)), difference)


def _in_band(run: BenchRun, key: tuple[Hashable, ...], fine: Callable[[], Array]) -> Array:
    """A force at the measured rate in the run's band, shape (n,)."""

    def shown() -> Array:
        force = fine()
        if not abs(force[-1]) < RUNAWAY:
            return np.full(run.force.size, np.inf)
        return run.in_band(force)

    return _found(run, key, shown)


def states_of(part: Part, model: Model, state: State) -> State:
    """Those states of a model's device that a part of it has too."""
    of_all, of_part = model.device().state_names, part.device.state_names
    if not of_all or not of_part:
        return 0.0
    return np.atleast_1d(state)[_kept(of_all, of_part)]


@functools.lru_cache(maxsize=64)
def _kept(of_all: tuple[str, ...], of_part: tuple[str, ...]) -> NDArray[np.intp]:
    return np.array([i for i, name in enumerate(of_all) if name in of_part], dtype=np.intp)


def _found(run: BenchRun, key: tuple[Hashable, ...], work_out: Callable[[], Array]) -> Array:
    return _KEPT.found((run.identity, *key), work_out)


def _key(state: State) -> bytes:
    return np.asarray(state, dtype=np.float64).tobytes()
