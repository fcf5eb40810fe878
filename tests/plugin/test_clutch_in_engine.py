"""Clutches and leaks in a model: a clutching inerter damper, torque limiters, fluids that leak."""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np
import pytest
from inerter.plugin import load_plugin
from inerter.reference import ReferenceDevice
from scipy.integrate import solve_ivp

MASS, STIFFNESS, DAMPING, START = 40.0, 4000.0, 5.0, 0.05
SHAFT = {"inertance": 60.0, "series_stiffness": 2e6, "series_damping": 1500.0}
PAIRS: dict[str, tuple[dict[str, Any], dict[str, Any]]] = {
    "clutching inerter damper": (
        {**SHAFT, "clutch_force": 1e6, "clutch_asymmetry": 1.0},
        {**SHAFT, "clutch_force": 1e6, "clutch_asymmetry": -1.0},
    ),
    "limiters": ({**SHAFT, "clutch_force": 60.0}, {**SHAFT, "clutch_force": 100.0}),
    "leaks": (
        {"inertance": 60.0, "leak_damping": 300.0},
        {"inertance": 60.0, "leak_damping": 50.0, "leak_quadratic_damping": 2000.0},
    ),
    "leaks behind springs": (
        {"inertance": 60.0, "series_stiffness": 1e5, "leak_damping": 300.0},
        {"inertance": 60.0, "series_stiffness": 1e4, "series_damping": 50.0, "clutch_force": 30.0,
         "leak_damping": 300.0},
    ),
}  # fmt: skip
# steps of one stage are of the first order
ALLOWED = {"Euler": 3e-3, "implicit": 3e-3, "implicitfast": 3e-3, "discrete": 3e-2, "RK4": 1e-5}
SECONDS, EVERY = 2.0, 0.01


def element(device: dict[str, Any]) -> str:
    keys = "".join(f'<config key="{name}" value="{value}"/>' for name, value in device.items())
    return f'<plugin joint="x" plugin="inerter.device" actdim="3">{keys}</plugin>'


def built(pair: tuple[dict[str, Any], dict[str, Any]], integrator: str, step: float) -> Any:
    load_plugin()
    return mujoco.MjModel.from_xml_string(f"""
<mujoco>
  <extension><plugin plugin="inerter.device"/></extension>
  <option integrator="{integrator}" timestep="{step}" gravity="0 0 0"/>
  <worldbody>
    <body>
      <joint name="x" type="slide" axis="1 0 0" stiffness="{STIFFNESS}" damping="{DAMPING}"/>
      <geom size="0.1" mass="{MASS}" contype="0" conaffinity="0"/>
    </body>
  </worldbody>
  <actuator>{element(pair[0])}{element(pair[1])}</actuator>
</mujoco>""")


def moved(pair: Any, integrator: str, step: float) -> np.ndarray:
    model = built(pair, integrator, step)
    data = mujoco.MjData(model)
    data.qpos[0] = START
    found = []
    for i in range(round(SECONDS / step)):
        if i % round(EVERY / step) == 0:
            found.append(data.qpos[0])
        mujoco.mj_step(model, data)
    return np.array(found)


def solved(pair: Any) -> np.ndarray:
    """The same from the reference equations."""
    one, other = (ReferenceDevice(**device) for device in pair)

    def rates(_: float, y: np.ndarray) -> np.ndarray:
        x, v, first, second = y[0], y[1], y[2:5], y[5:8]
        force = float(one.force(x, v, 0.0, first)) + float(other.force(x, v, 0.0, second))
        moving = [v, -(STIFFNESS * x + DAMPING * v + force) / MASS]
        return np.concatenate([moving, one.state_rate(x, v, first), other.state_rate(x, v, second)])

    return solve_ivp(
        rates, (0.0, SECONDS), [START, *[0.0] * 7], method="Radau",
        t_eval=EVERY * np.arange(round(SECONDS / EVERY)), rtol=1e-8, atol=1e-10,
    ).y[0]  # fmt: skip


@pytest.mark.parametrize("name", PAIRS)
def test_every_integrator_follows_the_reference(name: str) -> None:
    true = solved(PAIRS[name])
    for integrator, allowed in ALLOWED.items():
        found = moved(PAIRS[name], integrator, 5e-4)
        assert np.abs(found - true).max() < allowed * START, integrator


@pytest.mark.parametrize("integrator", ["Euler", "implicitfast", "discrete"])
def test_no_step_is_too_long(integrator: str) -> None:
    """Where it slips the spring relaxes with k / c = 1333/s, which none of these steps resolves."""
    for name, pair in PAIRS.items():
        for step in (1e-2, 5e-3, 2e-3, 1e-3):
            found = moved(pair, integrator, step)
            assert np.abs(found).max() <= START * 1.001, (name, step)


def test_a_clutching_pair_takes_energy_that_an_inerter_gives_back() -> None:
    """Of the first second the rms swing: a clutched pair swings less than two inerters."""
    rigid = {key: value for key, value in SHAFT.items() if not key.startswith("clutch")}
    plain = {**rigid, "clutch_force": 1e9}
    free = moved((plain, plain), "implicitfast", 1e-3)
    clutched = moved(PAIRS["clutching inerter damper"], "implicitfast", 1e-3)
    assert np.std(clutched[100:]) < 0.8 * np.std(free[100:])
