"""Bench data as a fit needs them: smoothed motions, the force in the same band, and masks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.fft import rfftfreq
from numpy.typing import NDArray

from inerter.core import Device
from inerter.identify.coordinates import Scales
from inerter.records.motion import Motion, filtered, lowpass, response

Array = NDArray[np.float64]

# samples per period of the cut-off that a fit works on; more add time and no information
SAMPLES_PER_PERIOD = 8
# a velocity within this many standard deviations of its noise may be none
REST = 4


@dataclass(frozen=True)
class Run:
    """One run, thinned to what its band needs.

    Attributes
    ----------
    spacing : float
        Sample spacing [s].
    displacement, velocity, acceleration, force : ndarray (n,)
        Smoothed motion, and the measured force through the same low-pass.
    inner : ndarray of bool (n,)
        False near the ends.
    resting : ndarray of bool (n,)
        True in rests, where the velocity is noise: friction without memory is zero there.
    thinned : int
        Measured samples per sample here.
    first_force : float
        Mean measured force over the first 10 ms [N], which tells the state a run begins with.
    """

    name: str
    start: float
    spacing: float
    displacement: Array
    velocity: Array
    acceleration: Array
    force: Array
    inner: NDArray[np.bool_]
    first_force: float
    cutoff: float
    resting: NDArray[np.bool_]
    thinned: int = 1

    def lowpass(self, values: Array) -> Array:
        """The smoother's low-pass at this run's rate, shape (n,) to (n,)."""
        if "_response" not in self.__dict__:
            frequency = rfftfreq(2 * values.size - 2, self.spacing)
            object.__setattr__(self, "_response", response(frequency, self.cutoff))
        return filtered(values, self.__dict__["_response"])

    def friction(self, device: Device, state: float) -> Array:
        """Friction force of a device averaged over each sample's interval [N], shape (n,).

        Friction jumps where the velocity changes sign. Taken at thinned samples the jump would be
        misplaced by up to half an interval, which other effects then make up for; so it is worked
        out at the measured rate.
        """
        n, parts = self.force.size, self.thinned
        if "_fine" not in self.__dict__:
            at = (np.arange(n * parts) + 0.5) / parts - 0.5
            velocity = np.where(self.resting, 0.0, self.velocity)
            fine = [
                np.interp(at, np.arange(n), channel)
                for channel in (self.displacement, velocity, self.acceleration)
            ]
            object.__setattr__(self, "_fine", fine)
        x, v, a = self.__dict__["_fine"]
        friction = device.along(self.spacing / parts, x, v, a, state)["friction"]
        return np.asarray(friction.reshape(n, parts).mean(axis=1), float)

    @property
    def time(self) -> Array:
        """Times of the samples [s], shape (n,)."""
        return self.start + self.spacing * np.arange(self.force.size, dtype=float)


def thin(motion: Motion, rate: float | None = None) -> Run:
    """A run for fitting: force low-passed like the motion, thinned to the rate its band needs.

    `rate` [Hz] overrides the rate; None takes `SAMPLES_PER_PERIOD` times the cut-off.
    """
    rate = rate or SAMPLES_PER_PERIOD * motion.cutoff
    step = max(1, int(1 / (rate * motion.spacing)))
    first = max(1, round(0.01 / motion.spacing))
    force = lowpass(motion.force, motion.spacing, motion.cutoff)
    return Run(
        motion.name,
        motion.start,
        motion.spacing * step,
        np.ascontiguousarray(motion.displacement[::step]),
        np.ascontiguousarray(motion.velocity[::step]),
        np.ascontiguousarray(motion.acceleration[::step]),
        np.ascontiguousarray(force[::step]),
        motion.inner[::step],
        float(np.mean(motion.force[:first])),
        motion.cutoff,
        _resting(motion)[::step],
        step,
    )


def _resting(motion: Motion) -> NDArray[np.bool_]:
    """Stretches longer than the smoother's memory in which the velocity is within its noise."""
    slow = np.abs(motion.velocity) < REST * motion.velocity_noise
    edges = np.flatnonzero(np.diff(np.r_[False, slow, False].astype(int)))
    resting = np.zeros(slow.size, bool)
    for begin, end in edges.reshape(-1, 2):
        resting[begin:end] = (end - begin) * motion.spacing > 1 / motion.cutoff
    return resting


def whole(motion: Motion) -> Run:
    """A run at the record's own rate with the force as measured: what figures are reported on."""
    first = max(1, round(0.01 / motion.spacing))
    return Run(
        motion.name,
        motion.start,
        motion.spacing,
        motion.displacement,
        motion.velocity,
        motion.acceleration,
        motion.force,
        motion.inner,
        float(np.mean(motion.force[:first])),
        np.inf,
        np.zeros(motion.force.size, bool),
    )


def head_size(run: Run, share: float) -> int:
    """Number of samples in the first part of a run."""
    return max(int(share * run.force.size), min(200, run.force.size))


def head(run: Run, share: float) -> Run:
    """The first part of a run."""
    n = head_size(run, share)
    arrays = ("displacement", "velocity", "acceleration", "force", "inner", "resting")
    return replace(run, **{name: getattr(run, name)[:n] for name in arrays})


def scales(runs: Sequence[Run]) -> Scales:
    """Typical sizes of the channels over all runs."""

    def size(channel: str) -> float:
        values = np.concatenate([getattr(run, channel) for run in runs])
        return float(np.std(values)) or 1.0

    return Scales(
        size("force"),
        size("displacement"),
        size("velocity"),
        size("acceleration"),
        min(run.cutoff for run in runs),
    )
