"""What the page builder makes: every picture that is shown, and a word where one is missing."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest
from inerter.diagnose.decision import CRITERIA

DOCS = Path(__file__).resolve().parents[2] / "docs"
sys.path.insert(0, str(DOCS))

import figures  # noqa: E402
import generated  # noqa: E402


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    for module, name in ((figures, "FOLDER"), (generated, "FOLDER")):
        monkeypatch.setattr(module, name, tmp_path)
    monkeypatch.setattr(generated, "KEPT", tmp_path / "made_of.json")
    return tmp_path


def test_every_picture_that_a_page_shows_is_made_once(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(generated, "render_scenes", lambda: "no graphics in this test")
    assert generated.make() == "no graphics in this test"
    for page in DOCS.glob("*.md"):
        for name in re.findall(r"\(figures/([\w.]+)\)", page.read_text(encoding="utf-8")):
            assert (folder / name).exists(), f"{page.name}: {name}"
    gallery = (folder / "gallery.md").read_text(encoding="utf-8")
    for picture in folder.glob("*.svg"):
        assert gallery.count(picture.name) == 1, picture.name

    # again: nothing is drawn, but graphics may be there now
    monkeypatch.setattr(figures, "draw", lambda: pytest.fail("drawn again"))
    monkeypatch.setattr(generated, "render_scenes", lambda: None)
    assert generated.make() is None
    monkeypatch.setattr(generated, "render_scenes", lambda: pytest.fail("rendered again"))
    assert generated.make() is None


def test_a_missing_scene_is_said_and_not_shown() -> None:
    text = generated.scenes("no OpenGL")
    assert "not rendered in this build: no OpenGL" in text
    assert "](figures/" not in text
    assert generated.scenes(None).count("](figures/scene_") == text.count("## ")


def test_every_bound_of_a_diagnosis_is_printed_with_its_reason() -> None:
    rows = [line.split(" | ") for line in generated.criteria().splitlines()[2:]]
    printed = {row[0].strip("| `"): float(row[1]) for row in rows}
    assert printed == {name: value for name, value, _, _ in CRITERIA.rows()}
    assert all(len(row) == 4 and len(row[3]) > 5 for row in rows)


def test_every_law_says_what_it_leaves_out() -> None:
    table = generated.not_modelled()
    for law in (*figures.FRICTION, "series", "pipe", "gas_spring", "end_stop", "friction_play"):
        assert re.search(rf"\| `{law}\.c` \| \w.*\w.* \|", table), law


def test_the_parameter_table_is_written_from_the_core(tmp_path: Path) -> None:
    kept = generated.README.read_text(encoding="utf-8")
    copy = tmp_path / "README.md"
    copy.write_text(re.sub(r"\n\| `coulomb_force`.*", "\n| `old` | N |", kept), encoding="utf-8")
    assert copy.read_text(encoding="utf-8") != kept
    generated.write_parameter_table(copy)
    assert copy.read_text(encoding="utf-8") == kept
