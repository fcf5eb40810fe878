"""Time and evaluations of a fit: along the motion, with mujoco.sysid, with SciPy's differences.

The record of docs/examples/fit_with_mujoco_sysid.py, a LuGre device on a bench, fitted from the
same start by all: seven parameters, off by a third. An evaluation is one prediction of the record:
a simulation for mujoco.sysid, the device's law along the motion for the others. `identify` does
more than one fit: it chooses the smoothing for the model, allows for the noise of the motion, and
by default starts in 96 places and gives profile intervals. Time is what the process computes.

A second device, without a state, has parameters that enter in proportion, whose derivatives need no
evaluation.

Last come whole identifications of the records that are diagnosed in `diagnosis.py`: with the usual
laws and with every one. They work on all cores, and are timed by the clock on the wall.
"""

from __future__ import annotations

import contextlib
import importlib.util
import io
import logging
import sys
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from inerter import Device
from inerter.benchmark.rows import Row, aimed, spread_of
from inerter.benchmark.timing import Spread, Work, interleaved
from inerter.identify.estimate import identify
from inerter.identify.fit import Problem
from inerter.identify.laws import LAWS
from inerter.identify.model import Model
from inerter.identify.runs import thin
from inerter.records import Record, read_records
from inerter.records.preparation import prepare
from scipy.optimize import least_squares

from benchmarks.diagnosis import folder, made

EXAMPLE = Path(__file__).parents[1] / "docs" / "examples" / "fit_with_mujoco_sysid.py"
SYSID, SCIPY = "mujoco.sysid", "SciPy, 2-point differences"
ONE = "one fit along the motion"

# without a state, most of it in proportion
PLAIN = {
    "inertance": 60.0, "viscous": 150.0, "stiffness": 900.0, "quadratic_damping": 120.0,
    "force_offset": 3.0, "friction": "coulomb", "coulomb_force": 12.0, "transition_velocity": 1e-3,
}  # fmt: skip
Values = Mapping[str, float]

EVERY = (*LAWS, "bouc_wen_any", "rate_state", "fluid")
AIM = "<= 10"
MEASURED = ("rack_inerter/r16_*.csv", "friction_damper/*.csv")


def has_sysid() -> bool:
    """Whether mujoco.sysid and what it needs are installed."""
    try:
        from mujoco import sysid
    except ImportError:
        return False
    return hasattr(sysid, "optimize")


def notes() -> list[str]:
    """What is left out here."""
    return [] if has_sysid() else ['mujoco.sysid is left out: pip install "mujoco[sysid]"']


def example() -> Any:
    """The example as a module."""
    name = EXAMPLE.stem
    if name not in sys.modules:
        spec = importlib.util.spec_from_file_location(name, EXAMPLE)
        if spec is None or spec.loader is None:
            raise FileNotFoundError(f"{EXAMPLE} is missing; run the benchmarks in a checkout")
        module = importlib.util.module_from_spec(spec)
        sys.modules[name] = module
        spec.loader.exec_module(module)
    return sys.modules[name]


class Counted:
    """A way to fit: parameters found, and predictions of the record in the last call."""

    def __init__(self, fit: Callable[[Counted], Values]) -> None:
        self._fit, self.evaluations, self.found = fit, 0, {}

    def __call__(self) -> None:
        self.evaluations = 0
        self.found: Values = self._fit(self)


