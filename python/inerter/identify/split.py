"""What a diagnosis learns from and what it is judged on."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inerter.identify.information import least_missed
from inerter.identify.runs import BenchRun, scales

Mask = NDArray[np.bool_]

# a single record is cut into this many blocks, of which these are held out
BLOCKS = 10
HELD_OUT_BLOCKS = (3, 6, 8)
# share of all data that a run held out by itself has at most, and at least
MOST_HELD = 0.6
LEAST_HELD = 0.02
# a run has one speed where so large a share of it is so near to the median
STEADY, NEAR = 0.7, 0.1
# folds of the runs learnt from, where these are so many
FOLDS = 5


@dataclass(frozen=True)
class Split:
    """Masks per run: samples to learn from, samples held out, and folds within the former.

    in_blocks: whether blocks of every run are held out, no run as a whole.
    """

    fit: list[Mask]
    holdout: list[Mask]
    folds: list[list[Mask]]
    description: str
    in_blocks: bool = False

    def role(self, i: int) -> str:
        """Role of run i: "fit" or "holdout"."""
        return "fit" if self.fit[i].any() else "holdout"


def split(
    runs: Sequence[BenchRun], holdout: Sequence[str] = (), in_blocks: bool | None = None
) -> Split:
    """Hold out whole runs where there are several, else blocks of the one.

    Parameters
    ----------
    runs : sequence of BenchRun
        Every run.
    holdout : sequence of str
        Names of runs to hold out, or of runs whose parts are all held out; by default the run
        whose motion is nearest to the others', so that it is judged on what can be learnt from
        them, and another where that one alone tells something (`information`).
    in_blocks : bool, optional
        Whether blocks of every run are held out instead; by default where all others have one
        frequency, and it has another, and where two have one speed each, as triangles have.

    Raises
    ------
    ValueError
        A name that no run has, or no run left to learn from.
    """
    names = [run.name for run in runs]
    named = [name for run in runs for name in holdout if run.part and run.part.run == name]
    chosen = held_runs(names, [name for name in holdout if name not in named])
    chosen |= {i for i, run in enumerate(runs) if run.part and run.part.run in named}
    if not chosen and len(runs) > 1:
        usual = _most_typical(runs)
        if in_blocks or (in_blocks is None and _is_needed(runs, usual)):
            return _in_blocks(runs)
        chosen = {usual}
    if held := chosen:
        everything = [np.ones(run.force.size, bool) for run in runs]
        fit = [m if i not in held else ~m for i, m in enumerate(everything)]
        out = [m if i in held else ~m for i, m in enumerate(everything)]
        text = "held out: " + ", ".join(names[i] for i in sorted(held))
        return Split(fit, out, _folds(runs, fit), text)

    return _in_blocks(runs)


def _in_blocks(runs: Sequence[BenchRun]) -> Split:
    """Blocks of every run held out."""
    name = runs[0].name if len(runs) == 1 else "every run"
    out = [held_blocks(run.inner, name)[0] for run in runs]
    fit = [~mask for mask in out]
    return Split(fit, out, _folds(runs, fit), held_blocks(runs[0].inner, name)[1], in_blocks=True)


def _is_needed(runs: Sequence[BenchRun], held: int) -> bool:
    """Whether a run would take away, held out as a whole, what no other one can do without."""
    return _has_the_other_frequency(runs, held) or _has_the_other_speed(runs)


def _has_the_other_speed(runs: Sequence[BenchRun]) -> bool:
    """Whether two runs have one speed each, and each another.

    Along one speed a damper is a friction, and how it bends is not told.
    """
    if len(runs) != 2 or any(run.part for run in runs):
        return False
    speeds = [np.abs(run.velocity[run.inner]) for run in runs]
    usual = [float(np.median(speed)) if speed.size else 0.0 for speed in speeds]
    pairs = zip(speeds, usual, strict=True)
    steady = all(np.mean(np.abs(v - middle) < NEAR * middle) > STEADY for v, middle in pairs)
    return steady and max(usual) > (1.0 + 2.0 * NEAR) * min(usual)


def _has_the_other_frequency(runs: Sequence[BenchRun], held: int) -> bool:
    """Whether the runs without one have one frequency, though all of them have more.

    Along one frequency a stiffness and a shaft are an inertance of another size.
    """
    if any(run.part for run in runs) or scales(runs).one_tone:
        return False
    return scales([run for i, run in enumerate(runs) if i != held]).one_tone


def held_runs(names: Sequence[str], holdout: Sequence[str]) -> set[int]:
    """Numbers of the runs that a user names to be held out.

    Raises
    ------
    ValueError
        A name that no run has, or no run left to learn from.
    """
    for name in holdout:
        if name not in names:
            raise ValueError(f"--holdout {name}: no such run; the runs are {', '.join(names)}")
    if len(set(holdout)) == len(names):
        raise ValueError("--holdout names every run; leave at least one to learn from")
    return {names.index(name) for name in holdout}


def held_blocks(known: Mask, name: str) -> tuple[Mask, str]:
    """Blocks spread over what is known of a single run (n,), and in words what they are."""
    index = np.flatnonzero(known)
    edges = np.linspace(0, index.size, BLOCKS + 1).astype(int)
    out = np.zeros(known.size, bool)
    for block in HELD_OUT_BLOCKS:
        out[index[edges[block] : edges[block + 1]]] = True
    numbers = ", ".join(str(block + 1) for block in HELD_OUT_BLOCKS)
    return out, f"held out: blocks {numbers} of {BLOCKS} of {name}"


def may_be_held(sizes: Sequence[int]) -> NDArray[np.intp]:
    """Numbers of the runs of some sizes that leave enough to learn from."""
    share = np.array(sizes) / max(sum(sizes), 1)
    enough = np.flatnonzero((share <= MOST_HELD) & (share >= LEAST_HELD))
    return enough if enough.size else np.array([int(np.argmin(np.abs(share - LEAST_HELD)))])


def _most_typical(runs: Sequence[BenchRun]) -> int:
    """The run whose amplitudes are nearest to the median, where others tell what it tells."""
    able = may_be_held([int(run.inner.sum()) for run in runs])
    channels = ("displacement", "velocity", "acceleration")
    sizes = np.log(
        [[np.std(getattr(run, channel)) + 1e-300 for channel in channels] for run in runs]
    )
    distance = np.sum((sizes - np.median(sizes, axis=0)) ** 2, axis=1)
    usual = int(able[np.argmin(distance[able])])
    return least_missed(runs, able.tolist(), usual)


def _folds(runs: Sequence[BenchRun], fit: list[Mask]) -> list[list[Mask]]:
    """Masks of what each fold leaves out: runs, or spread blocks where there are few runs.

    One of few runs takes away what only it can tell: how far the others' motion goes, say.
    """
    used = [i for i, mask in enumerate(fit) if mask.any()]
    if len(used) >= FOLDS:
        names = list(dict.fromkeys(_run_of(runs[i]) for i in used))
        # parts of few runs are folds themselves
        places = [names.index(_run_of(runs[i])) for i in used] if len(names) >= FOLDS else None
        numbered = list(zip(used, places or range(len(used)), strict=True))
        groups = [[i for i, place in numbered if place % FOLDS == fold] for fold in range(FOLDS)]
        groups = [group for group in groups if group]
        return [
            [mask if i in group else np.zeros_like(mask) for i, mask in enumerate(fit)]
            for group in groups
        ]
    return spread_folds(fit)


def _run_of(run: BenchRun) -> str:
    return run.part.run if run.part else run.name


def spread_folds(fit: Sequence[Mask]) -> list[list[Mask]]:
    """Masks of what each of four folds leaves out: blocks spread over every run."""
    folds = []
    for fold in range(4):
        masks = []
        for mask in fit:
            index = np.flatnonzero(mask)
            chosen = np.zeros_like(mask)
            for part in np.array_split(index, 16)[fold::4]:
                chosen[part] = True
            masks.append(chosen)
        folds.append(masks)
    return folds


def blocks(masks: Sequence[Mask], count: int = 48) -> list[tuple[int, NDArray[np.intp]]]:
    """Stretches of consecutive masked samples, about `count` of them: (run, index array).

    Residuals are correlated over milliseconds; sums over such stretches are nearly independent,
    which is what the tests of `statistics` need.
    """
    total = sum(int(mask.sum()) for mask in masks)
    length = max(total // count, 8)
    found = []
    for i, mask in enumerate(masks):
        index = np.flatnonzero(mask)
        if index.size:
            parts = max(1, round(index.size / length))
            found += [(i, part) for part in np.array_split(index, parts)]
    return found
