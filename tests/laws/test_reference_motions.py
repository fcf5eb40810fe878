"""Motions: their derivatives, and where the velocity turns."""

import numpy as np
import pytest
from inerter.reference import (
    Motion,
    chirp,
    scaled,
    sine_motion,
    strokes,
    sum_of_sines,
    wang_su_motion,
    windowed_sines,
)
from inerter.reference.motion import velocity_crossings

MOTIONS = {
    "sine": sine_motion(5e-3, 2.0, 0.3),
    "sum_of_sines": sum_of_sines([3e-3, 1e-3], [0.7, 4.1], [0.1, 2.0]),
    "windowed_sines": windowed_sines([5e-3, 2e-3], [1.0, 5.0], [0.0, 3.0, 6.0], 0.4),
    "chirp": chirp(10e-3, 0.3, 6.0, 6.0, 0.5),
    "strokes": strokes([0.0, 0.02, -0.01], [0.5, 2.5], [0.6, 0.4]),
    "scaled": scaled(sine_motion(1.0, 2.0), 5e-3),
    "wang_su": wang_su_motion(3),
}


@pytest.mark.parametrize("name", MOTIONS)
def test_derivatives(name: str) -> None:
    motion = MOTIONS[name]
    t, h = np.linspace(0.01, 5.99, 997), 1e-5
    velocity = (motion.displacement(t + h) - motion.displacement(t - h)) / (2 * h)
    acceleration = (motion.velocity(t + h) - motion.velocity(t - h)) / (2 * h)
    scale = np.max(abs(acceleration))
    np.testing.assert_allclose(motion.velocity(t), velocity, atol=1e-7 * scale)
    np.testing.assert_allclose(motion.acceleration(t), acceleration, atol=1e-5 * scale)
    assert float(motion.velocity(1.234)) == pytest.approx(
        float(np.asarray(motion.velocity(np.array([1.234])))[0]), rel=1e-12
    )


@pytest.mark.parametrize("name", MOTIONS)
def test_one_time_is_as_many(name: str) -> None:
    """A solver asks for one time after another, also beyond the ends and at the edges."""
    motion, times = MOTIONS[name], np.concatenate([np.linspace(-1.0, 7.0, 333), [0.0, 3.0, 6.0]])
    for channel in (motion.displacement, motion.velocity, motion.acceleration):
        together = np.broadcast_to(channel(times), times.shape)
        alone = [float(channel(float(t))) for t in times]
        np.testing.assert_allclose(
            alone, together, rtol=1e-12, atol=1e-13 * float(np.max(abs(together)))
        )


def test_reversals_are_found_to_rounding() -> None:
    found = velocity_crossings(sine_motion(1e-3, 3.0), 0.0, 0.0, 2.0, 1e-3)
    np.testing.assert_allclose(found, (np.arange(12) + 0.5) / 6.0, atol=1e-12)


def test_dwells_begin_and_end() -> None:
    motion = strokes([0.0, 0.01, 0.0], [0.1, 0.5], [0.2, 0.2])
    found = velocity_crossings(motion, 0.0, 0.0, 1.0, 1e-3)
    for edge in (0.1, 0.3, 0.5, 0.7):
        assert min(abs(np.array(found) - edge)) < 2e-3


def test_a_motion_may_be_constant() -> None:
    still = Motion(lambda t: 0.01, lambda t: 0.0, lambda t: 0.0)
    assert velocity_crossings(still, 0.0, 0.0, 1.0, 1e-2) == []
