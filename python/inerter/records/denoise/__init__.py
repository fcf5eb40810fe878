"""Denoising one channel: the choice of methods, and what each reports of itself."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inerter.records.denoise import filters
from inerter.records.denoise.modes import Modes, Rule, selected
from inerter.records.motion import white_noise

Array = NDArray[np.float64]

METHODS = ("emd", "savgol", "lowpass", "spline", "none")


@dataclass(frozen=True, kw_only=True)
class Denoised:
    """A denoised channel and how it came about.

    Attributes
    ----------
    values : ndarray (n,)
        In the unit of the channel.
    method : str
        One of `METHODS`.
    noise : float
        Rms of the white noise that the strength was chosen for, in the unit of the channel.
    strength : dict of float
        "cutoff" [Hz] of the low-pass or "window" [samples] of the Savgol filter.
    noise_gain : float or None
        Share of the rms of white noise left away from the ends; None where it depends on the data.
    modes : Modes or None
        Of the EMD.
    """

    values: Array
    method: str
    noise: float
    strength: dict[str, float]
    noise_gain: float | None
    modes: Modes | None = None


def noise_level(values: Array) -> float:
    """Rms of the white noise of a channel: as `motion.white_noise`, at least a quantisation step's.

    The step is the smallest change there is; of a channel that is not quantised it is nothing.
    """
    change = np.abs(np.diff(values))
    change = change[change > 1e-12 * np.max(np.abs(values), initial=0.0)]
    step = float(np.min(change, initial=np.inf))
    return max(white_noise(values), step / np.sqrt(12) if np.isfinite(step) else 0.0)


def denoise(
    values: Array,
    spacing: float,
    method: str,
    noise: float | None = None,
    rule: Rule = "noise",
    cutoff: float | None = None,
) -> Denoised:
    """Denoise a uniformly sampled channel.

    Parameters
    ----------
    values : ndarray (n,)
        Channel.
    spacing : float
        Interval [s] between its samples. Bring records with odd clocks onto one first
        (`motion.uniform_channels`).
    method : str
        "emd", "savgol", "lowpass", "spline" or "none".
    noise : float, optional
        Rms of its white noise; default: `noise_level` of it. The spline does not use it.
    rule : str
        Which modes the EMD keeps; see `denoise.modes`.
    cutoff : float, optional
        Of the low-pass [Hz]; default: chosen by the noise.

    Raises
    ------
    ValueError
        Another method.
    RecordError
        EMD, and the package EMD-signal is not installed.
    """
    values = np.asarray(values, float)
    level = noise_level(values) if noise is None else noise
    ways: dict[str, Callable[[], Denoised]] = {
        "emd": lambda: _by_modes(values, level, rule),
        "savgol": lambda: _by_savgol(values, level),
        "lowpass": lambda: _by_lowpass(values, spacing, level, cutoff),
        "spline": lambda: Denoised(
            values=filters.spline(values),
            method="spline",
            noise=level,
            strength={},
            noise_gain=None,
        ),
        "none": lambda: Denoised(
            values=values.copy(), method="none", noise=level, strength={}, noise_gain=1.0
        ),
    }
    if method not in ways:
        raise ValueError(
            f"no way to denoise is called {method!r}; take one of {', '.join(METHODS)}"
        )
    return ways[method]()


def _by_modes(values: Array, noise: float, rule: Rule) -> Denoised:
    modes = selected(values, noise, rule)
    return Denoised(
        values=modes.denoised, method="emd", noise=noise, strength={}, noise_gain=None, modes=modes
    )


def _by_savgol(values: Array, noise: float) -> Denoised:
    smooth, window = filters.savgol(values, noise)
    return Denoised(
        values=smooth,
        method="savgol",
        noise=noise,
        strength={"window": window},
        noise_gain=filters.savgol_gain(window),
    )


def _by_lowpass(values: Array, spacing: float, noise: float, cutoff: float | None) -> Denoised:
    smooth, cutoff = filters.lowpassed(values, spacing, noise, cutoff)
    gain = filters.lowpass_gain(spacing, cutoff)
    return Denoised(
        values=smooth, method="lowpass", noise=noise, strength={"cutoff": cutoff}, noise_gain=gain
    )
