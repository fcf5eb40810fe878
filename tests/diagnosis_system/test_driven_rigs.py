"""Rigs that are driven by a road and a force: positions with zeros of their own, delays, gains.

The records come from the linear equations of a quarter-car by SciPy's matrix exponential.
"""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from inerter.diagnose.vehicle import diagnose_model
from inerter.diagnose.vehicle.build import read_model
from inerter.diagnose.vehicle.mapping import map_columns
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.signal import lsim

Array = NDArray[np.float64]
MODEL = Path(__file__).parents[2] / "docs" / "examples" / "quanser" / "model.xml"
STEP = 0.002
COLUMNS = ["road", "actuator_force", "wheel_position", "body_position", "suspension_travel"]
# of positions that a bench counts from somewhere else than the model
ZEROS = (0.013, -0.071, 0.004)


@dataclass(frozen=True, kw_only=True)
class Bench:
    """The quarter-car bench as the model states it, and what may be hidden; SI units."""

    body: float = 2.45
    wheel: float = 1.0
    spring: float = 900.0
    damper: float = 7.5
    tyre: float = 2500.0
    tyre_damping: float = 5.0
    guide: float = 0.0  # damping of the body's guide
    gain: float = 1.0  # of the force
    lag: float = 0.0  # of the force, first order [s]
    late: float = 0.0  # the body's position [s]

    def run(
        self, number: Sequence[int], seconds: float = 12.0, noise: float = 0.01
    ) -> dict[str, Array]:
        """A record by column; noise as a share of each channel's spread."""
        rng = np.random.default_rng(list(number))
        t = np.asarray(STEP * np.arange(round(seconds / STEP)), dtype=np.float64)
        road, force = (_smooth(rng, t, f) for f in (4.0, 6.0))
        road, force = 3e-3 * road, 1.5 * force
        acting = self.gain * force
        if self.lag:
            acting = lsim(([self.gain], [self.lag, 1.0]), force, t)[1]
        k, c, kt, ct = self.spring, self.damper, self.tyre, self.tyre_damping
        a = np.array([
            [0, 1, 0, 0],
            [-(k + kt) / self.wheel, -(c + ct) / self.wheel, k / self.wheel, c / self.wheel],
            [0, 0, 0, 1],
            [k / self.body, c / self.body, -k / self.body, -(c + self.guide) / self.body],
        ])  # fmt: skip
        b = np.array([[0, 0, 0], [kt / self.wheel, ct / self.wheel, -1 / self.wheel],
                      [0, 0, 0], [0, 0, 1 / self.body]])  # fmt: skip
        inputs = np.column_stack([road, np.gradient(road, t), acting])
        states = lsim((a, b, np.eye(4), np.zeros((4, 3))), inputs, t)[1]
        wheel, travel = states[:, 0], states[:, 2] - states[:, 0]
        body = np.interp(t - self.late, t, states[:, 2])
        made = {"time": t, "road": road, "actuator_force": force}
        for name, values, zero in zip(COLUMNS[2:], (wheel, body, travel), ZEROS, strict=True):
            made[name] = zero + values + noise * np.std(values) * rng.normal(size=len(t))
        return made


def _smooth(rng: np.random.Generator, t: Array, highest: float) -> Array:
    """A sum of sines with random phases, 0 with rate 0 at the start."""
    made = np.zeros_like(t)
    for f in np.linspace(0.3, highest, 14):
        made += np.sin(2 * np.pi * f * t + rng.uniform(0, 2 * np.pi)) / 3
    return made * (1 - np.exp(-((t / 0.5) ** 2)))


@functools.cache
def found(folder: Path, bench: Bench, noise: float = 0.01, seed: int = 0):
    """The diagnosis of three runs, whose motions follow from the seed."""
    paths = []
    for number in (1, 2, 3):
        made = bench.run([seed, number], noise=noise)
        paths.append(folder / f"run{number}.csv")
        np.savetxt(paths[-1], np.column_stack(list(made.values())), delimiter=",", comments="",
                   header=",".join(made))  # fmt: skip
    return diagnose_model(paths, MODEL, holdout=["run3"])


