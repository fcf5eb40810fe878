"""A run as records: one CSV per device, one for a vehicle, in the form that `diagnose` reads.

Device: time, displacement, force, velocity, acceleration; then inertance_force, friction_force
[N], the states, stored_energy, dissipated_energy [J], and control_force [N] if there was any; where
the control sets a parameter control_command, in its unit.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import mujoco
import polars as pl
from numpy.typing import NDArray

import inerter
from inerter.core import parameters
from inerter.folder import file_names
from inerter.motion_units import ROTATION
from inerter.printable import printable
from inerter.records.turning import UNITS
from inerter.simulate.run import SimulatedRun
from inerter.simulate.sample import DeviceRun


def device_names(run: SimulatedRun) -> list[str]:
    """File names, without extension, of the devices: what a file may be called, all different."""
    return file_names([device.place.name for device in run.devices], "device")


def device_csv(run: SimulatedRun, device: DeviceRun) -> str:
    """Text of a device's record."""
    place = device.place
    given = ", ".join(
        f"{name} = {value}" if isinstance(value, str) else f"{name} = {value:.10g}{_unit(name)}"
        for name, value in place.stated(run.model).items()
    )
    notes = [
        f'device "{place.name}" of {run.path.name}: {given or "no parameters"}',
        *_origin(run),
        "displacement: length of the actuator less the rest length; force: tension positive,",
        "without control_force, which acts beside the device; SI units",
        "acceleration: the engine's at the row's instant, along the device: J qacc + dJ/dt qvel",
    ]
    if device.motion == ROTATION:
        notes.insert(-1, "on a hinge: read rad for m, N*m for N, kg*m^2 for kg")
        return _csv(notes, {_turning(name): each for name, each in device.columns.items()})
    return _csv(notes, device.columns)


def _turning(name: str) -> str:
    """The header of a column of a device on a hinge, with which it is read as one that turns."""
    return f"{name}[{UNITS[name]}]" if name in UNITS else name


def vehicle_csv(run: SimulatedRun) -> str:
    """Text of the vehicle record."""
    return _csv([f"vehicle of {run.path.name}", *_origin(run)], run.vehicle)


def _origin(run: SimulatedRun) -> list[str]:
    steps = "step" if run.every == 1 else f"{run.every} steps"
    return [
        f"simulated by inerter {inerter.__version__} with MuJoCo {mujoco.mj_versionString()}, "
        f"{run.integrator}, time step {run.model.opt.timestep:g} s, a row every {steps}",
    ]


def _unit(name: str) -> str:
    unit = parameters()[name].unit
    return "" if unit == "1" else f" {unit}"


def _csv(notes: Iterable[str], columns: Mapping[str, NDArray]) -> str:
    # names come from the model: a line break in one must not end the comment
    head = "".join(f"# {printable(' '.join(note.split()))}\n" for note in notes)
    return head + pl.DataFrame(dict(columns)).write_csv()
