"""Vehicles with hidden effects: the generator against MuJoCo, its roads, the cases of a plan."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from inerter.blind_test.case import Outcome, hide, solve
from inerter.blind_test.plan import Plan, Task
from inerter.blind_test.score import score
from inerter.blind_test.vehicle import ELSEWHERE, name_in_vehicle
from inerter.blind_test.vehicle_model import sensors_of, vehicle_mjcf
from inerter.commands import app
from inerter.diagnose.result import Finding, StatedValue
from inerter.diagnose.vehicle.build import model_of_text
from inerter.diagnose.vehicle.drive import make_drive
from inerter.diagnose.vehicle.mapping import map_columns
from inerter.diagnose.vehicle.model import VehicleModel
from inerter.diagnose.vehicle.simulate import VehicleSimulator
from inerter.plugin import load_plugin
from inerter.records.free_form import FreeRecord
from inerter.reference import (
    VEHICLE_EFFECTS,
    VEHICLE_UNKNOWN,
    HiddenVehicle,
    compatible_in_vehicles,
    hide_in_vehicle,
)
from inerter.reference.drawn_vehicle import KINDS
from inerter.reference.hidden_vehicle import draw_vehicle
from inerter.reference.vehicle_draws import Making, Sizes, draw_vehicle_effect
from inerter.reference.vehicle_roads import Bump, RoadRun, Track
from scipy.integrate import quad
from typer.testing import CliRunner

SPACING = 0.004
SIZES = Sizes(x=0.01, v=0.15, a=5.0, force=300.0, largest=0.03, smallest=-0.03,
              guide_rate=0.2, pull=1200.0)  # fmt: skip


def _misses(making: Making, change: VehicleModel, seconds: float = 1.5) -> dict[str, float]:
    """Rms difference of reference and MuJoCo by channel, per the channel's size."""
    load_plugin()
    stated = making.stated
    road = RoadRun(road_class="B", speed=15.0, seconds=seconds, seed=5,
                   bumps=(Bump(0.5, 0.15, 0.02),))  # fmt: skip
    first = max(corner.x for corner in stated.corners)
    times = np.arange(0.0, seconds, SPACING)
    tracks = [road.track(int(c.y < 0), first - c.x) for c in stated.corners]
    felt = [road.track(int(c.y < 0), first - c.x, making.patch) for c in stated.corners]
    truth = making.built().drive(felt, times)
    truth = {name: making.felt(name, times, values) for name, values in truth.items()}
    heights = {
        f"road{name}": np.array([track(t) for t in times])
        for name, track in zip(stated.names, tracks, strict=True)
    }
    user = model_of_text(vehicle_mjcf(stated), Path("car.xml")).with_timestep(0.001)
    channels = map_columns(user.model, [*heights, *truth, "speed"], {}, sensors_of(stated))
    user.with_inputs(channels.inputs.values())
    assert user.parts.unknown == []
    assert len(user.parts.tyres) == len(stated.corners)
    speed = np.full(times.size, road.speed)
    record = FreeRecord(name="run", time=times, extra={**heights, **truth, "speed": speed})
    drive = make_drive(record, channels, 0.001)
    simulated = VehicleSimulator(user, channels, 1).outputs([change], drive)[0]
    found = {}
    for i, output in enumerate(channels.outputs):
        # the first samples have the jump with which the wheel meets the road
        measured, model = truth[output.column][25:], simulated[25:, i]
        difference = (measured - measured.mean()) - (model - model.mean())
        found[output.column] = float(np.std(difference) / np.std(measured))
    return found


@pytest.mark.parametrize("kind", KINDS)
def test_the_stated_vehicle_moves_as_its_model_in_mujoco(kind: str) -> None:
    making = Making(draw_vehicle(np.random.default_rng(3), kind))
    misses = _misses(making, VehicleModel())
    assert len(misses) > 3
    # the model's geometry bends with pitch and roll, the reference's does not
    assert max(misses.values()) < (0.005 if kind in ("quarter", "arm") else 0.01), misses


