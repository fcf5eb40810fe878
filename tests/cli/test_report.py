"""The report: complete, self-contained, and safe with any name."""

from __future__ import annotations

import base64
import io
import json
import os
import re
from collections.abc import Iterator
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from inerter.device_file import read_delay, read_device, read_filters
from inerter.diagnose.result import ParameterValue
from inerter.pictures import thinning
from inerter.pictures.plotting import to_script
from inerter.report import text
from inerter.report.figures import loop_figure
from inerter.report.output import write_outputs
from inerter.report.page import headline, render_report
from inerter.report.run_plots import run_plots
from inerter.report.terminal import print_summary
from made_reports import CASES, HOSTILE, TOML, XML, diagnosis, run, table_only, two_runs
from rich.console import Console

VOID = {"meta", "link", "br", "img", "input", "hr"}


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


def test_picture_replaces_a_file(tmp_path: Path) -> None:
    path, other = tmp_path / "loop.png", tmp_path / "made" / "loop.png"
    path.write_text("old")
    loop_figure(two_runs(), path)
    loop_figure(two_runs(), other)
    assert path.read_bytes() == other.read_bytes()
    assert sorted(tmp_path.rglob("*")) == sorted([path, other, other.parent])


def test_file_in_the_place_of_a_folder_is_named(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(NotADirectoryError, match="not a folder") as caught:
        loop_figure(two_runs(), tmp_path / "file" / "loop.png")
    assert str(tmp_path / "file") in str(caught.value)


@pytest.mark.skipif(
    not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may write anywhere"
)
def test_unwritable_folder_is_named(tmp_path: Path) -> None:
    tmp_path.chmod(0o500)
    with pytest.raises(PermissionError) as caught:
        loop_figure(two_runs(), tmp_path / "loop.png")
    tmp_path.chmod(0o700)
    assert str(tmp_path) in str(caught.value)
    assert list(tmp_path.iterdir()) == []


def test_failed_replacement_leaves_the_old_file_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "loop.png"
    path.write_text("old")
    replace_file = os.replace

    def fail(source: Path, target: Path) -> None:
        if "new" in Path(source).parts:
            raise OSError(28, "No space left on device")
        replace_file(source, target)

    monkeypatch.setattr(os, "replace", fail)
    with pytest.raises(OSError, match="No space left"):
        loop_figure(two_runs(), path)
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
        (ParameterValue(1.2e7, 6e11, "Pa"), "1.2 × 10⁷ ± 6.0 × 10¹¹ Pa"),
        (ParameterValue(0.0031, 4.9, "m^3"), "0.0031 ± 4.9 m³"),
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


@pytest.mark.parametrize(
    ("sentence", "shown"),
    [
        ("misses by 7.55e-05 N rms", "misses by 7.55 × 10⁻⁵\u00a0N rms"),
        ("stiffness 3e+08 N/m", "stiffness 3 × 10⁸\u00a0N/m"),
        ("run 1e5a of test_2e-3x stays", "run 1e5a of test_2e-3x stays"),
    ],
)
def test_sentences_have_powers_of_ten(sentence: str, shown: str) -> None:
    assert text.tidy(sentence) == shown


def test_what_explains_most_is_named_first() -> None:
    made = two_runs()
    (small,) = made.findings
    small = replace(small, rmse_before=4.0, rmse_after=0.5)
    large = replace(small, effect="viscous_friction", rmse_before=40.0, rmse_after=4.1)
    shown = Reader(render_report(replace(made, findings=[small, large]), TOML, XML)).text
    assert "The simulation lacks viscous friction and Coulomb friction" in shown
    assert shown.index("1. Viscous friction") < shown.index("2. Coulomb friction")


def test_a_curve_is_one_row_of_the_parameters() -> None:
    made = two_runs()
    nodes = {f"force_node_{i}": ParameterValue(i - 3.0, 0.5, "N") for i in range(1, 18)}
    curve = {"force_curve": " ".join(f"{v.value!r}" for v in nodes.values()), "curve_lower": -0.1}
    device = {**made.extended.device, **curve}
    made = replace(
        made,
        parameters={**made.parameters, **nodes},
        extended=replace(made.extended, device=device),
        baseline=replace(made.baseline, device={"friction_curve": "1.0 1.1 1.2"}),
    )
    shown = Reader(render_report(made, TOML, XML)).text
    assert "force_node" not in shown
    assert "a curve through 17 places from -2 to 14 N (each ± 0.5 N at most)" in shown
    assert "3 values" in shown
    assert "1.0 1.1 1.2" not in shown


def test_what_misses_a_fitted_run_is_not_called_right() -> None:
    made = two_runs()
    right = replace(made, findings=[], baseline=replace(made.baseline, rmse=1.0, nrmse=0.001))
    assert headline(right) == "No lack of the simulation is to be seen in these data"
    missed = replace(right, method={**right.method, "missed_runs": {"a": 40.0}})
    assert headline(missed) == "The simulation misses the force, and no known effect explains it"


def test_the_headline_is_as_sure_as_the_findings() -> None:
    made = two_runs()
    sure = replace(made.findings[0], confidence=0.99, members=(), looks_like=False)
    half = replace(made.findings[-1], confidence=0.3, members=(), looks_like=False)
    left = replace(made.unexplained, significant=True)
    told = replace(made, findings=[sure, half], unexplained=left)
    assert headline(told).startswith("The simulation lacks ")
    assert "perhaps " in headline(told)
    assert "what looks like " in headline(replace(told, findings=[replace(sure, looks_like=True)]))
    # more likely not there than there, and most is unexplained
    assert headline(replace(told, findings=[half])) == (
        "The simulation lacks something that no known effect explains"
    )
    # each of two that are not told apart has half of what both have
    either = replace(half, members=(half.effect, "sensor_delay"))
    assert "perhaps " not in headline(replace(told, findings=[either]))


def test_an_engine_that_strays_is_named() -> None:
    made = replace(two_runs(), engines={"mujoco": 1.1, "exudyn": 8.8, "reference": 1.11})
    assert "Exudyn cannot follow this device" in Reader(render_report(made, TOML, XML)).text
    assert "cannot follow" not in Reader(render_report(two_runs(), TOML, XML)).text


def test_the_ends_where_the_motion_is_not_known_are_not_drawn() -> None:
    made = run("a")
    inner = np.zeros(len(made.time), bool)
    inner[100:-50] = True
    wild = np.where(inner, made.extended, 1e6)
    plot: Any = run_plots(replace(made, inner=inner, extended=wild))["time"]
    for trace in plot.data:
        if trace.name != "measured":
            assert np.abs(np.asarray(trace.y, float)).max() < 1e3
            assert min(trace.x) >= made.time[100]
            assert max(trace.x) <= made.time[-51]


def test_an_interval_stands_behind_its_gain() -> None:
    shown = render_report(
        replace(
            two_runs(),
            findings=[replace(two_runs().findings[0], gain_interval=(-0.012, 0.891))],
            gain_interval=(0.8, 0.9),
        ),
        TOML,
        XML,
    )
    assert "of the error explained (95\u00a0% interval 80 to 90\u00a0%)" in shown
    assert "less error (95\u00a0% interval −1 to 89\u00a0%)" in shown
    assert "interval" not in Reader(render_report(two_runs(), TOML, XML)).text


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


def test_a_device_file_tells_what_only_the_record_has(tmp_path: Path) -> None:
    """As a comment: what is read back is the device, and what the file can state of a channel."""
    usual = two_runs()
    write_outputs(usual, tmp_path / "usual")
    assert "beside" not in (tmp_path / "usual" / "device.toml").read_text()
    channels = {"delay": 2e-3, "force_filter": 40.0, "force_filter_order": 2.0,
                "force_drift": 1.25, "viscous_drift": -0.01}  # fmt: skip
    drifting = replace(usual, extended=replace(usual.extended, channels=channels))
    write_outputs(drifting, tmp_path)
    path = tmp_path / "device.toml"
    assert path.read_text().splitlines()[1] == (
        "# beside this device the record shows: force_drift = 1.25 N/s, viscous_drift = -0.01 1/s"
    )
    assert read_device(path).given == usual.extended.device
    assert read_delay(path) == channels["delay"]
    assert set(read_filters(path)) == {"force"}


def test_a_value_below_its_error_is_called_undetermined() -> None:
    made = two_runs()
    first, *rest = made.findings
    name, value = next(iter(first.parameters.items()))
    wide = {**first.parameters, name: replace(value, stderr=4 * abs(value.value))}
    for told, parameters in ((0, first.parameters), (1, wide)):
        seen = io.StringIO()
        shown = replace(made, findings=[replace(first, parameters=parameters), *rest])
        print_summary(shown, Console(width=400, file=seen))
        assert seen.getvalue().count("(not determined)") == told


def test_a_device_file_says_which_values_are_not_sure(tmp_path: Path) -> None:
    made = two_runs()
    first, *rest = made.findings
    sure = [replace(each, confidence=0.95) for each in rest]
    write_outputs(
        replace(made, findings=[replace(first, confidence=0.46), *sure]), tmp_path / "one"
    )
    said = (tmp_path / "one" / "device.toml").read_text()
    name = next(iter(first.parameters))
    (line,) = [each for each in said.splitlines() if each.startswith(f"{name} = ")]
    assert line.endswith("; confidence 0.46)")
    assert said.count("confidence") == len(first.parameters)


def test_why_a_value_that_may_be_none_is_not_sure_is_said_beside_it() -> None:
    made = two_runs()
    first, *rest = made.findings
    told = "Its own value differs from none by 1.1 standard errors."
    unsure = replace(first, evidence=f"{first.evidence} {told}")
    shown = render_report(replace(made, findings=[unsure, *rest]), TOML, XML)
    assert f'<p class="warn">{told}</p>' in shown
    assert told not in render_report(made, TOML, XML)
