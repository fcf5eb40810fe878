"""Implicit solvers: few Newton iterations for stiff devices, and a right Jacobian."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

pytest.importorskip("exudyn.itemInterface")

from element_systems import ELASTIC, LUGRE, Array, bodies, exu, line, settings, solve
from inerter.exudyn import CreateInerter

END = 0.4
BRISTLE = {**LUGRE, "bristle_stiffness": 1e7}
STIFF: dict[str, dict[str, Any]] = {
    "bristle": {**BRISTLE, "bristle_damping": 0.0},
    "damped bristle": {**BRISTLE, "bristle_damping": 3e3},
    "shaft": {"series_stiffness": 1e9, "series_damping": 1e3},
    "coulomb": {"friction": "coulomb", "coulomb_force": 10.0, "transition_velocity": 1e-4},
    "stribeck": {
        "friction": "stribeck", "coulomb_force": 10.0, "static_force": 15.0,
        "stribeck_velocity": 1e-3, "transition_velocity": 1e-4,
    },
    "brown_mcphee": {
        "friction": "brown_mcphee", "coulomb_force": 10.0, "static_force": 15.0,
        "stribeck_velocity": 1e-3,
    },
    "play without damper": {"series_stiffness": 1e6, "backlash": 5e-4},
    "stops": {"stop_stiffness": 1e7, "stop_damping": 1.0, "stop_upper": 5e-3, "stop_lower": -5e-3},
    "stops of rubber": {
        "stop_stiffness": 1e6, "stop_stiffness_cubic": 1e12, "stop_upper": 5e-3, "stop_lower": -5e-3
    },
    "gas": {"gas_pressure": 1e5, "gas_area": 1e-2, "gas_volume": 1e-4},
    "load friction": {"load_friction": 0.3, "transition_velocity": 1e-3},
    "varying": {"inertance_gradient": 20.0, "inertance_speed_gradient": 0.5},
}  # fmt: skip


def iterations(device: dict[str, Any], step: float, *, adaptive: bool, modified: bool) -> float:
    """Newton iterations per step, at Exudyn's own tolerances."""
    system = line([25.0, 180.0], [0.3, 0.0], 1e4)
    CreateInerter(system.mbs, "d", system.parts, inertance=100.0, **device)
    chosen = settings(END, step)
    chosen.timeIntegration.newton.relativeTolerance = 1e-8
    chosen.timeIntegration.newton.absoluteTolerance = 1e-10
    chosen.timeIntegration.adaptiveStep = adaptive
    chosen.timeIntegration.newton.useModifiedNewton = modified
    solve(system.mbs, chosen, "GeneralizedAlpha")
    return system.mbs.sys["dynamicSolver"].it.newtonStepsCount / round(END / step)


@pytest.mark.parametrize("name", STIFF)
def test_few_iterations_for_stiff_devices(name: str) -> None:
    """Without shortening a step: 1.0 to 2.8 by full Newton, up to 7.2 by the modified one."""
    assert iterations(STIFF[name], 1e-3, adaptive=False, modified=False) < 3.5
    assert iterations(STIFF[name], 1e-3, adaptive=False, modified=True) < 9.0


@pytest.mark.parametrize("modified", [False, True])
def test_play_with_a_damper_takes_shorter_steps(modified: bool) -> None:
    """Teeth that meet are a jump: Exudyn shortens that step, as it does by default."""
    play = {"series_stiffness": 1e6, "series_damping": 3200.0, "backlash": 5e-4}
    assert iterations(play, 1e-3, adaptive=True, modified=modified) < 9.0


# a stiff bristle behind its play, struck at 0.3 m/s
BEHIND_PLAY = {**BRISTLE, "bristle_damping": 3e3, "friction_backlash": 5e-4}


@pytest.mark.parametrize("modified", [False, True])
def test_a_bristle_behind_free_play_takes_shorter_steps(modified: bool) -> None:
    """Its damper sets in with a jump, as teeth do."""
    assert iterations(BEHIND_PLAY, 1e-3, adaptive=True, modified=modified) < 9.0


def test_a_bristle_behind_smooth_play_needs_no_shorter_steps() -> None:
    device = BEHIND_PLAY | {"smoothPlay": True}
    for step in (1e-3, 2e-4):
        assert iterations(device, step, adaptive=False, modified=False) < 4.0


# the Jacobian that Exudyn finds, against central differences of the forces

