"""The C core from Python: parameters, one device, many devices along a motion."""

from __future__ import annotations

import ctypes
import os
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cached_property, partial
from typing import Any, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from inerter.checked_motion import checked_motion
from inerter.core_library import (
    FORCES,
    MESSAGE_SIZE,
    WORDS,
    NumberList,
    Parameter,
    controls,
    device_type,
    friction_laws,
    friction_sides,
    gas_laws,
    library,
    library_path,
    lists,
    message_text,
    names,
    parameters,
    set_numbers,
)
from inerter.parameter_text import value_text, with_suggestion

__all__ = [
    "WORDS",
    "Device",
    "DeviceError",
    "NumberList",
    "Parameter",
    "along_many",
    "controls",
    "friction_laws",
    "friction_sides",
    "gas_laws",
    "library_path",
    "lists",
    "names",
    "parameters",
]


class DeviceError(ValueError):
    """A device that cannot be: names the parameter, its value, what is allowed."""


class Device:
    """A device: inertance, damping, stiffness, further force laws and one friction law.

    States z are counted as in `state_names`. Where a method takes one number for z, it is the first
    state, and the others are 0.

    Parameters
    ----------
    **values : float or str
        Parameters by name (see `parameters()`), SI units, lists of numbers (see `lists()`; a
        sequence, or a text with blanks), and names: `friction`, `gas_law`, `friction_side`,
        `control`. What is not given has its default.

    Raises
    ------
    DeviceError
        An unknown name, a value out of range, values that do not fit together.
    """

    def __init__(self, **values: float | str | Sequence[Any]) -> None:
        self._c = device_type()()
        core, message = library(), ctypes.create_string_buffer(MESSAGE_SIZE)
        at, known = ctypes.byref(self._c), parameters()
        core.inerter_default(at)
        for name, value in values.items():
            if set_numbers(self._c, name, value):
                continue
            text, key = value_text(value), name if name in known else value_text(name)
            if text is None or key is None:
                raise DeviceError(f"{name!a} is {value!a:.80}: give a number, or the name of a law")
            if core.inerter_set(at, key.encode(), text.encode(), message):
                raise DeviceError(with_suggestion(name, message_text(message), names()))
        if core.inerter_finish(at, message):
            raise DeviceError(message_text(message))
        self._stated = tuple(values)

    @property
    def given(self) -> dict[str, float | str]:
        """What was stated, by name; a list of numbers as a text, separated by blanks."""
        return dict(self._given)

    @cached_property
    def _given(self) -> dict[str, float | str]:
        values = {name: getattr(self, name) for name in self._stated}
        return {n: value_text(v) or "" if n in lists() else v for n, v in values.items()}

    @property
    def friction(self) -> str:
        """Name of the friction law."""
        return list(friction_laws())[self._c.friction]  # type: ignore[attr-defined]

    @property
    def gas_law(self) -> str:
        """Name of the law of the gas spring."""
        return list(gas_laws())[self._c.gas_law]  # type: ignore[attr-defined]

    @property
    def friction_side(self) -> str:
        """Where friction acts: terminals, or flywheel."""
        return list(friction_sides())[self._c.friction_side]  # type: ignore[attr-defined]

    @property
    def control(self) -> str:
        """What its control is: force, or the parameter that it sets."""
        return list(controls())[self._c.control]  # type: ignore[attr-defined]

    @property
    def has_load_friction(self) -> bool:
        """Whether friction grows with the force through the inertance."""
        return self.mu_forward > 0.0 or self.mu_backward > 0.0

    @property
    def nstate(self) -> int:
        """Number of states."""
        return self._c.nstate  # type: ignore[attr-defined]

    @cached_property
    def state_names(self) -> tuple[str, ...]:
        """Names of the states, such as friction_state."""
        name, at = library().inerter_state_name, ctypes.byref(self._c)
        return tuple(name(at, i).decode() for i in range(self.nstate))

    def __getattr__(self, name: str) -> Any:
        if name in parameters():
            return getattr(self._c, name)
        if name not in lists():
            raise AttributeError(name)
        count, place = ctypes.c_int(), list(lists()).index(name)
        at = library().inerter_list_values(ctypes.byref(self._c), place, ctypes.byref(count))
        return tuple(at[: count.value])

    def __setattr__(self, name: str, value: object) -> None:
        if not name.startswith("_"):
            raise AttributeError(
                f"{name}: a device does not change; make another with device.replace({name}=...), "
                f"and change one in an Exudyn system with strut.set({name}=...)"
            )
        super().__setattr__(name, value)

    def __reduce__(self) -> tuple[Any, ...]:
        return partial(Device, **self._given), ()

    def __repr__(self) -> str:
        return "Device(" + ", ".join(f"{k}={v!r}" for k, v in self._given.items()) + ")"

    def __eq__(self, other: object) -> bool:
        """Whether another device states the same."""
        return isinstance(other, Device) and self._given == other._given

    def __hash__(self) -> int:
        return hash(frozenset(self._given.items()))

    def replace(self, **values: float | str | Sequence[Any]) -> Device:
        """The same device with some values stated anew."""
        return Device(**{**self._given, **values})

    def evaluate(
        self, x: ArrayLike, v: ArrayLike, a: ArrayLike, z: ArrayLike, command: ArrayLike = np.nan
    ) -> dict[str, NDArray[np.float64]]:
        """Force, state rate and energies at given states.

        Parameters
        ----------
        x, v, a : array_like, broadcastable to one shape (n,)
            Relative displacement [m], velocity, acceleration.
        z : array_like
            States: shape (n, nstate), or anything that broadcasts to it. With at most one state
            also (n,); one number is the first state.
        command : array_like
            Where the control sets a parameter, the value that it asks for, in the parameter's unit;
            NaN: the one that is stated.

        Returns
        -------
        dict of arrays (n,)
            total, inertance, friction [N]; stored_energy [J]; dissipated_power [W]; state_rate,
            (n, nstate) with several states or where z has their axis; where the control sets a
            parameter, control_power [W], what its actuator gives.
        """
        told = (*FORCES, "stored_energy", "dissipated_power")
        commanded = self.control != "force"
        (x, v, a, command), z, axis = self._points((x, v, a, command), np.asarray(z, dtype=float))
        told = (*told, "control_power") if commanded else told
        result, rates = np.empty((len(told), x.size)), np.zeros((x.size, max(1, self.nstate)))
        core, motion = library(), (x, v, a, command) if commanded else (x, v, a)
        evaluate = core.inerter_evaluate_commanded if commanded else core.inerter_evaluate
        evaluate(
            ctypes.byref(self._c),
            x.size,
            *(_pointer(value) for value in (*motion, z)),
            _pointer(result),
            _pointer(rates),
        )
        found = dict(zip(told, result.reshape(len(told), *x.shape), strict=True))
        wide = (self.nstate,) if axis else ()
        return found | {"state_rate": rates[:, : sum(wide) if axis else 1].reshape(*x.shape, *wide)}

    def _points(
        self, motion: Sequence[ArrayLike], z: NDArray[np.float64]
    ) -> tuple[list[NDArray[np.float64]], NDArray[np.float64], bool]:
        """Motion of one shape, states (that shape, nstate); whether rates get an axis of states."""
        motion = np.broadcast_arrays(*np.atleast_1d(*motion))
        n = self.nstate
        axis = z.ndim > 0 and z.shape[-1] == n and (n != 1 or z.ndim > motion[0].ndim)
        if n > 1 and z.ndim and not axis:
            raise ValueError(f"z has shape {z.shape}; this device has {n} states: give (n, {n})")
        if not axis:
            z = np.atleast_1d(z)[..., np.newaxis]
            z = np.concatenate([z, np.zeros((*z.shape[:-1], max(0, n - 1)))], axis=-1)
        shape = np.broadcast_shapes(motion[0].shape, z.shape[:-1])
        states = np.ascontiguousarray(np.broadcast_to(z, (*shape, z.shape[-1])))
        wide = [
            np.ascontiguousarray(np.broadcast_to(value, shape), dtype=float) for value in motion
        ]
        return wide, states, axis or n > 1

    def _states(self, z: ArrayLike) -> NDArray[np.float64]:
        """All states, a copy of shape (nstate,)."""
        given, n = np.asarray(z, dtype=float), self.nstate
        states = np.zeros(n)
        if given.ndim == 0:
            states[:1] = given
        elif given.shape == (n,):
            states[:] = given
        else:
            raise ValueError(f"the state has shape {given.shape}; this device has {n} states")
        return states

    def commanded(self, command: float, z: ArrayLike = 0.0) -> Device:
        """The device at the value that its control commands, in the parameter's unit; states z.

        A device by itself, whose control is a force: it has one state less where there is a lag.

        Raises
        ------
        DeviceError
            The control is a force.
        """
        if self.control == "force":
            raise DeviceError(
                "control is 'force', which sets no parameter; give the device a control, such as "
                "control='viscous' with control_lower and control_upper"
            )
        c, states = device_type()(), self._states(z)
        ctypes.pointer(c)[0] = self._c
        library().inerter_command(ctypes.byref(c), command, states.ctypes.data)
        kept = {key: value for key, value in self._given.items() if not key.startswith("control")}
        return Device(**{**kept, self.control: getattr(c, self.control)})

    @overload
    def step(self, x: float, v: float, z: float, h: float, a: float = 0.0) -> float: ...
    @overload
    def step(
        self, x: float, v: float, z: Sequence[float] | NDArray, h: float, a: float = 0.0
    ) -> NDArray[np.float64]: ...
    def step(
        self, x: float, v: float, z: Any, h: float, a: float = 0.0
    ) -> float | NDArray[np.float64]:
        """States after a time h at constant velocity v from displacement x, in the form of z.

        Where the load raises the level of a bristle, it is that of the acceleration a [m/s^2].
        """
        states = self._states(z)
        library().inerter_state_step(ctypes.byref(self._c), x, v, a, states.ctypes.data, h)
        return states if np.ndim(z) else float(states[0]) if self.nstate else 0.0

    def state_of_force(
        self, x: float, v: float, a: float, force: float
    ) -> float | NDArray[np.float64]:
        """State at which the device has a given total force, within what its law can hold.

        A number for a device with at most one state, else an array (nstate,): with a series element
        this one carries the force, the flywheel moves along and friction is at 0. Behind free play
        (`friction_backlash`) a friction force of 0 has many states: the middle is given.
        """
        states = np.zeros(self.nstate)
        library().inerter_state_of_force(ctypes.byref(self._c), x, v, a, force, states.ctypes.data)
        return states if self.nstate > 1 else float(states.sum())

    def over_step(
        self, x: float, v: float, a: float, z: ArrayLike, h: float, mobility: float
    ) -> tuple[dict[str, float], NDArray[np.float64]]:
        """Force over a step of h seconds at whose end the velocity is v + h a.

        Parameters
        ----------
        x, v, z : float; z also a sequence (nstate,)
            Relative displacement [m], velocity and states at the start.
        a, h, mobility : float
            Acceleration over the step, its length [s], acceleration of the terminals per force
            [1/kg].

        Returns
        -------
        dict, ndarray (nstate,)
            total, inertance, friction [N]; states at the end.
        """
        states = self._states(z)
        end = np.zeros_like(states)
        force = library().inerter_force_over_step(
            ctypes.byref(self._c), x, v, a, states.ctypes.data, h, mobility, end.ctypes.data
        )
        return {name: getattr(force, name) for name in FORCES}, end

    def validity(self, x: float, z: ArrayLike = 0.0) -> str | None:
        """None where the laws hold at displacement x and states z, else which one does not."""
        states, message = self._states(z), ctypes.create_string_buffer(MESSAGE_SIZE)
        if library().inerter_valid(ctypes.byref(self._c), x, states.ctypes.data, message):
            return None
        return message_text(message)

    def along(
        self,
        h: float,
        x: ArrayLike,
        v: ArrayLike,
        a: ArrayLike,
        state: ArrayLike = 0.0,
        command: ArrayLike | None = None,
    ) -> dict[str, NDArray[np.float64]]:
        """Force and states along a motion sampled every h seconds.

        Parameters
        ----------
        h : float
            Sample spacing [s].
        x, v, a : ndarray (n,)
            Relative displacement [m], velocity, acceleration.
        state : float or sequence (nstate,)
            States at the first sample.
        command : ndarray (n,) or float, optional
            What the control commands, in the unit of the parameter that it sets, held from each
            sample to the next.

        Returns
        -------
        dict of ndarray
            total [N], friction [N], shape (n,); states (n, nstate); state (n,), the first of them
            (0 without states).

        Raises
        ------
        ValueError
            Channels of different lengths, a number that is not finite, a spacing that is not > 0.
        """
        x, v, a = checked_motion(h, x, v, a)
        return self.along_checked(h, x, v, a, state, command)

    def along_checked(
        self,
        h: float,
        x: NDArray,
        v: NDArray,
        a: NDArray,
        state: ArrayLike = 0.0,
        command: ArrayLike | None = None,
    ) -> dict[str, NDArray[np.float64]]:
        """`along` a motion that `checked_motion` has returned: many devices along the same one."""
        result, states = np.empty((2, x.size)), np.empty((x.size, self.nstate))
        now = self._states(state)
        at, row = result.ctypes.data, result.strides[0]
        told = None if command is None else np.array(np.broadcast_to(command, x.shape), float)
        library().inerter_along_commanded(
            ctypes.byref(self._c), x.size, h, x.ctypes.data, v.ctypes.data, a.ctypes.data,
            None if told is None else told.ctypes.data, now.ctypes.data, at, at + row,
            states.ctypes.data,
        )  # fmt: skip
        first = states[:, 0] if self.nstate else np.zeros(x.size)
        return {"total": result[0], "friction": result[1], "state": first, "states": states}

    def force_checked(
        self, h: float, x: NDArray, v: NDArray, a: NDArray, state: ArrayLike, name: str
    ) -> NDArray[np.float64]:
        """The force "total" or "friction" alone of `along_checked`, shape (n,)."""
        force, now = np.empty(x.size), self._states(state)
        at = force.ctypes.data
        wanted = (at, None) if name == "total" else (None, at)
        library().inerter_along_commanded(
            ctypes.byref(self._c), x.size, h, x.ctypes.data, v.ctypes.data, a.ctypes.data, None,
            now.ctypes.data, *wanted, None,
        )  # fmt: skip
        return force


