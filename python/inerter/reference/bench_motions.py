"""Random bench motions of five kinds, scaled to a realistic inertance force.

Kinds: steps of sines, multisine, chirp, minimum-jerk strokes with dwells, road-like noise as a
sum of sines. Frequencies 0.1 to 7.3 Hz; inertance force peaks of 50 to 1000 N where a stroke of
1.5 to 60 mm allows.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from .motion import Motion
from .motions import chirp, scaled, strokes, sum_of_sines, windowed_sines


@dataclass(frozen=True)
class Drive:
    """A motion and where it is sampled."""

    kind: str
    motion: Motion
    rate: float
    time: NDArray[np.float64]

    @property
    def displacement(self) -> NDArray[np.float64]:
        """Displacement [m] at the sample times, shape (n,)."""
        return np.asarray(self.motion.displacement(self.time))

    @property
    def acceleration(self) -> NDArray[np.float64]:
        """Acceleration [m/s^2] at the sample times, shape (n,)."""
        return np.asarray(self.motion.acceleration(self.time))


def _stepped_sines(draw: Generator, duration: float) -> Motion:
    count = int(draw.integers(3, 6))
    edges = np.linspace(0.0, duration, count + 1)
    frequencies = np.sort(draw.uniform(0.3, 6.0, count))
    amplitudes = frequencies**-1.3 * draw.uniform(0.6, 1.4, count)
    return windowed_sines(amplitudes.tolist(), frequencies.tolist(), edges.tolist(), 0.3)


def _multisine(draw: Generator, duration: float) -> Motion:
    frequencies = np.sort(draw.uniform(0.2, 6.0, int(draw.integers(8, 20))))
    amplitudes = frequencies**-1.4 * draw.uniform(0.5, 1.5, frequencies.size)
    return sum_of_sines(amplitudes, frequencies, draw.uniform(0.0, 2.0 * np.pi, frequencies.size))


def _chirp(draw: Generator, duration: float) -> Motion:
    roll_off = draw.uniform(1.0, 1.7)
    return chirp(1.0, draw.uniform(0.2, 0.6), draw.uniform(3.5, 6.0), duration, 0.5, roll_off)


def _strokes(draw: Generator, duration: float) -> Motion:
    positions, starts, lengths = [0.0], [], []
    clock = 0.3
    while True:
        distance = draw.uniform(0.3, 1.0) * (1.0 if positions[-1] <= 0.0 else -1.0)
        length = draw.uniform(0.25, 0.7)
        if clock + length > duration - 0.2:
            return strokes(positions, starts, lengths)
        positions.append(positions[-1] + distance)
        starts.append(clock)
        lengths.append(length)
        clock += length + draw.uniform(0.1, 0.6)


def _road_like(draw: Generator, duration: float) -> Motion:
    # white velocity, seen through a body resonance at one to two hertz
    frequencies = (np.arange(60) + draw.uniform(0.0, 1.0, 60)) * 0.12 + 0.1
    ratio = frequencies / draw.uniform(1.0, 2.0)
    filtered = 1.0 / np.sqrt((1.0 - ratio**2) ** 2 + (0.8 * ratio) ** 2)
    amplitudes = filtered / np.maximum(frequencies, 0.3)
    return sum_of_sines(amplitudes, frequencies, draw.uniform(0.0, 2.0 * np.pi, 60))


_MOTIONS: dict[str, Callable[[Generator, float], Motion]] = {
    "stepped_sines": _stepped_sines,
    "multisine": _multisine,
    "chirp": _chirp,
    "strokes": _strokes,
    "road_like": _road_like,
}


def draw_drives(draw: Generator, inertance: float) -> list[Drive]:
    """Three or four motions of different kinds, scaled to a peak inertance force of 50-1000 N."""
    drives: list[Drive] = []
    target = np.exp(draw.uniform(np.log(50.0), np.log(1000.0)))
    for kind in draw.permutation(list(_MOTIONS))[: int(draw.integers(3, 5))]:
        duration = float(np.round(draw.uniform(6.0, 10.0), 1))
        rate = float(draw.choice([500.0, 1000.0, 2000.0], p=[0.15, 0.7, 0.15]))
        time = np.arange(round(duration * rate)) / rate
        motion = _MOTIONS[str(kind)](draw, duration)

        # the force sets the scale, the stroke bounds it
        peak = float(np.max(abs(np.asarray(motion.acceleration(time)))))
        travel = float(np.max(abs(np.asarray(motion.displacement(time)))))
        wanted = np.clip(target * draw.uniform(0.7, 1.4), 50.0, 1000.0) / (inertance * peak)
        factor = float(np.clip(wanted, 1.5e-3 / travel, 60e-3 / travel))
        drives.append(Drive(str(kind), scaled(motion, factor), rate, time))
    return drives


def highest_frequency(drives: list[Drive]) -> float:
    """The frequency [Hz] below which each run has 95 % of its acceleration's power."""
    highest = 0.0
    for drive in drives:
        power, frequency = _spectrum(drive)
        summed = np.cumsum(power) / np.sum(power)
        highest = max(highest, float(frequency[np.searchsorted(summed, 0.95)]))
    return highest


def is_free_of(drives: list[Drive], frequency: float) -> bool:
    """Whether within half a hertz no run has more than 1e-4 of its acceleration's power."""
    for drive in drives:
        power, at = _spectrum(drive)
        near = abs(at - frequency) < 0.5
        if np.sum(power[near]) > 1e-4 * np.sum(power):
            return False
    return True


def _spectrum(drive: Drive) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Power and frequency [Hz] of the acceleration; a window keeps a line's feet small."""
    shape = np.hanning(drive.time.size)
    power = abs(np.fft.rfft(drive.acceleration * shape)) ** 2
    frequency = np.fft.rfftfreq(drive.time.size, 1.0 / drive.rate)
    return np.asarray(power, np.float64), np.asarray(frequency, np.float64)
