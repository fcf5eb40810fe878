"""The engine that runs, and the library that was made for it."""

from __future__ import annotations

import importlib
import os
import re
import subprocess
import sys
from pathlib import Path

import inerter
import inerter.plugin
import mujoco
import numpy as np
import pytest

VERSION = mujoco.mj_versionString()
NUMBERS = [int(number) for number in re.findall(r"\d+", VERSION)]

# two masses side by side, 113 kg of inertance between them: no place in the engine's matrix
SIBLINGS = """
<mujoco>
  <extension><plugin plugin="inerter.device"/></extension>
  <option gravity="0 0 0" integrator="{}" timestep="0.001"/>
  <worldbody>
    <body><joint name="a" type="slide"/><geom size="0.1" mass="25"/></body>
    <body pos="1 0 0"><joint name="b" type="slide"/><geom size="0.1" mass="181.75"/></body>
  </worldbody>
  <tendon><fixed name="strut">
    <joint joint="a" coef="-1"/><joint joint="b" coef="1"/>
  </fixed></tendon>
  <actuator><plugin plugin="inerter.device" tendon="strut">
    <config key="inertance" value="113"/>
  </plugin></actuator>
</mujoco>"""


def test_it_is_the_engine_that_is_to_be_tested() -> None:
    asked = os.environ.get("INERTER_TESTED_ENGINE")
    if asked is None:
        pytest.skip("`make versions` says which")
    assert asked == VERSION
    assert asked in mujoco.__file__


def test_the_library_is_made_for_it() -> None:
    assert inerter.plugin_path().parent.name == VERSION
    assert VERSION in inerter.plugin.plugin_versions()
    assert inerter.plugin_path(VERSION) == inerter.plugin_path()


@pytest.mark.parametrize("integrator", ["Euler", "implicit", "implicitfast", "discrete", "RK4"])
def test_two_masses_share_a_push(integrator: str) -> None:
    """M a = (f, 0), M = diag(m1, m2) + b (1 -1; -1 1): all integrators hit it."""
    model = mujoco.MjModel.from_xml_string(SIBLINGS.format(integrator))
    data = mujoco.MjData(model)
    data.qfrc_applied[0] = 100
    mujoco.mj_step(model, data, 200)
    inertia = np.diag([25, 181.75]) + 113 * np.array([[1, -1], [-1, 1]])
    expected = np.linalg.solve(inertia, [100, 0]) * 0.2
    np.testing.assert_allclose(data.qvel, expected, rtol=1e-10)


def test_many_at_once_or_a_word_about_it() -> None:
    if NUMBERS >= [3, 17]:
        assert importlib.import_module("inerter.engine_batch").batch.Batch
        return
    done = subprocess.run(
        [sys.executable, "-m", "inerter", "suspension", "evaluate", "--case", "tables"],
        capture_output=True, text=True, check=False, cwd=Path(sys.prefix),
    )  # fmt: skip
    assert done.returncode != 0
    assert "mujoco.batch, which is in MuJoCo 3.17 and newer" in done.stderr
    assert VERSION in done.stderr
    assert "Traceback" not in done.stderr


def test_an_engine_at_fault_is_told_once_where_it_matters(tmp_path: Path) -> None:
    """MuJoCo 4.0.0 alone, the Newton solver with a sparse constraint Jacobian."""
    script = (
        "import inerter, mujoco, sys\n"
        "for jacobian in ('dense', 'sparse', 'sparse'):\n"
        "    xml = sys.argv[1].replace('timestep', f'jacobian=\"{jacobian}\" timestep')\n"
        "    mujoco.MjModel.from_xml_string(xml)\n"
        "    print(jacobian, file=sys.stderr, flush=True)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", script, SIBLINGS.format("Euler")],
        capture_output=True, text=True, check=True, cwd=tmp_path,
    )  # fmt: skip
    before, after = done.stderr.split("dense", 1)
    assert "3767" not in before
    assert after.count("mujoco #3767") == (NUMBERS == [4, 0, 0])
