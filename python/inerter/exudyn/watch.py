"""Lets devices follow their system: what they read when it is assembled, changed, or solved.

Exudyn has no call-back for these moments, but builds much of MainSystem in Python; so do we. The
functions named in `install` do all that they did, and tell the devices of that system, if it has
any.
"""

from __future__ import annotations

import functools
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from copy import copy
from dataclasses import replace
from typing import Any

from inerter.core import names
from inerter.exudyn import control
from inerter.exudyn.carriers import follow
from inerter.exudyn.changes import (
    KEPT,
    KEPT_MASS,
    change_parameters,
    models_of,
    read_geometry,
    read_start,
    take,
)
from inerter.exudyn.engine import exudyn
from inerter.exudyn.inerter import Model
from inerter.exudyn.kinematics import Line
from inerter.exudyn.parameters import ALIASES

GEOMETRY = {
    "SetNodeParameter": ("referenceCoordinates",),
    "SetMarkerParameter": ("localPosition", "coordinate"),
    "SetObjectParameter": ("referencePosition", "referenceRotation"),
}
"""Parameters that move a terminal, by the function that sets them."""

IMPLICIT = ("GeneralizedAlpha", "TrapezoidalIndex2")


@functools.cache
def install() -> None:
    """Let MainSystem tell devices; once in a process."""
    system = exudyn().MainSystem
    system.Assemble = _telling_of_assembly(system.Assemble)
    for name in GEOMETRY:
        setattr(system, name, _telling_of_change(name, getattr(system, name)))
    system.Reset = _forgetting(system.Reset)
    for name, wrapped in (
        ("SolveDynamic", _careful(system.SolveDynamic)),
        ("SolveStatic", _still(system.SolveStatic)),
    ):
        for place in (system, exudyn(), exudyn("solver")):
            if hasattr(place, name):
                setattr(place, name, wrapped)


def _telling_of_assembly(original: Callable[..., Any]) -> Callable[..., Any]:
    @functools.wraps(original)
    def Assemble(self: Any) -> Any:  # noqa: N802 - Exudyn's name
        models = models_of(self)
        for model in models:
            read_geometry(self, model, assembling=True)
            read_start(self, model)
        done = original(self)
        # where markers start is known only now
        if [model for model in models if follow(self, model.carriers)]:
            for model in models:
                read_start(self, model)
            done = original(self)
        for model in models:
            model.forget()
        return done

    return Assemble


def _forgetting(original: Callable[..., Any]) -> Callable[..., Any]:
    @functools.wraps(original)
    def Reset(self: Any) -> Any:  # noqa: N802 - Exudyn's name
        self.variables.pop(KEPT, None)
        return original(self)

    return Reset


def _telling_of_change(name: str, original: Callable[..., Any]) -> Callable[..., Any]:
    @functools.wraps(original)
    def set_parameter(self: Any, number: Any, parameterName: str, value: Any) -> Any:
        models = models_of(self)
        if models and name == "SetObjectParameter" and _is_of_device(parameterName):
            for model in models:
                if int(model.objectNumber) == int(number):
                    return change_parameters(self, model, {parameterName: value})
        done = original(self, number, parameterName, value)
        if models and parameterName in GEOMETRY[name] and self.systemIsConsistent:
            for model in models:
                read_geometry(self, model)
        return done

    return set_parameter


def _is_of_device(name: str) -> bool:
    return name in names() or name in ALIASES


def _careful(original: Callable[..., Any]) -> Callable[..., Any]:
    @functools.wraps(original)
    def SolveDynamic(mbs: Any, *args: Any, **kwargs: Any) -> Any:  # noqa: N802 - Exudyn's name
        models = models_of(mbs)
        if not models:
            return original(mbs, *args, **kwargs)
        settings = kwargs.pop("simulationSettings", None)
        if settings is None and args:
            settings, args = args[0], args[1:]
        if settings is None:
            settings = exudyn().SimulationSettings()
        solver = kwargs.get("solverType") or (args[0] if args else None)
        name = getattr(solver or exudyn().DynamicSolverType.GeneralizedAlpha, "name", "")
        _refuse_threads(settings, models)
        if name not in IMPLICIT:
            for model in models:
                _refuse_points(model, name)
            _warn_of_constraints(mbs, models, name)
            with _mass_matrix(mbs, settings, models):
                return original(mbs, settings, *args, **kwargs)
        with (
            _mass_matrix(mbs, settings, models),
            _fresh_jacobians(settings, models),
            _soft_slip(mbs, models),
        ):
            return original(mbs, settings, *args, **kwargs)

    return SolveDynamic


def _still(original: Callable[..., Any]) -> Callable[..., Any]:
    @functools.wraps(original)
    def SolveStatic(mbs: Any, *args: Any, **kwargs: Any) -> Any:  # noqa: N802 - Exudyn's name
        settings = kwargs.get("simulationSettings") or (args[0] if args else None)
        if settings is not None and models_of(mbs):
            _refuse_threads(settings, models_of(mbs))
        moving = {
            int(model.objectNumber): model.element for model in models_of(mbs) if _goes_on(model)
        }
        models = [model for model in models_of(mbs) if int(model.objectNumber) in moving]
        for model in models:
            held = copy(model.element.device)
            held.still = True
            take(mbs, model, replace(model.element, device=held))
        try:
            return original(mbs, *args, **kwargs)
        finally:
            for model in models:
                take(mbs, model, moving[int(model.objectNumber)])

    return SolveStatic


