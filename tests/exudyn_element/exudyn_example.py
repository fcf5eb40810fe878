"""Runs one of Exudyn's own examples with a device put into it, and prints what came of it as JSON.

    python exudyn_example.py SCRIPT [FINER]

FINER: by how much the steps are finer than the script's own.
Between the ground and three of the bodies that an inerter takes, cables and beams where there are
no others; the first dynamic solution is cut to some hundred steps. The velocity v is worked out
from Exudyn's own sensors of the body. Printed, the worst of the devices whose bodies move:

- `velocity`: largest difference of the device's velocity and v, relative to the largest v;
- `momentum`: of b (v - v0) and the integral of F, relative to the force's largest impulse;
- `energy`: of b (v^2 - v0^2) / 2 and the integral of F v, relative to that of its amount;
- `momentum_known`, `energy_known`: how well the steps tell the integrals, which is the difference
  of the trapezoidal sums over every step and over every second one, relative to the same;
- `moves`: whether a body moves at all; `devices`: how many do; `carried`: whether by a massless
  point, whose joint the solver keeps to its tolerance;

or `none`, why there is nothing to tell.
"""

from __future__ import annotations

import builtins
import importlib
import json
import os
import runpy
import sys
from pathlib import Path
from typing import Any

import exudyn
import exudyn.solver
import numpy as np
from exudyn.itemInterface import MarkerBodyPosition, SensorMarker
from inerter.exudyn import CreateInerter
from inerter.exudyn.carriers import CARRIED_BODIES
from inerter.exudyn.watch import install

# what it says of its own types lacks much
exu: Any = exudyn
STEPS = 400
INERTANCE = 0.2
ASIDE = np.array([0.37, -0.41, 0.53])
FLAT = ("MassPoint2D", "RigidBody2D")
BODIES = ("MassPoint", "RigidBody", *FLAT)


def tell(**found: Any) -> None:
    """Print what was found and end, whatever the script would still do."""
    sys.stdout.flush()
    print("\n" + json.dumps(found), flush=True)
    os._exit(0)


LENT = (
    "math", "numpy", "exudyn.basicUtilities", "exudyn.advancedUtilities", "exudyn.beams",
    "exudyn.graphicsDataUtilities", "exudyn.rigidBodyUtilities", "exudyn.utilities",
)  # fmt: skip


def lend_names() -> None:
    """What scripts of older versions had from `from exudyn.utilities import *`."""
    given: dict[str, Any] = {"exudyn": exudyn, "exu": exudyn, "np": np}
    for name in LENT:
        module = importlib.import_module(name)
        found = {key: value for key, value in vars(module).items() if key[0] != "_"}
        given = {**found, **given} if name == "numpy" else {**given, **found}
    given["graphics"] = importlib.import_module("exudyn.graphics")
    for key, value in given.items():
        if not hasattr(builtins, key):
            setattr(builtins, key, value)


def takers(mbs: Any) -> tuple[list[int], list[int]]:
    """Bodies that take a device as they are, and those that take one by a massless point."""
    plain, carried = [], []
    for number in range(mbs.systemData.NumberOfObjects()):
        body = mbs.GetObject(number)
        # the marker of an axially moving cable tells no velocity of a place
        if body["objectType"] in CARRIED_BODIES and not body["objectType"].startswith("ALE"):
            carried.append(number)
        if body["objectType"] not in BODIES:
            continue
        mass = float(body.get("mass", body.get("physicsMass", 0.0)))
        node = exu.NodeIndex(int(body["nodeNumber"]))
        if mass > 0.0 and mbs.GetNode(node)["nodeType"] != "PointGround":
            plain.append(number)
    return plain, carried


