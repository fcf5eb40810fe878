"""Work against precision: error after 10 s of a quarter-car against the time it took.

The car, its equations and the truth are in `precision_car.py`, the programs in
`precision_solvers.py`. Every program runs with coarser and finer settings; the time that it needs
for a given error is interpolated between them (both logarithmic).
"""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path

import numpy as np
from inerter.benchmark.rows import Row, aimed, spread_of
from inerter.benchmark.timing import Timing, interleaved, once
from inerter.exudyn.engine import installed as has_exudyn
from inerter.exudyn.engine import quiet
from inerter.simulate.checks import engine_warnings

from benchmarks.picture import COLOURS, figure, save
from benchmarks.precision_car import PROBLEMS, error_of
from benchmarks.precision_solvers import Attempt, Solver, absent, solvers

TARGETS = (1e-3, 1e-6, 1e-9)
# an error below this is the truth's own
FLOOR = 1e-12


def run(quick: bool = False, only: Sequence[str] = (), longest: float | None = None) -> list[Row]:
    """Measure every program on every problem.

    Parameters
    ----------
    quick
        Coarse settings and one round.
    only
        Parts of the names of the programs to take; all if empty.
    longest
        Processor time of a run [s] from which on a program is not refined further; by default as
        `quick` says.

    Returns
    -------
    list of dict
        First the runs: problem, solver, ours (whether the device is this project's), setting (step
        [s] or tolerance), error, milliseconds. Then what follows from them: for each `target` error
        the interpolated milliseconds of each solver and their ratio to the quickest one's, and how
        far the quickest of ours is ahead of the quickest of the others.
    """
    usual, rounds = (0.04, 1) if quick else (0.4, 5)
    longest = usual if longest is None else longest
    chosen = [s for s in solvers() if not only or any(part in s.name for part in only)]
    rows: list[Row] = []
    with ExitStack() as stack:
        stack.enter_context(engine_warnings())
        if has_exudyn():
            stack.enter_context(quiet())
        for problem in PROBLEMS:
            runs = [
                row
                for s in chosen
                if problem in s.problems
                for row in _explore(s, problem, longest)
            ]
            works = {str(k): attempt.work for k, (_, attempt) in enumerate(runs)}
            times = interleaved(works, rounds, warm_up=False, clock=time.process_time)
            rows += [row | _cost(times[str(k)]) for k, (row, _) in enumerate(runs)]
    return rows + [row for problem in PROBLEMS for row in _targets(problem, rows)]


def _explore(solver: Solver, problem: str, longest: float) -> list[tuple[Row, Attempt]]:
    """From coarse to fine until a run takes too long or nothing is left to gain."""
    found = []
    for setting in solver.settings:
        attempt = solver.attempt(problem, setting)
        try:
            seconds = once(attempt.work, time.process_time)
            error = error_of(problem, attempt.end())
        except (RuntimeError, OverflowError, ValueError):
            # an explicit method with too coarse a step
            continue
        if error < 1.0:
            row = {
                "problem": problem, "solver": solver.name, "ours": solver.ours, "setting": setting,
                "error": error, "target": None, "question": None, **dict.fromkeys(_RATIO),
            }  # fmt: skip
            found.append((row, attempt))
        if seconds > longest or error < FLOOR:
            break
    return found


_RATIO = ("ratio", "aim", "met")


def _cost(timing: Timing) -> dict[str, float]:
    return spread_of("milliseconds", timing.spread.times(1e3))


def time_for(target: float, errors: Sequence[float], times: Sequence[float]) -> float | None:
    """Time from which on the error stays at or below a target, in the order of the settings.

    None where the finest setting misses it. Where the coarsest one reaches it already, its time.
    """
    if not errors or errors[-1] > target:
        return None
    above = [k for k, error in enumerate(errors) if error > target]
    if not above:
        return times[0]
    k = above[-1]
    (e0, e1), (t0, t1) = np.log(errors[k : k + 2]), np.log(times[k : k + 2])
    return float(math.exp(t0 + (t1 - t0) * (math.log(target) - e0) / (e1 - e0)))


