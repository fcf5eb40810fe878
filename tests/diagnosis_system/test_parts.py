"""Wheel, body, spring, damper and tyre are found by topology; what is written can be read back."""

from __future__ import annotations

from pathlib import Path

import mujoco
import numpy as np
import pytest
from hidden_vehicles import Car, Road, diagnose, record, write
from inerter.diagnose import diagnose as diagnose_files
from inerter.diagnose.vehicle.build import UserModel, read_model
from inerter.diagnose.vehicle.model import VehicleModel
from inerter.models import model_path

# file: (wheel, body, kind of spring, kind of damper) of every device
SHIPPED = {
    ("quarter_car", "model.xml"): [("unsprung", "sprung", "device", "device")],
    ("quarter_car", "model_siblings.xml"): [("unsprung", "sprung", "device", "device")],
    # the node between inerter and damper has no mass: the strut ends at the body
    ("quarter_car", "model_s3.xml"): [("unsprung", "sprung", "tendon", "tendon")],
    ("half_car", "model_s2.xml"): [
        ("wheel_front", "sprung", "device", "device"),
        ("wheel_rear", "sprung", "device", "device"),
    ],
}


def _user(model: str, file: str) -> UserModel:
    user = read_model(model_path(model, file))
    names = [user.model.actuator(i).name for i in range(user.model.nactuator)]
    user.with_roads([i for i, name in enumerate(names) if name.startswith("road")])
    return user


@pytest.mark.parametrize("shipped", SHIPPED)
def test_parts_of_shipped_vehicles(shipped: tuple[str, str]) -> None:
    user = _user(*shipped)
    found = [
        (
            user.model.body(part.wheel).name,
            user.model.body(part.body).name,
            part.spring and part.spring.kind,
            part.damper and part.damper.kind,
        )
        for part in user.parts.suspensions
    ]
    assert found == SHIPPED[shipped]
    assert len(user.parts.tyres) == len(found)
    assert user.parts.unknown == []


def test_device_of_a_building_is_no_suspension() -> None:
    user = read_model(model_path("tuned_inerter_damper"))
    user.with_roads([0])
    assert user.parts.suspensions == ()
    assert user.parts.unknown


def test_one_sided_damper_brakes_in_its_direction_alone() -> None:
    user = _user("quarter_car", "model.xml")
    change = VehicleModel({"strut.rebound_damping": 4000.0, "strut.bump_damping": 3000.0})
    model = user.compile(change)
    data = mujoco.MjData(model)

    def force(rate: float) -> float:
        data.qpos[:], data.qvel[:] = 0.0, (0.0, rate)
        mujoco.mj_forward(model, data)
        # what damps the travel: actuators and the engine's own damping of the device
        return float(data.qfrc_actuator[1] + data.qfrc_passive[1])

    assert force(0.1) == pytest.approx(-400.0)
    assert force(-0.1) == pytest.approx(300.0)


def test_tyre_cannot_pull_more_than_its_static_load() -> None:
    user = _user("quarter_car", "model.xml")
    model = user.compile(VehicleModel({"tyre:road.tyre_static_load": 2000.0}))
    data = mujoco.MjData(model)
    for road, force in ((-0.1, -2000.0), (-0.01, -1200.0), (0.1, 12000.0)):
        data.ctrl[0] = road
        mujoco.mj_forward(model, data)
        assert data.sensor("tyre_force").data[0] == pytest.approx(force)


def test_native_spring_and_damper_in_a_model_with_gravity(tmp_path: Path) -> None:
    # the same car: spring and damper are the tendon's, it stands on its tyre under gravity
    model = tmp_path / "car.xml"
    model.write_text(
        model_path("quarter_car").read_text().replace('gravity="0 0 0"', 'gravity="0 0 -9.81"')
        .replace('timestep="0.001"', 'timestep="0.002"')
        .replace('<config key="viscous" value="3705.4"/>', "")
        .replace('<config key="stiffness" value="120e3"/>', "")
        .replace(
            '<spatial name="strut"',
            '<spatial name="strut" stiffness="120e3" damping="3705.4" springlength="0.5"',
        )
    )  # fmt: skip
    runs = [
        write(record(Car(damping=3000.0), Road(70 + i, 4.0), f"run{i}"), tmp_path) for i in range(2)
    ]
    user = read_model(model)
    user.with_roads([0])
    spring = user.parts.suspensions[0].spring
    assert spring is not None
    assert spring.kind == "tendon"
    change = VehicleModel({"tendon:strut.stiffness": 1e5, "tendon:strut.damping": 3000.0})
    compiled = user.compile(change)
    assert compiled.tendon_stiffness[0] == 1e5
    assert compiled.tendon_damping[0] == 3000.0
    found = diagnose_files(runs, model=model)
    assert [finding.effect for finding in found.findings] == ["viscous_friction"]
    value = found.parameters["damping"]
    assert value.value == pytest.approx(3000.0, rel=0.01)
    assert found.json()["parameters"]["damping"]["stated"] == pytest.approx(3705.4)
    # the static travel is the model's own: it starts in equilibrium, and ends up nowhere else
    assert found.extended.rmse < 1.1 * found.noise_floor


def test_written_model_is_the_extended_one(tmp_path: Path) -> None:
    found = diagnose([record(Car(sprung_mass=200.0), Road(80 + i, 3.0), f"r{i}") for i in range(2)])
    path = tmp_path / "model.xml"
    path.write_text(found.model_xml)
    again = read_model(path)
    mass = again.model.body("sprung").mass[0]
    assert mass == pytest.approx(found.parameters["body_mass"].value, rel=1e-5)
    # its inertia went with its mass
    ratio = again.model.body("sprung").inertia / read_model(
        model_path("quarter_car")
    ).model.body("sprung").inertia  # fmt: skip
    assert np.allclose(ratio, mass / 181.75, rtol=1e-4)
