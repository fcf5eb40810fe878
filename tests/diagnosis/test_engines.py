"""A device that is found, simulated again in each engine along the record."""

import numpy as np
import pytest
from inerter import Device
from inerter.diagnose.engines import simulate_engines
from inerter.identify.model import Model, stated_values
from inerter.identify.runs import thin
from inerter.records import Record
from inerter.records.preparation import prepare

pytest.importorskip("exudyn")

BRISTLES = {
    "rate_state": {"age_distance": 2e-5, "rate_effect": 0.01, "age_effect": 0.1},
    "dahl": {"bristle_stiffness": 1e6},
    "lugre": {"bristle_stiffness": 1e6, "static_force": 14.0, "stribeck_velocity": 0.02},
}


@pytest.mark.parametrize("law", BRISTLES)
def test_engines_follow_a_bristle_that_a_sample_goes_far_beyond(law: str) -> None:
    """0.2 m/s at 300 Hz are 0.7 mm a sample, of contacts that forget along some micrometres."""
    rng, t = np.random.default_rng(4), np.arange(0, 8, 1 / 300)
    x = 0.03 * np.sin(2 * np.pi * t) + 0.01 * np.sin(2 * np.pi * 2.3 * t + 1)
    v, a = np.gradient(x, t), np.gradient(np.gradient(x, t), t)
    device = Device(inertance=70.0, friction=law, coulomb_force=11.0, **BRISTLES[law])
    force = device.along(1 / 300, x, v, a)["total"] + rng.normal(0, 0.5, t.size)
    preparation = prepare([Record(name="run", time=t, displacement=x, force=force)])
    run = thin(preparation.motions[0])
    values, texts = stated_values(device)
    found = simulate_engines(Model(law, values, (), texts), [run], [run.inner])
    assert found["exudyn"] is not None
    assert found["exudyn"] == pytest.approx(found["reference"], rel=0.02)
    assert found["exudyn"] < 5.0
