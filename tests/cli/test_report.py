"""The report: complete, self-contained, safe with any name, and drawn by a real browser."""

from __future__ import annotations

import base64
import html
import json
import os
import re
import shutil
import subprocess
from collections.abc import Iterator
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from inerter.diagnose.result import (
    Accuracy,
    Diagnosis,
    Finding,
    ParameterValue,
    RecordSummary,
    Rival,
    RunCurves,
    TablePoints,
    Unexplained,
)
from inerter.report import text, thinning
from inerter.report.figures import loop_figure
from inerter.report.page import render_report, write_report
from inerter.report.plotting import to_script
from inerter.report.terminal import print_summary
from rich.console import Console

HOSTILE = "<script>alert(1)</script>.csv"
TOML = '[device]\ninertance = 100.0\nfriction = "coulomb"\n'
XML = '<mujoco model="a"><worldbody/></mujoco>'
VOID = {"meta", "link", "br", "img", "input", "hr"}
RUN_PLOTS = 7


def run(name: str, samples: int = 900, held: bool = False, part: bool = False) -> RunCurves:
    """An inerter of 100 kg with 40 N of Coulomb friction, moved as a sine."""
    time = np.arange(samples) / 300
    turn = 2 * np.pi * 1.5
    x = 0.02 * np.sin(turn * time)
    v = 0.02 * turn * np.cos(turn * time)
    a = -(turn**2) * x
    noise = np.random.default_rng(0).normal(0, 1, samples)
    holdout = np.full(samples, held)
    if part:
        holdout[samples // 3 : samples // 2] = True
    return RunCurves(
        name,
        "holdout" if held else "fit",
        time,
        x,
        v,
        a,
        100 * a + 40 * np.sign(v) + noise,
        95 * a,
        100 * a + 40 * np.tanh(v / 0.002),
        holdout,
        np.ones(samples, bool),
    )


def diagnosis(*curves: RunCurves, **changes: Any) -> Diagnosis:
    """A diagnosis by hand: Coulomb friction found."""
    warnings = [{"code": "outliers", "text": "3 samples <b>stand out</b> & more"}]
    finding = Finding(
        "coulomb_friction",
        None,
        0.998,
        {"coulomb_force": ParameterValue(40.0, 0.4, "N")},
        40.0,
        1.1,
        "f_c = 40 N",
        [Rival("hysteretic_friction", 0.06, "dahl")],
    )
    parameters = {"inertance": ParameterValue(100.0, 0.5, "kg"), **finding.parameters}
    made = Diagnosis(
        [RecordSummary(c.name, len(c.time), 300.0, c.role, warnings) for c in curves],
        Accuracy({"friction": "none", "inertance": 95.0}, 40.0, 0.3),
        [finding],
        Accuracy({"friction": "coulomb", "inertance": 100.0, "coulomb_force": 40.0}, 1.1, 0.01),
        0.9,
        Unexplained(False, 0.1, [], "What remains is noise."),
        {"mujoco": 1.1, "exudyn": None, "reference": None},
        "The simulation misses the measured force by 40 N rms.",
        parameters,
        {
            "cutoff": 20.0,
            "cutoffs_tried": [5.0, 10.0, 20.0, 40.0],
            "force_error_at_cutoffs": [9.0, 4.0, 2.0, 6.0],
            "split": "held out: b",
            "channels": ["displacement"],
            "held_out_samples": 900,
        },
        list(curves),
    )
    return replace(made, **changes)


def table() -> TablePoints:
    """A bench table with a point without motion, whose ratio is not finite."""
    frequency = np.array([0.5, 1.0, 2.0, 4.0, 8.0])
    acceleration = np.array([0.0, 1.0, 2.0, 3.0, 4.0])
    held = np.array([False, True, False, True, False])
    force = 100 * acceleration
    return TablePoints(frequency, acceleration, force + 40, force, force + 39, held)


def two_runs() -> Diagnosis:
    """The usual case."""
    return diagnosis(run("a"), run("b", held=True))


def table_only() -> Diagnosis:
    """A diagnosis of a bench table."""
    return diagnosis(points=table(), method={"split": "every second frequency"})


CASES = {
    "two runs": two_runs,
    "one run": lambda: diagnosis(run("only", part=True)),
    "many runs": lambda: diagnosis(*(run(f"run {i}", 4000, held=i == 29) for i in range(30))),
    "long run": lambda: diagnosis(run("long", 300_000, part=True)),
    "no findings": lambda: replace(two_runs(), findings=[], verdict="The simulation is right."),
    "table": table_only,
    "nothing to draw": lambda: diagnosis(method={}),
    "hostile name": lambda: diagnosis(run(HOSTILE, held=True)),
    "few samples": lambda: diagnosis(run("short", 5, held=True)),
    "nothing moves": lambda: diagnosis(
        replace(run("still", held=True), displacement=np.zeros(900), velocity=np.zeros(900))
    ),
    "not finite": lambda: diagnosis(
        replace(run("gap", held=True), extended=np.full(900, np.nan)),
        replace(run("wild"), force=np.where(np.arange(900) % 7 == 0, np.inf, 1.0)),
        extended=Accuracy({"friction": "none"}, float("nan"), float("nan")),
        noise_floor=float("nan"),
    ),
    "effect without words": lambda: replace(
        two_runs(), findings=[Finding("backlash", None, 0.9, {}, 40.0, 2.0, "a gap.", [])]
    ),
}


@pytest.fixture(scope="module", params=CASES)
def page(request: pytest.FixtureRequest) -> tuple[str, str]:
    """Every case, rendered: its name and the page."""
    return request.param, render_report(CASES[request.param](), TOML, XML)


class Reader(HTMLParser):
    """Tags, attributes, visible text and scripts of a page; complains of unbalanced tags."""

    def __init__(self, source: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.open: list[str] = []
        self.text = ""
        self.styles = ""
        self.data: dict[str, Any] = {}
        self._id: str | None = None
        self.feed(source)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)
        if tag == "script":
            self._id = dict(attrs).get("id")

    def handle_endtag(self, tag: str) -> None:
        assert self.open
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        where = self.open[-1] if self.open else ""
        if where == "style":
            self.styles += data
        elif where == "script":
            if self._id:
                self.data[self._id] = json.loads(data, parse_constant=_no_constant)
        else:
            self.text += data


def _no_constant(word: str) -> None:
    raise AssertionError(f"{word} is not JSON")


def numbers(value: Any) -> Iterator[np.ndarray]:
    """Every number of a plot, base64 arrays decoded."""
    if isinstance(value, dict) and "bdata" in value:
        yield np.frombuffer(base64.b64decode(value["bdata"]), dtype=np.dtype(value["dtype"]))
    elif isinstance(value, dict):
        for part in value.values():
            yield from numbers(part)
    elif isinstance(value, list):
        for part in value:
            yield from numbers(part)
    elif isinstance(value, float):
        yield np.array([value])


def test_page_is_balanced_html_that_loads_nothing(page: tuple[str, str]) -> None:
    reader = Reader(page[1])
    names = [tag for tag, _ in reader.tags]
    assert names.count("h1") == names.count("main") == 1
    assert not {"link", "img", "iframe", "object", "embed", "base", "form"} & set(names)
    for tag, attributes in reader.tags:
        assert "src" not in attributes, tag
        assert not any(name.startswith("on") for name in attributes), tag
        assert (attributes.get("href") or "#").startswith("#")
        assert "url(" not in (attributes.get("style") or "")
    assert "url(" not in reader.styles
    assert "@import" not in reader.styles
    policy = next(a["content"] for _, a in reader.tags if a.get("http-equiv"))
    assert policy is not None
    assert policy.startswith("default-src 'none'")


def test_page_is_small_and_holds_plotly_once(page: tuple[str, str]) -> None:
    assert len(page[1].encode()) < 8_000_000
    assert page[1].count("* plotly.js v") == 1


def test_plots_hold_finite_numbers_only(page: tuple[str, str]) -> None:
    data = Reader(page[1]).data
    for values in numbers(data["plots"]):
        assert np.isfinite(values).all()


def test_every_place_for_a_plot_has_one(page: tuple[str, str]) -> None:
    reader = Reader(page[1])
    plots = reader.data["plots"]
    places = {a["data-plot"] for _, a in reader.tags if "data-plot" in a}
    per_run = [set(made) for made in plots["runs"]]
    assert places == set(plots["single"]).union(*per_run)
    assert all(made == per_run[0] for made in per_run)


def test_verdict_comes_first_and_the_model_can_be_copied() -> None:
    reader = Reader(render_report(two_runs(), TOML, XML))
    heading = reader.text.index("The simulation lacks Coulomb friction")
    verdict = reader.text.index("misses the measured force")
    finding = reader.text.index("dry sliding in seals")
    assert heading < verdict < finding < reader.text.index("Parameters", finding)
    assert TOML in reader.text
    assert XML in reader.text
    assert "40.00 ± 0.40 N" in reader.text
    assert "friction with memory (dahl), 6\u00a0%" in reader.text
    assert "not run" in reader.text
    copies = {a["data-copy"] for tag, a in reader.tags if tag == "button"}
    assert copies == {a.get("id") for tag, a in reader.tags if tag == "pre"}


def test_bars_are_the_errors_to_scale() -> None:
    reader = Reader(render_report(two_runs(), TOML, XML))
    widths = [a["style"] for _, a in reader.tags if (a.get("class") or "").startswith("bar ")]
    assert widths == ["width:100.0%", "width:2.75%"]


def test_names_and_warnings_stay_text() -> None:
    source = render_report(diagnosis(run(HOSTILE, held=True)), "</pre><b>x", "<script>y</script>")
    reader = Reader(source)
    assert reader.text.count(HOSTILE) >= 2
    assert "<b>stand out</b> & more" in reader.text
    assert "</pre><b>x" in reader.text
    assert "alert(1)" not in "".join(re.findall(r"<script.*?</script>", source, re.DOTALL))


def test_script_data_cannot_end_its_script() -> None:
    value = ["</script><!--", "\u2028 & >"]
    made = to_script(value)
    assert not set("<>&\u2028") & set(made)
    assert json.loads(made) == value
    with pytest.raises(ValueError, match="not JSON compliant"):
        to_script([float("nan")])


def test_held_out_runs_are_pictured_first_and_the_rest_counted() -> None:
    reader = Reader(render_report(CASES["many runs"](), TOML, XML))
    options = reader.text.split("Run\n")[1]
    assert options.strip().startswith("run 29 (held out)")
    assert "18 further runs without pictures" in reader.text


# --- writing -----------------------------------------------------------------------------------


def test_report_replaces_a_file(tmp_path: Path) -> None:
    path = tmp_path / "report.html"
    path.write_text("old")
    write_report(two_runs(), path, TOML, XML)
    assert path.read_text(encoding="utf-8") == render_report(two_runs(), TOML, XML)
    assert list(tmp_path.iterdir()) == [path]


def test_missing_folder_is_named(tmp_path: Path) -> None:
    with pytest.raises(OSError, match=r"cannot write report\.html") as caught:
        write_report(two_runs(), tmp_path / "no" / "report.html", TOML, XML)
    assert str(tmp_path / "no") in str(caught.value)


@pytest.mark.skipif(
    not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may write anywhere"
)
def test_unwritable_folder_is_named(tmp_path: Path) -> None:
    tmp_path.chmod(0o500)
    with pytest.raises(PermissionError, match=r"cannot write report\.html"):
        write_report(two_runs(), tmp_path / "report.html", TOML, XML)
    tmp_path.chmod(0o700)
    assert list(tmp_path.iterdir()) == []


def test_failed_replacement_leaves_the_old_file_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "report.html"
    path.write_text("old")

    def fail(*args: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "replace", fail)
    with pytest.raises(OSError, match="No space left"):
        write_report(two_runs(), path, TOML, XML)
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_picture_is_a_wide_png(tmp_path: Path) -> None:
    path = tmp_path / "loop.png"
    loop_figure(two_runs(), path)
    header = path.read_bytes()[:24]
    assert header[:8] == b"\x89PNG\r\n\x1a\n"
    assert int.from_bytes(header[16:20], "big") == 1800
    with pytest.raises(ValueError, match="tables"):
        loop_figure(table_only(), path)


# --- words and numbers -------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("value", "shown"),
    [
        (ParameterValue(65568.0, 17808.0, "N/m"), "66\u202f000 ± 18\u202f000 N/m"),
        (ParameterValue(113.04, 0.2, "kg"), "113.04 ± 0.20 kg"),
        (ParameterValue(-0.16, 0.0092, "1"), "−0.1600 ± 0.0092"),
        (ParameterValue(-4.76e-4, 2.6e-5, "s"), "(−4.76 ± 0.26) × 10⁻⁴ s"),
        (ParameterValue(1.14, 5e-12, "m/s"), "1.14 m/s (error not known)"),
        (ParameterValue(2.0, float("nan"), "N*s^2/m^2"), "2.00 N·s²/m² (error not known)"),
        (ParameterValue(float("nan"), 1.0, "N"), "–"),
        (ParameterValue(0.0, 0.5, "N"), "0.00 ± 0.50 N"),
    ],
)
def test_values_to_the_last_digit_that_counts(value: ParameterValue, shown: str) -> None:
    assert text.with_error(value) == shown


