"""Any configuration is simulated right or refused, and the same by every door.

The doors: `Device`, device.toml, MJCF. Right: the force that MuJoCo's sensor shows is the one that
the reference, which shares no code with it, has at the same motion and states.
"""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest
from configurations import Values, anything, meant, model_xml
from hypothesis import HealthCheck, assume, example, given, settings
from hypothesis import strategies as st
from inerter import Device, DeviceError, devices_of, parameters
from inerter.device_file import device_text, read_device
from inerter.engine_errors import SimulationError
from inerter.reference import ReferenceDevice
from inerter.rig import device_mjcf
from inerter.simulate.run import SimulatedRun, run_model

SETTINGS = settings(
    max_examples=100, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)


def by_python(values: Values) -> Device | str:
    try:
        return Device(**values)
    except DeviceError as error:
        return str(error)


def by_toml(values: Values, folder: Path) -> Device | str:
    lines = [
        f"{name} = {json.dumps(value) if isinstance(value, str) else repr(value)}"
        for name, value in values.items()
    ]
    path = folder / "device.toml"
    path.write_text("\n".join(["[device]", *lines]), encoding="utf-8")
    try:
        return read_device(path)
    except DeviceError as error:
        return str(error).removeprefix(f"{path}: ")


def mjcf(values: Values, states: int, option: str = "", rest: str = "") -> str:
    """A mass with a device and a sensor of it."""
    config = "".join(f'<config key="{k}" value="{v}"/>' for k, v in values.items())
    plugin = '<plugin name="d" instance="d" plugin="inerter.device"'
    return model_xml(
        f'{plugin} joint="x" actdim="{states}"/>',
        f'<instance name="d">{config}</instance>',
        option,
        f"<sensor>{plugin}/></sensor>{rest}",
    )


def by_mjcf(values: Values, states: int) -> mujoco.MjModel | str:
    try:
        return mujoco.MjModel.from_xml_string(mjcf(values, states))
    except ValueError as error:
        return str(error)


@SETTINGS
@given(values=anything())
@example(values={"inertance": 1e300})
@example(values={"friction": "dahl", "coulomb_force": 5e-324})
@example(values={"friction": "bouc_wen", "bw_stiffness": 1.0, "bw_exponent": 20.0})
def test_every_door_takes_and_refuses_the_same(values: Values, tmp_path: Path) -> None:
    told = by_python(values)
    by_file = by_toml(values, tmp_path)
    model = by_mjcf(values, told.nstate if isinstance(told, Device) else 0)
    if isinstance(told, Device):
        assert isinstance(by_file, Device), by_file
        assert by_file.given == told.given
        if isinstance(model, str):
            # in a model nothing may stand idle
            idle = "inertance is 0 kg, which is all that it acts on; state inertance"
            assert idle in model or "nothing is configured" in model
            assert told.inertance == 0
        else:
            assert devices_of(model)[0].device.given == told.given
        return
    assert by_file == told
    assert isinstance(model, str)
    assert told in model
    assert 'actuator "d"' in model or 'instance "d"' in model


@SETTINGS
@given(values=anything())
@example(values={"branch_stiffness_2": 1.0, "branch_damping_2": 1.0})
@example(values={"friction": "maxwell_slip", "slip_stiffness_2": 1.0, "slip_force_2": 1.0})
def test_a_refusal_names_a_key_and_what_to_do(values: Values) -> None:
    told = by_python(values)
    assume(isinstance(told, str))
    assert isinstance(told, str)
    assert "\n" not in told
    key = told.split()[0]
    assert key in {*parameters(), "friction", "gas_law"}, told
    # the range, or the other key that it has to fit
    advice = ("; give ", "; choose ", "; state ", "; remove it or choose ")
    assert any(word in told for word in advice), told
    if key in values and "out of range" in told:
        bounds = parameters()[key]
        assert bounds.meaning in told
        for bound in (bounds.lower, bounds.upper):
            assert not math.isfinite(bound) or f"{bound:g}" in told


ODD_VALUES = st.one_of(
    st.none(), st.text(max_size=8), st.binary(max_size=3), st.lists(st.floats(), max_size=2),
    st.complex_numbers(), st.integers(10**308, 10**330), st.booleans(),
)  # fmt: skip