def run(quick: bool = False, seconds: float | None = None, rounds: int | None = None) -> list[Row]:
    """Fit in every way.

    Parameters
    ----------
    quick
        One round.
    seconds, rounds
        Of the records, and how often; by default 10 s, and as `quick` says.

    Returns
    -------
    list of dict
        `question`, `device`, `way`, `seconds` with quartiles, `evaluations` (None where they are
        not counted), `error` (largest relative error of a parameter), `against`, `ratio` (how many
        times less time the way takes), `aim`, `met`; but in a quick one those of `whole`, too.
    """
    rounds = rounds or (1 if quick else 5)
    lugre = _lugre(seconds or 10.0)
    rows = _rows("LuGre", lugre, example().TRUTH, rounds, [
        ("a fit against mujoco.sysid", ONE, SYSID, ">= 20"),
        ("a fit against SciPy's differences", ONE, SCIPY, None),
        ("identify against mujoco.sysid", "identify, one start, normal intervals", SYSID, None),
        ("identify against mujoco.sysid", "identify", SYSID, None),
    ])  # fmt: skip
    truth = {key: value for key, value in PLAIN.items() if isinstance(value, float)}
    del truth["transition_velocity"]
    rows += _rows("Coulomb", _plain(seconds or 10.0), truth, rounds, [
        ("a fit against SciPy's differences", ONE, SCIPY, None),
    ])  # fmt: skip
    if quick:
        return rows
    return rows + [row for name, records in _benches().items() for row in whole(name, records)]


def whole(name: str, records: Sequence[Record], choices: Sequence[Sequence[str]] = ()) -> list[Row]:
    """Whole identifications of some records, with the usual laws and with every one.

    Parameters
    ----------
    name
        What the records are of.
    records
        What is identified.
    choices
        Laws, by default those two choices.

    Returns
    -------
    list of dict
        As of `run`, and the number of `samples`.
    """
    rows = []
    for laws in choices or (LAWS, EVERY):
        start = time.perf_counter()
        identify(records, laws)
        spent = time.perf_counter() - start
        rows.append(
            {
                "question": "identify, seconds", "device": name, "way": f"{len(laws)} laws",
                **spread_of("seconds", Spread(spent, spent, spent)), "evaluations": None,
                "error": None, "against": None, **_NO_RATIO, **aimed(spent, AIM),
                "samples": sum(record.samples for record in records),
            }
        )  # fmt: skip
    return rows


def _benches() -> dict[str, Sequence[Record]]:
    """Made and measured records by what they are of."""
    found: dict[str, Sequence[Record]] = {"LuGre friction": made("LuGre friction")}
    if where := folder():
        for pattern in MEASURED:
            read = read_records([where / pattern], "bench")
            found[pattern] = [record for record in read if isinstance(record, Record)]
    return found


def _rows(
    device: str, ways: dict[str, Counted], truth: Values, rounds: int, questions: list[Any]
) -> list[Row]:
    works = {name: Work(way) for name, way in ways.items()}
    with _quiet():
        # what a first call loads is not of a fit
        for name in (ONE, SCIPY):
            ways[name]()
        times = interleaved(works, rounds, warm_up=False, clock=time.process_time)
    rows = []
    asked = {way for _, way, other, _ in questions if other in ways}
    alone = [(None, way, None, None) for way in ways if way not in asked]
    for question, way, other, aim in (*alone, *(q for q in questions if q[2] in (*ways, None))):
        ratio = times[other].ratio(times[way]) if other else Spread(1.0, 1.0, 1.0)
        found = ways[way].found
        rows.append(
            {
                "question": question, "device": device, "way": way,
                **spread_of("seconds", times[way].spread),
                "evaluations": ways[way].evaluations or None,
                "error": max(abs(found[key] / value - 1) for key, value in truth.items()),
                "against": other,
                **(spread_of("ratio", ratio) if other else _NO_RATIO), **aimed(ratio.median, aim),
            }
        )  # fmt: skip
    return rows


_NO_RATIO = {"ratio": None, "ratio_lower": None, "ratio_upper": None}


@contextlib.contextmanager
def _quiet() -> Iterator[None]:
    """Without what optimisers print."""
    logging.disable(logging.INFO)
    try:
        with contextlib.redirect_stdout(io.StringIO()):
            yield
    finally:
        logging.disable(logging.NOTSET)


# ------------------------------ ways --------------------------------------------------------------


