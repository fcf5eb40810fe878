"""The time by which one channel is late, to a fraction of a sample, with its standard error.

Model: target(t) = m(t - tau) + noise, with m a sum of known channels of unknown size. For a tau the
target is moved back by it (band-limited) and regressed on the channels, in the frequency domain on
tapered transforms; the tau that leaves least is taken. First all frequencies weigh alike, over the
whole range; then, near the tau found, each by the inverse power of what is left there. For a single
channel this is the slope of the phase of the cross-spectrum, every frequency weighed by its signal
to noise (E. Hannan, P. Thomson, Biometrika 60 (1973) 469: the weights of least variance).

The standard error is that of the regression, with the sizes unknown. What is no delay is late by
different times in different parts of the band. So the error is larger by the root of chi-squared
per degree of freedom of the delays of four parts of the band, and the change between equal and
unequal weights is added to it.

Between displacement and force m is what a device with inertance, damping, a spring and dry friction
does along the measured motion. Damping and delay differ only in how they grow with frequency: the
standard error takes that into account, and for a motion of one tone it is as large as it should be.

Not modelled: dynamics between the channels beyond these, such as a soft shaft or a sensor's own
filter. What of them looks like a delay is part of the delay found.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.fft import rfft
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter1d
from scipy.optimize import minimize_scalar
from scipy.signal.windows import tukey

from inerter.core import Device
from inerter.records.band_limited import shifted
from inerter.records.motion import Motion, lowpass
from inerter.records.record import RecordError

Array = NDArray[np.float64]

# frequencies over which the power of what is left is averaged
NEIGHBOURS = 41
# share of the record that is tapered, both ends together
TAPER = 0.2
# rounds of weighing
REWEIGHTINGS = 3
# parts of the band whose delays are compared
PARTS = 4
# power below which noise is not believed, as a share of the highest
QUIETEST = 1e-6
# fewer samples than this tell no delay
SMALLEST = 200
# lengths of pre-sliding tried for friction, in rms displacements
PRESLIDING = (0.003, 0.03, 0.3)


@dataclass(frozen=True)
class Delay:
    """A delay [s], positive where the target is late, and its standard error [s]."""

    value: float
    stderr: float

    @property
    def significant(self) -> bool:
        """Whether it is more than three standard errors from zero."""
        return abs(self.value) > 3 * self.stderr


def delay_between(
    columns: Sequence[Array], target: Array, spacing: float, largest: float = 0.05
) -> Delay:
    """Delay of a channel behind a sum of others.

    Parameters
    ----------
    columns : sequence of ndarray (n,)
        The channels that make up the target, at any size: one, such as an acceleration, or several.
    target : ndarray (n,)
        The channel that may be late.
    spacing : float
        Interval between samples [s].
    largest : float
        Largest delay that is looked for [s].

    Returns
    -------
    Delay

    Raises
    ------
    RecordError
        Fewer than 200 samples, a channel that does not change, or a delay beyond `largest`.
    """
    matrix = np.array([np.asarray(c, float) - np.mean(c) for c in columns])
    target = np.asarray(target - np.mean(target), np.float64)
    if target.size < SMALLEST:
        raise RecordError(
            f"{target.size} samples are too few to tell a delay; record {SMALLEST} or more"
        )
    sizes = np.std(matrix, axis=1)
    moving = sizes > 1e-9 * np.array([np.max(np.abs(c)) for c in columns])
    if not moving.any() or not np.std(target) > 0:
        raise RecordError("a channel does not change: there is no delay to be found")
    matrix = matrix[moving] / sizes[moving, None]

    problem = _Problem(matrix, target, spacing)
    weight = np.ones(target.size // 2 + 1)
    plain = tau = problem.best(weight, problem.scan(largest))
    for _ in range(REWEIGHTINGS):
        weight = problem.weight(tau, weight)
        tau = problem.best(weight, tau)
    if abs(tau) > 0.98 * largest:
        raise RecordError(
            f"no delay within {largest:g} s explains the two channels; "
            "check that they belong together, or state the delay"
        )
    return Delay(tau, math.hypot(problem.error(tau, weight), tau - plain))


class _Problem:
    """A target, moved by some delay, as a sum of channels, in the frequency domain."""

    def __init__(self, matrix: Array, target: Array, spacing: float) -> None:
        self.matrix, self.target, self.spacing = matrix, target, spacing
        self.taper = tukey(target.size, TAPER)
        self.basis = rfft(matrix * self.taper, axis=1)
        self.reach = spacing

    def moved(self, tau: float) -> NDArray:
        """Transform of the target moved back by tau."""
        return rfft(shifted(self.target, self.spacing, -tau) * self.taper)

    def rest(self, moved: NDArray, weight: Array) -> Array:
        """Power at each frequency of what the channels do not explain of a moved target."""
        return np.abs(moved - _solve(self.basis, moved, weight)[0] @ self.basis) ** 2

    def weight(self, tau: float, weight: Array) -> Array:
        """Inverse of the power that is left, averaged over neighbouring frequencies."""
        rest = self.rest(self.moved(tau), weight)
        power = uniform_filter1d(rest, min(NEIGHBOURS, rest.size), mode="nearest")
        # where a filter left nothing, what there is is rounding and no witness
        return 1 / np.maximum(power, QUIETEST * float(np.max(power)) + 1e-300)

    def scan(self, largest: float) -> float:
        """The delay of whole samples within `largest` that leaves least, all weighed alike."""
        weight = np.ones(self.taper.size // 2 + 1)
        most = max(int(largest / self.spacing), 1)
        samples = np.arange(-most, most + 1)
        # a long scan in larger steps: refined below
        samples = samples[:: max(1, samples.size // 100)]
        # whole samples need no interpolation, and the taper hides what comes round
        left = [
            np.sum(self.rest(rfft(np.roll(self.target, -shift) * self.taper), weight))
            for shift in samples
        ]
        self.reach = float(samples[1] - samples[0]) * self.spacing
        return float(samples[int(np.argmin(left))]) * self.spacing

    def best(self, weight: Array, middle: float) -> float:
        """The delay near another one that leaves least."""
        found = minimize_scalar(
            lambda tau: float(np.sum(weight * self.rest(self.moved(tau), weight))),
            bounds=(middle - self.reach, middle + self.reach),
            method="bounded",
            options={"xatol": 1e-5 * self.spacing},
        )
        return float(found.x)  # type: ignore[attr-defined]

    def error(self, tau: float, weight: Array) -> float:
        """Standard error of a delay, larger where parts of the band disagree about it."""
        moved = self.moved(tau)
        model = _solve(self.basis, moved, weight)[0] @ self.matrix
        late = -rfft(_derivative(model, self.spacing) * self.taper)
        _, covariance = _solve(np.vstack([self.basis, late]), moved, weight)

        # the same delay found from parts of the band that know equally much of it
        told = np.cumsum(weight * np.abs(late) ** 2)
        edges = np.searchsorted(told, told[-1] * np.arange(1, PARTS) / PARTS)
        parts = np.zeros((PARTS, late.size), complex)
        for part, begin, end in zip(parts, (0, *edges), (*edges, late.size), strict=True):
            part[begin:end] = late[begin:end]
        parts = parts[np.any(parts != 0, axis=1)]
        solution, spread = _solve(np.vstack([self.basis, *parts]), moved, weight)
        first = len(self.basis)
        rest, spread = solution[first:], spread[first:, first:]
        excess = float(rest @ np.linalg.pinv(spread, hermitian=True) @ rest) / max(len(rest) - 1, 1)

        # a taper leaves less data than there seem to be, and weighs them unevenly
        taper = self.taper
        lost = taper.size * np.sum(taper**4) / np.sum(taper**2) ** 2
        return float(np.sqrt(covariance[-1, -1] * lost * max(1.0, excess / lost)))


def force_delay(motion: Motion, largest: float = 0.05) -> Delay:
    """Delay of the force behind the motion of a bench record.

    motion: as `motion.smooth` gives it; the force is brought into the same band here.
    Raises RecordError where the record is too short or no delay explains it.
    """
    x, v, a = motion.displacement, motion.velocity, motion.acceleration
    speed = float(np.std(v))
    rows = [a, v, x, v * np.abs(v), np.tanh(v / (0.01 * speed)) if speed else v]
    reach = float(np.std(x))
    for share in PRESLIDING:
        if reach > 0:
            bristle = Device(
                friction="dahl", coulomb_force=1.0, bristle_stiffness=1 / (share * reach)
            )
            rows.append(bristle.along(motion.spacing, x, v, a)["friction"])
    # friction jumps: bring it and the force into the band of the motion
    narrow = [lowpass(row, motion.spacing, motion.cutoff) for row in rows[4:]]
    force = lowpass(motion.force, motion.spacing, motion.cutoff)
    part = _longest(motion.inner)
    return delay_between(
        [row[part] for row in (*rows[:4], *narrow)], force[part], motion.spacing, largest
    )


def _solve(rows: NDArray, target: NDArray, weight: Array) -> tuple[Array, Array]:
    """Real coefficients of complex rows (m, k) for a target (k,), and their covariance (m, m).

    weight: inverse of the noise's mean squared modulus at each frequency, shape (k,).
    """
    scale = np.sqrt(np.sum(weight * np.abs(rows) ** 2, axis=1))
    scale[scale == 0] = 1
    unit = rows / scale[:, None]
    # real and imaginary part each have half of the noise
    gram = 2 * np.real((unit * weight) @ unit.conj().T)
    right = 2 * np.real((unit.conj() * weight) @ target)
    inverse = np.linalg.pinv(gram, rcond=1e-12, hermitian=True)
    return inverse @ right / scale, inverse / np.outer(scale, scale)


def _derivative(values: Array, spacing: float) -> Array:
    """Derivative of a sampled channel by eighth-order central differences."""
    factors = np.array([4 / 5, -1 / 5, 4 / 105, -1 / 280]) / spacing
    slope = np.gradient(values, spacing)
    n = values.size
    slope[4:-4] = sum(
        f * (values[4 + k : n - 4 + k] - values[4 - k : n - 4 - k])
        for k, f in enumerate(factors, start=1)
    )
    return slope


def _longest(mask: NDArray[np.bool_]) -> slice:
    """The longest stretch of True."""
    edges = np.flatnonzero(np.diff(np.r_[False, mask, False].astype(np.int8))).reshape(-1, 2)
    if not len(edges):
        return slice(0, 0)
    begin, end = edges[int(np.argmax(edges[:, 1] - edges[:, 0]))]
    return slice(int(begin), int(end))


def pooled(delays: Sequence[Delay]) -> Delay:
    """One delay for runs of one bench: the mean weighed by the inverse variances.

    Where the runs scatter more than their standard errors say, the error of the mean is larger by
    the root of chi-squared per degree of freedom (R. Birge, Physical Review 40 (1932) 207).
    """
    values, errors = (np.array([getattr(d, n) for d in delays]) for n in ("value", "stderr"))
    weight = 1 / np.maximum(errors, 1e-15) ** 2
    mean = float(np.sum(weight * values) / np.sum(weight))
    error = float(1 / np.sqrt(np.sum(weight)))
    if len(delays) > 1:
        spread = np.sum(weight * (values - mean) ** 2) / (len(delays) - 1)
        error *= max(1.0, float(np.sqrt(spread)))
    return Delay(mean, error)
