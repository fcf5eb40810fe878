"""Every part of a device under every manner of the element: changed while it runs, linear, static.

One coordinate, or a point that moves along a line; a spring beside the device.
"""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
import pytest

pytest.importorskip("exudyn.itemInterface")

from element_systems import Array, coordinate, empty, exu, settings, solve
from exudyn import itemInterface
from inerter.exudyn import CreateInerter

MASS, SPRING, B, PULL = 2.0, 200.0, 3.0, 1.5
SHAFT = {"series_stiffness": 4e3, "series_damping": 20.0}
SLIP: dict[str, Any] = {
    "friction": "maxwell_slip", "slip_stiffness_1": 300.0, "slip_force_1": 0.4,
    "slip_stiffness_2": 200.0, "slip_force_2": 0.7,
}  # fmt: skip
DAHL: dict[str, Any] = {"friction": "dahl", "coulomb_force": 1.0, "bristle_stiffness": 500.0}
AGING: dict[str, Any] = {
    "friction": "rate_state", "coulomb_force": 1.0, "rate_effect": 0.03, "age_effect": 0.05,
    "rate_velocity": 0.05, "age_distance": 2e-2, "transition_velocity": 0.05,
}  # fmt: skip
COIL: dict[str, Any] = {
    "piston_area": 1.6e-3, "channel_area": 1e-4, "channel_length": 0.5, "fluid_density": 998.0,
    "fluid_viscosity": 1e-2, "coil_diameter": 0.2,
}  # fmt: skip

# a part, what is changed of it, stiffness [N/m] and inertance [kg] that a small motion feels at
# rest (complex eigenvalues), None where these say something else
PARTS: dict[str, tuple[dict[str, Any], dict[str, Any], tuple[float, float] | None]] = {
    "friction at the flywheel": (
        {**DAHL, **SHAFT, "friction_side": "flywheel"}, {"coulomb_force": 2.0}, None,
    ),
    "inertance, curve": (
        # the middle one of three values is that of x = 0
        {"inertance_curve": "0.2 0.5 -0.1", "curve_lower": -0.05, "curve_upper": 0.05},
        {"inertance": 5.0}, (0.0, 1.5 * B),
    ),
    "inertance, two flanks": (
        {"inertance_periods": "0.05 0.2 0", "inertance_back_periods": "0.04 0.1 0"},
        {"inertance_periods": "0.05 0.4 0"}, None,
    ),
    "friction level, periods": (
        {**SLIP, "friction_periods": "0.05 0.4 0"}, {"friction_periods": "0.03 0.4 1"},
        (500.0, B),
    ),
    "spring force, periods": (
        {"force_periods": "0.1 2.0 0"}, {"force_periods": "0.1 3.0 0"},
        (2.0 * 2.0 * np.pi / 0.1, B),
    ),
    "viscous damping, curve": (
        {"viscous": 5.0, "viscous_curve": "1 5 2", "curve_lower": -0.05, "curve_upper": 0.05},
        {"viscous": 9.0}, None,
    ),
    "load friction by direction": (
        {"mu_forward": 0.3, "mu_backward": 0.1, "transition_velocity": 0.05}, {"mu_forward": 0.6},
        (0.0, B),
    ),
    "load on Dahl": (
        {**DAHL, "mu_forward": 0.3, "mu_backward": 0.1}, {"mu_forward": 0.6}, (500.0, B),
    ),
    "maxwell_slip": (SLIP, {"slip_force_2": 1.4}, (500.0, B)),
    "load on maxwell_slip": ({**SLIP, "load_friction": 0.3}, {"load_friction": 0.6}, (500.0, B)),
    "rate_state": (AGING, {"coulomb_force": 2.0}, None),
    "branches": (
        {"branch_stiffness_1": 300.0, "branch_damping_1": 60.0}, {"branch_damping_1": 20.0}, None,
    ),
    "dampers behind a spring": (
        {"viscous": 20.0, "damping_knee": 0.1, "damping_beyond": 0.3, "quadratic_damping": 5.0,
         "damping_asymmetry": 0.3, "damper_stiffness": 400.0}, {"damper_stiffness": 900.0}, None,
    ),
    "leak": (
        {"leak_damping": 20.0, "leak_quadratic_damping": 30.0}, {"leak_damping": 40.0}, None,
    ),
    "clutch": (
        {**SHAFT, "clutch_force": 2.0, "clutch_asymmetry": 0.3}, {"clutch_force": 3.0}, None,
    ),
    "control of the damping": (
        {"viscous": 5.0, "control": "viscous", "control_lower": 1.0, "control_upper": 60.0,
         "control_lag": 0.05}, {"control_lag": 0.1}, None,
    ),
    "coiled channel": (COIL, {"fluid_viscosity": 3e-2}, None),
    "coiled channel behind a spring": ({**COIL, **SHAFT}, {"fluid_viscosity": 3e-2}, None),
}  # fmt: skip
KINDS = ("line", "points")
BOTH = [(name, kind) for name in PARTS for kind in KINDS]


