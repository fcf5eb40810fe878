"""MuJoCo's own system identification fits the plugin's parameters through the spec."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import pytest

EXAMPLE = Path(__file__).parents[2] / "docs" / "examples" / "fit_with_mujoco_sysid.py"


def example(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    sysid = pytest.importorskip("mujoco.sysid")
    if not hasattr(sysid, "optimize"):
        pytest.skip('mujoco.sysid is not complete; pip install "mujoco[sysid]"')
    spec = importlib.util.spec_from_file_location("fit_with_mujoco_sysid", EXAMPLE)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    monkeypatch.setitem(sys.modules, "fit_with_mujoco_sysid", module)
    spec.loader.exec_module(module)
    return module


def test_both_ways_recover_the_device(monkeypatch: pytest.MonkeyPatch) -> None:
    fit = example(monkeypatch)
    monkeypatch.setattr(fit, "SECONDS", 3.0)
    t, force, position = fit.measured()
    found = fit.by_sysid(t, force, position)
    for key, value in fit.TRUTH.items():
        # 0.1 um of noise on the position
        assert found[key] == pytest.approx(value, rel=0.01), key
    record = fit.record_of(t, force, position)
    other = fit.identify([record], ["lugre"], intervals="normal").best
    for key, value in fit.TRUTH.items():
        each = other.parameters[key]
        assert abs(each.value - value) < 4 * each.stderr + 1e-3 * value, key
