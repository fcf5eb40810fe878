"""A run goes on from where another ended, starts again, and starts from given states."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("exudyn.itemInterface")

from element_systems import ELASTIC, LUGRE, PLAY, Array, System, bodies, exu, line, settings, solve
from inerter.exudyn import CreateInerter

BOUC_WEN = {"friction": "bouc_wen", "bw_alpha": 1.0, "bw_beta": 30.0, "bw_gamma": 20.0,
            "bw_stiffness": 100.0, "bw_ratio": 0.3}  # fmt: skip
DEVICES: dict[str, dict[str, Any]] = {
    "no state": {"viscous": 3.0},
    "bristle": LUGRE,
    "bouc_wen": BOUC_WEN,
    "shaft": ELASTIC,
    "play": PLAY,
    "play without damper": {**PLAY, "series_damping": 0.0},
    "all": {**LUGRE, **PLAY, "dissipatedEnergy": True},
}
SYMBOLIC = pytest.mark.parametrize("symbolic", [True, False])


def on_a_line(name: str, symbolic: bool, speed: float = 0.5) -> tuple[System, Any]:
    system = line([2.0, 3.0], [speed, -0.4], 300.0)
    device: dict[str, Any] = {"inertance": 4.0, **DEVICES[name]}
    return system, CreateInerter(system.mbs, "d", system.parts, symbolic=symbolic, **device)


def state(system: System, inerter: Any) -> Array:
    data = system.mbs.systemData
    q, q_t = np.array(data.GetODE2Coordinates()), np.array(data.GetODE2Coordinates_t())
    # positions of the state node integrate states and mean nothing
    extra = len(inerter.stateNames)
    return np.concatenate([q[: q.size - extra], q_t])


def hand_over(system: System) -> None:
    """What Exudyn users do: the current state becomes the initial one."""
    data = system.mbs.systemData
    now = data.GetSystemState(configuration=exu.ConfigurationType.Current)
    data.SetSystemState(now, configuration=exu.ConfigurationType.Initial)


@SYMBOLIC
@pytest.mark.parametrize("name", DEVICES)
def test_two_halves_are_the_whole(name: str, symbolic: bool) -> None:
    whole, inerter = on_a_line(name, symbolic)
    solve(whole.mbs, settings(0.4, 1e-3))
    expected, states = state(whole, inerter), inerter.GetStates()

    halves, inerter = on_a_line(name, symbolic)
    solve(halves.mbs, settings(0.2, 1e-3))
    hand_over(halves)
    solve(halves.mbs, settings(0.2, 1e-3))
    np.testing.assert_allclose(state(halves, inerter), expected, rtol=1e-11, atol=1e-14)
    np.testing.assert_allclose(inerter.GetStates(), states, rtol=1e-11, atol=1e-14)


@pytest.mark.parametrize("name", ["bristle", "play without damper"])
def test_in_space(name: str) -> None:
    ends = []
    for pieces in ([0.1], [0.05, 0.05]):
        system = bodies("RigidBodyRxyz")
        inerter = CreateInerter(system.mbs, "d", system.parts, inertance=4.0, **DEVICES[name])
        for piece in pieces:
            solve(system.mbs, settings(piece, 1e-3))
            hand_over(system)
        ends.append(state(system, inerter))
    np.testing.assert_allclose(ends[1], ends[0], rtol=1e-11, atol=1e-13)


@pytest.mark.parametrize("solver", ["RK44", "GeneralizedAlpha"])
@pytest.mark.parametrize("name", ["bristle", "shaft", "play without damper"])
def test_exudyns_restart_file(name: str, solver: str, tmp_path: Path) -> None:
    """The file also holds accelerations, so that an implicit run goes on to rounding too."""
    whole, inerter = on_a_line(name, True)
    solve(whole.mbs, settings(0.4, 1e-3), solver)
    expected = state(whole, inerter)
    # the second starts otherwise, but for the file
    for end, speed in ((0.2, 0.5), (0.4, 9.0)):
        system, inerter = on_a_line(name, True, speed)
        chosen = settings(end, 1e-3)
        chosen.solution.restart.name = str(tmp_path / "restart")
        chosen.solution.restart.write = True
        chosen.solution.restart.continueIfAvailable = True
        solve(system.mbs, chosen, solver)
    np.testing.assert_allclose(state(system, inerter), expected, rtol=1e-9, atol=1e-12)


@SYMBOLIC
@pytest.mark.parametrize("solver", ["RK44", "GeneralizedAlpha"])
@pytest.mark.parametrize("name", ["bristle", "shaft", "all"])
def test_a_second_run_is_the_first(name: str, solver: str, symbolic: bool) -> None:
    system, inerter = on_a_line(name, symbolic)
    ends = []
    for _ in range(2):
        solve(system.mbs, settings(0.1, 1e-3), solver)
        ends.append(state(system, inerter))
    np.testing.assert_array_equal(ends[1], ends[0])


def test_a_second_run_with_load_friction_is_the_first() -> None:
    """Its sign comes from the last known acceleration, which must not be the first run's."""
    system = line([2.0, 3.0], [0.5, -0.4], 300.0)
    inerter = CreateInerter(
        system.mbs, "d", system.parts, inertance=4.0, load_friction=0.4, transition_velocity=1e-2
    )
    ends = []
    for end in (0.1, 0.13, 0.1):
        solve(system.mbs, settings(end, 1e-3))
        ends.append(state(system, inerter))
    np.testing.assert_array_equal(ends[2], ends[0])


