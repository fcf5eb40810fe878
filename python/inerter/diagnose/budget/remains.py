"""What remains, with what could be predicted of it."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from inerter.diagnose.budget.ceiling import Ceiling, ceiling
from inerter.diagnose.data import Data
from inerter.diagnose.remainder.words import no_noise
from inerter.diagnose.result import Unexplained
from inerter.diagnose.statistics import taken_away
from inerter.identify.fit import rms
from inerter.motion_units import Kind, words

Array = NDArray[np.float64]

_LOOKS_AT = {
    "motion": "the motion",
    "place": "the place along the stroke",
    "memory": "what went before",
}
# share by which two errors differ by rounding alone
_SAME = 1e-3


def with_ceiling(
    data: Data,
    errors: Sequence[Array],
    noise: float,
    found: Unexplained,
    motion: float = 0.0,
    rmse: float | None = None,
) -> Unexplained:
    """What remains, with the error that the best predictor leaves.

    Parameters
    ----------
    data
        The runs, and how they are divided.
    errors
        Measured minus predicted force of every run at the measured rate (n_i,) [N].
    noise
        Of force and motion, rms [N].
    found
        What the tests say of the remainder; what they predict counts as a predictor, too.
    motion
        Part of the noise that the motion brings [N].
    rmse
        Error on everything that is held out, where `data` are a part of it [N].
    """
    best = ceiling(data.whole, data.full, errors, data.preparation.cutoff, noise, motion)
    own = rms(errors, data.raw.masks)
    if rmse is not None and own > 0:
        best = replace(best, rmse=best.rmse * rmse / own, takes=best.takes * rmse / own)
        own = rmse
    by_tests = taken_away(own, found.predicted)
    told = replace(found, ceiling={"rmse": min(best.rmse, by_tests)})
    if best.rmse < (1 - _SAME) * by_tests:
        # what else is predicted leaves less than the tests alone do
        told = replace(told, summary=re.sub(r", which leaves [^ ]+ N( m)?", "", told.summary))
    if not best.takes or found.depends_on:
        return told
    return replace(
        told,
        significant=True,
        structure=max(found.structure, best.takes),
        summary=(
            f"{_start(found.summary)} {no_noise(own, noise)}: "
            f"{_predicted(best, data.whole[0].motion)}"
        ),
    )


def _start(summary: str) -> str:
    """Such as "What remains (2 N rms; noise of force and motion 1 N)"."""
    return summary[: summary.index(")") + 1]


def _predicted(best: Ceiling, motion: Kind) -> str:
    looked = [_LOOKS_AT[name] for name in best.looks_at if name in _LOOKS_AT]
    together = " and ".join(filter(None, [", ".join(looked[:-1]), looked[-1]]))
    return (
        f"{best.takes:.3g} {words(motion, 'N')} rms can be predicted from the other data by "
        f"{together}, taken together, though by none of the quantities that were tested alone. "
        "No effect that is known here explains it."
    )
