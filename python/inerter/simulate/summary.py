"""A run in figures: for a program, and for people in a terminal."""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np
from rich.console import Console
from rich.table import Table
from rich.text import Text

from inerter.models import title_of
from inerter.motion_units import Kind, unit
from inerter.printable import printable
from inerter.report import text
from inerter.simulate.record import device_names
from inerter.simulate.run import SimulatedRun
from inerter.simulate.sample import DeviceRun

SCHEMA = "inerter.simulation/1"
STILL = 1e-9  # m or rad: less is no motion


def summary(run: SimulatedRun) -> dict[str, Any]:
    """Figures of a run, ready for JSON; SI units."""
    spacing = run.every * float(run.model.opt.timestep)
    return {
        "schema": SCHEMA,
        "model": run.path.name,
        "integrator": run.integrator,
        "timestep": float(run.model.opt.timestep),
        "duration": float(run.time[-1] - run.time[0]),
        "samples": len(run.time),
        "sample_rate": 1 / spacing,
        "driven": list(run.inputs.driven) if run.inputs else [],
        "devices": [
            _device(name, device, run.model)
            for name, device in zip(device_names(run), run.devices, strict=True)
        ],
        "vehicle": {
            name: _spread(values) for name, values in run.vehicle.items() if name != "time"
        },
        "warnings": run.warnings,
    }


def in_units(run: SimulatedRun, translation: str) -> str:
    """A unit of the devices, of which that in translation is given; both where both are there."""
    motions: list[Kind] = [device.motion for device in run.devices]
    return " or ".join(text.unit(unit(motion, translation)) for motion in dict.fromkeys(motions))


def at_rest(run: SimulatedRun, keyframe: str | None) -> str | None:
    """Where no device moved: what would make them move; None where one did."""
    if any(np.ptp(device.columns["displacement"]) > STILL for device in run.devices):
        return None
    names = [run.model.key(i).name or str(i) for i in range(run.model.nkey)]
    names = [name for name in names if name != keyframe]
    ways = [f"start from a keyframe (--keyframe {' or '.join(names)})"] if names else []
    if run.inputs:
        ways.append(f"drive more than {', '.join(run.inputs.driven)}, or further (--control)")
    elif run.model.nu:
        ways.append("drive it (--control FILE)")
    return f"No device moved: {', or '.join(ways) or 'give the model something that moves it'}."


def _device(name: str, device: DeviceRun, model: mujoco.MjModel) -> dict[str, Any]:
    columns = device.columns
    heat = columns["dissipated_energy"]
    return {
        "name": device.place.name,
        "file": f"{name}.csv",
        "motion": device.motion,
        "parameters": device.place.stated(model),
        **{key: _spread(columns[key]) for key in ("displacement", "velocity", "force")},
        "stored_energy": float(columns["stored_energy"][-1]),
        "dissipated_energy": float(heat[-1] - heat[0]),
    }


def _spread(values: np.ndarray) -> dict[str, float]:
    return {
        "min": float(values.min()),
        "max": float(values.max()),
        "rms": float(np.sqrt(np.mean(values**2))),
    }


def print_run(run: SimulatedRun, console: Console) -> None:
    """Print the figures of a run."""
    found = summary(run)
    seconds = f"{found['duration']:.6g} s simulated in {run.wall:.2g} s"
    how = f"{run.integrator}, time step {found['timestep']:g} s, {found['samples']} samples"
    console.print(_plain(f"{title_of(run.path)}: {seconds} ({how})"))
    if found["devices"]:
        table = Table(box=None, padding=(0, 1), header_style="dim")
        table.add_column("device", no_wrap=True)
        for title, translation in (
            ("force rms", "N"), ("max", "N"), ("stroke", "m"), ("speed", "m/s"), ("heat", "J"),
        ):  # fmt: skip
            units = in_units(run, translation)
            table.add_column(Text(f"{title} [{units}]"), justify="right", no_wrap=True)
        for device in found["devices"]:
            stroke = device["displacement"]["max"] - device["displacement"]["min"]
            values = (
                device["force"]["rms"],
                _largest(device["force"]),
                stroke,
                _largest(device["velocity"]),
                device["dissipated_energy"],
            )
            table.add_row(_plain(device["name"]), *map(text.number, values))
        console.print(table)
    else:
        console.print("There is no inerter.device in the model: no device record.")
    for warning in found["warnings"]:
        console.print(_plain(f"warning: {warning}"), style="yellow")


def _largest(spread: dict[str, float]) -> float:
    return max(abs(spread["min"]), abs(spread["max"]))


def _plain(words: str) -> Text:
    # names come from files: no markup
    return Text(printable(words))
