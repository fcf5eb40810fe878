"""The force that a model predicts for a run's force channel."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from inerter.catalogue.coordinates import COORDINATES
from inerter.core import Device
from inerter.identify.channel import (
    LIMITS,
    clips,
    delayed,
    through_channel,
    without_limits,
    without_tone,
)
from inerter.identify.channel_filter import (
    Filter,
    filter_of,
    filtered,
    slow_start,
    without_start,
)
from inerter.identify.first_slip import flywheel_speed
from inerter.identify.force_parts import RUNAWAY, is_sum, sharp_force, smooth_force, states_of
from inerter.identify.forgetting import Forgetting, held
from inerter.identify.model import Model
from inerter.identify.runs import BenchRun, forces_along
from inerter.identify.transient import (
    MOST_STROKES,
    most_bent,
    relaxing,
    swings_freely,
    without_bending,
    without_relaxing,
    without_transient,
)

Array = NDArray[np.float64]

# of a channel that does not clip, as `LIMITS` are
_NO_LIMITS = (np.inf, -np.inf)
# share of what the bristle holds from which on the first force tells the side of its free play
_TELLING = 0.1


def first_state(
    device: Device,
    run: BenchRun,
    place: float = 0.0,
    pressed: float = 0.0,
    late: float = 0.0,
    mass: float = 0.0,
) -> float | Array:
    """State at a run's sample `first`, read off the force, within what the friction law can hold.

    A force near 0 does not tell where in a free play before the friction a run begins: that is the
    `place`, -1 ... 1 of half the play. A number for a device with at most one state, else an array
    (nstate,). `pressed` [N] is added to the force, which the channel shows so `late` [s], and with
    it that of a `mass` [kg] before the device.
    """
    if device.nstate == 0:
        return 0.0
    i = run.first
    force = run.first_force + pressed + (run.force_later(late) if late else 0.0)
    force -= mass * float(run.acceleration[i])
    state = device.state_of_force(run.displacement[i], run.velocity[i], run.acceleration[i], force)
    if device.series_stiffness:
        state = _twisted(device, run, np.atleast_1d(state))
    if device.clutch_force:
        state = np.atleast_1d(state)
        state[device.state_names.index("flywheel_velocity")] = flywheel_speed(device, run)
    if not device.friction_backlash:
        return state
    bent, side = _bent(device, float(np.atleast_1d(state)[0]))
    told = min(1.0, abs(bent) / (_TELLING * held(device)))
    found = bent + device.friction_backlash * (told * side + (1.0 - told) * place)
    return np.array([found, *np.atleast_1d(state)[1:]]) if device.nstate > 1 else found


def begin(
    device: Device, run: BenchRun, values: Mapping[str, float], pressed: float = 0.0
) -> float | Array:
    """`first_state` as these coordinates have it."""
    place, mass = values.get("friction_place", 0.0), values.get("grip_mass", 0.0)
    return first_state(device, run, place, pressed, lateness(values), mass)


def _twisted(device: Device, run: BenchRun, states: Array) -> Array:
    """States whose series deflection may be one of the run.

    More of it would be an oscillation that nothing in the run excites, by which a shaft without
    stiffness carries any slow force.
    """
    most = MOST_STROKES * np.ptp(run.displacement) + device.backlash
    at = device.state_names.index("series_deflection")
    states[at] = np.clip(states[at], -most, most)
    return states


def _bent(device: Device, state: float) -> tuple[float, float]:
    """Deflection of the bristle [m] behind its free play, and its side, -1, 0 or 1."""
    half = device.friction_backlash
    return state - min(max(state, -half), half), float((state > 0) - (state < 0))


def force_along(model: Model, run: BenchRun, pressed: float = 0.0) -> Array:
    """Force that the model predicts for a run's force channel, shape (n,).

    States begin where the run's first force and `pressed` [N] put them.

    What is not smooth in the motion has to pass the low-pass of the measured force: only what it
    adds to the smooth terms, so that these carry the same noise of the motion in every model.
    """
    device = model.device()
    run, values = with_late_motion(model, run)
    state, motion = begin(device, run, values, pressed), _motion_of(run)
    rough = model.has_jumps or device.friction != "none" or device.has_load_friction
    drift = values.get("friction_drift", 0.0)
    if np.isinf(run.cutoff) or not rough:

        def along(each: Device) -> dict[str, Array]:
            return run.along(each, state)

        if drift:
            total = with_friction_drift(device, drift, along, run.elapsed)
        else:
            total = run.thinned_force(device, state)
        total = total + felt_beside(device, values, motion, run.elapsed)
        return through_channel(values, total, run.elapsed - run.zero, run.spacing)

    if is_sum(model):
        sharp = sharp_force(model, run, state, drift)
        if not np.isfinite(sharp[-1]):
            # hysteresis that hardens without end
            return np.full(run.force.size, np.inf)
        beside = felt_beside(device, values, motion, run.elapsed)
        total = smooth_force(model, run, state) + beside + sharp
        return through_channel(values, total, run.elapsed - run.zero, run.spacing)

    rest, part = states_of(model.smooth_part, model, state), model.smooth_part.device
    smooth = forces_along(part, run.spacing, run.followed, rest, run.force.size)["total"]
    smooth = smooth + felt_beside(device, values, motion, run.elapsed)
    found = run.at_measured_rate(device, state)
    if not abs(found["friction"][-1]) < RUNAWAY:
        # hysteresis that hardens without end: nothing that could be low-passed
        return np.full(run.force.size, np.inf)
    law = found["friction"]
    if drift and device.has_load_friction:
        law = run.at_measured_rate(_without_load(device), state)["friction"]
    if not clips(values):
        # such a channel is linear: what it does to the sum may wait until that is in the band
        rough = found["friction"]
        if model.has_jumps:
            rough = found["total"] - run.at_measured_rate(part, rest)["total"]
        total = smooth + run.in_band(rough)
        if drift:
            total = total + drift * run.elapsed * run.in_band(law)
        return through_channel(values, total, run.elapsed - run.zero, run.spacing)
    times, spacing = run.fine_elapsed, run.fine_spacing
    total = found["total"] + drift * times * law if drift else found["total"]
    plain, less = without_limits(values), run.at_measured_rate(part, rest)["total"]
    if run.measured is not None:
        beside = felt_beside(device, values, run.measured, times)
        total, less = total + beside, less + beside
    added = through_channel(values, total, times - run.zero, spacing)
    added = added - through_channel(plain, less, times - run.zero, spacing)
    return through_channel(plain, smooth, run.elapsed - run.zero, run.spacing) + run.in_band(added)


def beyond_limits(model: Model, run: BenchRun) -> NDArray[np.bool_]:
    """Where a channel that clips shows a limit, at the rate at which the force passes it, (m,)."""
    device, (run, values) = model.device(), with_late_motion(model, run)
    state = begin(device, run, values)
    motion, elapsed, spacing = _motion_of(run), run.elapsed, run.spacing
    fine = run.measured if np.isfinite(run.cutoff) else None
    if fine is not None:
        motion, elapsed, spacing = fine, run.fine_elapsed, run.fine_spacing

    def along(each: Device) -> dict[str, Array]:
        return run.along(each, state) if fine is None else run.at_measured_rate(each, state)

    drift = values.get("friction_drift", 0.0)
    total = with_friction_drift(device, drift, along, elapsed)
    total = total + felt_beside(device, values, motion, elapsed)
    shown = through_channel(without_limits(values), total, elapsed - run.zero, spacing)
    upper, lower = (values.get(name, limit) for name, limit in zip(LIMITS, _NO_LIMITS, strict=True))
    return (shown > upper) | (shown < lower)


def lateness(values: Mapping[str, float]) -> float:
    """Time by which a force channel with these coordinates shows what is slow late [s]."""
    low_pass = filter_of(values, "force")
    return values.get("delay", 0.0) + (low_pass.lateness if low_pass else 0.0)


def moves_late(values: Mapping[str, float], run: BenchRun) -> bool:
    """Whether a delay has to be in the motion, see `with_late_motion`."""
    return bool(values.get("delay") and "backlash" in values and np.isinf(run.cutoff))


def with_late_motion(model: Model, run: BenchRun) -> tuple[BenchRun, Mapping[str, float]]:
    """A run and coordinates whose delay is in the motion, where it has to be; else as they are.

    A filter of the displacement channel is taken out of the motion.

    A flywheel that lands has a force between samples that none of them shows: a delayed force would
    be read off those. The motion is smooth.
    """
    run = before_filter(run, model.values)
    if not moves_late(model.values, run):
        return run, model.values
    values, h = dict(model.values), run.spacing
    delay = values.pop("delay")
    more = int(abs(delay) / h) + 2
    before, after = h * np.arange(-more, 0), h * np.arange(1, more + 1)
    inner = slice(more, more + run.displacement.size)

    def late(*derivatives: Array) -> Array:
        # beyond the ends the motion goes on as it is there
        first, last = (
            sum(channel[end] * t**k / (1, 1, 2)[k] for k, channel in enumerate(derivatives))
            for end, t in ((0, before), (-1, after))
        )
        return delayed(np.concatenate([first, derivatives[0], last]), delay, h)[inner]

    x, v, a = run.displacement, run.velocity, run.acceleration
    return replace(
        run, displacement=late(x, v, a), velocity=late(v, a), acceleration=late(a)
    ), values


# runs by identity and filter, as many as fit: a fit asks for many forces along each
_BEFORE_FILTER: dict[tuple[tuple[int, int], Filter], BenchRun] = {}
_MOST_RUNS, _MOST_SAMPLES = 32, 2**20


def before_filter(run: BenchRun, values: Mapping[str, float]) -> BenchRun:
    """A run with the motion before the filter of its displacement, where coordinates have one."""
    low_pass = filter_of(values, "displacement")
    if low_pass is None:
        return run
    kept, key = _BEFORE_FILTER, (run.identity, low_pass)
    found = kept.get(key)
    if found is None:
        found = unfiltered(run, low_pass)
        samples = sum(
            each.displacement.size * each.thinned * each.instants for each in kept.values()
        )
        if samples > _MOST_SAMPLES:
            kept.clear()
        elif len(kept) == _MOST_RUNS:
            kept.pop(next(iter(kept)))
        kept[key] = found
    return found


def unfiltered(run: BenchRun, low_pass: Filter) -> BenchRun:
    """A run whose displacement channel went through a filter, with the motion before that."""

    def before(channels: Sequence[Array], spacing: float) -> list[Array]:
        return [filtered(channel, spacing, low_pass, inverse=True) for channel in channels]

    x, v, a = before((run.displacement, run.velocity, run.acceleration), run.spacing)
    measured = run.measured
    if measured is not None:
        fine = before(measured, run.fine_spacing)
        measured = (fine[0], fine[1], fine[2])
    return replace(run, displacement=x, velocity=v, acceleration=a, measured=measured)


def with_friction_drift(
    device: Device, drift: float, along: Callable[[Device], dict[str, Array]], elapsed: Array
) -> Array:
    """Total force of a device whose friction level changes with time [N], shape (n,).

    What changes is the level of the friction law, not what the load adds; `along` gives the forces.
    """
    found = along(device)
    if not drift:
        return found["total"]
    law = along(_without_load(device)) if device.has_load_friction else found
    return found["total"] + drift * elapsed * law["friction"]


def felt_beside(
    device: Device, values: Mapping[str, float], motion: Sequence[Array], elapsed: Array
) -> Array | float:
    """What is felt beside a device that does not change with time [N], shape (n,).

    That is of viscous damping what time adds, and a mass that moves with the terminal; `motion` is
    displacement, velocity and acceleration.
    """
    drift, mass = values.get("viscous_drift", 0.0), values.get("grip_mass", 0.0)
    _, velocity, acceleration = motion
    added = drift * elapsed * device.viscous * velocity if drift else 0.0
    return added + mass * acceleration if mass else added


def _motion_of(run: BenchRun) -> tuple[Array, Array, Array]:
    return run.displacement, run.velocity, run.acceleration


def _without_load(device: Device) -> Device:
    load = ("load_friction", *COORDINATES["load_friction"].also)
    given = {name: value for name, value in device.given.items() if name not in load}
    return Device(**given)


def settled(model: Model, run: BenchRun, residual: Array, mask: NDArray[np.bool_]) -> Array:
    """A residual without what only the record itself can tell, read off its masked samples.

    That is how the flywheel turned as the record began, what branches were bent by, a low-pass or a
    delay held then, and the phase of a tone. Of a run left out of a fit (nothing masked) everything
    is read off the run.
    """
    mask = mask if mask.any() else run.inner
    device, values = model.device(), model.values
    if not np.isfinite(residual).all():
        return residual
    if swings_freely(device):
        speed = float(np.max(np.abs(run.velocity)))
        # behind a leak it dies away too soon to be counted from elsewhere than where it begins
        begin = run.first if device.leak_damping else 0
        bare = without_transient(
            device, residual[begin:], run.spacing, mask[begin:], speed, run.first - begin
        )
        residual = np.concatenate([residual[:begin], bare])
    forgets = Forgetting.of(device)
    residual = without_bending(forgets.path(run), forgets.reach, residual, mask, run.first)
    residual = without_relaxing(
        relaxing(values), residual, run.spacing, mask, run.first, run.cutoff,
        most_bent(values, float(np.ptp(run.displacement))),
    )  # fmt: skip
    if (low_pass := slow_start(values)) is not None:
        residual = without_start(residual, run.spacing, mask & run.inner, low_pass, run.first)
    if amplitude := values.get("disturbance_amplitude", 0.0):
        frequency = values["disturbance_frequency"]
        seen = amplitude * run.gain(frequency)
        residual = without_tone(residual, run.elapsed, mask, seen, frequency)
    return residual
