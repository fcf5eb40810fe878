"""What the noise of the measurement does to an estimate: bias and spread.

Noise on the displacement becomes noise on the velocity and acceleration, along which a model is
run. Least squares takes them for exact, so an estimate is biased, a little, and its errors are not
those of the force alone. Both are measured here: the fitted model is driven along the smoothed
motion, noise as large as the record's is drawn anew on every channel, and the made-up record goes
through the same smoothing. One Gauss-Newton step from the fit says where an estimate from it would
end. What smoothing itself does is told by `choices`.

Noise is taken for white, of the size that the upper third of each channel's spectrum shows.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from inerter.identify.fit import Problem
from inerter.identify.model import Model
from inerter.identify.prediction import force_along
from inerter.identify.runs import BenchRun, thin, whole
from inerter.records import Record
from inerter.records.motion import smooth, white_noise
from inerter.records.preparation import Preparation

Array = NDArray[np.float64]

DRAWS = 60
SEED = 0


@dataclass(frozen=True)
class NoiseEffect:
    """Of a fit's search variables: `bias` (p,) and `covariance` (p, p)."""

    bias: Array
    covariance: Array


def effect_of_noise(
    problem: Problem,
    model: Model,
    jacobian: Array,
    preparation: Preparation,
    records: Sequence[Record],
    used: Sequence[int],
    changed: Callable[[BenchRun], BenchRun] | None = None,
    draws: int = DRAWS,
) -> NoiseEffect:
    """Bias and covariance of the free search variables that the channels' noise brings.

    Parameters
    ----------
    problem, model
        What was fitted, and to what.
    jacobian
        Derivatives of the residual [N] by the search variables at the fit, shape (n, p).
    preparation
        How the records were smoothed.
    records
        Every record, as the motions of the preparation.
    used
        Which of them the runs of the problem are.
    changed
        What is done to a run before a model follows it.
    draws
        Made-up sets of records.
    """
    random = np.random.default_rng(SEED)
    change = changed or (lambda run: run)
    projector = np.linalg.pinv(jacobian)
    truths = [_truth(model, records[i], preparation, change) for i in used]
    steps = np.empty((draws, jacobian.shape[1]))
    for draw in range(draws):
        runs = [change(truth.drawn(random, preparation)) for truth in truths]
        steps[draw] = -projector @ _flat(problem, model, runs)
    bias = steps.mean(axis=0)
    covariance = np.cov(steps.T).reshape(bias.size, bias.size)
    return NoiseEffect(bias, covariance)


@dataclass(frozen=True)
class _Truth:
    """A record without noise, and the noise of its channels by name."""

    record: Record
    noise: dict[str, float]

    def drawn(self, random: np.random.Generator, preparation: Preparation) -> BenchRun:
        noisy = {
            name: getattr(self.record, name) + size * random.standard_normal(self.record.samples)
            for name, size in self.noise.items()
        }
        record = replace(self.record, **noisy)
        return thin(smooth(record, preparation.cutoff, preparation.channels))


def _truth(
    model: Model, record: Record, preparation: Preparation, change: Callable[[BenchRun], BenchRun]
) -> _Truth:
    """The record that the model would leave along the smoothed motion."""
    motion = replace(smooth(record, preparation.cutoff, preparation.channels), instants=1)
    # at rest the smoothed velocity is noise, and would turn friction about
    still = thin(motion).measured
    assert still is not None
    exact = change(replace(whole(motion), velocity=still[1]))
    channels = {
        "displacement": motion.displacement,
        "force": force_along(model, exact),
        **{name: getattr(motion, name) for name in preparation.channels},
    }
    noise = {name: white_noise(getattr(record, name)) for name in channels}
    return _Truth(Record(name=record.name, time=motion.time, **channels), noise)


def _flat(problem: Problem, model: Model, runs: Sequence[BenchRun]) -> Array:
    """Measured minus predicted force on the samples that count, shape (n,)."""
    parts = [
        (run.force - force_along(model, run))[mask]
        for run, mask in zip(runs, problem.masks, strict=True)
    ]
    return np.concatenate(parts)