def keys(name: str) -> dict[str, Any]:
    given = PARTS[name][0]
    return dict(given) if "channel_area" in given else {"inertance": B, **given}


def build(kind: str, device: dict[str, Any], speed: float = 0.0, load: float = 0.0) -> Any:
    """A mass on a spring, the device beside it: system and device."""
    made = empty()
    mbs = made.mbs
    if kind == "line":
        node = mbs.AddNode(
            itemInterface.Node1D(referenceCoordinates=[0.0], initialVelocities=[speed])
        )
        mbs.AddObject(itemInterface.Mass1D(mass=MASS, nodeNumber=node))
        ends, rest = [None, node], 0.0
    else:
        mass = mbs.CreateMassPoint(
            referencePosition=[1.0, 0.0, 0.0], initialVelocity=[speed, 0.0, 0.0], mass=MASS
        )
        node = mbs.GetObject(mass)["nodeNumber"]
        ends, rest = [mbs.CreateGround(), mass], 1.0
    ground = coordinate(mbs, mbs.AddNode(itemInterface.NodePointGround()))
    moving = coordinate(mbs, node)
    mbs.AddObject(
        itemInterface.CoordinateSpringDamper(markerNumbers=[ground, moving], stiffness=SPRING)
    )
    mbs.AddLoad(itemInterface.LoadCoordinate(markerNumber=moving, load=load))
    strut = CreateInerter(mbs, "d", ends, rest_length=rest, **device)
    mbs.variables["container"] = made.container  # which owns the system
    mbs.Assemble()
    return mbs, strut


def path(mbs: Any, strut: Any, end: float = 0.3) -> Array:
    """Displacement and total force at every step of a run, continued from where it is."""
    names = ("displacement", "total")
    sensors = [strut.AddSensor(name) for name in names]
    mbs.Assemble()
    if strut.device.control != "force":
        strut.SetControl(20.0)
    solve(mbs, settings(end, 1e-3), "GeneralizedAlpha")
    return np.stack([mbs.GetSensorStoredData(sensor)[:, 1] for sensor in sensors], axis=1)


@pytest.mark.parametrize(("name", "kind"), BOTH)
def test_a_changed_part_is_the_part_that_was_given(name: str, kind: str) -> None:
    changed = PARTS[name][1]
    _, first = build(kind, keys(name), speed=0.3)
    assert pickle.loads(pickle.dumps(first.device)).given == first.device.given

    mbs, strut = build(kind, keys(name), speed=0.3)
    before = path(mbs, strut)
    mbs, strut = build(kind, keys(name), speed=0.3)
    strut.set(**changed)
    found = path(mbs, strut)
    mbs, strut = build(kind, keys(name) | changed, speed=0.3)
    np.testing.assert_allclose(found, path(mbs, strut), rtol=1e-9, atol=1e-11)
    assert np.abs(found - before).max() > 1e-4 * np.abs(before).max(), "the change acts"


