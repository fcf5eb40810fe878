"""What happens to the force on its way into the record, and what depends on the clock.

    F_c = F(t - delay) + d_f e F_friction + d e + A sin(2 pi f e + phase)
    recorded: F_c and its noise, kept between force_minimum and force_maximum

Symbols: e [s] time since the start of the clock, d_f `friction_drift` [1/s], d `force_drift`
[N/s], A `disturbance_amplitude` [N], f `disturbance_frequency` [Hz]; the phase is a run's own.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from .bench_motions import Drive
from .device import ReferenceDevice
from .motion import Response, response

Array = NDArray[np.float64]

# a flywheel on a shaft swings itself in before a record starts [s]
SWING_IN = 2.0


@dataclass(frozen=True, kw_only=True)
class Channel:
    """The force channel and the clock; every default leaves the force as it is."""

    delay: float = 0.0
    friction_drift: float = 0.0
    force_drift: float = 0.0
    disturbance_amplitude: float = 0.0
    disturbance_frequency: float = 0.0
    force_minimum: float = -np.inf
    force_maximum: float = np.inf

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
        truth = _moved(device, run.drive, channel.delay, rtol)
        elapsed = run.drive.time + run.start
        friction = device.friction_force(
            truth.displacement, truth.velocity, device.state_argument(truth.states)
        )
        tone = np.sin(2.0 * np.pi * channel.disturbance_frequency * elapsed + run.phase)
        force = (
            truth.force
            + channel.friction_drift * elapsed * friction
            + channel.force_drift * elapsed
            + channel.disturbance_amplitude * tone
        )
        found.append(replace(truth, time=truth.time + run.start, force=force))
    return found


def _moved(device: ReferenceDevice, drive: Drive, delay: float, rtol: float) -> Response:
    """The device along the motion, seen `delay` [s] earlier than the record's clock says."""
    times = drive.time - delay
    if not device.has_series:
        return response(device, drive.motion, times, rtol=rtol)

    # the flywheel starts with the terminals, on a shaft that carries its inertance force
    begin = float(times[0]) - SWING_IN
    speed = float(drive.motion.velocity(begin))
    pull = device.inertance * float(drive.motion.acceleration(begin))
    gap = float(np.sign(pull)) * device.backlash
    known = {
        "series_deflection": gap + pull / device.series_stiffness,
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
    names = ("time", "displacement", "velocity", "acceleration", "state", "force", "states")
    return Response(**{name: getattr(whole, name)[1:] for name in names})
