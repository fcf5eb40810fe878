"""The steps of a preparation, in their order, and what each did and found."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inerter.records.band_limited import PASS_BAND, resampled, shifted
from inerter.records.delay import Delay, force_delay, pooled
from inerter.records.denoise import Denoised, denoise
from inerter.records.motion import smooth, uniform_channels
from inerter.records.preparation import prepare
from inerter.records.prepare.checks import bench, over_time, refuse_cutoff
from inerter.records.prepare.options import Options
from inerter.records.quality import check_records
from inerter.records.record import AnyRecord, Record, RecordError, TimeRecord
from inerter.records.runs import MIN_SAMPLES

Array = NDArray[np.float64]

# a denoiser that takes less than this share of the noise did not work
LEAST = 0.3


@dataclass(frozen=True, kw_only=True)
class PreparedRecord:
    """A prepared record and how it came about.

    Attributes
    ----------
    source, record : TimeRecord
        As read, and as prepared; both with the warnings of `check_records`.
    spacing : float
        Interval [s] of the uniform clock that denoising worked on.
    before : dict of ndarray (n,)
        Channels on that clock, before they were denoised.
    denoised : dict of Denoised
        By the name of the channel.
    found : dict
        What was done and found, for JSON.
    """

    source: TimeRecord
    record: TimeRecord
    spacing: float
    before: dict[str, Array]
    denoised: dict[str, Denoised]
    found: dict[str, Any] = field(default_factory=dict)


def prepare_records(records: Sequence[AnyRecord], options: Options) -> list[PreparedRecord]:
    """Prepare records over time, each by itself but for the delay, which all share.

    Raises
    ------
    RecordError
        A table, a record that is no bench record where delay or derivatives are wanted, a gap too
        long to bridge, a channel that is not there, or a rate that leaves too few samples.
    """
    timed = [over_time(record) for record in records]
    if options.cutoff is not None:
        refuse_cutoff(timed, options.cutoff)
    cutoff, delays = None, None
    if options.derivatives or options.delay is not None:
        benches = [bench(record) for record in timed]
        if options.derivatives or options.delay == "auto":
            cutoff = options.cutoff or _cutoff(benches)
        delays = _delays(benches, options.delay, cutoff)
    found = [_prepare(record, options, cutoff, delays, i) for i, record in enumerate(timed)]
    checked = check_records([p.record for p in found])
    return [dataclasses.replace(p, record=r) for p, r in zip(found, checked, strict=True)]


# ------------------------------ all records ------------------------------


def _cutoff(records: Sequence[Record]) -> float:
    """The cut-off of a diagnosis: whose motion predicts the force best."""
    try:
        return prepare(records).cutoff
    except ValueError as error:
        raise RecordError(f"{error}; or state --cutoff") from None


def _delays(
    records: Sequence[Record], wanted: float | str | None, cutoff: float | None
) -> list[Delay] | None:
    """The delay of every record; None where none is wanted or it was stated."""
    if wanted != "auto" or cutoff is None:
        return None
    delays = []
    for record in records:
        try:
            delays.append(force_delay(smooth(record, cutoff)))
        except RecordError as error:
            raise RecordError(f"{record.source or record.name}: --delay auto: {error}") from None
    return delays


# ------------------------------ one record ------------------------------


def _prepare(
    record: TimeRecord,
    options: Options,
    cutoff: float | None,
    delays: Sequence[Delay] | None,
    index: int,
) -> PreparedRecord:
    notes: list[str] = []
    channels = record.channels()
    extra = {name: values for name, values in record.extra.items() if np.isfinite(values).all()}
    spacing, even = uniform_channels(record.time, channels | _apart(extra))
    clock = record.time[0] + spacing * np.arange(next(iter(even.values())).size)
    moved = clock.size != record.samples or bool(
        np.max(np.abs(clock - record.time)) > 0.02 * spacing
    )
    if moved:
        notes.append(
            f"the clock was not uniform: brought to {1 / spacing:.6g} samples per second by a "
            "cubic spline, which colours the noise"
        )
    found: dict[str, Any] = {
        "clock": {"uniform": not moved, "sample_rate": 1 / spacing},
        "delay": None,
        "denoised": {},
        "derivatives": None,
        "resampled": None,
    }

    # delay first: it moves the force, and with it the friction steps, in time
    rows = slice(0, clock.size)
    if options.delay is not None:
        found["delay"], applied = _found_delay(options.delay, delays, index)
        if applied:
            even["force"] = shifted(even["force"], spacing, -applied)
            lost = math.ceil(abs(applied) / spacing - 1e-9)
            if clock.size - lost < MIN_SAMPLES:
                raise RecordError(
                    f"{record.source or record.name}: moved by {applied:g} s only "
                    f"{max(clock.size - lost, 0)} samples of the force are left, {MIN_SAMPLES} are "
                    "needed; state a smaller --delay"
                )
            rows = slice(0, clock.size - lost) if applied > 0 else slice(lost, clock.size)
            notes.append(f"{lost} samples were cut off where the moved force is not known")

    before = {name: even[name][rows] for name in channels}
    denoised = _denoise(record, before, spacing, options)
    found["denoised"] = {name: _summary(d, before[name]) for name, d in denoised.items()}
    columns = before | {name: d.values for name, d in denoised.items()}
    for name, said in found["denoised"].items():
        if said["removed_rms"] < LEAST * said["noise"] or said["noise"] == 0:
            notes.append(
                f"next to nothing was taken from {name!r}: no white noise shows above "
                f"{said['noise']:.3g}; noise that is not white, or was filtered before, bears no "
                "mark: take --denoise lowpass and state its --cutoff"
            )
    if denoised and any(w.code == "outliers" for w in record.warnings):
        notes.append("denoising smears outliers instead of removing them; correct them first")

    times = clock[rows]
    part = slice(0, times.size)
    if options.derivatives and cutoff is not None:
        derived, part, found["derivatives"] = _derive(
            dataclasses.replace(
                record, time=times, extra={}, **{name: before[name] for name in channels}
            ),
            cutoff,
        )
        columns |= derived
        cut = found["derivatives"]["cut"]
        if any(cut):
            notes.append(
                f"{cut[0]} samples at the start and {cut[1]} at the end were cut off: "
                "derivatives there would be guesses"
            )

    others = {name: even[f"extra {name}"][rows] for name in extra}
    columns = {name: values[part] for name, values in columns.items()}
    others = {name: values[part] for name, values in others.items()}
    times = times[part]
    if options.rate is not None:
        times, columns, others, found["resampled"] = _resample(
            record, times, spacing, columns, others, options.rate
        )
    for name in record.extra:
        if name not in others:
            notes.append(f"column {name!r} has gaps and was left out")
    if not moved and options.rate is None:
        # the clock as measured, digit for digit
        first = rows.start + part.start
        times = record.time[first : first + times.size]
    found["notes"] = notes
    made = dataclasses.replace(record, time=times, extra=others, warnings=(), **columns)
    return PreparedRecord(
        source=record, record=made, spacing=spacing, before=before, denoised=denoised, found=found
    )


def _apart(extra: dict[str, Array]) -> dict[str, Array]:
    """Further columns under names that no channel has."""
    return {f"extra {name}": values for name, values in extra.items()}


def _found_delay(
    wanted: float | str, delays: Sequence[Delay] | None, index: int
) -> tuple[dict[str, Any], float]:
    """What is known of the delay, for JSON, and by how much the force is moved [s]."""
    if delays is None:
        return {"how": "stated", "applied": float(wanted)}, float(wanted)
    common = pooled(delays)
    applied = common.value if common.significant else 0.0
    said = {
        "how": "estimated",
        "this_record": {"value": delays[index].value, "stderr": delays[index].stderr},
        "all_records": {"value": common.value, "stderr": common.stderr},
        "significant": common.significant,
        "applied": applied,
    }
    return said, applied


def _denoise(
    record: TimeRecord, channels: dict[str, Array], spacing: float, options: Options
) -> dict[str, Denoised]:
    if options.denoise == "none":
        return {}
    denoised = {}
    for name in dict.fromkeys(options.channels):
        if name not in channels:
            raise RecordError(
                f"{record.source or record.name}: no column {name!r} to denoise "
                f"(measured: {', '.join(channels)}); choose --channel"
            )
        denoised[name] = denoise(
            channels[name], spacing, options.denoise, options.noise, cutoff=options.cutoff
        )
    return denoised


def _summary(denoised: Denoised, before: Array) -> dict[str, Any]:
    said: dict[str, Any] = {
        "method": denoised.method,
        "noise": denoised.noise,
        "removed_rms": float(np.std(before - denoised.values)),
        **denoised.strength,
        "noise_gain": denoised.noise_gain,
    }
    modes = denoised.modes
    if modes is not None:
        said["modes"] = [
            {
                "period_samples": float(period) if math.isfinite(period) else None,
                "rms": math.sqrt(energy),
                "noise_rms": math.sqrt(expected),
                "limit_rms": math.sqrt(limit),
                "kept": bool(kept),
            }
            for period, energy, expected, limit, kept in zip(
                modes.period, modes.energy, modes.expected, modes.threshold, modes.kept,
                strict=True,
            )
        ]  # fmt: skip
    return said


def _derive(record: TimeRecord, cutoff: float) -> tuple[dict[str, Array], slice, dict[str, Any]]:
    """Columns that were not measured, the rows where they are not guesses, and figures."""
    record = bench(record)
    measured = tuple(n for n in ("velocity", "acceleration") if getattr(record, n) is not None)
    motion = smooth(record, cutoff, measured)
    derived = {
        name: getattr(motion, name) for name in ("velocity", "acceleration") if name not in measured
    }
    inner = np.flatnonzero(motion.inner)
    if inner.size < MIN_SAMPLES:
        raise RecordError(
            f"{record.source or record.name}: at a cut-off of {cutoff:.3g} Hz only {inner.size} "
            f"samples are far enough from the ends, {MIN_SAMPLES} are needed; raise --cutoff"
        )
    part = slice(int(inner[0]), int(inner[-1]) + 1)
    said = {
        "columns": list(derived),
        "cutoff": cutoff,
        "velocity_noise": motion.velocity_noise,
        "acceleration_noise": motion.acceleration_noise,
        "cut": [part.start, motion.force.size - part.stop],
    }
    return derived, part, said


def _resample(
    record: TimeRecord,
    times: Array,
    spacing: float,
    columns: dict[str, Array],
    others: dict[str, Array],
    rate: float,
) -> tuple[Array, dict[str, Array], dict[str, Array], dict[str, Any]]:
    count = int((times.size - 1) * spacing * rate) + 1
    if not MIN_SAMPLES <= count <= 10**7:
        what = f"less than {MIN_SAMPLES}" if count < MIN_SAMPLES else "more than memory holds"
        raise RecordError(
            f"{record.source or record.name}: --resample {rate:g} makes {count} samples of "
            f"{times.size * spacing:.3g} s, {what}; choose another rate"
        )
    made, also = (
        {name: resampled(values, spacing, rate) for name, values in group.items()}
        for group in (columns, others)
    )
    said = {
        "from": 1 / spacing,
        "to": rate,
        "unchanged_below": min(PASS_BAND * rate, 1 / spacing) / 2,
    }
    return times[0] + np.arange(next(iter(made.values())).size) / rate, made, also, said
