"""What happens to the force on its way into the record, and what depends on the clock.

    F_c = F(t - delay) + d_f e F_friction + d e + A sin(2 pi f e + phase)
    F_r = F_c through a low-pass, where there is one
    recorded: F_r and its noise, kept between force_minimum and force_maximum

Symbols: e [s] time since the start of the clock, d_f `friction_drift` [1/s], d `force_drift`
[N/s], A `disturbance_amplitude` [N], f `disturbance_frequency` [Hz]; the phase is a run's own.
The low-pass: cut-off `force_filter` [Hz] at -3 dB, `force_filter_order`, Bessel where
`force_filter_bessel` is 1 and Butterworth where it is 0. It is integrated as the differential
equation that it is, on a grid fine enough for it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.signal import bessel, butter, lfilter, residue

from .bench_motions import Drive
from .device import ReferenceDevice
from .laws import clutch
from .motion import Response, Signal, response
from .sizes import rounded

Array = NDArray[np.float64]

# a flywheel on a shaft swings itself in before a record starts [s]
SWING_IN = 2.0
# steps of a low-pass in a period of its cut-off, and periods that it remembers
STEPS_PER_PERIOD = 60
MEMORY = 8.0
_COLUMNS = ("time", "displacement", "velocity", "acceleration", "state", "force", "states")


@dataclass(frozen=True, kw_only=True)
class Channel:
    """The force channel and the clock; every default leaves the force as it is."""

    delay: float = 0.0
    friction_drift: float = 0.0
    viscous_drift: float = 0.0
    force_drift: float = 0.0
    disturbance_amplitude: float = 0.0
    disturbance_frequency: float = 0.0
    force_minimum: float = -np.inf
    force_maximum: float = np.inf
    force_filter: float = 0.0
    force_filter_order: float = 0.0
    force_filter_bessel: float = 0.0

    def clip(self, force: Array) -> Array:
        """The force [N] within the sensor's range, same shape."""
        return np.clip(force, self.force_minimum, self.force_maximum)


@dataclass(frozen=True)
class Situation:
    """A run's motion, when it starts on its clock [s], and the disturbance's phase [rad]."""

    drive: Drive
    start: float
    phase: float


def answers(
    device: ReferenceDevice, channel: Channel, runs: list[Situation], rtol: float = 1e-10
) -> list[Response]:
    """Each run as its channel gives it: no noise, not clipped; times as the device sees them."""
    found = []
    for run in runs:
        times, every, lead = _grid(channel, run.drive)
        truth = _moved(device, run.drive, times - channel.delay, rtol)
        elapsed = times + run.start
        friction = device.friction_force(
            truth.displacement,
            truth.velocity,
            device.state_argument(truth.states),
            a=truth.acceleration,
        )
        tone = np.sin(2.0 * np.pi * channel.disturbance_frequency * elapsed + run.phase)
        force = (
            truth.force
            + channel.friction_drift * elapsed * friction
            + channel.viscous_drift * elapsed * device.viscous * truth.velocity
            + channel.force_drift * elapsed
            + channel.disturbance_amplitude * tone
        )
        if channel.force_filter:
            force = low_passed(channel, times, force)
        rows = slice(lead, None, every)
        kept = {name: getattr(truth, name)[rows] for name in _COLUMNS}
        kept |= {"time": truth.time[rows] + run.start, "force": force[rows]}
        found.append(replace(truth, **kept))
    return found


def shown(channel: Channel, drive: Drive, force: Signal) -> Array:
    """What the delay and the low-pass of a channel make of a force [N] of time [s], (n,)."""
    times, every, lead = _grid(channel, drive)
    values = np.asarray(force(times - channel.delay), dtype=float)
    if channel.force_filter:
        values = low_passed(channel, times, values)
    return values[lead::every]


def _grid(channel: Channel, drive: Drive) -> tuple[Array, int, int]:
    """Times of a run [s], how many there are per sample, and how many come before the first.

    A low-pass has steps of its own, and begins early enough to have forgotten how.
    """
    if not channel.force_filter:
        return drive.time, 1, 0
    step = 1 / drive.rate
    every = max(1, int(np.ceil(STEPS_PER_PERIOD * channel.force_filter * step)))
    lead = every * int(np.ceil(MEMORY / channel.force_filter / step))
    count = (drive.time.size - 1) * every + 1
    times = np.asarray(drive.time[0] + step / every * np.arange(-lead, count), dtype=np.float64)
    return times, every, lead


def draw_filter(draw: np.random.Generator, highest: float) -> dict[str, float]:
    """A low-pass near enough to the motion's highest frequency [Hz] to be told from a delay."""
    return {
        "force_filter": rounded(highest * np.exp(draw.uniform(np.log(1.5), np.log(4.0)))),
        "force_filter_order": float(draw.integers(2, 5)),
        "force_filter_bessel": float(draw.integers(0, 2)),
    }


def low_passed(channel: Channel, times: Array, force: Array) -> Array:
    """A force [N] behind the channel's low-pass, at rest before the first of the even times [s]."""
    order, cutoff = int(channel.force_filter_order), 2 * np.pi * channel.force_filter
    system: Any = bessel(order, cutoff, analog=True, norm="mag")
    if not channel.force_filter_bessel:
        system = butter(order, cutoff, analog=True)
    step, start = float(times[1] - times[0]), float(force[0])
    # a force that is straight between the times, behind each pole by itself
    shown = np.full(force.size, start)
    for share, pole in zip(*residue(*system)[:2], strict=True):
        there = pole * step
        decay = np.exp(there)
        constant, rising = (decay - 1) / there, (decay - 1 - there) / there**2
        held = lfilter([rising, constant - rising], [1, -decay], force - start)
        shown += (share * step * held).real
    return shown


def _moved(device: ReferenceDevice, drive: Drive, times: Array, rtol: float) -> Response:
    """The device along the motion at some times [s] of it."""
    if not device.has_series:
        return response(device, drive.motion, times, rtol=rtol)

    # the flywheel starts with the terminals, on a shaft that carries its inertance force
    begin = float(times[0]) - SWING_IN
    speed = float(drive.motion.velocity(begin))
    pull = device.inertance * float(drive.motion.acceleration(begin))
    if device.clutch_force > 0.0:
        pull = float(np.clip(pull, *clutch.limits(device)))
    gap = float(np.sign(pull)) * device.backlash
    stiffness = device.series_stiffness
    known = {
        "series_deflection": gap + (pull / stiffness if stiffness > 0.0 else 0.0),
        "flywheel_velocity": speed,
        "gap_position": gap,
    }
    start = [known.get(name, 0.0) for name in device.state_names]
    whole = response(
        device,
        drive.motion,
        np.concatenate(([begin], times)),
        initial_state=start,
        rtol=max(rtol, 1e-7),
    )
    return Response(**{name: getattr(whole, name)[1:] for name in _COLUMNS})
