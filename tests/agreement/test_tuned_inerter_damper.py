"""The MuJoCo frame with a tuned inerter damper against the reference and its closed form."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from inerter.models import model_path
from inerter.reference import (
    FRAME,
    FRAME_DEVICE,
    FloorDevice,
    ShearFrame,
    frame_modes,
    frame_state_matrix,
)
from scipy.linalg import expm
from shipped_runs import Array, compiled, error, path, stated

# file: the floors that the damper joins; between 1 and 3 lie two branches of the tree
PLACES = {"model.xml": (1, 3), "model_ground.xml": (0, 1)}
TIMES = np.arange(0, 2.0 + 1e-9, 0.02)
JOLT = {"floor_1": 0.445, "floor_2": 0.802, "floor_3": 1.0}


def frame(file: str) -> ShearFrame:
    lower, upper = PLACES[file]
    return ShearFrame(devices=(FloorDevice(lower=lower, upper=upper, device=FRAME_DEVICE),))


def state(data) -> Array:
    """As in the reference: floors, their rates, deflection and flywheel velocity."""
    return np.concatenate([data.qpos, data.qvel, data.act])


def rung(file: str) -> Array:
    """The free motion after a jolt, from the matrix exponential."""
    start = np.zeros(8)
    start[3:6] = list(JOLT.values())
    matrix = frame_state_matrix(frame(file))
    return np.array([expm(matrix * t) @ start for t in TIMES])


@pytest.mark.parametrize("file", PLACES)
def test_the_model_has_the_published_numbers(file: str) -> None:
    assert stated("tuned_inerter_damper", file, "damper") == {
        "inertance": FRAME.inertance,
        "series_stiffness": FRAME.series_stiffness,
        "series_damping": FRAME.series_damping,
        "rest_length": 1.2,
    }
    model = mujoco.MjModel.from_xml_path(str(model_path("tuned_inerter_damper", file)))
    for i in range(3):
        storey = model.tendon(f"storey_{i + 1}").id
        assert model.body(f"floor_{i + 1}").mass[0] == FRAME.storey_mass[i]
        assert model.tendon_stiffness[storey] == FRAME.storey_stiffness[i]
        assert model.tendon_damping[storey] == FRAME.storey_damping[i]
    assert model.tendon_length0[model.tendon("damper").id] == pytest.approx(1.2, abs=1e-14)


def test_modes_of_the_bare_frame() -> None:
    """Stiffness by differences of the engine's forces; frequencies as the reference's."""
    spec = mujoco.MjSpec.from_file(str(model_path("tuned_inerter_damper", "frame.xml")))
    model = spec.compile()
    data = mujoco.MjData(model)
    stiffness = np.empty((3, 3))
    for i in range(3):
        data.qpos[:] = np.eye(3)[i] * 1e-3
        mujoco.mj_forward(model, data)
        stiffness[:, i] = -data.qfrc_passive / 1e-3
    found = np.sqrt(np.linalg.eigvalsh(stiffness / 1000.0)) / (2 * np.pi)
    assert found == pytest.approx(frame_modes(frame("model.xml"))[0], rel=1e-12)
    assert found == pytest.approx([2.743, 7.686, 11.107], abs=5e-4)


@pytest.mark.parametrize("file", PLACES)
def test_free_motion(file: str) -> None:
    """RK4: of fourth order, 1e-6 at half a millisecond."""
    truth = rung(file)
    errors = [
        error(
            path(compiled("tuned_inerter_damper", file, "RK4", step), TIMES, state,
                 velocities=JOLT),
            truth,
        )
        for step in (2e-3, 1e-3, 5e-4)
    ]  # fmt: skip
    assert errors[2] < 1e-6
    assert np.all(np.array(errors[:2]) / errors[1:] > 14)


@pytest.mark.parametrize("file", PLACES)
def test_first_order_under_implicitfast(file: str) -> None:
    truth = rung(file)
    errors = []
    for step in (1e-3, 5e-4, 2.5e-4):
        model = compiled("tuned_inerter_damper", file, "implicitfast", step)
        errors.append(error(path(model, TIMES, state, velocities=JOLT), truth))
    assert errors[2] < 0.05
    assert 1.8 < errors[1] / errors[2] < 2.2


@pytest.mark.parametrize("file", PLACES)
def test_earthquake(file: str) -> None:
    """A pulse of the ground near the first mode; held over a step: second order."""

    def ground(t: float) -> float:
        return 3.0 * float(np.sin(2 * np.pi * 2.7 * t) * np.exp(-(((t - 0.8) / 0.3) ** 2)))

    result = frame(file).simulate(
        TIMES, ground_acceleration=ground, method="DOP853", rtol=1e-10, atol=1e-13
    )
    errors = []
    for step in (1e-3, 5e-4):
        model = compiled("tuned_inerter_damper", file, "RK4", step)
        found = path(model, TIMES, state, controls={"ground": ground})
        errors.append(error(found[:, :3], result.displacement))
    assert errors[1] < 1e-5
    assert errors[0] / errors[1] > 3.5


def test_the_damper_damps() -> None:
    """After three seconds the jolted frame has lost most of its motion, the bare one none."""

    def top(file: str) -> float:
        times = np.arange(0, 4.0 + 1e-9, 0.01)
        model = compiled("tuned_inerter_damper", file, "RK4", 1e-3)
        rows = path(model, times, lambda data: data.qpos, velocities=JOLT)
        return float(np.abs(rows[300:, 2]).max() / np.abs(rows[:100, 2]).max())

    assert top("frame.xml") > 0.98
    assert top("model.xml") < 0.05
