"""At how many instants per sample a force is followed: more where its jumps were smoothed first.

A converter without a low-pass samples a jump of friction as it is: it lies between two samples, and
the force followed at the same instants jumps between the same two. Behind a low-pass it is spread
over some, and tells when it was: then it has to be followed more often than the record was sampled.
At a thousand samples per second there is little between the two; at a hundred, much.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from inerter.identify.fit import Problem
from inerter.identify.model import Model
from inerter.identify.runs import thin
from inerter.records import Record
from inerter.records.motion import Motion
from inerter.records.preparation import Preparation

# instants per period of the motion's cut-off, and per sample at most
_PER_PERIOD, _MOST = 32, 8
# share of the error that they have to take away
_GAIN = 0.01
# the level of friction, and the speed within which it turns, that a fit begins with: shares of the
# rms force and of the rms velocity
_LEVEL, _WITHIN = 0.3, 0.01


def with_instants(
    records: Sequence[Record],
    motions: Sequence[Motion],
    model: Model,
    learnt: Sequence[NDArray[np.bool_]],
) -> Sequence[Record]:
    """Records with as many instants as tell more of what jumps in the samples of `learnt`."""
    most = min(_MOST, max(round(_PER_PERIOD * m.cutoff * m.spacing) for m in motions))
    if most < 2:
        return records
    plain, fine = (_fit(motions, model, learnt, instants) for instants in (1, most))
    if fine > (1 - _GAIN) * plain:
        return records
    return [replace(record, instants=most) for record in records]


def at_instants(records: Sequence[Record], smoothed: Preparation) -> Preparation:
    """Smoothed records with the instants of others that are the same else."""
    pairs = zip(smoothed.motions, records, strict=True)
    return replace(smoothed, motions=[replace(m, instants=r.instants) for m, r in pairs])


def _fit(
    motions: Sequence[Motion], model: Model, learnt: Sequence[NDArray[np.bool_]], instants: int
) -> float:
    """Rms error of a model with a level of friction, a damper and a delay more [N]."""
    runs = [thin(replace(motion, instants=instants)) for motion in motions]
    masks = [run.inner & mask[:: run.thinned] for run, mask in zip(runs, learnt, strict=True)]
    problem = Problem(runs, masks)
    sizes, law = problem.scales, model.friction
    level = {"coulomb_force": _LEVEL * sizes.force, "transition_velocity": _WITHIN * sizes.velocity}
    more = {"viscous": 0.0, "delay": 0.0, **(level if law == "none" else {}), **model.values}
    new = {name: more[name] for name in ("viscous", "delay", *level) if name in more}
    fit = problem.fit(model.adding("coulomb" if law == "none" else law, **new))
    return fit.rmse(problem.masks)
