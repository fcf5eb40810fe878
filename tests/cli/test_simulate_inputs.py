"""Tables that drive a run of `inerter simulate`: joints, mocap bodies, controls, and bad ones."""

from __future__ import annotations

from pathlib import Path

import mujoco
import numpy as np
import pytest
from inerter.engine_errors import SimulationError
from inerter.simulate.inputs import read_inputs
from inerter.simulate.run import run_model
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline
from simulate_models import EXTENSION, columns, device, oscillator, written

SINGLE_STAGE = ("Euler", "implicit", "implicitfast", "discrete")


def test_an_imposed_joint_accelerates_what_hangs_on_it(tmp_path: Path) -> None:
    """A body that slides freely on a driven one stays where it is."""
    xml = f"""
<mujoco>
  <option gravity="0 0 0" timestep="1e-3" integrator="implicitfast"/>{EXTENSION}
  <worldbody>
    <body name="table"><joint name="road" type="slide" axis="0 0 1"/><geom size="0.1" mass="3"/>
      <body name="rider"><joint name="x" type="slide" axis="0 0 1"/><geom size="0.1" mass="7"/>
      </body>
    </body>
  </worldbody>
  <actuator>{device(inertance=1e-6)}</actuator>
</mujoco>"""
    t = np.arange(0, 1.001, 0.01)
    road = 20 * (1 - np.cos(2 * np.pi * t))
    np.savetxt(tmp_path / "table.csv", np.c_[1000 * t + 5e5, road], delimiter=",",
               header="time[ms],road[mm]", comments="")  # fmt: skip
    run = run_model(written(tmp_path, xml), control=tmp_path / "table.csv")
    assert run.time[-1] == pytest.approx(1.0)
    assert np.abs(run.joints["road"][::10] - road / 1e3).max() < 1e-12
    # the start at a given velocity is of first order in h
    assert np.abs(run.joints["road"] + run.joints["x"]).max() < 0.02 * 0.04
    expected = -0.02 * (2 * np.pi) ** 2 * np.cos(2 * np.pi * run.time)
    middle = slice(20, -20)
    assert np.abs(columns(run)["acceleration"] - expected)[middle].max() < 1e-3 * 0.8


@pytest.mark.parametrize(
    ("integrator", "within"), [("RK4", 1e-4), ("implicitfast", 5e-3), ("Euler", 5e-3)]
)
def test_what_hangs_on_a_light_base_does_not_move_it(
    tmp_path: Path, integrator: str, within: float
) -> None:
    """A storey of 1000 kg on a base of 10 kg sways as the ground that is prescribed makes it."""
    m, k, c = 1000.0, 1e5, 200.0
    xml = f"""
<mujoco>
  <option gravity="0 0 0" timestep="1e-3" integrator="{integrator}"/>{EXTENSION}
  <worldbody>
    <body name="base"><joint name="ground" type="slide" axis="1 0 0"/><geom size=".1" mass="10"/>
      <body name="floor" pos="0 0 3">
        <joint name="x" type="slide" axis="1 0 0" stiffness="{k}" damping="{c}"/>
        <geom size=".5" mass="{m}"/>
      </body>
    </body>
  </worldbody>
  <actuator>{device(inertance=1e-3)}</actuator>
</mujoco>"""
    t = np.arange(0, 4.001, 0.01)
    ground = 0.01 * np.sin(2 * np.pi * 1.5 * t) * np.minimum(t, 1) ** 3
    np.savetxt(tmp_path / "g.csv", np.c_[t, ground], delimiter=",", header="time,ground",
               comments="")  # fmt: skip
    run = run_model(written(tmp_path, xml), control=tmp_path / "g.csv")
    felt = CubicSpline(t, ground)
    sway = solve_ivp(
        lambda at, y: [y[1], -felt(at, 2) - (k * y[0] + c * y[1]) / m], (0, 4), [0.0, 0.0],
        rtol=1e-9, atol=1e-12, max_step=0.01, t_eval=run.time,
    ).y[0]  # fmt: skip
    assert np.abs(run.joints["x"] - sway).max() < within * np.abs(sway).max()


@pytest.mark.parametrize(
    ("unit", "size"),
    [("g", 9.80665), ("%g", 0.0980665), ("mg", 9.80665e-3), ("Gal", 0.01), ("gal", 0.01),
     ("m/s^2", 1.0), ("cm/s^2", 0.01), ("g_0", 9.80665)],
)  # fmt: skip
def test_the_ground_of_an_accelerogram_is_an_acceleration(
    tmp_path: Path, unit: str, size: float
) -> None:
    """Where the control of a motor along several masses says nothing of its quantity."""
    path = written(
        tmp_path,
        """
<mujoco><worldbody>
  <body><joint name="a" type="slide" axis="1 0 0"/><geom size=".1" mass="20"/></body>
  <body><joint name="b" type="slide" axis="1 0 0"/><geom size=".1" mass="30"/></body></worldbody>
  <tendon><fixed name="masses"><joint joint="a" coef="-20"/><joint joint="b" coef="-30"/></fixed>
  </tendon><actuator><motor name="ground" tendon="masses"/></actuator></mujoco>""",
    )
    model = mujoco.MjModel.from_xml_path(str(path))
    table = tmp_path / "quake.csv"
    table.write_text(f"time,ground[{unit}]\n0,0\n1,2\n")
    assert read_inputs(table, model).controls[0][-1] == pytest.approx(2 * size)
    for wrong, what in (("kg", "a mass"), ("gallon", "a volume")):
        table.write_text(f"time,ground[{wrong}]\n0,0\n1,2\n")
        with pytest.raises(SimulationError, match=f"'{wrong}' is {what}"):
            read_inputs(table, model)


