"""Rests between motions in which friction does what no motion tells.

A servo that settles creeps for a while, to and fro, slower than noise lets anybody see. There dry
friction has its whole level, in a direction that is not told: where a model with friction misses
such rests by far more than what moves, they are left out, and the search is done once more.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from inerter.catalogue.scales import Scales
from inerter.diagnose.decision import CRITERIA
from inerter.diagnose.stages import Confirmed
from inerter.diagnose.start import Given
from inerter.identify.fit import Problem, rms
from inerter.identify.model import Model
from inerter.identify.runs import BenchRun, thin
from inerter.motion_units import words
from inerter.records.rests import LEAKS, long_stretches

Masks = list[NDArray[np.bool_]]

SLOW = 12.0
"""Noises of the velocity below which its direction is not told."""
SHARE = 0.02
"""Of the samples that rest so, at least."""
WORSE = 2.5
"""Times what moves is missed by, fitted alone, that any plain model misses them by."""
GAIN = 0.1
"""Share of the error of what moves that leaving them out takes away, at least."""
# distance of a bristle where a fit begins, per travel
_BEGIN = (1e-4, 1e-2)
# of such a fit
_EVALUATIONS = 25


def without_creeping(
    given: Given, stands: Confirmed, stood: Callable[[Given], Confirmed]
) -> tuple[Given, Confirmed]:
    """What stands without rests that friction makes a riddle of, where there are such."""
    whole, errors = stands.data.whole, stands.data.raw.errors(stands.fit.model)
    left = rms(errors, [run.inner for run in whole])
    noise = stands.judge.noise_left(stands.fit.model)
    # where hardly more than noise is left nothing is a riddle, however plain models fare
    if given.time.is_over() or left < CRITERIA.near_noise * noise or not _is_riddle(stands):
        return given, stands
    rests = _rests(stands, whole)
    moving = [run.inner & ~rest for run, rest in zip(whole, rests, strict=True)]
    before = rms(errors, moving)
    given.progress("rests in which friction may have either sign: searching without them")
    speeds = _speeds(stands)
    records = [replace(each, slowest=speeds.get(each.name, 0.0)) for each in given.records]
    told = " ".join([*filter(None, [given.left_out]), _in_words(stands, rests)])
    bare = replace(given, records=records, left_out=told)
    again = stood(bare)
    after = rms(again.data.raw.errors(again.fit.model), [run.inner for run in again.data.whole])
    return (bare, again) if after < (1.0 - GAIN) * before else (given, stands)


def _is_riddle(stands: Confirmed) -> bool:
    """Whether plain models with friction say what moves, and none of them what rests."""
    runs = [thin(motion) for motion in stands.data.preparation.motions]
    rests = _rests(stands, runs)
    moving = [run.inner & ~rest for run, rest in zip(runs, rests, strict=True)]
    resting, counted = (sum(int(mask.sum()) for mask in masks) for masks in (rests, moving))
    if not counted or resting < SHARE * (resting + counted):
        return False
    everything = Problem(runs, [run.inner for run in runs])
    still = everything.with_masks(moving)
    least, missed = np.inf, np.inf
    for model in _plain_models(everything.scales):
        least = min(least, still.fit(model, _EVALUATIONS).rmse(moving))
        missed = min(missed, everything.fit(model, _EVALUATIONS).rmse(rests))
        if missed <= WORSE * least:
            # what comes may only say more of the rests
            return False
    return True


def _plain_models(sizes: Scales) -> list[Model]:
    """Inertance, spring, damper, a constant force, and friction without and with memory."""
    values = {
        "inertance": sizes.force / sizes.acceleration, "viscous": 0.0, "stiffness": 0.0,
        "force_offset": 0.0, "coulomb_force": 0.3 * sizes.force,
    }  # fmt: skip
    width = {"transition_velocity": 2e-3 * sizes.velocity}
    peak = {"static_excess": 0.1 * sizes.force, "stribeck_velocity": 0.2 * sizes.velocity}
    found = [
        Model("coulomb", values | width, tuple(values | width)),
        Model("stribeck", values | peak | width, tuple(values | peak | width)),
    ]
    branch = {
        "branch_stiffness_1": 0.1 * sizes.force / sizes.displacement,
        "branch_time_1": 1.0 / sizes.frequency,
    }
    for share in _BEGIN:
        bristle = values | {"presliding": share * sizes.displacement}
        found.append(Model("dahl", bristle | width, tuple(bristle)))
        found.append(Model("dahl", bristle | branch | width, tuple(bristle | branch)))
    return found


def _speeds(stands: Confirmed) -> dict[str, float]:
    """The speed below which the direction of each run is not told [m/s]."""
    return {m.name: SLOW * m.velocity_noise for m in stands.data.preparation.motions}


def _rests(stands: Confirmed, runs: Sequence[BenchRun]) -> Masks:
    """Of every run the samples that count and are in such rests."""
    speeds, cutoff = _speeds(stands), stands.data.preparation.cutoff
    found = []
    for run in runs:
        slow = np.abs(run.velocity) < speeds.get(run.name, 0.0)
        found.append(run.inner & long_stretches(slow, run.spacing, cutoff, LEAKS))
    return found


def _in_words(stands: Confirmed, rests: Masks) -> str:
    """A sentence on what was left out."""
    speeds, motion = _speeds(stands), stands.data.whole[0].motion
    unit = words(motion, "m/s")
    each = [
        f"{run.name} (about {float(np.mean(rest)):.0%}, slower than {speeds[run.name]:.2g} {unit})"
        for run, rest in zip(stands.data.whole, rests, strict=True)
        if rest.any()
    ]
    return (
        "Where the device hardly moves its direction is not told from noise, and dry friction may "
        f"have either sign: such rests were left out of {', '.join(each)}."
    )
