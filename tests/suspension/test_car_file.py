"""Cars in files: what they mean in the linear study and in MuJoCo, and what is refused."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path

import mujoco
import numpy as np
import polars as pl
import pytest
from inerter.cars.mjcf import car_mjcf
from inerter.cars.parts import CarParts, StrutParts
from inerter.cars.read import CarError, read_car, shipped_car
from inerter.core import DeviceError
from inerter.mjcf import device_of_model
from inerter.model_parameters import FULL_CAR
from inerter.models import model_path
from inerter.plugin import load_plugin
from inerter.simulate.run import run_model
from inerter.suspension.car_options import linear_car
from inerter.suspension.commands import app
from inerter.suspension.layouts import LAYOUTS
from inerter.suspension.quarter_car import QuarterCar
from inerter.suspension.vehicle.cars import FullCar, full_car, half_car
from inerter.suspension.vehicle.indices import vehicle_index
from inerter.suspension.vehicle.strut import VehicleStrut
from typer.testing import CliRunner

QUARTER = """[car]
kind = "quarter"
body_mass_kg = 320
[front]
wheel_mass_kg = 42
tyre_stiffness_kN_per_m = 210
[front.strut]
stiffness_N_per_mm = 25
damping_N_s_per_m = 1500
"""
VALUES = {
    "S1": {}, "S2": {"inertance": 40.0}, "S3": {"inertance": 200.0},
    "S4": {"inertance": 20.0, "relaxation_stiffness": 150e3},
    "S5": {"inertance": 200.0, "relaxation_stiffness": 150e3},
    "S6": {"inertance": 100.0, "relaxation_stiffness": 10e3},
    "SR": {"relaxation_stiffness": 150e3},
    "SW7": {"inertance": 200.0, "damper_stiffness": 9e3, "inerter_stiffness": 2e3},
    "SW8": {"inertance": 200.0, "damper_stiffness": 9e3, "inerter_stiffness": 2e3,
            "relaxation_stiffness": 200e3},
}  # fmt: skip


def own(text: str, folder: Path) -> CarParts:
    path = folder / "car.toml"
    path.write_text(text)
    return read_car(path)


def with_strut(car: CarParts, **values) -> CarParts:
    """The quarter-car with another strut."""
    strut = dataclasses.replace(car.front.strut, **values)
    return dataclasses.replace(car, front=dataclasses.replace(car.front, strut=strut))


def compiled(car: CarParts) -> mujoco.MjModel:
    load_plugin()
    return mujoco.MjModel.from_xml_string(car_mjcf(car))


def test_the_shipped_cars_are_the_published_ones() -> None:
    assert linear_car(shipped_car("quarter")) == QuarterCar()
    assert linear_car(shipped_car("half")) == half_car()
    assert linear_car(shipped_car("full")) == full_car()
    assert shipped_car("full").rear is not None
    assert shipped_car("full").static_loads["front"] == pytest.approx(half_car().static_loads[0])


@pytest.mark.parametrize("layout", VALUES)
def test_mujoco_has_the_strut_of_every_layout(layout: str, tmp_path: Path) -> None:
    """Swept in frequency against the transfer function, with a motion ratio of 0.8."""
    ratio = 0.8
    car = with_strut(
        own(QUARTER, tmp_path), layout=layout, stiffness=40e3, motion_ratio=ratio, **VALUES[layout]
    )
    model = compiled(car)
    values = VALUES[layout]
    k1, k2 = (values.get(f"{name}_stiffness", 0.0) for name in ("damper", "inerter"))
    centred = {}
    if k1:
        # k_1 = k share (1 + ratio), k_1 / k_2 = ratio
        centred = {"centring_ratio": k1 / k2, "centring_share": k1 * k2 / (k1 + k2) / 40e3}
    network = LAYOUTS[layout].stiffness(
        40e3, 1500.0, values.get("inertance", 0.0), values.get("relaxation_stiffness", 1.0),
        **centred,  # pyright: ignore[reportArgumentType]
    )  # fmt: skip
    # at the wheel everything counts with the ratio's square
    at_wheel = dataclasses.replace(network, numerator=ratio**2 * network.numerator)
    linear = linear_car(car)
    assert isinstance(linear, QuarterCar)
    wheel, heave = (model.joint(name).qposadr[0] for name in ("wheel", "heave"))
    for frequency in (1.6, 9.0):
        data, omega = mujoco.MjData(model), 2 * np.pi * frequency
        periods = int(25 * frequency)
        per = round(1.0 / frequency / 1e-3)
        model.opt.timestep = 1.0 / frequency / per
        rows = []
        for n in range(periods * per):
            t = n * model.opt.timestep
            # RK4 holds the control over a step: its value in the middle
            data.ctrl[model.actuator("road").id] = 1e-3 * np.sin(
                omega * (t + 0.5 * model.opt.timestep)
            )
            if n >= (periods - 2) * per:
                rows.append((t, data.qpos[heave], data.qpos[wheel]))
            mujoco.mj_step(model, data)
        time, body, _ = np.array(rows).T
        found = 2.0 * np.mean(body * np.exp(-1j * omega * time)) / (-1j) / 1e-3
        expected = complex(linear.body_per_road(at_wheel)(1j * omega))
        assert abs(found - expected) < 0.01 * abs(expected) + 2e-3, frequency


def test_a_full_car_from_a_file_moves_as_the_shipped_model(tmp_path: Path) -> None:
    time = np.arange(0.0, 0.8, 1e-3)
    bump = 1e-4 * np.exp(-(((time - 0.2) / 0.04) ** 2))
    late = np.interp(time - 0.1, time, bump)
    control = tmp_path / "road.csv"
    pl.DataFrame(
        {"time": time, "road_front_left": bump, "road_front_right": 0.3 * bump,
         "road_rear_left": late, "road_rear_right": 0.3 * late}
    ).write_csv(control)  # fmt: skip
    path = tmp_path / "car.toml"
    shipped = Path(__import__("inerter.cars.read", fromlist=["SHIPPED"]).SHIPPED / "full.toml")
    path.write_text(shipped.read_text())
    found = run_model(path, control=control).vehicle
    expected = run_model(model_path("full_car", "model.xml"), control=control).vehicle
    for name in ("heave", "pitch", "roll", "tyre_force_front_left", "body_acceleration"):
        scale = np.abs(expected[name]).max()
        assert found[name] == pytest.approx(expected[name], abs=2e-3 * scale)
    # the travel is that of the linear geometry
    lifted = found["heave"] - 1.011 * found["pitch"] + 0.755 * found["roll"]
    assert np.abs(found["suspension_travel_front_left"]).max() > 0.0
    assert np.abs(lifted).max() > np.abs(found["suspension_travel_front_left"]).max() * 0.1


def test_an_anti_roll_bar_stiffens_roll_alone() -> None:
    """Force on each wheel per opposite travel; heave and pitch do not feel it."""
    car = shipped_car("full")
    stiff = dataclasses.replace(car, front=dataclasses.replace(car.front, anti_roll_stiffness=30e3))
    forces = []
    for each in (car, stiff):
        model = compiled(each)
        data = mujoco.MjData(model)
        data.joint("wheel_front_left").qpos, data.joint("wheel_front_right").qpos = 0.01, -0.01
        mujoco.mj_forward(model, data)
        roll = data.joint("wheel_front_left").qfrc_passive[0]
        mujoco.mj_resetData(model, data)
        data.joint("heave").qpos = 0.01
        mujoco.mj_forward(model, data)
        forces.append((roll, data.joint("heave").qfrc_passive[0]))
    assert forces[1][0] - forces[0][0] == pytest.approx(-30e3 * 0.01)
    assert forces[1][1] == pytest.approx(forces[0][1])
    # the linear study: the same as a stiffer spring in roll, and nothing without roll
    struts = (VehicleStrut(19960.0, 1290.0), VehicleStrut(17500.0, 1690.0))
    plain, barred = linear_car(car), linear_car(stiff)
    assert isinstance(plain, FullCar)
    assert isinstance(barred, FullCar)
    assert vehicle_index("J1", barred, "S1", struts) > vehicle_index("J1", plain, "S1", struts)
    together = [
        vehicle_index("J1", dataclasses.replace(each, correlation=1.0), "S1", struts)
        for each in (plain, barred)
    ]
    assert together[0] == together[1]
    assert plain.track == FULL_CAR.track


def test_damper_tables_and_stops_are_the_forces_that_they_state(tmp_path: Path) -> None:
    text = QUARTER.replace(
        "damping_N_s_per_m = 1500",
        "damper_bump_m_per_s_N = [[0.1, 100], [0.5, 200]]\n"
        "damper_rebound_mm_per_s_N = [[100, 400], [500, 900]]\n"
        "bump_stop_gap_mm = 60\nbump_stop_stiffness_kN_per_m = 200",
    )
    model = compiled(own(text, tmp_path))
    data = mujoco.MjData(model)

    def force(travel: float, speed: float) -> float:
        """On the body, upward; without the tyre."""
        mujoco.mj_resetData(model, data)
        data.joint("heave").qpos, data.joint("heave").qvel = travel, speed
        mujoco.mj_forward(model, data)
        joint = data.joint("heave")
        return float((joint.qfrc_passive + joint.qfrc_actuator)[0])

    assert force(0.0, 0.0) == 0.0
    assert force(0.0, 0.05) == pytest.approx(-200.0)
    assert force(0.0, 0.3) == pytest.approx(-650.0)
    assert force(0.0, 1.0) == pytest.approx(-900.0 - 0.5 * 1250.0)
    assert force(0.0, -0.3) == pytest.approx(150.0)
    assert force(0.0, -1.0) == pytest.approx(200.0 + 0.5 * 250.0)
    assert force(-0.05, 0.0) == pytest.approx(0.05 * 25e3)
    assert force(-0.08, 0.0) == pytest.approx(0.08 * 25e3 + 0.02 * 200e3)
    assert force(0.08, 0.0) == pytest.approx(-0.08 * 25e3)


def test_its_tyre_leaves_the_road(tmp_path: Path) -> None:
    (tmp_path / "car.toml").write_text(QUARTER)
    time = np.arange(0, 0.6, 1e-3)
    x = 30 / 3.6 * (time - 0.1)
    bump = np.where((x >= 0) & (x <= 0.5), 0.025 * (1 - np.cos(4 * np.pi * x)), 0.0)
    pl.DataFrame({"time": time, "road": bump}).write_csv(tmp_path / "road.csv")
    run = run_model(tmp_path / "car.toml", control=tmp_path / "road.csv")
    assert run.vehicle["tyre_force"].min() == pytest.approx(-9.81 * 362.0)
    assert not [warning for warning in run.warnings if "pulls" in warning]


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("body_mass_kg = 320", "body_mass = 320", "body_mass has no unit: write body_mass_kg"),
        ("body_mass_kg = 320", "bodymass_kg = 320", "did you mean body_mass_kg?"),
        ("stiffness_N_per_mm = 25", "stiffness_N_per_m = 25",
         "did you mean stiffness_kN_per_m = 25?"),
        ("tyre_stiffness_kN_per_m = 210\n", "", "[front] tyre_stiffness_N_per_m is missing"),
        ("wheel_mass_kg = 42", "wheel_mass_kg = -1", "wheel_mass_kg is -1: give a positive"),
        ("wheel_mass_kg = 42", 'wheel_mass_kg = "42"', "wheel_mass_kg is '42': give a number"),
        ('kind = "quarter"', 'kind = "lorry"', "give one of quarter, half, full"),
        ('kind = "quarter"', 'kind = "half"', "pitch_inertia_kg_m2 is missing"),
        ("[front.strut]", '[front.strut]\nlayout = "S2"', "inertance_kg is missing: layout S2"),
        ("[front.strut]", "[front.strut]\ninertance_kg = 5", "layout S1 has none"),
        ("[front.strut]", '[front.strut]\nlayout = "X"', "layout is 'X': there are S1, S2"),
        ("damping_N_s_per_m = 1500", "", "damping_N_s_per_m is missing, or two damper tables"),
        ("damping_N_s_per_m = 1500", "damper_bump_m_per_s_N = [[0.1, 5]]", "one damper table"),
        ("damping_N_s_per_m = 1500", "damper_bump_m_per_s_N = [[100, 5]]", "did you mean mm/s"),
        ("stiffness_N_per_mm = 25", "stiffness_N_per_mm = 2.5", "yields 1.3 m under"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_said(old: str, new: str, said: str, tmp_path: Path) -> None:
    assert old in QUARTER
    with pytest.raises(CarError) as refused:
        own(QUARTER.replace(old, new), tmp_path)
    assert said in str(refused.value)
    assert str(refused.value).startswith(str(tmp_path / "car.toml"))
    assert "\n" not in str(refused.value)


def test_what_is_unusual_may_be_meant(tmp_path: Path) -> None:
    text = QUARTER.replace("wheel_mass_kg = 42", "wheel_mass_kg = 1.5")
    with pytest.raises(CarError, match="usual is 2 to 1000"):
        own(text, tmp_path)
    meant = text.replace("[car]", '[car]\nunusual = ["front.wheel_mass"]')
    assert own(meant, tmp_path).front.wheel_mass == 1.5


def test_commands_take_the_file(tmp_path: Path) -> None:
    path = tmp_path / "car.toml"
    path.write_text(QUARTER)
    run = CliRunner().invoke(
        app, ["optimize", "--car", str(path), "--layout", "S1,S3", "--index", "J1", "--json"]
    )
    assert run.exit_code == 0, run.output
    rows = json.loads(run.stdout)
    assert {row["stiffness"] for row in rows} == {25e3}
    # the closed form of S1: c = k sqrt((ms + mu) / kt)
    assert rows[0]["damping"] == pytest.approx(25e3 * np.sqrt(362.0 / 210e3), rel=1e-6)
    run = CliRunner().invoke(
        app,
        ["evaluate", "--car", str(path), "--layout", "S2", "--case", "ideal", "--index", "J1",
         "--seeds", "2", "--step", "0.002", "--json", "--out", str(tmp_path / "out")],
    )  # fmt: skip
    assert run.exit_code == 0, run.output
    (row,) = json.loads(run.stdout)["rows"]
    assert row["value"] == pytest.approx(row["exact"], rel=2e-3)
    for words, said in (
        (["--car", str(path), "--sprung-mass", "3"], "--sprung-mass: "),
        (["--stiffness", "60"], "did you mean 60e3, 60 kN/m?"),
    ):
        run = CliRunner().invoke(app, ["optimize", *words])
        assert run.exit_code == 2
        assert said in run.stderr


def test_inner_springs_may_not_carry_more_than_all(tmp_path: Path) -> None:
    car = own(QUARTER, tmp_path)
    strut = StrutParts(
        layout="SW7", stiffness=25e3, damping=1500.0, inertance=20.0,
        damper_stiffness=80e3, inerter_stiffness=80e3,
    )  # fmt: skip
    front = dataclasses.replace(car.front, strut=strut)
    with pytest.raises(ValueError, match="its inner springs carry 40000 N/m at rest"):
        car_mjcf(dataclasses.replace(car, front=front))


def test_the_device_of_a_car_file_is_a_baseline_for_its_record(tmp_path: Path) -> None:
    text = (
        "[car]\nkind = 'quarter'\nbody_mass_kg = 320\n[front]\nwheel_mass_kg = 42\n"
        "tyre_stiffness_kN_per_m = 210\n[front.strut]\nlayout = 'S6'\nstiffness_kN_per_m = 25\n"
        "damping_N_s_per_m = 961\ninertance_kg = 144\nrelaxation_stiffness_kN_per_m = 6.9\n"
    )
    path = tmp_path / "car.toml"
    path.write_text(text, encoding="utf-8")
    assert device_of_model(path).inertance == 144.0
    path.write_text(text.replace("kind = 'quarter'", "kind = 'boat'"), encoding="utf-8")
    with pytest.raises(DeviceError, match="boat"):
        device_of_model(path)
