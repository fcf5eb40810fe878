"""The MuJoCo full car and the reference ODE, written apart, move alike."""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np
import pytest
from inerter.models import model_path
from inerter.reference import FULL_CAR, FullCar, corner_of
from shipped_runs import Array, compiled, error, path, stated

LAYOUTS = {"S1": "model_s1.xml", "S2": "model.xml", "S3": "model_s3.xml"}
CORNERS = ("front_left", "front_right", "rear_left", "rear_right")
BODY = ("heave", "pitch", "roll")
TIMES = np.arange(0, 1.0 + 1e-9, 0.01)
# so small that the geometry is linear to 1e-7: relative travel over the strut's length
SMALL = 1e-5
KERB = {
    "heave": 0.1, "pitch": 0.05, "roll": -0.1, "wheel_front_left": 0.1, "wheel_front_right": 0.5,
    "wheel_rear_left": -0.2, "wheel_rear_right": 0.0,
}  # fmt: skip


def coordinates(data) -> list[float]:
    """Heave, pitch, roll, wheels."""
    return [data.joint(name).qpos[0] for name in KERB]


def simulated(layout: str, integrator: str, step: float, scale: float = SMALL) -> Array:
    model = compiled("full_car", LAYOUTS[layout], integrator, step)
    kerb = {name: scale * value for name, value in KERB.items()}
    return path(model, TIMES, coordinates, velocities=kerb) / scale


def car(layout: str) -> FullCar:
    axles = {"front": FULL_CAR.front, "rear": FULL_CAR.rear}
    corners: Any = {name: corner_of(axles[name.split("_")[0]], layout) for name in CORNERS}
    return FullCar(**corners)


def result_columns(found) -> Array:
    return np.column_stack([found.heave, found.pitch, found.roll, found.wheel_displacement])


@pytest.fixture(scope="module")
def truth() -> dict[str, Array]:
    found = {}
    for layout in LAYOUTS:
        model = car(layout)
        state = np.zeros(model.nstate)
        state[7:14] = list(KERB.values())
        result = model.simulate(
            [lambda t: 0.0] * 4, TIMES, initial=state, method="DOP853", rtol=1e-10, atol=1e-13
        )
        found[layout] = result_columns(result)
    return found


@pytest.mark.parametrize(("layout", "file"), LAYOUTS.items())
def test_the_model_has_the_published_numbers(layout: str, file: str) -> None:
    model = mujoco.MjModel.from_xml_path(str(model_path("full_car", file)))
    body = model.body("sprung")
    assert body.mass[0] == FULL_CAR.body_mass
    for name in CORNERS:
        numbers = FULL_CAR.front if name.startswith("front") else FULL_CAR.rear
        wheel = model.body(f"wheel_{name}")
        assert wheel.mass[0] == numbers.wheel_mass
        place = [
            numbers.distance if name.startswith("front") else -numbers.distance,
            FULL_CAR.track / 2 if name.endswith("left") else -FULL_CAR.track / 2,
        ]
        assert wheel.pos[:2].tolist() == place
        assert model.actuator(f"road_{name}").gainprm[0] == numbers.tyre_stiffness
        expected = {"stiffness": numbers.stiffness, "rest_length": 0.55}
        expected["series_damping" if layout == "S3" else "viscous"] = numbers.damping
        if layout != "S1":
            expected["inertance"] = numbers.inertance
        assert stated("full_car", file, f"strut_{name}") == expected


def test_the_inertias_belong_to_their_axes() -> None:
    model = mujoco.MjModel.from_xml_path(str(model_path("full_car", "model_s1.xml")))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    full = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, full)
    at = [model.joint(name).dofadr[0] for name in BODY]
    expected = [FULL_CAR.body_mass, FULL_CAR.pitch_inertia, FULL_CAR.roll_inertia]
    np.testing.assert_allclose(full[np.ix_(at, at)], np.diag(expected), rtol=1e-12, atol=1e-9)


@pytest.mark.parametrize("layout", LAYOUTS)
def test_small_motions(layout: str, truth: dict[str, Array]) -> None:
    """RK4 at 1 ms on a smooth model: 2e-7 to 5e-7, of fourth order in the step."""
    assert error(simulated(layout, "RK4", 1e-3), truth[layout]) < 1e-6


@pytest.mark.parametrize("layout", LAYOUTS)
def test_first_order_under_implicitfast(layout: str, truth: dict[str, Array]) -> None:
    errors = [
        error(simulated(layout, "implicitfast", step), truth[layout]) for step in (1e-3, 5e-4)
    ]
    assert errors[1] < 0.02
    assert 1.8 < errors[0] / errors[1] < 2.2


def test_the_geometry_bends_in_proportion(truth: dict[str, Array]) -> None:
    """A real kerb, 0.5 m/s: 0.3 %, and ten times less at a tenth."""
    errors = [error(simulated("S2", "RK4", 1e-3, scale), truth["S2"]) for scale in (1.0, 0.1)]
    assert errors[0] < 0.006
    assert 8 < errors[0] / errors[1] < 12


def test_road() -> None:
    """A twist of the road, one bump for each wheel; held over a step: second order."""

    def bump(height: float, centre: float):
        return lambda t: height * SMALL * float(np.exp(-(((t - centre) / 0.08) ** 2)))

    roads = dict(
        zip(CORNERS, [bump(0.03, 0.3), bump(-0.02, 0.35), bump(0.03, 0.45), bump(0, 0)],
            strict=True),
    )  # fmt: skip
    result = car("S3").simulate(
        list(roads.values()), TIMES, method="DOP853", rtol=1e-10, atol=1e-17,
        breakpoints=[0.1, 0.3, 0.5],
    )  # fmt: skip
    errors = []
    for step in (1e-3, 5e-4):
        model = compiled("full_car", LAYOUTS["S3"], "RK4", step)
        drives = {f"road_{name}": road for name, road in roads.items()}
        found = path(model, TIMES, coordinates, controls=drives)
        errors.append(error(found, result_columns(result)))
    assert errors[1] < 1e-5
    assert errors[0] / errors[1] > 3.5
