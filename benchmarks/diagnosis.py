"""How long a whole diagnosis takes, on records made by the reference and on measured ones.

Made records are four runs of 10 s at 1 kHz with 0.2 N and 1 micrometre of noise: a device with one
hidden effect, driven by sines one after another, a chirp, a sum of sines and strokes. Measured
records are used where they are, in ../shared/data beside the checkout or in the folder that
INERTER_RECORDS names. A diagnosis works on all cores; `computed` is what all of them computed
together, which a busy machine stretches less than `seconds`. A long record has a motion between 0.3
and 12 Hz; beside it stands how much memory a fresh process took for it at most.
"""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from inerter.benchmark.rows import Row, aimed
from inerter.diagnose import Diagnosis, diagnose, diagnose_bench
from inerter.records import Record
from inerter.reference import (
    Motion,
    ReferenceDevice,
    chirp,
    response,
    scaled,
    strokes,
    sum_of_sines,
    windowed_sines,
)

AIM, LONG_AIM = "<= 20", "<= 60"
LONG, LONG_NAME = 1_000_000, "1,000,000 samples"
SAMPLE_RATE = 1000.0
INERTANCE, FORCE = 100.0, 300.0  # kg, and the largest inertance force of a run in N
MEASURED = ("rack_inerter/r0_*.csv", "rack_inerter/r16_*.csv", "emps/emps.csv")

# what is hidden beside the inertance
HIDDEN: dict[str, dict[str, float | str]] = {
    "nothing": {},
    "viscous friction": {"viscous": 120.0},
    "LuGre friction": {
        "friction": "lugre", "coulomb_force": 12.0, "static_force": 16.0,
        "stribeck_velocity": 0.03, "bristle_stiffness": 4e4, "bristle_damping": 100.0,
    },
    "series elasticity": {"series_stiffness": 4e6, "series_damping": 2e3},
    "backlash": {"series_stiffness": 4e6, "series_damping": 2e3, "backlash": 4e-5},
}  # fmt: skip


@dataclass(frozen=True)
class Case:
    """What is diagnosed: a name, whose it is, and the call."""

    name: str
    records: str
    call: Callable[[], Diagnosis]
    aim: str = AIM


def folder() -> Path | None:
    """Where the measured records are, if anywhere."""
    beside = Path(__file__).resolve().parents[2] / "shared" / "data"
    named = os.environ.get("INERTER_RECORDS")
    found = Path(named) if named else beside
    return found if found.is_dir() else None


def notes() -> list[str]:
    """What is left out here."""
    if folder() is not None:
        return []
    return ["measured records are left out: put them into ../shared/data or set INERTER_RECORDS"]


def motions(seconds: float) -> dict[str, Motion]:
    """Four motions of so many seconds, of any size."""
    edges = (0.0, 0.3 * seconds, 0.6 * seconds, seconds)
    places, starts = (0.0, 1.0, -0.6, 0.8, 0.0), (0.02, 0.27, 0.52, 0.77)
    return {
        "sines": windowed_sines((1.0, 0.3, 0.1), (0.8, 1.7, 3.1), edges, 0.05 * seconds),
        "chirp": chirp(1.0, 0.4, 8.0, seconds, 0.05 * seconds),
        "sum": sum_of_sines((1.0, 0.4, 0.1, 0.03), (0.5, 1.3, 2.9, 6.1), (0.0, 1.0, 2.0, 3.0)),
        "strokes": strokes(places, [seconds * start for start in starts], [0.18 * seconds] * 4),
    }


@cache
def made(name: str, seconds: float = 10.0) -> tuple[Record, ...]:
    """Records of a device with a hidden effect."""
    device = ReferenceDevice(inertance=INERTANCE, **HIDDEN[name])  # type: ignore[arg-type]
    random, found = np.random.default_rng(7), []
    times = np.arange(round(seconds * SAMPLE_RATE)) / SAMPLE_RATE
    for kind, motion in motions(seconds).items():
        peak = float(np.max(np.abs(np.asarray(motion.acceleration(times)))))
        travel = float(np.max(np.abs(np.asarray(motion.displacement(times)))))
        size = min(FORCE / (INERTANCE * peak), 0.06 / travel)
        truth = response(device, scaled(motion, size), times)
        found.append(
            Record(
                name=kind, time=times,
                displacement=truth.displacement + 1e-6 * random.standard_normal(times.size),
                force=truth.force + 0.2 * random.standard_normal(times.size),
            )
        )  # fmt: skip
    return tuple(found)


