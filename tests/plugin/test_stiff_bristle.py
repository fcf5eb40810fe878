"""Does a bristle stiffer than the step can resolve stay bounded?"""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from plugin_models import INERTANCE, INTEGRATORS, plugin_actuator, quarter_car_xml, simulate

LEVEL, STEP = 50.0, 2e-3


@pytest.mark.parametrize("integrator", INTEGRATORS[:-1])
@pytest.mark.parametrize("law", ["dahl", "lugre", "bouc_wen"])
def test_the_force_never_leaves_the_level(law: str, integrator: str) -> None:
    # sigma0 = 1e8 N/m: a time constant of half a microsecond at 1 m/s, 4000 times below the step
    keys: dict[str, float | str] = {"inertance": INERTANCE, "friction": law}
    if law == "bouc_wen":
        yield_length = LEVEL / 1e8
        keys |= {
            "bw_stiffness": 1e8, "bw_beta": 0.5 / yield_length, "bw_gamma": 0.5 / yield_length,
        }  # fmt: skip
    else:
        keys |= {"bristle_stiffness": 1e8, "coulomb_force": LEVEL}
    xml = quarter_car_xml(
        plugin_actuator(keys), option=f'timestep="{STEP}" integrator="{integrator}"'
    )
    path = simulate(mujoco.MjModel.from_xml_string(xml), 4.0)
    assert np.isfinite(path).all()
    assert 1e8 * np.abs(path[:, 4]).max() <= LEVEL * (1 + 1e-9)
    # the motion dies out as it should: 0.3 m/s moves the car by millimetres, then it rests
    assert np.abs(path[:, :2]).max() < 0.01
    assert np.abs(path[-200:, :2]).max() < 1e-3
