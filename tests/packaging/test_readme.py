"""What the READMEs show runs."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]


def blocks(language: str) -> list[str]:
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    return re.findall(rf"```{language}\n(.*?)```", text, re.S)


def test_model_loads_and_moves_as_an_inerter() -> None:
    """1 m/s apart, then only friction of at most 14 N brakes 180 kg and 113 kg of inertance."""
    (xml,) = blocks("xml")
    model = mujoco.MjModel.from_xml_string(xml)
    model.opt.gravity[:] = 0
    data = mujoco.MjData(model)
    data.qvel[0] = 1.0
    mujoco.mj_step(model, data, 100)
    lost = 10 / (180 + 113) * 100 * model.opt.timestep
    assert data.qvel[0] == pytest.approx(1 - lost, rel=2e-3)


def test_python_runs() -> None:
    (code,) = [code for code in blocks("python") if "exudyn" not in code]
    names: dict[str, object] = {}
    exec(code, names)
    force = np.asarray(names["force"])
    assert force.shape == (2000,)
    assert np.all(np.isfinite(force))


def test_exudyn_runs() -> None:
    """Without a force the box keeps its speed."""
    exudyn = pytest.importorskip("exudyn")
    (code,) = [code for code in blocks("python") if "exudyn" in code]
    names: dict[str, Any] = {}
    exec(code, names)
    settings = exudyn.SimulationSettings()
    settings.timeIntegration.numberOfSteps = 100
    settings.timeIntegration.endTime = 0.1
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    names["mbs"].SolveDynamic(settings, solverType=exudyn.DynamicSolverType.RK44)
    assert names["strut"].Evaluate()["velocity"] == pytest.approx(1.0, abs=1e-12)
    assert names["strut"].Evaluate()["displacement"] == pytest.approx(0.1, abs=1e-12)


def test_exudyn_page_runs() -> None:
    pytest.importorskip("exudyn")
    text = (ROOT / "docs" / "exudyn.md").read_text(encoding="utf-8")
    (code,) = re.findall(r"```python\n(.*?)```", text, re.S)
    names: dict[str, Any] = {}
    exec(code, names)
    # 10 N of friction brake 180 kg and 113 kg of inertance
    found = names["strut"].Evaluate()
    assert found["velocity"] == pytest.approx(1 - 0.5 * 10 / 293, rel=1e-3)
    assert found["friction"] == pytest.approx(10, rel=1e-2)


def test_links_lead_somewhere() -> None:
    folders = ("docs", "plugin_c", "mjcf_models", "exudyn_models", "python")
    pages = [page for folder in folders for page in (ROOT / folder).rglob("*.md")]
    # what the page builder makes is not there in a fresh clone: see test_generated.py
    made = (ROOT / "docs" / "figures").resolve()
    for document in [*ROOT.glob("*.md"), *(page for page in pages if made not in page.parents)]:
        text = document.read_text(encoding="utf-8")
        for target in re.findall(r"\]\(([^)#:]+)\)", text):
            place = (document.parent / target).resolve()
            assert place.exists() or made in place.parents, f"{document.name}: {target}"
