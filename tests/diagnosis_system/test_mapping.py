"""Columns find their actuators and sensors, or one error says what there is and what to do."""

from __future__ import annotations

from pathlib import Path

import mujoco
import pytest
from hidden_vehicles import Car, Road, record, write
from inerter.commands import app
from inerter.diagnose.vehicle.build import read_model
from inerter.diagnose.vehicle.mapping import MappingError, map_columns, read_options
from inerter.models import model_path
from typer.testing import CliRunner

CAR = model_path("quarter_car")
VEHICLE = ["road", "body_acceleration", "wheel_acceleration", "suspension_travel", "tyre_force"]


@pytest.fixture(scope="module")
def model() -> mujoco.MjModel:
    return read_model(CAR).model


def test_shipped_model_needs_no_option(model: mujoco.MjModel) -> None:
    found = map_columns(model, VEHICLE, {}, {})
    assert found.inputs == {"road": "road"}
    assert [(o.column, o.sensor, o.component) for o in found.outputs] == [
        ("body_acceleration", "body_acceleration", 2),
        ("wheel_acceleration", "wheel_acceleration", 2),
        ("suspension_travel", "suspension_travel", 0),
        ("tyre_force", "tyre_force", 0),
    ]
    # nobody knows the zero of an accelerometer, or the static part of a tyre's force
    assert [o.floating for o in found.outputs] == [True, True, False, False]
    assert [o.load for o in found.outputs] == [False, False, False, True]


def test_kind_decides_where_there_is_one_of_it() -> None:
    # the road is the only position actuator, the travel the only length of a tendon
    siblings = read_model(model_path("quarter_car", "model_siblings.xml")).model
    siblings_names = map_columns(siblings, ["road", "suspension_travel"], {}, {})
    assert siblings_names.outputs[0].sensor == "suspension_travel"
    half = read_model(model_path("half_car", "model_s2.xml")).model
    with pytest.raises(MappingError, match="no column drives an actuator"):
        map_columns(half, ["road", "body_acceleration"], {}, {})


def test_sensor_of_the_device_has_named_parts(model: mujoco.MjModel) -> None:
    found = map_columns(model, ["road", "F"], {}, {"F": "strut.friction"})
    assert found.outputs[0].component == 2
    with pytest.raises(MappingError, match="total, inertance, friction"):
        map_columns(model, ["road", "F"], {}, {"F": "strut.tension"})


WRONG = [
    (["road", "a"], {}, {}, "no column is compared with a sensor"),
    (["z", "body_acceleration"], {}, {}, "no column drives an actuator"),
    (["z", "a"], {"z": "raod"}, {}, "did you mean 'road'"),
    (["z", "a"], {"y": "road"}, {}, "no column 'y'"),
    (["road", "a"], {}, {"a": "acceleration"}, "no sensor 'acceleration'"),
    (["road", "a"], {}, {"a": "body_acceleration"}, r"3 components, write .x, .y or .z"),
    (["road", "z", "body_acceleration"], {"z": "road"}, {}, "two columns drive one actuator"),
]


@pytest.mark.parametrize(("columns", "inputs", "sensors", "said"), WRONG)
def test_what_cannot_be_mapped_is_told_in_one_line(
    model: mujoco.MjModel,
    columns: list[str],
    inputs: dict[str, str],
    sensors: dict[str, str],
    said: str,
) -> None:
    with pytest.raises(MappingError, match=said) as error:
        map_columns(model, columns, inputs, sensors)
    text = str(error.value)
    # which columns, actuators and sensors there are, and how to map them
    for part in ("columns: ", "actuators: road, strut", "sensors: body_acceleration", "--input"):
        assert part in text
    assert "\n" not in text


def test_options_are_pairs() -> None:
    assert read_options(["a=b", "c = d"], "input") == {"a": "b", "c": "d"}
    for wrong in (["a"], ["=b"], ["a=b", "a=c"]):
        with pytest.raises(MappingError, match="--sensor"):
            read_options(wrong, "sensor")


def _run(*arguments: str | Path) -> tuple[int, str]:
    result = CliRunner().invoke(app, ["diagnose", *map(str, arguments)])
    return result.exit_code, result.stderr


def test_command_refuses_and_writes_nothing(tmp_path: Path) -> None:
    run = write(record(Car(), Road(1, 2.0), "run"), tmp_path)
    out = tmp_path / "out"
    status, said = _run(run, "--model", CAR, "--input", "road=wheel", "--out", out)
    assert status == 2
    assert "no actuator 'wheel'" in said
    assert not out.exists()
    # a vehicle record needs a model, and a mapping too
    status, said = _run(run, "--out", out)
    assert status == 2
    assert "--model" in said
    assert not out.exists()
    status, said = _run(run, "--input", "road=road", "--out", out)
    assert status == 2
    assert "--model" in said
    assert not out.exists()


def test_model_without_a_device_is_refused(tmp_path: Path) -> None:
    run = write(record(Car(), Road(1, 2.0), "run"), tmp_path)
    status, said = _run(run, "--model", model_path("quarter_car", "model_s1.xml"))
    assert status == 2
    assert "no inerter.device" in said


def test_column_missing_in_one_run_is_named(tmp_path: Path) -> None:
    first = write(record(Car(), Road(1, 2.0), "run1"), tmp_path)
    other = write(record(Car(), Road(2, 2.0), "run2"), tmp_path, {"suspension_travel": "stroke"})
    status, said = _run(first, other, "--model", CAR, "--out", tmp_path / "out")
    assert status == 2
    assert "run2" in said
    assert "suspension_travel" in said
