"""A run whose force has another scale or sign than that of the others: range, calibration, wires.

Whatever acts in a device, a wrong scale multiplies all of it in one run alike, and leaves the other
runs as they are. It shows in what was found for all of them, which may have causes that are none
to make up for it: without it all is found anew, and it stands where that is met better.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from inerter.identify.runs import BenchRun
from inerter.measured_text import measured
from inerter.motion_units import TRANSLATION, Kind, force_word
from inerter.records import Record

Array = NDArray[np.float64]
RunScales = Mapping[str, tuple[float, float]]

# a scale is tried from so many standard errors on, this deviation, so many times the spread of the
# others, and where it takes this share of what is missed of the run beyond the noise
SURE, LEAST, TIMES, SHARE = 5.0, 0.003, 4.0, 0.1
# the warning of a force that pushes where an inerter pulls
SIGN = "sign_flip"
# the share of a scale that each part of the force has to have, and the least part, per the larger
# one, that tells one
ALIKE, PART = 0.4, 0.1
# stretches of a run that count as independent; runs that it takes to tell which is the odd one
STRETCHES, RUNS = 12, 3
# it stands where all runs are met so much better without it
BETTER = 0.85


def odd_scale(
    runs: Sequence[BenchRun], errors: Sequence[Array], noise: float, inertance: float
) -> RunScales:
    """Scale of a run's force over that of the others, and its standard error; at most one run.

    errors: measured minus predicted force of every run (n,) [N]; noise: rms [N]; inertance: of the
    model [kg]. Its force and all others have to have that scale: where one part alone differs, it
    is another inertance, or other friction.
    """
    if len(runs) < RUNS or any(run.part or run.inner.sum() < 10 * STRETCHES for run in runs):
        return {}
    found = [_scale(run, error) for run, error in zip(runs, errors, strict=True)]
    scales, stderrs = np.array(found).T
    odd = int(np.argmax(abs(scales - np.median(scales))))
    others = np.delete(scales, odd)
    about, spread = float(np.mean(others)), float(np.std(others, ddof=1))
    apart = scales[odd] - about
    if not (about > 0 and abs(apart) > max(SURE * stderrs[odd], LEAST, TIMES * spread)):
        return {}
    run, missed = runs[odd], errors[odd]
    left = missed - apart * (run.force - missed)
    before, after = (float(np.var(e[run.inner])) - noise**2 for e in (missed, left))
    if not after < (1.0 - SHARE) * before:
        return {}
    parts = (_of_parts(run, missed, inertance) - about) / apart
    if not np.all(parts > ALIKE):
        return {}
    return {run.name: (float(scales[odd] / about), float(np.hypot(stderrs[odd], spread)) / about)}


def without_scale(records: Sequence[Record], scales: RunScales) -> list[Record]:
    """Records with the force of a run divided by its scale."""
    return [
        replace(r, force=r.force / scales[r.name][0]) if r.name in scales else r for r in records
    ]


def turned_round(records: Sequence[Record]) -> tuple[list[Record], RunScales]:
    """Records with the force of some turned round that alone have the wrong sign, and their scales.

    Those of fewer than half of the runs: of more, what they are called has the wrong sign.
    """
    wrong = {r.name for r in records if any(w.code == SIGN for w in r.warnings)}
    if not wrong or 2 * len(wrong) >= len(records):
        return list(records), {}
    turned = [
        replace(r, force=-r.force, warnings=tuple(w for w in r.warnings if w.code != SIGN))
        if r.name in wrong
        else r
        for r in records
    ]
    return turned, dict.fromkeys(sorted(wrong), (-1.0, 0.0))


def together(known: RunScales, more: RunScales) -> RunScales:
    """Scales of runs from which some were taken before."""
    before = {name: value for name, (value, _) in known.items()}
    return dict(known) | {n: (v * before.get(n, 1.0), e) for n, (v, e) in more.items()}


def is_met_better(before: float, after: float, known: RunScales) -> bool:
    """Whether errors of all runs [N] say that a scale is one; it may be refined by little."""
    refined = any(error > 0 for _, error in known.values())
    return after < (1.0 if refined else BETTER) * before


def scales_in_words(scales: RunScales, motion: Kind = TRANSLATION) -> str:
    """A sentence about the run with another scale; empty where there is none."""
    force, told = force_word(motion), []
    for name, (value, error) in scales.items():
        if value < 0:
            told.append(
                f"The {force} of {name} has the other sign than that of the other runs, or its "
                "displacement has, and was turned round."
            )
        if error > 0:
            told.append(
                f"The {force} of {name} is {measured(abs(value), error)} times what the other runs "
                "tell, the inertance's part and the rest alike: another range or calibration. It "
                "was divided by that."
            )
    return " ".join(told)


def _of_parts(run: BenchRun, error: Array, inertance: float) -> Array:
    """Measured over predicted, of the inertance's force and of all others; 0 of too small a one."""
    force = run.force[run.inner]
    carried = inertance * run.acceleration[run.inner]
    parts = np.column_stack([carried, force - error[run.inner] - carried])
    parts, force = parts - parts.mean(axis=0), force - force.mean()
    sizes = np.sqrt(np.mean(parts**2, axis=0))
    if sizes.min() < PART * sizes.max():
        return np.zeros(2)
    return np.asarray(np.linalg.lstsq(parts / sizes, force, rcond=1e-9)[0] / sizes)


def _scale(run: BenchRun, error: Array) -> tuple[float, float]:
    """Measured over predicted force of a run, with the standard error over its stretches."""
    force = run.force[run.inner]
    predicted = force - error[run.inner]
    predicted, force = predicted - predicted.mean(), force - force.mean()
    square = float(predicted @ predicted)
    if square <= 0:
        return 1.0, np.inf
    scale = float(predicted @ force) / square
    left = predicted * (force - scale * predicted)
    scores = [float(part.sum()) for part in np.array_split(left, STRETCHES)]
    return scale, float(np.sqrt(np.sum(np.square(scores)))) / square
