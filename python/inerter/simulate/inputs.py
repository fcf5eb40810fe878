"""Inputs over time from a table: controls, imposed joint motions, mocap bodies.

A column drives what it is named after: an actuator (its control), else a slide or hinge joint (its
position), else a mocap body by NAME.x, NAME.y, NAME.z (position in the world). Units in brackets
are converted to SI; one that what is driven cannot have is refused. The table's first instant is
the start of the run; before and after the table its end values hold. Between samples controls and
mocap positions are linear, joint motions a cubic spline, so that their velocity and acceleration
are continuous.

An imposed joint is a moving constraint. Its position and velocity are set, and a generalized force
tau is applied such that the joint has the prescribed acceleration:

    qacc_j(tau) = r''(t)     found by Newton steps with the response d(qacc_j)/d(tau_k)

[tau]: N or N m. So the bodies that hang on the joint feel its acceleration. Setting the position
alone would let them fall as if the joint were free between two steps. tau is held over a step,
while what hangs on the joint pulls at it differently from stage to stage: the joint is given an
armature that outweighs all of that, which moves nothing else, as its own motion is prescribed.
Not modelled: what drives the joint; its force is whatever is needed.

A tyre with damping (`inerter.cars.mjcf`) takes the road's height plus its lead times its rate; the
table gives heights, the rate is that of the straight line between two of them.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from inerter.cars.mjcf import LEAD
from inerter.engine_errors import SimulationError
from inerter.records import RecordError
from inerter.records.raw_table import RawTable
from inerter.records.table import read_table
from inerter.records.units import ACCELERATIONS, LENGTH, QUANTITIES, Quantity, split_header
from inerter.simulate.load import scalar_joints
from inerter.simulate.quantities import no_control, quantity_of_control, quantity_of_joint
from inerter.unit_text import parse_unit, unit_registry

Array = NDArray[np.float64]
_AXES = ("x", "y", "z")

# armature of an imposed joint per inertia of what hangs on it
_OUTWEIGHS = 1e9


@dataclass(kw_only=True)
class Inputs:
    """What drives a model.

    times: [s], from 0. controls: values by index of `ctrl`. mocap: values by (mocap body, axis).
    joints: cubic spline by joint. driven: names for people. leads: [s] by index of `ctrl`, of
    tyres with damping.
    """

    times: Array
    controls: dict[int, Array] = field(default_factory=dict)
    mocap: dict[tuple[int, int], Array] = field(default_factory=dict)
    joints: dict[int, Any] = field(default_factory=dict)
    driven: list[str] = field(default_factory=list)
    ignored: list[str] = field(default_factory=list)
    leads: dict[int, float] = field(default_factory=dict)
    _response: Array | None = None

    @property
    def duration(self) -> float:
        """Length of the table [s]."""
        return float(self.times[-1])

    def outweigh(self, model: mujoco.MjModel) -> None:
        """Give the imposed joints of a model their armature, once, before the first step."""
        dofs = model.jnt_dofadr[list(self.joints)]
        model.dof_armature[dofs] += _OUTWEIGHS * model.dof_M0[dofs]

    def apply(self, model: mujoco.MjModel, data: mujoco.MjData, t: float, ahead: float) -> None:
        """Set every input for the instant t [s] since the start.

        Controls and imposed accelerations are those of t + ahead.
        """
        for index, values in self.controls.items():
            data.ctrl[index] = np.interp(t + ahead, self.times, values)
            if index in self.leads:
                data.ctrl[index] += self.leads[index] * self._rate(values, t + ahead)
        for (body, axis), values in self.mocap.items():
            data.mocap_pos[body, axis] = np.interp(t, self.times, values)
        if self.joints:
            self._impose(model, data, min(t, self.duration), ahead if t < self.duration else 0.0)

    def _rate(self, values: Array, t: float) -> float:
        """Rate of a control at t [s] since the start; 0 before and after the table."""
        row = int(np.searchsorted(self.times, t, side="right")) - 1
        if not 0 <= row < len(self.times) - 1:
            return 0.0
        return float((values[row + 1] - values[row]) / (self.times[row + 1] - self.times[row]))

    def heights(self, model: mujoco.MjModel, times: Array) -> dict[str, Array]:
        """Of tyres with damping, by the name of the control: the road itself at times [s]."""
        names = {int(model.actuator_ctrladr[i]): model.actuator(i).name
                 for i in range(model.nactuator)}  # fmt: skip
        return {
            names[index]: np.interp(times, self.times, self.controls[index]) for index in self.leads
        }

    def imposed(self, model: mujoco.MjModel, t: float) -> tuple[list[int], list[float]]:
        """Dofs of the imposed joints, and their accelerations at t [s] since the start."""
        dofs = [int(model.jnt_dofadr[joint]) for joint in self.joints]
        moving = t < self.duration
        return dofs, [float(spline(t, 2)) * moving for spline in self.joints.values()]

    def _impose(self, model: mujoco.MjModel, data: mujoco.MjData, t: float, ahead: float) -> None:
        joints = list(self.joints)
        dofs = model.jnt_dofadr[joints]
        moving = t < self.duration
        wanted = np.zeros(len(joints))
        for i, (joint, spline) in enumerate(self.joints.items()):
            data.qpos[model.jnt_qposadr[joint]] = spline(t)
            data.qvel[dofs[i]] = spline(t, 1) if moving else 0.0
            wanted[i] = spline(t + ahead, 2) if moving else 0.0

        # the force that gives the acceleration; the response of the last step nearly always serves
        tolerance = 1e-9 * (1 + np.abs(wanted).max())
        for attempt in range(6):
            mujoco.mj_forward(model, data)
            miss = wanted - data.qacc[dofs]
            if np.abs(miss).max() <= tolerance or not np.isfinite(miss).all():
                return
            if self._response is None or attempt >= 2:
                self._response = _response(model, data, dofs)
            data.qfrc_applied[dofs] += np.linalg.lstsq(self._response, miss, rcond=None)[0]


def _response(model: mujoco.MjModel, data: mujoco.MjData, dofs: NDArray[Any]) -> Array:
    """Accelerations of dofs per force on each of them, by differences about the present forces."""
    rows = np.zeros((len(dofs), model.nv))
    unit = np.zeros_like(rows)
    unit[np.arange(len(dofs)), dofs] = 1.0
    mujoco.mj_solveM(model, data, rows, unit)
    before = data.qacc[dofs].copy()
    found = np.empty((len(dofs), len(dofs)))
    for i, dof in enumerate(dofs):
        # a force that would change the acceleration by 1 if nothing but inertia resisted
        force = 1 / rows[i, dof]
        data.qfrc_applied[dof] += force
        mujoco.mj_forward(model, data)
        found[:, i] = (data.qacc[dofs] - before) / force
        data.qfrc_applied[dof] -= force
    return found


def read_inputs(path: Path, model: mujoco.MjModel) -> Inputs:
    """Inputs from a CSV, Parquet or MATLAB file; see the head of this file.

    Columns of a vehicle or bench record that drive nothing are left aside.

    Raises
    ------
    SimulationError
        The file cannot be read, times do not increase, a cell is no number, a column drives
        nothing or has a unit that what it drives cannot have; names the column and what there is to
        drive, or which units there are.
    """
    try:
        table = read_table(path)
    except RecordError as error:
        raise SimulationError(str(error)) from None
    headers = [_split(header) for header in table.header]
    names = [name for name, _ in headers]
    if "time" not in [name.casefold() for name in names]:
        raise SimulationError(f"{path}: no column 'time'; it has {', '.join(names)}")
    clock = [name.casefold() for name in names].index("time")
    times = _numbers(table, clock, headers[clock][1], QUANTITIES["time"])
    if len(times) < 2 or not (np.diff(times) > 0).all():
        row = int(np.argmax(np.diff(times) <= 0)) + 1 if len(times) > 1 else 0
        raise SimulationError(f"{path}: {table.place(row)}: time does not increase; sort the rows")
    inputs = Inputs(times=times - times[0])
    for index, (name, unit) in enumerate(headers):
        if index != clock:
            _connect(inputs, model, table, index, name, unit)
    if not inputs.driven:
        raise SimulationError(f"{path}: no column drives anything; {_choices(model)}")
    return inputs


def _connect(
    inputs: Inputs, model: mujoco.MjModel, table: RawTable, index: int, name: str, unit: str | None
) -> None:
    """Find what a column drives."""
    body, _, axis = name.rpartition(".")
    objects = mujoco.mjtObj
    actuator = mujoco.mj_name2id(model, objects.mjOBJ_ACTUATOR, name)
    joint = mujoco.mj_name2id(model, objects.mjOBJ_JOINT, name)
    mocap = mujoco.mj_name2id(model, objects.mjOBJ_BODY, body) if axis in _AXES else -1
    if name in inputs.driven:
        raise SimulationError(f"{table.path}: column {name!r} is there twice; remove one")
    if actuator >= 0 and model.actuator_ctrlnum[actuator] == 1:
        taken = f"the control of actuator {name!r}"
        if joint in scalar_joints(model):
            taken += f" (it comes before the joint {name!r}; rename one to move that)"
        values = _numbers(table, index, unit, quantity_of_control(model, actuator), taken)
        control = int(model.actuator_ctrladr[actuator])
        inputs.controls[control] = values
        lead = mujoco.mj_name2id(model, objects.mjOBJ_NUMERIC, LEAD + name)
        if lead >= 0:
            inputs.leads[control] = float(model.numeric_data[model.numeric_adr[lead]])
    elif joint in scalar_joints(model):
        from scipy.interpolate import CubicSpline

        quantity = quantity_of_joint(model, joint)
        values = _numbers(table, index, unit, quantity, f"the position of joint {name!r}")
        inputs.joints[joint] = CubicSpline(inputs.times, values)
    elif mocap >= 0 and model.body_mocapid[mocap] >= 0:
        place = int(model.body_mocapid[mocap]), _AXES.index(axis)
        taken = f"the position of mocap body {body!r}"
        inputs.mocap[place] = _numbers(table, index, unit, LENGTH, taken)
    elif name.casefold() in QUANTITIES:
        inputs.ignored.append(name)
        return
    else:
        raise SimulationError(
            f"{table.path}: column {name!r} drives nothing in the model; {_choices(model)}"
        )
    inputs.driven.append(name)


def _choices(model: mujoco.MjModel) -> str:
    """What a column can be named."""
    actuators = [model.actuator(i).name for i in range(model.nactuator)]
    joints = [model.joint(i).name for i in scalar_joints(model)]
    mocap = [
        f"{model.body(i).name}.x" for i in range(model.nbody) if model.body_mocapid[i] >= 0
    ]  # fmt: skip
    kinds = {"actuators": actuators, "joints": joints, "mocap bodies": mocap}
    listed = "; ".join(
        f"{kind}: {', '.join(filter(None, names))}" for kind, names in kinds.items() if any(names)
    )
    return f"it has {listed}" if listed else "the model has no actuators, joints or mocap bodies"


def _split(header: str) -> tuple[str, str | None]:
    """Name, as written, and unit of a header."""
    _, unit = split_header(header)
    text = header.strip().strip("\ufeff\"'").strip()
    return (re.sub(r"\s*[\[(][^\[(]*[\])]$", "", text) if unit else text), unit


def _numbers(
    table: RawTable, index: int, unit: str | None, quantity: Quantity | None, driven: str = "time"
) -> Array:
    """A column in SI units; every cell must be a number, and the unit one of the quantity."""
    values, _ = table.numbers(index)
    header = table.header[index].strip()
    missing = np.flatnonzero(~np.isfinite(values))
    if missing.size:
        place = table.place(int(missing[0]))
        raise SimulationError(f"{table.path}: {place}: column {header!r} has no number there")
    if unit is None:
        return values
    if quantity is None and unit in ACCELERATIONS:
        return values * ACCELERATIONS[unit]
    parsed = parse_unit(unit)
    if parsed is None:
        raise SimulationError(f"{table.path}: column {header!r}: unknown unit {unit!r}")
    if quantity and parsed.dimensionality != parse_unit(quantity.unit).dimensionality:
        raise SimulationError(
            f"{table.path}: column {header!r}: {driven} is {quantity.meaning}, and {unit!r} is no "
            f"unit of one; write for example one of: {quantity.allowed}, or leave it out for "
            f"{quantity.unit}"
        )
    if quantity is None and (what := no_control(parsed)):
        raise SimulationError(
            f"{table.path}: column {header!r}: {unit!r} is {what}, and {driven} is none; write for "
            "example one of: N, m, rad, m/s^2, g (standard gravity), Gal, or leave it out"
        )
    return unit_registry().Quantity(values, parsed).to_base_units().magnitude.astype(float)
