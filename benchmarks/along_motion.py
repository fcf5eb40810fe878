"""What a sample along a measured motion costs, per friction law.

The core against the same law compiled by Numba (total force only, the core also gives friction and
states), against SciPy (`solve_ivp` with LSODA for the state, NumPy where there is none), and
against the reference equations; and how many instructions it takes, see `instructions.py`.
"""

from __future__ import annotations

import importlib.util
import math
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from inerter.benchmark.laws import INERTANCE, LAWS, parameters_of
from inerter.benchmark.motion import SPACING, core_work, motion, reference_work, samples
from inerter.benchmark.rows import Row, spread_of
from inerter.benchmark.timing import Work, interleaved
from inerter.core import Device
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from benchmarks import instructions
from benchmarks.picture import COLOURS, figure, save

OTHERS = ("numba", "scipy", "reference")


COMPARED = ("none", "coulomb", "stribeck", "dahl", "lugre", "bouc_wen", "brown_mcphee")
"""The laws that the others are written for too."""


def run(quick: bool = False, laws: tuple[str, ...] = COMPARED) -> list[Row]:
    """Measure.

    Returns
    -------
    list of dict
        law; nanoseconds of a sample in the core; million_samples_per_second; for numba, scipy and
        reference the ratio of their cost to the core's; instructions of a sample, those of them in
        the mathematical library, the least there can be, and the ratio of all to the least. None
        for what is not installed.
    """
    rounds, count = (5, 5000) if quick else (25, 20_000)
    counted = ("lugre",) if quick else laws
    counts = {} if instructions.lacking() else instructions.counts(counted)
    rows: list[Row] = []
    for law in laws:
        works = {"core": core_work(law, count)}
        if _has_numba():
            works["numba"] = _numba_work(law, count)
        works["scipy"] = _scipy_work(law, count // 10)
        works["reference"] = reference_work(law, count // 20)
        times = interleaved(works, rounds, clock=time.process_time)
        cost = times["core"].spread
        row: Row = {
            "law": law,
            **spread_of("nanoseconds", cost.times(1e9)),
            "million_samples_per_second": 1e-6 / cost.median,
        }
        for name in OTHERS:
            keys = (f"{name}_ratio", f"{name}_ratio_lower", f"{name}_ratio_upper")
            ratio = times[name].ratio(times["core"]) if name in times else None
            row |= spread_of(keys[0], ratio) if ratio else dict.fromkeys(keys)
        found = counts.get(law)
        row |= dict(zip(("instructions", "in_libm", "least"), found or (None,) * 3, strict=True))
        rows.append(row | {"instructions_over_least": found[0] / found[2] if found else None})
    return rows


def notes() -> list[str]:
    """What is left out here."""
    found = [] if _has_numba() else ["Numba is left out: pip install numba"]
    reason = instructions.lacking()
    return [*found, *([reason] if reason else [])]


def picture(rows: list[Row], path: Path) -> None:
    """Samples per second of the core and the others, by law."""
    made = figure(10.0, 4.2)
    axes = made.subplots()
    names = ["core", *(name for name in OTHERS if rows[0][f"{name}_ratio"] is not None)]
    for k, name in enumerate(names):
        speeds = [
            1e6 * row["million_samples_per_second"] / (row[f"{name}_ratio"] if k else 1.0)
            for row in rows
        ]
        places = np.arange(len(rows)) + 0.8 * ((k + 0.5) / len(names) - 0.5)
        colour = COLOURS["after"] if k == 0 else ["#d4641c", "#8d97a3", "#c9b458"][k - 1]
        axes.bar(places, speeds, 0.72 / len(names), color=colour, label=name)
    axes.set_yscale("log")
    axes.minorticks_off()
    axes.set_xticks(range(len(rows)), [row["law"].replace("_", " ") for row in rows])
    axes.set_ylabel("samples per second", fontsize=9)
    axes.legend(frameon=False, fontsize=9, loc="upper center", bbox_to_anchor=(0.5, 1.12), ncols=4)
    save(made, path)


def _has_numba() -> bool:
    return importlib.util.find_spec("numba") is not None


def _numba_work(law: str, count: int) -> Work:
    """Compiled before it is timed, and checked against the core."""
    from benchmarks.laws_numba import along

    force, (x, v, a) = along(law), samples(count)
    own = Device(**parameters_of(law)).along(SPACING, x, v, a)["total"]
    if not np.allclose(force(SPACING, x, v, a), own, rtol=1e-9, atol=1e-9 * np.abs(own).max()):
        raise RuntimeError(f"the Numba version of {law} is not the core's law")
    return Work(lambda: force(SPACING, x, v, a), count)


# --------------------------- SciPy ----------------------------------------------------------------


def _scipy_work(law: str, count: int) -> Work:
    """Force along the motion; the state, if any, integrated to 1e-6 where the motion leads it."""
    path, p = motion(), LAWS[law]
    times, (_, v, a) = SPACING * np.arange(count), samples(count)
    rate = _rate(law)

    def run() -> NDArray:
        if rate is None:
            return INERTANCE * a + _static(law, p, v)
        slide = rate
        done = solve_ivp(
            lambda t, z: [slide(float(path.velocity(t)), z[0])], (0.0, times[-1]), [0.0],
            method="LSODA", t_eval=times, rtol=1e-6, atol=1e-9,
        )  # fmt: skip
        z = done.y[0]
        if law == "bouc_wen":
            return INERTANCE * a + p["bw_stiffness"] * z
        force = INERTANCE * a + p["bristle_stiffness"] * z
        if law == "lugre":
            slip = np.array([rate(*pair) for pair in zip(v.tolist(), z.tolist(), strict=True)])
            force += p["bristle_damping"] * slip
        return force

    return Work(run, count)


def _static(law: str, p: dict[str, Any], v: NDArray) -> NDArray | float:
    """Friction of the laws without state."""
    if law == "none":
        return 0.0
    if law == "coulomb":
        return p["coulomb_force"] * np.tanh(v / p["transition_velocity"])
    ratio, rise = v / p["stribeck_velocity"], p["static_force"] - p["coulomb_force"]
    if law == "stribeck":
        level = p["coulomb_force"] + rise * np.exp(-(ratio**2))
        return level * np.tanh(v / p["transition_velocity"])
    peak = rise * ratio / (0.25 * ratio**2 + 0.75) ** 2
    return p["coulomb_force"] * np.tanh(4.0 * ratio) + peak


def _rate(law: str) -> Callable[[float, float], float] | None:
    """Rate of the state at a velocity, or None."""
    p = LAWS[law]
    if law == "dahl":
        steep = p["bristle_stiffness"] / p["coulomb_force"]
        return lambda v, z: v - steep * abs(v) * z
    if law == "lugre":
        s0, fc, rise = p["bristle_stiffness"], p["coulomb_force"], p["static_force"]
        rise, slow = rise - fc, p["stribeck_velocity"]
        return lambda v, z: v - s0 * abs(v) * z / (fc + rise * math.exp(-((v / slow) ** 2)))
    if law == "bouc_wen":
        beta, gamma = p["bw_beta"], p["bw_gamma"]
        return lambda v, z: v - beta * abs(v) * z - gamma * v * abs(z)
    return None
