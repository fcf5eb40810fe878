"""`CreateInerter`: puts a device between two terminals of an Exudyn system."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from numbers import Real
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inerter.core import Device
from inerter.exudyn import device as law
from inerter.exudyn.engine import exudyn
from inerter.exudyn.functions import NUMBERS
from inerter.exudyn.kinematics import Span
from inerter.exudyn.parameters import Parameters
from inerter.exudyn.terminals import terminals
from inerter.exudyn.user_functions import (
    Element,
    force_function,
    mass_function,
    mass_matrix,
    recalled,
    symbolic_force,
)

FORCES = ("total", "inertance", "friction")
QUANTITIES = (
    "displacement",
    "velocity",
    "acceleration",
    *FORCES,
    "stored_energy",
    "dissipated_power",
)
"""What `Inerter.Evaluate` tells, and sensors can measure."""
FUNCTIONS = "inerter_user_functions"
"""Where in `mbs.variables` the user functions are kept."""


@dataclass(frozen=True)
class Inerter:
    """A device in an Exudyn system.

    Attributes
    ----------
    name
        Name of the object.
    device
        The device with all its parameters.
    objectNumber
        The ObjectGenericODE2.
    nodeNumbers
        Nodes of the terminals.
    stateNode
        NodeGenericODE2 whose velocity coordinates are the states, or None.
    stateNames
        Names of the states in their order; last "dissipated_energy" if it is added up.
    symbolic
        Whether Exudyn evaluates the forces in C++.
    """

    mbs: Any
    name: str
    device: Device
    objectNumber: Any  # noqa: N815 - Exudyn's manner
    nodeNumbers: tuple[Any, ...]  # noqa: N815
    stateNode: Any  # noqa: N815
    stateNames: tuple[str, ...]  # noqa: N815
    symbolic: bool
    element: Element

    def GetStates(self, configuration: Any = None) -> NDArray[np.float64]:  # noqa: N802
        """States, shape (states,), in the order of `stateNames`; Exudyn's current configuration.

        Raises
        ------
        ValueError
            The run has diverged.
        """
        if self.stateNode is None:
            return np.zeros(0)
        values = self._coordinates("Coordinates_t", configuration)[self.element.kinematics.size :]
        device = self.device
        if device.backlash:
            # within the play, past whose edge a last step may have gone; without a damper the
            # position follows from the deflection
            gap = self.stateNames.index("gap_position")
            place = values[gap if device.series_damping else gap - 2]
            values[gap] = np.clip(place, -device.backlash, device.backlash)
        return values

    def Evaluate(self, configuration: Any = None) -> dict[str, Any]:  # noqa: N802
        """What the device does: the quantities of `QUANTITIES` and "states", SI units.

        Forces are tension positive. The acceleration is the one that Exudyn knows: explicit
        solvers know none before the first step, and that of their last stage if
        `timeIntegration.explicit.computeEndOfStepAccelerations` has been set False. Raises
        ValueError if the run has diverged.
        """
        p = self.element.device
        q, q_t, q_tt = (
            self._coordinates(kind, configuration)
            for kind in ("Coordinates", "Coordinates_t", "Coordinates_tt")
        )
        motion = self.element.kinematics.at(q.tolist(), q_t.tolist())
        x, v = motion.length - self.device.rest_length, motion.rate
        a = float(np.dot(motion.row, q_tt[: len(motion.row)])) + motion.bias
        states = self.GetStates(configuration)
        z = states[: self.device.nstate].tolist()
        through = law.carried(p, x, v, a, z)
        return {
            "displacement": x,
            "velocity": v,
            "acceleration": a,
            **law.forces(p, x, v, a, z),
            "stored_energy": law.stored_energy(p, x, v, z),
            "dissipated_power": law.dissipated_power(NUMBERS, p, x, v, z, through),
            "states": states,
        }

    def AddSensor(  # noqa: N802
        self, quantity: str = "total", fileName: str = "", storeInternal: bool = True
    ) -> Any:
        """Add a sensor of a quantity or a state, and return its SensorIndex.

        "forces" are total, inertance and friction together, "states" all states.

        Raises
        ------
        ValueError
            There is no such quantity; the message lists them.
        """
        together = ("forces", "states") if self.stateNames else ("forces",)
        known = (*QUANTITIES, *self.stateNames, *together)
        if quantity not in known:
            raise ValueError(f"quantity: {quantity!r} is none of {', '.join(known)}")

        name = f"{self.name}_{quantity}"
        if int(self.mbs.GetSensorNumber(name)) >= 0:
            name = f"{name}_{self.mbs.systemData.NumberOfSensors()}"

        # a system that held itself by its sensors would never be freed
        unbound = replace(self, mbs=None)

        def sensorUserFunction(  # noqa: N802
            mbs: Any, t: float, sensorNumbers: Any, factors: Any, configuration: Any
        ) -> list[float]:
            inerter = replace(unbound, mbs=mbs)
            if quantity == "states":
                return inerter.GetStates(configuration).tolist()
            if quantity in inerter.stateNames:
                place = inerter.stateNames.index(quantity)
                return [float(inerter.GetStates(configuration)[place])]
            found = inerter.Evaluate(configuration)
            names = FORCES if quantity == "forces" else (quantity,)
            return [float(found[name]) for name in names]

        return self.mbs.AddSensor(
            exudyn("itemInterface").SensorUserFunction(
                name=name,
                sensorUserFunction=sensorUserFunction,
                fileName=fileName,
                writeToFile=bool(fileName),
                storeInternal=storeInternal,
            )
        )

    def _coordinates(self, kind: str, configuration: Any) -> NDArray[np.float64]:
        """Coordinates of the object: the terminals' nodes, then the states."""
        engine = exudyn()
        where = engine.ConfigurationType.Current if configuration is None else configuration
        what = getattr(engine.OutputVariableType, kind)
        found = self.mbs.GetObjectOutputBody(self.objectNumber, what, [0.0] * 3, where)
        values = np.atleast_1d(np.array(found, dtype=float))
        if not np.all(np.isfinite(values)):
            raise ValueError(
                f'inerter "{self.name}": its coordinates are not finite; the run has diverged. '
                "Shorten the step, or take GeneralizedAlpha, or DOPRI5 with tolerances"
            )
        return values


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
    nodes, kinematics = terminals(mbs, name, itemNumbers, (localPosition0, localPosition1))
    element = Element(Parameters.of(device, smoothPlay), kinematics, dissipatedEnergy)
    if symbolic and not element.recordable:
        raise ValueError(
            "symbolic: True, but Exudyn can evaluate by itself only devices on 1D coordinates, "
            "without load friction on a rigid inertance; leave it None or set it False"
        )
    names = (*device.state_names, *(("dissipated_energy",) if dissipatedEnergy else ()))
    states = _initial_states(names, initialStates or {})

    own = None
    if names:
        own = mbs.AddNode(
            itemInterface.NodeGenericODE2(
                name=f"{name}_states",
                referenceCoordinates=[0.0] * len(names),
                initialCoordinates=[0.0] * len(names),
                initialCoordinates_t=states,
                numberOfODE2Coordinates=len(names),
            )
        )
    at = recalled(kinematics)
    compiled = element.recordable if symbolic is None else symbolic
    force = symbolic_force(element, mbs) if compiled else force_function(element, at)
    mass = 0 if element.constant_mass else mass_function(element, at)
    number = mbs.AddObject(
        itemInterface.ObjectGenericODE2(
            name=name,
            nodeNumbers=[*nodes, *([own] if names else [])],
            massMatrix=mass_matrix(element),
            forceUserFunction=force,
            massMatrixUserFunction=mass,
            visualization=itemInterface.VObjectGenericODE2(show=False),
        )
    )
    # expressions live as long as the system that evaluates them
    mbs.variables.setdefault(FUNCTIONS, []).append(force)
    if show and isinstance(kinematics, Span):
        _draw(mbs, name, itemNumbers, (localPosition0, localPosition1), drawSize, color)
    return Inerter(mbs, name, device, number, tuple(nodes), own, names, bool(compiled), element)


def _initial_states(names: Sequence[str], given: Mapping[str, float]) -> list[float]:
    if not isinstance(given, Mapping):
        raise ValueError(f"initialStates: {given!r} is no dict; give {{name: value}}")
    for key, value in given.items():
        if key not in names:
            there = ", ".join(names) or "none"
            raise ValueError(f"initialStates: {key!r} is no state of this device; it has {there}")
        if not isinstance(value, Real) or not math.isfinite(value):
            raise ValueError(f"initialStates: {key} is {value!r}; give a finite number")
    return [float(given.get(key, 0.0)) for key in names]


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
