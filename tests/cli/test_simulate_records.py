"""The records of `inerter simulate` are true motions; a diagnosis finds what was simulated."""

from __future__ import annotations

import json
from pathlib import Path

import mujoco
import numpy as np
import polars as pl
import pytest
from inerter.device_in_model import device_of
from inerter.models import model_path
from inerter.records import read_records
from inerter.simulate.output import write_run
from inerter.simulate.record import device_csv
from inerter.simulate.run import run_model
from inerter.simulate.summary import summary
from simulate_models import EXTENSION, PULL, columns, device, oscillator, written
from test_diagnose_command import inerter

SINGLE_STAGE = ("Euler", "implicit", "implicitfast", "discrete")


# ------------------------------ what a sample is ------------------------------


def swing(integrator: str, step: float, folder: Path) -> float:
    """Largest error of x, v, a and F against the closed form, each relative to its amplitude."""
    xml = oscillator(device('tendon="rope"', inertance=13, rest_length=0.5), extra=PULL)
    path = written(folder, xml)
    run = run_model(
        path, 0.5, timestep=step, integrator=integrator, keyframe="0", rate=1 / step
    )  # fmt: skip
    omega = np.sqrt(3e4 / 33)
    x = 0.01 * np.cos(omega * run.time)
    truth = {
        "displacement": x,
        "velocity": -0.01 * omega * np.sin(omega * run.time),
        "acceleration": -(omega**2) * x,
        "force": -13 * omega**2 * x,
    }
    found = columns(run)
    return max(
        float(np.max(np.abs(found[name] - value)) / np.max(np.abs(value)))
        for name, value in truth.items()
    )


def test_rk4_is_the_closed_form(tmp_path: Path) -> None:
    assert swing("RK4", 1e-3, tmp_path) < 1e-6


@pytest.mark.parametrize("integrator", SINGLE_STAGE)
def test_the_four_columns_are_one_motion(tmp_path: Path, integrator: str) -> None:
    """Semi-implicit integrators: v and a are the centred differences of x, F the law's at them."""
    strut = device(
        'tendon="rope"', states=1, inertance=13, viscous=40, friction="dahl", coulomb_force=30,
        bristle_stiffness=1e5, rest_length=0.5,
    )  # fmt: skip
    path = written(tmp_path, oscillator(strut, extra=PULL))
    found = columns(run_model(path, 0.5, integrator=integrator, keyframe="pulled"))
    x, h = found["displacement"], 1e-3
    v, a = (x[2:] - x[:-2]) / (2 * h), (x[2:] - 2 * x[1:-1] + x[:-2]) / h**2
    assert np.allclose(found["velocity"][1:-1], v, atol=1e-10)
    assert np.allclose(found["acceleration"][1:-1], a, atol=1e-8)
    law = 13 * found["acceleration"] + 40 * found["velocity"] + 1e5 * found["friction_state"]
    assert np.allclose(found["force"], law, rtol=1e-12, atol=1e-9)
    assert np.allclose(found["friction_force"], 1e5 * found["friction_state"], atol=1e-9)


