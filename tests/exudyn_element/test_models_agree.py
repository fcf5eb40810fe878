"""The Exudyn models move as the reference ODE, written apart, and as the MuJoCo models."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import mujoco
import numpy as np
import pytest
from inerter.model_parameters import HALF_CAR, QUARTER_CAR
from inerter.models import exudyn_model, model_path
from inerter.reference import HalfCar, QuarterCar, ReferenceDevice, Strut, corner_of

# a module of Exudyn, not "exudyn": this very folder would be taken for that
pytest.importorskip("exudyn.itemInterface")

import exudyn as exu
from inerter.exudyn.model_parts import Model, Run, simulate, simulation_settings
from model_cases import (
    CASES,
    ELASTIC,
    LAYOUTS,
    TIMES,
    Array,
    build,
    error,
    motion_error,
    run,
    truth,
)

# ------------------------------ the models move as the reference ------------------------------


@pytest.mark.parametrize("name", [name for name in CASES if "fluid" not in name])
def test_free_motion(name: str) -> None:
    """RK44 at 1 ms: 3e-8 to 2e-6, 1e-5 where the damper is fast against the wheel (S3)."""
    true = truth(name, False)
    errors = [motion_error(run(name, "RK44", step, driven=False), true) for step in (1e-3, 5e-4)]
    assert errors[0] < (2e-5 if name == "quarter_car S3" else 4e-6)
    assert 13 < errors[0] / errors[1] < 20


@pytest.mark.rarely("fluid_inerter complete", "fluid_inerter dry")
@pytest.mark.parametrize("name", CASES)
def test_inputs(name: str) -> None:
    """The solver asks for the input at every stage: fourth order, and forces as good."""
    true = truth(name, True)
    steps = (1e-4, 5e-5) if "fluid" in name else (2e-3, 1e-3)
    found = [run(name, "RK44", step, driven=True) for step in steps]
    errors = [motion_error(each, true) for each in found]
    assert errors[1] < 1e-6
    assert 13 < errors[0] / errors[1] < 25
    # at the start an explicit solver knows no acceleration yet
    for i, force in enumerate(found[1].force.values()):
        assert error(force[1:], true.device_force[1:, i]) < 2e-6


@pytest.mark.parametrize("name", CASES)
def test_second_order_under_generalized_alpha(name: str) -> None:
    true = truth(name, True)
    errors = [
        motion_error(run(name, "GeneralizedAlpha", step, driven=True), true)
        for step in (1e-3, 5e-4)
    ]
    assert errors[1] < 2e-3
    assert 3.7 < errors[0] / errors[1] < 4.3


@pytest.mark.parametrize("solver", ["DOPRI5", "RK67"])
@pytest.mark.parametrize("name", ["quarter_car S2", "half_car S3", "frame floors"])
def test_other_explicit_solvers(name: str, solver: str) -> None:
    """Of order 5 and 6, at fixed steps of 1 ms."""
    found = run(name, solver, 1e-3, driven=False)
    assert motion_error(found, truth(name, False)) < 2e-8


def test_automatic_steps() -> None:
    """Exudyn writes at its own times then: the reference is asked for those."""
    case = CASES["quarter_car S3"]()
    _container, model = build(case, driven=False)
    settings = simulation_settings(1.0, 1e-2, 0.01)
    settings.timeIntegration.automaticStepSize = True
    settings.timeIntegration.relativeTolerance = 1e-9
    settings.timeIntegration.absoluteTolerance = 1e-12
    found = simulate(model, 1.0, solver="DOPRI5", settings=settings)
    state = np.zeros(case.structure.nstate)
    state[2:4] = list(case.start.values())
    still = np.zeros(2)
    true = case.structure.simulate(
        lambda t: still, found.time, initial=state, method="DOP853", rtol=1e-11, atol=1e-14
    )
    assert found.time[-1] == pytest.approx(1.0, abs=1e-12)
    assert motion_error(found, true) < 1e-7


@pytest.mark.parametrize("solver", ["RK44", "GeneralizedAlpha"])
def test_locked_directions_stay(solver: str) -> None:
    """Their inertia is 1e12 kg and kg m^2; forces of some kN move that by 1e-10."""
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    kerb = {"wheel_front_right": 0.5, "roll": 0.2, "pitch": 0.2}
    model = exudyn_model("full_car").build(mbs, initial_velocities=kerb)
    simulate(model, 0.3, solver=solver)
    body, wheel = (model.coordinates[name][0] for name in ("heave", "wheel_front_right"))
    moved = np.abs(mbs.GetNodeOutput(body, exu.OutputVariableType.Coordinates))
    assert moved[[2, 3, 4]].min() > 1e-4
    assert moved[[0, 1, 5]].max() < 1e-10
    assert np.abs(mbs.GetNodeOutput(wheel, exu.OutputVariableType.Coordinates))[:2].max() < 1e-10


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("name", ["half_car", "full_car"])
def test_large_motions_as_in_mujoco(name: str, layout: str) -> None:
    """A kerb at 2 m/s bends the geometry by more than 1e-3 of the motion: alike to rounding.

    The same step of the same Runge-Kutta method in both engines: 6e-13 to 3e-11 are left.
    """
    case = CASES[f"{name} {layout}"]()
    kerb = {key: 4.0 * value for key, value in case.start.items()}
    container = exu.SystemContainer()
    model = exudyn_model(name).build(container.AddSystem(), layout=layout, initial_velocities=kerb)
    found = simulate(model, 1.0, 1e-3)

    compiled = mujoco.MjModel.from_xml_path(str(model_path(name, f"model_{layout.lower()}.xml")))
    data = mujoco.MjData(compiled)
    for key, value in kerb.items():
        data.joint(key).qvel = value
    rows = [[data.joint(key).qpos[0] for key in kerb]]
    for _ in range(100):
        mujoco.mj_step(compiled, data, 10)
        rows.append([data.joint(key).qpos[0] for key in kerb])
    moved = np.column_stack(list(found.displacement.values()))
    assert error(moved, np.array(rows)) < 1e-10
    linear = truth(f"{name} {layout}", False).position * (4.0 / case.scale)
    assert error(moved, linear) > 1e-3


# ------------------------------ states and other devices ------------------------------

BRISTLES = {
    "friction": "lugre", "coulomb_force": 40.0, "static_force": 60.0, "stribeck_velocity": 0.02,
    "bristle_stiffness": 5e4, "bristle_damping": 100.0,
}  # fmt: skip


def states_of(model: Model, name: str, step: float) -> tuple[Run, Array]:
    sensor = model.inerters[name].AddSensor("states")
    found = simulate(model, 1.0, step)
    return found, np.array(model.mbs.GetSensorStoredData(sensor)[:, 1:])


@pytest.mark.often("S3")
@pytest.mark.parametrize(
    ("layout", "extra"), [("S2", {}), ("S2", ELASTIC), ("S3", {})], ids=["S2", "S2 elastic", "S3"]
)
def test_a_device_of_ones_own_in_the_quarter_car(layout: str, extra: dict[str, float]) -> None:
    """It takes the inerter's place alone, beside the damper (S2) or in series with it (S3)."""
    values: dict[str, Any] = {"inertance": 100.0, **BRISTLES, **extra}
    damping = QUARTER_CAR.struts[layout].damping
    car = QuarterCar(layout=layout, damping=damping, device=ReferenceDevice(**values))
    start = {"body": 0.1, "wheel": 0.3}
    state = np.zeros(car.nstate)
    state[2:4] = list(start.values())
    true = car.simulate(lambda t: 0.0, TIMES, initial=state, rtol=1e-10, atol=1e-13)

    container = exu.SystemContainer()
    model = exudyn_model("quarter_car").build(
        container.AddSystem(), layout=layout, device=values, initial_velocities=start
    )
    found, states = states_of(model, "strut", 1e-4)
    assert error(found.displacement["body"], true.body_displacement) < 2e-7
    assert error(found.displacement["wheel"], true.wheel_displacement) < 2e-7
    assert error(states, true.device_states) < 5e-6
    assert error(found.force["strut"][1:], true.device_force[1:]) < 1e-6


