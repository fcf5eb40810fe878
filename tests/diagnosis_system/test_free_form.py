"""Any columns and any MJCF with a device in it: a joint of a robot, a half-car on two posts."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hidden_vehicles import Road, noisy
from inerter.diagnose import diagnose
from inerter.diagnose.vehicle import SystemDiagnosis
from inerter.models import model_path
from inerter.records import RecordError
from inerter.records.free_form import column_names, read_free_form
from inerter.records.stated import reading
from inerter.reference import Corner, HalfCar, ReferenceDevice, Strut
from scipy.integrate import solve_ivp

# a pendulum with a flywheel geared to its joint, driven by a torque
ARM = """
<mujoco model="arm">
  <compiler angle="radian"/>
  <option timestep="0.002" integrator="implicitfast"/>
  <extension><plugin plugin="inerter.device"/></extension>
  <worldbody>
    <body name="arm">
      <joint name="elbow" type="hinge" axis="0 1 0" damping="0.05"/>
      <inertial pos="0 0 -0.3" mass="2" diaginertia="0.02 0.02 0.001"/>
    </body>
  </worldbody>
  <actuator>
    <motor name="torque" joint="elbow"/>
    <plugin name="flywheel" plugin="inerter.device" joint="elbow">
      <config key="inertance" value="0.3"/>
    </plugin>
  </actuator>
  <sensor>
    <jointpos name="angle" joint="elbow"/>
    <jointvel name="rate" joint="elbow"/>
  </sensor>
