"""The pictures of the study as data: panels with lines, for print and for the page alike."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inerter.studies.fluid_rig.identify import IdentifiedRig
from inerter.studies.fluid_rig.objective import Measured
from inerter.studies.fluid_rig.signals import Signals
from inerter.studies.fluid_rig.spectra import spectra
from inerter.studies.fluid_rig.study import Study
from inerter.studies.fluid_rig.sweeps import END, LEVELS, START

Array = NDArray[np.float64]

# seconds of the sweep that the time panels show
_SHOWN = (4.0, 14.0)


@dataclass(frozen=True)
class Line:
    """One line: `kind` "measured" or "fitted" (its colour), dashed or not."""

    label: str
    x: Array
    y: Array
    kind: str
    dashed: bool = False


@dataclass(frozen=True)
class Panel:
    """One panel; logarithmic: its ordinate. group: whose lines are hidden together."""

    title: str
    abscissa: str
    lines: tuple[Line, ...]
    logarithmic: bool = False
    group: str = ""


@dataclass(frozen=True)
class Picture:
    """Rows of panels under a name, which is the file's, and a title."""

    name: str
    title: str
    rows: tuple[tuple[Panel, ...], ...]


def pictures(study: Study) -> tuple[Picture, ...]:
    """Dry (Figs. 14 to 16), complete (17 to 19), levels (20)."""
    run = study.shown
    return (
        _configuration(
            "dry", "Dry, four levels of voltage (Figs. 14, 15, 16)", study.measured["dry"], run.dry
        ),
        _configuration(
            "complete",
            "Complete, after both preloads (Figs. 17, 18, 19)",
            study.measured["complete"],
            run.complete,
        ),
        _levels(study),
    )


def _configuration(name: str, title: str, measured: Measured, fit: IdentifiedRig) -> Picture:
    columns = [
        _column(sweep.name, seen, fitted)
        for sweep, seen, fitted in zip(measured.sweeps, measured.signals, fit.signals, strict=True)
    ]
    return Picture(name, title, tuple(zip(*columns, strict=True)))


def _column(name: str, seen: Signals, fitted: Signals) -> tuple[Panel, ...]:
    """Receptance, its phase, PSD, displacement of one test."""
    pairs = (("measured", seen), ("fitted", fitted))
    shown = {kind: _spectra(each) for kind, each in pairs}
    part = slice(*(round(t * seen.rate) for t in _SHOWN))

    def lines(of) -> tuple[Line, ...]:
        return tuple(Line(kind, each.frequency, of(each), kind) for kind, each in shown.items())

    return (
        Panel(f"{name}: |H| [mm/N]", "f [Hz]", lines(lambda s: 1e3 * s.magnitude), True),
        Panel("phase of H [deg]", "f [Hz]", lines(lambda s: s.phase)),
        Panel("G_xx [mm^2/Hz]", "f [Hz]", lines(lambda s: 1e6 * s.displacement_density), True),
        Panel(
            "displacement [mm]",
            "t [s]",
            tuple(
                Line(kind, each.time[part], 1e3 * each.displacement[part], kind)
                for kind, each in pairs
            ),
        ),
    )


def _levels(study: Study) -> Picture:
    """Two levels, dry and complete; the higher one of the complete device is a prediction."""
    duration, run = study.settings.duration, study.shown
    low, high = (sweep.shortened(duration) for sweep in LEVELS)
    dry, complete = study.measured["dry"], study.measured["complete"]
    generator = np.random.default_rng([study.settings.seeds[0], 2])
    higher = study.truth["complete", high].disturbed(study.settings.noise, generator)
    cases = {
        "dry": [(dry.sweeps[i].name, dry.signals[i], run.dry.signals[i]) for i in (1, 2)],
        "complete, 0.10 V preload": [
            (low.name, complete.signals[1], run.complete.signals[1]),
            (high.name, higher, study.level),
        ],
    }
    rows = []
    for name, pair in cases.items():
        receptance, density = [], []
        for dashed, (level, *both) in zip((False, True), pair, strict=True):
            for kind, signals in zip(("measured", "fitted"), both, strict=True):
                s = _spectra(signals)
                predicted = signals is study.level
                text = f"{level}, {'predicted' if predicted else kind}"
                receptance.append(Line(text, s.frequency, 1e3 * s.magnitude, kind, dashed))
                density.append(Line(text, s.frequency, 1e6 * s.displacement_density, kind, dashed))
        rows.append(
            (
                Panel(f"{name}: |H| [mm/N]", "f [Hz]", tuple(receptance), True, name),
                Panel(f"{name}: G_xx [mm^2/Hz]", "f [Hz]", tuple(density), True, name),
            )
        )
    return Picture("levels", "Two levels of voltage (Fig. 20)", tuple(rows))


def _spectra(signals: Signals):
    shown = spectra(signals.displacement, signals.force, signals.rate)
    return shown.between(START, min(END, START + 11.5 / 60 * signals.time[-1]))
