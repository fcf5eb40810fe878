"""Energy wherever the inertance lives, and how often a solve stopped, for programs to read."""

from __future__ import annotations

import inerter
import mujoco
import numpy as np
import pytest
from plugin_models import plugin_actuator

# the same two carriages on one rail: nested, where the engine's matrix holds the inertance, and
# side by side, where it cannot
NESTED = """<body><joint name="a" type="slide" axis="0 0 1" stiffness="90"/>
  <geom size="0.1" mass="3"/>
  <body pos="0 0 1"><joint name="b" type="slide" axis="0 0 1" stiffness="50"/>
  <geom size="0.1" mass="2"/></body></body>"""
APART = """<body><joint name="a" type="slide" axis="0 0 1"/><geom size="0.1" mass="3"/></body>
  <body pos="0 0 1"><joint name="b" type="slide" axis="0 0 1"/><geom size="0.1" mass="2"/></body>"""
MODEL = """
<mujoco>
  <extension><plugin plugin="inerter.device"/></extension>
  <option gravity="0 0 0" integrator="RK4" timestep="5e-4"><flag energy="enable" {flag}/></option>
  <worldbody>{bodies}</worldbody>
  <tendon><fixed name="strut">{joints}</fixed>{springs}</tendon>
  <actuator>{device}</actuator>
</mujoco>"""
ACROSS = '<joint joint="a" coef="-1"/><joint joint="b" coef="1"/>'
SPRINGS = f"""<fixed name="spring" stiffness="50">{ACROSS}</fixed>
  <fixed name="ground" stiffness="90"><joint joint="a" coef="1"/></fixed>"""


def carriages(nested: bool, keys: dict, states: int = 0, flag: str = "") -> mujoco.MjModel:
    return mujoco.MjModel.from_xml_string(
        MODEL.format(
            bodies=NESTED if nested else APART,
            joints='<joint joint="b" coef="1"/>' if nested else ACROSS,
            springs="" if nested else SPRINGS,
            device=plugin_actuator(
                keys, 'tendon="strut"', attributes=f'actdim="{states}"' if states else ""
            ),
            flag=flag,
        )
    )


def moving(nested: bool, model: mujoco.MjModel) -> mujoco.MjData:
    data = mujoco.MjData(model)
    data.qpos[:] = (0.1, -0.15) if nested else (0.1, -0.05)
    data.qvel[:] = (0.3, 0.5) if nested else (0.3, 0.8)
    mujoco.mj_forward(model, data)
    return data


LOSSLESS = {
    "inertance": ({"inertance": 7}, 0),
    "varying": ({"inertance": 7, "inertance_gradient": 0.8}, 0),
    "spring": ({"inertance": 7, "stiffness": 60}, 0),
    "elastic": ({"inertance": 7, "series_stiffness": 900}, 2),
}


@pytest.mark.parametrize("nested", [True, False], ids=["native", "coupled"])
@pytest.mark.parametrize("name", LOSSLESS)
def test_energy_is_kept_in_both_placements(name: str, nested: bool) -> None:
    keys, states = LOSSLESS[name]
    model = carriages(nested, keys, states)
    data = moving(nested, model)
    before = inerter.energy(model, data)
    parts = []
    for _ in range(400):
        mujoco.mj_step(model, data, 5)
        mujoco.mj_forward(model, data)
        now = inerter.energy(model, data)
        parts.append((now.kinetic, now.potential, now.devices))
        assert now.total == pytest.approx(before.total, rel=1e-9)
    assert np.ptp(np.array(parts), axis=0)[:2].min() > 0.1
    # where the engine's matrix holds the inertance there is nothing beside it
    assert (np.abs(np.array(parts)[:, 2]).max() < 1e-12) == (nested and name == "inertance")


def test_both_placements_have_the_same_energy() -> None:
    keys = {"inertance": 7, "stiffness": 60}
    found = [
        inerter.energy(model, moving(nested, model)).total
        for nested in (True, False)
        for model in [carriages(nested, keys)]
    ]
    assert found[0] == pytest.approx(found[1], rel=1e-12)
    speed, x = 0.5, -0.15
    by_hand = 0.5 * 3 * 0.3**2 + 0.5 * 2 * 0.8**2 + 0.5 * 7 * speed**2
    by_hand += 0.5 * 90 * 0.1**2 + 0.5 * (50 + 60) * x**2
    assert found[0] == pytest.approx(by_hand, rel=1e-12)


def test_energy_leaves_data_as_it_was() -> None:
    model = carriages(False, {"inertance": 7})
    data = moving(False, model)
    data.energy[:] = 1.0, 2.0
    inerter.energy(model, data)
    np.testing.assert_array_equal(data.energy, [1.0, 2.0])


@pytest.mark.parametrize("how", ["group", "all"])
@pytest.mark.parametrize("nested", [True, False], ids=["native", "coupled"])
@pytest.mark.parametrize("integrator", ["Euler", "implicitfast", "RK4"])
def test_matter_stays_when_actuation_is_disabled(integrator: str, nested: bool, how: str) -> None:
    """Inertance and viscous damping stay, friction, springs and states go: the same both times."""
    disabled = {"inertance": 7, "viscous": 1.5, "stiffness": 60, "friction": "coulomb",
                "coulomb_force": 4}  # fmt: skip
    plain = {"inertance": 7, "viscous": 1.5}
    paths = []
    for keys in (disabled, plain):
        model = carriages(nested, keys)
        model.opt.integrator = getattr(mujoco.mjtIntegrator, f"mjINT_{integrator.upper()}")
        if keys is disabled and how == "group":
            model.opt.disableactuator = 1
        elif keys is disabled:
            model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_ACTUATION)
        data = moving(nested, model)
        data.ctrl[:] = 30.0 if keys is disabled else 0.0
        path = []
        for _ in range(50):
            mujoco.mj_step(model, data)
            path.append(data.qpos.copy())
        paths.append(path)
    np.testing.assert_allclose(paths[0], paths[1], rtol=1e-10, atol=1e-13)


def test_states_rest_while_actuation_is_disabled() -> None:
    keys = {"inertance": 7, "series_stiffness": 900, "friction": "dahl", "coulomb_force": 3}
    model = carriages(False, keys, 3)
    data = moving(False, model)
    mujoco.mj_step(model, data, 20)
    states = data.act.copy()
    model.opt.disableactuator = 1
    mujoco.mj_step(model, data, 20)
    np.testing.assert_array_equal(data.act, states)


def test_solves_are_counted_and_reset() -> None:
    model = carriages(False, {"inertance": 7})
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 10)
    counts = inerter.solve_counts(model, data)["strut"]
    assert (counts.solves, counts.stops, counts.misfits) == (40, 0, 0)  # four stages a step
    mujoco.mj_resetData(model, data)
    assert inerter.solve_counts(model, data)["strut"].solves == 0
    native = carriages(True, {"inertance": 7})
    assert inerter.solve_counts(native, mujoco.MjData(native))["strut"].solves == 0


def test_data_of_another_model_is_told() -> None:
    model = carriages(False, {"inertance": 7})
    other = mujoco.MjModel.from_xml_string("<mujoco/>")
    for ask in (inerter.energy, inerter.solve_counts):
        with pytest.raises(ValueError, match="belongs to the model"):
            ask(model, mujoco.MjData(other))
