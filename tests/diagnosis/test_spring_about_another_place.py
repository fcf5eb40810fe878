"""A spring that hardens about another place than where the displacement is zero."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from inerter.device_file import read_device
from inerter.diagnose import diagnose_bench
from inerter.records import Record
from inerter.report.output import write_outputs
from inerter.report.page import render_report
from sines import moved

TIME = np.arange(0, 8, 1 / 250)


@pytest.mark.parametrize("stiffness", [-4000.0, 5000.0])
def test_place_and_stiffnesses_are_measured(
    stiffness: float, effects_seed: int, tmp_path: Path
) -> None:
    draw = np.random.default_rng([effects_seed, 11])
    place, cubic = float(draw.choice([-1, 1]) * draw.uniform(2e-3, 5e-3)), 6e7

    def record(name: str) -> Record:
        x, v, a = moved(draw, TIME, (0.5, 1.1, 2.3), draw.uniform(4e-3, 7e-3, 3))
        spring = stiffness * (x - place) + cubic * (x - place) ** 3
        noise = draw.standard_normal((2, TIME.size))
        return Record(
            name=name, time=TIME, displacement=x + 1e-6 * noise[0],
            force=30 * a + 60 * v + spring + 0.5 * noise[1],
        )  # fmt: skip

    found = diagnose_bench([record(f"run {i}") for i in range(3)])
    expected = {"hardening_stiffness", "parallel_stiffness", "viscous_friction"}
    assert {each.effect for each in found.findings} == expected
    assert not found.unexplained.significant
    values = {name: each.value for name, each in found.parameters.items()}
    assert values["rest_length"] == pytest.approx(place, abs=5e-5)
    assert values["stiffness_cubic"] == pytest.approx(cubic, rel=0.02)
    assert values["stiffness"] == pytest.approx(stiffness, abs=100)
    assert values["inertance"] == pytest.approx(30, rel=0.01)
    # a user's own length at rest counts from where his displacement does
    write_outputs(replace(found, rest_length=0.4), tmp_path)
    written = read_device(tmp_path / "device.toml").rest_length
    assert written == pytest.approx(0.4 + values["rest_length"], rel=1e-12)
    page = render_report(found, "", "")
    assert ("as a spring that snaps through" in page) == (stiffness < 0)
