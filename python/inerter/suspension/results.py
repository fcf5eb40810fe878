"""What is read out of the rows of a sweep: curves over stiffness, improvement over S1, notes."""

from __future__ import annotations

from collections.abc import Iterable

from inerter.suspension.sweep import Missed, SweepRow

Curve = tuple[list[float], list[float]]


def curves(rows: Iterable[SweepRow], index: str) -> dict[tuple[str, str], Curve]:
    """Stiffness [N/m] and value of each (layout, series), ascending; S1 once, its series none."""
    found: dict[tuple[str, str], dict[float, float]] = {}
    for row in rows:
        if row.case.index == index:
            series = row.case.series if row.case.problem.network.has_inerter else "none"
            points = found.setdefault((row.case.layout, series), {})
            points[row.case.stiffness] = row.optimum.value
    return {name: (sorted(p), [p[k] for k in sorted(p)]) for name, p in found.items()}


def improvements(rows: Iterable[SweepRow], index: str) -> dict[tuple[str, str], Curve]:
    """Stiffness and improvement over S1 in per cent of each other (layout, series)."""
    lines = curves(rows, index)
    base = lines.pop(("S1", "none"), None) or lines.pop(("SW1", "none"), None)
    if base is None:
        return {}
    return {
        name: (k, [100.0 * (1.0 - v / s) for v, s in zip(values, base[1], strict=True)])
        for name, (k, values) in lines.items()
    }


def improvement(rows: Iterable[SweepRow]) -> dict[int, float]:
    """Improvement over S1 in per cent of each row by its place, where S1 was asked for too."""
    listed = list(rows)
    base = {
        (row.case.index, row.case.stiffness, row.case.rear): row.optimum.value
        for row in listed
        if row.case.problem.network.own == "S1"
    }
    keys = [(row.case.index, row.case.stiffness, row.case.rear) for row in listed]
    return {
        n: 100.0 * (1.0 - row.optimum.value / base[key])
        for n, (row, key) in enumerate(zip(listed, keys, strict=True))
        if key in base and row.case.problem.network.own != "S1"
    }


def notes(rows: Iterable[SweepRow]) -> list[str]:
    """Each remark once, with what it is about."""
    about: dict[str, dict[str, list[float]]] = {}
    for row in rows:
        for note in row.optimum.notes:
            case = row.case
            name = f"{case.layout} {case.index}"
            if case.problem.pair is not None:
                name += f" {case.series}"
            stiffnesses = about.setdefault(note, {}).setdefault(name, [])
            if case.stiffness not in stiffnesses:
                stiffnesses.append(case.stiffness)
    return [
        f"{'; '.join(f'{name} at k = {_range(ks)} kN/m' for name, ks in groups.items())}: {note}"
        for note, groups in about.items()
    ]


def missed_notes(missed: Iterable[Missed]) -> list[str]:
    """What no design keeps, each sentence once, with the stiffnesses it is of."""
    about: dict[str, list[float]] = {}
    for each in missed:
        stiffnesses = about.setdefault(each.told, [])
        if each.case.stiffness not in stiffnesses:
            stiffnesses.append(each.case.stiffness)
    return [f"{told} (at k = {_range(ks)} kN/m)" for told, ks in about.items()]


def _range(stiffnesses: list[float]) -> str:
    low, high = min(stiffnesses) / 1e3, max(stiffnesses) / 1e3
    if len(stiffnesses) < 3:
        return " and ".join(f"{k / 1e3:g}" for k in stiffnesses)
    return f"{low:g} ... {high:g} ({len(stiffnesses)} values)"