@SYMBOLIC
def test_initial_states(symbolic: bool) -> None:
    """A shaft that is wound up: it pulls with k s, and the flywheel turns."""
    system = line([2.0, 3.0], [0.0, 0.0])
    start = {"friction_state": 1e-4, "series_deflection": 2e-3, "flywheel_velocity": 0.3}
    inerter = CreateInerter(
        system.mbs, "d", system.parts, inertance=4.0, symbolic=symbolic, initialStates=start,
        **{**LUGRE, "bristle_damping": 0.0}, series_stiffness=5e3,
    )  # fmt: skip
    system.mbs.Assemble()
    assert inerter.stateNames == tuple(start)
    np.testing.assert_array_equal(inerter.GetStates(), list(start.values()))
    said = inerter.Evaluate()
    assert said["inertance"] == pytest.approx(5e3 * 2e-3)
    assert said["friction"] == pytest.approx(1e4 * 1e-4)
    assert said["total"] == pytest.approx(11.0)
    assert said["stored_energy"] == pytest.approx(
        0.5 * 4.0 * 0.3**2 + 0.5 * 5e3 * 4e-6 + 0.5 * 1e4 * 1e-8
    )
    solve(system.mbs, settings(1e-7, 1e-7))
    np.testing.assert_allclose(system.velocities, [11e-7 / 2.0, -11e-7 / 3.0], rtol=1e-3)


def test_states_that_are_not_given_are_zero() -> None:
    system = line([2.0, 3.0], [0.0, 0.0])
    inerter = CreateInerter(
        system.mbs, "d", system.parts, inertance=4.0, initialStates={"gap_position": 1e-3}, **PLAY
    )
    system.mbs.Assemble()
    assert inerter.stateNames == ("series_deflection", "flywheel_velocity", "gap_position")
    np.testing.assert_array_equal(inerter.GetStates(), [0.0, 0.0, 1e-3])


def test_without_a_damper_the_position_in_the_play_follows_the_deflection() -> None:
    """As far as the edges; past them the shaft is wound: 5e3 N/m times 3 mm."""
    for deflection, place, force in ((5e-3, 2e-3, 15.0), (-5e-3, -2e-3, -15.0), (1e-3, 1e-3, 0.0)):
        system = line([2.0], [0.0])
        inerter = CreateInerter(
            system.mbs, "d", [None, system.parts[0]], inertance=4.0, backlash=2e-3,
            series_stiffness=5e3, initialStates={"series_deflection": deflection},
        )  # fmt: skip
        system.mbs.Assemble()
        np.testing.assert_array_equal(inerter.GetStates(), [deflection, 0.0, place])
        assert inerter.Evaluate()["total"] == pytest.approx(force)


def test_a_system_that_is_reset_takes_another_device() -> None:
    system = line([2.0, 3.0], [0.5, 0.0])
    CreateInerter(system.mbs, "d", system.parts, inertance=4.0, **LUGRE)
    solve(system.mbs, settings(0.01, 1e-3))
    mbs = system.mbs
    mbs.Reset()
    mass = mbs.CreateMassPoint(mass=2.0, referencePosition=[1.0, 0.0, 0.0])
    mbs.CreateForce(itemNumber=mass, loadVector=[18.0, 0.0, 0.0])
    inerter = CreateInerter(mbs, "d", [None, mass], inertance=4.0)
    solve(mbs, settings(0.01, 1e-3))
    assert inerter.GetStates().shape == (0,)
    assert inerter.Evaluate()["total"] == pytest.approx(12.0, rel=1e-12)