# element of a parameter in a model, by effect
OF = {
    "damper_asymmetry": "strut", "spring_hardening": "strut", "quadratic_damping": "strut",
    "variable_inertance": "strut", "inertance_error": "strut", "viscous_friction": "strut",
    "parallel_stiffness": "strut", "end_stop": "strut",
    "tyre_damping": "tyre:road", "tyre_liftoff": "tyre:road", "tyre_stiffness_error": "tyre:road",
    "body_mass_error": "body:sprung", "wheel_mass_error": "body:wheel",
    "joint_damping": "joint:wheel", "digressive_damping": "strut",
    "position_dependent_damping": "strut", "viscoelasticity": "strut",
    "tyre_enveloping": "tyres", "sensor_filter": "channel:body_acceleration",
    "sensor_compliance": "channel:body_acceleration", "sensor_delay": "channel:body_acceleration",
    "mounting_angle": "channel:wheel_acceleration",
    "sensor_gain_error": "channel:body_acceleration",
}  # fmt: skip


@pytest.mark.parametrize("effect", [*OF])
def test_a_hidden_effect_is_what_the_same_number_does_in_mujoco(effect: str) -> None:
    random = np.random.default_rng([7, len(effect)])
    kind = "arm" if effect == "mounting_angle" else "quarter"
    making = Making(draw_vehicle(random, kind))
    column = ["body_acceleration"]
    strength = 2.0 if effect == "tyre_enveloping" else 1.0
    draw_vehicle_effect(making, effect, None, random, [SIZES], strength, column, SPACING)
    without = _misses(making, VehicleModel())
    values = making.names[effect]
    if effect == "viscoelasticity":
        values["branch_time_1"] = values.pop("branch_damping_1") / values["branch_stiffness_1"]
    telling = {"body_mass": "mass", "wheel_mass": "mass"}
    change = {f"{OF[effect]}.{telling.get(name, name)}": v for name, v in values.items()}
    within = _misses(making, VehicleModel(change))
    assert max(without.values()) > 0.02, without
    # rates of a road that is given by samples are least sure at its start
    assert max(within.values()) < 0.015, within
    assert max(within.values()) < 0.3 * max(without.values())


def test_a_contact_patch_feels_the_mean_of_the_road() -> None:
    point = Track(seed=3, duration=4.0, amplitude=0.1, bumps=(Bump(1.0, 0.2, 0.03),))
    patch = Track(seed=3, duration=4.0, amplitude=0.1, bumps=point.bumps, patch=0.05)
    offset = quad(point, -0.025, 0.025, limit=200)[0] / 0.05
    for t in (0.5, 1.02, 1.1, 1.19):
        mean = quad(point, t - 0.025, t + 0.025, limit=200)[0] / 0.05
        assert patch(t) == pytest.approx(mean - offset, abs=1e-6)
        rate = (patch(t + 1e-5) - patch(t - 1e-5)) / 2e-5
        assert patch.rate(t) == pytest.approx(rate, abs=1e-5)


def test_a_road_is_as_rough_as_its_class() -> None:
    run = RoadRun(road_class="C", speed=20.0, seconds=40.0, seed=9)
    track = run.track(0, 0.0)
    rates = np.array([track.rate(t) for t in np.arange(0.0, 40.0, 0.01)])
    # G_v = (2 pi 0.1)^2 256e-6 20 up to 25 Hz
    assert np.std(rates) == pytest.approx(np.sqrt(0.394784 * 256e-6 * 20 * 25), rel=0.03)


@pytest.fixture(scope="module")
def case() -> HiddenVehicle:
    return hide_in_vehicle(11, ("tyre_damping",), vehicle="quarter")


def test_noise_is_that_of_the_channels(case: HiddenVehicle) -> None:
    for name in case.truth[0]:
        noise = np.concatenate(
            [run[name] - true[name] for run, true in zip(case.runs, case.truth, strict=True)]
        )
        size = np.std(np.concatenate([true[name] for true in case.truth]))
        assert np.std(noise) == pytest.approx(0.01 * size, rel=0.06)
    assert case.share > 0.02
    assert set(case.parameters) == {"tyre_damping"}


