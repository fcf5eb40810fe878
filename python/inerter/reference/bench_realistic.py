"""A bench as it is: what it adds to a case's motion and to both channels of its records.

    motion        one of `bench_motions.py` or one sine, one to four runs of 5 to 20 s, and on some
                  benches the ringing of the actuator: three near tones of 20 to 60 Hz
    force         F + m_g a + hum + drift,  m_g the mass between load cell and device
    both          low-pass of each channel, sampled at times that jitter, white noise, quantised

Rates of 100 to 2000 Hz. Filters of 25 to 200 Hz, order 2 to 4, Bessel or Butterworth, on the force
alone, on the displacement alone, or the same on both. Hum: 50 or 60 Hz, 0.3 to 2 % of the force
rms. Drift: as much over a run. Quantised to 2^-11 to 2^-15 of a channel's range. Each of these is
there in some of the benches. `Chain.brings` names the effects that a diagnosis may rightly name
for them; a mass between cell and device is inertance as far as such records can tell.
Not modelled: cross-talk, bases that give way, clocks that drift against each other.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from .bench_channel import Channel, low_passed
from .bench_motions import Drive, draw_drives
from .motion import Motion, Response
from .motions import sum_of_sines
from .sizes import rms, rounded

Array = NDArray[np.float64]

# what is simulated, of which every bench's rate is a part [Hz]
FINE = 2000.0
RATES = (100.0, 200.0, 250.0, 500.0, 1000.0, 2000.0)


@dataclass(frozen=True, kw_only=True)
class Chain:
    """What a bench does to its records; 0 where it does not.

    force_filter, displacement_filter: cut-off [Hz] of a low-pass of `order`, Bessel or not;
    hum [N], hum_frequency [Hz], phase [rad]; drift [N/s]; jitter [s] rms; grip_mass [kg];
    force_step, displacement_step: of the converters [N], [m].
    """

    rate: float = FINE
    force_filter: float = 0.0
    displacement_filter: float = 0.0
    order: float = 2.0
    is_bessel: bool = False
    hum: float = 0.0
    hum_frequency: float = 50.0
    phase: float = 0.0
    drift: float = 0.0
    jitter: float = 0.0
    grip_mass: float = 0.0
    force_step: float = 0.0
    displacement_step: float = 0.0

    @property
    def brings(self) -> tuple[str, ...]:
        """Effects that are there besides what is hidden, by the names of a diagnosis."""
        found = []
        if self.force_filter != self.displacement_filter:
            found += ["sensor_filter", "sensor_delay"]
        if self.hum:
            found.append("periodic_disturbance")
        if self.drift:
            found += ["force_drift", "force_offset"]
        if self.grip_mass:
            found.append("grip_mass")
        return tuple(found)

    @property
    def every(self) -> int:
        """Simulated samples per recorded one."""
        return round(FINE / self.rate)

    def force(self, truth: Response, felt: Array | None = None) -> Array:
        """The force before the converter [N] at the simulated times, (n,).

        The load cell feels the grip as it feels the device: what is `felt` (n,) of the acceleration
        [m/s^2] is behind the hidden channel; by default it is that of the motion.
        """
        t, a = truth.time, truth.acceleration if felt is None else felt
        force = truth.force + self.grip_mass * a + self.drift * (t - t[0])
        force = force + self.hum * np.sin(2.0 * np.pi * self.hum_frequency * t + self.phase)
        return self._passed(force, t, self.force_filter)

    def displacement(self, drive: Drive) -> Array:
        """The displacement before the converter [m] at the simulated times, (n,)."""
        return self._passed(drive.displacement, drive.time, self.displacement_filter)

    def sampled(self, values: Array, times: Array, shake: Generator) -> Array:
        """Values at the times of the record, which jitter, (n / every,)."""
        if not self.jitter:
            return values[:: self.every]
        when = times[:: self.every]
        late = when + self.jitter * shake.standard_normal(when.size)
        return CubicSpline(times, values)(np.clip(late, times[0], times[-1]))

    def _passed(self, values: Array, times: Array, cutoff: float) -> Array:
        if not cutoff:
            return values
        channel = Channel(
            force_filter=cutoff,
            force_filter_order=self.order,
            force_filter_bessel=float(self.is_bessel),
        )
        # begun as if mirrored in its first value, so that no step is filtered
        ahead = min(values.size - 1, int(8.0 * FINE / cutoff))
        led = np.concatenate([2.0 * values[0] - values[ahead:0:-1], values])
        more = times[0] - np.arange(ahead, 0, -1) / FINE
        return low_passed(channel, np.concatenate([more, times]), led)[ahead:]


def quantised(values: Array, step: float) -> Array:
    """Values as a converter with this step tells them; as they are with step 0."""
    return step * np.round(values / step) if step else values


def draw_bench_drives(draw: Generator, inertance: float) -> list[Drive]:
    """The motions of one bench: one to four runs at the simulated rate."""
    made = draw_drives(draw, inertance)[: int(draw.integers(1, 5))]
    seconds, centre = draw.uniform(5.0, 20.0), draw.uniform(20.0, 60.0)
    if draw.random() < 0.2:
        # one sine, and nothing else, of the size that the first motion has
        first, speed = made[0], 2.0 * np.pi * rounded(draw.uniform(0.5, 5.0))
        reach = [float(np.max(abs(q))) for q in (first.displacement, first.acceleration)]
        sine = sum_of_sines([min(reach[0], reach[1] / speed**2)], [speed / (2.0 * np.pi)], [0.0])
        made = [Drive("one_sine", sine, FINE, first.time)]
    ringing, found = draw.random() < 0.3, []
    for drive in made:
        motion = drive.motion
        # the others are made for the length that they have
        endless = drive.kind in ("multisine", "road_like", "one_sine")
        end = seconds if endless else float(drive.time[-1])
        if ringing:
            share = draw.uniform(0.01, 0.05) * rms(drive.acceleration)
            tones = centre * np.array([0.98, 1.0, 1.03])
            sizes = share / (2.0 * np.pi * tones) ** 2
            motion = _sum(motion, sum_of_sines(sizes, tones, draw.uniform(0.0, 6.0, 3)))
        found.append(Drive(drive.kind, motion, FINE, np.arange(round(end * FINE)) / FINE))
    return found


def draw_chain(draw: Generator, drives: list[Drive], force: Array) -> Chain:
    """A measuring chain; `force` is what the device's force is like [N]."""
    size = rms(force)
    known: dict[str, Any] = {"rate": float(draw.choice(RATES))}
    if draw.random() < 0.5:
        cutoff = rounded(float(np.exp(draw.uniform(np.log(25.0), np.log(200.0)))))
        which = draw.choice(["both", "force", "displacement"], p=[0.5, 0.3, 0.2])
        known |= {"order": float(draw.integers(2, 5)), "is_bessel": bool(draw.integers(2))}
        known |= {"force_filter": cutoff} if which != "displacement" else {}
        known |= {"displacement_filter": cutoff} if which != "force" else {}
    if draw.random() < 0.4:
        known |= {"hum": rounded(size * draw.uniform(3e-3, 2e-2))}
        known |= {"hum_frequency": float(draw.choice([50.0, 60.0])), "phase": draw.uniform(0, 6)}
    if draw.random() < 0.3:
        known |= {"drift": rounded(size * draw.uniform(3e-3, 2e-2) / float(drives[0].time[-1]))}
    if draw.random() < 0.3:
        known |= {"jitter": draw.uniform(0.01, 0.1) / known["rate"]}
    if draw.random() < 0.3:
        inertance = size / rms(np.concatenate([drive.acceleration for drive in drives]))
        known |= {"grip_mass": rounded(inertance * draw.uniform(5e-3, 3e-2))}
    if draw.random() < 0.7:
        bits = int(draw.integers(11, 16))
        travel = np.concatenate([drive.displacement for drive in drives])
        known |= {"force_step": 4.0 * float(np.max(abs(force))) * 2.0**-bits}
        known |= {"displacement_step": 4.0 * float(np.max(abs(travel))) * 2.0 ** -(bits + 1)}
    return Chain(**known)


def _sum(one: Motion, other: Motion) -> Motion:
    return Motion(
        lambda t: one.displacement(t) + other.displacement(t),
        lambda t: one.velocity(t) + other.velocity(t),
        lambda t: one.acceleration(t) + other.acceleration(t),
        one.kinks,
    )
