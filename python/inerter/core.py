"""The C core from Python: parameters, one device, many devices along a motion."""

from __future__ import annotations

import ctypes
import functools
import os
import sys
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

LIBRARY_FOLDER = Path(__file__).parent / "lib"
_MESSAGE_SIZE = 512


class DeviceError(ValueError):
    """A device that cannot be: names the parameter, its value, what is allowed."""


class _CParameter(ctypes.Structure):
    _fields_ = [
        ("name", ctypes.c_char_p),
        ("unit", ctypes.c_char_p),
        ("initial", ctypes.c_double),
        ("lower", ctypes.c_double),
        ("upper", ctypes.c_double),
        ("lower_open", ctypes.c_int),
        ("offset", ctypes.c_size_t),
        ("laws", ctypes.c_char_p),
        ("meaning", ctypes.c_char_p),
    ]


@dataclass(frozen=True)
class Parameter:
    """What the core says of one parameter.

    `initial` is the default (NaN: derived from others), `laws` the friction laws that read it
    (empty: the device itself).
    """

    name: str
    unit: str
    initial: float
    lower: float
    upper: float
    lower_open: bool
    laws: tuple[str, ...]
    meaning: str


def library_path(stem: str) -> Path:
    """Path of a shared library of this package, by its stem."""
    suffix = {"darwin": ".dylib", "win32": ".dll"}.get(sys.platform, ".so")
    prefix = "" if sys.platform == "win32" else "lib"
    return LIBRARY_FOLDER / f"{prefix}{stem}{suffix}"


@functools.cache
def _library() -> ctypes.CDLL:
    path = library_path("inerter_core")
    if not path.exists():
        raise ImportError(
            f"{path} is missing: reinstall with `pip install --force-reinstall inerter`"
        )
    library = ctypes.CDLL(os.fspath(path))
    library.inerter_parameter.restype = ctypes.POINTER(_CParameter)
    library.inerter_friction_name.restype = ctypes.c_char_p
    library.inerter_friction_meaning.restype = ctypes.c_char_p
    for name in ("state_step", "state_of_force"):
        function = getattr(library, f"inerter_{name}")
        function.restype = ctypes.c_double
        function.argtypes = [ctypes.c_void_p] + [ctypes.c_double] * 4
    library.inerter_along.argtypes = [
        ctypes.c_void_p,
        ctypes.c_int,
        ctypes.c_double,
        *[ctypes.c_void_p] * 7,
    ]
    return library


@functools.cache
def parameters() -> Mapping[str, Parameter]:
    """Every parameter of a device by name, as declared in the core."""
    found: dict[str, Parameter] = {}
    while entry := _library().inerter_parameter(len(found)):
        c = entry.contents
        found[c.name.decode()] = Parameter(
            c.name.decode(),
            c.unit.decode(),
            c.initial,
            c.lower,
            c.upper,
            bool(c.lower_open),
            tuple(c.laws.decode().split()),
            c.meaning.decode(),
        )
    return found


@functools.cache
def friction_laws() -> Mapping[str, str]:
    """The friction laws by name, with their meaning."""
    found: dict[str, str] = {}
    while name := _library().inerter_friction_name(len(found)):
        found[name.decode()] = _library().inerter_friction_meaning(len(found)).decode()
    return found


@functools.cache
def _device_type() -> type[ctypes.Structure]:
    fields: list[tuple[str, Any]] = [(name, ctypes.c_double) for name in parameters()]
    fields += [("friction", ctypes.c_int), ("given", ctypes.c_uint64)]
    return type("_CDevice", (ctypes.Structure,), {"_fields_": fields})


