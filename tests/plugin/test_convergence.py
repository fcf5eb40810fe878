"""Does the quarter-car converge to the equations of motion, and how fast?"""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from plugin_models import (
    DAMPER,
    FRICTION,
    INERTANCE,
    INTEGRATORS,
    SPRUNG,
    STRUT,
    TYRE,
    UNSPRUNG,
    Law,
    plugin_actuator,
    quarter_car_truth,
    quarter_car_xml,
    simulate,
)
from scipy.linalg import expm

DURATION, EVERY = 0.4, 4e-3
STEPS = [2e-3 / 2**k for k in range(5)]
TIMES = np.arange(round(DURATION / EVERY) + 1) * EVERY


def errors(keys: dict, integrator: str, truth: np.ndarray) -> np.ndarray:
    """Largest error of the positions over the run, relative, for each step."""
    found = []
    for h in STEPS:
        xml = quarter_car_xml(
            plugin_actuator(keys), option=f'timestep="{h}" integrator="{integrator}"'
        )
        path = simulate(mujoco.MjModel.from_xml_string(xml), DURATION, round(EVERY / h))
        found.append(np.abs(path[:, :2] - truth[:, :2]).max() / np.abs(truth[:, :2]).max())
    return np.array(found)


@pytest.fixture(scope="module")
def truths() -> dict[str, np.ndarray]:
    return {name: quarter_car_truth(Law(name, p), TIMES) for name, p in FRICTION.items()}


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("law", FRICTION)
def test_the_error_falls_with_the_step(law: str, integrator: str, truths: dict) -> None:
    keys = {"inertance": INERTANCE, "friction": law, **FRICTION[law]}
    error = errors(keys, integrator, truths[law])
    order = np.log2(error[0] / error[-1]) / (len(STEPS) - 1)

    # RK4 loses its order where a law has a corner: |v| of the laws with memory
    memory = law in ("dahl", "lugre", "bouc_wen")
    expected = (1.8 if memory else 3.7) if integrator == "RK4" else 0.9
    assert order > expected, error
    if integrator != "RK4":
        assert np.all(np.diff(error) < 0), error
        # springs integrated implicitly (discrete) are damped, hence the larger error
        assert error[0] < (0.15 if integrator == "discrete" else 0.04)
    else:
        assert error[0] < 1e-4


def test_a_linear_strut_is_the_matrix_exponential() -> None:
    # m_u (zu'') + m_s (zu'' + x'') = -k_t zu;  m_s (zu'' + x'') + b x'' = -k x - c v
    mass = np.array([[UNSPRUNG + SPRUNG, SPRUNG], [SPRUNG, SPRUNG + INERTANCE]])
    a = np.zeros((4, 4))
    a[:2, 2:] = np.eye(2)
    a[2:] = np.linalg.solve(mass, [[-TYRE, 0, 0, 0], [0, -STRUT, 0, -DAMPER]])
    start = np.array([0, 0, 0.3, -0.3])
    truth = np.array([expm(a * t) @ start for t in TIMES])

    # everything in the device: inertance, damper and spring
    keys = {"inertance": INERTANCE, "viscous": DAMPER, "stiffness": STRUT}
    xml = quarter_car_xml(
        plugin_actuator(keys), stiffness=0, damping=0, option='timestep="1e-3" integrator="RK4"'
    )
    path = simulate(mujoco.MjModel.from_xml_string(xml), DURATION, 4)
    assert np.abs(path[:, :4] - truth).max() < 1e-7 * np.abs(truth).max()


# on a bristle: `test_load_on_bristle_in_engine`
@pytest.mark.parametrize("friction", ["none"])
def test_load_friction_converges(friction: str) -> None:
    width, load = 2e-2, 0.2
    p = FRICTION[friction]
    truth = quarter_car_truth(Law(friction, p), TIMES, load=load, width=width)
    keys = {
        "inertance": INERTANCE, "load_friction": load, "transition_velocity": width,
        "friction": friction, **p,
    }  # fmt: skip
    assert np.abs(truth - quarter_car_truth(Law(friction, p), TIMES)).max() > 1e-3
    for integrator, order, coarse in (("RK4", 1.8, 1e-4), ("implicitfast", 0.9, 0.04)):
        error = errors(keys, integrator, truth)
        assert np.log2(error[0] / error[-1]) / (len(STEPS) - 1) > order, error
        assert error[0] < coarse


@pytest.mark.parametrize("load", [0.0, 0.2])
def test_a_varying_inertance_converges(load: float) -> None:
    shape = {"gradient": 40.0, "curvature": 3000.0}
    truth = quarter_car_truth(Law("none"), TIMES, load=load, width=2e-2, **shape)
    keys = {
        "inertance": INERTANCE, "load_friction": load, "transition_velocity": 2e-2,
        **{f"inertance_{name}": value for name, value in shape.items()},
    }  # fmt: skip
    assert np.abs(truth - quarter_car_truth(Law("none"), TIMES)).max() > 1e-2
    for integrator, order, coarse in (("RK4", 1.8 if load else 3.7, 1e-4), ("Euler", 0.9, 0.04)):
        error = errors(keys, integrator, truth)
        assert np.log2(error[0] / error[-1]) / (len(STEPS) - 1) > order, error
        assert error[0] < coarse, error
