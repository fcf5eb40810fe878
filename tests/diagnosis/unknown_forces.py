"""Records with a force that no known effect describes, made with NumPy along reference motions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from inerter.diagnose.baseline import baseline_of
from inerter.diagnose.result import Unexplained
from inerter.diagnose.unexplained import unexplained
from inerter.identify.fit import Problem, rms
from inerter.identify.model import Model
from inerter.identify.runs import BenchRun, scales, thin, whole
from inerter.identify.split import split
from inerter.records import Record
from inerter.records.preparation import prepare
from inerter.reference import HiddenCase, NoiseLevels, hide_effect
from numpy.typing import NDArray
from scipy.signal import lfilter

Array = NDArray[np.float64]
QUIET = NoiseLevels(0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Along:
    """A reference motion: time, displacement, velocity, acceleration, (n,) each; stroke, speed."""

    time: Array
    x: Array
    v: Array
    a: Array
    stroke: float
    speed: float


def motions(case: HiddenCase) -> list[Along]:
    """The true motions of a case with the largest displacement and rms velocity of all."""
    truths = [run.truth for run in case.runs]
    stroke = max(float(np.max(np.abs(t.displacement))) for t in truths)
    speed = float(np.sqrt(np.mean(np.concatenate([t.velocity for t in truths]) ** 2)))
    return [
        Along(run.time, t.displacement, t.velocity, t.acceleration, stroke, speed)
        for run, t in zip(case.runs, truths, strict=True)
    ]


def cogging(m: Along) -> Array:
    """Repeats along the stroke."""
    return np.sin(2 * np.pi * m.x / (0.3 * m.stroke) + 1.0)


def coupling(m: Along) -> Array:
    """Grows with place and speed."""
    return m.x * m.v**2


def viscoelastic(m: Along) -> Array:
    """Four Maxwell elements in parallel, each a spring behind a damper."""
    step = m.time[1] - m.time[0]
    total = np.zeros(m.x.size)
    for relaxation in (0.03, 0.08, 0.2, 0.5):
        keep = np.exp(-step / relaxation)
        total += lfilter([relaxation * (1 - keep)], [1, -keep], m.v)
    return total


def log_speed(m: Along) -> Array:
    """Friction that rises with the logarithm of the speed."""
    return np.sign(m.v) * np.log1p(np.abs(m.v) / (0.01 * m.speed))


def periodic_friction(m: Along) -> Array:
    """Friction whose level repeats along the stroke."""
    return np.sign(m.v) * (1 + 0.8 * np.sin(2 * np.pi * m.x / (0.4 * m.stroke)))


def pulsing_friction(m: Along) -> Array:
    """Friction whose level comes and goes with time."""
    return np.sign(m.v) * (1 + np.sin(2 * np.pi * 0.7 * m.time))


def fading(m: Along) -> Array:
    """Inertance that fades in the course of each run."""
    return -m.a * (1 - np.exp(-m.time / 5.0))


def square_wave(m: Along) -> Array:
    """A disturbance that knows only two values."""
    return np.sign(np.sin(2 * np.pi * 1.3 * m.time + 10 * m.x[m.x.size // 3] / m.stroke))


def ageing(m: Along) -> Array:
    """Friction that grows with the logarithm of the time in contact, which sliding renews."""
    step, reach = m.time[1] - m.time[0], 0.05 * m.stroke
    age, ages = 0.01, np.empty(m.x.size)
    for i, speed in enumerate(np.abs(m.v)):
        age = (age + step) / (1 + speed * step / reach)
        ages[i] = age
    return np.tanh(m.v / (0.01 * m.speed)) * (1 + 0.4 * np.log1p(ages / 0.02))


def squeal(m: Along) -> Array:
    """Oscillation that a reversal sets off, with a phase of its own each time."""
    random = np.random.default_rng(round(1e6 * abs(float(m.x[m.x.size // 2]))))
    force, last = np.zeros(m.x.size), -1.0
    for i in np.flatnonzero(np.sign(m.v[1:]) != np.sign(m.v[:-1])) + 1:
        if m.time[i] - last > 0.05:
            last = m.time[i]
            since = m.time[i:] - last
            wave = np.sin(2 * np.pi * 40 * since + random.uniform(0, 2 * np.pi))
            force[i:] += np.exp(-since / 0.06) * wave
    return force


def unknown_records(
    seed: int, law: Callable[[Along], Array], share: float, noise: float = 0.01
) -> tuple[list[Record], float]:
    """An ideal inerter with an unknown force of rms `share` of the inertance force, and its size.

    The size is what `law` is multiplied by [N].
    """
    case = hide_effect(seed, "none", noise=QUIET)
    along = motions(case)
    extra = [law(m) for m in along]
    forces = [case.device.inertance * m.a for m in along]
    size = share * _rms(forces) / _rms(extra)
    forces = [f + size * e for f, e in zip(forces, extra, strict=True)]
    return _noisy(seed, along, forces, noise), size


def dead_band_records(seed: int, share: float, noise: float = 0.01) -> list[Record]:
    """An ideal inerter behind a force channel that shows nothing of small forces."""
    case = hide_effect(seed, "none", noise=QUIET)
    along = motions(case)
    forces = [case.device.inertance * m.a for m in along]
    limit = 1.3 * share * _rms(forces)
    return _noisy(seed, along, [f - np.clip(f, -limit, limit) for f in forces], noise)


def _rms(parts: list[Array]) -> float:
    return float(np.sqrt(np.mean(np.concatenate(parts) ** 2)))


def _noisy(seed: int, along: list[Along], forces: list[Array], noise: float) -> list[Record]:
    random = np.random.default_rng(seed)
    sigma, jitter = noise * _rms(forces), 1e-6 * noise / 0.01
    return [
        Record(
            name=f"run_{i + 1}",
            time=m.time,
            displacement=m.x + jitter * random.standard_normal(m.x.size),
            force=f + sigma * random.standard_normal(f.size),
        )
        for i, (m, f) in enumerate(zip(along, forces, strict=True))
    ]


def remaining(
    records: list[Record], model: Callable[[list[BenchRun]], Model] | None = None
) -> Unexplained:
    """What a fitted model leaves: by default the ideal inerter with viscous and Coulomb friction.

    Both kinds of friction stand for the search, which takes known effects for an unknown one.
    """
    preparation = prepare(records)
    runs = [thin(motion) for motion in preparation.motions]
    full = [whole(motion) for motion in preparation.motions]
    parts = split(runs)
    sizes = scales(runs)
    start = baseline_of(None, sizes)
    if model is not None:
        start = model(runs)
    else:
        start = start.adding("coulomb", viscous=0.0, coulomb_force=1e-3 * sizes.force)
    problem = Problem(runs, parts.fit, sizes)
    fitted = problem.fit(start).model
    held = split(full, [r.name for i, r in enumerate(runs) if parts.role(i) == "holdout"])
    everything = Problem(full, held.holdout, sizes)
    residual = everything.residual(fitted)
    accelerations = [motion.acceleration_noise for motion in preparation.motions]
    floor = np.hypot(
        preparation.noise_floor,
        fitted.values["inertance"] * np.sqrt(np.mean(np.square(accelerations))),
    )
    return unexplained(
        runs,
        parts,
        problem.residual(fitted),
        float(floor),
        rms(residual, everything.masks),
        full,
        residual,
    )


def with_stated(case: HiddenCase) -> Callable[[list[BenchRun]], Model]:
    """The family of the hidden effect, to fit from the true values."""
    from inerter.core import Device

    device = Device(
        inertance=case.device.inertance, friction=case.device.friction, **case.parameters
    )

    def model(runs: list[BenchRun]) -> Model:
        start = baseline_of(device, scales(runs))
        free = tuple(name for name in start.values if name != "transition_velocity")
        if start.friction in ("coulomb", "stribeck"):
            free += ("transition_velocity",)
        return replace(start, free=free)

    return model
