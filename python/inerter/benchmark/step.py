"""What one step of a car costs in MuJoCo, with its devices made in different ways."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import Any

import mujoco

from inerter.benchmark.cars import NATIVE, PLUGIN, car_xml, jolt
from inerter.benchmark.python_way import coupled_steps, passive_callback
from inerter.benchmark.rows import Row, aimed, spread_of
from inerter.benchmark.timing import Timing, Work, interleaved
from inerter.plugin import load_plugin

CALLBACK, LOOP = "callback lugre", "python loop"
TOPOLOGIES = {"nested": "wheels in the body", "branches": "wheels beside the body"}
IDEAL, LUGRE = "plugin none", "plugin lugre"

# what a variant is held against, in the same topology: question, variant, against, aim
NESTED_QUESTIONS = (
    ("ideal inerter against armature", IDEAL, "armature", "<= 1.10"),
    *(("friction against armature", name, "armature", None) for name in PLUGIN if name != IDEAL),
    ("LuGre against native", LUGRE, "native lugre", "<= 1.05"),
    ("Coulomb against native", "plugin coulomb", "native friction loss", None),
    ("Python callback against plugin", CALLBACK, LUGRE, ">= 20"),
)
BRANCH_QUESTIONS = (
    ("coupling of branches against armature", IDEAL, "armature", "<= 1.30"),
    *(("friction against armature", name, "armature", None) for name in PLUGIN if name != IDEAL),
    ("Python loop against plugin", LOOP, IDEAL, ">= 20"),
)


def step_costs(
    cars: Sequence[str],
    integrators: Sequence[str],
    rounds: int,
    steps: int,
    progress: Callable[[float], None] = lambda share: None,
) -> list[Row]:
    """Cost of a step, every variant in turn, for each car, topology and integrator.

    Parameters
    ----------
    cars, integrators
        Of `inerter.benchmark.cars`.
    rounds, steps
        How often each variant runs, and how many steps of 1 ms from a kerb on.
    progress
        Called with the share that is done.

    Returns
    -------
    list of dict
        `car`, `topology`, `integrator`, `question`, `variant`, `microseconds` of a step with
        quartiles, `against` (another variant), `ratio` to it with quartiles, `added`, the ratio of
        what the two add to a step without devices, `aim`, `met`. Variants that answer no question
        have a row with None for these.
    """
    load_plugin()
    rows: list[Row] = []
    cases = [(car, branches) for car in cars for branches in (False, True)]
    for done, (car, branches) in enumerate(cases):
        for k, integrator in enumerate(integrators):
            works = _works(car, branches, integrator, steps)
            times = interleaved(works, rounds, clock=time.process_time)
            topology = "branches" if branches else "nested"
            labels = {"car": car, "topology": topology, "integrator": integrator}
            rows += [labels | row for row in _rows(times, branches)]
            progress((done + (k + 1) / len(integrators)) / len(cases))
    return rows


def tables(rows: Sequence[Row]) -> dict[str, list[Row]]:
    """For each car and topology a table by title: the cost of a step over the armature's.

    One line for each variant, one column for each integrator; the armature's own in microseconds.
    """
    found: dict[str, list[Row]] = {}
    for car, topology in dict.fromkeys((row["car"], row["topology"]) for row in rows):
        here = [row for row in rows if (row["car"], row["topology"]) == (car, topology)]
        cost = {(row["variant"], row["integrator"]): row["microseconds"] for row in here}
        integrators = dict.fromkeys(row["integrator"] for row in here)
        lines = [
            {"over the armature's": variant}
            | {
                name: cost[variant, name] / cost["armature", name]
                if (variant, name) in cost
                else None
                for name in integrators
            }
            for variant in (*NATIVE, *PLUGIN, CALLBACK, LOOP)
            if variant != "armature" and any(row["variant"] == variant for row in here)
        ]
        armature = {name: cost["armature", name] for name in integrators}
        lines.insert(0, {"over the armature's": "armature [µs]"} | armature)
        found[f"One step of a {car}, {TOPOLOGIES[topology]}"] = lines
    return found


def _works(car: str, branches: bool, integrator: str, steps: int) -> dict[str, Work]:
    """The variants of a car."""
    works = {}
    for made in (*NATIVE, *PLUGIN):
        # the armature of branches is another device, wrong but of the same cost
        if not branches or made in ("bare", "armature") or made in PLUGIN:
            works[made] = _stepping(car_xml(car, made, integrator, branches=branches), car, steps)
    few = max(1, steps // 10)
    if not branches:
        works[CALLBACK] = _with_callback(car_xml(car, "armature", integrator), car, few)
    elif integrator != "RK4":
        # its stages are out of reach between two half steps
        works[LOOP] = _loop(car_xml(car, "bare", integrator, branches=True), car, few)
    return works


def _stepping(xml: str, car: str, steps: int) -> Work:
    model, data, prepare = _start(xml, car)
    return Work(lambda: mujoco.mj_step(model, data, steps), steps, prepare)


def _with_callback(xml: str, car: str, steps: int) -> Work:
    model, data, prepare = _start(xml, car)

    def run() -> None:
        mujoco.set_mjcb_passive(passive_callback(model))
        try:
            mujoco.mj_step(model, data, steps)
        finally:
            mujoco.set_mjcb_passive(None)

    return Work(run, steps, prepare)


def _loop(xml: str, car: str, steps: int) -> Work:
    model, data, prepare = _start(xml, car)
    return Work(lambda: coupled_steps(model, data, steps), steps, prepare)


def _start(xml: str, car: str) -> tuple[Any, Any, Callable[[], None]]:
    model = mujoco.MjModel.from_xml_string(xml)
    data = mujoco.MjData(model)

    def prepare() -> None:
        mujoco.mj_resetData(model, data)
        data.qvel[:] = jolt(car)

    return model, data, prepare


def _rows(times: dict[str, Timing], branches: bool) -> list[Row]:
    questions = [
        question
        for question in (BRANCH_QUESTIONS if branches else NESTED_QUESTIONS)
        if question[1] in times
    ]
    asked = {variant for _, variant, _, _ in questions}
    rest = [(None, variant, None, None) for variant in times if variant not in asked]
    return [_row(times, *question) for question in (*rest, *questions)]


def _row(
    times: dict[str, Timing], question: str | None, variant: str, against: str | None, aim: Any
) -> Row:
    cost = times[variant].spread.times(1e6)
    row: Row = {"question": question, "variant": variant, **spread_of("microseconds", cost)}
    if against is None:
        nothing = dict.fromkeys(("ratio", "ratio_lower", "ratio_upper", "added", "aim", "met"))
        return row | {"against": None} | nothing
    ratio = times[variant].ratio(times[against])
    bare = times["bare"].spread.median
    own, other = (times[name].spread.median - bare for name in (variant, against))
    return row | {
        "against": against,
        **spread_of("ratio", ratio),
        "added": own / other if own > 0 and other > 0 else None,
        **aimed(ratio.median, aim),
    }
