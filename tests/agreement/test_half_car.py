"""The MuJoCo half-car and the reference ODE, written apart, move alike."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from inerter.models import model_path
from inerter.reference import HALF_CAR, HalfCar, corner_of
from shipped_runs import Array, compiled, configuration, error, path, stated

AXLES = {"front": HALF_CAR.front, "rear": HALF_CAR.rear}
LAYOUTS = {"S1": "model_s1.xml", "S2": "model.xml", "S3": "model_s3.xml"}
TIMES = np.arange(0, 1.5 + 1e-9, 0.01)
# so small that the geometry is linear to 1e-7: relative travel over the strut's length
SMALL = 1e-5
KERB = {"wheel_front": 0.5, "wheel_rear": -0.2, "heave": 0.1, "pitch": 0.05}


def coordinates(data) -> list[float]:
    """Heave, pitch, wheels."""
    return [data.joint(name).qpos[0] for name in ("heave", "pitch", "wheel_front", "wheel_rear")]


def simulated(layout: str, integrator: str, step: float, scale: float = SMALL) -> Array:
    model = compiled("half_car", LAYOUTS[layout], integrator, step)
    kerb = {name: scale * value for name, value in KERB.items()}
    return path(model, TIMES, coordinates, velocities=kerb) / scale


def car(layout: str) -> HalfCar:
    return HalfCar(front=corner_of(HALF_CAR.front, layout), rear=corner_of(HALF_CAR.rear, layout))


def result_columns(found) -> Array:
    return np.column_stack([found.heave, found.pitch, found.wheel_displacement])


@pytest.fixture(scope="module")
def truth() -> dict[str, Array]:
    found = {}
    for layout in LAYOUTS:
        model = car(layout)
        state = np.zeros(model.nstate)
        state[4:8] = [KERB[name] for name in ("heave", "pitch", "wheel_front", "wheel_rear")]
        result = model.simulate(
            [lambda t: 0.0] * 2, TIMES, initial=state, method="DOP853", rtol=1e-11, atol=1e-14
        )
        found[layout] = result_columns(result)
    return found


@pytest.mark.parametrize(("layout", "file"), LAYOUTS.items())
def test_the_model_has_the_published_numbers(layout: str, file: str) -> None:
    model = mujoco.MjModel.from_xml_path(str(model_path("half_car", file)))
    body = model.body("sprung")
    assert body.mass[0] == HALF_CAR.body_mass
    # the principal axes are the body's, in whatever order
    assert sorted(body.inertia)[1] == HALF_CAR.pitch_inertia
    for axle, numbers in AXLES.items():
        wheel = model.body(f"wheel_{axle}")
        assert wheel.mass[0] == numbers.wheel_mass
        assert abs(wheel.pos[0]) == numbers.distance
        assert np.sign(wheel.pos[0]) == (1 if axle == "front" else -1)
        assert model.actuator(f"road_{axle}").gainprm[0] == numbers.tyre_stiffness
        expected = {"stiffness": numbers.stiffness, "rest_length": 0.55}
        expected["series_damping" if layout == "S3" else "viscous"] = numbers.damping
        if layout != "S1":
            expected["inertance"] = numbers.inertance
        assert stated("half_car", file, f"strut_{axle}") == expected
        assert model.tendon_length0[model.tendon(f"strut_{axle}").id] == pytest.approx(
            0.55, abs=1e-15
        )


def test_s2_is_the_model() -> None:
    assert configuration("half_car", "model_s2.xml", "strut_front") == configuration(
        "half_car", "model.xml", "strut_front"
    )


@pytest.mark.parametrize("layout", LAYOUTS)
def test_small_motions(layout: str, truth: dict[str, Array]) -> None:
    """RK4 at 1 ms on a smooth model: 2e-7 to 4e-7, of fourth order in the step."""
    assert error(simulated(layout, "RK4", 1e-3), truth[layout]) < 1e-6


@pytest.mark.parametrize("layout", LAYOUTS)
def test_first_order_under_implicitfast(layout: str, truth: dict[str, Array]) -> None:
    errors = [
        error(simulated(layout, "implicitfast", step), truth[layout]) for step in (1e-3, 5e-4)
    ]
    assert errors[1] < 0.02
    assert 1.8 < errors[0] / errors[1] < 2.2


def test_the_geometry_bends_in_proportion(truth: dict[str, Array]) -> None:
    """A real kerb, 0.5 m/s: 0.07 %, and ten times less at a tenth."""
    errors = [error(simulated("S2", "RK4", 1e-3, scale), truth["S2"]) for scale in (1.0, 0.1)]
    assert errors[0] < 0.002
    assert 8 < errors[0] / errors[1] < 12


@pytest.mark.parametrize("layout", LAYOUTS)
def test_road(layout: str) -> None:
    """A bump under the front, 0.1 s later under the rear; held over a step: second order."""

    def front(t: float) -> float:
        return 0.03 * SMALL * float(np.exp(-(((t - 0.3) / 0.08) ** 2)))

    def rear(t: float) -> float:
        return front(t - 0.1)

    result = car(layout).simulate(
        [front, rear], TIMES, method="DOP853", rtol=1e-10, atol=1e-17, breakpoints=[0.1, 0.3, 0.5]
    )
    errors = []
    for step in (1e-3, 5e-4):
        model = compiled("half_car", LAYOUTS[layout], "RK4", step)
        found = path(model, TIMES, coordinates, controls={"road_front": front, "road_rear": rear})
        errors.append(error(found, result_columns(result)))
    assert errors[1] < 1e-5
    assert errors[0] / errors[1] > 3.5
