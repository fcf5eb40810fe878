"""The C library that evaluates tapes inside Exudyn's solvers, without running any Python."""

from __future__ import annotations

import ctypes
import functools
import os
from typing import Any

from inerter.core import library_path

PYTHON = (
    "PyTuple_GetItem", "PyLong_AsVoidPtr", "PyList_Size", "PyList_GetItem", "PyList_New",
    "PyList_SetItem", "PyFloat_FromDouble", "PyFloat_AsDouble", "PyErr_Occurred",
    "PyErr_SetString", "PyObject_CallObject", "PyObject_GetAttr", "PyObject_CallMethodObjArgs",
    "PyObject_GetBuffer", "PyBuffer_Release", "Py_IncRef", "Py_DecRef",
)  # fmt: skip
"""Functions of Python that the library calls, in its order."""

METHODS = ("force", "mass", "jacobian", "sensor")


class CTape(ctypes.Structure):
    """InerterTape of plugin_c/exudyn/tape.h."""

    _fields_ = (
        ("ninput", ctypes.c_int32),
        ("nconstant", ctypes.c_int32),
        ("nstep", ctypes.c_int32),
        ("steps", ctypes.c_void_p),
        ("spans", ctypes.c_void_p),
        ("values", ctypes.c_void_p),
        ("slopes", ctypes.c_void_p),
    )


class CElement(ctypes.Structure):
    """InerterElement of plugin_c/exudyn/callbacks.c."""

    _fields_ = (
        ("tape", CTape),
        ("size", ctypes.c_int32),
        ("nrow", ctypes.c_int32),
        ("ndistinct", ctypes.c_int32),
        ("loaded", ctypes.c_int32),
        ("known", ctypes.c_int32),
        ("forces", ctypes.c_void_p),
        ("distinct", ctypes.c_void_p),
        ("entries", ctypes.c_void_p),
        ("length", ctypes.c_int32),
        ("shortest", ctypes.c_double),
        ("mass", ctypes.c_void_p),
        ("jacobian", ctypes.c_void_p),
        ("mass_array", ctypes.py_object),
        ("jacobian_array", ctypes.py_object),
        ("mass_list", ctypes.py_object),
        ("jacobian_list", ctypes.py_object),
        ("reader", ctypes.py_object),
        ("none", ctypes.py_object),
        ("error", ctypes.py_object),
        ("message", ctypes.c_char_p),
    )


class CSensor(ctypes.Structure):
    """InerterSensor of plugin_c/exudyn/sensor.c."""

    _fields_ = (
        ("tape", ctypes.c_void_p),
        ("size", ctypes.c_int32),
        ("ntold", ctypes.c_int32),
        ("total", ctypes.c_int32),
        ("needed", ctypes.c_int32 * 3),
        ("places", ctypes.c_void_p),
        ("coordinates", ctypes.c_void_p),
        ("data", ctypes.py_object),
        ("question", ctypes.py_object * 3),
        ("whole", ctypes.py_object),
    )


@functools.cache
def _library() -> ctypes.CDLL:
    # PyDLL: what it calls of Python needs the interpreter's lock
    path = library_path("inerter_exudyn")
    if not path.exists():
        raise ImportError(
            f"{path} is missing: reinstall with `pip install --force-reinstall inerter`"
        )
    library = ctypes.PyDLL(os.fspath(path))
    library.inerter_exudyn_method.restype = ctypes.c_void_p
    library.inerter_exudyn_operation.restype = ctypes.c_char_p
    library.inerter_exudyn_run.restype = library.inerter_exudyn_run_slopes.restype = None
    table = (ctypes.c_void_p * len(PYTHON))(
        *(ctypes.cast(getattr(ctypes.pythonapi, name), ctypes.c_void_p).value for name in PYTHON)
    )
    library.inerter_exudyn_begin(table)
    return library


@functools.cache
def operations() -> dict[str, int]:
    """The operations of a tape by name."""
    found: dict[str, int] = {}
    while name := _library().inerter_exudyn_operation(len(found)):
        found[name.decode()] = len(found)
    return found


@functools.cache
def listed() -> int:
    """Up to this size Exudyn reads a matrix faster from lists than from an array."""
    return int(_library().inerter_exudyn_listed())


def run(tape: Any) -> None:
    """Evaluate a tape, a reference to a CTape."""
    _evaluate()(tape)


@functools.cache
def _evaluate() -> Any:
    return _library().inerter_exudyn_run


def run_slopes(tape: Any) -> None:
    """The derivatives of what `run` evaluated."""
    _library().inerter_exudyn_run_slopes(tape)


def built_in(method: str, own: CElement | CSensor, *kept: Any) -> Any:
    """A built-in function of Python over an element or a sensor, which live as long as it."""
    make = ctypes.pythonapi.PyCFunction_NewEx
    make.argtypes, make.restype = (
        [ctypes.c_void_p, ctypes.py_object, ctypes.c_void_p],
        ctypes.py_object,
    )
    definition = _library().inerter_exudyn_method(METHODS.index(method))
    return make(definition, (ctypes.addressof(own), own, *kept), None)
