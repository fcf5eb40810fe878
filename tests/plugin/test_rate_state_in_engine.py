"""Rate-and-state friction in the engine: a block breaks away the later, the longer it was held."""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np
import pytest
from inerter import Device, add_device

LAW: dict[str, Any] = {
    "inertance": 0.0, "friction": "rate_state", "coulomb_force": 20.0, "rate_effect": 0.01,
    "age_effect": 0.05, "rate_velocity": 1e-3, "age_distance": 1e-5, "transition_velocity": 1e-6,
}  # fmt: skip


def block(integrator: str, mass: float = 1.0, **more: Any) -> tuple[Any, Any, Any]:
    spec: Any = mujoco.MjSpec()
    spec.option.timestep, spec.option.gravity = 1e-3, [0, 0, 0]
    spec.option.integrator = getattr(mujoco.mjtIntegrator, f"mjINT_{integrator}")
    body = spec.worldbody.add_body(name="block")
    body.add_joint(name="x", type=mujoco.mjtJoint.mjJNT_SLIDE, axis=[1, 0, 0])
    body.add_geom(size=[0.1] * 3, mass=mass)
    added = add_device(spec, "d", Device(**{**LAW, **more}), joint="x")
    model = spec.compile()
    return model, mujoco.MjData(model), added


@pytest.mark.parametrize("integrator", ["EULER", "IMPLICIT", "IMPLICITFAST", "DISCRETE"])
def test_it_rests_ages_and_breaks_away_above_its_grown_level(integrator: str) -> None:
    peaks, ages = [], []
    for hold in (0.5, 5.0, 50.0):
        model, data, _ = block(integrator)
        for _ in range(round(hold / model.opt.timestep)):
            mujoco.mj_step(model, data)
        assert data.act[0] == pytest.approx(np.log1p(1e-3 * hold / 1e-5), rel=1e-9)
        # pulled harder and harder: it sticks, with nothing but creep
        while abs(data.qvel[0]) < 1e-4:
            age = data.act[0]
            data.qfrc_applied[0] += 0.02
            mujoco.mj_step(model, data)
        peaks.append(data.qfrc_applied[0])
        ages.append(age)
    np.testing.assert_allclose(np.diff(peaks), 20.0 * 0.05 * np.diff(ages), rtol=0.05)
    # the speed at which it counts as sliding
    creep = 0.01 * np.log(1e-4 / 1e-3)
    np.testing.assert_allclose(peaks, 20.0 * (1.0 + creep + 0.05 * np.array(ages)), rtol=0.02)


def test_a_block_at_rest_under_less_than_its_level_does_not_chatter() -> None:
    model, data, added = block("IMPLICITFAST", inertance=2.0)
    data.qvel[0] = 0.5
    data.qfrc_applied[0] = 8.0
    for _ in range(2000):
        mujoco.mj_step(model, data)
    speeds = []
    for _ in range(500):
        mujoco.mj_step(model, data)
        speeds.append(data.qvel[0])
    assert np.abs(speeds).max() < 1e-6
    mujoco.mj_forward(model, data)
    said = added.of(model).read(data.sensordata)
    assert said["friction"] == pytest.approx(8.0, abs=1e-3)


def test_it_slides_steadily_at_the_closed_form() -> None:
    # on a heavy mass at 0.2 m/s the friction is f_c (1 + (A - B) ln(v / v_0))
    model, data, added = block("IMPLICITFAST", mass=1e6)
    data.qvel[0] = 0.2
    for _ in range(200):
        mujoco.mj_step(model, data)
    mujoco.mj_forward(model, data)
    found = added.of(model).read(data.sensordata)["friction"]
    assert found == pytest.approx(20.0 * (1.0 - 0.04 * np.log(200.0)), rel=1e-6)


def test_rk4_stays_finite_where_the_age_is_too_quick_for_it(
    capfd: pytest.CaptureFixture[str],
) -> None:
    model, data, _ = block("RK4", transition_velocity=1e-2, mass=50.0)
    data.qvel[0] = 0.5
    for _ in range(200):
        mujoco.mj_step(model, data)
    assert np.isfinite(data.qvel).all()
    assert np.isfinite(data.act).all()
    assert 0.0 < data.qvel[0] < 0.5 - 0.2 * 0.5 * 20.0 / 50.0


def test_under_rk4_an_age_that_a_step_does_not_resolve_is_slowed_and_said(
    capfd: pytest.CaptureFixture,
) -> None:
    """20 m/s renew contacts of 10 um in half a microsecond; then it stops, and ages."""
    model, data, _ = block("RK4", transition_velocity=0.05)
    data.qvel[0] = 20.0
    for _ in range(2500):
        mujoco.mj_step(model, data)
        assert np.isfinite(data.qvel[0])
        assert abs(data.act[0]) < 30
    # braked by about 20 N for a second; contacts cannot be older than the run
    assert abs(data.qvel[0]) < 0.05
    assert data.act[0] < np.log1p(1e-3 * data.time / 1e-5) + 0.1
    assert "renewed faster than RK4 resolves" in "".join(capfd.readouterr())
