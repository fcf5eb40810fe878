"""The example of a half-car on a four-post rig names what its record hides, and the gain."""

from __future__ import annotations

import runpy
from pathlib import Path

import pytest

EXAMPLE = Path(__file__).parents[2] / "docs" / "examples" / "four_post.py"


@pytest.mark.long
def test_the_example_finds_the_load_and_the_strut_that_rubs(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    runpy.run_path(str(EXAMPLE))["main"](tmp_path)
    first, second, last = capsys.readouterr().out.splitlines()
    # 10 % more than 730 kg, and 60 N in the rear strut
    told = {first.partition(":")[0]: first, second.partition(":")[0]: second}
    assert told.keys() == {"body_mass_error", "coulomb_friction"}
    mass = float(told["body_mass_error"].partition("body mass = ")[2].split()[0])
    assert mass == pytest.approx(803.0, rel=0.002)
    assert "strut rear.coulomb force = 60.0" in told["coulomb_friction"]
    before, after = (float(text.split()[0]) for text in (last.partition(": ")[2], last[-5:]))
    assert after < 0.011 < 0.1 < before
