"""`CreateInerter`: puts a device between two terminals of an Exudyn system."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from numbers import Real
from typing import Any

from inerter.core import Device
from inerter.exudyn.changes import KEPT, start
from inerter.exudyn.element import Element
from inerter.exudyn.engine import exudyn
from inerter.exudyn.inerter import Inerter, Model
from inerter.exudyn.kinematics import Line, Span
from inerter.exudyn.parameters import Parameters
from inerter.exudyn.readings import Readings
from inerter.exudyn.terminals import terminals
from inerter.exudyn.user_functions import UserFunctions
from inerter.exudyn.watch import install

def CreateInerter(  # noqa: N802 - Exudyn's manner
    mbs: Any,
    name: str = "",
    itemNumbers: Sequence[Any] = (None, None),
    localPosition0: Sequence[float] = (0.0, 0.0, 0.0),
    localPosition1: Sequence[float] = (0.0, 0.0, 0.0),
    *,
    symbolic: bool | None = None,
    initialStates: Mapping[str, float] | None = None,
    dissipatedEnergy: bool = False,
    smoothPlay: bool = False,
    show: bool = True,
    drawSize: float = -1.0,
    color: Sequence[float] | None = None,
    **parameters: float | str,
) -> Inerter:
    """Put a device between two terminals.

    Parameters
    ----------
    mbs
        The MainSystem, before `Assemble`.
    name
        Name of the object; if empty, a number is given it as by Exudyn.
    itemNumbers
        Terminals 1 and 2: each a body (ObjectIndex) at `localPosition0` or `localPosition1`, a
        node (NodeIndex), a marker (MarkerIndex), or None, the ground. Two points on bodies: the
        displacement is their distance minus `rest_length`. Two coordinates (Node1D, or
        MarkerNodeCoordinate): it is their difference minus `rest_length`, reference coordinates
        not counted, as in CoordinateSpringDamper.
    localPosition0, localPosition1
        Points on the bodies [m], in their frames; on the ground in the global one.
    symbolic
        Whether Exudyn evaluates the forces itself, in C++, instead of calling Python: None, where
        it can (on 1D coordinates, unless load friction acts on a rigid device).
    initialStates
        States at the start by name, as in `Inerter.stateNames`; 0 for those not given.
    dissipatedEnergy
        Whether to add up the dissipated energy [J], as one more state.
    smoothPlay
        Whether the teeth of a damped backlash begin to press a little before they meet, without a
        jump of the force: for implicit solvers, whose steps may else have no solution. The play
        then seems smaller by some c_s v / (10 k_s). LuGre's damper behind `friction_backlash` then
        bears at most ten times what the bristle's spring does.
    show, drawSize, color
        Whether and how a device between points is drawn.
    **parameters
        Parameters of the device, named as in the MuJoCo plugin, SI units: `inertance=113`,
        `friction="lugre"`, `bristle_stiffness=1e5` ...

    Returns
    -------
    Inerter
        The device in the system: its numbers, states, sensors.

    Raises
    ------
    inerter.core.DeviceError
        A parameter that cannot be: names it, its value, what is allowed.
    ValueError
        Terminals or states that cannot be.
    """
    itemInterface = exudyn("itemInterface")
    device = Device(**parameters)
    # what belongs to the device is named after it
    name = name or f"inerter{mbs.systemData.NumberOfObjects()}"
    nodes, kinematics = terminals(mbs, itemNumbers, (localPosition0, localPosition1))
    element = Element(Parameters.of(device, smoothPlay), kinematics, dissipatedEnergy)
    straight = isinstance(kinematics, Line) and not element.loaded
    if symbolic and not straight:
        raise ValueError(
            "symbolic: True, but Exudyn can evaluate by itself only devices on 1D coordinates, "
            "without load friction on a rigid inertance; leave it None or set it False"
        )
    names = (*device.state_names, *(("dissipated_energy",) if dissipatedEnergy else ()))
    given = _initial_states(names, initialStates or {})
    own = _own_node(mbs, name, element, nodes, given) if element.own else None
    compiled = straight if symbolic is None else bool(symbolic)
    functions = UserFunctions(mbs, element, name, compiled)
    install()
    number = mbs.AddObject(
        itemInterface.ObjectGenericODE2(
            name=name,
            nodeNumbers=[*nodes, *([own] if own is not None else [])],
            **functions.parameters,
            visualization=itemInterface.VObjectGenericODE2(show=False),
        )
    )
    model = Model(
        name, device, element, number, tuple(nodes), own, names, compiled, functions,
        Readings(element), tuple(itemNumbers), (tuple(localPosition0), tuple(localPosition1)), given,
    )  # fmt: skip
    # user functions live as long as the system that evaluates them
    mbs.variables.setdefault(KEPT, []).append(model)
    if show and isinstance(kinematics, Span):
        _draw(mbs, name, itemNumbers, (localPosition0, localPosition1), drawSize, color)
    return Inerter(mbs, model)


def _own_node(
    mbs: Any, name: str, element: Element, nodes: Sequence[Any], given: Mapping[str, float]
) -> Any:
    """The node of the device's own coordinates, at its start."""
    places, rates = start(mbs, element, nodes, given)
    return mbs.AddNode(
        exudyn("itemInterface").NodeGenericODE2(
            name=f"{name}_states",
            referenceCoordinates=[0.0] * len(element.own),
            initialCoordinates=places,
            initialCoordinates_t=rates,
            numberOfODE2Coordinates=len(element.own),
        )
    )


def _initial_states(names: Sequence[str], given: Mapping[str, float]) -> dict[str, float]:
    if not isinstance(given, Mapping):
        raise ValueError(f"initialStates: {given!r} is no dict; give {{name: value}}")
    for key, value in given.items():
        if key not in names:
            there = ", ".join(names) or "none"
            raise ValueError(f"initialStates: {key!r} is no state of this device; it has {there}")
        if not isinstance(value, Real) or not math.isfinite(value):
            raise ValueError(f"initialStates: {key} is {value!r}; give a finite number")
    return {key: float(value) for key, value in given.items()}


def _draw(
    mbs: Any,
    name: str,
    items: Sequence[Any],
    local: Sequence[Sequence[float]],
    size: float,
    color: Sequence[float] | None,
) -> None:
    """A spring without force, which Exudyn draws between the terminals."""
    places = [list(point) for point in local]
    ends = []
    for item, place in zip(items, places, strict=True):
        if item is None:
            ends.append(mbs.CreateGround(referencePosition=place))
            place[:] = [0.0, 0.0, 0.0]
        else:
            ends.append(item)
    mbs.CreateSpringDamper(
        name=f"{name}_drawing",
        itemNumbers=ends,
        localPosition0=places[0],
        localPosition1=places[1],
        drawSize=size,
        color=exudyn("graphics").color.default if color is None else list(color),
    )