@pytest.mark.parametrize(("name", "kind"), BOTH)
def test_a_change_in_a_run(name: str, kind: str) -> None:
    """Until then the motion is that of before; parameters that it refuses leave the run alone."""
    mbs, strut = build(kind, keys(name), speed=0.3)
    before = path(mbs, strut)
    mbs, strut = build(kind, keys(name), speed=0.3)

    def pre_step(_: Any, t: float) -> bool:
        if 0.1 < t < 0.1015:
            strut.set(**PARTS[name][1])
        return True

    mbs.SetPreStepUserFunction(pre_step)
    found = path(mbs, strut)
    assert np.isfinite(found).all()
    np.testing.assert_allclose(found[:99], before[:99], rtol=1e-9, atol=1e-11)
    assert np.abs(found[110:] - before[110:]).max() > 1e-5 * np.abs(before).max()


def static(kind: str, device: dict[str, Any], load: float) -> dict[str, Any]:
    mbs, strut = build(kind, device, load=load)
    chosen = exu.SimulationSettings()
    chosen.solution.file.write = False
    chosen.staticSolver.verboseMode = 0
    if kind == "points":
        node = exu.NodeIndex(0)
        ground = coordinate(mbs, mbs.AddNode(itemInterface.NodePointGround()))
        for which in (1, 2):
            own = coordinate(mbs, node, which)
            mbs.AddObject(itemInterface.CoordinateConstraint(markerNumbers=[ground, own]))
        mbs.Assemble()
    if strut.device.control != "force":
        strut.SetControl(20.0)
    mbs.SolveStatic(chosen)
    return strut.Evaluate()


@pytest.mark.parametrize(("name", "kind"), BOTH)
def test_static_solution(name: str, kind: str) -> None:
    """The spring carries, and a force of the place; friction and branches stay as they are."""
    found = static(kind, keys(name), PULL)
    rest = PARTS[name][0].get("force_periods")
    carried = SPRING * found["displacement"]
    if rest:
        length, amplitude, _ = map(float, rest.split())
        carried += amplitude * np.sin(2.0 * np.pi * found["displacement"] / length)
    assert carried == pytest.approx(PULL, rel=1e-7)
    assert found["velocity"] == 0.0


def complex_eigenvalues(mbs: Any) -> Array:
    return mbs.ComputeODE2Eigenvalues(
        computeComplexEigenvalues=True, ignoreAlgebraicEquations=False
    )[0]


@pytest.mark.parametrize(
    ("name", "kind"), [(name, kind) for name, kind in BOTH if PARTS[name][2] is not None]
)
def test_small_motions_from_rest(name: str, kind: str) -> None:
    stiffness, inertance = PARTS[name][2] or (0.0, 0.0)
    mbs, _ = build(kind, keys(name))
    found = np.max(np.abs(complex_eigenvalues(mbs)))
    assert found == pytest.approx(np.sqrt((SPRING + stiffness) / (MASS + inertance)), rel=1e-3)


@pytest.mark.parametrize("kind", KINDS)
def test_a_branch_in_the_eigenvalues(kind: str) -> None:
    """(m + b) s^2 + k + K s / (s + K / C) = 0, times its denominator."""
    mbs, _ = build(kind, keys("branches"))
    stiff, damp = 300.0, 60.0
    true = np.roots([MASS + B, (MASS + B) * stiff / damp, SPRING + stiff, SPRING * stiff / damp])
    # Exudyn tells their sizes
    found = np.abs(complex_eigenvalues(mbs))
    for root in np.abs(true):
        assert np.abs(found - root).min() < 1e-3 * root, root


@pytest.mark.parametrize("kind", KINDS)
def test_default_eigenvalues_behind_a_spring(kind: str) -> None:
    """Coil, flywheel and shaft as two masses and two springs."""
    mbs, strut = build(kind, keys("coiled channel behind a spring"))
    inertance, shaft = strut.device.inertance, SHAFT["series_stiffness"]
    stiffness = np.array([[SPRING + shaft, -shaft], [-shaft, shaft]])
    true = np.sqrt(np.linalg.eigvals(np.linalg.solve(np.diag([MASS, inertance]), stiffness)))
    found = np.sqrt(np.abs(mbs.ComputeODE2Eigenvalues(ignoreAlgebraicEquations=False)[0]))
    np.testing.assert_allclose(np.sort(found[found > 1e-3]), np.sort(true), rtol=1e-4)