def long_record(samples: int = LONG) -> Record:
    """Coulomb and viscous friction along noise between 0.3 and 12 Hz, at 1 kHz."""
    random, times = np.random.default_rng(7), np.arange(samples) / SAMPLE_RATE
    frequency = np.fft.rfftfreq(samples, 1 / SAMPLE_RATE)
    band = (frequency > 0.3) & (frequency < 12.0)
    spectrum = np.zeros(frequency.size, complex)
    spectrum[band] = random.normal(size=(2, band.sum())).T @ (1, 1j)
    spectrum[band] /= 1 + (frequency[band] / 2) ** 2
    size = 8e-3 / np.fft.irfft(spectrum, samples).std()
    x, v, a = (
        size * np.fft.irfft((2j * np.pi * frequency) ** order * spectrum, samples)
        for order in range(3)
    )
    force = 60 * a + 120 * v + 40 * np.sign(v)
    return Record(
        name="long", time=times,
        displacement=x + 1e-6 * random.standard_normal(samples),
        force=force + 2.0 * random.standard_normal(samples),
    )  # fmt: skip


def most_memory(samples: int = LONG) -> float:
    """What a fresh process takes at most to diagnose a long record [MB]."""
    text = (
        "import resource; from benchmarks.diagnosis import long_record; "
        "from inerter.diagnose import diagnose_bench; "
        f"diagnose_bench([long_record({samples})]); "
        "print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)"
    )
    told = subprocess.run(
        [sys.executable, "-c", text], check=True, capture_output=True, text=True,
        cwd=Path(__file__).parents[1],
    )  # fmt: skip
    return float(told.stdout.split()[-1]) / 1e3


def cases(quick: bool, seconds: float) -> list[Case]:
    """What is diagnosed."""
    hidden = ("viscous friction",) if quick else tuple(HIDDEN)
    found = [
        Case(name, "made", lambda name=name: diagnose_bench(made(name, seconds))) for name in hidden
    ]
    if not quick:
        record = long_record()
        found.append(Case(LONG_NAME, "long", lambda: diagnose_bench([record]), LONG_AIM))
    where = folder()
    if where is not None and not quick:
        found += [
            Case(pattern, "measured", lambda path=where / pattern: diagnose([path]))
            for pattern in MEASURED
        ]
    return found


def run(
    quick: bool = False, chosen: Sequence[Case] | None = None, seconds: float = 10.0
) -> list[Row]:
    """Diagnose every case once.

    Parameters
    ----------
    quick
        One made case.
    chosen
        By default `cases`.
    seconds
        Length of a made run.

    Returns
    -------
    list of dict
        `question`, `case`, `records`, `seconds`, `computed`, `samples`, `found` (the effects
        named), `memory` (of a long record) [MB], `aim` (for the seconds), `met`.
    """
    rows = []
    for case in cases(quick, seconds) if chosen is None else chosen:
        if case.records == "made":
            made(case.name, seconds)
        start, before = time.perf_counter(), _computed()
        diagnosis = case.call()
        spent, computed = time.perf_counter() - start, _computed() - before
        rows.append(
            {
                "question": "a whole diagnosis", "case": case.name, "records": case.records,
                "seconds": spent, "computed": computed,
                "samples": sum(record.samples for record in diagnosis.records),
                "found": ", ".join(finding.effect for finding in diagnosis.findings) or "nothing",
                **({"memory": most_memory()} if case.name == LONG_NAME else {}),
                **aimed(spent, case.aim),
            }
        )  # fmt: skip
    return rows


def _computed() -> float:
    """Seconds of processor time of this process and those that it began and that have ended."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system