@SETTINGS
@given(
    name=st.one_of(st.sampled_from([*parameters(), "friction"]), st.text(max_size=5)),
    value=ODD_VALUES,
)
def test_what_is_no_number_is_an_error_of_the_device(name: str, value: Any) -> None:
    told = by_python({name: value})
    if isinstance(told, str):
        assert "\n" not in told
    else:
        # a number after all
        assert name == "friction" or math.isfinite(getattr(told, name))


def simulated(path: Path) -> SimulatedRun | str:
    try:
        return run_model(path, 0.05, keyframe="pushed", rate=5e3)
    except SimulationError as error:
        return str(error)


@pytest.mark.parametrize("integrator", ["RK4", "Euler", "implicitfast", "discrete"])
@settings(SETTINGS, max_examples=25)
@given(values=meant(), speed=st.floats(0.05, 1.0))
@example(values={"inertance": 50.0, "viscous": 50.0, "damping_knee": 2.2e-309}, speed=1.0)
@example(
    values={
        "inertance": 50.0,
        "leak_damping": 1000.0,
        "leak_quadratic_damping": 2.2e-309,
        "series_stiffness": 1e5,
        "series_damping": 300.0,
    },
    speed=1.0,
)
def test_what_is_taken_is_simulated_right(
    values: Values, speed: float, integrator: str, tmp_path: Path
) -> None:
    """Along a run: finite, heat only grows, and at every instant the reference's force."""
    device, reference = Device(**values), ReferenceDevice(**values)
    option = f'integrator="{integrator}" timestep="2e-4"'
    path = tmp_path / "model.xml"
    key = f'<keyframe><key name="pushed" qvel="{speed}"/></keyframe>'
    path.write_text(mjcf(values, device.nstate, option, key))
    run = simulated(path)
    if isinstance(run, str):
        assert "diverged at t" in run
        return
    columns = run.devices[0].columns
    assert all(np.isfinite(column).all() for column in columns.values())
    heat = columns["dissipated_energy"]
    scale = 0.5 * (20 + device.inertance) * speed**2
    gives_energy = "force_map" in values and not values["force_map_passive"]
    assert gives_energy or np.diff(heat).min() > -1e-3 * scale
    if integrator != "RK4":
        # the others show the force of a whole step
        return
    x, v, a = (columns[name] for name in ("displacement", "velocity", "acceleration"))
    x = x + device.rest_length
    states = np.column_stack([columns[name] for name in device.state_names] or [np.zeros_like(x)])
    z = reference.state_argument(states)
    carried = reference.inertance_force(x, v, a, z)
    friction = reference.total_friction(x, v, a, z)
    size = np.abs(carried).max() + np.abs(friction).max() + np.abs(columns["force"]).max() + 1.0
    np.testing.assert_allclose(columns["friction_force"], friction, rtol=0, atol=1e-9 * size)
    np.testing.assert_allclose(
        columns["force"], reference.force(x, v, a, z), rtol=0, atol=1e-9 * size
    )


@SETTINGS
@given(values=meant(), delay=st.sampled_from([0.0, 1.25e-3]))
def test_a_device_survives_its_files(values: Values, delay: float, tmp_path: Path) -> None:
    """Device -> MJCF -> device, device -> device.toml -> device: bit by bit."""
    device = Device(**values)
    model = mujoco.MjModel.from_xml_string(device_mjcf(device))
    assert devices_of(model)[0].device.given == device.given
    (tmp_path / "device.toml").write_text(device_text(device, delay=delay), encoding="utf-8")
    assert read_device(tmp_path / "device.toml").given == device.given


@settings(SETTINGS, max_examples=40)
@given(values=meant(), live=st.booleans())
def test_a_model_survives_its_text(values: Values, live: bool) -> None:
    """MjSpec -> XML -> MjSpec, the device by `add_device` in it."""
    from inerter import add_device

    spec = mujoco.MjSpec.from_string(model_xml(""))
    keys = ("inertance",) if live and "series_stiffness" not in values else ()
    added = add_device(spec, "d", joint="x", live=keys, **values)
    first = spec.compile()
    text = spec.to_xml()
    again = mujoco.MjSpec.from_string(text)
    second = again.compile()
    one, other = added.of(first), added.of(second)
    assert other.device.given == one.device.given == Device(**values).given
    assert other.sensor == one.sensor
    assert other.act == one.act
    for key, value in one.stated(first).items():
        # the engine writes numerics with some digits
        expected = value if isinstance(value, str) else pytest.approx(value, rel=1e-5)
        assert other.stated(second)[key] == expected
    assert again.to_xml() == text