@pytest.mark.often("S2")
@pytest.mark.parametrize("layout", ["S2", "S3"])
def test_a_device_of_ones_own_in_the_half_car(layout: str) -> None:
    """In S3 the damper is the device's series element, its friction stays at the terminals."""
    values: dict[str, Any] = {"inertance": 40.0, **BRISTLES}
    axles = {"front": HALF_CAR.front, "rear": HALF_CAR.rear}
    corners: Any = {name: corner_of(axle, layout) for name, axle in axles.items()}
    for name, axle in axles.items():
        series: dict[str, Any] = {"series_damping": axle.damping} if layout == "S3" else {}
        strut = Strut(
            layout="S2",
            stiffness=axle.stiffness,
            damping=0.0 if layout == "S3" else axle.damping,
            device=ReferenceDevice(**values, **series),
        )
        corners[name] = replace(corners[name], strut=strut)
    car = HalfCar(**corners)
    # so small that the geometry is linear to 1e-5: the bristles bend, a fifth of their breakaway
    start = {"wheel_front": 2e-3, "heave": 1e-3}
    state = np.zeros(car.nstate)
    state[[4, 6]] = start["heave"], start["wheel_front"]
    true = car.simulate([lambda t: 0.0] * 2, TIMES, initial=state, rtol=1e-10, atol=1e-15)

    container = exu.SystemContainer()
    model = exudyn_model("half_car").build(
        container.AddSystem(), layout=layout, device=values, initial_velocities=start
    )
    found, states = states_of(model, "strut_front", 2.5e-4)
    moved = np.column_stack(list(found.displacement.values()))
    expected = np.column_stack([true.heave, true.pitch, true.wheel_displacement])
    assert error(moved, expected) < 1e-5
    assert error(states, true.device_states[0]) < 1e-5
