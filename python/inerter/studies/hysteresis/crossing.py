"""Who made the data, who fits: every model on three tests, judged on the fourth, all four ways.

The fits are those of `inerter identify`: bounded least squares over scaled coordinates from many
starts. Its Bouc-Wen has no parallel spring of its own, so the part `stiffness` is added; together
they are the paper's Bouc-Wen with A k0 as stiffness. Its LuGre holds delta at 2.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from inerter.identify.fit import Problem
from inerter.identify.laws import law_named
from inerter.identify.multistart import search
from inerter.studies.hysteresis.objective import force_of, true_error
from inerter.studies.hysteresis.published import FREQUENCIES
from inerter.studies.hysteresis.settings import Settings
from inerter.studies.hysteresis.virtual_tests import VirtualTest, cleaned_tests, measured

FITTERS: Mapping[str, str] = MappingProxyType(
    {
        "viscous": "b and c alone",
        "dahl": "Dahl",
        "lugre": "LuGre",
        "bouc_wen": "Bouc-Wen",
    }
)
"""What is fitted, and its title."""

_LAWS = {"bouc_wen": "bouc_wen+stiffness"}


@dataclass(frozen=True, kw_only=True)
class Crossing:
    """A fit to some tests.

    Attributes
    ----------
    maker, fitter
        See `published.MAKERS` and `FITTERS`.
    fitted
        Frequencies fitted [Hz].
    fit_error
        Rms force error [N] on the cleaned force fitted.
    true_errors
        Rms distance [N] from the force without noise at 1, 2, 3, 4 Hz.
    measured_errors
        Rms distance [N] from the noisy force.
    device
        The device found.
    """

    maker: str
    fitter: str
    fitted: tuple[float, ...]
    fit_error: float
    true_errors: tuple[float, ...]
    measured_errors: tuple[float, ...]
    device: Mapping[str, float | str]
    seconds: float

    @property
    def held_out(self) -> tuple[float, ...]:
        """Frequencies [Hz] that were not fitted."""
        return tuple(f for f in FREQUENCIES if f not in self.fitted)

    def json(self) -> dict[str, object]:
        """Plain data."""
        return {
            "maker": self.maker,
            "fitter": self.fitter,
            "fitted": list(self.fitted),
            "fit_error": self.fit_error,
            "true_errors": list(self.true_errors),
            "measured_errors": list(self.measured_errors),
            "device": dict(self.device),
            "seconds": self.seconds,
        }


def cross(maker: str, fitter: str, fitted: tuple[float, ...], settings: Settings) -> Crossing:
    """Fit a model to the tests at some frequencies [Hz] of a device of `published.MAKERS`."""
    begin = time.process_time()
    s = settings
    data = cleaned_tests(maker, s.rate, s.duration, s.noise, s.seed, s.denoise)
    runs = [test.run(cleaned) for test, cleaned in data]
    used = [f in fitted for f in FREQUENCIES]
    chosen = [run for run, use in zip(runs, used, strict=True) if use]
    problem = Problem(chosen, [run.inner for run in chosen])
    law = law_named(_LAWS.get(fitter, fitter))
    # the paper's models have no constant force
    fixed = {"force_offset": 0.0} if "force_offset" in law.linear else {}
    found = search(problem, law, fixed, starts=s.starts if law.starts else None).best
    device = found.model.device()
    noisy = [measured(maker, test, s.noise, s.seed) for test, _ in data]
    return Crossing(
        maker=maker,
        fitter=fitter,
        fitted=fitted,
        fit_error=found.rmse(problem.masks),
        true_errors=tuple(true_error(device, test) for test, _ in data),
        measured_errors=tuple(
            _rms(force_of(device, test) - force, test)
            for (test, _), force in zip(data, noisy, strict=True)
        ),
        device={k: v for k, v in device.given.items() if v != 0.0 or k == "bw_ratio"},
        seconds=time.process_time() - begin,
    )


def _rms(values: NDArray[np.float64], test: VirtualTest) -> float:
    return float(np.sqrt(np.mean(values[test.settled] ** 2)))
