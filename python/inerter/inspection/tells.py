"""What a record could tell of a device, by a linear model of it, and the motion that would.

The force is fitted by inertance, viscous and dry friction, stiffness and a constant. Of each, the
standard error says what would be seen, and the part of its column that the others do not explain
says what it cannot be told from.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import binary_dilation, median_filter

from inerter.inspection.motion import MotionFacts
from inerter.measured_text import measured
from inerter.motion_units import words as in_words
from inerter.records.motion import Motion, lowpass, white_noise

Array = NDArray[np.float64]

OWN = 0.1  # least share of a column that the others do not explain
SURE = 0.1  # of a standard error in its value
ASTRAY = 0.3  # of the force, left by the linear model: its errors and bounds hold no more
LEAST_SHARE = 0.2  # of the samples that have to be neither clipped nor spikes
TIMES = 3.0  # standard errors that are seen
BLOCKS = 10  # parts of a record that are left out in turn


@dataclass(frozen=True, kw_only=True)
class Tell:
    """What can be known of one quantity.

    value, stderr: in the unit; verdict: "told", "bounded" (known to be small), "not told"; reason:
    why it is not; motion: that would tell it.
    """

    name: str
    value: float
    stderr: float
    unit: str
    verdict: str
    reason: str = ""
    motion: str = ""


def tells(motion: Motion, facts: MotionFacts, warned: Collection[str] = ()) -> list[Tell]:
    """What a record tells of inertance, friction and stiffness.

    warned: codes of its warnings; what a clipped force or one with spikes says is left out.
    """
    inner = motion.inner
    sound = ~_spoilt(motion, warned)[inner]
    v = motion.velocity[inner]
    columns = {
        "inertance": (motion.acceleration[inner], "kg"),
        "viscous friction": (v, "N s/m"),
        "dry friction": (np.tanh(v / max(0.02 * float(np.max(np.abs(v))), 1e-12)), "N"),
        "stiffness": (motion.displacement[inner], "N/m"),
    }
    names = list(columns)
    if np.mean(sound) < LEAST_SHARE:
        return [
            Tell(
                name=name, value=0.0, stderr=math.inf, unit=in_words(motion.motion, unit),
                verdict="not told",
                reason="what is clipped or spikes reaches most of the force through the low-pass",
                motion="a sensor of a wider range, or a weaker motion",
            )
            for name, (_, unit) in columns.items()
        ]  # fmt: skip
    units = {name: in_words(motion.motion, unit) for name, (_, unit) in columns.items()}
    # one filter on both sides
    passed = np.column_stack(
        [lowpass(_whole(motion, inner, columns[n][0]), motion.spacing, motion.cutoff)[inner]
         if n == "dry friction" else columns[n][0] for n in names]
    )  # fmt: skip
    passed = passed[sound]
    force = lowpass(motion.force, motion.spacing, motion.cutoff)[inner][sound]
    matrix = np.column_stack([passed - passed.mean(axis=0), np.ones(len(force))])
    scale = np.maximum(np.std(matrix, axis=0), 1e-300)
    scale[-1] = 1.0
    scaled = matrix / scale
    weights, *_ = np.linalg.lstsq(scaled, force, rcond=1e-10)
    rest = force - scaled @ weights
    if _astray(rest, force, motion):
        return [
            Tell(
                name=name, value=0.0, stderr=math.inf, unit=units[name], verdict="not told",
                reason=f"a linear model leaves {100 * np.std(rest) / np.std(force):.0f} % of the "
                "force", motion="the laws of `inerter diagnose`",
            )
            for name in names
        ]  # fmt: skip
    variance = float(np.var(rest)) * _correlated(rest, motion)
    inverse = np.linalg.pinv(scaled.T @ scaled)
    stderrs = np.sqrt(np.maximum(np.diag(inverse) * variance, 0))
    # what is not linear shows otherwise in each part of the record
    stderrs = np.maximum(stderrs, _over_blocks(scaled, force))
    return _possible([
        _tell(name, units[name], weights[k] / scale[k], stderrs[k] / scale[k],
              _own_share(scaled[:, :-1], k), facts, _closest(scaled[:, :-1], k, names))
        for k, name in enumerate(names)
    ])  # fmt: skip


def _possible(told: list[Tell]) -> list[Tell]:
    """Nothing is told by a linear model that makes the inertance negative, and nothing else.

    A force that lags, as friction with memory does, looks so.
    """
    sure = {tell.name: tell.value > 0 for tell in told if tell.verdict == "told"}
    if sure.get("inertance", True) or not any(sure.values()):
        return told
    reason = "a linear model makes the inertance negative, other laws act"
    return [
        replace(tell, verdict="not told", reason=reason, motion="the laws of `inerter diagnose`")
        for tell in told
    ]


def _astray(rest: Array, force: Array, motion: Motion) -> bool:
    """Whether more is left than a linear model may leave, the white noise of the force apart."""
    noise = white_noise(motion.force) ** 2 * min(1.0, 2 * motion.cutoff * motion.spacing)
    return bool(np.var(rest) - noise > ASTRAY**2 * np.var(force))


def _spoilt(motion: Motion, warned: Collection[str]) -> NDArray[np.bool_]:
    """Samples whose force is clipped or a spike, and those that a low-pass mixes with them."""
    force = motion.force
    size = float(np.quantile(force, 0.999) - np.quantile(force, 0.001))
    bad = np.zeros(force.size, dtype=np.bool_)
    if "outliers" in warned:
        apart = np.abs(force - median_filter(force, 5))
        bad |= apart > max(10 * 1.4826 * float(np.median(apart)), 0.05 * size)
    if "clipping" in warned:
        # three in a row on one level, among the highest or the lowest
        level = np.abs(np.diff(force)) < 1e-6 * size
        flat = np.r_[level, False] & np.r_[False, level]
        sound = force[~bad]
        for end in (np.quantile(sound, 0.999), np.quantile(sound, 0.001)):
            cut = flat & (np.abs(force - end) < 0.01 * size)
            bad |= cut | np.roll(cut, 1) | np.roll(cut, -1)
    around = int(np.ceil(0.75 / (motion.cutoff * motion.spacing)))
    return np.asarray(binary_dilation(bad, iterations=around) if bad.any() else bad, dtype=np.bool_)


def _over_blocks(columns: Array, force: Array) -> Array:
    """Standard errors (p,) of a regression by how it changes without each block in turn."""
    parts = np.array_split(np.arange(len(force)), BLOCKS)
    squares = np.array([columns[part].T @ columns[part] for part in parts])
    sides = np.array([columns[part].T @ force[part] for part in parts])
    left_out = [
        np.linalg.pinv(squares.sum(axis=0) - square) @ (sides.sum(axis=0) - side)
        for square, side in zip(squares, sides, strict=True)
    ]
    spread = np.asarray(left_out) - np.mean(left_out, axis=0)
    return np.asarray(np.sqrt((BLOCKS - 1) / BLOCKS * np.sum(spread**2, axis=0)))


def _whole(motion: Motion, inner: NDArray[np.bool_], values: Array) -> Array:
    made = np.zeros(motion.force.size)
    made[inner] = values
    return made


def _correlated(rest: Array, motion: Motion) -> float:
    """Samples that count as one: what is left is low-passed, and slow besides."""
    size = 1 << int(np.ceil(np.log2(2 * len(rest))))
    auto = np.fft.irfft(np.abs(np.fft.rfft(rest - rest.mean(), size)) ** 2, size)[: len(rest)]
    if auto[0] <= 0:
        return 1.0
    below = np.flatnonzero(auto < 0.1 * auto[0])
    end = int(below[0]) if len(below) else len(auto)
    return float(1 + 2 * np.sum(auto[1:end] / auto[0]))


def _own_share(columns: Array, index: int) -> float:
    """Share of a column, in rms, that the others do not explain."""
    others = np.delete(columns, index, axis=1)
    weights, *_ = np.linalg.lstsq(others, columns[:, index], rcond=1e-10)
    return float(np.std(columns[:, index] - others @ weights))


def _closest(columns: Array, index: int, names: list[str]) -> str:
    alike = np.abs(np.asarray(np.corrcoef(columns.T))[index])
    alike[index] = -1
    return names[int(np.argmax(alike))]


def _tell(
    name: str, unit: str, value: float, stderr: float, own: float, facts: MotionFacts, other: str
) -> Tell:
    base = {"name": name, "value": float(value), "stderr": float(stderr), "unit": unit}
    if facts.strokes < 3 and name != "inertance":
        return Tell(
            **base, verdict="not told",
            reason="one stroke" if facts.strokes == 1 else f"{facts.strokes} strokes",
            motion="several strokes there and back",
        )  # fmt: skip
    if own < OWN:
        return Tell(
            **base,
            verdict="not told",
            reason=f"it goes with the {other}",
            motion={
                "inertance": "a second frequency, two to five times higher",
                "stiffness": "a second, lower frequency, or slow strokes",
                "viscous friction": "strokes at several speeds",
                "dry friction": "strokes at several speeds, a slow one among them",
            }[name],
        )
    if value < 0 and stderr < SURE * abs(value) and name.endswith("friction"):
        return Tell(
            **base, verdict="not told", reason="a linear model makes it negative, other laws act",
            motion="the laws of `inerter diagnose`",
        )  # fmt: skip
    if stderr < SURE * abs(value):
        return Tell(**base, verdict="told")
    if name == "inertance":
        return Tell(
            **base, verdict="not told", reason="its force is below what is left",
            motion="faster reversals: a higher frequency or shorter ramps",
        )  # fmt: skip
    return Tell(
        **base,
        verdict="bounded",
        motion={
            "stiffness": "longer strokes, or rests at their ends",
            "viscous friction": "faster strokes",
            "dry friction": "slow strokes, in which little else acts",
        }[name],
    )


def words(tell: Tell) -> str:
    """One clause."""
    if tell.verdict == "told":
        return f"{tell.name} {_with_error(tell.value, tell.stderr)} {tell.unit}"
    if tell.verdict == "bounded":
        most = abs(tell.value) + TIMES * tell.stderr
        return f"{tell.name} below {float(f'{most:.2g}'):g} {tell.unit}"
    return f"{tell.name} not: {tell.reason}; {tell.motion} would tell"


def clauses(tells: Sequence[Tell]) -> list[str]:
    """One of each; of those that cannot be told for the same reason one of them all."""
    alike: dict[tuple[str, str], list[str]] = {}
    for tell in tells:
        if tell.verdict == "not told":
            alike.setdefault((tell.reason, tell.motion), []).append(tell.name)
    found = []
    for tell in tells:
        names = alike.get((tell.reason, tell.motion), [tell.name])
        if tell.verdict != "not told" or len(names) == 1:
            found.append(words(tell))
        elif names[0] == tell.name:
            listed = f"{', '.join(names[:-1])} and {names[-1]}"
            found.append(f"{listed} not: {tell.reason}; {tell.motion} would tell")
    return found


def _with_error(value: float, error: float) -> str:
    """Both to the first digit of the error, such as "530 ± 30"; without one the value."""
    return measured(value, error) if math.isfinite(error) and error > 0 else f"{value:.4g}"
