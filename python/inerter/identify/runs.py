"""Bench data as a fit needs them: smoothed motions, the force in the same band, and masks."""

from __future__ import annotations

import itertools
import os
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from inerter.catalogue.scales import Scales, size_of
from inerter.checked_motion import checked_motion
from inerter.core import Device
from inerter.identify.between import about_samples, between
from inerter.motion_units import TRANSLATION, Kind
from inerter.records.motion import (
    EDGE_PERIODS,
    Motion,
    Shaft,
    apply_weight,
    band_response,
    filtered,
    filtered_and_thinned,
    has_one_line,
    is_slow,
    response,
    weight_above,
)
from inerter.records.record import Part
from inerter.records.rests import long_stretches

Array = NDArray[np.float64]

# time over which a first force is a mean [s]
FIRST = 0.01
# samples per period of the cut-off that a fit works on; more add time and no information
SAMPLES_PER_PERIOD = 8
# a velocity within this many standard deviations of its noise may be none
REST = 4
# squared correlation of displacement and acceleration from which they count as proportional
ONE_TONE = 0.98

# times after a first sample whose mean force is kept
_MOST_TIMES = 8

_made = itertools.count()


def _new_identity() -> tuple[int, int]:
    return os.getpid(), next(_made)


@dataclass(frozen=True, kw_only=True)
class BenchRun:
    """One run, thinned to what its band needs.

    Attributes
    ----------
    spacing : float
        Sample spacing [s].
    displacement, velocity, acceleration, force : ndarray (n,)
        Smoothed motion, and the measured force through the same low-pass.
    inner : ndarray of bool (n,)
        False near the ends.
    measured : tuple of ndarray (m,), optional
        Displacement, velocity, acceleration at the measured rate, or more often; the velocity is 0
        in rests, where it would be noise.
    thinned : int
        Measured samples per sample here.
    instants : int
        Instants per measured sample at which the force is followed: more than one where what it
        jumps by is smooth in the record.
    first_force : float
        Mean measured force over 10 ms [N] at the sample `first`, which tells the state there.
    first : int
        The first sample at which the motion is known; the device is followed from there.
    clock : float
        Time from which slow changes count [s].
    zeroed : float, optional
        That from which the drift of the force does, where it is another one.
    corner : float
        Frequency [Hz] above which the motion's noise outweighs the force's; residuals count less
        there.
    noise : float
        Of the force in the band, rms [N]; 0 where it is not known.
    shaft : tuple of float, optional
        Resonance [Hz] and damping ratio of a series element, which amplifies the motion's noise.
    far : float
        Size [N] beyond which a residual counts little, see `weighted`.
    quiet : float
        Cut-off of the motion [Hz] where forces are compared in a wider band: above it the motion
        has no noise.
    motion : str
        What the device does; in rotation read rad for m and N m for N.
    part : Part, optional
        Of which run it is a part.
    identity : tuple of int
        Tells its samples from those of all other runs, in other processes too.
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
    measured: tuple[Array, Array, Array] | None = None
    thinned: int = 1
    instants: int = 1
    first: int = 0
    clock: float = 0.0
    zeroed: float | None = None
    corner: float = np.inf
    noise: float = 0.0
    shaft: Shaft | None = None
    far: float = np.inf
    quiet: float = np.inf
    motion: Kind = TRANSLATION
    part: Part | None = None
    identity: tuple[int, int] = field(init=False, default_factory=_new_identity)

    def at_measured_rate(self, device: Device, state: float | Array) -> dict[str, Array]:
        """Forces of a device at the measured rate [N], shape (m,) each.

        Friction jumps where the velocity changes sign. At the instants of the measured samples a
        jump falls between the same two samples as in the record; elsewhere other effects would be
        found to make up for that. A jump that went through a low-pass before it was sampled is in
        several samples, and when it was is told from between them.
        """
        if self.measured is None:
            raise ValueError(f"{self.name}: a run at the measured rate has no band")
        size = self.measured[0].size
        return forces_along(device, self.fine_spacing, self._followed_finely, state, size)

    def force_at_measured_rate(self, device: Device, state: float | Array, name: str) -> Array:
        """One of them alone, "total" or "friction"."""
        x, v, a = self._followed_finely
        size = self.force.size if self.measured is None else self.measured[0].size
        return held(device.force_checked(self.fine_spacing, x, v, a, state, name), size)

    def along(self, device: Device, state: float | Array) -> dict[str, Array]:
        """Forces of a device along the thinned motion [N], shape (n,) each.

        Where the force is as measured and its jumps were smoothed, friction is the mean about each
        sample.
        """
        if self.instants == 1 or np.isfinite(self.cutoff):
            return forces_along(device, self.spacing, self.followed, state, self.force.size)
        return about_samples(self.at_measured_rate(device, state), self.instants)

    def thinned_force(self, device: Device, state: float | Array) -> Array:
        """The total of them alone."""
        if self.instants > 1 and np.isinf(self.cutoff):
            return self.along(device, state)["total"]
        x, v, a = self.followed
        force = device.force_checked(self.spacing, x, v, a, state, "total")
        return held(force, self.force.size)

    def in_band(self, values: Array) -> Array:
        """Values at the measured rate through the low-pass of the measured force, thinned."""
        steps = self.thinned * self.instants
        if is_slow(self.fine_spacing, self.cutoff, steps):
            return filtered_and_thinned(values, self.fine_spacing, self.cutoff, steps)
        return filtered(values, self._response)

    def weighted(self, values: Array, mask: NDArray[np.bool_], shaft: Shaft | None = None) -> Array:
        """Masked values as they count against noise, shape (n,); 0 elsewhere is taken for them.

        White noise of the displacement becomes one of b a whose power grows with the fourth power
        of the frequency: below the corner a residual counts in full, above ever less. Without that
        a model would win by predicting less of this noise. Near the resonance of a shaft a right
        model makes more of it than one without the shaft, and would lose by that; and a fit would
        find more damping than there is, to make less of it. So a model's own `shaft` sets what
        counts, in a run that has one: its weights are as large in the mean, and no model wins by
        the noise that it makes (the likelihood of a noise whose size is not known).

        What is beyond `far` counts by its logarithm: the sum of the squares is the Cauchy loss.
        """
        if np.isfinite(self.corner) and not mask.any():
            return np.zeros_like(values)
        if np.isfinite(self.corner) and np.isfinite(values).all():
            weight = self._weight if shaft is None else self._weight_of(shaft)
            values = apply_weight(np.where(mask, values, 0.0), weight)
        if np.isfinite(self.far):
            share = values / self.far
            values = self.far * np.sign(share) * np.sqrt(np.log1p(share**2))
        return values

    def force_later(self, late: float) -> float:
        """By how much the force is larger some time after the sample `first` [N]."""
        return self._force_about(late) - self._force_about(0.0)

    def _force_about(self, late: float) -> float:
        known: dict[float, float] = self.__dict__.setdefault("_forces_about", {})
        if late not in known:
            if len(known) > _MOST_TIMES:
                known.clear()
            width = FIRST / self.spacing
            window = np.linspace(-0.5, 0.5, max(1, round(width)) + 1) * width
            places = self.first + late / self.spacing + window
            known[late] = float(np.interp(places, np.arange(self.force.size), self.force).mean())
        return known[late]

    @property
    def sample_spacing(self) -> float:
        """Time between two samples as measured [s]."""
        return self.spacing / self.thinned

    @property
    def fine_spacing(self) -> float:
        """Time between two instants at which the force is followed [s]."""
        return self.spacing / (self.thinned * self.instants)

    # checked once, for the many devices that are tried along it
    @cached_property
    def followed(self) -> list[Array]:
        """Displacement, velocity, acceleration from the sample `first` on."""
        channels = (self.displacement, self.velocity, self.acceleration)
        return checked_motion(self.spacing, *(channel[self.first :] for channel in channels))

    @cached_property
    def path(self) -> Array:
        """Path slid since the sample `first` [m], shape (n,); 0 before."""
        slid = np.cumsum(np.abs(self.velocity)) * self.spacing
        return np.maximum(slid - slid[self.first], 0.0)

    @cached_property
    def _followed_finely(self) -> list[Array]:
        begin = self.first * self.thinned * self.instants
        x, v, a = (channel[begin:] for channel in self.measured or ())
        return checked_motion(self.fine_spacing, x, v, a)

    @cached_property
    def _response(self) -> Array:
        size = self.force.size if self.measured is None else self.measured[0].size
        return band_response(size, self.fine_spacing, self.cutoff)

    @cached_property
    def _weight(self) -> Array:
        return weight_above(self.force.size, self.spacing, self.corner, self.shaft, self.quiet)

    def _weight_of(self, shaft: Shaft) -> Array:
        if self.shaft is None or shaft == self.shaft:
            return self._weight
        weight = weight_above(self.force.size, self.spacing, self.corner, shaft, self.quiet)
        return weight * np.exp(self._mean_logarithm(self._weight) - self._mean_logarithm(weight))

    def _mean_logarithm(self, weight: Array) -> float:
        """Mean over the band of a weight's logarithm."""
        frequency = np.linspace(0.0, 0.5 / self.spacing, weight.size)
        return float(np.average(np.log(weight), weights=response(frequency, self.cutoff) ** 2))

    def gain(self, frequency: float) -> float:
        """What the low-pass leaves of a tone."""
        if np.isinf(self.cutoff):
            return 1.0
        return float(response(np.array([frequency]), self.cutoff)[0])

    @cached_property
    def elapsed(self) -> Array:
        """Time since the clock began [s], shape (n,)."""
        return self.time - self.clock

    @property
    def zero(self) -> float:
        """Elapsed time [s] from which the drift of the force counts."""
        return 0.0 if self.zeroed is None else self.zeroed - self.clock

    @cached_property
    def fine_elapsed(self) -> Array:
        """The same at the measured rate, shape (m,)."""
        size = self.force.size if self.measured is None else self.measured[0].size
        return self.start - self.clock + self.fine_spacing * np.arange(size, dtype=float)

    @property
    def time(self) -> Array:
        """Times of the samples [s], shape (n,)."""
        return self.start + self.spacing * np.arange(self.force.size, dtype=float)


