"""Names from strangers' files stay text: on pages, in the terminal, in file names."""

from __future__ import annotations

import itertools
from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np
import pytest
from inerter import Device
from inerter.commands import app
from inerter.device_file import device_text, read_device
from inerter.pictures.png import png
from inerter.records import read_records
from inerter.report.page import render_report
from inerter.simulate.page import render_page
from inerter.simulate.run import run_model
from made_reports import TOML, XML, diagnosis, run
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from simulate_models import device, oscillator, written
from test_report import Reader
from test_report_browser import browse, needs_browser
from typer.testing import CliRunner

SCRIPT = "<script>document.title='taken'</script>"
IMAGE = "<img src=x onerror=document.title='taken'>"
LINK = '<a href="javascript:document.title=1">x</a>'
NAMES = [SCRIPT, IMAGE, LINK, "&lt;b&gt; ]]> \" '", "{{ 7 * 7 }}{% raw %}", "\u202e\u2028"]


def attribute(text: str) -> str:
    """A text as an attribute of MJCF."""
    for sign, entity in (("&", "&amp;"), ("<", "&lt;"), (">", "&gt;"), ('"', "&quot;")):
        text = text.replace(sign, entity)
    return text


def hostile_report(name: str) -> str:
    curves = replace(run(name, held=True), quantity=name, unit=name)
    warnings = [{"code": "outliers", "text": f"column {name} stands out"}]
    made = diagnosis(curves, method={"split": name, name: name, "channels": [name]})
    records = [replace(record, warnings=warnings) for record in made.records]
    return render_report(replace(made, records=records, verdict=name), TOML, XML)


def hostile_run(folder: Path, name: str) -> str:
    named = attribute(name)
    xml = oscillator(device(name=named, inertance=50), joint="").replace(
        "<mujoco>", f'<mujoco model="{named}">'
    )
    xml = xml.replace('joint name="x"', f'joint name="{named}"').replace(
        'joint="x"', f'joint="{named}"'
    )
    return render_page(run_model(written(folder, xml, "<b>model.xml"), 0.05))


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("page", ["report", "simulation"])
def test_a_page_shows_names_as_they_are(name: str, page: str, tmp_path: Path) -> None:
    source = hostile_report(name) if page == "report" else hostile_run(tmp_path, name)
    assert SCRIPT not in source
    assert IMAGE not in source
    # all but the sign that turns what follows it
    shown = name.replace("\u202e", "\ufffd")
    assert " ".join(shown.split()) in " ".join(Reader(source).text.split())
    assert "\u202e" not in source.partition("plotly.js v")[0]
    assert r"\u202e" not in source.partition("plotly.js v")[0]


@needs_browser
@pytest.mark.parametrize("page", ["report", "simulation"])
def test_a_browser_runs_nothing_of_a_name(page: str, tmp_path: Path) -> None:
    """The page's own policy would let scripts in it run: nothing may become one."""
    name = SCRIPT + IMAGE + LINK
    source = hostile_report(name) if page == "report" else hostile_run(tmp_path, name)
    told = "<script>addEventListener('load', () => { if (document.title == 'taken' || "
    told += "document.querySelector('img, a[href^=javascript], svg a')) console.error('taken'); })"
    # the console of the frame is looked at by `browse`
    browse(tmp_path, source.replace("</body>", f"{told}</script></body>"), 1000)


@needs_browser
def test_the_browser_would_have_told(tmp_path: Path) -> None:
    page = "<!doctype html><title>x</title><body><p>x<script>console.error('taken')</script></body>"
    with pytest.raises(AssertionError, match="taken"):
        browse(tmp_path, page, 1000)


# --- from a file to the results ----------------------------------------------------------------


def hostile_record(folder: Path) -> Path:
    """A record whose file, comment, columns and runs all have such names."""
    t = 1e-3 * np.arange(2000)
    rows = [
        f"{a:.3f},{0.01 * np.sin(20 * a):.9g},{-200 * np.sin(20 * a):.9g},1,{SCRIPT}" for a in t
    ]
    path = folder / "[bold]<script>alert(1)<script>[/red] \x1b]0;x\x07.csv"
    path.parent.mkdir(parents=True)
    head = f"# {SCRIPT} \x1b[2J\ntime,displacement,force,{IMAGE},run"
    path.write_text("\n".join([head, *rows]))
    return path


