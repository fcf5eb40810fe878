"""The states of a device: which there are, how they stand in z, what a control makes of it."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .laws import FRICTION, DeviceParameters, Quantity, branches, control, maxwell_slip

_PLACE_OF_STATES = {
    "force": 3,
    "branch": 2,
    "inertance_force": 3,
    "rest_force": 2,
    "total_friction": 3,
    "friction_force": 2,
    "acceleration": 3,
    "stored_energy": 2,
    "dissipated_power": 3,
    "gas_valid": 1,
    "contact_of": 1,
    "contact_guards": 1,
}
"""Where z stands among the arguments of the methods."""


def at_command(method: Callable[..., Any]) -> Callable[..., Any]:
    """The method of the device at the value that its control commands; the last argument is z."""

    @functools.wraps(method)
    def wrapped(self: DeviceStates, *arguments: Any, **named: Any) -> Any:
        if self.control == "force":
            return method(self, *arguments, **named)
        places = _PLACE_OF_STATES[method.__name__]
        given = list(arguments)
        if places < len(given):
            present, given[places] = self._at_present(given[places])
        else:
            present, named["z"] = self._at_present(named.get("z", 0.0))
        return method(present, *given, **named)

    return wrapped


@dataclass(frozen=True, kw_only=True)
class DeviceStates(DeviceParameters):
    """The parameters of a device, and the states that follow from them."""

    @functools.cached_property
    def nstate(self) -> int:
        """Number of states."""
        return len(self.state_names)

    @functools.cached_property
    def state_names(self) -> tuple[str, ...]:
        """Names of the states in their order."""
        friction = ("friction_state",) if self.friction_states else ()
        if self.friction == "maxwell_slip":
            friction = tuple(f"friction_state_{i + 1}" for i in range(self.friction_states))
        flywheel = ("series_deflection", "flywheel_velocity") if self.has_series else ()
        gap = ("gap_position",) * (self.backlash > 0.0) + ("slip_position",) * self.has_clutch
        beside = tuple(f"branch_deflection_{i + 1}" for i in range(branches.count(self)))
        beside += ("damper_velocity",) * self._springy_damper
        return friction + flywheel + gap + beside + ("control_change",) * control.count(self)

    @property
    def _springy_damper(self) -> int:
        """Number of states of dampers behind a spring."""
        return int(self.damper_stiffness > 0.0)

    @property
    def friction_states(self) -> int:
        """Number of states of the friction law."""
        if self.friction == "maxwell_slip":
            return maxwell_slip.count(self)
        return FRICTION[self.friction].STATES

    def state_argument(self, states: ArrayLike) -> Quantity:
        """States of shape (..., nstate) in the form that the methods take as `z`."""
        array = np.asarray(states, dtype=np.float64)
        if self.nstate == 0:
            return 0.0
        return array[..., 0] if self.nstate == 1 else array

    def parameters(self) -> dict[str, float | str]:
        """Every parameter by name, defaults included; NaN for one that is not given."""
        return {name: value for name, value in asdict(self).items() if name != "command"}

    def with_knee(self, share: float) -> Self:
        """The device with a knee in maxwell_slip, see `laws/maxwell_slip.py`."""
        return self._with_value("slip_knee", share)

    def _change(self, z: Quantity) -> Quantity:
        """The control's own state."""
        array = np.asarray(z, dtype=np.float64)
        return array if self.nstate == 1 or array.ndim == 0 else array[..., -1]

    def _with_value(self, name: str, value: Quantity) -> Self:
        """The device, already checked, with a value, perhaps of many moments, of a parameter."""
        found = object.__new__(type(self))
        found.__dict__.update(self.__dict__)
        object.__setattr__(found, name, value)
        return found

    def _at_present(self, z: Quantity) -> tuple[Self, Quantity]:
        """The device at the value of its control, without a state of it; its states."""
        found = self._with_value(self.control, control.value(self, self._change(z)))
        object.__setattr__(found, "control", "force")
        for name in ("nstate", "state_names"):
            # without what the control adds to them
            found.__dict__.pop(name, None)
        array = np.asarray(z, dtype=np.float64)
        if not control.count(self) or array.ndim == 0:
            return found, z if self.nstate > control.count(self) else 0.0
        if self.nstate == 1:
            return found, 0.0
        return found, array[..., 0] if self.nstate == 2 else array[..., :-1]

    def _split(self, z: Quantity) -> tuple[Quantity, NDArray[np.float64], Quantity]:
        """The states without those of branches and dampers, in the form of `z`; those of each.

        Deflections (..., n); the velocity over dampers behind a spring, 0 without one.
        """
        count, damper = branches.count(self), self._springy_damper
        last, array = count + damper, np.asarray(z, dtype=np.float64)
        if not last:
            return z, np.zeros(0), 0.0
        if array.ndim == 0 and array == 0.0:
            return 0.0, np.zeros(count), 0.0
        if self.nstate == 1:
            return 0.0, array[..., np.newaxis][..., :count], array if damper else 0.0
        inner, beside = array[..., :-last], array[..., -last:]
        size = self.nstate - last
        own = inner[..., 0] if size == 1 else inner if size else 0.0
        return own, beside[..., :count], beside[..., -1] if damper else 0.0

    def _states(self, z: Quantity) -> tuple[Quantity, Quantity, Quantity, Quantity]:
        """Friction state, s, w, gap or slip; zero where there is none."""
        z = self._split(z)[0]
        if not self.has_series:
            return z, 0.0, 0.0, 0.0
        array: NDArray[np.float64] = np.asarray(z, dtype=np.float64)
        if array.ndim == 0 and array == 0.0:
            return 0.0, 0.0, 0.0, 0.0
        beside = branches.count(self) + self._springy_damper
        if array.ndim == 0 or array.shape[-1] != self.nstate - beside:
            raise ValueError(
                f"z: shape {array.shape}, but this device has the states "
                f"{', '.join(self.state_names)} along the last axis"
            )
        first = self.friction_states
        friction = array[..., :first] if first > 1 else array[..., 0] if first else 0.0
        third = self.backlash > 0.0 or self.has_clutch
        gap = array[..., first + 2] if third else 0.0
        return friction, array[..., first], array[..., first + 1], gap
