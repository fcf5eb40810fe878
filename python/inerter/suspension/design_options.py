"""Words of a user on what a design may be: given values, ranges, catalogues, limits of indices."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from pathlib import Path

from inerter.suspension.indices import INDICES
from inerter.suspension.layouts import LAYOUTS, Layout
from inerter.suspension.network_file import read_network
from inerter.suspension.study import Allowed, StudyError, read_layouts


def read_allowed(design: Sequence[str], limit: Sequence[str], layouts: Iterable[Layout]) -> Allowed:
    """Of `--design` NAME=VALUE, NAME=LOW:HIGH or NAME=V/V/V, and `--limit` INDEX=VALUE.

    Raises
    ------
    StudyError
        A name that no layout has, an index that cannot be limited, or no positive numbers.
    """
    known = tuple(dict.fromkeys(name for one in layouts for name in one.variables))
    fixed: list[tuple[str, float]] = []
    ranges: list[tuple[str, float, float]] = []
    choices: list[tuple[str, tuple[float, ...]]] = []
    seen: set[str] = set()
    for text in design:
        name, value = _halves(text, "design", "NAME=VALUE, LOW:HIGH or V/V/V")
        if name not in known:
            raise StudyError(f"--design {text}: {name!r} is none of {', '.join(known)}")
        if name in seen:
            raise StudyError(f"--design {text}: {name} is given twice")
        seen.add(name)
        if ":" in value:
            low, high = _numbers(text, value.split(":"), 2)
            if low >= high:
                raise StudyError(f"--design {text}: give LOW:HIGH, the lower one first")
            ranges.append((name, low, high))
        elif "/" in value:
            choices.append((name, tuple(_numbers(text, value.split("/"), None))))
        else:
            fixed.append((name, _numbers(text, [value], 1)[0]))
    limits = []
    smooth = [name for name, index in INDICES.items() if index.smooth]
    names = {name.lower(): name for name in smooth}
    for text in limit:
        name, value = _halves(text, "limit", "INDEX=VALUE")
        if name.lower() not in names:
            raise StudyError(f"--limit {text}: {name!r} is none of {', '.join(smooth)}")
        limits.append((names[name.lower()], _numbers(text, [value], 1)[0]))
    return Allowed(tuple(fixed), tuple(ranges), tuple(choices), tuple(limits))


def read_layouts_and_networks(text: str, networks: Sequence[Path]) -> dict[str, Layout]:
    """Layouts by name from a list with commas, and those of files.

    Raises
    ------
    ValueError
        A name that is not known, a file that is no network, a name given twice.
    """
    found = {name: LAYOUTS[name] for name in read_layouts(text)}
    for path in networks:
        own = read_network(path)
        if own.name in found:
            raise StudyError(f"{path}: name {own.name!r} is there already; choose another")
        found[own.name] = own
    return found


def _halves(text: str, option: str, form: str) -> tuple[str, str]:
    name, sign, value = (part.strip() for part in text.partition("="))
    if not (name and sign and value):
        raise StudyError(f"--{option} {text!r}: give {form}")
    return name, value


def _numbers(text: str, parts: Sequence[str], count: int | None) -> list[float]:
    try:
        values = [float(part) for part in parts]
    except ValueError:
        values = []
    if (
        not values
        or not all(0.0 < x < math.inf for x in values)
        or count
        not in (
            None,
            len(values),
        )
    ):
        raise StudyError(f"{text}: give positive numbers in SI units")
    return values
