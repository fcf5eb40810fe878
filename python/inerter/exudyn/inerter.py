"""`Inerter`: a device in an Exudyn system, what it does and what can be measured of it."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass, field
from typing import Any
from weakref import WeakSet

import numpy as np
from numpy.typing import NDArray

from inerter.core import Device
from inerter.exudyn.carriers import Carrier
from inerter.exudyn.element import Element
from inerter.exudyn.engine import exudyn
from inerter.exudyn.readings import FORCES, READINGS, Readings
from inerter.exudyn.sensors import Sensor
from inerter.exudyn.terminals import Terminals
from inerter.exudyn.user_functions import UserFunctions

QUANTITIES = READINGS
"""What `Inerter.Evaluate` tells, and sensors can measure."""


ORIGIN = [0.0, 0.0, 0.0]


@functools.cache
def _questions() -> tuple[Any, ...]:
    """What Exudyn is asked for, and where: coordinates, their rates, theirs, the current state."""
    kinds = exudyn().OutputVariableType
    now = exudyn().ConfigurationType.Current
    return kinds.Coordinates, kinds.Coordinates_t, kinds.Coordinates_tt, now


@dataclass
class Model:
    """What belongs to a device, without the system, which would never be freed if it held itself.

    `element` changes with the parameters and the geometry; `readings` follow it. `places`
    are the terminals as they were given, `carriers` massless points made for them, `given` the
    initial states; with `free_length` the rest length is the reference distance.
    """

    name: str
    device: Device
    element: Element
    objectNumber: Any  # noqa: N815 - Exudyn's manner
    nodeNumbers: tuple[Any, ...]  # noqa: N815
    stateNode: Any  # noqa: N815
    stateNames: tuple[str, ...]  # noqa: N815
    symbolic: bool
    drawingNumber: Any  # noqa: N815
    functions: UserFunctions
    readings: Readings
    places: Terminals
    carriers: tuple[Carrier, ...]
    given: dict[str, float]
    free_length: bool
    _needs: dict[tuple[str, ...], tuple[bool, bool, bool]] = field(default_factory=dict)
    sensors: WeakSet[Sensor] = field(default_factory=WeakSet)

    def take(self, element: Element) -> None:
        """Be of this element from now on."""
        self.element, self.readings, self._needs = element, Readings(element), {}
        for sensor in self.sensors:
            sensor.take(self.readings)

    def forget(self) -> None:
        """Where its coordinates are in the system may have changed: it is assembled anew."""
        for sensor in self.sensors:
            sensor.forget()

    def read(self, mbs: Any, configuration: Any, names: tuple[str, ...]) -> list[float]:
        """Readings and states by name."""
        where = _questions()[-1] if configuration is None else configuration
        if names not in self._needs:
            self._needs[names] = self.readings.needs(names)
        # a question costs more than all the arithmetic: only what is needed is asked
        parts = [
            mbs.GetObjectOutputBody(self.objectNumber, kind, ORIGIN, where) if needed else None
            for kind, needed in zip(_questions(), self._needs[names], strict=False)
        ]
        found = self.readings.at(*parts, names=names)
        if not math.isfinite(sum(found)):
            self._explain(*parts)
        return found

    def sensor_function(self, names: tuple[str, ...]) -> Any:
        """The user function of a sensor that tells these."""

        def whole(
            mbs: Any, t: float, sensorNumbers: Any, factors: Any, configuration: Any
        ) -> list[float]:
            sensor.locate(mbs, self.objectNumber)
            return self.read(mbs, configuration, names)

        sensor = Sensor(self.readings, names, whole)
        self.sensors.add(sensor)
        return sensor.function()

    def _explain(self, *parts: Any) -> None:
        """Raise ValueError for readings that are not finite."""
        if not all(part is None or np.isfinite(part).all() for part in parts):
            raise ValueError(
                f'inerter "{self.name}": its coordinates are not finite; the run has diverged. '
                "Shorten the step, or take GeneralizedAlpha, or DOPRI5 with tolerances"
            )


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
        NodeGenericODE2 of the device's own coordinates, or None.
    stateNames
        Names of the states in their order; last "dissipated_energy" if it is added up.
    symbolic
        Whether Exudyn evaluates the forces in C++.
    drawingNumber
        The object that draws the device, or None.
    """

    def __init__(self, mbs: Any, model: Model) -> None:
        self.mbs, self._model = mbs, model

    def __setattr__(self, name: str, value: Any) -> None:
        if name not in ("mbs", "_model"):
            raise AttributeError(
                f"{name}: an Inerter's attributes are not set; parameters change by "
                f"strut.set({name}={value!r:.40})"
            )
        super().__setattr__(name, value)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or name not in Model.__dataclass_fields__:
            raise AttributeError(f"an Inerter has no {name!r}")
        return getattr(self._model, name)

    def set(self, **parameters: float | str) -> None:
        """Change parameters, also while a run goes on; checked like those of `CreateInerter`.

        `mbs.SetObjectParameter(strut.objectNumber, "inertance", 50)` does the same. States that
        the device has stay; a change that asks for others is refused.

        Raises
        ------
        inerter.core.DeviceError
            A parameter that cannot be: names it, its value, what is allowed.
        ValueError
            A change that is not possible once the device is made.
        """
        from inerter.exudyn.changes import change_parameters

        change_parameters(self.mbs, self._model, parameters)

    def SetControl(self, command: float) -> None:  # noqa: N802
        """Command the parameter that the device's `control` names, in its unit; as a run goes on.

        Held until the next call, within `control_lower` and `control_upper`. Call it from a
        PreStepUserFunction; without lag what holds is there at once, with `control_lag` the device
        follows by a state of its own.

        Raises
        ------
        ValueError
            The device's control is a force, or the command is not a number.
        """
        from inerter.exudyn.changes import change_command

        change_command(self.mbs, self._model, command)

    def Show(self, show: bool = True) -> None:  # noqa: N802
        """Draw the device, or not; also while the renderer runs."""
        if self.drawingNumber is not None:
            self.mbs.SetObjectParameter(self.drawingNumber, "Vshow", bool(show))

    def __repr__(self) -> str:
        return f"Inerter({self.name!r}, {self.device!r})"

    def GetStates(self, configuration: Any = None) -> NDArray[np.float64]:  # noqa: N802
        """States, shape (states,), in the order of `stateNames`; Exudyn's current configuration.

        Raises
        ------
        ValueError
            The run has diverged.
        """
        if not self.stateNames:
            return np.zeros(0)
        return np.array(self._model.read(self.mbs, configuration, self.stateNames))

    def Evaluate(self, configuration: Any = None) -> dict[str, Any]:  # noqa: N802
        """What the device does: the quantities of `QUANTITIES` and "states", SI units.

        Forces are tension positive. The acceleration is the one that Exudyn knows: explicit
        solvers know none before the first step, and that of their last stage if
        `timeIntegration.explicit.computeEndOfStepAccelerations` has been set False. Raises
        ValueError if the run has diverged.
        """
        names = (*QUANTITIES, *self.stateNames)
        found = self._model.read(self.mbs, configuration, names)
        told: dict[str, Any] = dict(zip(QUANTITIES, found, strict=False))
        return told | {"states": np.array(found[len(QUANTITIES) :])}

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
        together = {"forces": FORCES} | ({"states": self.stateNames} if self.stateNames else {})
        known = (*QUANTITIES, *self.stateNames, *together)
        if quantity not in known:
            raise ValueError(f"quantity: {quantity!r} is none of {', '.join(known)}")

        name = f"{self.name}_{quantity}"
        if int(self.mbs.GetSensorNumber(name)) >= 0:
            name = f"{name}_{self.mbs.systemData.NumberOfSensors()}"
        function = self._model.sensor_function(tuple(together.get(quantity, (quantity,))))
        return self.mbs.AddSensor(
            exudyn("itemInterface").SensorUserFunction(
                name=name,
                sensorUserFunction=function,
                fileName=fileName,
                writeToFile=bool(fileName),
                storeInternal=storeInternal,
            )
        )
