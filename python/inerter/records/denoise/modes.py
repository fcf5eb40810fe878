"""Denoising by empirical mode decomposition (EMD), with a stated rule for the modes kept.

The decomposition is Huang's as the hysteresis paper describes it: cubic-spline envelopes through
the maxima and minima, their mean taken off again and again (sifting); the package EMD-signal does
it. Sifting stops after a fixed 10 rounds, where the modes of white noise form a dyadic filter bank
whose energies are known.

The rule. In white noise of rms s the modes have the mean energies

    E_1 = 0.64 s^2,   E_k = E_1 / 0.719 * 2.01^-k   (k >= 2)

(Flandrin, Rilling, Goncalves 2004, with Hurst exponent 1/2), and N E_k / s^2 is distributed as
chi-squared with as many degrees of freedom (Wu, Huang 2004). The fastest mode that counts as signal
is the first whose energy exceeds both the 99 % quantile of that distribution and 2 E_k; it, every
slower mode and the residue are kept. The 2: to drop a mode costs the signal in it, energy - E_k, to
keep it costs E_k, so it is worth keeping from energy = 2 E_k on. Slower modes are kept as they are
because modes share what is slow between them: leaving one out distorts the others' sum, and their
noise halves from one to the next.

`rule="loudest"` keeps the one mode of most energy: what the paper does ("the eighth IMF").

Not modelled: noise that is not white. Noise that was filtered before it was stored is not seen.

Sources: N. Huang et al., Proc. R. Soc. A 454 (1998) 903; P. Flandrin, G. Rilling, P. Goncalves,
IEEE Signal Processing Letters 11 (2004) 112 and "Detrending and denoising with EMD", EUSIPCO 2004;
Z. Wu, N. Huang, Proc. R. Soc. A 460 (2004) 1597.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.stats import chi2

from inerter.records.record import RecordError

Array = NDArray[np.float64]
Rule = Literal["noise", "loudest"]

# rounds of sifting: the number at which noise makes a dyadic filter bank
SIFTINGS = 10
# share of white noise's energy in the fastest mode, for that number
FIRST_SHARE = 0.64
# ratio of the energies of neighbouring modes, and of the first one to that law
RATIO, BETA = 2.01, 0.719
# probability that noise stays below the threshold
CONFIDENCE = 0.99
# energy beyond which a mode holds more signal than noise, in units of its noise
WORTH = 2.0


@dataclass(frozen=True, kw_only=True)
class Modes:
    """A channel as a sum of modes, fastest first, and a residue.

    Attributes
    ----------
    modes : ndarray (k, n)
        Intrinsic mode functions, in the unit of the channel.
    residue : ndarray (n,)
        What has no oscillation left; always kept.
    energy, expected, threshold : ndarray (k,)
        Mean square of each mode, what white noise alone would have, and the rule's limit.
    period : ndarray (k,)
        Mean period [samples], from zero crossings; infinite without one.
    kept : ndarray of bool (k,)
    """

    modes: Array
    residue: Array
    energy: Array
    expected: Array
    threshold: Array
    period: Array
    kept: NDArray[np.bool_]

    @property
    def denoised(self) -> Array:
        """Sum of the modes kept and the residue, shape (n,)."""
        return self.modes[self.kept].sum(axis=0) + self.residue


def decompose(values: Array) -> tuple[Array, Array]:
    """Modes (k, n), fastest first, and the residue (n,) of a uniformly sampled channel (n,).

    Raises
    ------
    RecordError
        The package EMD-signal is not installed.
    """
    try:
        from PyEMD.EMD import EMD
    except ModuleNotFoundError as error:
        raise RecordError(
            f"EMD needs the package EMD-signal ({error.name} is not installed); "
            "run `pip install EMD-signal` or choose another way to denoise"
        ) from None
    values = np.asarray(values, float)
    middle, size = float(np.mean(values)), float(np.std(values))
    if size <= 1e-12 * abs(middle):
        return np.empty((0, values.size)), values.copy()
    # its limits are absolute numbers: let them count in standard deviations
    emd = EMD(FIXE=SIFTINGS, range_thr=1e-9, total_power_thr=1e-9 * values.size)
    emd.emd((values - middle) / size)
    modes, _ = emd.get_imfs_and_residue()
    modes = np.asarray(modes, float) * size
    # what sums up to the channel whatever the rounding
    return modes, values - modes.sum(axis=0)


def noise_energy(count: int, noise: float) -> Array:
    """Mean energy of each of `count` modes of white noise of rms `noise`, shape (count,)."""
    energy = FIRST_SHARE / BETA * RATIO ** -np.arange(1.0, count + 1)
    energy[:1] = FIRST_SHARE
    return energy * noise**2


def selected(values: Array, noise: float, rule: Rule = "noise") -> Modes:
    """The modes of a channel (n,) and which of them to keep.

    noise: rms of the channel's white noise, in its unit; rule: see the module.
    """
    modes, residue = decompose(values)
    energy = np.mean(modes**2, axis=1)
    expected = noise_energy(len(modes), noise)
    freedom = values.size * noise_energy(len(modes), 1.0)
    threshold = expected * np.maximum(chi2.ppf(CONFIDENCE, freedom) / freedom, WORTH)
    kept = np.zeros(len(modes), bool)
    if rule == "loudest":
        if len(modes):
            kept[int(np.argmax(energy))] = True
    elif (above := np.flatnonzero(energy > threshold)).size:
        kept[above[0] :] = True
    crossings = np.sum(np.diff(np.signbit(modes), axis=1), axis=1)
    with np.errstate(divide="ignore"):
        period = 2 * values.size / crossings.astype(float)
    return Modes(
        modes=modes,
        residue=residue,
        energy=energy,
        expected=expected,
        threshold=threshold,
        period=period,
        kept=kept,
    )
