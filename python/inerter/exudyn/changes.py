"""What of a device can change after it is made: its geometry with the system's, its parameters."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from inerter.exudyn.element import FLYWHEEL, TURNED, Element
from inerter.exudyn.functions import NUMBERS
from inerter.exudyn.inerter import Model
from inerter.exudyn.kinematics import SHORTEST, Span
from inerter.exudyn.parameters import own_names
from inerter.exudyn.terminals import terminals

KEPT = "inerter_models"
"""Where in `mbs.variables` the devices of a system are kept."""


KEPT_MASS = "inerter_kept_mass"
"""Where it stands that a run goes on whose mass matrix Exudyn computes once."""


def models_of(mbs: Any) -> list[Model]:
    """The devices of a system."""
    return mbs.variables.get(KEPT, [])


def reference_length(kinematics: Span) -> float:
    """Distance of the terminals at the reference configuration [m]."""
    nothing = [0.0] * kinematics.size
    return kinematics.at(NUMBERS, nothing, nothing).length


def check_apart(mbs: Any, name: str, element: Element, nodes: Any) -> None:
    """Raise ValueError if the terminals start at one point."""
    if not isinstance(element.kinematics, Span):
        return
    length = element.kinematics.at(NUMBERS, *initial_coordinates(mbs, nodes)).length
    if length < SHORTEST:
        raise ValueError(
            f'inerter "{name}": its terminals are {length:g} m apart, which leaves it without a '
            "direction; put them apart, or use 1D coordinates"
        )


def initial_coordinates(mbs: Any, nodes: Any) -> tuple[list[float], list[float]]:
    """Coordinates and velocities of nodes at the start."""
    q: list[float] = []
    q_t: list[float] = []
    for node in nodes:
        told = mbs.GetNode(node)
        rest = [0.0] * len(told["referenceCoordinates"])
        q += list(told.get("initialCoordinates", rest))
        q_t += list(told.get("initialVelocities", told.get("initialCoordinates_t", rest)))
    return q, q_t


def read_geometry(mbs: Any, model: Model, assembling: bool = False) -> None:
    """Take the reference coordinates, local positions and ground positions as they are now.

    While a system is assembled, a rest length that was not given becomes the distance anew.
    """
    nodes, kinematics = _terminals_now(mbs, model, assembling)
    if [int(node) for node in nodes] != [int(node) for node in model.nodeNumbers]:
        raise ValueError(
            f'inerter "{model.name}": a terminal has moved to another node, which cannot change '
            f"once the device is made; make the device after that{_RENUMBERED}"
        )
    if kinematics != model.element.kinematics:
        element = replace(model.element, kinematics=kinematics)
        if assembling and model.free_length and isinstance(kinematics, Span):
            rest = reference_length(kinematics)
            model.device = model.device.replace(rest_length=rest)
            element = replace(element, device=element.device.with_device(model.device))
        take(mbs, model, element)
    if assembling:
        check_apart(mbs, model.name, model.element, model.nodeNumbers)


_RENUMBERED = (
    " (an item that is deleted gives the later ones other numbers: delete before CreateInerter)"
)


def _terminals_now(mbs: Any, model: Model, assembling: bool) -> tuple[Any, Any]:
    """Nodes and geometry of the terminals, or one line on what has become of them."""
    try:
        here = not assembling or mbs.GetObject(model.objectNumber)["name"] == model.name
        if here:
            return terminals(mbs, model.places)
        why = f"object {int(model.objectNumber)} is another one now"
    except TypeError:
        # Exudyn 1.9 cannot tell of an object with a symbolic function
        return terminals(mbs, model.places)
    except (ValueError, RuntimeError, IndexError) as error:
        why = str(error).splitlines()[0]
    raise ValueError(
        f'inerter "{model.name}": what it was made with is not where it was{_RENUMBERED}: {why}'
    )


def read_start(mbs: Any, model: Model) -> None:
    """Take the start of the terminals' motion as it is now: the flywheel goes with it."""
    if not {FLYWHEEL, TURNED} & set(model.element.own):
        return
    places, rates = start(mbs, model.element, model.nodeNumbers, model.given)
    mbs.SetNodeParameter(model.stateNode, "initialCoordinates", places)
    mbs.SetNodeParameter(model.stateNode, "initialCoordinates_t", rates)