def along_many(
    devices: Sequence[Device],
    h: float,
    x: NDArray,
    v: NDArray,
    a: NDArray,
    threads: int | None = None,
) -> NDArray[np.float64]:
    """Total force of many devices along one motion, states starting at 0.

    Parameters
    ----------
    devices : sequence of Device
        m devices.
    h : float
        Sample spacing [s].
    x, v, a : ndarray (n,)
        Relative displacement [m], velocity, acceleration.
    threads : int, optional
        Threads to use; the default is one per processor.

    Returns
    -------
    ndarray (m, n)
        Forces [N], the same whatever the number of threads.
    """
    x, v, a = checked_motion(h, x, v, a)
    total = np.empty((len(devices), x.size))
    array = (device_type() * len(devices))(*(device._c for device in devices))
    size = ctypes.sizeof(device_type())

    def run(first: int, count: int) -> None:
        motion = map(_pointer, (x, v, a, total[first:]))
        start, spacing = ctypes.byref(array, first * size), ctypes.c_double(h)
        library().inerter_along_many(start, count, x.size, spacing, *motion)

    workers = min(threads or os.cpu_count() or 1, len(devices)) or 1
    bounds = np.linspace(0, len(devices), workers + 1).astype(int)
    if workers == 1:
        run(0, len(devices))
    else:
        with ThreadPoolExecutor(workers) as pool:
            list(pool.map(run, bounds[:-1].tolist(), np.diff(bounds).tolist()))
    return total


def _pointer(array: NDArray[np.float64]) -> Any:
    return array.ctypes.data_as(ctypes.POINTER(ctypes.c_double))
