"""Runs one of Exudyn's own examples with a device put into it, and prints what came of it as JSON.

    python exudyn_example.py SCRIPT

Between the ground and the first body that an inerter takes; the first dynamic solution is cut to
some hundred steps. Printed: `error`, the largest difference of b (v - v0) and the integral of the
force, relative to the force's largest impulse; or `none`, why there is nothing to tell.
"""

from __future__ import annotations

import json
import os
import runpy
import sys
from pathlib import Path
from typing import Any

import exudyn
import exudyn.solver
import numpy as np
from inerter.exudyn import CreateInerter
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


def put_device(mbs: Any) -> Any:
    """The device, or None where no body takes one."""
    for number in range(mbs.systemData.NumberOfObjects()):
        body = mbs.GetObject(number)
        kind = body["objectType"]
        if kind not in BODIES:
            continue
        mass = float(body.get("mass", body.get("physicsMass", 0.0)))
        if mass <= 0.0:
            continue
        node = exu.NodeIndex(int(body["nodeNumber"]))
        if mbs.GetNode(node)["nodeType"] == "PointGround":
            continue
        place = np.zeros(3)
        reference = mbs.GetNode(node)["referenceCoordinates"]
        moves = 2 if kind in FLAT else 3
        place[:moves] = reference[:moves]
        aside = ASIDE * [1, 1, 0] if kind in FLAT else ASIDE
        return CreateInerter(
            mbs, "example device", [None, exu.ObjectIndex(number)], show=False,
            localPosition0=place + aside, inertance=INERTANCE * mass,
        )  # fmt: skip
    return None


def main() -> None:
    install()
    devices: dict[int, Any] = {}
    assemble, solve = exu.MainSystem.Assemble, exu.MainSystem.SolveDynamic

    def Assemble(self: Any) -> Any:  # noqa: N802 - Exudyn's name
        if not devices:
            made = put_device(self)
            if made is None:
                tell(none="no body that takes a device")
                return None
            sensors = [made.AddSensor(name) for name in ("velocity", "inertance")]
            devices[0] = (self, made, sensors)
        return assemble(self)

    def SolveDynamic(mbs: Any, *args: Any, **kwargs: Any) -> Any:  # noqa: N802 - Exudyn's name
        settings: Any = kwargs.get("simulationSettings") or (args[0] if args else None)
        integration = settings.timeIntegration
        step = integration.endTime / integration.numberOfSteps
        integration.numberOfSteps = min(STEPS, integration.numberOfSteps)
        integration.endTime = step * integration.numberOfSteps
        integration.verboseMode = 0
        integration.simulateInRealtime = False
        settings.solution.sensors.writePeriod = 1e-12
        settings.solution.file.write = False
        solve(mbs, *args, **kwargs)
        _, made, sensors = devices[0]
        velocity, force = (mbs.GetSensorStoredData(sensor) for sensor in sensors)
        time, f = force[:, 0], force[:, 1]
        # the first force: explicit solvers know no acceleration there
        f[0] = f[1]
        impulse = np.concatenate([[0.0], np.cumsum(np.diff(time) * (f[1:] + f[:-1]) / 2.0)])
        momentum = made.device.inertance * (velocity[:, 1] - velocity[0, 1])
        size = np.sum(np.diff(time) * np.abs(f[1:] + f[:-1]) / 2.0)
        tell(error=float(np.abs(momentum - impulse).max() / max(size, 1e-12)), steps=len(time))

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
    sys.argv = sys.argv[1:]
    os.chdir(Path(sys.argv[0]).parent)
    sys.path.insert(0, str(Path(sys.argv[0]).parent))
    try:
        runpy.run_path(sys.argv[0], run_name="__main__")
    except (Exception, SystemExit) as error:
        tell(none=f"{type(error).__name__}: {error}"[:200])
    tell(none="no dynamic solution")


if __name__ == "__main__":
    main()