def thin(motion: Motion, rate: float | None = None, force_band: float = 0.0) -> BenchRun:
    """A run for fitting: force low-passed like the motion, thinned to the rate its band needs.

    `rate` [Hz] overrides the rate; None takes `SAMPLES_PER_PERIOD` times the cut-off. A
    `force_band` [Hz] above the motion's cut-off takes its place for the force.
    """
    cutoff = max(motion.cutoff, force_band)
    rate = rate or SAMPLES_PER_PERIOD * cutoff
    step = max(1, int(1 / (rate * motion.spacing)))
    first = int(np.argmax(motion.inner[::step]))
    force = filtered_and_thinned(motion.force, motion.spacing, cutoff, step)
    velocity = np.where(_resting(motion), 0.0, motion.velocity)
    measured = (motion.displacement, velocity, motion.acceleration)
    if motion.instants > 1:
        measured = between(motion.spacing, measured, motion.instants)
    inner = motion.inner[::step]
    if motion.part and first:
        # what the force was before is not followed, and the low-pass remembers it
        inner = inner.copy()
        inner[: first + int(EDGE_PERIODS / cutoff / (motion.spacing * step))] = False
    return BenchRun(
        name=motion.name,
        start=motion.start,
        spacing=motion.spacing * step,
        displacement=np.ascontiguousarray(motion.displacement[::step]),
        velocity=np.ascontiguousarray(motion.velocity[::step]),
        acceleration=np.ascontiguousarray(motion.acceleration[::step]),
        force=force,
        inner=inner,
        first_force=_force_at(motion, first * step),
        cutoff=cutoff,
        measured=measured,
        thinned=step,
        instants=motion.instants,
        first=first,
        clock=motion.clock,
        zeroed=motion.zeroed,
        quiet=motion.cutoff if cutoff > motion.cutoff else np.inf,
        motion=motion.motion,
        part=motion.part,
    )


