"""Free play before the friction in the quarter-car: its equations, its energy balance."""

from __future__ import annotations

import functools
from dataclasses import dataclass

import mujoco
import numpy as np
import pytest
from plugin_models import (
    FRICTION,
    INERTANCE,
    INTEGRATORS,
    Law,
    plugin_actuator,
    quarter_car_truth,
    quarter_car_xml,
    simulate,
)
from test_sensors import car, energies

HALF, DURATION, EVERY = 5e-4, 0.4, 4e-3
TIMES = np.arange(round(DURATION / EVERY) + 1) * EVERY
LAWS = ("dahl", "lugre", "bouc_wen")


@dataclass
class BehindPlay(Law):
    """A law with a bristle that is bent by what of s goes beyond the play."""

    def rate(self, v: float, z: float) -> float:
        beyond = z - np.clip(z, -HALF, HALF)
        engaged = abs(z) > HALF or (abs(z) == HALF and z * v > 0)
        return super().rate(v, beyond) if engaged else v

    def force(self, x: float, v: float, z: float) -> float:
        side, beyond = np.sign(z), z - np.clip(z, -HALF, HALF)
        if self.name == "lugre":
            bristle = self.p["bristle_stiffness"] * beyond
            damper = self.p["bristle_damping"] * super().rate(v, beyond) if beyond else 0.0
            return side * max(0.0, side * (bristle + damper))
        return super().force(x, v, beyond)


@functools.cache
def truth(law: str) -> np.ndarray:
    return quarter_car_truth(BehindPlay(law, FRICTION[law]), TIMES)


def path(law: str, h: float, integrator: str, half: float = HALF) -> np.ndarray:
    keys = {"inertance": INERTANCE, "friction": law, **FRICTION[law], "friction_backlash": half}
    xml = quarter_car_xml(plugin_actuator(keys), option=f'timestep="{h}" integrator="{integrator}"')
    return simulate(mujoco.MjModel.from_xml_string(xml), DURATION, round(EVERY / h))


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("law", LAWS)
def test_it_converges_to_the_equations(law: str, integrator: str) -> None:
    size = np.abs(truth(law)[:, :2]).max()
    # the play is crossed, on both sides, and is felt
    assert truth(law)[:, 4].max() > HALF
    assert truth(law)[:, 4].min() < -HALF
    assert np.abs(path(law, 1e-3, integrator, 0.0)[:, :2] - truth(law)[:, :2]).max() > 0.02 * size
    steps = [2e-3 / 2**k for k in range(5)]
    error = [np.abs((path(law, h, integrator) - truth(law))[:, :2]).max() / size for h in steps]
    # the jump of LuGre's damper at contact falls anywhere in a step
    order = 0.3 if (law, integrator) == ("lugre", "RK4") else 0.9
    assert np.log2(error[0] / error[-1]) / 4 > order, error
    assert error[0] < (1e-3 if integrator == "RK4" else 0.15 if integrator == "discrete" else 0.04)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("integrator", ["RK4", "implicitfast"])
def test_energy_balance(law: str, integrator: str) -> None:
    defects = []
    for h in (1e-3, 5e-4, 2.5e-4):
        model = car(law, f'timestep="{h}" integrator="{integrator}"', friction_backlash=HALF)
        mechanical, heat = energies(model, 0.3)
        defects.append(np.abs(mechanical + heat - mechanical[0]).max() / mechanical[0])
        assert np.diff(heat).min() > -1e-9 * mechanical[0], "heat never flows back"
    assert np.log2(defects[0] / defects[-1]) / 2 > 0.8, defects
    assert defects[-1] < (1e-4 if integrator == "RK4" else 2e-2)


@pytest.mark.parametrize("integrator", INTEGRATORS[:-1])
def test_a_stiff_bristle_behind_play_stays_within_its_level(integrator: str) -> None:
    keys: dict[str, float | str] = {
        "inertance": INERTANCE, "friction": "lugre", "bristle_stiffness": 1e8,
        "bristle_damping": 1e4, "coulomb_force": 50.0, "friction_backlash": HALF,
    }  # fmt: skip
    xml = quarter_car_xml(
        plugin_actuator(keys), option=f'timestep="2e-3" integrator="{integrator}"'
    )
    found = simulate(mujoco.MjModel.from_xml_string(xml), 4.0)
    assert np.isfinite(found).all()
    assert 1e8 * (np.abs(found[:, 4]).max() - HALF) <= 50.0 * (1 + 1e-6)
    assert np.abs(found[-200:, :2]).max() < 1e-3


def test_the_play_can_be_live() -> None:
    keys = {"inertance": INERTANCE, "friction": "dahl", **FRICTION["dahl"]}
    option = 'timestep="1e-3" integrator="implicitfast"'
    live = f'<custom><numeric name="strut.friction_backlash" data="{HALF}"/></custom>'
    model = mujoco.MjModel.from_xml_string(
        quarter_car_xml(plugin_actuator(keys), option=option, extra=live)
    )
    np.testing.assert_array_equal(simulate(model, DURATION, 4), path("dahl", 1e-3, "implicitfast"))


def test_a_law_without_bristle_is_refused() -> None:
    keys = {"friction": "coulomb", "coulomb_force": 5.0, "friction_backlash": HALF}
    with pytest.raises(ValueError, match="friction_backlash is given, but friction is"):
        mujoco.MjModel.from_xml_string(quarter_car_xml(plugin_actuator(keys)))
