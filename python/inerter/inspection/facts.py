"""The facts of records, and their short form."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from inerter import motion_units as units
from inerter.inspection.channel import ChannelFacts, channel_facts
from inerter.inspection.motion import MotionFacts, motion_facts
from inerter.inspection.tells import Tell, clauses, tells
from inerter.motion_units import TRANSLATION, Kind
from inerter.printable import in_digits
from inerter.records import AnyRecord, Record, TimeRecord
from inerter.records.even_clock import even_spacing
from inerter.records.motion import Motion, smooth, uniform_channels
from inerter.records.units import QUANTITIES, quantity_in

SCHEMA = "inerter.inspection/1"
MOST = 1_000_000  # samples that are looked at of a record
# cut-off of the motion, times the band in which the displacement stands above its noise
WITHIN = 2.0


@dataclass(frozen=True, kw_only=True)
class Facts:
    """What one record holds, SI units.

    jitter: share of an interval by which the clock strays (98 % of it); motion and tells are None
    and empty where it is no bench record, or one whose motion cannot be told from its noise.
    """

    record: AnyRecord
    rate: float | None
    duration: float | None
    jitter: float | None
    channels: tuple[ChannelFacts, ...]
    smoothed: Motion | None
    motion: MotionFacts | None
    tells: tuple[Tell, ...]
    looked_at: int

    def json(self) -> dict[str, Any]:
        """The same, for JSON."""
        record = self.record
        return {
            "name": record.name,
            "source": str(record.source) if record.source else None,
            "kind": record.kind,
            "reading": record.reading,
            "samples": record.samples,
            "looked_at": self.looked_at,
            "sample_rate": self.rate,
            "duration": self.duration,
            "jitter": self.jitter,
            "channels": [dataclasses.asdict(channel) for channel in self.channels],
            "motion": dataclasses.asdict(self.motion) if self.motion else None,
            "tells": [dataclasses.asdict(tell) for tell in self.tells],
            "warnings": [{"code": w.code, "text": w.text} for w in record.warnings],
        }


def facts_of(record: AnyRecord) -> Facts:
    """The facts of a record; of a very long one of its beginning."""
    part = _beginning(record)
    unit = {name: quantity_in(record.motion, name).unit for name in QUANTITIES}
    if not isinstance(part, TimeRecord):
        plain = tuple(
            ChannelFacts(
                name=n, unit=unit.get(n, ""), low=float(v.min()), high=float(v.max()), noise=0.0,
                step=None, band=0.0, hum=(), corner=None,
            )
            for n, v in part.channels().items()
        )  # fmt: skip
        return Facts(
            record=record, rate=None, duration=None, jitter=None, channels=plain, smoothed=None,
            motion=None, tells=(), looked_at=part.samples,
        )  # fmt: skip
    written = part.channels()
    spacing, even = uniform_channels(part.time, written)
    channels = tuple(
        channel_facts(n, unit.get(n, ""), v, spacing, written[n]) for n, v in even.items()
    )
    steps = np.diff(part.time)
    low, high = np.quantile(steps, (0.01, 0.99))
    codes = {warning.code for warning in record.warnings}
    smoothed = _smoothed(part, channels) if isinstance(part, Record) else None
    motion = motion_facts(smoothed) if smoothed is not None else None
    return Facts(
        record=record,
        rate=part.sample_rate,
        duration=float(record.time[-1] - record.time[0])
        if isinstance(record, TimeRecord)
        else None,
        jitter=float((high - low) / np.median(steps) / 2),
        channels=channels,
        smoothed=smoothed,
        motion=motion,
        tells=tuple(tells(smoothed, motion, codes))
        if smoothed is not None and motion is not None
        else (),
        looked_at=part.samples,
    )


def _beginning(record: AnyRecord) -> AnyRecord:
    if record.samples <= MOST or not isinstance(record, TimeRecord):
        return record
    columns = {n: v[:MOST] for n, v in {"time": record.time, **record.channels()}.items()}
    return dataclasses.replace(record, extra={}, **columns)


def _smoothed(record: Record, channels: Sequence[ChannelFacts]) -> Motion | None:
    band = next(c.band for c in channels if c.name == "displacement")
    cutoff = min(max(WITHIN * band, 5.0 / record.duration), 0.2 * record.sample_rate)
    motion = smooth(record, cutoff, ())
    if motion.inner.sum() < 50 or not np.any(motion.velocity[motion.inner]):
        return None
    return motion


# --- in words ----------------------------------------------------------------------------------


def size(value: float, unit: str) -> str:
    """A value with a unit of its size."""
    factor, name = scale(value, unit)
    return in_digits(f"{value * factor:.3g} {name}")


def span(low: float, high: float, unit: str) -> str:
    """From one value to another, in the unit of the larger one: "-3 to 105 mm"."""
    factor, name = scale(max(abs(low), abs(high)), unit)
    # a small end to the digits of the large one
    digits = 2 - math.floor(math.log10(max(abs(low), abs(high)) * factor or 1.0))
    ends = (f"{float(f'{round(end * factor, digits):.3g}') + 0.0:g}" for end in (low, high))
    return f"{' to '.join(ends)} {name}"


def scale(value: float, unit: str) -> tuple[float, str]:
    """Factor and name of the unit in which a value of this size is shown."""
    for factor, prefix in ((1.0, ""), (1e3, "m"), (1e6, "u")):
        if unit in ("m", "rad") and (abs(value) * factor >= 1 or factor == 1e6):
            return factor, f"{prefix}{unit}"
    return 1.0, unit.replace("*", " ")


def _is_rounded(facts: Facts) -> bool:
    """Whether intervals differ for the rounding of times alone; by less they may for any cause."""
    if facts.jitter is None or facts.jitter < 0.05 or not isinstance(facts.record, TimeRecord):
        return False
    return even_spacing(facts.record.time) is not None


def clock_words(facts: Facts) -> str:
    """How many samples, how often, how evenly."""
    text = f"{facts.record.samples} samples"
    if facts.rate is None or facts.duration is None or facts.jitter is None:
        return text
    text += f", {facts.rate:.6g} per second, {facts.duration:.5g} s, "
    if facts.jitter < 5e-4:
        text += "an even clock"
    else:
        text += f"98 % of the intervals within {100 * facts.jitter:.2g} % of the usual one"
        if _is_rounded(facts):
            text += ", as its times are rounded: an even clock"
    if facts.looked_at < facts.record.samples:
        text += f"; looked at: the first {facts.looked_at}"
    return text


def short(facts: Facts) -> list[str]:
    """The facts of a record in a few lines, for the beginning of a diagnosis."""
    record = facts.record
    if facts.rate is None or facts.duration is None:
        return [f"{record.name}: {record.samples} rows"]
    parts = [
        f"{c.name} {span(c.low, c.high, c.unit)} (noise {size(c.noise, c.unit)}"
        + (f", in steps of {size(c.step, c.unit)})" if c.step is not None else ")")
        for c in facts.channels[:2]
    ]
    lines = [
        f"{record.name}: {record.samples} samples, {facts.rate:.5g} per second, "
        f"{facts.duration:.4g} s; {', '.join(parts)}"
    ]
    if facts.motion is not None:
        lines.append(f"  {motion_words(facts.motion, record.motion)}")
    if facts.tells:
        lines.append(f"  a first look: {'; '.join(clauses(facts.tells))}")
    return lines


def motion_words(motion: MotionFacts, kind: Kind = TRANSLATION) -> str:
    """Strokes and speeds in words."""
    text = f"{motion.strokes} strokes" if motion.strokes != 1 else "1 stroke"
    if motion.stroke is not None:
        text += f" of {size(motion.stroke, units.unit(kind, 'm'))}"
    if motion.period is not None:
        text += f", a period of {motion.period:.3g} s"
    length = units.unit(kind, "m")
    text += f", up to {motion.speed:.3g} {length}/s and {motion.acceleration:.3g} {length}/s^2"
    if motion.rest > 0.02:
        text += f", at rest {100 * motion.rest:.0f} % of the time"
    if motion.repeats is not None:
        repeats = size(motion.repeats, units.unit(kind, "N"))
        text += f"; the {units.force_word(kind)} repeats to {repeats} rms"
    return text
