"""`CreateInerter`: puts a device between two terminals of an Exudyn system."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from numbers import Real
from typing import Any

from numpy.typing import ArrayLike

from inerter.core import Device, DeviceError
from inerter.exudyn.carriers import Carrier, carry, is_carried
from inerter.exudyn.changes import KEPT, check_apart, reference_length, start
from inerter.exudyn.control import lags
from inerter.exudyn.drawing import check_drawing, draw
from inerter.exudyn.element import Element
from inerter.exudyn.engine import exudyn
from inerter.exudyn.inerter import Inerter, Model
from inerter.exudyn.kinematics import Line, Span
from inerter.exudyn.parameters import Parameters, own_names
from inerter.exudyn.readings import Readings
from inerter.exudyn.terminals import Terminals, check, terminals
from inerter.exudyn.user_functions import MOST_SYMBOLIC, UserFunctions
from inerter.exudyn.watch import install


def CreateInerter(  # noqa: N802 - Exudyn's manner
    mbs: Any,
    name: str = "",
    itemNumbers: Sequence[Any] = (None, None),
    localPosition0: ArrayLike = (0.0, 0.0, 0.0),
    localPosition1: ArrayLike = (0.0, 0.0, 0.0),
    *,
    device: Device | None = None,
    axis: ArrayLike | None = None,
    useGlobalFrame: bool = True,
    symbolic: bool | None = None,
    initialStates: Mapping[str, float] | None = None,
    dissipatedEnergy: bool = False,
    smoothPlay: bool = False,
    show: bool = True,
    drawSize: float = -1.0,
    color: Sequence[float] | None = None,
    bodyNumbers: Sequence[Any] | None = None,
    bodyOrNodeList: Sequence[Any] | None = None,
    markerNumbers: Sequence[Any] | None = None,
    **parameters: float | str | None,
) -> Inerter:
    """Put a device between two terminals: helper function to create an inerter with its friction,
    springs and shaft between bodies, nodes or markers; see also CreateSpringDamper.

    Parameters
    ----------
    mbs
        The MainSystem, before `Assemble`.
    name
        Name of the object; if empty, a number is given it as by Exudyn.
    itemNumbers
        Terminals 1 and 2: each a body (ObjectIndex) at `localPosition0` or `localPosition1`, a
        node (NodeIndex), a marker (MarkerIndex), or None, the ground. Two points on bodies: the
        displacement is their distance minus `rest_length`. Two coordinates (Node1D, Mass1D,
        RotationalMass1D, MarkerNodeCoordinate): it is their difference minus `rest_length`,
        reference coordinates not counted, as in CoordinateSpringDamper. Cables, beams, kinematic
        trees and superelements get a massless point with a spherical joint, for implicit solvers.
    localPosition0, localPosition1
        Points on the bodies [m], in their frames; on the ground in the global one.
    device
        A device that is there already, such as `inerter.read_device("device.toml")` of a diagnosis;
        parameters that are given beside it take the place of its own.
    axis
        For a torsional device between two rigid bodies: the axis about which their relative angle
        [rad] counts, usually that of their joint; zero at the reference configuration. Inertance is
        then in kg m^2, forces are torques. Two MarkerNodeRotationCoordinate need no axis.
    useGlobalFrame
        Whether `axis` is in the global frame at the reference configuration, or in the frame of
        the first body.
    symbolic
        Whether Exudyn evaluates the forces itself, from matrices and expressions: None, where it
        can (on 1D coordinates, unless load friction acts on a rigid device, `control_lag` is
        given, or there are more than seven coordinates: terminals and states). Else the package's
        library evaluates them, as it does between points.
    initialStates
        States at the start by name, as in `Inerter.stateNames`; where none is given the shaft is
        unloaded, the flywheel moves with the terminals, the others are 0.
    dissipatedEnergy
        Whether to add up the dissipated energy [J], as one more state.
    smoothPlay
        Whether the teeth of a damped backlash begin to press a little before they meet, without a
        jump of the force: for implicit solvers, whose steps may else have no solution. The play
        then seems smaller by some c_s v / (10 k_s). LuGre's damper behind `friction_backlash` then
        bears at most ten times what the bristle's spring does.
    show, drawSize, color
        Whether and how a device between points is drawn; `Inerter.Show` switches it.
    bodyNumbers, bodyOrNodeList, markerNumbers
        Other names of `itemNumbers`, as in CreateSpringDamper and in Exudyn's connectors.
    **parameters
        Parameters of the device, named as in the MuJoCo plugin, SI units: `inertance=113`,
        `friction="lugre"`, `bristle_stiffness=1e5` ... `rest_length=None`, which is its default
        between points, is the distance at the reference configuration, as in SpringDamper. Keywords
        of Exudyn's connectors are understood: `damping` is `viscous`, `referenceLength` and
        `offset` are `rest_length`, `force` and `torque` are `force_offset`.

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

    Examples
    --------
    >>> strut = CreateInerter(
    ...     mbs, "strut", [ground, box], inertance=113, damping=500
    ... )  # doctest: +SKIP
    """
    items_of = exudyn("itemInterface")
    if not isinstance(mbs, exudyn().MainSystem):
        raise ValueError(
            f"mbs: a {type(mbs).__name__} is no MainSystem; make one by "
            "exudyn.SystemContainer().AddSystem()"
        )
    others = {
        "bodyNumbers": bodyNumbers,
        "bodyOrNodeList": bodyOrNodeList,
        "markerNumbers": markerNumbers,
    }
    items = _items(name, itemNumbers, others)
    check_drawing(drawSize, color)
    wanted = _parameters(device, parameters)
    device = Device(**{key: value for key, value in wanted.items() if value is not None})
    # what belongs to the device is named after it
    name = name or f"inerter{mbs.systemData.NumberOfObjects()}"
    _check_name(mbs, name)
    names = (*device.state_names, *(("dissipated_energy",) if dissipatedEnergy else ()))
    given = _initial_states(names, initialStates or {})
    places = Terminals(tuple(items), (localPosition0, localPosition1), axis, useGlobalFrame)
    places, points = _carried(mbs, name, places, bool(symbolic))
    nodes, kinematics = terminals(mbs, places)
    free = wanted.get("rest_length") is None
    if free and isinstance(kinematics, Span):
        device = device.replace(rest_length=reference_length(kinematics))
    element = Element(Parameters.of(device, smoothPlay), kinematics, dissipatedEnergy)
    straight = isinstance(kinematics, Line) and not element.loaded and element.size <= MOST_SYMBOLIC
    straight = straight and not lags(element.device)
    if symbolic and not straight:
        raise ValueError(f"{_SYMBOLIC} (here {element.size}); leave it None or set it False")
    check_apart(mbs, name, element, nodes)
    own = _own_node(mbs, name, element, nodes, given) if element.own else None
    compiled = straight if symbolic is None else bool(symbolic)
    functions = UserFunctions(mbs, element, name, compiled)
    install()
    number = mbs.AddObject(
        items_of.ObjectGenericODE2(
            name=name,
            nodeNumbers=[*nodes, *([own] if own is not None else [])],
            **functions.parameters,
            visualization=items_of.VObjectGenericODE2(show=False),
        )
    )
    functions.add_connector(mbs, name, element, nodes)
    drawn = isinstance(kinematics, Span)
    shown = draw(mbs, name, places, show, drawSize, color) if drawn else None
    model = Model(
        name=name, device=device, element=element, objectNumber=number, nodeNumbers=tuple(nodes),
        stateNode=own, stateNames=names, symbolic=compiled, drawingNumber=shown,
        functions=functions, readings=Readings(element), places=places, carriers=points,
        given=given, free_length=free,
    )  # fmt: skip
    # user functions live as long as the system that evaluates them
    mbs.variables.setdefault(KEPT, []).append(model)
    return Inerter(mbs, model)


_SYMBOLIC = (
    "symbolic: True, but Exudyn can evaluate by itself only devices on 1D coordinates, without "
    "load friction on a rigid inertance and without control_lag, of at most "
    f"{MOST_SYMBOLIC} coordinates"
)


def _check_name(mbs: Any, name: str) -> None:
    """Raise ValueError for a name that Exudyn would refuse halfway."""
    if re.match(r"(object|node|marker)[0-9]", name):
        raise ValueError(f"name: {name!r} is how Exudyn numbers its own items; give another one")
    if int(mbs.GetObjectNumber(name)) >= 0:
        raise ValueError(f"name: there is an object {name!r} already; give another one")


def _items(name: Any, itemNumbers: Any, told: Mapping[str, Any]) -> list[Any]:
    """The two items, under whichever name they were given."""
    if not isinstance(name, str):
        raise ValueError(
            f"name: {name!r:.60} is no text; give the name first, then the items: "
            'CreateInerter(mbs, "strut", [body1, body2], ...), or itemNumbers=[body1, body2]'
        )
    others = {key: value for key, value in told.items() if value is not None}
    if len(others) > 1 or (others and tuple(itemNumbers) != (None, None)):
        raise ValueError(f"itemNumbers: also given as {', '.join(others)}; give it once")
    found = next(iter(others.values()), itemNumbers)
    if isinstance(found, str) or not hasattr(found, "__len__") or len(found) != 2:
        count = len(found) if hasattr(found, "__len__") else repr(found)
        raise ValueError(f"itemNumbers: {count} given; an inerter has two terminals")
    return list(found)


def _parameters(device: Any, given: Mapping[str, Any]) -> dict[str, Any]:
    """Parameters under their own names, none of them None but a rest length."""
    if device is not None and not isinstance(device, Device):
        raise ValueError(
            f"device: {device!r:.60} is no device; give inerter.Device(...), or "
            'inerter.read_device("device.toml")'
        )
    found = {**(device.given if device is not None else {}), **own_names(given)}
    if not set(found) - {"rest_length"}:
        raise DeviceError(
            "inertance is not given, nor is anything else that acts; give inertance=... [kg], or "
            "what `inerter parameters` lists"
        )
    for key, value in found.items():
        if value is None and key != "rest_length":
            raise DeviceError(f"{key} is None: give a number, or leave it out")
    return found


def _carried(
    mbs: Any, name: str, places: Terminals, symbolic: bool
) -> tuple[Terminals, tuple[Carrier, ...]]:
    """The terminals with massless points in place of what has no coordinates of its own."""
    needed = [is_carried(mbs, item) for item in places.items]
    if not any(needed):
        return places, ()
    # nothing is added before the other terminal is known to be right
    check(mbs, places, needed)
    if places.axis is not None:
        raise ValueError(
            "axis: an angle is between two rigid bodies; a cable, a beam, a tree or a superelement "
            "carries a point alone; leave axis away"
        )
    if symbolic:
        raise ValueError(f"{_SYMBOLIC}; leave it None or set it False")
    items, local, points = list(places.items), list(places.local), []
    for i, is_needed in enumerate(needed):
        if is_needed:
            points.append(carry(mbs, name, items[i], local[i]))
            items[i], local[i] = points[-1].node, (0.0, 0.0, 0.0)
    return replace(places, items=tuple(items), local=tuple(local)), tuple(points)


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
