"""Nonlinear devices: limits, symmetry, the reference, and that a batch is a loop."""

from __future__ import annotations

import dataclasses
import math

import mujoco
import numpy as np
import pytest
from inerter.reference import QuarterCar, ReferenceDevice
from inerter.suspension.time_domain.cases import CASES, NUMBERED, Case, coulomb, numbers_of
from inerter.suspension.time_domain.model import Design, compiled
from inerter.suspension.time_domain.road import PeriodicRoad, iso_road, paper_road
from inerter.suspension.time_domain.simulate import RunSettings, load_gains, road_indices
from inerter.suspension.time_domain.stepping import StepError, step_all

SHORT = RunSettings(settle=1.0, jobs=2)
DESIGNS = {"S2": Design(120e3, 3705.4, 128.57), "S3": Design(120e3, 7544.2, 366.52)}
NONLINEAR = [name for name, case in CASES.items() if not case.linear]


class Mirrored(PeriodicRoad):
    """The road upside down."""

    def phases(self, seed: int) -> np.ndarray:
        return super().phases(seed) + np.pi


@pytest.mark.parametrize("layout", ["S2", "S3"])
def test_no_friction_is_the_linear_case(layout: str) -> None:
    none = compiled(layout, CASES["ideal"])
    weak = compiled(layout, Case("weak", "", "coulomb", coulomb(1e-6)))
    road = paper_road()
    for name, value in road_indices(none, [DESIGNS[layout]], road, [1], SHORT).items():
        found = road_indices(weak, [DESIGNS[layout]], road, [1], SHORT)[name]
        assert found == pytest.approx(value, rel=1e-7)


@pytest.mark.parametrize("layout", ["S2", "S3"])
def test_no_play_is_the_elastic_case(layout: str) -> None:
    elastic = compiled(layout, CASES["elastic"])
    tight = Design(*dataclasses.astuple(DESIGNS[layout])[:3], parameters={"backlash": 1e-9})
    loose = compiled(layout, CASES["backlash"])
    road = iso_road("B")
    expected = road_indices(elastic, [DESIGNS[layout]], road, [1], SHORT)
    found = road_indices(loose, [tight, DESIGNS[layout]], road, [1], SHORT)
    for name in ("J1", "J3"):
        value = expected[name][0]
        assert found[name][0] == pytest.approx(value, rel=2e-4)
        assert abs(found[name][1] / value - 1.0) > 5e-4


@pytest.mark.parametrize("case", NONLINEAR)
def test_up_and_down_are_alike(case: str) -> None:
    road = iso_road("B")
    mirrored = Mirrored(**dataclasses.asdict(road))
    car = compiled("S2", CASES[case])
    plain = road_indices(car, [DESIGNS["S2"]], road, [3], SHORT)
    other = road_indices(car, [DESIGNS["S2"]], mirrored, [3], SHORT)
    # rounding decides when a gap closes
    tolerance = 2e-4 if "backlash" in CASES[case].parameters else 1e-6
    for name in ("J1", "J3"):
        assert other[name] == pytest.approx(plain[name], rel=tolerance)


def test_friction_costs_more_where_the_road_is_smooth() -> None:
    """F_c / road is what counts: 100 N on class B is 200 N on class C, twice as high."""
    car = compiled("S2", CASES["friction100"])
    weak = Design(120e3, 3705.4, 128.57, coulomb(100.0, 1e-3))
    strong = Design(120e3, 3705.4, 128.57, coulomb(200.0, 2e-3))
    for name, value in road_indices(car, [weak], iso_road("B"), [1, 2], SHORT).items():
        if name == "lift_off":
            continue
        twice = road_indices(car, [strong], iso_road("C"), [1, 2], SHORT)[name]
        assert twice == pytest.approx(2.0 * value, rel=1e-8)


def reference_car(layout: str, case: Case) -> QuarterCar:
    design = DESIGNS[layout]
    device = ReferenceDevice(
        inertance=design.inertance,
        friction=case.friction,
        **case.parameters,  # type: ignore[arg-type]
    )
    return QuarterCar(
        layout=layout, stiffness=design.stiffness, damping=design.damping, device=device
    )


