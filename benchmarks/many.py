"""Many simulations at once: throughput of `mujoco.batch` against batch size and threads.

Two ways to step a batch: one step per call, as learning does, and all steps in one call, as sweeps
do. Against a single simulation that `mj_step` steps by itself: on one thread a batch can do no
better than that, and what it loses is the cost of handling many. One thread is timed by what the
process computes, so that a busy machine does not count; more threads by the clock on the wall too,
and they only help where cores are free (the load is in bench.json). The branches are quarter-cars
whose wheel stands beside the body, where the plugin carries the inertance.
"""

from __future__ import annotations

import os
import time
from pathlib import Path
from typing import Any

import mujoco
import mujoco.batch
from inerter.benchmark.cars import car_xml, jolt
from inerter.benchmark.rows import Row, aimed, spread_of
from inerter.benchmark.timing import Timing, Work, interleaved
from inerter.plugin import load_plugin
from matplotlib.ticker import NullLocator

from benchmarks.picture import COLOURS, figure, save

CAR, INTEGRATOR = "quarter-car", "implicitfast"
PLUGIN, NATIVE, BRANCHES = "plugin lugre", "native lugre", "plugin lugre, branches"
SIZES = (1, 16, 256, 4096, 65536)
# calls of one step that are enough to time one; simulations on which threads are compared
CALLS = 1000
COMPARED = (256, 4096)
CALLED, AT_ONCE = "one step per call", "all steps in one call"

# what threads gain, and whether they get in each other's way: that shows on a busy machine too
_CLOCKS = {
    time.perf_counter: "threads against one",
    time.process_time: "threads against one, processor time",
}

# name of a work: variant, way, simulations, threads
Case = tuple[str, str, int, int]


def model_of(variant: str) -> mujoco.MjModel:
    """A quarter-car with its device made in one of the ways compared."""
    load_plugin()
    made = variant.removesuffix(", branches")
    xml = car_xml(CAR, made, INTEGRATOR, branches=variant == BRANCHES)
    return mujoco.MjModel.from_xml_string(xml)


def thread_counts() -> list[int]:
    """1, 2, 4, ... up to the cores that this process may use."""
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    counts = [1]
    while 2 * counts[-1] <= (cores or 1):
        counts.append(2 * counts[-1])
    return counts


def run(quick: bool = False, sizes: tuple[int, ...] = SIZES, total: int | None = None) -> list[Row]:
    """Time batches.

    Parameters
    ----------
    quick
        Fewer rounds of fewer steps.
    sizes
        Simulations of a batch.
    total
        Steps of all simulations together in one measurement.

    Returns
    -------
    list of dict
        `question`, `variant`, `way`, `simulations`, `threads`, `steps_per_second` of all
        simulations together, `ratio` of the throughput to that of `against`, `aim`, `met`.
    """
    rounds = 3 if quick else 9
    total = total or (1 << 14 if quick else 1 << 17)
    models = {variant: model_of(variant) for variant in (PLUGIN, NATIVE, BRANCHES)}
    cases: list[Case] = [(v, AT_ONCE, n, 1) for v in models for n in sizes]
    cases += [(PLUGIN, CALLED, n, 1) for n in sizes]
    works: dict[Any, Work] = {variant: _alone(models[variant], total) for variant in models}
    works |= {case: _batch(models[case[0]], total, *case[1:]) for case in cases}
    times = interleaved(works, rounds, clock=time.process_time)
    rows = [_row("batch against one", case, times, "one alone", case[0]) for case in cases]
    rows += [
        _row("plugin against native", case, times, NATIVE, (NATIVE, *case[1:]))
        for case in cases
        if case[0] == PLUGIN and case[1] == AT_ONCE
    ]
    threaded = [
        (PLUGIN, AT_ONCE, n, threads)
        for n in dict.fromkeys(min(n, max(sizes)) for n in COMPARED)
        for threads in thread_counts()
    ]
    works = {case: _batch(models[PLUGIN], total, *case[1:]) for case in threaded}
    for clock, question in _CLOCKS.items():
        times = interleaved(works, rounds, clock=clock)
        rows += [
            _row(question, case, times, "1 thread", (*case[:3], 1))
            for case in threaded
            if case[3] > 1
        ]
    return rows


def _alone(model: mujoco.MjModel, total: int) -> Work:
    """One simulation on its own."""
    data = mujoco.MjData(model)
    speed = jolt(CAR)
    # shorter than a batch's: the motion has to be the same
    steps = min(total, CALLS)

    def start() -> None:
        mujoco.mj_resetData(model, data)
        data.qvel[:] = speed

    return Work(lambda: mujoco.mj_step(model, data, steps), steps, start)


def _batch(model: mujoco.MjModel, total: int, way: str, count: int, threads: int) -> Work:
    """A batch from a kerb on, so many steps that all simulations together make `total`."""
    worlds = mujoco.batch.Batch(model, count, threads)
    speeds = worlds.bind("qvel")
    steps = min(max(1, total // count), CALLS)

    def start() -> None:
        worlds.reset(stage=mujoco.mjtStage.mjSTAGE_NONE)
        speeds[:] = jolt(CAR)

    def call() -> None:
        for _ in range(steps):
            worlds.step()

    return Work(call if way == CALLED else lambda: worlds.step(nstep=steps), steps * count, start)


def _row(question: str, case: Case, times: dict[Any, Timing], against: str, other: Any) -> Row:
    variant, way, count, threads = case
    seconds = times[case].spread
    return {
        "question": question, "variant": variant, "way": way, "simulations": count,
        "threads": threads, "steps_per_second": 1.0 / seconds.median,
        "steps_per_second_lower": 1.0 / seconds.upper,
        "steps_per_second_upper": 1.0 / seconds.lower, "against": against,
        # more throughput is less time
        **spread_of("ratio", times[other].ratio(times[case])), **aimed(0.0, None),
    }  # fmt: skip


def picture(rows: list[Row], path: Path) -> None:
    """Throughput of one thread against batch size."""
    made = figure(8.0, 4.4)
    axes = made.subplots()
    lines: dict[tuple[str, str], dict[int, Row]] = {}
    for row in rows:
        if row["threads"] == 1:
            lines.setdefault((row["variant"], row["way"]), {})[row["simulations"]] = row
    for colour, ((variant, way), line) in zip(COLOURS["set"], lines.items(), strict=False):
        sizes = sorted(line)
        low, middle, high = (
            [1e-6 * line[n][f"steps_per_second{end}"] for n in sizes]
            for end in ("_lower", "", "_upper")
        )
        style = "o-" if way == AT_ONCE else "s--"
        axes.plot(sizes, middle, style, color=colour, ms=4, label=f"{variant}, {way}")
        axes.fill_between(sizes, low, high, color=colour, alpha=0.15, lw=0)
    axes.set_xscale("log")
    sizes = sorted({row["simulations"] for row in rows})
    axes.set_xticks(sizes, [f"{size:,}" for size in sizes])
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_ylim(bottom=0)
    axes.set_xlabel("simulations of a batch")
    axes.set_ylabel("million steps per second of one core")
    axes.legend(loc="best", fontsize=7, frameon=False)
    save(made, path)
