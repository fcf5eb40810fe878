"""What the READMEs show runs."""

from __future__ import annotations

import re
from pathlib import Path

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
    (code,) = blocks("python")
    names: dict[str, object] = {}
    exec(code, names)
    force = np.asarray(names["force"])
    assert force.shape == (2000,)
    assert np.all(np.isfinite(force))


def test_links_lead_somewhere() -> None:
    for document in [*ROOT.glob("*.md"), *ROOT.glob("docs/*.md"), *ROOT.glob("*/README.md")]:
        text = document.read_text(encoding="utf-8")
        for target in re.findall(r"\]\(([^)#:]+)\)", text):
            assert (document.parent / target).exists(), f"{document.name}: {target}"
