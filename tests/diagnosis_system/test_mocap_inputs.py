"""A road or a table as a mocap body: driven as an actuator's control is, its tyre a tendon."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from inerter.blind_test.vehicle import vehicle_records
from inerter.blind_test.vehicle_model import vehicle_mjcf
from inerter.diagnose.vehicle.build import UserModel, model_of_text
from inerter.diagnose.vehicle.diagnosis import diagnose_system
from inerter.diagnose.vehicle.drive import make_drive
from inerter.diagnose.vehicle.mapping import MappingError, map_columns
from inerter.diagnose.vehicle.model import VehicleModel
from inerter.diagnose.vehicle.simulate import VehicleSimulator
from inerter.reference import HiddenVehicle, hide_in_vehicle


def on_table(case: HiddenVehicle, name: str = "road") -> UserModel:
    """The quarter-car of a case on a table that is a mocap body 1 m under its wheel."""
    text = vehicle_mjcf(case.stated)
    stiffness = case.stated.corners[0].tyre_stiffness
    text = re.sub(r'<position name="road"[^>]*/>', "", text)
    text = re.sub(r'<actuatorfrc name="tyre_force"[^>]*/>', "", text)
    table = f'<body name="{name}" mocap="true" pos="0 0 -0.7"><site name="plate"/></body>'
    spring = (
        f'<spatial name="tyre" stiffness="{stiffness!r}" springlength="1">'
        '<site site="plate"/><site site="lower"/></spatial>'
    )
    text = text.replace("</worldbody>", f"{table}</worldbody>")
    return model_of_text(text.replace("<tendon>", f"<tendon>{spring}"), Path("table.xml"))


def columns_of(case: HiddenVehicle) -> list[str]:
    return [name for name in case.runs[0] if name not in ("time", "tyre_force")]


def test_a_table_moves_the_model_as_a_road_actuator_does(effects_seed: int) -> None:
    case = hide_in_vehicle(effects_seed, (), vehicle="quarter", noise=0.0)
    record = vehicle_records(case)[0]
    found = []
    actuated = model_of_text(vehicle_mjcf(case.stated), Path("road.xml"))
    for user in (actuated, on_table(case)):
        channels = map_columns(user.model, columns_of(case), {}, {})
        user.with_inputs(channels.inputs.values())
        drive = make_drive(record, channels, float(user.model.opt.timestep))
        found.append(VehicleSimulator(user, channels, 1).outputs([VehicleModel()], drive)[0])
        assert user.parts.suspensions[0].wheel > 0
    # the length of the strut counts from another place where the model starts at rest
    apart = found[0] - found[1]
    assert np.max(np.abs(apart)) < 1e-6 * np.max(np.abs(found[0]))


@pytest.mark.long
def test_what_a_table_cannot_show_is_said_and_its_spring_is_tried(effects_seed: int) -> None:
    case = hide_in_vehicle(effects_seed, ("tyre_stiffness_error",), vehicle="quarter")
    user = on_table(case, "shaker")
    channels = map_columns(user.model, columns_of(case), {"road": "shaker.z"}, {})
    records = vehicle_records(case)
    found = diagnose_system(records, user, channels, threads=1)
    assert "mocap body no velocity" in found.verdict
    names = {name for each in found.findings for name in (each.effect, *each.members)}
    assert "tyre_stiffness_error" in names
    value = found.parameters["tyre_stiffness"]
    true = case.parameters["tyre_stiffness"]
    assert abs(value.value - true) < max(0.05 * true, 4 * value.stderr)
    assert "springlength" in (found.model_xml or "")


def test_inputs_that_are_not_there_are_named(effects_seed: int) -> None:
    case = hide_in_vehicle(effects_seed, (), vehicle="quarter")
    user = on_table(case, "shaker")
    for given, said in (
        ("shake", "did you mean 'shaker'"), ("shaker.w", "write .x, .y or .z"),
        ("sprung", "not one of mocap"),
    ):  # fmt: skip
        with pytest.raises(MappingError, match=said):
            map_columns(user.model, columns_of(case), {"road": given}, {})