def forces_along(
    device: Device, spacing: float, motion: Sequence[Array], state: float | Array, size: int
) -> dict[str, Array]:
    """Total and friction force of a device along a checked motion that may begin late, (size,)."""
    x, v, a = motion
    found = device.along_checked(spacing, x, v, a, state)
    return {name: held(found[name], size) for name in ("total", "friction")}


def held(values: Array, count: int) -> Array:
    """Values that begin late, the first one held before them, shape (count,)."""
    missing = count - values.size
    return np.concatenate([np.full(missing, values[0]), values]) if missing else values


def _force_at(motion: Motion, index: int) -> float:
    """Mean measured force over 10 ms [N], at the beginning from it on, else around the sample."""
    width = max(1, round(FIRST / motion.spacing))
    begin = max(0, index - width // 2) if index else 0
    return float(np.mean(motion.force[begin : begin + width]))


def _resting(motion: Motion) -> NDArray[np.bool_]:
    """Stretches longer than the smoother's memory in which the velocity is within its noise."""
    slow = np.abs(motion.velocity) < REST * motion.velocity_noise
    return long_stretches(slow, motion.spacing, motion.cutoff)


def whole(motion: Motion) -> BenchRun:
    """A run at the record's own rate with the force as measured: what figures are reported on."""
    first = int(np.argmax(motion.inner))
    measured = (motion.displacement, motion.velocity, motion.acceleration)
    fine = between(motion.spacing, measured, motion.instants) if motion.instants > 1 else None
    return BenchRun(
        name=motion.name, start=motion.start, spacing=motion.spacing,
        displacement=motion.displacement, velocity=motion.velocity,
        acceleration=motion.acceleration, force=motion.force, inner=motion.inner,
        first_force=_force_at(motion, first), first=first, cutoff=np.inf,
        measured=fine, instants=motion.instants,
        clock=motion.clock, zeroed=motion.zeroed, motion=motion.motion, part=motion.part,
    )  # fmt: skip


def from_first(run: BenchRun) -> BenchRun:
    """The part of a run at the measured rate whose motion is known from the beginning."""
    arrays = ("displacement", "velocity", "acceleration", "force", "inner")
    part = {name: getattr(run, name)[run.first :] for name in arrays}
    if run.measured is not None:
        x, v, a = (channel[run.first * run.instants :] for channel in run.measured)
        part["measured"] = (x, v, a)
    return replace(run, **part, start=run.start + run.first * run.spacing, first=0)


def head_size(run: BenchRun, share: float) -> int:
    """Number of samples in the first part of a run, counted from where it is followed on."""
    left = run.force.size - run.first
    return run.first + max(int(share * left), min(200, left))


def head(run: BenchRun, share: float) -> BenchRun:
    """The first part of a run."""
    n = head_size(run, share)
    arrays = ("displacement", "velocity", "acceleration", "force", "inner")
    part = {name: getattr(run, name)[:n] for name in arrays}
    if run.measured is not None:
        x, v, a = (channel[: (n - 1) * run.thinned * run.instants + 1] for channel in run.measured)
        part["measured"] = (x, v, a)
    return replace(run, **part)


def scales(runs: Sequence[BenchRun]) -> Scales:
    """Typical sizes of the channels over all runs."""

    def size(channel: str) -> float:
        # across a gap the motion is a guess, and may swing far out
        values = np.concatenate([getattr(run, channel)[run.inner] for run in runs])
        return size_of(values, channel in ("velocity", "acceleration"))

    x, a = (
        np.concatenate([getattr(run, name)[run.inner] for run in runs])
        for name in ("displacement", "acceleration")
    )
    correlation = float(np.corrcoef(x, a)[0, 1]) if np.ptp(x) > 0 and np.ptp(a) > 0 else 0.0
    travel, forces = (
        (float(min(np.min(c) for c in channels)), float(max(np.max(c) for c in channels)))
        for channels in (
            [getattr(run, name)[run.inner] for run in runs if run.inner.any()]
            for name in ("displacement", "force")
        )
    )
    return Scales(
        force=size("force"),
        displacement=size("displacement"),
        velocity=size("velocity"),
        acceleration=size("acceleration"),
        cutoff=min(run.cutoff for run in runs),
        one_tone=correlation**2 > ONE_TONE or has_one_line(runs),
        travel=travel,
        # not of the travel: one large stroke to one side moves that beyond a stop
        middle=float(np.mean(np.quantile(x, (0.25, 0.75)))),
        elapsed=max(float(run.elapsed[-1]) for run in runs),
        run_length=max(float(np.ptp(run.time)) for run in runs),
        force_range=forces,
    )


def on_clocks(runs: Sequence[BenchRun]) -> list[BenchRun]:
    """Runs that share one clock where their times do not overlap, else each with its own.

    Parts of a run know its clock.
    """
    if any(run.part for run in runs):
        return list(runs)
    order = sorted(runs, key=lambda run: run.start)
    apart = all(a.time[-1] <= b.start for a, b in itertools.pairwise(order))
    return [replace(run, clock=order[0].start if apart else run.start) for run in runs]
