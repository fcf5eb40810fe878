"""Where a motion rests its noise is taken off, and nothing else."""

from __future__ import annotations

import numpy as np
import pytest
from inerter.core import Device
from inerter.records import Record
from inerter.records.motion import smooth

RATE, NOISE, CUTOFF = 500, 1e-6, 36.0
TIME = np.arange(0, 8, 1 / RATE)


def held(values: np.ndarray) -> np.ndarray:
    """Steps of 5 mm between two places, each a second, three quarters of it at rest."""
    share = np.clip((values % 1.0) / 0.25, 0.0, 1.0)
    way = share**3 * (10 - 15 * share + 6 * share**2)
    up = np.floor(values) % 2 == 0
    return 5e-3 * np.where(up, way, 1 - way)


def record(x: np.ndarray, seed: int = 1) -> Record:
    noisy = x + NOISE * np.random.default_rng(seed).standard_normal(x.size)
    return Record(name="run", time=TIME, displacement=noisy, force=np.zeros(x.size))


def test_a_bristle_keeps_what_it_holds_through_a_rest(effects_seed: int) -> None:
    fine = np.arange(0, 8, 1 / (20 * RATE))
    device = Device(friction="dahl", coulomb_force=15.0, bristle_stiffness=3e4)
    x = held(fine)
    v = np.gradient(x, fine)
    true = device.along(fine[1], x, v, np.gradient(v, fine))["total"][::20]
    motion = smooth(record(held(TIME), effects_seed), CUTOFF)
    found = device.along(motion.spacing, motion.displacement, motion.velocity, motion.acceleration)
    rests = (TIME % 1.0 > 0.35) & (TIME % 1.0 < 0.95)
    assert np.sqrt(np.mean((found["total"] - true)[rests] ** 2)) < 0.15
    # the noise there goes with it, and what moves is as it was
    assert np.std(motion.displacement[rests] - held(TIME)[rests]) < 0.3 * NOISE
    assert np.std(motion.velocity[rests]) < 0.3 * motion.velocity_noise


def test_velocity_and_acceleration_stay_those_of_the_displacement() -> None:
    motion = smooth(record(held(TIME)), CUTOFF)
    inner = slice(50, -50)
    for of, is_ in (("displacement", "velocity"), ("velocity", "acceleration")):
        rate = np.gradient(getattr(motion, of), motion.spacing)
        told = getattr(motion, is_)
        assert np.max(np.abs(rate - told)[inner]) < 0.02 * np.max(np.abs(told))
    steps = np.diff(motion.acceleration)
    assert np.max(np.abs(steps)) < 0.2 * np.max(np.abs(motion.acceleration))


@pytest.mark.parametrize("kind", ["creep", "slow sine", "slow stroke"])
def test_what_moves_less_than_noise_but_moves_stays(kind: str) -> None:
    """A rest in which something creeps, and a motion whose speed is that of noise."""
    x = {
        "creep": held(TIME) + 10e-6 * np.exp(-(TIME % 1.0) / 0.3),
        "slow sine": 30e-6 * np.sin(2 * np.pi * 0.25 * TIME),
        "slow stroke": 40e-6 * np.abs(TIME % 4.0 - 2.0),
    }[kind]
    motion = smooth(record(x), CUTOFF)
    usual = NOISE * np.sqrt(2 * CUTOFF / RATE)
    moving = slice(None) if kind != "creep" else (TIME % 1.0 > 0.35) & (TIME % 1.0 < 0.95)
    off = (motion.displacement - x)[moving]
    # as near as the smoother comes, or nearer
    assert np.sqrt(np.mean(off**2)) < 1.15 * usual