@pytest.mark.long
def test_a_seed_repeats_its_case(case: HiddenVehicle) -> None:
    again = hide_in_vehicle(11, ("tyre_damping",), vehicle="quarter")
    assert again.parameters == case.parameters
    for one, other in zip(case.runs, again.runs, strict=True):
        assert one.keys() == other.keys()
        assert all(np.array_equal(one[name], other[name]) for name in one)


def test_what_cannot_be_hidden_is_refused() -> None:
    with pytest.raises(ValueError, match="'gremlins' is not one of"):
        hide_in_vehicle(1, ("gremlins",))
    with pytest.raises(ValueError, match="do not go together"):
        hide_in_vehicle(1, ("backlash", "series_elasticity"))
    with pytest.raises(ValueError, match="'gremlins' is not one of"):
        hide_in_vehicle(1, unknown="gremlins")


def test_an_effect_in_another_corner_is_told_apart() -> None:
    made = HiddenVehicle(
        seed=1, effects=("tyre_damping",), law=None,
        stated=draw_vehicle(np.random.default_rng(1), "half"), active=False,
        roads=("road_front", "road_rear"), runs=(), truth=(),
        names={"tyre_damping": {"tyre_damping": 100.0}}, places={"tyre_damping": "_rear"},
        share=0.1,
    )  # fmt: skip
    for name, said in (("road_rear", "tyre_damping"), ("road_front", "tyre_damping" + ELSEWHERE)):
        value = StatedValue(100.0, 1.0, "N*s/m", None)
        finding = Finding(
            effect="tyre_damping", law=None, confidence=1.0, rmse_before=1.0, rmse_after=0.1,
            parameters={f"{name}.tyre_damping": value}, evidence="", rivals=[],
        )  # fmt: skip
        assert name_in_vehicle(made, finding) == said


def test_plan_in_vehicles() -> None:
    plan = Plan(count=2, clean=3, pairs=12, unknown=10, seed=5, bench="vehicle")
    tasks = plan.tasks()
    assert plan.effects == VEHICLE_EFFECTS
    assert Counter(task.group for task in tasks) == {
        "single": 2 * len(VEHICLE_EFFECTS), "clean": 3, "pairs": 12, "unknown": 10,
    }  # fmt: skip
    assert all(compatible_in_vehicles(task.effects) for task in tasks)
    assert {task.kind for task in tasks if task.group == "unknown"} == set(VEHICLE_UNKNOWN)
    laws = [task.law for task in tasks if task.effects == ("hysteretic_friction",)]
    assert laws == ["dahl", "lugre"]
    with pytest.raises(ValueError, match="'stribeck_friction' is not one of"):
        Plan(effects=("stribeck_friction",), bench="vehicle")

    # the counts of a score go by the vehicle's effects
    outcomes = [Outcome(task=task, error="not run") for task in tasks]
    matrix = score(plan, outcomes)["confusion"]
    assert matrix["hidden"] == [*VEHICLE_EFFECTS, "none"]
    assert matrix["named"][-1] == "failed"


def test_a_vehicle_on_a_realistic_bench_is_refused() -> None:
    result = CliRunner().invoke(app, ["blind-test", "--vehicle", "--bench", "realistic"])
    assert result.exit_code == 2
    assert result.stderr.count("\n") == 1
    assert "leave --bench or --vehicle out" in result.stderr


@pytest.mark.long
@pytest.mark.parametrize("effects", [("tyre_damping",), ()])
def test_a_drawn_vehicle_is_solved(effects: tuple[str, ...], effects_seed: int) -> None:
    group = "single" if effects else "clean"
    task = Task(group=group, seed=effects_seed, noise=0.01, effects=effects, bench="vehicle")
    assert isinstance(hide(task), HiddenVehicle)
    found = solve(task)
    assert found.error is None, f"seed {effects_seed}: {found.error}"
    assert found.effects == effects, f"seed {effects_seed}: {found.verdict}"
    assert all(error.near for error in found.parameters)
    assert not found.unexplained
