"""What a model leaves: is it noise, and if not, what does it go with?

Tests without a model (see the package `remainder`) look for structure in the residual. Each learns
on one part of the data and is judged on another, by the share of the residual's power that it
predicts, and by the probability of doing so by chance. They are controlled together: with nothing
but noise left, one of them raises a false alarm in `FALSE_ALARM` of the diagnoses at most
(Bonferroni). What is real may still be too small to matter; it counts where its rms is more than
`NOISE_PART` of the noise and `FORCE_PART` of the force.

A formula may be proposed for it (`remainder/proposal.py`).
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from inerter import motion_units
from inerter.diagnose.remainder.battery import (
    Remainder,
    Tested,
    battery,
    columns_of,
    in_order,
)
from inerter.diagnose.remainder.bursts import Bursts, bursts
from inerter.diagnose.remainder.columns import sizes_of
from inerter.diagnose.remainder.further import measured_by, test_of
from inerter.diagnose.remainder.learning import LearntPart, gather
from inerter.diagnose.remainder.lines import lines
from inerter.diagnose.remainder.proposal import propose
from inerter.diagnose.remainder.words import MORE, OF_MOTION, summary
from inerter.diagnose.result import Unexplained
from inerter.diagnose.statistics import blow
from inerter.identify.runs import BenchRun, on_clocks
from inerter.identify.split import Split
from inerter.records.motion import lowpass

Array = NDArray[np.float64]

FALSE_ALARM = 2e-3
# least size of structure, per noise and per force. What smoothing makes of a law that is not linear
# is certain, too: among 121 right models at 0.5 to 5 % noise up to a tenth of the noise, or 0.28 %
# of the force
NOISE_PART = 0.15
FORCE_PART = 4e-3
# bursts are judged at the full rate, where corners of the motion that the smoothing rounds off are
# left in the residual, at reversals too: up to 0.8 of the noise, or 1.6 % of the force
BURST_NOISE_PART = 1.25
BURST_FORCE_PART = 0.03
# share of the residual's power that the first dependence, and each further one, has to predict
FIRST_SHARE = 0.05
FURTHER_SHARE = 0.1
# share of what remains above the band that tones have to predict there, and samples of a run that
# they are looked for in
TONE_SHARE, MOST_SAMPLES = 0.2, 60_000
# of the best test's share, what a plainer one must reach to be named instead
PLAIN_ENOUGH = 0.85
MOST = 3
# of what time tells, what a further channel must tell to be named beside it
OF_TIME = 0.5
# more than this many times the noise, and this share of the force, is no noise whatever it is
EXCESS = 2.0
EXCESS_PART = 0.05
# share of what remains up to which its part in the band is so small that the rest is told of
BELOW = 0.7


def unexplained(
    runs: Sequence[BenchRun],
    split: Split,
    residual: Sequence[Array],
    floor: float,
    raw: float,
    whole: Sequence[BenchRun] = (),
    whole_residual: Sequence[Array] = (),
    motion: float = 0.0,
    channels: Mapping[str, Sequence[Array]] | None = None,
) -> Unexplained:
    """Describe the residual of a model.

    Parameters
    ----------
    runs : sequence of BenchRun
        What was fitted.
    split : Split
        The parts of it.
    residual : list of ndarray (n_i,)
        Measured minus predicted force in the fits' band [N].
    floor, raw : float
        Noise floor of the force channel and rms residual on held-out data at full band [N].
    whole, whole_residual
        The runs at the records' own rate and what remains there [N], for what lies above the
        fits' band; left out, nothing is looked for there.
    motion : float
        Part of the floor that the noise of the motion makes [N]. The motion itself tells something
        of it (along a sine the displacement tells the acceleration), which is no lack of the model.
    channels : mapping
        Further channels of the records by name, at the samples of `runs`.
    """
    fraction = max(0.0, 1 - (floor / raw) ** 2) if raw > 0 else 0.0
    remainder = _remainder(runs, split, residual, channels or {})
    force = remainder.sizes.force
    least = max(NOISE_PART * floor, FORCE_PART * force)
    chosen, details, first, outcome = _depends(remainder, float(np.hypot(least, motion)))
    found = np.zeros(remainder.data.residual.size)
    held_out = remainder.data.fold == 0
    for _, prediction in chosen:
        found = found + prediction.values
    structure = _taken(remainder.data.residual[held_out], found[held_out])
    if structure < least / 2:
        # smoothing flattens some runs more than others; what counts shows on held-out data
        chosen, structure = [], 0.0
        found = np.zeros_like(found)
        details.clear()
    power = remainder.data.power
    # as in the table of the report: by each alone, of all data
    by_each = {name: max(first.tests[name].share, each.share) for name, each in chosen}
    shares = {name: float(np.clip(share, 0.0, 1.0)) for name, share in by_each.items()}
    if "time" in shares and (told := _as_time_does(first, shares["time"], remainder.channels)):
        details["time"] = told
    tests = _rows(first, power, by_each)
    predicted = structure

    # what oscillates without a phase, above the band too
    if len(whole):
        rest = _above(remainder, found, whole, whole_residual)
        louder = bursts(whole, rest, _held_at(whole, runs, split), remainder.sizes)
        tests.append(_row("bursts", louder.share, louder.share_held_out, louder.size, louder.p))
        if _loud(louder, floor, force, len(first.tests)):
            shares["bursts"] = float(np.clip(louder.share, 0.0, 1.0))
            details["bursts"] = _burst_words(louder)
            structure = float(np.hypot(structure, louder.size))
    depends = ["harmonics" if n == "frequency" and outcome.lines.multiple else n for n in shares]
    shares = dict(zip(depends, shares.values(), strict=True))
    if "harmonics" in depends and "frequency" in details:
        details["harmonics"] = details.pop("frequency")

    left = float(np.sqrt(power))
    # over all data, and on those that the figures are about
    large = min(left, raw) > max(EXCESS * floor, EXCESS_PART * force)
    excess = large and not depends
    no_noise = float(np.sqrt(power - floor**2)) if large else 0.0
    if excess:
        structure = no_noise
    proposal = None
    if chosen:
        lengths = {
            name: period.length
            for name, period in first.periods.items()
            if _real(period.prediction, len(first.tests)) and period.prediction.share > FIRST_SHARE
        }
        proposal = propose(remainder, lengths)
    significant = bool(depends) or excess
    above = _tone_above(remainder, whole, whole_residual) if raw > MORE * floor else None
    text = summary(
        depends,
        details,
        shares,
        raw,
        floor,
        min(structure, raw),
        excess,
        proposal["text"] if proposal else None,
        _usual(whole, whole_residual, split, runs, raw),
        runs[0].motion,
        above,
        (left, min(run.cutoff for run in runs)) if left < BELOW * raw else None,
        predicted,
        None if depends else _too_small(first, power, remainder.channels),
    )
    return Unexplained(
        significant=significant,
        fraction=fraction,
        depends_on=depends,
        summary=text,
        # of the fitted data's errors it may be more than the held-out ones are
        structure=min(max(structure, no_noise), raw) if significant else 0.0,
        tests=tests,
        false_alarm_rate=FALSE_ALARM,
        proposal=proposal,
        predicted=predicted,
        tone_above=above[0] if above and not depends and not excess else None,
    )


def _taken(residual: Array, predicted: Array) -> float:
    """Rms [N] of what a prediction takes away from a residual."""
    if not residual.size:
        return 0.0
    return float(np.sqrt(max(np.mean(residual**2 - (residual - predicted) ** 2), 0.0)))


def _remainder(
    runs: Sequence[BenchRun],
    split: Split,
    residual: Sequence[Array],
    channels: Mapping[str, Sequence[Array]],
) -> Remainder:
    masks = [run.inner for run in runs]
    data = gather(
        residual, masks, split.holdout, [run.spacing for run in runs], [run.cutoff for run in runs]
    )
    clock = [run.elapsed for run in on_clocks(runs)]
    return Remainder(runs, residual, data, sizes_of(runs), clock, channels)


def _depends(
    remainder: Remainder, least: float
) -> tuple[list[tuple[str, LearntPart]], dict[str, str], Tested, Tested]:
    """What the residual goes with, one after another, the plainest of nearly equal ones first.

    Returns names with predictions, details in words, and the outcome of the tests on the whole
    residual and of the last ones that found something.
    """
    columns = columns_of(remainder)
    power = remainder.data.power
    first = last = outcome = battery(remainder, columns)
    chosen: list[tuple[str, LearntPart]] = []
    details: dict[str, str] = {}
    motion = remainder.runs[0].motion
    small, newton = motion_units.words(motion, "mm"), motion_units.words(motion, "N")
    while len(chosen) < MOST:
        required = FURTHER_SHARE if chosen else FIRST_SHARE
        # of all data, and of those that the figures are about
        gains = {
            name: min(prediction.share, prediction.share_held_out) * remainder.data.power
            for name, prediction in outcome.tests.items()
            if _real(prediction, len(outcome.tests)) and name not in dict(chosen)
        }
        least_gain = max(required * power, least**2)
        gains = {name: gain for name, gain in gains.items() if gain > least_gain}
        if not gains:
            break
        enough = PLAIN_ENOUGH * max(gains.values())
        order = in_order(remainder.channels)
        name = next(name for name in order if gains.get(name, 0.0) >= enough)
        prediction = outcome.tests[name]
        chosen.append(
            (
                name,
                LearntPart(
                    prediction.values, gains[name] / power, prediction.share_held_out, prediction.p
                ),
            )
        )
        if name in map(test_of, remainder.channels):
            details[name] = measured_by(name)
        if name in outcome.periods:
            details[name] = f"with a period of {1e3 * outcome.periods[name].length:.3g} {small}"
        if name == "frequency":
            line, last = outcome.lines, outcome
            details[name] = (
                f"{line.frequency:.3g} Hz with an amplitude of {line.amplitude:.2g} {newton}"
                f"{OF_MOTION if line.of_motion else ''}"
            )
        remainder = remainder.without(prediction.values)
        if remainder.data.power < FURTHER_SHARE * power:
            break
        outcome = battery(remainder, columns)
    return chosen, details, first, last


def _real(prediction: LearntPart, tests: int) -> bool:
    # one more test than these: that of bursts
    return prediction.share > 0 and prediction.p < FALSE_ALARM / (tests + 1)


def _row(name: str, share: float, held_out: float, size: float, p: float) -> dict[str, float | str]:
    return {
        "goes_with": name,
        "share": float(max(share, 0.0)),
        "share_held_out": float(max(held_out, 0.0)),
        "rms": float(size),
        "p": float(p),
    }


def _rows(outcome: Tested, power: float, told: Mapping[str, float]) -> list[dict[str, float | str]]:
    """Of each test; `told`: shares of what was found, beside what was found before."""
    rows = []
    for name, p in outcome.tests.items():
        share = told.get(name, p.share)
        size = float(np.sqrt(max(share, 0.0) * power))
        rows.append(_row(name, share, p.share_held_out, size, p.p))
    return sorted(rows, key=lambda row: -float(row["share"]))


def _as_time_does(outcome: Tested, share: float, channels: Collection[str]) -> str:
    """The channel that tells much of what time tells, of which `share`; empty without one."""
    shares = {
        name: outcome.tests[name].share
        for name in map(test_of, channels)
        if name in outcome.tests and _real(outcome.tests[name], len(outcome.tests))
    }
    name = max(shares, key=lambda each: shares[each], default="")
    if not name or shares[name] < OF_TIME * share:
        return ""
    return f"and {name} tells {100 * shares[name]:.0f} % too, {measured_by(name)}"


def _too_small(
    outcome: Tested, power: float, channels: Collection[str]
) -> tuple[str, float] | None:
    """The test that predicts most for sure, though too little to count, and how much, rms [N]."""
    sure = {
        name: p.share
        for name, p in outcome.tests.items()
        if _real(p, len(outcome.tests)) and min(p.share, p.share_held_out) > FIRST_SHARE
    }
    if not sure:
        return None
    enough = PLAIN_ENOUGH * max(sure.values())
    name = next(name for name in in_order(channels) if sure.get(name, 0.0) >= enough)
    return name, float(np.sqrt(sure[name] * power))


def _above(
    remainder: Remainder, found: Array, whole: Sequence[BenchRun], residual: Sequence[Array]
) -> list[Array]:
    """The residual at the full rate without what was found in the band."""
    rest, begin = [], 0
    for run, thin, r, mask in zip(
        whole, remainder.runs, residual, remainder.data.chosen, strict=True
    ):
        count = int(mask.sum())
        inside = np.interp(run.time, thin.time[mask], found[begin : begin + count])
        rest.append(r - inside)
        begin += count
    return rest


def _held_at(
    whole: Sequence[BenchRun], runs: Sequence[BenchRun], split: Split
) -> list[NDArray[np.bool_]]:
    """Held-out samples at the full rate."""
    return [
        np.interp(run.time, thin.time, out.astype(float)) > 0.5
        for run, thin, out in zip(whole, runs, split.holdout, strict=True)
    ]


def _tone_above(
    remainder: Remainder, whole: Sequence[BenchRun], residual: Sequence[Array]
) -> tuple[float, float, float] | None:
    """Frequency [Hz] and rms [N] of tones above the fits' band, and the end of that [Hz]."""
    end = max((run.cutoff for run in remainder.runs), default=np.inf)
    if not len(whole) or not np.isfinite(end):
        return None
    high, model, masks = [], [], []
    for run, r in zip(whole, residual, strict=True):
        high.append((r - lowpass(r, run.spacing, end))[:MOST_SAMPLES])
        model.append((run.force - r)[:MOST_SAMPLES])
        masks.append(run.inner[:MOST_SAMPLES])
    found = lines(high, model, [run.spacing for run in whole], masks)
    power, values = (
        np.concatenate([each[m] for each, m in zip(channels, masks, strict=True)])
        for channels in (high, found.values)
    )
    if found.p > FALSE_ALARM or found.frequency < end or found.share < TONE_SHARE:
        return None
    return found.frequency, _taken(power, values), end


def _usual(
    whole: Sequence[BenchRun],
    residual: Sequence[Array],
    split: Split,
    runs: Sequence[BenchRun],
    raw: float,
) -> float | None:
    """Median size of the error [N] on held-out data, where few large ones make the rms."""
    if not len(whole):
        return None
    held = _held_at(whole, runs, split)
    parts = [np.abs(r[m & run.inner]) for r, m, run in zip(residual, held, whole, strict=True)]
    sizes = np.concatenate(parts)
    return float(np.median(sizes)) if raw > blow(sizes) else None


def _loud(louder: Bursts, floor: float, force: float, tests: int) -> bool:
    return (
        louder.share > FURTHER_SHARE
        and louder.p < FALSE_ALARM / (tests + 1)
        and louder.size > max(BURST_NOISE_PART * floor, BURST_FORCE_PART * force)
    )


def _burst_words(louder: Bursts) -> str:
    when = "after reversals, " if louder.after_reversals else ""
    return f"{when}around {louder.frequency:.2g} Hz"
