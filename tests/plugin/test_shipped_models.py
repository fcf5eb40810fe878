"""Do the shipped models load, and are they what their README says?"""

from __future__ import annotations

import re
from typing import Any

import mujoco
import numpy as np
import pytest
from inerter.models import model_names, model_path
from plugin_models import SPRUNG, TYRE, UNSPRUNG
from scipy.linalg import expm

FILES = [
    (name, path.name)
    for name in model_names()
    for path in sorted(model_path(name).parent.glob("*.xml"))
]


@pytest.mark.parametrize(("name", "file"), FILES)
def test_it_loads_and_runs(name: str, file: str) -> None:
    model = mujoco.MjModel.from_xml_path(str(model_path(name, file)))
    data = mujoco.MjData(model)
    if model.nkey:
        mujoco.mj_resetDataKeyframe(model, data, 0)
    for _ in range(100):
        mujoco.mj_step(model, data)
    assert np.isfinite(data.qpos).all()
    assert not any(warning.number for warning in data.warning)


@pytest.mark.parametrize("name", model_names())
def test_every_model_can_be_looked_at(name: str) -> None:
    """A scene with a light, at rest or started from its key, and a README that names each file."""
    scene = mujoco.MjModel.from_xml_path(str(model_path(name, "scene.xml")))
    assert scene.nlight
    assert scene.nkey
    text = model_path(name, "README.md").read_text(encoding="utf-8")
    for path in model_path(name).parent.glob("model*.xml"):
        if name != "test_rig":
            assert f"`{path.name}`" in text, path.name
    assert "**Provenance.**" in text
    assert "**What to look at.**" in text


@pytest.mark.parametrize("name", model_names())
def test_what_the_readme_shows_runs(name: str) -> None:
    text = model_path(name, "README.md").read_text(encoding="utf-8")
    for code in re.findall(r"```python\n(.*?)```", text, re.S):
        names: dict[str, Any] = {}
        exec(code, names)
        data = names["data"]
        assert np.isfinite(data.qpos).all()
        assert np.abs(data.qpos).max() > 1e-6
        assert not any(warning.number for warning in data.warning)


def test_what_is_not_there_is_named() -> None:
    with pytest.raises(ValueError, match="quarter_car, test_rig"):
        model_path("bicycle")
    with pytest.raises(ValueError, match=r"scene\.xml"):
        model_path("quarter_car", "model_s4.xml")


# mass, damping and stiffness over (zu, x) or, in S3, (zu, y, x); x = zs - zu, y of the device
K = 120e3
LAYOUTS = {
    "model_s1.xml": (0.0, 4981.0),
    "model_s2.xml": (128.57, 3705.4),
    "model_s3.xml": (366.52, 7544.2),
}


@pytest.mark.parametrize("file", LAYOUTS)
def test_a_quarter_car_is_the_matrix_exponential(file: str) -> None:
    b, c = LAYOUTS[file]
    if file == "model_s3.xml":
        mass = np.array([[UNSPRUNG + SPRUNG, 0, SPRUNG], [0, b, 0], [SPRUNG, 0, SPRUNG]])
        damping = c * np.array([[0, 0, 0], [0, 1, -1], [0, -1, 1]])
    else:
        mass = np.array([[UNSPRUNG + SPRUNG, SPRUNG], [SPRUNG, SPRUNG + b]])
        damping = c * np.diag([0, 1])
    n = len(mass)
    stiffness = np.diag([TYRE] + [0] * (n - 2) + [K])
    # the road is a step of 10 mm: rest about the new equilibrium, a constant state appended
    a = np.zeros((2 * n + 1, 2 * n + 1))
    a[:n, n:-1] = np.eye(n)
    a[n:-1, :n] = -np.linalg.solve(mass, stiffness)
    a[n:-1, n:-1] = -np.linalg.solve(mass, damping)
    a[n:-1, -1] = np.linalg.solve(mass, np.eye(n)[0] * TYRE * 0.01)
    start = np.zeros(2 * n + 1)
    start[-1] = 1

    model = mujoco.MjModel.from_xml_path(str(model_path("quarter_car", file)))
    data = mujoco.MjData(model)
    data.actuator("road").ctrl = 0.01
    truth, path = [], []
    for i in range(1, 501):
        mujoco.mj_step(model, data)
        if i % 10 == 0:
            truth.append((expm(a * i * 1e-3) @ start)[: 2 * n])
            path.append(np.concatenate([data.qpos, data.qvel]))
    # RK4 at 1 ms, with a damper that is fast against the wheel: 3e-6 to 1.2e-5
    assert np.abs(np.array(path) - truth).max() < 2e-5 * np.abs(truth).max()


def test_a_friction_strut_agrees_with_the_reference() -> None:
    from inerter.reference import QuarterCar, ReferenceDevice

    p: dict[str, Any] = {"coulomb_force": 40.0, "static_force": 60.0, "stribeck_velocity": 0.02}
    bristle: dict[str, Any] = {"bristle_stiffness": 5e4, "bristle_damping": 100.0}
    spec = mujoco.MjSpec.from_file(str(model_path("quarter_car")))
    config = dict(spec.plugins[0].config)
    spec.plugins[0].config = config | {"friction": "lugre"} | {
        key: str(value) for key, value in (p | bristle).items()
    }  # fmt: skip
    spec.actuator("strut").actdim = 1
    spec.option.timestep = 2.5e-4
    model = spec.compile()
    data = mujoco.MjData(model)

    def road(t: float) -> float:
        return 5e-3 * np.sin(2 * np.pi * 3 * t)

    # the control is held over a step of RK4: take the road at its middle, second order
    path = [np.zeros(2)]
    for i in range(1, 2001):
        data.actuator("road").ctrl = road(data.time + 1.25e-4)
        mujoco.mj_step(model, data)
        if i % 40 == 0:
            path.append(data.qpos.copy())
    car = QuarterCar(
        damping=3705.4,
        device=ReferenceDevice(inertance=128.57, friction="lugre", **p, **bristle),
    )
    result = car.simulate(road, np.arange(51) * 0.01)
    truth = np.stack([result.wheel_displacement, result.suspension_travel], axis=1)
    # RK4 at 1 ms, with a damper that is fast against the wheel: 3e-6 to 1.2e-5
    assert np.abs(np.array(path) - truth).max() < 2e-5 * np.abs(truth).max()