@pytest.mark.parametrize("layout", ["S2", "S3"])
@pytest.mark.parametrize("case", ["friction100", "elastic", "both", "dahl", "lugre", "bouc_wen"])
def test_gains_are_those_of_the_reference(layout: str, case: str) -> None:
    """One and two seconds of 1000 N at 2 Hz, the ratio over the second half."""
    frequency, amplitude = 2.0, 1000.0
    found = load_gains(
        compiled(layout, CASES[case]), [DESIGNS[layout]], [[frequency]], amplitude, SHORT
    )[0, 0]
    times = np.arange(0.0, 2.0, 1e-3)

    def load(t: float) -> float:
        return (
            amplitude
            * math.sin(2 * np.pi * frequency * t)
            * 0.5
            * (1 - math.cos(np.pi * min(t, 1.0)))
        )

    run = reference_car(layout, CASES[case]).simulate(
        lambda t: 0.0, times, body_force=load, rtol=1e-6, atol=1e-9, max_step=0.02
    )
    body = run.body_displacement[1000:]
    assert found == pytest.approx(np.sqrt(np.mean(body**2) / (0.5 * amplitude**2)), rel=3e-4)


@pytest.mark.parametrize(("layout", "case"), [("S2", "dahl"), ("S3", "friction100")])
def test_road_indices_are_those_of_the_reference(layout: str, case: str) -> None:
    """A road that ends at 12 Hz, which an adaptive solver drives over in seconds."""
    road = PeriodicRoad("slow", paper_road().strength, 5, 120)
    car = compiled(layout, CASES[case])
    found = road_indices(car, [DESIGNS[layout]], road, [7], SHORT)
    phases, omega = road.phases(7), 2 * np.pi * road.frequencies

    def height(t: float) -> float:
        fade = 0.5 * (1 - math.cos(np.pi * min(t, 1.0)))
        return fade * float(road.amplitudes @ np.sin(omega * (t - 1.0) + phases))

    times = np.arange(0.0, 11.0, 2e-3)
    run = reference_car(layout, CASES[case]).simulate(
        height, times, rtol=1e-5, atol=1e-8, max_step=0.02
    )
    late = times >= 1.0 - 1e-9
    j1 = np.sqrt(np.mean(run.body_acceleration[late] ** 2))
    j3 = np.sqrt(np.mean(run.tyre_force[late] ** 2))
    assert [found["J1"][0, 0], found["J3"][0, 0]] == pytest.approx([j1, j3], rel=1e-3)


@pytest.mark.parametrize(("layout", "case"), [("S2", "lugre"), ("S3", "both"), ("S2", "all")])
def test_a_batch_is_a_loop_of_steps(layout: str, case: str) -> None:
    car = compiled(layout, CASES[case])
    designs = [
        dataclasses.replace(DESIGNS[layout], damping=c, inertance=b)
        for c, b in ((3000.0, 100.0), (9000.0, 300.0))
    ]
    steps, count = np.array([1e-3, 5e-4]), 700
    (wheel_of,) = car.wheels
    drive = 1e-2 * np.sin(np.outer([0.03, 0.02], np.arange(count)))
    chunks = list(
        step_all(
            car, designs, steps, count, [wheel_of.road], lambda i, n: drive[:, i : i + n, None], 2
        )
    )
    wheel = np.hstack([chunk.wheels[:, :, 0] for chunk in chunks])
    body = np.hstack([chunk.body for chunk in chunks])
    integrators = mujoco.mjtIntegrator
    for i, design in enumerate(designs):
        model = car.of(design).__copy__()
        model.opt.integrator = integrators.mjINT_DISCRETE if car.implicit else integrators.mjINT_RK4
        model.opt.timestep = steps[i]
        data = mujoco.MjData(model)
        mujoco.mj_setConst(model, data)
        data = mujoco.MjData(model)
        rows = []
        for held in drive[i]:
            data.ctrl[wheel_of.road] = held
            mujoco.mj_step(model, data)
            rows.append([data.sensor("wheel").data[0], data.sensor("heave").data[0]])
        assert np.array_equal(np.array(rows), np.column_stack([wheel[i], body[i]]))


