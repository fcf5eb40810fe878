"""What happens to devices around and during a run: another inertance, slip, threads, leftovers."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from inerter import Device
from inerter.device_file import read_device
from scipy.integrate import solve_ivp

pytest.importorskip("exudyn.itemInterface")

from element_systems import coordinate, double_pendulum, empty, line, push, settings, solve
from exudyn import itemInterface
from inerter.exudyn import CreateInerter
from inerter.exudyn.inerter import Inerter

SOLVERS = ("GeneralizedAlpha", "TrapezoidalIndex2", "RK44", "DOPRI5")
CONTROL: dict[str, Any] = {"control": "inertance", "control_lower": 1.0, "control_upper": 20.0}


def heavier(made: Inerter, by: str, after: float) -> Any:
    """A pre-step function that makes 9 kg of 4."""

    def pre_step(mbs: Any, t: float) -> bool:
        if t > after - 1e-9 and by == "a control":
            made.SetControl(9.0)
        elif t > after - 1e-9 and made.device.inertance == 4.0:
            made.set(inertance=9.0)
        return True

    return pre_step


@pytest.mark.parametrize("by", ["set", "a control"])
@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("symbolic", [True, False])
def test_an_inertance_changes_in_a_run(by: str, solver: str, symbolic: bool) -> None:
    system = line([1.0], [0.0])
    push(system.mbs, system.parts[0], 10.0)
    more = CONTROL if by == "a control" else {}
    made = CreateInerter(
        system.mbs, "d", [None, system.parts[0]], inertance=4.0, symbolic=symbolic, **more
    )
    system.mbs.SetPreStepUserFunction(heavier(made, by, 0.5))
    chosen = settings(1.0, 1e-3)
    chosen.timeIntegration.minimumStepSize = 1e-12
    solve(system.mbs, chosen, solver)
    # 10 N push 1 + 4 kg for one half of the time, 1 + 9 kg for the other; one step may be late
    assert system.velocities[0] == pytest.approx(1.5, abs=2.1e-3)
    assert made.Evaluate()["total"] == pytest.approx(9.0, abs=1e-6)
    assert chosen.timeIntegration.reuseConstantMassMatrix


@pytest.mark.parametrize("solver", ["GeneralizedAlpha", "RK44"])
def test_a_flywheel_behind_a_shaft_changes_in_a_run_between_points(solver: str) -> None:
    system = empty()
    mbs = system.mbs
    box = mbs.CreateMassPoint(referencePosition=[1.0, 0.0, 0.0], mass=1.0, gravity=[10.0, 0.0, 0.0])
    shaft: dict[str, Any] = {"series_stiffness": 1e3, "series_damping": 20.0}
    made = CreateInerter(mbs, "d", [mbs.CreateGround(), box], inertance=4.0, **shaft)
    mbs.SetPreStepUserFunction(heavier(made, "set", 0.5))
    solve(mbs, settings(1.0, 5e-4), solver)

    def rates(t: float, state: Any, inertance: float) -> list[float]:
        x, v, y, w = state
        force = 1e3 * (x - y) + 20.0 * (v - w)
        return [v, 10.0 - force, w, force / inertance]

    state = np.zeros(4)
    for begin, inertance in ((0.0, 4.0), (0.5, 9.0)):
        run = solve_ivp(
            rates, (begin, begin + 0.5), state, args=(inertance,), rtol=1e-9, atol=1e-12
        )
        state = run.y[:, -1]
    assert made.Evaluate()["velocity"] == pytest.approx(state[1], rel=2e-3)


def test_a_change_of_a_kept_mass_is_refused() -> None:
    """A function of a load is called in a run, and nobody can ask for it beforehand."""
    system = line([1.0], [0.0])
    made = CreateInerter(system.mbs, "d", [None, system.parts[0]], inertance=4.0, viscous=2.0)

    def pushed(mbs: Any, t: float, load: float) -> float:
        if t > 0.01:
            made.set(viscous=3.0)
            made.set(inertance=9.0)
        return load

    system.mbs.AddLoad(
        itemInterface.LoadCoordinate(
            markerNumber=coordinate(system.mbs, system.parts[0]), load=1.0, loadUserFunction=pushed
        )
    )
    with pytest.raises(Exception, match="reuseConstantMassMatrix = False before SolveDynamic"):
        solve(system.mbs, settings(0.1, 1e-3))
    assert made.device.viscous == 3.0
    assert made.device.inertance == 4.0
    # the run is over
    made.set(inertance=9.0)


SLIPS: dict[str, Any] = {
    "friction": "maxwell_slip", "slip_stiffness_1": 3e3, "slip_force_1": 8.0,
    "slip_stiffness_2": 1e3, "slip_force_2": 12.0,
}  # fmt: skip


def true_slips(end: float) -> float:
    """Place of 10 kg on 400 N/m with the device under 60 N sin 7 t: play operators, small steps."""
    elements = [(3e3, 8.0), (1e3, 12.0)]
    state, z = np.zeros(2), np.zeros(2)
    step, t = 2e-5, 0.0

    def acceleration(x: float, v: float, t: float, z: Any) -> float:
        friction = sum(k * each for (k, _), each in zip(elements, z, strict=True))
        return (60.0 * np.sin(7.0 * t) - 400.0 * x - 5.0 * v - friction) / 30.0

    for _ in range(round(end / step)):
        x, v = state
        half_v = v + 0.5 * step * acceleration(x, v, t, z)
        moved = x + step * half_v
        z = np.array([
            np.clip(each + moved - x, -f / k, f / k)
            for (k, f), each in zip(elements, z, strict=True)
        ])  # fmt: skip
        t += step
        v = half_v + 0.5 * step * acceleration(moved, half_v, t, z)
        state = np.array([moved, v])
    return float(state[0])


@pytest.mark.parametrize("solver", ["GeneralizedAlpha", "TrapezoidalIndex2"])
@pytest.mark.parametrize("symbolic", [True, False])
def test_elements_that_slip_do_not_shorten_implicit_steps(solver: str, symbolic: bool) -> None:
    system = line([10.0], [0.0], spring=400.0)
    mbs, (node,) = system.mbs, system.parts
    made = CreateInerter(
        mbs, "d", [None, node], inertance=20.0, viscous=5.0, symbolic=symbolic, **SLIPS
    )
    mbs.AddLoad(
        itemInterface.LoadCoordinate(
            markerNumber=coordinate(mbs, node), load=1.0,
            loadUserFunction=lambda mbs, t, load: 60.0 * np.sin(7.0 * t),
        )
    )  # fmt: skip
    chosen = settings(1.0, 1e-3, newton=1e-10)
    chosen.timeIntegration.automaticStepSize = True
    solve(mbs, chosen, solver)
    # 600 to 700 times as many were taken where an element jumped between two rates
    assert mbs.sys["dynamicSolver"].it.currentStepIndex < 1500
    assert system.positions[0] == pytest.approx(true_slips(1.0), abs=1e-4)
    # afterwards the laws are those that were asked for
    states = made.GetStates()
    assert np.all(np.abs(states) <= np.array([8.0 / 3e3, 12.0 / 1e3]) * (1.0 + 1e-6))


def test_several_threads_are_refused() -> None:
    system = line([1.0], [1.0])
    CreateInerter(system.mbs, "d", [None, system.parts[0]], inertance=4.0)
    chosen = settings(0.1, 1e-3)
    chosen.parallel.numberOfThreads = 2
    with pytest.raises(ValueError, match="numberOfThreads is 2, and with several threads"):
        solve(system.mbs, chosen)
    with pytest.raises(ValueError, match="numberOfThreads is 2, and with several threads"):
        system.mbs.SolveStatic(chosen)


@pytest.mark.parametrize(
    ("wrong", "told"),
    [
        ({"initialStates": {"nothing": 1.0}}, "'nothing' is no state"),
        ({"symbolic": True}, "symbolic: True, but"),
        ({"name": "object1"}, "how Exudyn numbers its own items"),
        ({"name": "taken"}, "there is an object 'taken' already"),
        ({"axis": [0, 0, 1]}, "axis: an angle is between two rigid bodies"),
    ],
)
def test_what_is_refused_leaves_nothing_behind(wrong: dict[str, Any], told: str) -> None:
    system = empty()
    mbs = system.mbs
    ground = mbs.CreateGround(name="taken", referencePosition=[0.0, -1.0, 0.0])
    marker = double_pendulum(mbs, [0.0, 0.0])

    def count() -> tuple[int, ...]:
        data = mbs.systemData
        return data.NumberOfNodes(), data.NumberOfObjects(), data.NumberOfMarkers()

    before = count()
    with pytest.raises(ValueError, match=told):
        CreateInerter(mbs, itemNumbers=[ground, marker], inertance=1.0, **{"name": "d", **wrong})
    assert count() == before
    CreateInerter(mbs, "d", [ground, marker], inertance=1.0)


def test_items_that_were_deleted_are_told() -> None:
    system = empty()
    mbs = system.mbs
    other = mbs.CreateMassPoint(referencePosition=[0.0, 5.0, 0.0], mass=1.0)
    box = mbs.CreateMassPoint(referencePosition=[1.0, 0.0, 0.0], mass=1.0)
    CreateInerter(mbs, "d", [mbs.CreateGround(), box], inertance=4.0)
    mbs.DeleteObject(other, deleteDependentItems=True, suppressWarnings=True)
    with pytest.raises(ValueError, match="delete before CreateInerter"):
        mbs.Assemble()


def test_a_device_of_a_file_is_taken(tmp_path: Path) -> None:
    path = tmp_path / "device.toml"
    path.write_text('[device]\ninertance = "4 kg"\nviscous = 2.0\n')
    system = line([1.0], [1.0])
    device = read_device(str(path))
    made = CreateInerter(system.mbs, "d", [None, system.parts[0]], device=device, damping=3.0)
    assert made.device == Device(inertance=4.0, viscous=3.0)
    solve(system.mbs, settings(0.1, 1e-3), "DOPRI5")
    assert system.velocities[0] == pytest.approx(np.exp(-3.0 * 0.1 / 5.0), rel=1e-6)
    with pytest.raises(ValueError, match="is no device; give inerter"):
        CreateInerter(system.mbs, "e", [None, system.parts[0]], device="device.toml")  # type: ignore[arg-type]
