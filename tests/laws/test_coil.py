"""A coiled channel: White, Mishra and Gupta by hand; limits; three tellings; behind a spring."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from core_draws import draw_complete, draw_points, draw_states
from inerter.core import Device, DeviceError
from inerter.exudyn import device as element
from inerter.exudyn.parameters import Parameters as ElementParameters
from inerter.reference import ReferenceDevice

BORE, LENGTH, AREA, DENSITY = 6e-3, 1.7, 1.6e-3, 1000.0
CHANNEL = np.pi * BORE**2 / 4
FLUID: dict[str, Any] = {
    "piston_area": AREA, "channel_area": CHANNEL, "channel_length": LENGTH,
    "fluid_density": DENSITY,
}  # fmt: skip


def loss(w: Any, **values: Any) -> np.ndarray:
    return Device(**FLUID, **values).evaluate(0.0, w, 0.0, 0.0)["total"]


def speed_at(dean: float, viscosity: float, coil: float) -> float:
    """Speed of the piston [m/s] at a Dean number."""
    u = dean * viscosity / (DENSITY * BORE * np.sqrt(BORE / coil))
    return u * CHANNEL / AREA


@pytest.mark.parametrize("dean", [5.0, 11.0, 30.0, 100.0, 400.0])
def test_laminar_friction_is_whites(dean: float) -> None:
    # oil, so that the flow is laminar: Poiseuille times White's factor, 1 below De 11.6
    viscosity, coil = 0.05, 0.2
    w = speed_at(dean, viscosity, coil)
    poiseuille = 8 * np.pi * viscosity * LENGTH * (AREA / CHANNEL) ** 2 * w
    factor = 1.0 if dean <= 11.6 else 1 / (1 - (1 - (11.6 / dean) ** 0.45) ** 2.2)
    found = loss(w, fluid_viscosity=viscosity, coil_diameter=coil)[0]
    assert found == pytest.approx(poiseuille * factor, rel=1e-3 if dean > 200 else 1e-6)


def test_turbulent_friction_is_the_straight_channels_and_a_constant() -> None:
    # Re 1e6: laminar shares are gone
    coil, w = 0.2, 1e6 * 1e-3 / (DENSITY * BORE) * CHANNEL / AREA
    straight = loss(w, fluid_viscosity=1e-3)[0]
    u = w * AREA / CHANNEL
    more = AREA * 0.03 * np.sqrt(BORE / coil) * LENGTH / BORE * DENSITY * u**2 / 2
    found = loss(w, fluid_viscosity=1e-3, coil_diameter=coil)[0]
    assert found == pytest.approx(straight + more, rel=1e-3)


def test_an_endless_coil_is_straight_and_a_narrow_one_loses_more() -> None:
    w = np.geomspace(1e-6, 10.0, 400)
    straight = loss(w, fluid_viscosity=1e-3)
    np.testing.assert_allclose(loss(w, fluid_viscosity=1e-3, coil_diameter=1e18), straight, 1e-6)
    wide, narrow = (loss(w, fluid_viscosity=1e-3, coil_diameter=d) for d in (0.3, 0.05))
    assert np.all(wide >= straight * (1 - 1e-12))
    assert np.all(narrow >= wide)
    assert np.all(np.diff(narrow) > 0)


def test_the_flow_through_a_coil_has_no_jump() -> None:
    # at De = 11.6, at Re = 10 where the other terms set in, and everywhere else
    w = np.geomspace(1e-6, 10.0, 200_001)
    found = loss(w, fluid_viscosity=1e-3, coil_diameter=0.05)
    growth = np.diff(np.log(found)) / np.diff(np.log(w))
    assert growth.min() > 0.9
    assert growth.max() < 2.6
    assert abs(np.diff(growth)).max() < 2e-3


def test_the_implicit_step_takes_the_slope_of_the_loss() -> None:
    # over a step the loss is that of the start and its slope times the change of speed
    for w in (0.003, 0.02, 0.1, 0.5):
        device = Device(**FLUID, fluid_viscosity=1e-3, coil_diameter=0.1)
        near, h = 1e-6 * w, 1e-3
        slope = (device.evaluate(0.0, [w - near, w + near], 0.0, 0.0)["total"]) @ [-1, 1]
        slope /= 2 * near
        inertance = device.evaluate(0.0, 0.0, 1.0, 0.0)["total"][0]
        found = [device.over_step(0.0, w, a, 0.0, h, 0.0)[0]["total"] for a in (0.0, 1.0)]
        assert (found[1] - found[0] - inertance) / h == pytest.approx(slope, rel=1e-6)


def test_three_tellings_agree() -> None:
    rng = np.random.default_rng(28)
    for _ in range(60):
        p = draw_complete(rng)
        while "channel_area" not in p:
            p = draw_complete(rng)
        bore = np.sqrt(4 * p["channel_area"] / np.pi)
        p["coil_diameter"] = bore * (1.05 + 10.0 ** float(rng.uniform(-1.0, 3.0)))
        core, reference = Device(**p), ReferenceDevice(**p)
        told = ElementParameters.of(core)
        x, v, a, _ = draw_points(rng, 20, 1.0, 1.0)
        z = draw_states(rng, 20, p)
        if p.get("backlash"):
            z[:, -1] = np.clip(z[:, -1], -p["backlash"], p["backlash"])
        found = core.evaluate(x, v, a, z)
        heat = reference.dissipated_power(x, v, a, reference.state_argument(z))
        w = v
        if "flywheel_velocity" in core.state_names:
            w = z[:, core.state_names.index("flywheel_velocity")]
        # the loss alone, by three hands
        only = {k: p[k] for k in p if k.startswith(("piston", "channel", "fluid", "minor", "coil"))}
        alike = ElementParameters.of(Device(**only))
        alone = [
            Device(**only).evaluate(0.0, w, 0.0, 0.0)["total"],
            ReferenceDevice(**only).force(0.0, w, 0.0),
            [element.forces(alike, 0.0, float(s), 0.0, [])["total"] for s in w],
        ]
        np.testing.assert_allclose(alone[1], alone[0], rtol=1e-12)
        np.testing.assert_allclose(alone[2], alone[0], rtol=1e-12)
        size = abs(found["dissipated_power"]) + abs(found["total"] * v) + abs(alone[0] * w)
        np.testing.assert_array_less(abs(found["dissipated_power"] - heat), 1e-9 * size + 1e-9)
        assert told.coil_diameter == core.coil_diameter


def test_a_fluid_inerter_behind_a_spring_is_one_device() -> None:
    """A tuned inerter damper: F / X = k (i c w - b w^2) / (k - b w^2 + i c w), laminar."""
    viscosity = 0.05
    device = Device(**FLUID, fluid_viscosity=viscosity, coil_diameter=0.5, series_stiffness=4e5)
    b = DENSITY * LENGTH * AREA**2 / CHANNEL
    c = 8 * np.pi * viscosity * LENGTH * (AREA / CHANNEL) ** 2
    rate, h = 0.9 * np.sqrt(4e5 / b), 1e-4
    # small, so that De stays below 11.6 in the coil
    amplitude = 0.3 * speed_at(11.6, viscosity, 0.5) / rate * 0.2
    t = np.arange(0.0, 12.0, h)
    motion = amplitude * np.array([np.sin(rate * t), rate * np.cos(rate * t)])
    ran = device.along(h, motion[0], motion[1], -(rate**2) * motion[0])
    s = 1j * rate
    ratio = 4e5 * (b * s * s + c * s) / (4e5 + b * s * s + c * s)
    late = t > 10.0
    expected = amplitude * (ratio * np.exp(s * t)).imag
    error = ran["total"][late] - expected[late]
    assert abs(error).max() < 2e-3 * abs(ratio) * amplitude


@pytest.mark.parametrize(
    ("keys", "part"),
    [
        ({"coil_diameter": 0.1}, "coil_diameter is given, but the channel is incomplete"),
        ({**FLUID, "coil_diameter": BORE}, "coil_diameter is 0.006 m"),
        ({**FLUID, "coil_diameter": -1.0}, "coil_diameter"),
    ],
)
def test_a_coil_that_cannot_be_is_refused(keys: dict[str, Any], part: str) -> None:
    with pytest.raises(DeviceError, match=part):
        Device(**keys)
    with pytest.raises(ValueError, match="coil_diameter"):
        ReferenceDevice(**keys)
