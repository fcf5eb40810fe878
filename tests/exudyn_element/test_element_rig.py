"""A device on Exudyn's test rig along a sampled motion, against the reference on that motion."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

pytest.importorskip("exudyn.itemInterface")

from inerter import Device
from inerter.exudyn.rig import simulate_along
from inerter.reference import ReferenceDevice, response, sine_motion

SPACING, AMPLITUDE, FREQUENCY, PHASE = 1e-3, 0.01, 2.0, 0.7
TIMES = SPACING * np.arange(1000)
# the error of the force over its size: rounding beside a table of 1e12 kg, then what corners cost
DEVICES: dict[str, tuple[dict[str, Any], float]] = {
    "ideal": ({}, 1e-9),
    "coulomb": ({"friction": "coulomb", "coulomb_force": 20.0}, 1e-8),
    "lugre": (
        {"friction": "lugre", "coulomb_force": 20.0, "static_force": 30.0,
         "bristle_stiffness": 1e5, "bristle_damping": 100.0},
        1e-5,
    ),
    "stiff dahl": (
        {"friction": "dahl", "coulomb_force": 20.0, "bristle_stiffness": 1e6}, 1e-5
    ),
    "series": ({"series_stiffness": 1e6, "series_damping": 500.0, "rest_length": 0.2}, 1e-4),
}  # fmt: skip


@pytest.mark.parametrize("name", DEVICES)
def test_force_along_a_sine(name: str) -> None:
    device, tolerance = DEVICES[name]
    motion = sine_motion(AMPLITUDE, FREQUENCY, PHASE)
    x, v, a = (
        np.asarray(signal(TIMES), dtype=float)  # pyright: ignore[reportArgumentType]
        for signal in (motion.displacement, motion.velocity, motion.acceleration)
    )
    true = response(ReferenceDevice(inertance=100.0, **device), motion, TIMES)
    found = simulate_along(Device(inertance=100.0, **device), SPACING, x, v, a)
    assert np.abs(found["total"] - true.force).max() < tolerance * np.abs(true.force).max()
    assert found["states"].shape == true.states.shape


def test_first_states_are_the_ones_given() -> None:
    """10 N move the table of 1e12 kg by 1e-16 m in this time, and that is 1e-12 of the bristle."""
    device = Device(inertance=1.0, friction="dahl", coulomb_force=20.0, bristle_stiffness=1e5)
    rest = np.zeros(5)
    found = simulate_along(device, SPACING, rest, rest, rest, state=1e-4)
    np.testing.assert_allclose(found["total"], 10.0, rtol=1e-10)


def test_forces_at_some_samples_are_those_of_all() -> None:
    motion = sine_motion(AMPLITUDE, FREQUENCY, PHASE)
    times = SPACING * np.arange(81)
    x, v, a = (
        np.asarray(signal(times), dtype=float)  # pyright: ignore[reportArgumentType]
        for signal in (motion.displacement, motion.velocity, motion.acceleration)
    )
    for name in ("lugre", "ideal"):
        device = Device(inertance=100.0, **DEVICES[name][0])
        whole = simulate_along(device, SPACING, x, v, a)
        some = simulate_along(device, SPACING, x, v, a, every=8)
        for quantity, values in whole.items():
            np.testing.assert_array_equal(some[quantity], values[::8])


def test_what_cannot_be() -> None:
    with pytest.raises(ValueError, match="arrays of one length >= 2"):
        simulate_along(Device(inertance=1.0), SPACING, [0.0, 1.0], [0.0], [0.0])
    with pytest.raises(ValueError, match="h is 0: give a sample spacing > 0 s"):
        simulate_along(Device(inertance=1.0), 0, [0.0, 1.0], [0.0, 1.0], [0.0, 1.0])
    for every in (0, 3):
        with pytest.raises(ValueError, match=f"every is {every}: give a divisor of the 4 sample"):
            simulate_along(Device(inertance=1.0), 1.0, *np.zeros((3, 5)), every=every)
