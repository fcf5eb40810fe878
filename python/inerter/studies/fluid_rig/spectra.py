"""Receptance and power spectral density of records, by Welch's averaged periodograms.

    H(f) = G_Fx / G_FF   (displacement per force, H1: noise of the force alone biases it)
Segments of `segment` seconds, half overlapping, each less its mean and under a Hann window; the
periodograms are averaged and scaled to one-sided densities. A sweep passes a frequency in one or
two segments only, so that what is averaged over is mostly where the sweep is not: the estimate of
one frequency is that of the sweep's passage.
Source: Welch (1967); Bendat and Piersol, Random Data, for H1 and its coherence.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.signal import csd, welch

Array = NDArray[np.float64]

SEGMENT = 8.0
"""Length of a segment [s] if not said otherwise: bins of 0.125 Hz."""


@dataclass(frozen=True, kw_only=True)
class Spectra:
    """Spectra of one record or several, arrays of shape (..., frequencies).

    frequency [Hz], shape (frequencies,). receptance [m/N], complex. displacement_density [m^2/Hz],
    force_density [N^2/Hz], one-sided. coherence, 0 to 1. segments: how many were averaged.
    """

    frequency: Array
    receptance: NDArray[np.complex128]
    displacement_density: Array
    force_density: Array
    coherence: Array
    segments: int

    @property
    def magnitude(self) -> Array:
        """|H| [m/N]."""
        return np.abs(self.receptance)

    @property
    def phase(self) -> Array:
        """Angle of H [deg], -180 to 180."""
        return np.degrees(np.angle(self.receptance))

    def between(self, low: float, high: float) -> Spectra:
        """The bins from `low` to `high` [Hz], both included."""
        here = (self.frequency >= low - 1e-9) & (self.frequency <= high + 1e-9)
        return Spectra(
            frequency=self.frequency[here],
            receptance=self.receptance[..., here],
            displacement_density=self.displacement_density[..., here],
            force_density=self.force_density[..., here],
            coherence=self.coherence[..., here],
            segments=self.segments,
        )


def spectra(
    displacement: ArrayLike, force: ArrayLike, rate: float, segment: float = SEGMENT
) -> Spectra:
    """Receptance, densities and coherence of equally spaced records.

    Parameters
    ----------
    displacement, force : array_like (..., n)
        [m], [N]; several records of one length at once.
    rate : float
        Samples per second.
    segment : float
        Length of a segment [s].

    Raises
    ------
    ValueError
        Shapes differ, or a record is shorter than a segment.
    """
    x, f = np.asarray(displacement, dtype=float), np.asarray(force, dtype=float)
    if x.shape != f.shape:
        raise ValueError(f"displacement {x.shape} and force {f.shape} differ in shape")
    length = round(segment * rate)
    if length < 8:
        raise ValueError(f"segment: {segment:g} s is {length} samples, at least 8 are needed")
    if x.shape[-1] < length:
        raise ValueError(
            f"segment: {segment:g} s is longer than the record of {x.shape[-1] / rate:g} s; "
            "choose a shorter one"
        )
    how = {"fs": rate, "window": "hann", "nperseg": length, "detrend": "constant"}
    frequency, cross = csd(f, x, **how)  # pyright: ignore[reportArgumentType]
    displacement_density = np.asarray(welch(x, **how)[1])  # pyright: ignore[reportArgumentType]
    force_density = np.asarray(welch(f, **how)[1])  # pyright: ignore[reportArgumentType]
    cross = np.asarray(cross, dtype=np.complex128)
    with np.errstate(divide="ignore", invalid="ignore"):
        receptance = cross / force_density
        coherence = np.abs(cross) ** 2 / (displacement_density * force_density)
    return Spectra(
        frequency=np.asarray(frequency, dtype=np.float64),
        receptance=receptance,
        displacement_density=displacement_density,
        force_density=force_density,
        coherence=coherence,
        segments=(x.shape[-1] - length) // (length - length // 2) + 1,
    )
