"""A device on a test rig in Exudyn, along a sampled motion."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from inerter.core import Device
from inerter.exudyn import device as law
from inerter.exudyn.create import CreateInerter
from inerter.exudyn.engine import exudyn, quiet
from inerter.exudyn.readings import FORCES
from inerter.motion_units import ROTATION, TRANSLATION, Kind

TABLE = 1e12
"""Mass of the rig's table [kg], beside which the device's force moves nothing."""
MOST_PIECES = 50
"""Steps per sample at most."""


def simulate_along(
    device: Device,
    h: float,
    x: ArrayLike,
    v: ArrayLike,
    a: ArrayLike,
    state: ArrayLike = 0.0,
    every: int = 1,
    motion: Kind = TRANSLATION,
) -> dict[str, NDArray[np.float64]]:
    """Run a device in Exudyn along a sampled motion.

    A table moves terminal 2 with the acceleration of the polynomials of fifth degree that meet x, v
    and a at both ends of each sample spacing; terminal 1 is the ground. RK44, with as many steps
    per sample as the device's fastest state asks for, at most `MOST_PIECES`.

    Parameters
    ----------
    device : Device
        The device.
    h : float
        Sample spacing [s].
    x, v, a : array_like (n,)
        Relative displacement [m], velocity, acceleration.
    state : float or sequence (nstate,)
        States at the first sample; one number is the first of them, the others are 0.
    every : int
        Forces and states are given at every so many samples, which divide n - 1; reading them costs
        more than a step.
    motion : str
        In rotation the table is a rotor: x is an angle [rad], forces are torques [N m].

    Returns
    -------
    dict of ndarray
        total [N], friction [N], shape (m,), m = 1 + (n - 1) / every; states (m, nstate).

    Raises
    ------
    ValueError
        h is not positive, x, v, a are not of one length, `every` does not divide n - 1, or the run
        diverged.
    ImportError
        Exudyn is not installed.
    """
    x, v, a = (np.asarray(channel, dtype=float) for channel in (x, v, a))
    if x.ndim != 1 or x.shape != v.shape or x.shape != a.shape or x.size < 2:
        shapes = f"{x.shape}, {v.shape}, {a.shape}"
        raise ValueError(f"x, v, a must be arrays of one length >= 2; their shapes are {shapes}")
    if not h > 0:
        raise ValueError(f"h is {h}: give a sample spacing > 0 s")
    if every < 1 or (x.size - 1) % every:
        raise ValueError(f"every is {every}: give a divisor of the {x.size - 1} sample spacings")
    states = np.zeros(device.nstate)
    states[: np.size(state)] = state

    engine, items = exudyn(), exudyn("itemInterface")
    mbs = engine.SystemContainer().AddSystem()
    table = mbs.AddNode(
        items.Node1D(
            referenceCoordinates=[0.0], initialCoordinates=[x[0]], initialVelocities=[v[0]]
        )
    )
    if motion == ROTATION:
        mbs.AddObject(items.Rotor1D(inertia=TABLE, nodeNumber=table))
    else:
        mbs.AddObject(items.Mass1D(mass=TABLE, nodeNumber=table))
    marker = mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=table, coordinate=0))
    mbs.AddLoad(
        items.LoadCoordinate(markerNumber=marker, load=1.0, loadUserFunction=_push(h, x, v, a))
    )
    given: dict[str, Any] = {"inertance": 0.0, **device.given}
    inerter = CreateInerter(
        mbs,
        "device",
        [None, table],
        initialStates=dict(zip(device.state_names, states.tolist(), strict=True)),
        **given,
    )
    forces = inerter.AddSensor("forces")
    own = inerter.AddSensor("states") if device.nstate else None
    mbs.Assemble()
    settings = engine.SimulationSettings()
    settings.timeIntegration.numberOfSteps = (x.size - 1) * pieces(device, h, v)
    settings.timeIntegration.endTime = (x.size - 1) * h
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = every * h
    with quiet():
        mbs.SolveDynamic(settings, solverType=engine.DynamicSolverType.RK44)
    found = mbs.GetSensorStoredData(forces)
    # at the start an explicit solver knows no acceleration
    stretch = float(x[0]) - device.rest_length
    first = law.forces(inerter.element.device, stretch, float(v[0]), float(a[0]), states.tolist())
    found[0, 1:] = [first[name] for name in FORCES]
    inner = np.zeros((len(found), 0)) if own is None else mbs.GetSensorStoredData(own)[:, 1:]
    return {"total": found[:, 1], "friction": found[:, 3], "states": inner}


def pieces(device: Device, h: float, v: NDArray[np.float64]) -> int:
    """Steps per sample that resolve the fastest state, within `MOST_PIECES`."""
    fastest = 0.0
    if device.friction in ("dahl", "lugre"):
        level = min(device.coulomb_force, device.static_force or np.inf)
        fastest = device.bristle_stiffness * float(np.abs(v).max()) / level
    if device.series_stiffness or device.series_damping:
        fastest = max(
            fastest,
            np.sqrt(device.series_stiffness / device.inertance),
            device.series_damping / device.inertance,
            device.series_stiffness / device.series_damping if device.backlash else 0.0,
        )
    if device.leak_damping or device.leak_quadratic_damping:
        # at the speed of the terminals, which a slip seldom exceeds
        slope = device.leak_damping + 2.0 * device.leak_quadratic_damping * float(np.abs(v).max())
        spring = device.series_stiffness
        relaxing = spring / (slope + device.series_damping)
        fastest = max(fastest, relaxing if spring else slope / device.inertance)
    elif device.clutch_force and device.series_damping:
        fastest = max(fastest, device.series_stiffness / device.series_damping)
    return int(np.clip(np.ceil(fastest * h / 0.2), 1, MOST_PIECES))


def _push(
    h: float, x: NDArray[np.float64], v: NDArray[np.float64], a: NDArray[np.float64]
) -> Callable[[Any, float, float], float]:
    """The table's force: its mass times the motion's acceleration."""
    # x = x0 + v0 u + a0 u^2 / 2 + c3 u^3 + c4 u^4 + c5 u^5 in a spacing
    rise = x[1:] - x[:-1] - v[:-1] * h - a[:-1] * h**2 / 2
    turn = (v[1:] - v[:-1] - a[:-1] * h) * h
    bend = (a[1:] - a[:-1]) * h**2
    c3 = (10 * rise - 4 * turn + bend / 2) / h**3
    c4 = (-15 * rise + 7 * turn - bend) / h**4
    c5 = (6 * rise - 3 * turn + bend / 2) / h**5
    rows = TABLE * np.column_stack([a[:-1], 6 * c3, 12 * c4, 20 * c5])
    table, last = rows.tolist(), len(rows) - 1

    def loadUserFunction(mbs: Any, t: float, load: float) -> float:  # noqa: N802 - Exudyn's name
        row = min(last, int(t / h + 1e-9))
        u = t - row * h
        c0, c1, c2, c3 = table[row]
        return c0 + u * (c1 + u * (c2 + u * c3))

    return loadUserFunction