def _goes_on(model: Model) -> bool:
    """Whether a state changes at rest, so that no static solution would end."""
    device = model.element.device
    return device.friction == "rate_state" or control.lags(device)


_IN_A_RUN = ("PreStep", "PostStep", "PostNewton", "PreNewtonResidual")


@contextmanager
def _mass_matrix(mbs: Any, settings: Any, models: list[Model]) -> Iterator[None]:
    """The mass matrix anew for every step, where an inertance may change in the run.

    Exudyn computes one that is constant once, and knows nothing of a parameter that changes; the
    run's acceleration would be the old one's. May change: what a control or a user function sets.
    """
    settings_of = settings.timeIntegration
    before = settings_of.reuseConstantMassMatrix
    still = [model for model in models if model.element.constant_mass]
    changing = any(model.device.control == "inertance" for model in still)
    if still and before and (changing or _has_user_function(mbs)):
        settings_of.reuseConstantMassMatrix = False
    mbs.variables[KEPT_MASS] = bool(settings_of.reuseConstantMassMatrix)
    try:
        yield
    finally:
        settings_of.reuseConstantMassMatrix = before
        mbs.variables.pop(KEPT_MASS, None)


def _has_user_function(mbs: Any) -> bool:
    """Whether something of the user's is called in every step."""
    known = [name for name in _IN_A_RUN if hasattr(mbs, f"Set{name}UserFunction")]
    asked = [getattr(mbs, f"Get{name}UserFunction", None) for name in known]
    # an Exudyn that cannot be asked may have one
    return any(ask is None or bool(ask()) for ask in asked)


@contextmanager
def _soft_slip(mbs: Any, models: list[Model]) -> Iterator[None]:
    """Elements of maxwell_slip that begin to slip over a knee, for a solver that iterates."""
    soft = [model for model in models if model.device.friction == "maxwell_slip"]
    try:
        for model in soft:
            _take_slip(mbs, model, True)
        yield
    finally:
        for model in soft:
            _take_slip(mbs, model, False)


def _take_slip(mbs: Any, model: Model, soft: bool) -> None:
    device = copy(model.element.device)
    device.soft_slip = soft
    take(mbs, model, replace(model.element, device=device))


def _refuse_threads(settings: Any, models: list[Model]) -> None:
    threads = settings.parallel.numberOfThreads
    if threads > 1:
        raise ValueError(
            f'inerter "{models[0].name}": settings.parallel.numberOfThreads is {threads}, and with '
            "several threads Exudyn hangs in user functions or loses forces of theirs; set it to 1"
        )


@contextmanager
def _fresh_jacobians(settings: Any, models: list[Model]) -> Iterator[None]:
    """A Jacobian for every step, where an inertance turns; set back afterwards.

    With that of an earlier direction modified Newton converges slowly, and after an impact not at
    all until the step is at its minimum, where it stays.
    """
    newton = settings.timeIntegration.newton
    before = newton.modifiedNewtonJacUpdatePerStep
    if not all(model.element.constant_mass for model in models):
        newton.modifiedNewtonJacUpdatePerStep = True
    try:
        yield
    finally:
        newton.modifiedNewtonJacUpdatePerStep = before


def _refuse_points(model: Model, solver: str) -> None:
    if model.carriers:
        raise ValueError(
            f'inerter "{model.name}": {solver} cannot solve the joint of its massless point, which '
            "carries the terminal on a cable, beam, tree or superelement; take GeneralizedAlpha"
        )


def _warn_of_constraints(mbs: Any, models: list[Model], solver: str) -> None:
    """Explicit solvers put a constrained coordinate back after a step, which is not exact there."""
    coupling = [model for model in models if _couples(model)]
    held = _constrained(mbs) if coupling else {}
    for model in coupling:
        name = next((held[int(node)] for node in model.nodeNumbers if int(node) in held), None)
        if name is not None:
            warnings.warn(
                f'inerter "{model.name}": {solver} puts the coordinate of constraint "{name}" back '
                "after each step, which is not exact where an inerter couples it to others (errors "
                "of 1e-3 were seen); take GeneralizedAlpha, or lock the coordinate by a large mass",
                stacklevel=3,
            )


def _couples(model: Model) -> bool:
    """Whether the mass matrix joins coordinates of nodes."""
    element = model.element
    alone = isinstance(element.kinematics, Line) and len(element.kinematics.places) == 1
    return not alone and "flywheel_velocity" not in element.own and bool(element.device.inertance)


def _constrained(mbs: Any) -> dict[int, str]:
    """The nodes that a CoordinateConstraint holds a coordinate of, and its name."""
    held: dict[int, str] = {}
    # every object is asked once: telling of itself is what an object is slowest at
    for number in range(mbs.systemData.NumberOfObjects()):
        try:
            item = mbs.GetObject(number)
        except TypeError:
            # Exudyn 1.9 cannot tell of an object with a symbolic function; it is no constraint
            continue
        if item["objectType"] == "ConnectorCoordinate":
            for marker in item["markerNumbers"]:
                node = mbs.GetMarker(marker).get("nodeNumber")
                if node is not None:
                    held.setdefault(int(node), item["name"])
    return held