def test_under_rk4_the_record_is_the_sensor(tmp_path: Path) -> None:
    run = run_model(model_path("quarter_car", "scene.xml"), 0.3, keyframe="kerb")
    model = mujoco.MjModel.from_xml_path(str(model_path("quarter_car", "scene.xml")))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    place, rows = device_of(model, "strut"), []
    for _ in run.time:
        mujoco.mj_forward(model, data)
        rows.append(data.sensordata.copy())
        mujoco.mj_step(model, data)
    sensor = place.read(np.array(rows))
    names = {"force": "total", "inertance_force": "inertance", "friction_force": "friction"}
    names |= {name: name for name in ("stored_energy", "dissipated_energy")}
    for column, shown in names.items():
        assert np.allclose(columns(run)[column], sensor[shown], rtol=1e-9, atol=1e-9), column
    acceleration = sensor["inertance"] / place.device.inertance
    assert np.allclose(columns(run)["acceleration"], acceleration, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("integrator", ["RK4", "implicitfast"])
def test_the_run_is_that_of_a_plain_loop(tmp_path: Path, integrator: str) -> None:
    """Sampling, and the sensor that a device without one is given, change nothing."""
    strut = device(
        'tendon="rope"', states=1, inertance=13, friction="dahl", coulomb_force=30,
        bristle_stiffness=1e5, rest_length=0.5,
    )  # fmt: skip
    path = written(tmp_path, oscillator(strut, f'integrator="{integrator}"', extra=PULL))
    run = run_model(path, 0.4, keyframe="pulled", rate=200)
    model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    positions = []
    for _ in range(401):
        positions.append(data.qpos[0])
        mujoco.mj_step(model, data)
    assert np.array_equal(run.joints["x"], positions[::5])
    assert run.every == 5
    assert np.allclose(run.time, np.arange(81) * 5e-3, atol=1e-12)


WRAPPED = """
<mujoco>
  <option gravity="0 0 -9.81" timestep="2e-4" integrator="RK4"/>{extension}
  <worldbody>
    <site name="a" pos="0.3 0 0.4"/>
    <geom name="drum" type="cylinder" size="0.05 0.1" euler="90 0 0" pos="0.1 0 0.1"
          contype="0" conaffinity="0"/>
    <body><joint name="turn" type="hinge" axis="0 1 0"/>
      <geom type="capsule" size="0.02" fromto="0 0 0 0.4 0 -0.2" mass="2" contype="0"
            conaffinity="0"/>
      <site name="b" pos="0.4 0 -0.2"/>
    </body>
  </worldbody>
  <tendon><spatial name="rope"><site site="a"/>{wrap}<site site="b"/></spatial></tendon>
  <actuator>{device}</actuator>
</mujoco>"""


@pytest.mark.parametrize("wrap", ["", '<geom geom="drum"/>'])
def test_acceleration_of_a_tendon_that_turns(tmp_path: Path, wrap: str) -> None:
    xml = WRAPPED.format(
        extension=EXTENSION, wrap=wrap, device=device('tendon="rope"', viscous=0.5)
    )
    found = columns(run_model(written(tmp_path, xml), 0.5, rate=5000))
    second = np.diff(found["displacement"], 2) / (2e-4) ** 2
    error = np.abs(found["acceleration"][1:-1] - second)
    # where the rope meets or leaves the drum, its speed jumps between two samples
    outliers = np.count_nonzero(error > 1e-4 * np.median(np.abs(second)))
    assert 0 < outliers <= 8 if wrap else outliers == 0


def test_force_is_what_moves_the_bodies_between_two_branches(tmp_path: Path) -> None:
    path = model_path("quarter_car", "model_siblings.xml")
    t = np.arange(0, 1, 0.01)
    np.savetxt(tmp_path / "road.csv", np.c_[t, 10 * np.sin(9 * t)], delimiter=",",
               header="time,road[mm]", comments="")  # fmt: skip
    run = run_model(path, control=tmp_path / "road.csv")
    body = 181.75 * run.vehicle["body_acceleration"]
    assert np.abs(body + columns(run)["force"]).max() < 1e-9 * np.abs(body).max()
    travel = run.vehicle["suspension_travel"]
    assert np.allclose(travel, columns(run)["displacement"], atol=1e-12)
    assert run.vehicle["road"].max() == pytest.approx(0.01, rel=1e-3)


def test_a_series_element_shows_its_states(tmp_path: Path) -> None:
    strut = device(
        states=3, inertance=50, series_stiffness=2e5, series_damping=100, backlash=1e-4
    )  # fmt: skip
    path = written(tmp_path, oscillator(strut, 'integrator="implicitfast"', extra=PULL))
    run = run_model(path, 1.0, keyframe="pulled", timestep=2e-4, rate=5000)
    found = columns(run)
    assert list(run.devices[0].place.act) == [
        "series_deflection", "flywheel_velocity", "gap_position"
    ]  # fmt: skip
    # in contact the spring carries the force; the flywheel's momentum is its integral
    impulse = np.concatenate([[0], np.cumsum(found["force"][:-1] + found["force"][1:]) * 1e-4])
    momentum = 50 * found["flywheel_velocity"]
    assert np.abs(impulse - momentum).max() < 0.01 * np.abs(momentum).max()
    assert np.abs(found["gap_position"]).max() == pytest.approx(1e-4)
    write_run(run, tmp_path / "out")
    table = pl.read_csv(tmp_path / "out" / "strut.csv", comment_prefix="#")
    assert table.columns == list(found)
    assert np.array_equal(table["gap_position"].to_numpy(), found["gap_position"])


def test_live_parameters_are_read_from_the_model(tmp_path: Path) -> None:
    strut = device(inertance=0, friction="coulomb", coulomb_force=10, transition_velocity=1e-2)
    numeric = '<custom><numeric name="strut.coulomb_force" data="40"/></custom>'
    path = written(tmp_path, oscillator(strut, extra=PULL + numeric))
    run = run_model(path, 0.5, keyframe="pulled")
    assert np.abs(columns(run)["friction_force"]).max() == pytest.approx(40, rel=1e-3)
    assert summary(run)["devices"][0]["parameters"]["coulomb_force"] == 40
    assert "coulomb_force = 40 N" in device_csv(run, run.devices[0])


def test_a_hinge_says_its_units(tmp_path: Path) -> None:
    xml = oscillator(device('joint="turn"', inertance=2)).replace(
        '<site name="b"/>', '<joint name="turn" type="hinge"/><site name="b"/>'
    )
    run = run_model(written(tmp_path, xml), 0.01)
    assert "# on a hinge: read rad for m" in device_csv(run, run.devices[0])
    assert "\ntime,displacement[rad],force[N*m],velocity[rad/s]," in device_csv(run, run.devices[0])
    slide = run_model(written(tmp_path, oscillator(device(inertance=2))), 0.01)
    assert "hinge" not in device_csv(slide, slide.devices[0])


# ------------------------------ the round trip ------------------------------


def drive(folder: Path) -> Path:
    """A push of three tones and rests."""
    t = np.arange(0, 16, 2e-3)
    tones = ((200, 1.1, 0.0), (150, 2.3, 1.0), (100, 4.1, 2.0))
    push = sum(size * np.sin(2 * np.pi * f * t + phase) for size, f, phase in tones)
    path = folder / "push.csv"
    np.savetxt(path, np.c_[t, push], delimiter=",", header="time,push", comments="")
    return path


@pytest.mark.often("ideal")
@pytest.mark.parametrize("kind", ["ideal", "coulomb"])
def test_a_diagnosis_of_the_record_finds_what_was_simulated(tmp_path: Path, kind: str) -> None:
    keys = {"friction": "coulomb", "coulomb_force": 30, "transition_velocity": 1e-3}
    strut = device(
        'tendon="rope"', inertance=113, rest_length=0.5, **(keys if kind == "coulomb" else {})
    )
    path = written(tmp_path, oscillator(strut, 'integrator="implicitfast"', joint='damping="50"'))
    options = ("--control", drive(tmp_path), "--rate", "500", "--out", tmp_path / "run")
    done = inerter("simulate", path, *options)
    assert done.returncode == 0, done.stderr
    record = tmp_path / "run" / "strut.csv"
    done = inerter("diagnose", record, "--out", tmp_path / "diagnosis", "--json")
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert [warning for r in found["records"] for warning in r["warnings"]] == []
    assert found["baseline"]["device"]["inertance"] == pytest.approx(113, rel=0.01)
    if kind == "ideal":
        assert found["findings"] == []
        assert found["baseline"]["nrmse"] < 2e-3
    else:
        (finding,) = found["findings"]
        assert finding["effect"] == "coulomb_friction"
        assert finding["parameters"]["coulomb_force"]["value"] == pytest.approx(30, rel=0.02)


# ------------------------------ models ------------------------------


def test_a_run_in_which_nothing_moves_says_so(tmp_path: Path) -> None:
    path = written(tmp_path, oscillator(device(inertance=1), extra=PULL))
    (warning,) = run_model(path, 0.1).warnings
    assert "no device moved" in warning
    assert run_model(path, 0.1, keyframe="pulled").warnings == []


def test_warnings_are_of_the_integrator_that_runs(tmp_path: Path) -> None:
    """A bristle that RK4 could not resolve: implicitfast steps it exactly."""
    dahl = device(states=1, inertance=1, friction="dahl", coulomb_force=30, bristle_stiffness=1e7)
    path = written(tmp_path, oscillator(dahl, extra=PULL))
    assert run_model(path, 0.2, keyframe="0", integrator="implicitfast").warnings == []
    (warning,) = run_model(path, 0.2, keyframe="0", integrator="RK4").warnings
    assert "faster than RK4 resolves" in warning


def test_every_device_has_a_record_whatever_its_name(tmp_path: Path) -> None:
    keys = {"inertance": 2, "friction": "dahl", "coulomb_force": 1}
    actuators = (
        device(name="left/strut", states=1, **keys) + device(name="left strut", states=1, **keys)
        + device(states=1, **keys).replace(' name="strut"', "") + device(name="..", viscous=1)
    )  # fmt: skip
    run = run_model(written(tmp_path, oscillator(actuators, extra=PULL)), 0.1, keyframe="0")
    files = write_run(run, tmp_path / "out")
    records = ["left_strut.csv", "left_strut_2.csv", "device_2.csv", "device_3.csv"]
    assert files[:4] == records
    for name in records:
        (record,) = read_records(tmp_path / "out" / name)
        assert record.kind == "bench"
        assert record.warnings == ()
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == sorted(files)


def test_a_compiled_model_gives_the_same_record(tmp_path: Path) -> None:
    path = model_path("quarter_car", "scene.xml")
    model = mujoco.MjModel.from_xml_path(str(path))
    mujoco.mj_saveModel(model, str(tmp_path / "car.mjb"))
    first, second = (
        run_model(p, 0.2, keyframe="kerb") for p in (path, tmp_path / "car.mjb")
    )  # fmt: skip
    for name, values in columns(first).items():
        assert np.array_equal(columns(second)[name], values), name


def test_the_vehicle_record_can_be_read(tmp_path: Path) -> None:
    run = run_model(model_path("quarter_car", "scene.xml"), 0.5, keyframe="kerb")
    assert "vehicle/record.csv" in write_run(run, tmp_path)
    (record,) = read_records(tmp_path / "vehicle", "vehicle")
    assert set(record.channels()) == {
        "road", "body_acceleration", "wheel_acceleration", "suspension_travel", "tyre_force"
    }  # fmt: skip
    # the record of the device beside it is read alone
    assert [r.kind for r in read_records(tmp_path)] == ["bench"]
    assert record.tyre_force is not None
    assert record.wheel_acceleration is not None
    strut = columns(run)["force"]
    assert np.allclose(25 * record.wheel_acceleration, record.tyre_force + strut, atol=1e-6)


def test_gravity_is_not_an_acceleration_of_the_vehicle(tmp_path: Path) -> None:
    xml = """
<mujoco>
  <worldbody>
    <body name="car"><joint name="x" type="slide" axis="0 0 1"/><geom size="0.1"/></body>
    <body name="ground"><joint name="road" type="slide"/><geom size="0.1" pos="9 0 0"/></body>
  </worldbody>
  <sensor><framelinacc name="body_acceleration" objtype="body" objname="car"/></sensor>
</mujoco>"""
    run = run_model(written(tmp_path, xml), 0.1)
    assert np.allclose(run.vehicle["body_acceleration"], -9.81)
    assert run.devices == []


def test_every_car_writes_its_channels(tmp_path: Path) -> None:
    """Of a half- and a full car: each wheel's road, force and length, and the body's motions."""
    wheels = {"half_car": ("front", "rear"),
              "full_car": ("front_left", "front_right", "rear_left", "rear_right")}  # fmt: skip
    for name, places in wheels.items():
        run = run_model(model_path(name, "model.xml"), 0.05)
        expected = {"time", "heave", "pitch", "body_acceleration", "pitch_acceleration"}
        expected |= {f"{kind}_{place}" for kind in ("road", "tyre_force", "strut_length")
                     for place in places}  # fmt: skip
        if name == "full_car":
            expected |= {"roll", "roll_acceleration"}
        assert set(run.vehicle) == expected
        write_run(run, tmp_path / name)
        assert "tyre_force_" in (tmp_path / name / "vehicle/record.csv").read_text()
        assert set(summary(run)["vehicle"]) == expected - {"time"}


def test_the_half_cars_channels_are_one_motion(tmp_path: Path) -> None:
    """Newton and Euler from the channels alone: m z'' and I theta'' of the forces on the wheels."""
    time = np.arange(0, 1.0, 1e-3)
    bump = 0.01 * np.exp(-(((time - 0.3) / 0.05) ** 2))
    path = tmp_path / "road.csv"
    rows = {"time": time, "road_front": bump, "road_rear": np.roll(bump, 150)}
    pl.DataFrame(rows).write_csv(path)
    run = run_model(model_path("half_car", "model.xml"), control=path)
    found = run.vehicle
    dt = float(run.time[1] - run.time[0])
    for name, kind in (("heave", "body_acceleration"), ("pitch", "pitch_acceleration")):
        x = found[name]
        second = (x[2:] - 2 * x[1:-1] + x[:-2]) / dt**2
        assert found[kind][1:-1] == pytest.approx(second, abs=2e-3 * np.abs(second).max())
    assert np.abs(found["pitch"]).max() > 1e-3
    assert not run.warnings


def test_a_tyre_that_pulls_on_the_road_is_said(tmp_path: Path) -> None:
    """50 mm by half a metre at 30 km/h: more pull than the 2028 N that press the tyre at rest."""
    time = np.arange(0, 0.6, 1e-3)
    x = 30 / 3.6 * (time - 0.1)
    bump = np.where((x >= 0) & (x <= 0.5), 0.025 * (1 - np.cos(4 * np.pi * x)), 0.0)
    path = tmp_path / "road.csv"
    pl.DataFrame({"time": time, "road": bump}).write_csv(path)
    run = run_model(model_path("quarter_car", "model.xml"), control=path)
    assert run.vehicle["tyre_force"].min() < -3000.0
    (warning,) = run.warnings
    assert "2028 N press that tyre at rest" in warning
    text = model_path("quarter_car", "model.xml").read_text()
    limited = text.replace('kp="120e3"', 'kp="120e3" forcerange="-2028.2175 1e9"')
    (tmp_path / "model.xml").write_text(limited)
    run = run_model(tmp_path / "model.xml", control=path)
    assert run.vehicle["tyre_force"].min() == pytest.approx(-2028.2175)
    assert not run.warnings