@pytest.mark.parametrize(
    ("value", "shown"),
    [
        (999.99, "1000"),
        (0.0017, "0.00170"),
        (1.2e-5, "1.20 × 10⁻⁵"),
        (0, "0"),
        (None, "–"),
        (float("inf"), "–"),
        (-68.77, "−68.8"),
        (24841.0, "24\u202f800"),
    ],
)
def test_numbers(value: float | None, shown: str) -> None:
    assert text.number(value) == shown


@pytest.mark.parametrize("count", [1, 2, 999, 1000, 1001, 5003, 100_000])
def test_thinning_keeps_extremes_order_and_limit(count: int) -> None:
    y = np.random.default_rng(count).normal(size=count)
    keep = thinning.extremes(y, 1000)
    assert len(keep) <= 1000
    assert (np.diff(keep) > 0).all()
    assert y[keep].max() == y.max()
    assert y[keep].min() == y.min()


def test_terminal_says_it_all_and_obeys_no_name() -> None:
    name = "[bold]\x1b[31mred.csv"
    console = Console(width=110, record=True, file=open(os.devnull, "w"))  # noqa: SIM115
    print_summary(diagnosis(run(name, held=True)), console)
    console.file.close()
    shown = console.export_text()
    assert "40.0 N → 1.10 N" in shown
    assert "Coulomb friction" in shown
    assert "or friction with memory" in shown
    assert "outliers: 3 samples <b>stand out</b>" in re.sub(r"\s+", " ", shown)
    assert "[bold]\ufffd[31mred.csv" in shown
    assert "\x1b" not in shown