def _lugre(seconds: float) -> dict[str, Counted]:
    """The example's record, fitted in every way."""
    fit = example()
    fit.SECONDS = seconds
    t, force, position = fit.measured()
    record, guess = fit.record_of(t, force, position), fit.start_values()
    start = {**guess, "static_excess": guess["static_force"] - guess["coulomb_force"]}
    start["presliding"] = guess["coulomb_force"] / start.pop("bristle_stiffness")
    del start["static_force"]
    model = Model("lugre", start, tuple(start))

    def by_sysid(counted: Counted) -> Values:
        write = fit.write

        def counting(*arguments: Any) -> None:
            counted.evaluations += 1
            write(*arguments)

        fit.write = counting
        try:
            return fit.by_sysid(t, force, position)
        finally:
            fit.write = write

    def by_identify(**options: Any) -> Counted:
        def found(counted: Counted) -> Values:
            best = identify([record], ["lugre"], **options).best
            return {key: best.parameters[key].value for key in fit.TRUTH}

        return Counted(found)

    ways = {SYSID: Counted(by_sysid)} if has_sysid() else {}
    return ways | {
        ONE: Counted(_one_fit(record, model)),
        SCIPY: Counted(_by_scipy(record, model)),
        "identify, one start, normal intervals": by_identify(starts=1, intervals="normal"),
        "identify": by_identify(),
    }


def _plain(seconds: float) -> dict[str, Counted]:
    """A device without a state, its parameters off by a third, up and down in turn."""
    spacing = 1e-3
    t = spacing * np.arange(round(seconds / spacing), dtype=np.float64)
    x, v, a = np.zeros((3, t.size))
    for size, frequency in ((0.02, 0.6), (0.004, 2.1), (0.0006, 6.3)):
        w = 2 * np.pi * frequency
        x, v, a = (x + size * np.sin(w * t), v + size * w * np.cos(w * t),
                   a - size * w**2 * np.sin(w * t))  # fmt: skip
    random = np.random.default_rng(1)
    force = Device(**PLAIN).along(spacing, x, v, a)["total"]
    record = Record(
        name="bench", time=t, displacement=x + 1e-7 * random.standard_normal(t.size),
        force=force + 0.2 * random.standard_normal(t.size),
    )  # fmt: skip
    values = {key: value for key, value in PLAIN.items() if isinstance(value, float)}
    free = tuple(key for key in values if key != "transition_velocity")
    for k, key in enumerate(free):
        values[key] *= 0.75 if k % 2 else 1.3
    model = Model("coulomb", values, free)
    return {
        ONE: Counted(_one_fit(record, model)), SCIPY: Counted(_by_scipy(record, model))
    }  # fmt: skip


def _problem(record: Record, counted: Counted) -> Problem:
    """The record as a fit has it; every prediction of it is counted."""

    class Counting(Problem):
        def errors(self, model: Model, pressed: float = 0.0, **which: bool) -> list[Any]:
            counted.evaluations += 1
            return super().errors(model, pressed, **which)

    runs = [thin(motion) for motion in prepare([record]).motions]
    return Counting(runs, [np.ones(run.force.size, bool) for run in runs])


def _values(model: Model) -> Values:
    device = model.device()
    return {key: float(getattr(device, key)) for key in device.given if key != "friction"}


def _one_fit(record: Record, model: Model) -> Callable[[Counted], Values]:
    """Smoothing, and the fit as `identify` makes it."""
    return lambda counted: _values(_problem(record, counted).fit(model, 100).model)


def _by_scipy(record: Record, model: Model) -> Callable[[Counted], Values]:
    """The same residual and the same variables, left to SciPy."""

    def fit(counted: Counted) -> Values:
        problem = _problem(record, counted)
        variables = problem.variables(model)
        start, (lower, upper) = variables.encode(model.values), variables.bounds
        masks = np.concatenate(problem.masks)

        def residual(point: np.ndarray) -> np.ndarray:
            there = problem.moved(model, point - start)
            return np.concatenate(problem.residual(there))[masks] / problem.scales.force

        found = least_squares(
            residual, np.clip(start, lower + 1e-9, upper - 1e-9), bounds=(lower, upper),
            xtol=1e-7, ftol=1e-9, gtol=1e-10, max_nfev=100,
        )  # fmt: skip
        return _values(problem.moved(model, found.x - start))

    return fit