def test_mocap_bodies_are_moved_and_what_they_cannot_do_is_told(tmp_path: Path) -> None:
    xml = f"""
<mujoco>
  <option gravity="0 0 0" timestep="1e-3"/>{EXTENSION}
  <worldbody>
    <body name="road" mocap="true"><geom size="0.1" contype="0" conaffinity="0"/>
      <site name="a"/></body>
    <body name="car" pos="0 0 1"><joint name="x" type="slide" axis="0 0 1"/>
      <geom size="0.1" mass="2"/><site name="b"/></body>
  </worldbody>
  <tendon><spatial name="rope"><site site="a"/><site site="b"/></spatial></tendon>
  <actuator>{device('tendon="rope"', stiffness=100, viscous=5, rest_length=1)}</actuator>
  <sensor><jointpos name="suspension_travel" joint="x"/></sensor>
</mujoco>"""
    (tmp_path / "up.csv").write_text("time,road.z\n0,0\n1,0.1\n2,0.1\n")
    run = run_model(written(tmp_path, xml), control=tmp_path / "up.csv")
    assert np.allclose(run.vehicle["road"], np.minimum(run.time, 1) * 0.1, atol=1e-12)
    assert run.joints["x"].max() > 0.05
    (warning,) = run.warnings
    assert "fixed to a mocap body" in warning


def test_controls_interpolate_and_end_values_hold(tmp_path: Path) -> None:
    path = written(tmp_path, oscillator(device(inertance=1)))
    (tmp_path / "c.csv").write_text("time,strut,force\n7,0,1\n8,10,1\n")
    run = run_model(path, 2.0, control=tmp_path / "c.csv")
    assert np.allclose(columns(run)["control_force"], 10 * np.minimum(run.time, 1), atol=1e-9)
    assert run.warnings == ["columns that drive nothing were left aside: force"]


@pytest.mark.parametrize("lag", [0.0, 0.05])
def test_a_command_is_recorded_and_the_force_follows_it(tmp_path: Path, lag: float) -> None:
    # the record's force is what the engine's sensor of the step shows, at the commanded damping
    damper = device(
        states=int(lag > 0), inertance=1, viscous=2, control="viscous", control_lower=1,
        control_upper=50, control_lag=lag,
    )  # fmt: skip
    path = written(tmp_path, oscillator(damper))
    (tmp_path / "c.csv").write_text("time,strut\n0,1\n1,30\n2,500\n")
    run = run_model(path, 2.0, control=tmp_path / "c.csv")
    found = columns(run)
    damping = np.clip(found["control_command"], 1, 50)
    assert found["control_command"].max() > 400
    if lag:
        damping = 2 + found["control_change"]
        assert found["control_change"].max() > 40
    expected = found["acceleration"] + damping * found["velocity"]
    assert np.allclose(found["force"], expected, atol=1e-9)


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ("t,push\n0,1\n1,2\n", "no column 'time'"),
        ("time,pusch\n0,1\n1,2\n", "column 'pusch' drives nothing in the model; it has actuators:"),
        ("time,force\n0,1\n1,2\n", "no column drives anything; it has actuators: push, strut; j"),
        ("time,push\n0,1\n0,2\n", "line 3: time does not increase"),
        ("time,push\n0,1\n1,\n", "line 3: column 'push' has no number"),
        ("time,push\n0,1\n1,a\n", "line 3: column 'push' has no number"),
        ("time,x[furlongs]\n0,0\n1,0\n", ""),
        ("time,push[lbf],strut[kgf]\n0,1,1\n1,2,1\n", ""),
        (
            "time,push[furlongs]\n0,1\n1,2\n",
            "'push[furlongs]': the control of actuator 'push' is a force",
        ),
        (
            "time,strut[mm]\n0,1\n1,2\n",
            "write for example one of: N, kN, lbf, kgf, or leave it out",
        ),
        ("time,strut[N*m]\n0,1\n1,2\n", "is a force, and 'N*m' is no unit of one"),
        ("time,x[N]\n0,1\n1,2\n", "the position of joint 'x' is a length"),
        ("time[mm],push\n0,1\n1,2\n", "column 'time[mm]': time is a time"),
        ("time,push[nonsense]\n0,1\n1,2\n", "unknown unit 'nonsense'"),
        ("time,push,push\n0,1,1\n1,2,2\n", "'push'"),
    ],
)
def test_tables_that_cannot_be_used(tmp_path: Path, table: str, words: str) -> None:
    path = written(tmp_path, oscillator(device(inertance=1)))
    (tmp_path / "c.csv").write_text(table)
    if not words:
        run_model(path, 0.01, control=tmp_path / "c.csv")
        return
    with pytest.raises(SimulationError) as caught:
        run_model(path, 0.01, control=tmp_path / "c.csv")
    assert words in str(caught.value)
    assert "c.csv" in str(caught.value)
