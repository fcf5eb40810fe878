"""The pictures of a run: per device forces, loops and energies; the vehicle; the joints."""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np
import plotly.graph_objects as go

from inerter.core import parameters
from inerter.motion_units import force_word, parameter_unit, unit
from inerter.pictures import thinning
from inerter.pictures.plotting import figure, line, two_over_time
from inerter.report.text import unit as shown
from inerter.simulate.load import scalar_joints
from inerter.simulate.run import SimulatedRun
from inerter.simulate.sample import DeviceRun
from inerter.simulate.vehicle import column_unit

TIME_SAMPLES = 3000
LOOP_SAMPLES = 4000
MOST_JOINTS = 6

# line colours of the report that differ in lightness too
TOTAL, INERTANCE, FRICTION = "after", "measured", "before"
_COLORS = ("after", "before", "measured", "warn", "shade", "text")
STATE_UNITS = {
    "friction_state": "m",
    **{f"friction_state_{i}": "m" for i in range(1, 9)},
    **{f"branch_deflection_{i}": "m" for i in range(1, 4)},
    "damper_velocity": "m/s",
    "control_change": "unit of what it sets",
    "series_deflection": "m",
    "flywheel_velocity": "m/s",
    "gap_position": "m",
    "slip_position": "m",
}


def device_plots(run: SimulatedRun, device: DeviceRun) -> dict[str, go.Figure]:
    """Every plot of a device, by the name of its place in the page."""
    plots = {
        "time": _forces_and_motion(run, device),
        "loop-displacement": _loop(device, "displacement", "m"),
        "loop-velocity": _loop(device, "velocity", "m/s"),
        "energy": _energy(run, device),
    }
    for name in device.place.act:
        # an age, as its logarithm
        aging = name == "friction_state" and device.place.device.friction == "rate_state"
        plot = figure("time [s]", _title(device, name, "1" if aging else STATE_UNITS[name]))
        _over_time(plot, run.time, device.columns[name], "after", name)
        plots[f"state-{name}"] = plot
    return plots


def model_plots(run: SimulatedRun) -> dict[str, go.Figure]:
    """Plots of what is not a device: the vehicle's columns and the joints."""
    plots = {}
    for name in run.vehicle:
        if name != "time":
            plot = figure("time [s]", f"{name.replace('_', ' ')} [{shown(column_unit(name))}]")
            _over_time(plot, run.time, run.vehicle[name], "after", name)
            plots[f"vehicle-{name}"] = plot
    if run.joints:
        plot = figure("time [s]", _positions(run), showlegend=len(run.joints) > 1)
        plot.update_layout(legend={"orientation": "h", "y": 1.02, "yanchor": "bottom"})
        moving = sorted(run.joints, key=lambda name: -float(np.ptp(run.joints[name])))
        for color, name in zip(_COLORS, moving[:MOST_JOINTS], strict=False):
            _over_time(plot, run.time, run.joints[name], color, name)
        plots["joints"] = plot
    return plots


def _forces_and_motion(run: SimulatedRun, device: DeviceRun) -> go.Figure:
    """Forces above, displacement below, one time axis."""
    plot = two_over_time(_force(device), _title(device, "displacement", "m"))
    columns = device.columns
    _over_time(plot, run.time, columns["inertance_force"], INERTANCE, "inertance", width=3.0)
    if has_friction(device):
        _over_time(plot, run.time, columns["friction_force"], FRICTION, "friction")
    _over_time(plot, run.time, columns["force"], TOTAL, "total")
    _over_time(plot, run.time, columns["displacement"], TOTAL, "displacement", yaxis="y2")
    return plot


def has_friction(device: DeviceRun) -> bool:
    """Whether friction acted in a device."""
    return bool(np.any(device.columns["friction_force"]))


def _title(device: DeviceRun, name: str, translation: str) -> str:
    """A column with its unit, of which that in translation is given."""
    return f"{name.replace('_', ' ')} [{shown(unit(device.motion, translation))}]"


def _force(device: DeviceRun) -> str:
    return _title(device, force_word(device.motion), "N")


def _positions(run: SimulatedRun) -> str:
    """The joints' positions with their unit or units."""
    hinge = [run.model.jnt_type[i] == mujoco.mjtJoint.mjJNT_HINGE for i in scalar_joints(run.model)]
    units = "rad" if all(hinge) else "m or rad" if any(hinge) else "m"
    return f"position [{units}]"


def _loop(device: DeviceRun, name: str, translation: str) -> go.Figure:
    """Force against a column: the whole, and what of it is not the inertance's."""
    plot = figure(_title(device, name, translation), _force(device))
    columns = device.columns
    keep = thinning.evenly(len(columns[name]), LOOP_SAMPLES)
    x, total = columns[name][keep], columns["force"][keep]
    rest = total - columns["inertance_force"][keep]
    line(plot, x, total, TOTAL, "total", 1.2)
    if np.any(rest):
        line(plot, x, rest, FRICTION, "without inertance", 1.2)
    return plot


def _energy(run: SimulatedRun, device: DeviceRun) -> go.Figure:
    plot = figure("time [s]", "energy [J]")
    for name, color in (("stored_energy", INERTANCE), ("dissipated_energy", FRICTION)):
        _over_time(plot, run.time, device.columns[name], color, name.split("_")[0])
    return plot


def _over_time(
    plot: go.Figure,
    time: np.ndarray,
    values: np.ndarray,
    color: str,
    name: str,
    width: float = 1.4,
    **options: Any,
) -> None:
    keep = thinning.extremes(values, TIME_SAMPLES)
    line(plot, time[keep], values[keep], color, name, width, **options)


def parameter_rows(run: SimulatedRun, device: DeviceRun) -> list[tuple[str, str, str]]:
    """Name, value and meaning of what a device was given."""
    rows = []
    for name, value in device.place.stated(run.model).items():
        if isinstance(value, str):
            rows.append((name, value, ""))
        else:
            known = parameters()[name]
            its = shown(parameter_unit(device.motion, name, known.unit))
            rows.append((name, f"{value:.6g} {its}".rstrip(), known.meaning))
    return rows
