"""A demonstration record after Wang and Su's bench: their device, motions in their manner.

Source: Wang and Su, "Inerter nonlinearities and the impact on suspension control", ACC 2008:
inertance 5 kg (screw) + 108 kg (flywheel), constant friction 10 N, test motions 1 mm at 0.1 Hz
and cos(6 pi t) mm. The steps of sines and the multisine that follow are this project's, so that
one record holds several amplitudes and speeds.
Not modelled: the shaft's elasticity (k_s = 1000 kN/m, c_s = 3200 N s/m), the rig.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from inerter.model_parameters import TEST_RIG

from .device import ReferenceDevice
from .laws import Quantity
from .motion import Motion, response
from .motions import Jet, motion_of, product, total, window, windowed_sines
from .record import write_record

WANG_SU_DEVICE = ReferenceDevice(
    inertance=TEST_RIG.inertance, friction="coulomb", coulomb_force=TEST_RIG.coulomb_force
)


@dataclass(frozen=True, kw_only=True)
class WangSuBench:
    """One record: what the sensors saw, arrays of shape (n,), and the device behind it."""

    seed: int
    time: NDArray[np.float64]
    displacement: NDArray[np.float64]
    force: NDArray[np.float64]
    device: ReferenceDevice
    force_noise: float
    displacement_noise: float

    def write_csv(self, path: str | Path) -> Path:
        """Write the record; its comments say that it is synthetic, not what is hidden in it."""
        comments = (
            "synthetic: made by the reference ODE, not measured",
            "device and test motions after Wang and Su, ACC 2008; rigid shaft",
            f"white noise: {self.force_noise:g} N, {self.displacement_noise:g} m; seed {self.seed}",
            "units: s, m, N; tension positive",
        )
        return write_record(path, self.time, self.displacement, self.force, comments)


def wang_su_motion(seed: int) -> Motion:
    """The 40 s test motion: 10 s slow, 6 s at 3 Hz, 14 s of stepped sines, 10 s multisine."""
    draw = np.random.default_rng(np.random.SeedSequence([seed, 1]))
    known = windowed_sines(
        [1e-3, 1e-3, 8e-3, 5e-3, 3e-3, 2e-3, 6e-3],
        [0.1, 3.0, 0.5, 1.0, 2.0, 4.0, 1.5],
        [0.0, 10.0, 16.0, 20.0, 23.0, 25.5, 27.5, 30.0],
        0.4,
        phases=[np.pi / 2.0] * 2 + [0.0] * 5,
    )
    frequencies = np.sort(draw.uniform(0.3, 5.0, 12))
    omega = 2.0 * np.pi * frequencies
    amplitudes = 4e-3 * frequencies**-1.3 * draw.uniform(0.6, 1.4, 12)
    phases = draw.uniform(0.0, 2.0 * np.pi, 12)

    def jet(t: Quantity) -> Jet:
        angle = np.multiply.outer(t, omega) + phases
        tones: Jet = (
            np.sin(angle) @ amplitudes,
            np.cos(angle) @ (amplitudes * omega),
            -np.sin(angle) @ (amplitudes * omega * omega),
        )
        first: Jet = (known.displacement(t), known.velocity(t), known.acceleration(t))
        return total([first, product(window(t, 30.0, 40.0, 0.4), tones)])

    return motion_of(jet, (*known.kinks, 30.0, 30.4, 39.6, 40.0))


def wang_su_bench(
    seed: int,
    *,
    sample_rate: float = 250.0,
    force_noise: float = 0.2,
    displacement_noise: float = 1e-6,
) -> WangSuBench:
    """The 40 s record of the bench device at `sample_rate` [Hz], noise in N and m (rms)."""
    time = np.arange(round(40.0 * sample_rate)) / sample_rate
    answer = response(WANG_SU_DEVICE, wang_su_motion(seed), time)
    shake = np.random.default_rng(np.random.SeedSequence([seed, 2]))
    return WangSuBench(
        seed=seed,
        time=time,
        displacement=answer.displacement + displacement_noise * shake.standard_normal(time.size),
        force=answer.force + force_noise * shake.standard_normal(time.size),
        device=WANG_SU_DEVICE,
        force_noise=force_noise,
        displacement_noise=displacement_noise,
    )
