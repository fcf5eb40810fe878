"""What each way to denoise costs, on a force that is known: `python -m` this module.

The force is that of the hysteresis paper's ball-screw inerter with dry friction along a sine,
F = b a + f_c sign(v), so friction jumps where the inertance force has its peak: that is where a
denoiser does harm. Bias is the mean over many draws of noise less the truth, noise the scatter
about that mean.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inerter.records.denoise import denoise
from inerter.records.motion import lowpass

Array = NDArray[np.float64]

# inertance [kg] and motion [m, Hz] of the paper's first test; friction and noise [N] chosen here
INERTANCE, AMPLITUDE, FREQUENCY = 158.65, 0.01, 1.0
FRICTION, NOISE = 10.0, 5.0
RATE, PERIODS = 1000.0, 8
DRAWS = 40
# name, method and rule of the ways compared
WAYS = (
    ("none", "none", "noise"),
    ("emd", "emd", "noise"),
    ("emd, loudest mode", "emd", "loudest"),
    ("savgol", "savgol", "noise"),
    ("lowpass", "lowpass", "noise"),
    ("spline", "spline", "noise"),
    ("lowpass on both sides", "lowpass", "noise"),
)


@dataclass(frozen=True, kw_only=True)
class DenoisingRow:
    """One way to denoise.

    Attributes
    ----------
    peak_bias : float
        Error of the mean over the draws where the force is within 2 % of its peak, as a share.
    phase : float
        Shift of the force's fundamental [degrees], positive where it comes late.
    noise : float
        Rms scatter [N] over the draws, away from the ends.
    error : float
        Rms distance [N] from the truth.
    friction, friction_error : float
        Mean error and scatter of the friction level [N] that a least-squares fit with the true
        motion finds.
    inertance : float
        Mean error [kg] of the inertance of that fit.
    """

    name: str
    peak_bias: float
    phase: float
    noise: float
    error: float
    friction: float
    friction_error: float
    inertance: float


def compare(draws: int = DRAWS, noise: float = NOISE, seed: int = 0) -> list[DenoisingRow]:
    """A row for each of `WAYS`; `draws` noises of rms `noise` [N]."""
    time = np.arange(int(PERIODS * RATE / FREQUENCY)) / RATE
    turn = 2 * np.pi * FREQUENCY
    # a quarter of a sample away from the grid, so that no velocity is zero
    phase = turn * (time + 0.25 / RATE)
    v = AMPLITUDE * turn * np.cos(phase)
    a = -AMPLITUDE * turn**2 * np.sin(phase)
    truth = INERTANCE * a + FRICTION * np.sign(v)
    inner = slice(int(RATE / FREQUENCY), -int(RATE / FREQUENCY))
    columns = np.column_stack([a, np.sign(v), v, np.ones_like(v)])
    rows = []
    for name, method, rule in WAYS:
        random = np.random.default_rng(seed)
        forces, fits = [], []
        for _ in range(draws):
            measured = truth + random.normal(0, noise, time.size)
            result = denoise(measured, 1 / RATE, method, rule=rule)  # type: ignore[arg-type]
            explained = columns
            if name.endswith("both sides"):
                explained = np.column_stack(
                    [lowpass(c, 1 / RATE, result.strength["cutoff"]) for c in columns.T]
                )
            forces.append(result.values)
            fits.append(np.linalg.lstsq(explained[inner], result.values[inner])[0])
        rows.append(_row(name, np.array(forces), np.array(fits), truth, phase, inner))
    return rows


def _row(
    name: str, forces: Array, fits: Array, truth: Array, phase: Array, inner: slice
) -> DenoisingRow:
    mean = forces.mean(axis=0)
    period = int(RATE / FREQUENCY)
    # the mean cycle, where the true one is within 2 % of its peak
    cycle, true = (values[inner].reshape(-1, period).mean(axis=0) for values in (mean, truth))
    top = true > 0.98 * true.max()
    wave = np.exp(-1j * phase[inner])
    late = -np.angle(np.sum(mean[inner] * wave) / np.sum(truth[inner] * wave))
    return DenoisingRow(
        name=name,
        peak_bias=float(np.mean(cycle[top]) / np.mean(true[top]) - 1),
        phase=float(np.degrees(late)),
        noise=float(np.sqrt(np.mean(np.var(forces[:, inner], axis=0, ddof=1)))),
        error=float(np.sqrt(np.mean((forces[:, inner] - truth[inner]) ** 2))),
        friction=float(fits[:, 1].mean() - FRICTION),
        friction_error=float(fits[:, 1].std(ddof=1)),
        inertance=float(fits[:, 0].mean() - INERTANCE),
    )


def main() -> None:
    """Print the table as Markdown."""
    print(f"noise {NOISE:g} N rms, friction {FRICTION:g} N, {DRAWS} draws")
    print("| way | peak | phase | noise left | rms error | friction | inertance |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    for r in compare():
        print(
            f"| {r.name} | {100 * r.peak_bias:+.1f} % | {r.phase:+.2f}° | {r.noise:.2f} N "
            f"| {r.error:.2f} N | {r.friction:+.2f} ± {r.friction_error:.2f} N "
            f"| {r.inertance:+.2f} kg |"
        )


if __name__ == "__main__":
    main()