def test_neighbours_and_threads_change_nothing() -> None:
    car = compiled("S2", CASES["friction100"])
    designs = [
        dataclasses.replace(DESIGNS["S2"], damping=c, parameters={"coulomb_force": f})
        for c, f in ((3000.0, 50.0), (3705.4, 100.0), (4500.0, 10.0))
    ]
    seeds, road = [1, 2], iso_road("B")
    together = road_indices(car, designs, road, seeds, RunSettings(settle=1.0, jobs=2))
    one = road_indices(car, designs, road, seeds, RunSettings(settle=1.0, jobs=1, block=4))
    alone = [
        road_indices(car, [design], road, [seed], RunSettings(settle=1.0, jobs=1))["J1"][0, 0]
        for design in designs
        for seed in seeds
    ]
    assert np.array_equal(together["J1"], one["J1"])
    assert np.array_equal(together["J3"], one["J3"])
    assert np.array_equal(together["J1"].ravel(), alone)
    f = np.tile([2.0, 3.3], (3, 1))
    settings = [RunSettings(settle=1.0, jobs=n, block=n) for n in (1, 2)]
    first, second = (load_gains(car, designs, f, settings=each) for each in settings)
    assert np.array_equal(first, second)


def test_cases_are_numbered_as_the_text_tells() -> None:
    """Section V.C: 1, 2, 5 ideal, 3, 4, 6, 7 with friction; V.D: 5 and 9 with both."""
    kinds = {(n.table, n.number): n.case for n in NUMBERED}
    assert {n for (t, n), case in kinds.items() if t == 2 and case == "ideal"} == {1, 2, 5}
    assert {n for (t, n), case in kinds.items() if t == 2 and "friction" in case} == {3, 4, 6, 7}
    for case, expected in (
        ("ideal", {1, 2, 6}), ("elastic", {3, 7}), ("friction", {4, 8}), ("both", {5, 9}),
    ):  # fmt: skip
        assert {n for (t, n), found in kinds.items() if t == 3 and found == case} == expected
    assert numbers_of("S3", "friction") == "2.6 3.8"
    assert numbers_of("S3", "dahl") == ""


def test_what_cannot_be_simulated_is_refused() -> None:
    car = compiled("S2", CASES["friction100"])
    sharp = dataclasses.replace(DESIGNS["S2"], parameters=coulomb(100.0, 1e-4))
    with pytest.raises(ValueError, match=r"too sharp for steps of 0\.001 s; shorten the step"):
        road_indices(car, [sharp], paper_road(), [1], SHORT)
    strange = dataclasses.replace(DESIGNS["S2"], parameters={"backlash": 1e-4})
    with pytest.raises(ValueError, match="has no parameter backlash"):
        road_indices(car, [strange], paper_road(), [1], SHORT)
    with pytest.raises(ValueError, match="inertance is 0"):
        road_indices(compiled("S3", CASES["ideal"]), [Design(1e5, 1e3)], paper_road(), [1])
    with pytest.raises(ValueError, match="damping is -1"):
        Design(1e5, -1.0)
    with pytest.raises(ValueError, match="layout 'S9' is not known: take S1"):
        compiled("S9", CASES["ideal"])
    for layout in ("S1", "SR"):
        with pytest.raises(ValueError, match=f"{layout} has no inerter"):
            compiled(layout, CASES["dahl"])
    wild = Design(120e3, 1e6)
    with pytest.raises(StepError, match=r"damping 1e\+06.*diverged; shorten the step"):
        road_indices(compiled("S1", CASES["ideal"]), [wild], paper_road(), [1], SHORT)
    wrong = dataclasses.replace(DESIGNS["S2"], parameters={"coulomb_force": -5.0})
    with pytest.raises(ValueError, match=r"coulomb_force is .-5\.0.: out of range"):
        road_indices(car, [wrong], paper_road(), [1], SHORT)
