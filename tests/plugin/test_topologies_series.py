"""Is a series element right between branches, with every integrator and stiffness?

Wheel and car as siblings, a series element before the inertance: x = zs - zu, y = x - s, w = y',
u = c x' + k x + F_s, F_s = k_s s + c_s s', b w' = F_s.
"""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from plugin_models import INTEGRATORS
from scipy.integrate import solve_ivp
from topology_mechanisms import Array
from topology_models import (
    CAR,
    INERTANCE,
    STRUT,
    TYRE,
    WHEEL,
    linear_motion,
    mjcf,
    quarter_car,
    slide,
)

TIMES = np.arange(0, 0.4001, 0.02)
START = np.array([0, 0, 0.3, 0.0])
SPRING, SERIES_DAMPER, BESIDE = 8e4, 300.0, 1500.0


def car(
    integrator: str, h: float, *, flywheel: float = 0.0, **keys: float
) -> tuple[mujoco.MjModel, mujoco.MjData]:
    """The siblings with a strut spring and a device, whose flywheel has a velocity."""
    world = slide("wheel", WHEEL, 0, f'stiffness="{TYRE}"') + slide("car", CAR, 1)
    tendon = f"""<fixed name="strut" stiffness="{STRUT}"><joint joint="wheel" coef="-1"/>
      <joint joint="car" coef="1"/></fixed>"""
    xml = mjcf(world, tendon, [({"inertance": INERTANCE, "viscous": BESIDE, **keys},
                                'tendon="strut"')])  # fmt: skip
    option = f'timestep="{h}" integrator="{integrator}"'
    model = mujoco.MjModel.from_xml_string(xml.replace("{option}", option))
    data = mujoco.MjData(model)
    data.qvel[:] = START[2:]
    data.act[1] = flywheel
    return model, data


def path(integrator: str, h: float, **keys: float) -> Array:
    """Rows (zu, zs) at TIMES."""
    model, data = car(integrator, h, **keys)
    rows = [data.qpos.copy()]
    for count in np.diff(np.rint(TIMES / h).astype(int)):
        mujoco.mj_step(model, data, int(count))
        rows.append(data.qpos.copy())
    return np.array(rows)


def truth(spring: float, damper: float, hardening: float = 0.0, backlash: float = 0.0) -> Array:
    """Rows (zu, zs); backlash only without series damping, as a dead zone."""

    def slope(_: float, q: Array) -> list[float]:
        zu, zs, vu, vs, s, w = q
        x, v = zs - zu, vs - vu
        d = s - np.clip(s, -backlash, backlash)
        force = spring * (1 + hardening * d) * d + damper * (v - w)
        u = STRUT * x + BESIDE * v + force
        return [vu, vs, (u - TYRE * zu) / WHEEL, -u / CAR, v - w, force / INERTANCE]

    result = solve_ivp(
        slope, (0, TIMES[-1]), [*START, 0, 0], "DOP853", TIMES, rtol=1e-12, atol=1e-14,
        max_step=1e-4 if backlash else np.inf,
    )  # fmt: skip
    return result.y[:2].T


def errors(expected: Array, integrator: str, steps: tuple[float, ...], **keys: float) -> Array:
    """Largest error of the positions, relative, for each step."""
    size = np.abs(expected).max()
    return np.array([np.abs(path(integrator, h, **keys) - expected).max() / size for h in steps])


