"""What the paper states of its tests, checked on the tests made here."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inerter.studies.fluid_rig.identify import IdentifiedRig
from inerter.studies.fluid_rig.rig import Configuration
from inerter.studies.fluid_rig.signals import Signals
from inerter.studies.fluid_rig.spectra import Spectra, spectra
from inerter.studies.fluid_rig.sweeps import Sweep

Array = NDArray[np.float64]

DRY_AT_ONE_HERTZ = (0.117, 0.145, 0.181, 0.203)
"""|H| at 1 Hz of the four dry levels [mm/N], recomputed from the printed equations."""
# part of the sweep in which it passes the anti-resonance [s], and where that is looked for [Hz]
_PASSAGE = (12.0, 32.0)
_NEAR = (3.5, 6.0)
_BAND = (1.0, 3.5)
# about the anti-resonance [Hz]
_DIP = (4.25, 5.5)


@dataclass(frozen=True)
class Statement:
    """text: what is stated. holds: whether it does here. figures: by name, what it rests on."""

    text: str
    holds: bool
    figures: Mapping[str, Any]

    def json(self) -> dict[str, Any]:
        """As JSON."""
        return asdict(self)


def anti_resonance(signals: Signals, sweep: Sweep) -> float:
    """Frequency of the least |H| [Hz], from one window over the sweep's passage.

    Raises
    ------
    ValueError
        The sweep ends before.
    """
    begin, end = _PASSAGE
    if sweep.duration < end - 4.0:
        raise ValueError(f"duration: {sweep.duration:g} s; the anti-resonance needs {end - 4:g} s")
    part = slice(round(begin * signals.rate), round(min(end, sweep.duration) * signals.rate))
    x, force = signals.displacement[part], signals.force[part]
    near = spectra(x, force, signals.rate, x.size / signals.rate).between(*_NEAR)
    return float(near.frequency[np.argmin(near.magnitude)])


def statements(
    truth: Mapping[tuple[Configuration, Sweep], Signals],
    dry: Sequence[Sweep],
    complete: Sequence[Sweep],
    levels: Sequence[Sweep],
    dry_fit: IdentifiedRig,
    complete_fit: IdentifiedRig,
    level_fit: Signals,
) -> tuple[Statement, ...]:
    """The paper's statements about its tests, on the tests without noise and the fits shown."""
    dry_spectra = [_spectra(truth["dry", sweep]) for sweep in dry]
    at_one = [float(1e3 * np.interp(1.0, s.frequency, s.magnitude)) for s in dry_spectra]
    found = [
        Statement(
            "dry: |H| at 1 Hz is 0.117, 0.145, 0.181, 0.203 mm/N (recomputed from the equations)",
            bool(np.allclose(at_one, DRY_AT_ONE_HERTZ, atol=5e-4)),
            {"mm_per_newton": at_one},
        ),
        _grows(dry_spectra),
        _shift(truth, complete),
        _level_matters_less(truth, dry, (complete[1], levels[1])),
        _receptance_alone(dry_fit, complete_fit),
        _prediction(truth["complete", levels[1]], level_fit),
    ]
    return tuple(found)


def _spectra(signals: Signals) -> Spectra:
    return spectra(signals.displacement, signals.force, signals.rate)


def _grows(shown: Sequence[Spectra]) -> Statement:
    band = [each.between(*_BAND) for each in shown]
    magnitude = np.array([each.magnitude for each in band])
    density = np.array([each.displacement_density for each in band])
    return Statement(
        "dry: receptance and PSD grow with the voltage, at every frequency from 1 to 3.5 Hz",
        bool((np.diff(magnitude, axis=0) > 0).all() and (np.diff(density, axis=0) > 0).all()),
        {
            "least_ratio_of_receptance": float(np.min(magnitude[1:] / magnitude[:-1])),
            "least_ratio_of_density": float(np.min(density[1:] / density[:-1])),
        },
    )


def _shift(
    truth: Mapping[tuple[Configuration, Sweep], Signals], complete: Sequence[Sweep]
) -> Statement:
    at = {sweep.name: anti_resonance(truth["complete", sweep], sweep) for sweep in complete}
    values = list(at.values())
    return Statement(
        "complete: an anti-resonance between 4.4 and 4.9 Hz, higher after the higher preload",
        bool(4.4 < values[0] < values[1] < 4.9),
        {"hertz": at},
    )


def _level_matters_less(
    truth: Mapping[tuple[Configuration, Sweep], Signals],
    dry: Sequence[Sweep],
    levels: Sequence[Sweep],
) -> Statement:
    """Ratio of |H| of two levels, dry and complete, over the sweep; the PSD still grows."""
    pairs = {
        "dry": [_spectra(truth["dry", sweep]) for sweep in dry[1:3]],
        "complete": [_spectra(truth["complete", sweep]) for sweep in levels],
    }
    change, near, growth = {}, {}, {}
    for name, pair in pairs.items():
        low, high = (each.between(_BAND[0], dry[0].highest - 1.0) for each in pair)
        change[name] = float(np.median(np.abs(np.log(high.magnitude / low.magnitude))))
        growth[name] = float(np.median(high.displacement_density / low.displacement_density))
        low, high = (each.between(*_DIP) for each in pair)
        near[name] = float(np.median(np.abs(np.log(high.magnitude / low.magnitude))))
    return Statement(
        "complete: a higher level changes the receptance much less than dry, the PSD clearly",
        change["complete"] < 0.5 * change["dry"] and growth["complete"] > 1.2,
        {
            "median_change_of_ln_receptance": change,
            "near_the_anti_resonance": near,
            "median_ratio_of_density": growth,
        },
    )


def _receptance_alone(dry_fit: IdentifiedRig, complete_fit: IdentifiedRig) -> Statement:
    """How much larger the standard errors are with the receptance alone, near the minimum."""
    ratios = {}
    for fit in (dry_fit, complete_fit):
        if "receptance" in fit.alone:
            ratio = fit.alone["receptance"] / np.maximum(fit.together, 1e-300)
            ratios |= dict(zip(fit.names, map(float, ratio), strict=True))
    return Statement(
        "receptance and PSD together determine every parameter better than the receptance alone",
        bool(ratios) and min(ratios.values()) > 1.0,
        {"standard_error_ratio": ratios},
    )


def _prediction(measured: Signals, fitted: Signals) -> Statement:
    """The level that no fit has seen."""
    real, model = (_spectra(each).between(1.0, 10.0) for each in (measured, fitted))
    error = float(np.sqrt(np.mean(np.log(model.magnitude / real.magnitude) ** 2)))
    difference = fitted.displacement - measured.displacement
    share = float(np.std(difference) / np.std(measured.displacement))
    return Statement(
        "the identified model reproduces a level that it was not fitted to, within 2 %",
        error < 0.02 and share < 0.02,
        {"rms_error_of_ln_receptance": error, "rms_error_of_displacement": share},
    )
