"""The gallery of Exudyn scripts, and devices in Exudyn's own examples where these are at hand.

Exudyn's examples are not in its package: clone its repository and name the folder in
EXUDYN_EXAMPLES, as main/pythonDev/Examples. Those that do not run on the installed version, or want
a package that is absent, tell so and are skipped.
"""

from __future__ import annotations

import json
import os
import runpy
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("exudyn.itemInterface")

HERE = Path(__file__).parent
GALLERY = HERE.parents[1] / "docs" / "examples" / "exudyn"
FOLDER = os.environ.get("EXUDYN_EXAMPLES", "")
EXAMPLES = sorted(Path(FOLDER).glob("*.py")) if FOLDER else []
LONGEST = 60.0
FINER = 4
COARSE = 0.02
"""Above this share of it an integral is not known well enough to show an error of the element."""


def told(path: Path, finer: int = 1) -> dict[str, Any]:
    """What `exudyn_example.py` tells of a script; skipped where it tells nothing."""
    command = [sys.executable, str(HERE / "exudyn_example.py"), str(path), str(finer)]
    try:
        done = subprocess.run(
            command, capture_output=True, text=True, timeout=LONGEST, check=False,
            stdin=subprocess.DEVNULL,
        )  # fmt: skip
    except subprocess.TimeoutExpired:
        pytest.skip(f"takes more than {LONGEST:g} s")
    lines = done.stdout.strip().splitlines()
    if not lines or not lines[-1].startswith("{"):
        pytest.skip(f"ends by itself: {done.stderr.strip()[-200:]}")
    found = json.loads(lines[-1])
    if "none" in found:
        assert "inerter" not in found["none"], found["none"]
        pytest.skip(found["none"])
    return found


def gallery(name: str) -> dict[float, Any]:
    return runpy.run_path(str(GALLERY / f"{name}.py"))["main"]()


def test_quarter_car() -> None:
    """Its frequencies are checked in the script."""
    without, there = gallery("quarter_car").values()
    assert there < 0.9 * without


def test_slider_crank() -> None:
    """Energy is checked in the script; the inerter evens the speed out."""
    without, there = gallery("slider_crank").values()
    assert there < 0.2 * without


def test_beam() -> None:
    without, there = gallery("beam").values()
    assert without > 0.9
    assert there < 0.5


def test_rolling_vehicle() -> None:
    for found, formula in gallery("rolling_vehicle").values():
        assert found == pytest.approx(formula, rel=2e-3)


@pytest.mark.skipif(not EXAMPLES, reason="no Exudyn examples: name their folder in EXUDYN_EXAMPLES")
@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_exudyns_own(path: Path) -> None:
    """The force's impulse is b (v - v0), its work b (v^2 - v0^2) / 2; v as Exudyn tells it.

    The sums over steps tell these integrals as well as the steps resolve the force: by what the
    trapezoidal sum over every second step differs, four times its own error. The solvers are of
    second order too, so that the difference bounds both; 1e-9 for rounding.
    """
    found = told(path)
    assert found["velocity"] < (1e-6 if found["carried"] else 1e-12)
    known = {name: found[f"{name}_known"] for name in ("momentum", "energy")}
    if not found["moves"]:
        pytest.skip("its body is at rest")
    if max(known.values()) > COARSE:
        pytest.skip(f"its steps do not resolve the force: {known}")
    beyond = [name for name, bound in known.items() if not found[name] < bound + 1e-9]
    if beyond:
        # the solver's own error goes with the square of the step, with contacts and friction with
        # the step; one of the element would stay
        finer = told(path, FINER)
        for name in beyond:
            assert finer[name] < 1.5 * found[name] / FINER, (name, found, finer)