DEVICES: dict[str, dict[str, Any]] = {
    "lugre": LUGRE,
    "shaft": {**ELASTIC, **LUGRE},
    "springs": {"stiffness": 300.0, "stiffness_cubic": 1e4, "viscous": 5.0, "quadratic_damping": 3},
    "bouc_wen": {"friction": "bouc_wen", "bw_alpha": 1.0, "bw_beta": 30.0, "bw_gamma": 20.0,
                 "bw_stiffness": 100.0, "bw_ratio": 0.3},
    "gas": {"gas_pressure": 1e5, "gas_area": 1e-3, "gas_volume": 1e-4},
}  # fmt: skip


class Forces:
    """Forces of a system (n,) at displacements and velocities, and Exudyn's derivative of them."""

    def __init__(self, mbs: Any) -> None:
        mbs.Assemble()
        self.mbs, self.settings = mbs, settings(0.1, 0.1)
        self.solver = exu.MainSolverImplicitSecondOrder()
        assert self.solver.InitializeSolver(mbs, self.settings)

    def at(self, q: Array, q_t: Array) -> Array:
        self._set(q, q_t)
        self.solver.ComputeODE2RHS(self.mbs)
        return np.array(self.solver.GetSystemResidual())[: q.size]

    def jacobian(self, q: Array, q_t: Array, by_velocity: bool) -> Array:
        self._set(q, q_t)
        size = np.array(self.solver.GetSystemResidual()).size
        self.solver.SetSystemJacobian(np.zeros((size, size)))
        self.solver.ComputeJacobianODE2RHS(
            self.mbs,
            scalarFactor_ODE2=float(not by_velocity),
            scalarFactor_ODE2_t=float(by_velocity),
        )
        return np.array(self.solver.GetSystemJacobian())[: q.size, : q.size]

    def differences(self, q: Array, q_t: Array, by_velocity: bool) -> Array:
        columns = []
        for k in range(q.size):
            change = 1e-6 * np.eye(q.size)[k]
            if by_velocity:
                more, less = self.at(q, q_t + change), self.at(q, q_t - change)
            else:
                more, less = self.at(q + change, q_t), self.at(q - change, q_t)
            columns.append((more - less) / 2e-6)
        return np.column_stack(columns)

    def _set(self, q: Array, q_t: Array) -> None:
        self.mbs.systemData.SetODE2Coordinates(q)
        self.mbs.systemData.SetODE2Coordinates_t(q_t)


@pytest.mark.parametrize("by_velocity", [False, True])
@pytest.mark.parametrize("symbolic", [True, False])
@pytest.mark.parametrize("name", DEVICES)
def test_jacobian_on_a_line(name: str, symbolic: bool, by_velocity: bool) -> None:
    system = line([2.0, 3.0], [0.0, 0.0], 200.0)
    CreateInerter(system.mbs, "d", system.parts, inertance=4.0, symbolic=symbolic, **DEVICES[name])
    forces = Forces(system.mbs)
    rng = np.random.default_rng(3)
    size = len(system.mbs.systemData.GetODE2Coordinates())
    for _ in range(5):
        q, q_t = rng.normal(0.0, 0.02, size), rng.normal(0.0, 0.3, size)
        q_t[2:] *= 1e-2
        true = forces.differences(q, q_t, by_velocity)
        found = forces.jacobian(q, q_t, by_velocity)
        np.testing.assert_allclose(found, true, rtol=1e-4, atol=1e-5 * np.abs(true).max())


@pytest.mark.parametrize("by_velocity", [False, True])
@pytest.mark.parametrize("kind", ["Point", "RigidBody2D", "RigidBodyRxyz", "RigidBodyRotVecLG"])
def test_jacobian_in_space(kind: str, by_velocity: bool) -> None:
    system = bodies(kind)
    CreateInerter(
        system.mbs, "d", system.parts, inertance=4.0, stiffness=100.0, rest_length=0.4, **LUGRE
    )
    forces = Forces(system.mbs)
    size = len(system.mbs.systemData.GetODE2Coordinates())
    rng = np.random.default_rng(4)
    q, q_t = rng.normal(0.0, 0.02, size), rng.normal(0.0, 0.3, size)
    q_t[-1] *= 1e-2
    true = forces.differences(q, q_t, by_velocity)
    found = forces.jacobian(q, q_t, by_velocity)
    np.testing.assert_allclose(found, true, rtol=1e-3, atol=1e-4 * np.abs(true).max())


@pytest.mark.parametrize("play", [(1e6, 3200.0, 5e-4), (1e5, 300.0, 1e-3)])
def test_smooth_play_needs_no_shorter_steps(play: tuple[float, float, float]) -> None:
    """Without step control, where the jump of sharp teeth leaves steps without a solution."""
    names = ("series_stiffness", "series_damping", "backlash")
    device = dict(zip(names, play, strict=True)) | {"smoothPlay": True}
    for step in (1e-3, 2e-4):
        assert iterations(device, step, adaptive=False, modified=False) < 3.0
