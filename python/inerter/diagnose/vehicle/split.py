"""What a diagnosis of a user's model learns from and what it is judged on."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from inerter.diagnose.vehicle.drive import RecordedDrive
from inerter.identify.split import Mask, held_blocks, held_runs, may_be_held

# a channel of one of two runs is so many times the other's where one cannot stand for the other
MUCH_LARGER = 1.5


def split_drives(
    drives: Sequence[RecordedDrive], holdout: Sequence[str]
) -> tuple[list[Mask], list[Mask], str]:
    """Masks of what is fitted and what is held out, and the split in words.

    Of several runs, whole ones are held out: the named ones, else the one whose size is nearest to
    the others'. Of a single run, blocks: the whole road is simulated, some blocks do not count.
    Of two runs of which one is much larger, too, blocks of both: a damper bends in the larger one
    alone, friction shows most in the other.

    Raises
    ------
    ValueError
        A name that no run has, or no run left to learn from.
    """
    names = [drive.name for drive in drives]
    chosen = held_runs(names, holdout)
    whole = [np.ones(drive.time.size, bool) for drive in drives]
    if len(drives) == 2 and not chosen and _differ(drives):
        both = [held_blocks(mask, "every run") for mask in whole]
        return [~mask for mask, _ in both], [mask for mask, _ in both], both[0][1]
    if len(drives) > 1:
        held = chosen or {_most_typical(drives)}
        fit = [~m if i in held else m for i, m in enumerate(whole)]
        out = [m if i in held else ~m for i, m in enumerate(whole)]
        return fit, out, "held out: " + ", ".join(names[i] for i in sorted(held))
    mask, text = held_blocks(whole[0], names[0])
    return [~mask], [mask], text


def _differ(drives: Sequence[RecordedDrive]) -> bool:
    """Whether a channel of one of two runs is much larger than the other's."""
    one, other = (np.std(drive.measured, axis=0) + 1e-300 for drive in drives)
    return bool(np.max(np.abs(np.log(one / other))) > np.log(MUCH_LARGER))


def _most_typical(drives: Sequence[RecordedDrive]) -> int:
    """The run whose channels' sizes are nearest to the median."""
    able = may_be_held([drive.time.size for drive in drives])
    sizes = np.log([np.std(drive.measured, axis=0) + 1e-300 for drive in drives])
    distance = np.sum((sizes - np.median(sizes, axis=0)) ** 2, axis=1)
    return int(able[np.argmin(distance[able])])
