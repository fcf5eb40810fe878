"""What a fit compares: spectra as the paper does, or the records themselves.

Spectra: ln |H| and ln G_xx of every test at the bins of the sweep, together, because errors of
displacement and force may cancel in |H| (the paper's reason). The logarithms let an anti-resonance
count as much as the first hertz. Each residual is weighted by

    1 / sqrt(sigma^2 + 0.001^2)

sigma its standard deviation by the instruments' noise; 0.001 is what the simulation is right to.
Time: displacement and force of every sample, each over the rms of its noise.
Noise is taken for white, of the size that the upper third of a channel's spectrum shows
(`records.motion.white_noise`): first of the records, whose stick-slip makes it too large, then,
once a model is near, of what is left when the model is taken off.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from inerter.records.motion import white_noise
from inerter.studies.fluid_rig.signals import Noise, Signals
from inerter.studies.fluid_rig.spectra import spectra
from inerter.studies.fluid_rig.sweeps import START, Sweep

Array = NDArray[np.float64]

FLOOR = 1e-3
"""Relative error that is believed of no spectrum to be smaller."""
_DRAWS = 200
_SEED = 1


@dataclass(frozen=True)
class Measured:
    """Sweeps, what was recorded in them, and a model's signals that are near, if there are."""

    sweeps: tuple[Sweep, ...]
    signals: tuple[Signals, ...]
    near: tuple[Signals, ...] | None = None

    @cached_property
    def noise(self) -> Noise:
        """White noise of both channels, the median over the tests."""
        x = [each.displacement for each in self.signals]
        force = [each.force for each in self.signals]
        if self.near is not None:
            x = [a - b.displacement for a, b in zip(x, self.near, strict=True)]
            force = [a - b.force for a, b in zip(force, self.near, strict=True)]
        return Noise(
            float(np.median([white_noise(each) for each in x])),
            float(np.median([white_noise(each) for each in force])),
        )

    def shortened(self, duration: float) -> Measured:
        """The first part of every test, `duration` [s]; itself where that is all."""
        if all(sweep.duration <= duration for sweep in self.sweeps):
            return self
        cut = tuple(each.first(duration) for each in self.signals)
        near = self.near and tuple(each.first(duration) for each in self.near)
        return Measured(tuple(sweep.shortened(duration) for sweep in self.sweeps), cut, near)


class Objective(ABC):
    """What is compared, for one set of measured tests."""

    name: str
    parts: tuple[str, ...]
    """What the features are of, each as long as the others, in their order."""

    def __init__(self, measured: Measured) -> None:
        self.measured = measured

    @abstractmethod
    def features(self, signals: Sequence[Signals]) -> Array:
        """What is compared, of the tests in their order, one vector."""

    @property
    @abstractmethod
    def weights(self) -> Array:
        """Of every feature."""

    @property
    @abstractmethod
    def expected_cost(self) -> float:
        """Sum of squared residuals that noise alone makes of perfect predictions."""

    @abstractmethod
    def covariance(self, jacobian: Array, part: str | None = None) -> Array:
        """Covariance by noise of the variables of a least-squares fit, shape (p, p).

        Parameters
        ----------
        jacobian : ndarray (features, p)
            Derivatives of the weighted features.
        part
            If only this one of `parts` were compared.
        """

    @cached_property
    def target(self) -> Array:
        """The features of what was measured."""
        return self.features(self.measured.signals)

    def residual(self, signals: Sequence[Signals | None]) -> Array:
        """Weighted model minus measured; infinite where a simulation has not reached its end."""
        reached = [each for each in signals if each is not None]
        if len(reached) < len(signals):
            return np.full(self.target.size, np.inf)
        return self.weights * (self.features(reached) - self.target)

    def rows(self, part: str | None) -> slice:
        """The features of one part, or all."""
        if part is None:
            return slice(None)
        length, number = self.target.size // len(self.parts), self.parts.index(part)
        return slice(number * length, (number + 1) * length)


class SpectralObjective(Objective):
    """Receptance and power spectral density together."""

    name = "spectra"
    parts = ("receptance", "density")

    def features(self, signals: Sequence[Signals]) -> Array:
        """Logarithms of |H| of every test, then of G_xx of every test."""
        shown = [
            spectra(each.displacement, each.force, each.rate).between(START, sweep.highest)
            for each, sweep in zip(signals, self.measured.sweeps, strict=True)
        ]
        receptance = [np.log(each.magnitude) for each in shown]
        return np.concatenate(receptance + [np.log(each.displacement_density) for each in shown])

    @cached_property
    def _draws(self) -> Array:
        """The features as further noise moves them, shape (draws, features)."""
        generator, noise = np.random.default_rng(_SEED), self.measured.noise
        drawn = [
            self.features([each.disturbed(noise, generator) for each in self.measured.signals])
            for _ in range(_DRAWS)
        ]
        return np.array(drawn) - np.mean(drawn, axis=0)

    @cached_property
    def weights(self) -> Array:
        """1 over what noise and the simulation leave uncertain."""
        return 1 / np.hypot(np.std(self._draws, axis=0), FLOOR)

    @property
    def expected_cost(self) -> float:
        """From the draws of the noise."""
        return float(np.sum((self.weights * np.std(self._draws, axis=0)) ** 2))

    def covariance(self, jacobian: Array, part: str | None = None) -> Array:
        """From the draws: the features' errors are correlated."""
        rows = self.rows(part)
        moved = (self.weights * self._draws)[:, rows] @ np.linalg.pinv(jacobian[rows]).T
        return moved.T @ moved / (_DRAWS - 1)


class TimeObjective(Objective):
    """Displacement and force of every sample."""

    name = "time"
    parts = ("displacement", "force")

    def features(self, signals: Sequence[Signals]) -> Array:
        """Displacement of every test, then force of every test."""
        parts = [each.displacement for each in signals] + [each.force for each in signals]
        return np.concatenate(parts)

    @cached_property
    def weights(self) -> Array:
        """1 over the rms of each channel's noise."""
        noise, half = self.measured.noise, self.target.size // 2
        return np.repeat([1 / noise.displacement, 1 / noise.force], [half, half])

    @property
    def expected_cost(self) -> float:
        """One for every sample."""
        return float(self.target.size)

    def covariance(self, jacobian: Array, part: str | None = None) -> Array:
        """The noise of the samples is white."""
        inverse = np.linalg.pinv(jacobian[self.rows(part)])
        return inverse @ inverse.T


OBJECTIVES: dict[str, type[SpectralObjective] | type[TimeObjective]] = {
    "spectra": SpectralObjective,
    "time": TimeObjective,
}
"""By name."""
