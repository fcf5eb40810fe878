"""Hidden cases as records, and one diagnosis each."""

from __future__ import annotations

from functools import cache

import numpy as np
from inerter import Device
from inerter.blind_test.case import records_of
from inerter.diagnose import Diagnosis, diagnose_bench
from inerter.reference import HiddenCase, hide_effect


@cache
def solve(seed: int, effect: str, law: str | None = None) -> tuple[HiddenCase, Diagnosis]:
    """Hide an effect by the reference, diagnose the noisy records."""
    case = hide_effect(seed, effect, law=law)
    return case, diagnose_bench(records_of(case), Device(**case.stated) if case.stated else None)


def told(case: HiddenCase) -> dict[str, float]:
    """Smallest standard error that the records allow anybody, of each device parameter hidden.

    The Cramer-Rao bound: the truth's derivatives along the true motion, in the frequency domain,
    against white noise of the force and that of the displacement, b (2 pi f)^2 times as large.
    """
    at = {"inertance": case.device.inertance}
    at |= {name: value for name, value in case.parameters.items() if hasattr(case.device, name)}
    words = {"friction": case.device.friction}
    information = np.zeros((len(at), len(at)))
    for run in case.runs:
        motion, spacing = run.truth, 1 / run.sample_rate

        def force(values: dict[str, float]) -> np.ndarray:
            device = Device(**words, **values)
            x, v, a = motion.displacement, motion.velocity, motion.acceleration  # noqa: B023
            return device.along(spacing, x, v, a)["total"]  # noqa: B023

        slopes = []
        for name, value in at.items():
            step = 1e-4 * abs(value)
            ends = [force({**at, name: value + way * step}) for way in (1, -1)]
            slopes.append((ends[0] - ends[1]) / (2 * step))
        rate = 2 * np.pi * np.fft.rfftfreq(motion.time.size, spacing)
        moving = case.noise["displacement"] * case.device.inertance * rate**2
        density = motion.time.size * (case.noise["force"] ** 2 + moving**2)
        lines = np.fft.rfft(slopes, axis=1)
        # every line but the ends stands for two
        information += np.real((2 * lines / density) @ lines.conj().T)
    return dict(zip(at, np.sqrt(np.diag(np.linalg.pinv(information))), strict=True))