def start(
    mbs: Any, element: Element, nodes: Any, given: Mapping[str, float]
) -> tuple[list[float], list[float]]:
    """Coordinates and velocities of the own coordinates at the start.

    A state that is not given is 0, but the flywheel moves with the terminals.
    """
    q, q_t = initial_coordinates(mbs, nodes)
    motion = element.kinematics.at(NUMBERS, q, q_t)
    places = [0.0] * len(element.own)
    if FLYWHEEL in element.own:
        stretch = motion.length - element.device.rest_length
        slide = given.get("series_deflection", 0.0)
        places[element.own.index(FLYWHEEL)] = stretch - slide
    moving = {FLYWHEEL: motion.rate, TURNED: motion.length}
    return places, [float(given.get(name, moving.get(name, 0.0))) for name in element.own]


def change_parameters(mbs: Any, model: Model, changes: Mapping[str, Any]) -> None:
    """Take other parameters.

    Raises
    ------
    inerter.core.DeviceError
        A parameter that cannot be.
    ValueError
        A change that asks for other coordinates than the device was made with.
    """
    changes = own_names(changes)
    if "rest_length" in changes and changes["rest_length"] is None:
        raise ValueError(
            f'inerter "{model.name}": rest_length=None is for CreateInerter; give a number [m]'
        )
    device = model.device.replace(**changes)
    old = model.element
    new = replace(old, device=old.device.with_device(device))
    told = f'inerter "{model.name}": {", ".join(f"{k}={v!r}" for k, v in changes.items())}'
    if new.device.state_names != old.device.state_names or new.own != old.own:
        raise ValueError(
            f"{told} would change its states from {_listed(old.device.state_names)} to "
            f"{_listed(new.device.state_names)}, which are frozen once it is made; make it so at "
            "the start (a part that hardly acts is enough to have a state: a tiny value, of a "
            "series stiffness a large one)"
        )
    if new.constant_mass != old.constant_mass or new.loaded != old.loaded:
        raise ValueError(
            f"{told} would make a constant inertance a varying one, or the other way round, which "
            "is frozen once it is made; make it so at the start (a tiny value is enough)"
        )
    if mbs.variables.get(KEPT_MASS) and old.constant_mass and _mass(new) != _mass(old):
        raise ValueError(
            f"{told} changes a mass that Exudyn keeps through this run; set "
            "settings.timeIntegration.reuseConstantMassMatrix = False before SolveDynamic"
        )
    if FLYWHEEL in old.own and new.device.rest_length != old.device.rest_length:
        raise ValueError(
            f"{told} would move the flywheel behind the series element; rest_length is frozen there"
        )
    model.device = device
    take(mbs, model, new)


def change_command(mbs: Any, model: Model, command: float) -> None:
    """Take another command of the control that sets a parameter; see `Inerter.SetControl`."""
    if model.device.control == "force":
        raise ValueError(
            f'inerter "{model.name}": its control is "force", which sets no parameter; make it '
            'with control="viscous", control_lower and control_upper, or apply a load'
        )
    if not math.isfinite(command):
        raise ValueError(f'inerter "{model.name}": command is {command}; give a finite number')
    old = model.element
    device = old.device.with_device(model.device, float(command))
    if device.aim != old.device.aim:
        take(mbs, model, replace(old, device=device))


def take(mbs: Any, model: Model, element: Element) -> None:
    """Let the object be this element from now on; it has the same coordinates."""
    model.functions.take(mbs, model.objectNumber, element)
    model.take(element)


def _mass(element: Element) -> float:
    return float(element.device.inertance)


def _listed(names: Any) -> str:
    return ", ".join(names) or "none"
