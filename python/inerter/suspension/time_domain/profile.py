"""Roads that are no random ones: a bump, or heights along the way out of a file.

`bump:HEIGHT/LENGTH` in m: height/2 (1 - cos(2 pi x / length)). A file of heights has the columns
`distance` [m], ascending, and `height` [m], or `height_left` and `height_right`; before and behind
it the road stays at the first and the last height, the first counts as 0.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_GAP = 10.0
"""Times the usual distance of rows, and more than 1 m, that is a gap in the record."""
_NEAR, _CLIFF = 2.0, 1.0
"""Within so many metres along the road its height changes by no more than so many."""


@dataclass(frozen=True, eq=False)
class Profile:
    """`name` to be shown, `distance` [m] (n,), heights `left` and `right` [m], `speed` [m/s]."""

    name: str
    distance: Array
    left: Array
    right: Array
    speed: float

    @property
    def duration(self) -> float:
        """Seconds from its beginning to its end."""
        return float(self.distance[-1] - self.distance[0]) / self.speed

    def height(self, times: Array, behind: float = 0.0, y: float = 0.0) -> Array:
        """Heights [m] at times [s] under a wheel that is `behind` [m], `y` [m] to the left."""
        x = self.distance[0] + self.speed * times - behind
        if y == 0.0:
            return np.interp(x, self.distance, 0.5 * (self.left + self.right))
        return np.interp(x, self.distance, self.left if y > 0.0 else self.right)


def profile_named(name: str, speed: float) -> Profile | None:
    """The profile of `bump:HEIGHT/LENGTH` or of a file .csv; None of another name.

    Raises
    ------
    ValueError
        A bump without length, a file that cannot be used, or a speed that is not positive.
    """
    if not (name.startswith("bump:") or name.lower().endswith(".csv")):
        return None
    if not (math.isfinite(speed) and speed > 0.0):
        raise ValueError(f"speed is {speed:g} m/s: give a positive number")
    return _bump(name, speed) if name.startswith("bump:") else _file(Path(name), speed)


def _bump(name: str, speed: float) -> Profile:
    words = name.removeprefix("bump:").split("/")
    try:
        height, length = (float(word) for word in words)
    except ValueError:
        raise ValueError(
            f"road {name!r}: give bump:HEIGHT/LENGTH in m, as in bump:0.05/0.5"
        ) from None
    if not (math.isfinite(height) and abs(height) <= 1.0 and height != 0.0):
        raise ValueError(f"road {name!r}: the height is {height:g} m; give one up to 1 m, not 0")
    if not 0.0 < length < 1e4:
        raise ValueError(f"road {name!r}: the length is {length:g} m; give one above 0")
    x = np.linspace(0.0, length, 2001)
    bump = 0.5 * height * (1.0 - np.cos(2.0 * np.pi * x / length))
    return Profile(name, x, bump, bump, speed)


def _file(path: Path, speed: float) -> Profile:
    import polars as pl

    try:
        # as text, so that a row that is no number can be named
        table = pl.read_csv(path, infer_schema=False)
    except (OSError, pl.exceptions.PolarsError) as error:
        raise ValueError(f"{path}: cannot be read as a CSV file of a road ({error})") from None
    sides = ["height_left", "height_right"] if "height_left" in table.columns else ["height"]
    missing = [name for name in ("distance", *sides) if name not in table.columns]
    if missing:
        raise ValueError(
            f"{path}: no column {missing[0]!r}; a road has distance [m] and height [m], or "
            "height_left and height_right"
        )
    if len(table) < 2:
        raise ValueError(f"{path}: give two or more rows of numbers")
    x, *heights = (_numbers(path, name, table[name].to_list()) for name in ("distance", *sides))
    if (np.diff(x) <= 0.0).any():
        row = int(np.argmax(np.diff(x) <= 0.0)) + 2
        raise ValueError(f"{path}: distance does not rise at row {row}; sort the file by it")
    _refuse_gap(path, x, heights)
    for height in heights:
        _refuse_cliff(path, x, height)
    left, right = heights[0] - heights[0][0], heights[-1] - heights[-1][0]
    return Profile(str(path), x, left, right, speed)


def _numbers(path: Path, name: str, words: Sequence[str | None]) -> Array:
    """The values of a column; rows count from 1 below the header."""
    found = np.empty(len(words))
    for i, word in enumerate(words):
        try:
            found[i] = float(word or "")
        except ValueError:
            found[i] = math.nan
        if not math.isfinite(found[i]):
            told = f"is {word.strip()}" if word and word.strip() else "is empty"
            raise ValueError(
                f"{path}: {name} of row {i + 1} {told}: give a number, or leave the row out"
            )
    return found


def _refuse_gap(path: Path, x: Array, heights: Sequence[Array]) -> None:
    """Refuse rows that are missing; where the heights before and behind are equal it is flat."""
    steps = np.diff(x)
    usual = float(np.median(steps))
    most = max(_GAP * usual, 1.0)
    uneven = np.any([np.diff(height) != 0.0 for height in heights], axis=0)
    wide = (steps > most * (1.0 + 1e-9)) & uneven
    if wide.any():
        i = int(np.argmax(wide))
        raise ValueError(
            f"{path}: no rows between distance {x[i]:.9g} and {x[i + 1]:.9g} m, where rows are "
            f"usually {usual:.3g} m apart: give those heights or use the road on one side alone; "
            f"if it is straight there, give a row every {most:.3g} m"
        )


def _refuse_cliff(path: Path, x: Array, height: Array) -> None:
    """Refuse heights that change as no road does: hills may be high, but over a distance."""
    for ahead in np.linspace(_NEAR / 8.0, _NEAR, 8):
        change = np.abs(np.interp(x + ahead, x, height) - height)
        i = int(np.argmax(change))
        if change[i] > _CLIFF:
            raise ValueError(
                f"{path}: the height changes by {change[i]:.3g} m within {ahead:.3g} m of distance "
                f"{x[i]:.9g} m, which is no road: give m; did you mean mm, {change[i] / 1e3:.3g} m?"
            )
