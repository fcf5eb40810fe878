"""Where a tone is looked for: found where there is one, nowhere else."""

from __future__ import annotations

import numpy as np
import pytest
from inerter.diagnose.tone import strongest_line
from inerter.identify.bench import Run, whole
from inerter.identify.preparation import prepare
from inerter.records import Record

TIME = np.arange(0, 8, 1e-3)


def moving(frequency: float, seed: int) -> Run:
    random = np.random.default_rng(seed)
    x = 5e-3 * np.sin(2 * np.pi * frequency * TIME)
    force = 40 * np.gradient(np.gradient(x, TIME), TIME) + random.standard_normal(TIME.size)
    return whole(prepare([Record(name="run", time=TIME, displacement=x, force=force)]).motions[0])


RUNS = [moving(1.1, 1), moving(2.3, 2)]
EVERYTHING = [np.ones(TIME.size, bool)] * 2


def noise(seed: int) -> list[np.ndarray]:
    random = np.random.default_rng(seed)
    return [random.standard_normal(TIME.size) for _ in RUNS]


@pytest.mark.parametrize("frequency", [0.7, 6.4, 44.0, 180.0])
def test_a_tone_of_a_tenth_of_the_noise_power_is_found(frequency: float) -> None:
    residual = [
        values + 0.45 * np.sin(2 * np.pi * frequency * TIME + phase)
        for phase, values in enumerate(noise(3))
    ]
    line = strongest_line(RUNS, residual, EVERYTHING)
    assert line is not None
    assert line[0] == pytest.approx(frequency, abs=0.1)
    assert line[1] == pytest.approx(0.45, rel=0.35)


def test_noise_has_no_tone() -> None:
    assert all(strongest_line(RUNS, noise(seed), EVERYTHING) is None for seed in range(20))


def test_a_line_of_the_motion_or_of_friction_along_it_is_no_tone() -> None:
    for run in RUNS:
        for wave in (run.displacement / 5e-3, np.sign(run.velocity)):
            assert strongest_line([run], [wave + 0.5 * noise(4)[0]], EVERYTHING[:1]) is None
