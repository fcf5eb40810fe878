"""Virtual bench tests: a published device on a harmonic bench, solved by the reference equations.

The reference is an independent telling of the physics, integrated to 1e-8, so that data and fit do
not share code. The motion is imposed and known; white noise is on the force alone.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from inerter.identify.runs import BenchRun
from inerter.reference import ReferenceDevice, response, sine_motion
from inerter.studies.hysteresis.denoising import Cleaned, clean
from inerter.studies.hysteresis.published import (
    AMPLITUDES,
    FREQUENCIES,
    MAKERS,
    maker_values,
)

Array = NDArray[np.float64]

# left out at either end: the bristle's first run-in, and the guess of a denoiser at the ends
EDGE = 1.0


@dataclass(frozen=True, kw_only=True)
class VirtualTest:
    """One test at one frequency, arrays of shape (n,), SI units.

    `truth` is the force without noise; `settled` marks the samples that count.
    """

    frequency: float
    spacing: float
    time: Array
    displacement: Array
    velocity: Array
    acceleration: Array
    truth: Array
    settled: NDArray[np.bool_]

    def run(self, cleaned: Cleaned) -> BenchRun:
        """The test as identification takes it, with a cleaned force."""
        first = max(1, round(0.01 / self.spacing))
        return BenchRun(
            name=f"{self.frequency:g} Hz",
            start=0.0,
            spacing=self.spacing,
            displacement=self.displacement,
            velocity=self.velocity,
            acceleration=self.acceleration,
            force=cleaned.force,
            inner=self.settled,
            first_force=float(np.mean(cleaned.force[:first])),
            cutoff=np.inf,
        )


@lru_cache(maxsize=16)
def virtual_tests(maker: str, rate: float, duration: float) -> tuple[VirtualTest, ...]:
    """The four tests of a device of `published.MAKERS`, without noise.

    rate: samples per second; duration: length of each [s].
    """
    return bench_tests(maker_values(maker), rate, duration)


def bench_tests(
    values: Mapping[str, float | str], rate: float, duration: float
) -> tuple[VirtualTest, ...]:
    """The four tests of any device, given by its parameters; it starts unloaded."""
    device = ReferenceDevice(**values)  # type: ignore[arg-type]
    time = np.arange(round(duration * rate)) / rate
    tests = []
    for amplitude, frequency in zip(AMPLITUDES, FREQUENCIES, strict=True):
        r = response(device, sine_motion(amplitude, frequency), time, rtol=1e-8)
        settled = (time >= EDGE) & (time < duration - EDGE)
        tests.append(
            VirtualTest(
                frequency=frequency,
                spacing=1 / rate,
                time=time,
                displacement=r.displacement,
                velocity=r.velocity,
                acceleration=r.acceleration,
                truth=r.force,
                settled=settled,
            )
        )
    return tuple(tests)


def measured(maker: str, test: VirtualTest, noise: float, seed: int) -> Array:
    """The force of a test with white noise of rms `noise` [N], shape (n,)."""
    key = (seed, list(MAKERS).index(maker), round(10 * test.frequency))
    return test.truth + noise * np.random.default_rng(key).standard_normal(test.truth.size)


@lru_cache(maxsize=64)
def cleaned_tests(
    maker: str, rate: float, duration: float, noise: float, seed: int, way: str
) -> tuple[tuple[VirtualTest, Cleaned], ...]:
    """The tests of a device, each with its noisy force cleaned in one of `denoising.WAYS`."""
    return tuple(
        (test, clean(measured(maker, test, noise, seed), test.spacing, way))
        for test in virtual_tests(maker, rate, duration)
    )