class Device:
    """A device: inertance, damping, stiffness, further force laws and one friction law.

    Parameters
    ----------
    **values : float or str
        Parameters by name (see `parameters()`), SI units, and `friction`, a law's name. What is
        not given has its default.

    Raises
    ------
    DeviceError
        An unknown name, a value out of range, values that do not fit together.
    """

    def __init__(self, **values: float | str) -> None:
        self._c = _device_type()()
        library, message = _library(), ctypes.create_string_buffer(_MESSAGE_SIZE)
        library.inerter_default(ctypes.byref(self._c))
        for name, value in values.items():
            text = value if isinstance(value, str) else repr(float(value))
            if library.inerter_set(ctypes.byref(self._c), name.encode(), text.encode(), message):
                raise DeviceError(_with_suggestion(name, _text(message)))
        if library.inerter_finish(ctypes.byref(self._c), message):
            raise DeviceError(_text(message))
        self._given = {
            name: self.friction if name == "friction" else getattr(self._c, name) for name in values
        }

    @property
    def given(self) -> dict[str, float | str]:
        """What was stated, by name."""
        return dict(self._given)

    @property
    def friction(self) -> str:
        """Name of the friction law."""
        return list(friction_laws())[self._c.friction]  # type: ignore[attr-defined]

    @property
    def nstate(self) -> int:
        """Number of states of the friction law."""
        return _library().inerter_nstate(ctypes.byref(self._c))

    def __getattr__(self, name: str) -> float:
        if name.startswith("_") or name not in parameters():
            raise AttributeError(name)
        return getattr(self._c, name)

    def __repr__(self) -> str:
        return "Device(" + ", ".join(f"{k}={v!r}" for k, v in self._given.items()) + ")"

    def replace(self, **values: float | str) -> Device:
        """The same device with some values stated anew."""
        return Device(**{**self._given, **values})

    def evaluate(
        self, x: ArrayLike, v: ArrayLike, a: ArrayLike, z: ArrayLike
    ) -> dict[str, NDArray[np.float64]]:
        """Force, state rate and energies at given states.

        Parameters
        ----------
        x, v, a, z : array_like, broadcastable to one shape (n,)
            Relative displacement [m], velocity, acceleration, state.

        Returns
        -------
        dict of arrays (n,)
            total, inertance, friction [N]; state_rate; stored_energy [J]; dissipated_power [W].
        """
        names = (
            "total",
            "inertance",
            "friction",
            "state_rate",
            "stored_energy",
            "dissipated_power",
        )
        x, v, a, z = (
            np.ascontiguousarray(value, dtype=float)
            for value in np.broadcast_arrays(*np.atleast_1d(x, v, a, z))
        )
        result = np.empty((len(names), x.size))
        _library().inerter_evaluate(
            ctypes.byref(self._c),
            x.size,
            *(_pointer(value) for value in (x, v, a, z)),
            _pointer(result),
        )
        return dict(zip(names, result.reshape(len(names), *x.shape), strict=True))

    def step(self, x: float, v: float, z: float, h: float) -> float:
        """State after a time h at constant velocity v from displacement x."""
        return _library().inerter_state_step(ctypes.byref(self._c), x, v, z, h)

    def state_of_force(self, x: float, v: float, a: float, force: float) -> float:
        """State at which the device has a given total force, within what its law can hold."""
        return _library().inerter_state_of_force(ctypes.byref(self._c), x, v, a, force)

    def along(
        self, h: float, x: NDArray, v: NDArray, a: NDArray, state: float = 0.0
    ) -> dict[str, NDArray[np.float64]]:
        """Force and state along a motion sampled every h seconds.

        Parameters
        ----------
        h : float
            Sample spacing [s].
        x, v, a : ndarray (n,)
            Relative displacement [m], velocity, acceleration.
        state : float
            State at the first sample.

        Returns
        -------
        dict of ndarray (n,)
            total [N], friction [N], state.
        """
        x, v, a = _motion(x, v, a)
        result = np.empty((3, x.size))
        at, row = result.ctypes.data, result.strides[0]
        _library().inerter_along(
            ctypes.byref(self._c),
            x.size,
            h,
            x.ctypes.data,
            v.ctypes.data,
            a.ctypes.data,
            ctypes.byref(ctypes.c_double(state)),
            at,
            at + row,
            at + 2 * row,
        )
        total, friction, states = result
        return {"total": total, "friction": friction, "state": states}


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
    x, v, a = _motion(x, v, a)
    total = np.empty((len(devices), x.size))
    array = (_device_type() * len(devices))(*(device._c for device in devices))
    size = ctypes.sizeof(_device_type())

    def run(first: int, count: int) -> None:
        _library().inerter_along_many(
            ctypes.byref(array, first * size),
            count,
            x.size,
            ctypes.c_double(h),
            _pointer(x),
            _pointer(v),
            _pointer(a),
            _pointer(total[first:]),
        )

    workers = min(threads or os.cpu_count() or 1, len(devices)) or 1
    bounds = np.linspace(0, len(devices), workers + 1).astype(int)
    if workers == 1:
        run(0, len(devices))
    else:
        with ThreadPoolExecutor(workers) as pool:
            list(pool.map(run, bounds[:-1].tolist(), np.diff(bounds).tolist()))
    return total


def _motion(*channels: NDArray) -> list[NDArray[np.float64]]:
    arrays = [np.ascontiguousarray(channel, dtype=float) for channel in channels]
    shape = arrays[0].shape
    if len(shape) != 1 or any(array.shape != shape for array in arrays):
        shapes = ", ".join(str(array.shape) for array in arrays)
        raise ValueError(f"x, v, a must be arrays of one length; their shapes are {shapes}")
    return arrays


def _pointer(array: NDArray[np.float64]) -> Any:
    return array.ctypes.data_as(ctypes.POINTER(ctypes.c_double))


def _text(message: ctypes.Array[ctypes.c_char]) -> str:
    # a long value is cut, perhaps within a character
    return message.value.decode(errors="replace")


def _with_suggestion(name: str, message: str) -> str:
    if name == "friction" or name in parameters():
        return message
    import difflib

    close = difflib.get_close_matches(name, [*parameters(), "friction"], n=3)
    hint = f"did you mean {', '.join(close)}?" if close else "`inerter parameters` lists them"
    return f"{message}; {hint}"