ELEMENTS = {
    "spring": {"series_stiffness": SPRING},
    "spring and damper": {"series_stiffness": SPRING, "series_damping": SERIES_DAMPER},
    "damper": {"series_damping": 2e3},
    "hardening": {
        "series_stiffness": SPRING, "series_damping": SERIES_DAMPER, "series_hardening": 30.0,
    },
    "dead zone": {"series_stiffness": SPRING, "backlash": 1e-3},
}  # fmt: skip


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("name", ELEMENTS)
def test_the_motion_converges_to_the_equations(name: str, integrator: str) -> None:
    keys = ELEMENTS[name]
    expected = truth(*(keys.get(key, 0.0) for key in (
        "series_stiffness", "series_damping", "series_hardening", "backlash")))  # fmt: skip
    rk4 = integrator == "RK4"
    steps = (5e-3, 2.5e-3, 1.25e-3) if rk4 else (1e-3, 5e-4, 2.5e-4)
    steps = (2e-3, 1e-3, 5e-4) if rk4 and name == "dead zone" else steps
    found = errors(expected, integrator, steps, **keys)
    order = np.log2(found[0] / found[-1]) / 2
    # corners of the dead zone cost RK4 its order
    least = 0.85 if not rk4 else 1.2 if name == "dead zone" else 3.7
    assert order > least, found
    assert found[0] < (2e-2 if rk4 else 0.1)


@pytest.mark.parametrize("name", ["spring", "spring and damper"])
def test_a_linear_element_is_the_matrix_exponential(name: str) -> None:
    # a node between element and inertance gets the coordinate y; no mass of its own but b
    damper = ELEMENTS[name].get("series_damping", 0.0)
    mass = np.diag([WHEEL, CAR, INERTANCE])
    apart, link = np.array([-1, 1, 0.0]), np.array([-1, 1, -1.0])
    stiffness = np.diag([TYRE, 0, 0]) + STRUT * np.outer(apart, apart)
    stiffness = stiffness + SPRING * np.outer(link, link)
    damping = BESIDE * np.outer(apart, apart) + damper * np.outer(link, link)
    start = np.array([0, 0, 0, 0.3, 0, 0])
    expected = linear_motion(mass, damping, stiffness, np.zeros(3), start, TIMES)[:, :2]
    assert np.abs(truth(SPRING, damper) - expected).max() < 1e-10 * np.abs(expected).max()
    assert errors(expected, "RK4", (1e-3,), **ELEMENTS[name])[0] < 3e-6


# k_s -> infinity: the flywheel moves along from the start
ALONG = {"flywheel": -0.3}


@pytest.mark.parametrize("integrator", INTEGRATORS[:-1])
def test_a_rigid_element_is_the_ideal_inerter(integrator: str) -> None:
    ideal = quarter_car("fixed", INERTANCE, BESIDE, STRUT).truth(TIMES)
    steps = (1e-3, 5e-4, 2.5e-4)
    found = errors(ideal, integrator, steps, **ALONG, series_stiffness=1e12)
    order = np.log2(found[0] / found[-1]) / 2
    assert order > 0.85, found
    assert found[0] < 0.1


def test_a_stiffening_element_goes_to_the_ideal_inerter() -> None:
    # the compliance moves the motion by its share, 1 / k_s; with RK4, which resolves it
    ideal = quarter_car("fixed", INERTANCE, BESIDE, STRUT).truth(TIMES)
    gaps = [
        errors(ideal, "RK4", (2.5e-4,), **ALONG, series_stiffness=k, series_damping=2 * np.sqrt(k))[
            0
        ]
        for k in (1e6, 1e7, 1e8)
    ]
    assert np.divide(gaps[:-1], gaps[1:]).min() > 6, gaps
    assert gaps[-1] < 2e-3


@pytest.mark.parametrize("integrator", INTEGRATORS[:-1])
@pytest.mark.parametrize("damping", [0.0, 1e4])
def test_a_rigid_element_stays_bounded_for_long(damping: float, integrator: str) -> None:
    model, data = car(integrator, 2e-3, series_stiffness=1e12, series_damping=damping)
    for _ in range(50):
        mujoco.mj_step(model, data, 100)
        assert np.abs(data.qpos).max() < 0.02
    assert np.abs(data.qvel).max() < 1e-2


def test_small_play_goes_to_none() -> None:
    expected = truth(SPRING, 0)
    distances = [
        errors(expected, "RK4", (5e-4,), series_stiffness=SPRING, backlash=play)[0]
        for play in (1e-4, 1e-5, 1e-6)
    ]
    ratios = np.divide(distances[:-1], distances[1:])
    assert np.all(ratios > 8), distances
    assert distances[-1] < 2e-3
