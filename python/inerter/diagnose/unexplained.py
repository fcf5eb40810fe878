"""What a model leaves: is it noise, and if not, what does it go with?"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from inerter.diagnose.result import Unexplained
from inerter.identify.bench import Run
from inerter.identify.split import Split

Array = NDArray[np.float64]

# share of the held-out residual's variance that a dependence must predict to be named
REQUIRED_SHARE = 0.08
# a residual this much larger than the noise (in variance) is significant
REQUIRED_EXCESS = 0.2
BINS = 16

_WORDS = {
    "displacement": "the position along the stroke",
    "velocity": "the velocity",
    "acceleration": "the acceleration",
    "displacement and direction": "the position, differently for each direction of motion",
    "time": "the time since the start",
    "history": "what went before (it is correlated over time)",
    "frequency": "a frequency of its own",
}


def unexplained(
    runs: Sequence[Run], split: Split, residual: Sequence[Array], floor: float, raw: float
) -> Unexplained:
    """Describe the residual of a model on held-out data.

    Parameters
    ----------
    runs : sequence of Run
        What was fitted.
    split : Split
        The parts of it.
    residual : list of ndarray
        Measured minus predicted force in the fits' band [N].
    floor, raw : float
        Noise floor of the force channel and rms residual on held-out data at full band [N].
    """
    fit = [m & run.inner for m, run in zip(split.fit, runs, strict=True)]
    held = [m & run.inner for m, run in zip(split.holdout, runs, strict=True)]
    fraction = max(0.0, 1 - (floor / raw) ** 2) if raw > 0 else 0.0
    shares = {
        name: _predicted_share([values[i] for i in range(len(runs))], residual, fit, held)
        for name, values in _quantities(runs).items()
    }
    depends = [
        name
        for name, share in sorted(shares.items(), key=lambda item: -item[1])
        if share > REQUIRED_SHARE
    ]
    if "displacement and direction" in depends and "displacement" in depends:
        simple = shares["displacement"] > 0.7 * shares["displacement and direction"]
        depends.remove("displacement and direction" if simple else "displacement")
    line, strength = _spectral_line(runs, residual, held)
    if strength > 0.2:
        depends.append("frequency")
    if not depends and _memory(residual, held) > 0.5 and fraction > REQUIRED_EXCESS:
        depends.append("history")
    significant = fraction > REQUIRED_EXCESS and bool(depends)
    return Unexplained(
        significant,
        fraction,
        depends,
        _summary(significant, fraction, depends, shares, line, raw, floor),
    )


def _quantities(runs: Sequence[Run]) -> dict[str, list[Array]]:
    sizes = np.concatenate([run.displacement for run in runs])
    both = 2 * (np.max(np.abs(sizes)) or 1.0)
    return {
        "displacement": [run.displacement for run in runs],
        "velocity": [run.velocity for run in runs],
        "acceleration": [run.acceleration for run in runs],
        "displacement and direction": [
            run.displacement + both * np.sign(run.velocity) for run in runs
        ],
        "time": [run.time - run.start for run in runs],
    }


def _predicted_share(
    values: Sequence[Array],
    residual: Sequence[Array],
    fit: Sequence[NDArray],
    held: Sequence[NDArray],
) -> float:
    """Share of the held-out residual's power that bin means learnt on the fit data predict."""
    x = np.concatenate([v[m] for v, m in zip(values, fit, strict=True)])
    y = np.concatenate([r[m] for r, m in zip(residual, fit, strict=True)])
    x_held = np.concatenate([v[m] for v, m in zip(values, held, strict=True)])
    y_held = np.concatenate([r[m] for r, m in zip(residual, held, strict=True)])
    if x.size < 20 * BINS or x_held.size < BINS:
        return 0.0
    edges = np.unique(np.quantile(x, np.linspace(0, 1, BINS + 1)[1:-1]))
    bins = np.digitize(x, edges)
    means = np.array(
        [y[bins == k].mean() if np.any(bins == k) else 0.0 for k in range(edges.size + 1)]
    )
    power = float(np.sum(y_held**2))
    left = float(np.sum((y_held - means[np.digitize(x_held, edges)]) ** 2))
    return 1 - left / power if power > 0 else 0.0


def _spectral_line(
    runs: Sequence[Run], residual: Sequence[Array], held: Sequence[NDArray]
) -> tuple[float, float]:
    """Strongest line of the held-out residual that the motion does not have: Hz, power share."""
    best = (0.0, 0.0)
    for run, r, mask in zip(runs, residual, held, strict=True):
        if mask.sum() < 64:
            continue
        window = np.hanning(r.size)
        power = np.abs(np.fft.rfft(np.where(mask, r, 0) * window)) ** 2
        motion = np.abs(np.fft.rfft(run.acceleration * window)) ** 2
        frequency = np.fft.rfftfreq(r.size, run.spacing)
        quiet = motion < 1e-4 * motion.max()
        power = np.where(quiet, power, 0)
        peak = int(np.argmax(power))
        share = float(power[max(peak - 2, 0) : peak + 3].sum() / max(power.sum(), 1e-300))
        if share > best[1] and quiet[max(peak - 2, 0) : peak + 3].all():
            best = (float(frequency[peak]), share)
    return best


def _memory(residual: Sequence[Array], held: Sequence[NDArray]) -> float:
    """Correlation of the held-out residual with itself a little later than the band allows."""
    numerator = denominator = 0.0
    for r, mask in zip(residual, held, strict=True):
        kept = np.where(mask, r, 0)
        lag = 18
        numerator += float(np.sum(kept[lag:] * kept[:-lag]))
        denominator += float(np.sum(kept**2))
    return numerator / denominator if denominator > 0 else 0.0


def _summary(
    significant: bool,
    fraction: float,
    depends: Sequence[str],
    shares: dict[str, float],
    line: float,
    raw: float,
    floor: float,
) -> str:
    if not depends:
        return (
            f"What remains ({raw:.3g} N rms; noise of the force channel {floor:.3g} N) shows no "
            "dependence on displacement, velocity, acceleration, time or frequency."
        )
    parts = [
        f"{_WORDS[name]} ({100 * shares[name]:.0f} %)" if name in shares else _WORDS[name]
        for name in depends
    ]
    text = "; ".join(parts)
    if "frequency" in depends:
        text += f", {line:.3g} Hz"
    verb = "goes with" if significant else "hints at a dependence on"
    return f"What remains ({raw:.3g} N rms, {100 * fraction:.0f} % not noise) {verb} {text}."
