"""What the devices of a running model tell beside their sensors: energy, how they were solved."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from inerter.plugin import load_plugin, plugin_path

if TYPE_CHECKING:
    import mujoco


@dataclass(frozen=True, kw_only=True)
class Energy:
    """Energy of a model with devices.

    Attributes
    ----------
    kinetic
        Kinetic energy of the engine's inertia matrix [J], native inertances in it.
    potential
        Potential energy of the engine [J]: gravity, springs of joints, tendons and flexes.
    devices
        Energy stored in the devices [J] beside that: inertance that the engine's matrix does not
        hold, flywheels behind a series element, springs, bristles, gas, stops.
    """

    kinetic: float
    potential: float
    devices: float

    @property
    def total(self) -> float:
        """Sum of the three [J]; what friction and dampers take is gone from it."""
        return self.kinetic + self.potential + self.devices


@dataclass(frozen=True, kw_only=True)
class SolveCounts:
    """How the force of a device was found since the last reset of its MjData.

    Attributes
    ----------
    solves
        Evaluations in which force and acceleration were found together; 0 for a device whose
        force needs no solution.
    stops
        Of these, solves that stopped at their bound: the force may differ from the one that goes
        with the acceleration, by rounding or, with constraints, by more, which `misfits` counts.
    misfits
        Evaluations in which force and acceleration were left more than 1e-6 apart, and steps
        (integrators other than RK4) that ended with another acceleration than the force was found
        with: the engine's constraint solver stopped before its end (noslip, no warm start, PGS), or
        all actuation is disabled.
    """

    solves: int
    stops: int
    misfits: int


@lru_cache(maxsize=1)
def _library() -> ctypes.CDLL:
    load_plugin()
    library = ctypes.CDLL(str(plugin_path()))
    address = [ctypes.c_void_p, ctypes.c_void_p, ctypes.c_int]
    library.inerter_energy.argtypes = [*address, ctypes.POINTER(ctypes.c_double)]
    library.inerter_solve_counts.argtypes = [*address, ctypes.POINTER(ctypes.c_int64)]
    return library


def _addresses(model: mujoco.MjModel, data: mujoco.MjData) -> tuple[int, int]:
    if (data.model.nactuator, data.model.nv) != (model.nactuator, model.nv):
        raise ValueError(
            f"data was made for a model with {data.model.nactuator} actuators and "
            f"{data.model.nv} dofs, the model has {model.nactuator} and {model.nv}: give the "
            f"MjData that belongs to the model"
        )
    return model._address, data._address


def _devices(
    places: tuple[int, int], actuators: int, told: Callable[..., int], result: Any
) -> Iterator[int]:
    """Actuators that are devices; `told` has filled the result with what it knows of each."""
    for actuator in range(actuators):
        if told(*places, actuator, result) == 0:
            yield actuator


def energy(model: mujoco.MjModel, data: mujoco.MjData) -> Energy:
    """Energy of a model with its devices, wherever their inertance lives.

    Kinetic and potential energy are computed here from the present `qpos`, `qvel` and `act` with
    the positions of the last forward pass: call `mujoco.mj_forward` after writing into them.
    `data.energy` stays as it is, and counts the same but for `devices`.

    Parameters
    ----------
    model, data
        A compiled model and its MjData.

    Raises
    ------
    ValueError
        The MjData was made for another model.
    """
    import mujoco

    places = _addresses(model, data)
    kept = data.energy.copy()
    mujoco.mj_energyPos(model, data)
    mujoco.mj_energyVel(model, data)
    potential, kinetic = (float(value) for value in data.energy)
    data.energy[:] = kept
    stored = (ctypes.c_double * 2)()
    devices = 0.0
    for _ in _devices(places, model.nactuator, _library().inerter_energy, stored):
        devices += stored[0] - stored[1]
    return Energy(kinetic=kinetic, potential=potential, devices=devices)


def solve_counts(model: mujoco.MjModel, data: mujoco.MjData) -> dict[str, SolveCounts]:
    """How the force of each device was found since the last reset, by the actuator's name.

    An actuator without a name is called by its number, "actuator 3".

    Parameters
    ----------
    model, data
        A compiled model and its MjData.

    Raises
    ------
    ValueError
        The MjData was made for another model.
    """
    places = _addresses(model, data)
    counts = (ctypes.c_int64 * 3)()
    found = {}
    for actuator in _devices(places, model.nactuator, _library().inerter_solve_counts, counts):
        name = model.actuator(actuator).name or f"actuator {actuator}"
        found[name] = SolveCounts(solves=counts[0], stops=counts[1], misfits=counts[2])
    return found