def test_a_force_beside_the_road_leaves_the_wheel_recognised() -> None:
    user = read_model(MODEL)
    found = map_columns(user.model, [*COLUMNS, "temperature"], {}, {})
    assert found.inputs == {"road": "road", "actuator_force": "actuator_force"}
    assert [o.column for o in found.outputs] == COLUMNS[2:]
    # nobody knows the zero of a position
    assert all(o.floating for o in found.outputs)
    assert found.unused == ("temperature",)
    user.with_inputs(found.inputs.values())
    (part,) = user.parts.suspensions
    names = {user.model.body(part.wheel).name, user.model.body(part.body).name}
    assert names == {"wheel", "body"}
    assert user.model.body(part.wheel).name == "wheel"
    assert part.tyre is not None
    assert user.parts.unknown == []
    assert user.stated["tyre:road.tyre_damping"] == 5.0


def test_a_right_model_with_displaced_zeros_is_right(tmp_path: Path) -> None:
    said = found(tmp_path, Bench())
    assert said.findings == []
    # the noise, and what the step of 2 ms does
    assert 0.01 < said.baseline.rmse < 0.02


# what is hidden in the bench, its name in a finding, and between which values it is drawn
HIDDEN = {
    "actuator_gain_error": ("gain", "actuator_force.actuator_gain", 1.2, 1.6),
    "joint_damping": ("guide", "body.joint_damping", 3.0, 9.0),
    "tyre_damping": ("tyre_damping", "tyre_damping", 8.0, 12.0),
    "sensor_delay": ("late", "body_position.delay", 0.004, 0.012),
    "actuator_lag": ("lag", "actuator_force.actuator_lag", 0.02, 0.08),
}


@pytest.mark.long
@pytest.mark.parametrize("effect", HIDDEN)
def test_what_is_hidden_is_named_and_measured(
    effect: str, effects_seed: int, tmp_path: Path
) -> None:
    field, name, least, most = HIDDEN[effect]
    true = float(np.random.default_rng([effects_seed, len(effect)]).uniform(least, most))
    said = found(tmp_path, Bench(**{field: true}), seed=effects_seed)
    assert [finding.effect for finding in said.findings] == [effect], effects_seed
    measured = said.findings[0].parameters[name]
    # a step of 2 ms shifts them by some per cent
    assert abs(measured.value - true) < 4 * measured.stderr + 0.05 * true, (effects_seed, true)
    # what was written, read back, is the model that was found
    assert said.engines["mujoco"] == pytest.approx(said.extended.rmse, rel=1e-3)


def test_a_unit_that_is_another_and_a_sign_are_told(tmp_path: Path) -> None:
    from inerter.diagnose.vehicle.drive import RecordedDrive
    from inerter.diagnose.vehicle.polarity import polarity

    user = read_model(MODEL)
    outputs = map_columns(user.model, COLUMNS, {}, {}).outputs
    rng = np.random.default_rng(0)
    true = rng.normal(size=(500, 3))
    measured = true * np.array([1000.0, -1.0, 1.3])
    drive = RecordedDrive(
        name="run", time=np.arange(500, dtype=np.float64), start=0.0, measured=measured, step=STEP,
        ahead=true[:, :2], now=true[:, :2], rate=true[:, :2], rate_now=true[:, :2], stride=1,
        spline=CubicSpline(np.arange(500.0), true[:, :2]),
    )  # fmt: skip
    signs, notes, warnings = polarity(outputs, [drive], [true])
    assert list(signs) == [1.0, 1.0, 1.0]
    assert notes == []
    assert [(w.code, w.text.split("'")[1]) for w in warnings] == [
        ("unit_suspect", "wheel_position"), ("sign_flip", "body_position")
    ]  # fmt: skip
    assert "milli-units" in warnings[0].text