</mujoco>
"""


def _arm_runs(folder: Path, quadratic: float) -> list[Path]:
    """Runs of the arm, in degrees, with quadratic drag in the flywheel."""
    inertia, weight = 0.02 + 2 * 0.3**2 + 0.3, 2 * 9.81 * 0.3
    paths = []
    for i in range(3):
        drive = Road(40 + i, 6.0, amplitude=2.5, top=2.0)

        def rates(t: float, y: np.ndarray, drive: Road = drive) -> list[float]:
            drag = 0.05 * y[1] + quadratic * y[1] * abs(y[1])
            return [y[1], (drive(t) - drag - weight * np.sin(y[0])) / inertia]

        times = np.arange(0, 6, 0.01)
        run = solve_ivp(rates, (0, 6), [0, 0], t_eval=times, rtol=1e-8, atol=1e-10, max_step=0.01)
        random = np.random.default_rng(i)
        table = np.column_stack(
            [times, [drive(t) for t in times], np.rad2deg(noisy(run.y[0], 0.01, random))]
        )
        paths.append(folder / f"swing{i}.csv")
        np.savetxt(paths[-1], table, "%.9g", ",", header="time,M[N*m],phi[deg]", comments="")
    return paths


LOGGED = "Zeit [ms];Fahrbahn [mm];a_achse [g]\n" + "".join(
    f"{10 * i},0;{i % 7},5;0,{i % 10}\n" for i in range(60)
)


def test_a_logger_names_time_and_road_its_own_way(tmp_path: Path) -> None:
    path = tmp_path / "fahrt.csv"
    path.write_text(LOGGED)
    with pytest.raises(RecordError, match=r"no column 'time'.*--column time='Zeit .ms."):
        read_free_form([path], ["a_achse"])
    with reading(["time=Zeit [ms]", "road=Fahrbahn [mm]"]):
        assert column_names([path]) == ["road", "a_achse"]
        (found,) = read_free_form([path], ["road", "a_achse"], {"a_achse": "m/s^2"})
    assert found.time == pytest.approx(0.01 * np.arange(60))
    channels = found.channels()
    assert channels["road"] == pytest.approx(1e-3 * (np.arange(60) % 7 + 0.5))
    assert channels["a_achse"] == pytest.approx(0.980665 * (np.arange(60) % 10))


def test_a_road_in_volts_and_a_time_that_is_counted_are_stated(tmp_path: Path) -> None:
    path = tmp_path / "drive.csv"
    path.write_text("laser [V],axle\n" + "".join(f"{0.5 + 0.1 * (i % 9)},{i}\n" for i in range(60)))
    with reading(["time=every 5 ms", "road=20 mm/V * (laser - 0.5 V)"]):
        (found,) = read_free_form([path], ["road", "axle"])
    assert found.time == pytest.approx(0.005 * np.arange(60))
    assert found.channels()["road"] == pytest.approx(2e-3 * (np.arange(60) % 9))


def test_a_delay_of_a_column_is_not_taken_without_a_word(tmp_path: Path) -> None:
    path = tmp_path / "fahrt.csv"
    path.write_text(LOGGED)
    (tmp_path / "records.toml").write_text(
        '[[files]]\n[files.columns]\ntime = "Zeit [ms]"\n'
        'road = {column = "Fahrbahn", unit = "mm", delay = "2 ms"}\n'
    )
    with pytest.raises(RecordError, match="a delay and a filter of a column are stated of bench"):
        read_free_form([path], ["road", "a_achse"])


@pytest.mark.parametrize("unit", ["mm", "m/s", "kN", "furlong"])
def test_a_column_has_a_unit_of_what_the_sensor_gives(unit: str, tmp_path: Path) -> None:
    path = tmp_path / "drive.csv"
    rows = "".join(f"{0.01 * i:.2f},{i % 5}\n" for i in range(60))
    path.write_text(f"time,axle[{unit}]\n{rows}")
    with pytest.raises(RecordError, match=r"axle.*is no unit of .* m/s\^2; correct the unit"):
        read_free_form([path], ["axle"], {"axle": "m/s^2"})
    # of a sensor without a known unit any is taken
    assert read_free_form([path], ["axle"])[0].samples == 60


def test_joint_of_a_robot_with_mapped_columns(tmp_path: Path) -> None:
    model = tmp_path / "arm.xml"
    model.write_text(ARM)
    runs = _arm_runs(tmp_path, quadratic=0.1)
    found = diagnose(runs, model=model, inputs=["M=torque"], sensors=["phi=angle"])
    assert [finding.effect for finding in found.findings] == ["quadratic_damping"]
    assert found.findings[0].parameters["quadratic_damping"].value == pytest.approx(0.1, rel=0.03)
    assert found.extended.json()["channels"]["phi"]["unit"] == "rad"
    assert found.extended.rmse < 0.013
    # no vehicle here, and the result says so
    assert "no wheel" in found.verdict


@pytest.mark.long
def test_half_car_with_two_roads(tmp_path: Path) -> None:
    # the rear strut of the shipped half-car has Coulomb friction; columns have their own names
    def corner(which: str, **device: Any) -> Corner:
        data = {"front": (1.011, 40.0, 19960.0, 1290.0), "rear": (1.803, 35.5, 17500.0, 1690.0)}
        distance, wheel, stiffness, damping = data[which]
        inerter = ReferenceDevice(inertance=30.0, **device)
        strut = Strut(layout="S2", stiffness=stiffness, damping=damping, device=inerter)
        return Corner(distance=distance, wheel_mass=wheel, tyre_stiffness=175500.0, strut=strut)

    car = HalfCar(
        front=corner("front"), rear=corner("rear", friction="coulomb", coulomb_force=60.0)
    )
    paths = []
    for i in range(2):
        roads = [Road(50 + i, 4.0, 0.1, 15.0), Road(60 + i, 4.0, 0.1, 15.0)]
        times = np.arange(0, 4, 0.005)
        run = car.simulate(roads, times, rtol=1e-6, atol=1e-8, max_step=0.01)
        random = np.random.default_rng(i)
        columns = {
            "time": times,
            "left_post": np.array([roads[0](t) for t in times]),
            "right_post": np.array([roads[1](t) for t in times]),
            "az[g]": noisy(run.heave_acceleration, 0.01, random) / 9.80665,
            "front[mm]": 1000 * run.suspension_travel[:, 0],
            "rear[mm]": 1000 * run.suspension_travel[:, 1],
        }
        paths.append(tmp_path / f"rig{i}.csv")
        table = np.column_stack(list(columns.values()))
        np.savetxt(paths[-1], table, "%.9g", ",", header=",".join(columns), comments="")
    model = tmp_path / "car.xml"
    # a step of 2 ms, and travel counted from the struts' length at rest
    text = f'<mujoco><include file="{model_path("half_car", "model_s2.xml")}"/>'
    model.write_text(
        text + '<option timestep="0.002"/><sensor>'
        '<actuatorpos name="front" actuator="strut_front"/>'
        '<actuatorpos name="rear" actuator="strut_rear"/></sensor></mujoco>'
    )
    found = diagnose(
        paths,
        model=model,
        inputs=["left_post=road_front", "right_post=road_rear"],
        sensors=["az=body_acceleration.z"],
    )
    assert found.findings[0].effect == "coulomb_friction"
    force = found.findings[0].parameters["strut_rear.coulomb_force"]
    assert force.value == pytest.approx(60.0, rel=0.05)
    assert isinstance(found, SystemDiagnosis)
    assert set(found.devices) == {"strut_front", "strut_rear"}
    assert "in strut_rear" in found.verdict