# --- in a browser ------------------------------------------------------------------------------

BROWSER = next(
    filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None
)
needs_browser = pytest.mark.skipif(BROWSER is None, reason="no chromium on PATH")

# a frame of a phone's width, and a word on what stands in it
_FRAME = """<!doctype html><body><iframe id="f" width="{width}" height="800" srcdoc="{page}">
</iframe><script>
const frame = document.getElementById("f");
frame.onload = () => setTimeout(() => {{
  const page = frame.contentDocument, root = page.documentElement;
  const all = Array.from(page.querySelectorAll("[data-plot]"));
  document.body.dataset.found = JSON.stringify({{
    overflow: root.scrollWidth - root.clientWidth,
    plots: all.length,
    drawn: all.filter((p) => p.querySelector("svg.main-svg")).length,
    wide: all.filter((p) => p.querySelector("svg.main-svg").clientWidth > p.clientWidth).length,
    lines: page.querySelectorAll("#pictures path.js-line").length,
  }});
}}, 300);
</script></body>"""


def browse(folder: Path, page: str, width: int, *flags: str) -> dict[str, int]:
    """What a browser makes of a page; fails when its console has an error to tell."""
    assert BROWSER is not None
    file = folder / "frame.html"
    file.write_text(_FRAME.format(width=width, page=html.escape(page)), encoding="utf-8")
    result = subprocess.run(
        [
            BROWSER,
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--disable-quic",
            "--no-first-run",
            "--disable-background-networking",
            "--disable-component-update",
            "--disable-sync",
            f"--user-data-dir={folder / 'profile'}",
            "--window-size=1400,1000",
            "--enable-logging=stderr",
            "--v=0",
            "--virtual-time-budget=8000",
            *flags,
            "--dump-dom",
            file.as_uri(),
        ],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert [row for row in result.stderr.splitlines() if "CONSOLE" in row] == []
    found = re.search(r'data-found="([^"]*)"', result.stdout)
    assert found, result.stderr[-2000:]
    return json.loads(html.unescape(found[1]))


@needs_browser
@pytest.mark.parametrize("width", [375, 1200])
@pytest.mark.parametrize("case", ["two runs", "table", "hostile name", "not finite"])
def test_browser_draws_every_plot_within_the_page(tmp_path: Path, case: str, width: int) -> None:
    dark = f"--blink-settings=preferredColorScheme={int(width != 375)}"
    found = browse(tmp_path, render_report(CASES[case](), TOML, XML), width, dark)
    expected = {"two runs": RUN_PLOTS + 1, "table": 3}.get(case, RUN_PLOTS + 1)
    assert found["plots"] == found["drawn"] == expected
    assert found["overflow"] <= 0
    assert found["wide"] == 0
    assert found["lines"] >= 4


@needs_browser
def test_browser_check_sees_a_script_error(tmp_path: Path) -> None:
    broken = render_report(two_runs(), TOML, XML).replace('read("plots")', 'read("nothing")')
    with pytest.raises(AssertionError, match="CONSOLE"):
        browse(tmp_path, broken, 375)