def put_devices(mbs: Any) -> list[Any]:
    """Of each device itself, its point of the ground, a marker on its body."""
    plain, carried = takers(mbs)
    chosen, found = plain or carried, []
    for number in sorted({chosen[0], chosen[len(chosen) // 2], chosen[-1]} if chosen else ()):
        body = mbs.GetObject(number)
        flat = body["objectType"] in FLAT or body["objectType"].endswith("2D")
        local = [0.0, 0.0, 0.0]
        if not plain:
            local[0] = 0.5 * float(body.get("length", body.get("physicsLength", 0.0)))
        marker = mbs.AddMarker(MarkerBodyPosition(bodyNumber=number, localPosition=local))
        place = np.zeros(3)
        if plain:
            reference = mbs.GetNode(exu.NodeIndex(int(body["nodeNumber"])))["referenceCoordinates"]
            moves = 2 if flat else 3
            place[:moves] = reference[:moves]
        else:
            where = exu.OutputVariableType.Position, exu.ConfigurationType.Reference
            place = np.array(mbs.GetMarkerOutput(marker, *where))
        ground = place + (ASIDE * [1, 1, 0] if flat else ASIDE)
        mass = float(body.get("mass", body.get("physicsMass", 0.01)))
        made = CreateInerter(
            mbs, f"example device {number}", [None, exu.ObjectIndex(number) if plain else marker],
            show=False, localPosition0=ground, inertance=INERTANCE * mass,
        )  # fmt: skip
        found.append((made, ground, marker))
    return found


def sums(time: Any, rate: Any) -> tuple[Any, Any]:
    """The trapezoidal sums over every step, and how far those over every second one are off."""

    def summed(t: Any, r: Any) -> Any:
        return np.concatenate([[0.0], np.cumsum(np.diff(t) * (r[1:] + r[:-1]) / 2.0)])

    every = summed(time, rate)
    return every, np.abs(summed(time[::2], rate[::2]) - every[::2]).max()


def compare(name: str, grown: Any, time: Any, rate: Any) -> dict[str, float]:
    """What has grown beside the integral of its rate, relative to that of the rate's amount."""
    integral, off = sums(time, rate)
    size = max(sums(time, np.abs(rate))[0][-1], 1e-12)
    error = float(np.abs(grown - integral).max() / size)
    return {name: error, f"{name}_known": float(off / size)}


def measured(mbs: Any, made: Any, ground: Any, sensors: list[Any]) -> dict[str, Any]:
    """What is told of one device after the solution."""
    told, force, place, speed = (mbs.GetSensorStoredData(sensor) for sensor in sensors)
    time, f = force[:, 0], force[:, 1]
    # the first force: explicit solvers know no acceleration there
    f[0] = f[1]
    line = place[:, 1:] - ground
    v = np.sum(line * speed[:, 1:], axis=1) / np.linalg.norm(line, axis=1)
    b = made.device.inertance
    return {
        "velocity": float(np.abs(told[:, 1] - v).max() / max(np.abs(v).max(), 1e-12)),
        **compare("momentum", b * (v - v[0]), time, f),
        **compare("energy", 0.5 * b * (v**2 - v[0] ** 2), time, f * v),
        "moves": bool(np.abs(v).max() > 1e-9),
    }


def main() -> None:
    install()
    lend_names()
    finer = int(sys.argv[2]) if len(sys.argv) > 2 else 1
    devices: dict[int, Any] = {}
    assemble, solve = exu.MainSystem.Assemble, exu.MainSystem.SolveDynamic

    def Assemble(self: Any) -> Any:  # noqa: N802 - Exudyn's name
        if not devices:
            found = put_devices(self)
            if not found:
                tell(none="no body that takes a device")
                return None
            kinds = exu.OutputVariableType
            for number, (made, ground, marker) in enumerate(found):
                sensors = [made.AddSensor("velocity"), made.AddSensor("inertance")]
                for kind in (kinds.Position, kinds.Velocity):
                    own = SensorMarker(
                        markerNumber=marker,
                        outputVariableType=kind,
                        writeToFile=False,
                        storeInternal=True,
                    )
                    sensors.append(self.AddSensor(own))
                devices[number] = (made, ground, sensors)
        return assemble(self)

    def SolveDynamic(mbs: Any, *args: Any, **kwargs: Any) -> Any:  # noqa: N802 - Exudyn's name
        settings: Any = kwargs.get("simulationSettings") or (args[0] if args else None)
        integration = settings.timeIntegration
        step = integration.endTime / integration.numberOfSteps
        integration.numberOfSteps = min(STEPS, integration.numberOfSteps)
        integration.endTime = step * integration.numberOfSteps
        integration.numberOfSteps *= finer
        integration.verboseMode = 0
        integration.simulateInRealtime = False
        settings.solution.sensors.writePeriod = 1e-12
        settings.solution.file.write = False
        solve(mbs, *args, **kwargs)
        told = [measured(mbs, *device) for device in devices.values()]
        moving = [one for one in told if one["moves"]] or told[:1]
        worst = {key: max(one[key] for one in moving) for key in moving[0]}
        tell(**worst, devices=len(moving), carried=not takers(mbs)[0])

    exu.MainSystem.Assemble = Assemble
    places: tuple[Any, ...] = (exu.MainSystem, exu, exudyn.solver)
    for where in places:
        where.SolveDynamic = SolveDynamic
    # no window, no pictures
    exu.StartRenderer = exu.StopRenderer = lambda *args, **kwargs: False
    container = exu.SystemContainer()
    for name in ("Start", "Stop", "DoIdleTasks", "IsActive"):
        if hasattr(container, "renderer") and hasattr(type(container.renderer), name):
            setattr(type(container.renderer), name, lambda *args, **kwargs: False)
    os.environ["MPLBACKEND"] = "Agg"
    sys.argv = [str(Path(sys.argv[1]).resolve())]
    os.chdir(Path(sys.argv[0]).parent)
    sys.path.insert(0, str(Path(sys.argv[0]).parent))
    try:
        runpy.run_path(sys.argv[0], run_name="__main__")
    except (Exception, SystemExit) as error:
        tell(none=f"{type(error).__name__}: {error}"[:200])
    tell(none="no dynamic solution")


if __name__ == "__main__":
    main()
