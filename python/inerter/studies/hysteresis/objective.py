"""The force error of the paper, P(x) = sqrt(mean (F_measured - F_model)^2), over its parameters.

The model's force is the C core's, along the known motion from an unloaded start.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from inerter.core import Device
from inerter.records.motion import lowpass
from inerter.studies.hysteresis.denoising import Cleaned
from inerter.studies.hysteresis.published import PaperModel
from inerter.studies.hysteresis.virtual_tests import VirtualTest

Array = NDArray[np.float64]


class Objective:
    """A model against tests with their cleaned forces; `evaluations` counts simulated sets."""

    def __init__(self, model: PaperModel, data: Sequence[tuple[VirtualTest, Cleaned]]) -> None:
        self.model = model
        self.data = tuple(data)
        self.evaluations = 0

    def forces(self, vector: Array | tuple[float, ...]) -> list[Array]:
        """Modelled force [N] of every test at the paper's parameters (p,)."""
        device = Device(**self.model.values(vector))
        found = []
        for test, cleaned in self.data:
            force = force_of(device, test)
            if cleaned.cutoff is not None:
                force = lowpass(force, test.spacing, cleaned.cutoff)
            found.append(force)
        return found

    def residual(self, vector: Array | tuple[float, ...]) -> Array:
        """Modelled less cleaned force [N] on the samples that count, shape (m,)."""
        self.evaluations += 1
        return np.concatenate(
            [
                (force - cleaned.force)[test.settled]
                for force, (test, cleaned) in zip(self.forces(vector), self.data, strict=True)
            ]
        )

    def error(self, vector: Array | tuple[float, ...]) -> float:
        """The paper's P(x) [N]."""
        return float(np.sqrt(np.mean(self.residual(vector) ** 2)))

    def true_errors(self, vector: Array | tuple[float, ...]) -> list[float]:
        """Rms distance [N] of the modelled force from the force without noise, per test."""
        device = Device(**self.model.values(vector))
        return [true_error(device, test) for test, _ in self.data]


def force_of(device: Device, test: VirtualTest) -> Array:
    """Force [N] of a device along a test from an unloaded start, shape (n,)."""
    motion = (test.displacement, test.velocity, test.acceleration)
    return device.along(test.spacing, *motion)["total"]


def true_error(device: Device, test: VirtualTest) -> float:
    """Rms distance [N] of a device's force from a test's force without noise."""
    return float(np.sqrt(np.mean((force_of(device, test) - test.truth)[test.settled] ** 2)))
