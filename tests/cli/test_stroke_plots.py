"""The picture of what changes along the stroke is that of the device found."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from inerter import Device
from inerter.diagnose.result import Diagnosis, Finding, ParameterValue
from inerter.report.page import render_report
from inerter.report.stroke_plots import BAND, stroke_plot
from made_reports import TOML, XML, diagnosis, two_runs

NODES = (0.0, 4.0, -3.0, 0.0, 2.0)
CURVE = {"force_curve": " ".join(map(str, NODES)), "curve_lower": -0.015, "curve_upper": 0.015}
PERIOD = {"length": 0.007, "amplitude": 0.03, "phase": 0.7}


def found(finding: Finding, **device: float | str) -> Diagnosis:
    made = two_runs()
    extended = replace(made.extended, device={"inertance": 100.0, **device})
    return replace(made, findings=[finding], extended=extended)


def of_curve() -> tuple[Finding, Diagnosis]:
    # the node in the middle is held at 0: a constant force says the same
    parameters = {
        f"force_node_{i + 1}": ParameterValue(node, 0.1 * (i + 1), "N")
        for i, node in enumerate(NODES)
        if i != 3
    }
    base = diagnosis().findings[0]
    finding = replace(base, effect="position_force", law="curve", parameters=parameters)
    return finding, found(finding, **CURVE)


def of_period() -> tuple[Finding, Diagnosis]:
    parameters = {
        "inertance_period_1": ParameterValue(PERIOD["length"], 1e-6, "m"),
        "inertance_amplitude_1": ParameterValue(PERIOD["amplitude"], 0.002, "1"),
        "inertance_phase_1": ParameterValue(PERIOD["phase"], 0.05, "rad"),
    }
    base = diagnosis().findings[0]
    finding = replace(base, effect="variable_inertance", law="period", parameters=parameters)
    return finding, found(finding)


def of_flanks() -> tuple[Finding, Diagnosis]:
    back = (0.01, -0.02, 0.03, 0.0, 0.04)
    parameters = {
        f"inertance{side}_node_{i + 1}": ParameterValue(node, 0.001, "1")
        for side, nodes in (("", NODES), ("_back", back))
        for i, node in enumerate(0.01 * np.array(nodes) if not side else nodes)
    }
    base = diagnosis().findings[0]
    finding = replace(base, effect="variable_inertance", law="flanks", parameters=parameters)
    ends = {"curve_lower": -0.015, "curve_upper": 0.015}
    return finding, found(
        finding,
        inertance_curve=" ".join(str(0.01 * node) for node in NODES),
        inertance_back_curve=" ".join(map(str, back)),
        **ends,
    )


def drawn(plot: Any, trace: int) -> tuple[np.ndarray, np.ndarray]:
    """Places and values of a trace: 0 the band, 1 the line."""
    assert plot is not None
    return np.asarray(plot.data[trace].x, float), np.asarray(plot.data[trace].y, float)


def test_a_curve_is_the_force_of_the_device() -> None:
    x, y = drawn(stroke_plot(*of_curve()), 1)
    assert x.min() == pytest.approx(-0.02, abs=1e-3)
    device = Device(**CURVE)
    np.testing.assert_allclose(y, device.evaluate(x, 0.0, 0.0, 0.0)["total"], atol=1e-5)


def test_its_band_is_that_of_the_nodes() -> None:
    plot = stroke_plot(*of_curve())
    (x, high), (_, middle) = drawn(plot, 0), drawn(plot, 1)
    half = x.size // 2
    upper = high[:half]
    at = int(np.argmin(np.abs(x[:half] - 0.015)))
    assert upper[at] - middle[at] == pytest.approx(BAND * 0.5, rel=0.02)


def test_a_wide_band_leaves_the_curve_to_be_seen() -> None:
    finding, made = of_curve()
    wide = {name: replace(v, stderr=100.0) for name, v in finding.parameters.items()}
    drawn_wide: Any = stroke_plot(replace(finding, parameters=wide), made)
    drawn_usual: Any = stroke_plot(finding, made)
    low, high = drawn_wide.layout.yaxis.range
    assert low < min(NODES)
    assert max(NODES) < high
    assert high - low < 6 * np.ptp(NODES)
    assert drawn_usual.layout.yaxis.range is None


def test_periods_are_the_ratio_of_the_device() -> None:
    x, y = drawn(stroke_plot(*of_period()), 1)
    device = Device(inertance=1.0, inertance_periods=list(PERIOD.values()))
    force = device.evaluate(x, 0.0, 1.0, 0.0)["total"]
    np.testing.assert_allclose(1 + y / 100, force, atol=1e-6)


@pytest.mark.parametrize(("trace", "way"), [(1, 1e-9), (3, -1e-9)])
def test_flanks_are_the_ratio_of_the_device_each_way(trace: int, way: float) -> None:
    finding, made = of_flanks()
    x, y = drawn(stroke_plot(finding, made), trace)
    device = Device(**{**made.extended.device, "inertance": 1.0})
    force = device.evaluate(x, way, 1.0, 0.0)["total"]
    np.testing.assert_allclose(1 + y / 100, force, atol=1e-6)


@pytest.mark.parametrize("case", [of_curve, of_period, of_flanks])
def test_the_page_shows_it(case: Callable[[], tuple[Finding, Diagnosis]]) -> None:
    finding, made = case()
    page = render_report(made, TOML, XML)
    assert f'data-plot="stroke-{finding.effect}"' in page
    assert ("while x shrinks" in page) == (finding.law == "flanks")


def test_what_is_no_curve_has_none() -> None:
    made = two_runs()
    assert stroke_plot(made.findings[0], made) is None
    assert 'data-plot="stroke-' not in render_report(made, TOML, XML)
