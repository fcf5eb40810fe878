"""Which cases there are, and which of them are asked for."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from inerter.validate import exudyn_engine, mujoco_engine
from inerter.validate.case import PUBLISHED, Case
from inerter.validate.inputs import INPUTS
from inerter.validate.laws import LAWS
from inerter.validate.models import ValidationModel, models
from inerter.validate.task import Task, Wanted

ENGINES = {"mujoco": mujoco_engine.INTEGRATORS, "exudyn": exudyn_engine.INTEGRATORS}
"""Integrators by engine."""

# one law of each kind where not all of them are run
_SUBSET = (PUBLISHED, "coulomb", "lugre", "backlash")
_SHORT = {"load_on_lugre": 1.0, "load_on_maxwell_slip": 1.0}
"""Durations of laws that take the reference long [s]; they slide and stick within it."""

_LONG = 10.0
_LONG_INTEGRATORS = ("RK4", "DOPRI5")


class SelectionError(ValueError):
    """A name that is none: says which, and what there is."""


@dataclass(frozen=True)
class Selection:
    """Names that are asked for; empty means all of that kind."""

    models: tuple[str, ...] = ()
    laws: tuple[str, ...] = ()
    engines: tuple[str, ...] = ()
    integrators: tuple[str, ...] = ()
    quick: bool = False

    def __post_init__(self) -> None:
        """Check the names."""
        integrators = [name for names in ENGINES.values() for name in names]
        _check("--model", self.models, model_choices())
        _check("--law", self.laws, [PUBLISHED, *LAWS])
        _check("--engine", self.engines, ENGINES)
        _check("--integrator", self.integrators, integrators)


def model_choices() -> list[str]:
    """What `--model` may be: a model, or a model in one layout."""
    names: dict[str, None] = {}
    for key, model in models().items():
        names |= dict.fromkeys((*model.files, model.name, key))
    return list(names)


def plan(selection: Selection, exudyn: bool = True) -> list[Task]:
    """The tasks, the longest first.

    Raises SelectionError if the names leave nothing to run.
    """
    tasks = []
    for case in _quick() if selection.quick else _all():
        if selection.laws and case.law not in selection.laws:
            continue
        wanted = tuple(_wanted(case, selection, exudyn))
        if wanted:
            tasks.append(Task(case, wanted))
    if not tasks and not exudyn:
        raise SelectionError(
            "no case is left without Exudyn, which is not installed: "
            "pip install exudyn (the extra `exudyn`), or ask for --engine mujoco"
        )
    if not tasks:
        raise SelectionError(
            "no case is left by --model, --law, --engine and --integrator together; "
            "leave one of them out"
        )
    return sorted(tasks, key=_cost, reverse=True)


def _all() -> list[Case]:
    found = [_case("quarter_car/S2", law, "road") for law in LAWS]
    found += [
        _case("quarter_car/S2", law, kind)
        for kind in INPUTS[1:]
        for law in ("ideal", "lugre", "backlash")
    ]
    found += [_case("quarter_car/S3", law, "road") for law in ("coulomb", "lugre")]
    for key in ("half_car/S2", "full_car/S2", "tuned_inerter_damper/floors"):
        found += [_case(key, law, "road") for law in _SUBSET]
    for key in models():
        if (key, PUBLISHED) not in {(case.model, case.law) for case in found}:
            found.append(_case(key, PUBLISHED, "road"))
        found.append(Case(key, PUBLISHED, "road", _LONG, headline=True))
    for key in ("tuned_inerter_damper/floors", "fluid_inerter/complete"):
        found += [_case(key, PUBLISHED, kind) for kind in INPUTS[1:]]
    return found


def _quick() -> list[Case]:
    """One law of each kind, one model of each tree."""
    laws = ("ideal", "series", "lugre", "coulomb")
    found = [_case("quarter_car/S2", law, "road") for law in laws]
    found += [_case("quarter_car/S2", "ideal", "step"), _case("quarter_car/S3", PUBLISHED, "road")]
    found.append(_case("tuned_inerter_damper/floors", PUBLISHED, "sine"))
    found.append(_case("half_car/S2", PUBLISHED, "road"))
    found.append(Case("quarter_car/S2", PUBLISHED, "road", _LONG, headline=True))
    return found


def _case(model: str, law: str, kind: str) -> Case:
    return Case(model, law, kind, _SHORT.get(law, models()[model].duration))


def _wanted(case: Case, selection: Selection, exudyn: bool) -> Iterable[Wanted]:
    setup = case.setup
    for engine, integrators in ENGINES.items():
        if (selection.engines and engine not in selection.engines) or (
            engine == "exudyn" and not exudyn
        ):
            continue
        # Exudyn knows one model where MuJoCo has several trees for it
        for name in setup.files if engine == "mujoco" else (setup.name,):
            if selection.models and not _asked(setup, name, selection.models):
                continue
            for integrator in integrators:
                if selection.integrators and integrator not in selection.integrators:
                    continue
                if not case.headline or integrator in _LONG_INTEGRATORS:
                    yield Wanted(engine, integrator, name)


def _asked(setup: ValidationModel, name: str, asked: Sequence[str]) -> bool:
    """Whether a row is asked for: by its name, or by a model with all its files."""
    return name in asked or setup.key in asked or setup.name in asked


def _cost(task: Task) -> float:
    """Roughly how long a task takes, relative to others."""
    size = len(task.case.setup.inerters) + 1
    spatial = 3.0 if task.case.setup.scale != 1.0 else 1.0
    return task.case.duration / task.case.setup.step * size * spatial * len(task.wanted)


def _check(option: str, given: Sequence[str], known: Iterable[str]) -> None:
    names = list(known)
    for name in given:
        if name not in names:
            small = {known.lower(): known for known in names}
            near = difflib.get_close_matches(name.lower(), small, n=1)
            hint = f"; did you mean {small[near[0]]}?" if near else ""
            raise SelectionError(f"{option}: no {name!r}, there is {', '.join(names)}{hint}")
