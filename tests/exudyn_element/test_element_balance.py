"""What a device must not change: momentum, angular momentum, the sum of all energies and heat."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

pytest.importorskip("exudyn.itemInterface")

from element_systems import (
    BLOCK,
    LUGRE,
    ROTATIONS,
    Array,
    System,
    bodies,
    line,
    point,
    settings,
    solve,
)
from inerter.exudyn import CreateInerter

VARYING = {"inertance_gradient": 2.0, "inertance_curvature": 5.0, "inertance_speed_gradient": 0.4}
SOFT = {"series_stiffness": 500.0, "series_damping": 5.0}
LOOSE = {"series_stiffness": 500.0, "series_damping": 20.0, "backlash": 5e-3}
SMOOTH = {"transition_velocity": 0.05}
# what each device is, and the relative energy error that its corners cost RK44
DEVICES: dict[str, tuple[dict[str, Any], float]] = {
    "ideal": ({}, 1e-9),
    "varying": (VARYING, 1e-9),
    "damped": ({"viscous": 3.0, "quadratic_damping": 2.0, "flywheel_viscous": 1.0}, 1e-9),
    "springs": ({"stiffness": 60.0, "stiffness_cubic": 500.0, "rest_length": 0.5}, 1e-9),
    "coulomb": ({"friction": "coulomb", "coulomb_force": 2.0, **SMOOTH}, 1e-7),
    "stribeck": (
        {"friction": "stribeck", "coulomb_force": 2.0, "static_force": 3.0,
         "stribeck_velocity": 0.1, **SMOOTH},
        1e-7,
    ),
    "brown_mcphee": (
        {"friction": "brown_mcphee", "coulomb_force": 2.0, "static_force": 3.0,
         "stribeck_velocity": 0.1},
        1e-7,
    ),
    "dahl": ({"friction": "dahl", "coulomb_force": 2.0, "bristle_stiffness": 500.0}, 2e-6),
    "lugre": ({**LUGRE, "coulomb_force": 2.0, "static_force": 3.0, "bristle_stiffness": 500.0,
               "bristle_damping": 5.0}, 2e-6),
    "bouc_wen": ({"friction": "bouc_wen", "bw_alpha": 1.0, "bw_beta": 30.0, "bw_gamma": 20.0,
                  "bw_stiffness": 100.0, "bw_ratio": 0.3, "rest_length": 0.6}, 2e-6),
    "uneven friction": (
        {"friction": "coulomb", "coulomb_force": 2.0, "friction_asymmetry": 0.3,
         "friction_gradient": 0.5, **SMOOTH},
        1e-7,
    ),
    "damper that bends in each direction by itself": (
        {"viscous": 5.0, "damping_asymmetry": 0.3, "damping_knee": 0.1, "damping_beyond": 0.3,
         "damping_knee_back": 0.03, "damping_beyond_back": 2.0, "damping_sharpness": 5.0},
        1e-7,
    ),
    "series": ({**SOFT, "series_hardening": 3.0}, 1e-6),
    "dashpot": ({"series_damping": 3.0}, 1e-8),
    "series, load friction": ({**SOFT, "load_friction": 0.2, **SMOOTH}, 1e-6),
    "play": (LOOSE, 5e-3),
    "smooth play": ({**LOOSE, "smoothPlay": True}, 1e-4),
    "play, no damper": ({**LOOSE, "series_damping": 0.0}, 1e-4),
    "free play, dahl": (
        {"friction": "dahl", "coulomb_force": 2.0, "bristle_stiffness": 500.0,
         "friction_backlash": 5e-3},
        5e-5,
    ),
    "free play, lugre": (
        {**LUGRE, "coulomb_force": 2.0, "static_force": 3.0, "bristle_stiffness": 500.0,
         "bristle_damping": 5.0, "friction_backlash": 5e-3},
        2e-3,
    ),
    "free play, bouc_wen": (
        {"friction": "bouc_wen", "bw_alpha": 0.8, "bw_beta": 30.0, "bw_gamma": 20.0,
         "bw_stiffness": 100.0, "bw_ratio": 0.3, "rest_length": 0.6, "friction_backlash": 5e-3},
        1e-5,
    ),
    "stops": ({"stop_stiffness": 2e3, "stop_damping": 0.5, "stop_upper": 0.62,
               "stop_lower": 0.58, "rest_length": 0.0}, 1e-4),
    "stops of rubber": (
        {"stop_stiffness": 1e3, "stop_stiffness_cubic": 3e5, "stop_damping": 0.5,
         "stop_upper": 0.62, "stop_lower": 0.58, "rest_length": 0.0}, 1e-4,
    ),
    "gas": ({"gas_pressure": 1e5, "gas_area": 2e-4, "gas_volume": 2e-4, "rest_length": 0.6}, 1e-8),
    "pipe": (
        {"piston_area": 1.6e-3, "channel_area": 3e-5, "channel_length": 0.02,
         "fluid_density": 1000.0, "fluid_viscosity": 1e-3},
        1e-6,
    ),
}  # fmt: skip


def with_inertance(device: dict[str, Any]) -> dict[str, Any]:
    return device if "channel_area" in device else {"inertance": 2.0, **device}


def mechanics(system: System) -> tuple[Array, Array, float]:
    """Momentum, angular momentum about the origin, kinetic energy of the tumbling bodies."""
    momentum, turning, energy = np.zeros(3), np.zeros(3), 0.0
    for part in system.parts:
        x, v, spin = (
            point(system.mbs, part, w) for w in ("Position", "Velocity", "AngularVelocity")
        )
        turned = point(system.mbs, part, "RotationMatrix").reshape(3, 3)
        own = turned @ BLOCK.InertiaCOM() @ turned.T @ spin
        momentum += BLOCK.mass * v
        turning += np.cross(x, BLOCK.mass * v) + own
        energy += 0.5 * BLOCK.mass * v @ v + 0.5 * spin @ own
    return momentum, turning, energy


def tumble(kind: str, device: dict[str, Any], solver: str, step: float) -> dict[str, float]:
    """Largest changes over half a second, relative to what there was."""
    system = bodies(kind)
    made = CreateInerter(
        system.mbs, "d", system.parts, localPosition0=[0.05, 0.02, -0.03],
        localPosition1=[-0.04, 0.1, 0.02], dissipatedEnergy=True, **with_inertance(device),
    )  # fmt: skip
    system.mbs.Assemble()
    momentum, turning, energy = mechanics(system)
    stored = made.Evaluate()["stored_energy"]
    solve(system.mbs, settings(0.4, step), solver)
    now = mechanics(system)
    heat = made.GetStates()[made.stateNames.index("dissipated_energy")]
    all_energy = now[2] + made.Evaluate()["stored_energy"] + heat
    return {
        "momentum": float(np.abs(now[0] - momentum).max()),
        "turning": float(np.abs(now[1] - turning).max()),
        "energy": abs(all_energy - energy - stored) / (energy + stored),
        "heat": float(heat) / (energy + stored),
    }


@pytest.mark.parametrize("name", DEVICES)
def test_tumbling_bodies(name: str) -> None:
    device, allowed = DEVICES[name]
    found = tumble("RigidBodyRxyz", device, "RK44", 2e-3)
    assert found["momentum"] < 1e-12
    assert found["turning"] < 1e-6
    assert found["energy"] < allowed
    lossless = name in ("ideal", "varying", "springs", "gas", "play, no damper")
    assert found["heat"] == 0.0 if lossless else found["heat"] > 1e-5


@pytest.mark.parametrize("kind", ROTATIONS)
def test_every_rotation(kind: str) -> None:
    """Generalized-alpha is of second order: a quarter with half the step."""
    device = {**VARYING, "stiffness": 60.0, "viscous": 1.0}
    coarse, fine = (tumble(kind, device, "GeneralizedAlpha", step) for step in (2e-3, 1e-3))
    assert fine["momentum"] < 1e-12
    for what in ("turning", "energy"):
        assert fine[what] < 1e-5
        assert fine[what] == pytest.approx(coarse[what] / 4.0, rel=0.1, abs=1e-12)


@pytest.mark.parametrize("name", DEVICES)
def test_on_a_line(name: str) -> None:
    """The same, mostly in C++ and so with finer steps."""
    device, allowed = DEVICES[name]
    device = {key: value for key, value in device.items() if key != "rest_length"}
    if "stop_stiffness" in device:
        device |= {"stop_upper": 0.02, "stop_lower": -0.02}
    system = line([2.0, 3.0], [0.5, -0.4])
    made = CreateInerter(
        system.mbs, "d", system.parts, dissipatedEnergy=True, **with_inertance(device)
    )
    system.mbs.Assemble()

    def total() -> float:
        kinetic = 0.5 * np.array(system.masses) @ system.velocities**2
        return float(kinetic + made.Evaluate()["stored_energy"] + made.GetStates()[-1])

    before, momentum = total(), np.array(system.masses) @ system.velocities
    solve(system.mbs, settings(0.5, 1e-4))
    assert total() == pytest.approx(before, rel=max(1e-11, allowed / 10.0))
    assert np.array(system.masses) @ system.velocities == pytest.approx(momentum, rel=1e-11)
