"""The ways to clean a force before a fit.

    none            as measured
    emd             empirical mode decomposition, modes kept by the noise rule
    emd_loudest     the one mode of most energy, as the paper keeps "the eighth IMF"
    lowpass         zero-phase low-pass, cut-off from the data
    lowpass_both    the same low-pass on the measured and on the modelled force

The noise rule needs modes sifted a fixed number of times (see `inerter.records.denoise.modes`). The
paper sifts until a mode fulfils the conditions of an intrinsic mode function; for its single mode
the package's own stopping rules for these are taken.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inerter.records.denoise import denoise
from inerter.records.denoise.modes import Modes
from inerter.records.record import RecordError

Array = NDArray[np.float64]

WAYS = ("none", "emd", "emd_loudest", "lowpass", "lowpass_both")


@dataclass(frozen=True)
class Cleaned:
    """A cleaned force [N], shape (n,).

    `cutoff` [Hz] is set where the modelled force has to pass the same low-pass; `modes` where the
    noise rule chose among some; `number` of the loudest mode where it stands alone, 1 the fastest.
    """

    force: Array
    cutoff: float | None = None
    modes: Modes | None = None
    number: int | None = None


def clean(force: Array, spacing: float, way: str) -> Cleaned:
    """Clean a force (n,) [N] sampled every `spacing` seconds in one of `WAYS`.

    Raises
    ------
    RecordError
        EMD, and the package EMD-signal is not installed.
    """
    if way == "none":
        return Cleaned(force)
    if way == "emd_loudest":
        return _loudest(force)
    if way == "emd":
        found = denoise(force, spacing, "emd")
        return Cleaned(found.values, modes=found.modes)
    found = denoise(force, spacing, "lowpass")
    return Cleaned(found.values, found.strength["cutoff"] if way == "lowpass_both" else None)


def _loudest(force: Array) -> Cleaned:
    """The mode of most energy alone."""
    try:
        from PyEMD.EMD import EMD
    except ModuleNotFoundError as error:
        raise RecordError(
            f"EMD needs the package EMD-signal ({error.name} is not installed); "
            "run pip install EMD-signal or choose another way to denoise"
        ) from None
    size = float(np.std(force))
    emd = EMD()
    emd.emd(force / size)
    modes = size * np.asarray(emd.get_imfs_and_residue()[0], float)
    at = int(np.argmax(np.mean(modes**2, axis=1)))
    return Cleaned(modes[at], number=at + 1)