def _targets(problem: str, rows: Sequence[Row]) -> list[Row]:
    """Times for the target errors, and who is ahead."""
    here = [row for row in rows if row["problem"] == problem]
    names = dict.fromkeys((row["solver"], row["ours"]) for row in here)
    found: list[Row] = []
    empty = {"setting": None, "milliseconds_lower": None, "milliseconds_upper": None}
    for target in TARGETS:
        times: dict[tuple[str, bool], float] = {}
        for key in names:
            runs = [row for row in here if row["solver"] == key[0]]
            reached = time_for(
                target, [r["error"] for r in runs], [r["milliseconds"] for r in runs]
            )
            if reached is not None:
                times[key] = reached
        for (name, ours), spent in sorted(times.items(), key=lambda item: item[1]):
            found.append(
                {
                    "problem": problem, "solver": name, "ours": ours, "error": None,
                    "target": target, "question": None, "milliseconds": spent,
                    "ratio": spent / min(times.values()), "aim": None, "met": None, **empty,
                }
            )  # fmt: skip
        best = {}
        for (name, ours), spent in sorted(times.items(), key=lambda item: item[1]):
            best.setdefault(ours, (spent, name))
        if len(best) == 2:
            ahead = best[False][0] / best[True][0]
            found.append(
                {
                    "problem": problem, "solver": f"{best[True][1]} before {best[False][1]}",
                    "ours": True, "error": None, "target": target,
                    "question": f"{problem}: ahead of the next at {target:.0e}",
                    "milliseconds": best[True][0], "ratio": ahead,
                    **aimed(ahead, ">= 10" if target == 1e-6 else None), **empty,
                }
            )  # fmt: skip
    return found


def summary(rows: list[Row]) -> dict[str, list[Row]]:
    """A table for each problem, a line for each solver: milliseconds at the target errors."""
    found: dict[str, dict[str, Row]] = {meaning: {} for meaning in PROBLEMS.values()}
    for row in rows:
        if row["question"] is None:
            line = found[PROBLEMS[row["problem"]]].setdefault(
                row["solver"],
                {"solver": row["solver"]} | {f"ms at {target:.0e}": None for target in TARGETS},
            )
            if row["target"] is not None:
                line[f"ms at {row['target']:.0e}"] = row["milliseconds"]
    return {meaning: list(lines.values()) for meaning, lines in found.items()}


def picture(rows: list[Row], path: Path) -> None:
    """Error against time, both logarithmic, a panel for each problem."""
    made = figure(13.0, 6.2)
    panels = made.subplots(1, len(PROBLEMS), sharey=True, squeeze=False)[0]
    names = list(dict.fromkeys((row["solver"], row["ours"]) for row in rows if row["setting"]))
    for axes, (problem, meaning) in zip(panels, PROBLEMS.items(), strict=True):
        for name, ours in names:
            runs = [
                r for r in rows if r["setting"] and (r["problem"], r["solver"]) == (problem, name)
            ]
            group = [n for n, o in names if o == ours]
            colour = COLOURS["set"][group.index(name) % len(COLOURS["set"])]
            axes.plot(
                [r["milliseconds"] for r in runs], [r["error"] for r in runs],
                "o-" if ours else "s--", color=colour, ms=4, lw=1.6 if ours else 1.1,
                mfc=colour if ours else COLOURS["page"], label=name,
            )  # fmt: skip
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_title(meaning, fontsize=10, loc="left")
        axes.set_ylim(FLOOR, 1.0)
        axes.set_yticks([10.0**k for k in range(-12, 1, 3)])
        axes.minorticks_off()
        axes.set_xlabel("time for 10 s of simulation [ms]", fontsize=9)
    panels[0].set_ylabel("error at 10 s / largest displacement", fontsize=9)
    handles, labels = panels[0].get_legend_handles_labels()
    made.legend(
        handles, labels, loc="outside right center", frameon=False, fontsize=8,
        title="filled: with this project's device", title_fontsize=8, alignment="left",
    )  # fmt: skip
    save(made, path)


def notes() -> list[str]:
    """What is left out here."""
    return absent()
