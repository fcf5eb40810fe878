"""The report as a real browser draws it: every plot, within the page, without an error."""

from __future__ import annotations

import html
import json
import re
import shutil
import subprocess
from pathlib import Path

import pytest
from inerter.report.page import render_report
from made_reports import CASES, RUN_PLOTS, TOML, XML, two_runs

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
