"""Load friction by the direction of power: tellings, efficiency of a screw, energy."""

import numpy as np
import pytest
from core_draws import draw_complete, draw_points, draw_states
from core_telling import Telling
from inerter.core import Device, DeviceError
from inerter.reference import ReferenceDevice

LEAD, RUBBING = np.radians(12.0), np.radians(3.0)
SCREW = {
    "mu_forward": np.tan(LEAD + RUBBING) / np.tan(LEAD) - 1.0,
    "mu_backward": 1.0 - np.tan(LEAD - RUBBING) / np.tan(LEAD),
}
"""A screw of lead angle 12 degrees and friction angle 3 degrees."""


def test_one_mu_for_both_directions_is_load_friction_bit_for_bit() -> None:
    rng = np.random.default_rng(1)
    for _ in range(40):
        p = draw_complete(rng)
        mu = p.pop("load_friction")
        one = Device(**p, load_friction=mu)
        both = Device(**p, mu_forward=mu, mu_backward=mu)
        x, v, a, _ = draw_points(rng, 30, 1.0, 1.0)
        z = draw_states(rng, 30, p)
        said, again = one.evaluate(x, v, a, z), both.evaluate(x, v, a, z)
        for name, value in said.items():
            np.testing.assert_array_equal(value, again[name])


def test_core_is_the_reference_on_random_devices() -> None:
    rng = np.random.default_rng(2)
    for _ in range(150):
        p = draw_complete(rng)
        mu = p.pop("load_friction")
        by_power = {"mu_forward": float(rng.uniform(0.0, 3.0)), "mu_backward": mu}
        core, reference = Device(**p, **by_power), ReferenceDevice(**p, **by_power)
        x, v, a, _ = draw_points(rng, 40, 1.0, 1.0)
        z = draw_states(rng, 40, p)
        if p.get("backlash"):
            z[:, -1] = np.clip(z[:, -1], -p["backlash"], p["backlash"])
        state, found = reference.state_argument(z), core.evaluate(x, v, a, z)
        # sizes of the terms: those of one mu that is the larger one
        sizes = Telling(**p, load_friction=0.9).quantities(x, v, a, z)
        for name, value in (
            ("inertance", reference.inertance_force(x, v, a, state)),
            ("friction", reference.total_friction(x, v, a, state)),
            ("total", reference.force(x, v, a, state)),
            ("dissipated_power", reference.dissipated_power(x, v, a, state)),
        ):
            error = abs(found[name] - np.reshape(value, v.shape))
            assert np.all(error <= 4e-12 * sizes[name][1]), (p, name, error.max())
        assert np.all(found["dissipated_power"] >= -1e-12 * sizes["dissipated_power"][1])


def test_efficiency_of_a_screw() -> None:
    # power in over power out, at speeds where sign(v) is 1
    screw = Device(inertance=50.0, **SCREW)
    said = screw.evaluate(0.0, [0.2, -0.2, 0.2, -0.2], [3.0, -3.0, -3.0, 3.0], 0.0)
    forward = np.tan(LEAD) / np.tan(LEAD + RUBBING)
    backward = np.tan(LEAD - RUBBING) / np.tan(LEAD)
    efficiency = said["inertance"] / said["total"]
    np.testing.assert_allclose(efficiency[:2], forward, rtol=1e-12)
    np.testing.assert_allclose(1.0 / efficiency[2:], backward, rtol=1e-12)


@pytest.mark.parametrize("side", ["terminals", "flywheel"])
@pytest.mark.parametrize("shaft", [{}, {"series_stiffness": 5e4, "series_damping": 50.0}])
def test_over_a_step_the_force_does_not_fall_with_the_acceleration(
    side: str, shaft: dict[str, float]
) -> None:
    device = Device(inertance=50.0, friction_side=side, **SCREW, **shaft)
    for v in (-0.3, -1e-4, 0.0, 1e-4, 0.3):
        for s in (0.0, 1e-3, -1e-3) if shaft else (0.0,):
            z = [s, v] if shaft else 0.0
            force = [
                device.over_step(0.0, v, a, z, 1e-3, 0.01)[0]["total"]
                for a in np.linspace(-50.0, 50.0, 101)
            ]
            assert np.all(np.diff(force) >= -1e-9)


def test_the_state_of_a_force_holds_it_with_load_friction() -> None:
    device = Device(inertance=50.0, series_stiffness=5e4, series_damping=50.0, **SCREW)
    for force, v in ((30.0, 0.2), (30.0, -0.2), (-30.0, 0.2), (-30.0, -0.2)):
        z = device.state_of_force(0.0, v, 0.0, force)
        assert device.evaluate(0.0, v, 0.0, z)["total"][0] == pytest.approx(force, rel=1e-12)


def test_what_does_not_fit_is_refused() -> None:
    with pytest.raises(DeviceError, match=r"mu_forward is 0\.3, but load_friction is 0\.1; state"):
        Device(inertance=1.0, load_friction=0.1, mu_forward=0.3)
    with pytest.raises(DeviceError, match="mu_backward"):
        Device(inertance=1.0, mu_backward=1.5)
    with pytest.raises(DeviceError, match='mu_backward is 1 and friction_side is "flywheel"'):
        Device(inertance=1.0, mu_backward=1.0, friction_side="flywheel", series_stiffness=1e4)
