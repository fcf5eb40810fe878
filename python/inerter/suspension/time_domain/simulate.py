"""Indices of many designs on many roads, and gains under a sinusoidal load.

    J1 = sqrt(mean zs''^2),   J3 = sqrt(mean Fr^2)                               over a road
    Fr = kt (zu - zr) + ct (zu' - zr')
    gain(w) = sqrt(int zs^2 / int Fs^2)                                          Fs = A sin(w t)

zs is the body above a wheel, zu the wheel; with several axles the mean is also over them, each on
the road of the first one, later by its distance over the speed. Under a load zs is the body where
the load stands, of a half-car its centre of mass.

Means over one whole period of the road, or whole periods of the load, after `settle` seconds that
begin from rest and fade the input in. They are summed while the simulations run: memory does not
grow with the number of roads or designs.

The road is held over a step (see `road.py`). What it does to the tyre and, through a rigid
inertance in S2, to the body *at once* is put right at every instant with the road's own value
there. Frequencies beyond half the sampling rate (500 Hz at 1 ms) are not simulated: body and wheel
move by less than 1e-3 of their height. What they do at once is added to the mean squares in closed
form, so that the indices do not depend on the step.

A tyre that is one-sided (`compiled`) presses by at most its static load less than at rest: beyond
that it is off the road, and Fr is the static load.

RK4 needs nothing more at its default step. discrete (S3 with an elastic shaft, whose node has
no mass) is of first order: mean squares from steps h and h/2 are extrapolated, 2 S(h/2) - S(h),
with h half the step of RK4, a quarter of it for the half-car, whose struts are softer against
their wheels and tyres.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from inerter.suspension.time_domain.car_model import CarModel
from inerter.suspension.time_domain.design import Design
from inerter.suspension.time_domain.road import PeriodicRoad, correlations, track
from inerter.suspension.time_domain.signals import (
    Kept,
    gain_of,
    index_of,
    kept_of,
    signal_of,
)
from inerter.suspension.time_domain.stepping import step_all

Array = NDArray[np.float64]
Progress = Callable[[float], None]

FADE = 1.0
"""Seconds over which an input is faded in."""

_LOAD_BLOCK = 16

# numbers of whole signals at a time
_HELD = 2**24

BESIDE = ("travel_rms", "lift_off", "tyre_peak", "travel_peak")
"""What a simulation of a road gives beside its indices."""

_ROWS = ("J1", "J3", *BESIDE)


@dataclass(frozen=True, kw_only=True)
class RunSettings:
    """How simulations are run; results do not depend on `jobs` and `block`.

    `step` [s] of RK4, the largest one; discrete takes fractions of it. `settle` [s]
    before the means begin. `jobs` threads, 0 for every processor. `block` simulations at a time.

    Raises
    ------
    ValueError
        A value out of range.
    """

    step: float = 1e-3
    settle: float = 4.0
    jobs: int = 0
    block: int = 128

    def __post_init__(self) -> None:
        """Check what was given, see Raises."""
        if not 0.0 < self.step <= 5e-3:
            raise ValueError(f"step is {self.step:g} s: give one above 0, up to 0.005")
        if not (math.isfinite(self.settle) and self.settle >= FADE):
            raise ValueError(f"settle is {self.settle:g} s: give {FADE:g} or more")
        if self.jobs < 0 or self.block < 1:
            raise ValueError("jobs and block: give 0 or more threads, 1 or more simulations")


def road_indices(
    car: CarModel,
    designs: Sequence[Design],
    road: PeriodicRoad,
    seeds: Sequence[int],
    settings: RunSettings | None = None,
    progress: Progress | None = None,
    indices: Sequence[str] = ("J1", "J3"),
) -> dict[str, Array]:
    """Indices of every design on every road.

    Parameters
    ----------
    car
        The model.
    designs, seeds
        Every pair of them is a simulation.
    road
        Of which the seeds choose the phases.
    settings
        Step, settling, threads.
    progress
        Called with the share that is done.
    indices
        Names in `INDICES` but J5; also a user's own.

    Returns
    -------
    dict of ndarray (designs, seeds)
        "J1" [m/s^2], "J3" [N] and what of `indices` is beside, SI units; "travel_rms",
        "travel_peak" [m] of the struts; "lift_off", the share of time that a tyre is off the road,
        or would have to pull, mean of the wheels; "tyre_peak"
        [N], the largest dynamic force that presses a tyre.

    Raises
    ------
    ValueError
        A design that cannot be, or that diverges (`StepError`).
    """
    settings = settings or RunSettings()
    tell = progress or (lambda share: None)
    pairs = [(d, s) for s in range(len(seeds)) for d in range(len(designs))]
    kept = kept_of(indices)
    rows = (*_ROWS, *kept)
    squares = np.empty((len(rows), len(designs), len(seeds)))
    for design in designs:
        car.refuse(design, settings.step)
    block = settings.block
    if kept:
        # whole signals are held in memory
        finest = settings.step / (2 * car.fineness if car.implicit else 1)
        one = road.period / finest * len(car.wheels) * len(kept)
        block = max(1, min(block, int(_HELD / one)))
    for start in range(0, len(pairs), block):
        part = pairs[start : start + block]
        chosen, drawn = [designs[d] for d, _ in part], [seeds[s] for _, s in part]

        def at(step: float, chosen: list[Design] = chosen, drawn: list[int] = drawn) -> Array:
            return _road_squares(car, chosen, road, drawn, step, settings, kept)

        d, s = np.array(part).T
        squares[:, d, s] = _extrapolated(car, settings.step, at)
        tell((start + len(part)) / len(pairs))
    found = dict(zip(rows, squares, strict=True))
    rms = {name: np.sqrt(found.pop(name)) for name in ("J1", "J3", "travel_rms", *kept)}
    parts = {**rms, "travel": rms["travel_rms"]}
    beside = {name: rms[name] for name in ("J1", "J3", "travel_rms")}
    asked = {name: index_of(name, parts) for name in indices}
    return {**asked, **beside, **found, "lift_off": np.clip(found["lift_off"], 0.0, 1.0)}


def load_gains(
    car: CarModel,
    designs: Sequence[Design],
    frequencies: ArrayLike,
    amplitude: float = 1000.0,
    settings: RunSettings | None = None,
) -> Array:
    """Root of the energy ratio of body displacement and load [m/N], after the transient.

    Parameters
    ----------
    car, designs
        The model, and the designs.
    frequencies
        [Hz], shape (designs, n).
    amplitude
        A [N] of the load on the body.
    settings
        Step, settling, threads.

    Returns
    -------
    ndarray (designs, n)
        The gains.

    Raises
    ------
    ValueError
        A design that cannot be, or that diverges (`StepError`); a value that is not positive.
    """
    settings = settings or RunSettings()
    table = np.asarray(frequencies, dtype=np.float64)
    if table.ndim != 2 or len(table) != len(designs) or not np.all(table > 0.0):
        raise ValueError("frequencies: give positive ones, a row for each design")
    if not amplitude > 0.0:
        raise ValueError(f"amplitude is {amplitude:g} N: give a positive number")
    for design in designs:
        car.refuse(design, settings.step)

    # low frequencies take longest: few and alike ones run together
    size = min(settings.block, _LOAD_BLOCK)
    row, column = np.unravel_index(np.argsort(table, axis=None), table.shape)
    squares = np.empty(table.shape)
    for start in range(0, table.size, size):
        r, c = (index[start : start + size] for index in (row, column))
        chosen = [designs[i] for i in r]

        def at(step: float, chosen: list[Design] = chosen, f: Array = table[r, c]) -> Array:
            return _load_squares(car, chosen, f, amplitude, step, settings)

        squares[r, c] = _extrapolated(car, settings.step, at)
    return np.sqrt(squares)


def _extrapolated(car: CarModel, step: float, at: Callable[[float], Array]) -> Array:
    """Mean squares without the error of first order, where the integrator has one."""
    if not car.implicit:
        return at(step)
    return 2.0 * at(0.5 * step / car.fineness) - at(step / car.fineness)


def _road_squares(
    car: CarModel,
    designs: Sequence[Design],
    road: PeriodicRoad,
    seeds: Sequence[int],
    step: float,
    settings: RunSettings,
    kept: tuple[str, ...],
) -> Array:
    """Means of `_ROWS` and `kept` over time and axles, shape (rows, simulations)."""
    # a whole number of steps makes the period
    count = math.ceil(road.period / step - 1e-9)
    step = road.period / count
    settle = math.ceil(settings.settle / step)
    seen = _once(seeds)
    behind = [wheel.behind for wheel in car.wheels]
    # shape (roads, count, wheels)
    sides, shared = [wheel.side for wheel in car.wheels], getattr(car.car, "correlation", 1.0)
    leads = [wheel.lead for wheel in car.wheels]
    places = list(zip([road.led(lead) for lead in leads], behind, sides, strict=True))

    def tracks(make: str) -> Array:
        each = [
            [track(getattr(own, make), seed, count, x, s, shared) for own, x, s in places]
            for seed in seen
        ]
        return np.moveaxis(np.array(each), 1, 2)

    # with what a tyre's damper adds of the road's rate
    shown = tracks("instants")
    driven = shown if car.implicit else tracks("held")
    which = [seen.index(seed) for seed in seeds]
    kt = np.array([wheel.tyre_stiffness for wheel in car.wheels])
    ct = np.array([wheel.tyre_damping for wheel in car.wheels])
    # accelerations per height of the road, (simulations, points, wheels)
    at_once = np.array([car.accelerations_per_force(design) * kt for design in designs])

    def control(first: int, number: int) -> Array:
        steps = np.arange(first, first + number)
        return driven[:, (steps - settle) % count][which] * _fade(steps * step)[:, None]

    loads = np.array([wheel.static_load for wheel in car.wheels])
    sums = np.zeros((4, len(designs)))
    peaks = np.zeros((2, len(designs)))
    whole = Kept(kept, car, len(designs), count) if kept else None
    steps = np.full(len(designs), step)
    roads = [wheel.road for wheel in car.wheels]
    for chunk in step_all(car, designs, steps, settle + count, roads, control, settings.jobs):
        skip = max(settle - chunk.first, 0)
        now = np.arange(chunk.first + skip, chunk.first + chunk.body.shape[1]) - settle
        if now.size == 0:
            continue
        height = shown[:, now][which]
        sudden = height - chunk.control[:, skip:]
        # tension positive, as in the paper
        force = kt * (chunk.wheels[:, skip:] - height) + ct * chunk.rates[:, skip:]
        off = force >= loads
        corrected = chunk.accelerations[:, skip:]
        if car.one_sided:
            sudden, force = np.where(off, 0.0, sudden), np.minimum(force, loads)
        corrected = corrected + sudden @ at_once.transpose(0, 2, 1)
        sums[0] += _squares(corrected)
        sums[1] += _squares(force)
        sums[2] += _squares(chunk.travels[:, skip:])
        sums[3] += off.sum(axis=(1, 2))
        highest = [-force.min(axis=(1, 2)), np.abs(chunk.travels[:, skip:]).max(axis=(1, 2))]
        peaks = np.maximum(peaks, highest)
        if whole is not None:
            whole.add(int(now[0]), corrected, force, chunk.travels[:, skip:])
    # sinusoids too quick for the step move nothing; they press the tyres
    rest = road.left_out(count, behind, leads=leads) * correlations(sides, shared)
    quick = np.einsum("spw,wv,spv->s", at_once, rest, at_once)
    points, wheels = at_once.shape[1:]
    felt = np.zeros((0, len(designs)))
    if whole is not None:
        felt = whole.mean_squares(step)
        for n, name in enumerate(kept):
            beyond = road.left_out(count, behind, partial(gain_of, name), leads)
            beyond = beyond * correlations(sides, shared)
            if signal_of(name) == "J3":
                felt[n] += float(np.sum(kt**2 * np.diag(beyond))) / wheels
            elif signal_of(name) != "travel":
                turned = whole.rows[signal_of(name)] @ at_once
                felt[n] += np.einsum("spw,wv,spv->s", turned, beyond, turned) / turned.shape[1]
    return np.array(
        [
            (sums[0] / count + quick) / points,
            (sums[1] / count + float(np.sum(kt**2 * np.diag(rest)))) / wheels,
            sums[2] / count / wheels,
            sums[3] / count / wheels,
            *peaks,
            *felt,
        ]
    )


def _load_squares(
    car: CarModel,
    designs: Sequence[Design],
    frequencies: Array,
    amplitude: float,
    step: float,
    settings: RunSettings,
) -> Array:
    """Mean square of zs per mean square of the load, shape (simulations,)."""
    # whole periods of whole steps: at least two of them, and a second
    per_period = np.ceil(1.0 / (frequencies * step) - 1e-9)
    per_period = np.maximum(per_period, 24.0)
    steps = 1.0 / (frequencies * per_period)
    begin = np.ceil(settings.settle * frequencies) * per_period
    length = np.maximum(np.ceil(frequencies), 2.0) * per_period
    turn = 2.0 * np.pi / per_period[:, None]
    # RK4 holds the load over the step, discrete takes it at its beginning
    shift, gain = (0.0, amplitude) if car.implicit else (0.5, amplitude / np.sinc(1 / per_period))
    gain = np.broadcast_to(gain, per_period.shape)[:, None]

    def control(first: int, number: int) -> Array:
        index = np.arange(first, first + number)
        wave = gain * np.sin(turn * (index + shift))
        return (wave * _fade(index * steps[:, None]))[:, :, None]

    sums = np.zeros(len(designs))
    count = int((begin + length).max())
    for chunk in step_all(car, designs, steps, count, [car.load], control, settings.jobs):
        index = np.arange(chunk.first, chunk.first + chunk.body.shape[1])
        inside = (index >= begin[:, None]) & (index < (begin + length)[:, None])
        sums += _squares(np.where(inside, chunk.body, 0.0))
    return sums / length / (0.5 * amplitude**2)


def _fade(times: NDArray[Any]) -> Array:
    """0 to 1 over the first second, smoothly."""
    return 0.5 - 0.5 * np.cos(np.pi * np.minimum(times / FADE, 1.0))


def _squares(values: Array) -> Array:
    """Sum of squares of each simulation."""
    return np.square(values).reshape(len(values), -1).sum(axis=1)


def _once(seeds: Sequence[int]) -> list[int]:
    """The seeds without repetition, in their order."""
    return list(dict.fromkeys(seeds))
