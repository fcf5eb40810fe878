"""What a record holds and can tell, on records made here."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from inerter.inspection.channel import channel_facts
from inerter.inspection.tells import Tell, words


@pytest.mark.parametrize("count", [2, 3, 5, 12, 33, 60, 250, 1000])
def test_a_channel_of_any_kind_and_length_has_facts(count: int) -> None:
    rng, t = np.random.default_rng(count), 2e-3 * np.arange(count)
    noise = rng.normal(size=count)
    for values in (
        np.zeros(count), np.full(count, 1e9), noise, np.sin(3 * t), np.round(np.sin(9 * t), 1),
        np.cumsum(noise), t, (t > t[-1] / 2) * 1.0, 1e-300 * noise, np.sin(50 * t) + 1e-3 * noise,
    ):  # fmt: skip
        facts = channel_facts("force", "N", np.asarray(values, dtype=np.float64), 2e-3)
        assert (facts.low, facts.high) == (values.min(), values.max())


def test_rate_and_noise_are_told(tmp_path: Path) -> None:
    """White noise of 0.5 N on the force; the record's rate, strokes and channels."""
    rng, t = np.random.default_rng(3), 1e-3 * np.arange(8000)
    x = 0.02 * np.sin(2 * np.pi * 1.5 * t)
    force = -60.0 * (2 * np.pi * 1.5) ** 2 * x + 0.5 * rng.normal(size=t.size)
    np.savetxt(
        tmp_path / "run.csv", np.column_stack([t, x, force]), delimiter=",", comments="",
        header="time,displacement,force",
    )  # fmt: skip
    done = subprocess.run(
        [sys.executable, "-m", "inerter", "inspect", tmp_path / "run.csv", "--json"],
        capture_output=True, text=True, check=True, cwd=tmp_path,
    )  # fmt: skip
    (found,) = json.loads(done.stdout)["records"]
    channels = {each["name"]: each for each in found["channels"]}
    assert found["sample_rate"] == pytest.approx(1000.0)
    assert found["samples"] == 8000
    assert channels["force"]["noise"] == pytest.approx(0.5, rel=0.1)
    assert channels["displacement"]["unit"] == "m"


@pytest.mark.parametrize(
    ("value", "error", "said"),
    [
        (527.2, 31.0, "530 ± 30"),
        (33.41, 0.6, "33.4 ± 0.6"),
        (104.6, 9.6, "100 ± 10"),
        (5.0, 0.0, "5"),
    ],
)
def test_a_value_has_the_digits_of_its_error(value: float, error: float, said: str) -> None:
    tell = Tell(name="stiffness", value=value, stderr=error, unit="N/m", verdict="told")
    assert words(tell) == f"stiffness {said} N/m"
