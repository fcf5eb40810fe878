"""A blind test in the terminal."""

from __future__ import annotations

from collections import Counter
from typing import Any

from rich.console import Console
from rich.table import Table
from rich.text import Text

from inerter.blind_test.plan import VEHICLE


def print_blind_test(result: dict[str, Any], console: Console) -> None:
    """Print what `score` found."""
    noise = 100 * result["settings"]["noise"]
    bench = result["settings"]["bench"]
    where, of = f"on {bench} benches", "the force rms"
    if bench == VEHICLE:
        where, of = "in vehicles", "each channel's spread"
    console.print(Text(f"Blind test {where}, seed {result['seed']}, noise {noise:g} % of {of}"))
    if result["effects"]:
        console.print(_effects(result))
    for line in _lines(result):
        console.print(Text(line), soft_wrap=True)
    crashed = [one for one in result["failures"] if one["error"]]
    for one in crashed:
        text = f"failed: {', '.join(one['hidden'])}, seed {one['seed']}: {one['error']}"
        console.print(Text(text, style="red"), soft_wrap=True)


def _effects(result: dict[str, Any]) -> Table:
    table = Table(box=None, padding=(0, 2, 0, 0), header_style="dim")
    table.add_column("hidden", no_wrap=True)
    for name in ("cases", "first", "found", "alone", "near", "gain", "s"):
        table.add_column(name, justify="right", no_wrap=True)
    table.add_column("else first")
    matrix = result["confusion"]
    for effect, found in [*result["effects"].items(), ("all", result["single"])]:
        others = _others(matrix, effect)
        table.add_row(
            effect,
            str(found["cases"]),
            _percent(found["named_first"]),
            _percent(found["found"]),
            _percent(found["alone"]),
            _percent(found["parameters_near"]),
            _percent(found["gain_on_truth"]["median"]),
            f"{found['seconds']['median']:.1f}",
            others,
        )
    return table


def _others(matrix: dict[str, Any], effect: str) -> str:
    """What was named first in the place of an effect, the most frequent first."""
    if effect not in matrix["hidden"]:
        return ""
    row = matrix["counts"][matrix["hidden"].index(effect)]
    counts = Counter(dict(zip(matrix["named"], row, strict=True)))
    wrong = [(name, n) for name, n in counts.most_common(4) if n and name != effect]
    return ", ".join(f"{name} {n}" for name, n in wrong[:3])


def _lines(result: dict[str, Any]) -> list[str]:
    lines = []
    if (part := result["clean"])["cases"]:
        lines.append(
            f"clean: {_cases(part['cases'])}, {_percent(part['without_findings'])} without findings"
            + _names(part["invented"], "; invented")
        )
    for group in ("pairs", "triples"):
        if (part := result[group])["cases"]:
            lines.append(
                f"{group}: {_cases(part['cases'])}, all found {_percent(part['all_found'])}, any "
                f"{_percent(part['any_found'])}, with extras {_percent(part['with_extras'])}"
                + _names(part["missed"], "; missed")
            )
    if (part := result["unknown"])["cases"]:
        lines.append(
            f"unknown: {_cases(part['cases'])}, {_percent(part['significant'])} called "
            f"unexplained, {_percent(part['wrong_claim'])} with a wrong finding given 90 % or more"
        )
    if (part := result["trust"])["cases"]:
        lines.append(
            f"all {_cases(part['cases'])}: found {_percent(part['found'])} (in "
            f"{part['cannot_tell']} more the motion cannot tell, as was said), nothing false "
            f"{_percent(part['nothing_false'])}; of {part['claims']} findings given 90 % or more "
            f"{_percent(part['wrong_claims'])} wrong, of {part['described']} that look like what "
            f"is there {_percent(part['wrong_described'])}; 2 standard errors hold "
            f"{_percent(part['covered'])}"
            + _names(part["wrong"], "; wrong")
            + _names(part["missed"], "; missed")
        )
    bins = [part for part in result["calibration"] if part["findings"]]
    if bins:
        shown = [
            f"{part['from']:g}-{part['to']:g}: {_percent(part['right'])} of {part['findings']}"
            for part in bins
        ]
        lines.append(f"right by confidence: {', '.join(shown)}")
    seconds = result["seconds_per_case"]
    lines.append(
        f"{seconds['median']:.1f} s per case ({seconds['processor_median']:.1f} s of processor), "
        f"at most {seconds['worst']:.1f} s (seed {seconds['worst_seed']}); "
        f"{result['seconds']:.0f} s in all; {_failures(len(result['failures']))} in "
        "blind_test.json"
    )
    return lines


def _names(counts: dict[str, int], before: str) -> str:
    if not counts:
        return ""
    return f"{before}: {', '.join(f'{name} {n}' for name, n in list(counts.items())[:5])}"


def _percent(share: float | None) -> str:
    return "" if share is None else f"{100 * share:.0f} %"


def _failures(number: int) -> str:
    return f"{number} failure" if number == 1 else f"{number} failures"


def _cases(number: int) -> str:
    return f"{number} case" if number == 1 else f"{number} cases"
