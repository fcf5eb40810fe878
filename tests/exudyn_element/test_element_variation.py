"""exudyn.processing.ParameterVariation over the device's parameters, in one process and in two."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("exudyn.itemInterface")

from element_variation import VARIED, simulate


def test_parameter_variation() -> None:
    """Both ways give what single runs give, to the last bit, and the parameters matter."""
    script = Path(__file__).with_name("element_variation.py")
    done = subprocess.run(
        [sys.executable, str(script)], capture_output=True, text=True, timeout=120, check=False
    )
    assert done.returncode == 0, done.stderr
    in_turn, at_once = json.loads(done.stdout.strip().splitlines()[-1])
    points = [
        {"inertance": inertance, "coulomb_force": force}
        for inertance in VARIED["inertance"]
        for force in VARIED["coulomb_force"]
    ]
    single = [simulate(point) for point in points]
    assert len(set(single)) == len(points) == 6
    for parameters, values in (in_turn, at_once):
        listed = [
            dict(zip(parameters, row, strict=True))
            for row in zip(*parameters.values(), strict=True)
        ]
        assert sorted(map(str, listed)) == sorted(map(str, points))
        for point, value in zip(listed, values, strict=True):
            assert value == single[points.index(point)]