def test_a_record_with_such_names_is_prepared(tmp_path: Path) -> None:
    path = hostile_record(tmp_path)
    out = tmp_path / "[/b]:smile:"
    done = CliRunner().invoke(app, ["prepare", str(path), "--out", str(out)])
    assert done.exit_code == 0, done.output
    assert "\x1b" not in done.output.replace("\x1b[1m", "").replace("\x1b[0m", "")
    assert "[/b]:smile:" in done.stdout.replace("\n", "")
    # file names are tame, what stands in the files is as it was
    names = sorted(p.name for p in out.iterdir())
    assert all(set("<>[]\x1b/ ").isdisjoint(name) for name in names), names
    (again,) = read_records([p for p in out.iterdir() if p.suffix == ".csv"])
    assert list(again.extra) == [IMAGE]


def test_what_is_wrong_with_such_a_file_is_one_tame_line(tmp_path: Path) -> None:
    path = hostile_record(tmp_path)
    path.write_text(path.read_text().replace("force", "\x1b[31mforce"))
    done = CliRunner().invoke(app, ["diagnose", str(path), "--out", str(tmp_path / "out")])
    assert done.exit_code == 2
    assert len(done.stderr.splitlines()) == 1
    assert "\x1b" not in done.stderr


# --- models ------------------------------------------------------------------------------------

BOMB = """<!DOCTYPE mujoco [<!ENTITY a "aaaaaaaaaa">{entities}
<!ENTITY file SYSTEM "file://{secret}">]>
<mujoco model="&z;&file;"><worldbody/></mujoco>"""


def test_entities_of_a_model_stay_what_they_are(tmp_path: Path) -> None:
    """Twenty doublings, and a file from elsewhere."""
    secret = tmp_path / "secret.txt"
    secret.write_text("the secret")
    letters = "abcdefghijklmnopqrstuvwxyz"
    entities = "".join(f'<!ENTITY {b} "{f"&{a};" * 10}">' for a, b in itertools.pairwise(letters))
    path = written(tmp_path, BOMB.format(entities=entities, secret=secret))
    page = render_page(run_model(path, 0.01))
    assert "the secret" not in page
    assert "aaaaaaaaaa" not in page
    assert mujoco.MjSpec.from_file(str(path)).modelname == "&z;&file;"


@pytest.mark.parametrize("what", ["include", "mesh", "hfield", "texture", "skin"])
def test_a_model_brings_nothing_of_another_file_to_light(what: str, tmp_path: Path) -> None:
    (tmp_path / "secret.txt").write_text("the secret\n" * 9)
    (tmp_path / "in").mkdir()
    assets = {
        "include": '<include file="../secret.txt"/>',
        "mesh": '<asset><mesh name="m" content_type="model/obj" file="../secret.txt"/></asset>',
        "hfield": '<asset><hfield name="m" size="1 1 1 1" file="../secret.txt"/></asset>',
        "texture": '<asset><texture name="m" type="2d" file="../secret.txt"/></asset>',
        "skin": '<asset><skin name="m" file="../secret.txt"/></asset>',
    }
    path = written(tmp_path / "in", f"<mujoco>{assets[what]}</mujoco>")
    done = CliRunner().invoke(app, ["simulate", str(path), "--out", str(tmp_path / "out")])
    assert done.exit_code == 2
    assert "the secret" not in done.output
    assert not (tmp_path / "out").exists()


# --- files of results --------------------------------------------------------------------------


ODD_TITLES = ["\x1b[2J\x00", 'a"""b\n[device]\ninertance = 1', "\ud800"]


@pytest.mark.parametrize("name", [*NAMES, *ODD_TITLES])
def test_a_device_file_can_be_read_whatever_its_title(name: str, tmp_path: Path) -> None:
    text = device_text(Device(inertance=7), title=f"identified from {name}")
    (tmp_path / "device.toml").write_bytes(text.encode("utf-8", "replace"))
    assert read_device(tmp_path / "device.toml").given == {"inertance": 7.0}


@pytest.mark.parametrize("name", [*NAMES, "$\\frac{", "道路 1", "\x1b[2J"])
def test_a_picture_bears_any_name(name: str) -> None:
    figure = Figure()
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    axes.loglog([1, 1e3], [1, 1e3], label=name)
    axes.set_title(name)
    axes.legend()
    assert png(figure).startswith(b"\x89PNG")
    assert {text.get_text() for text in axes.get_xticklabels()} >= {r"$\mathdefault{10^{2}}$"}
    assert all(text.get_parse_math() for text in axes.get_xticklabels())
