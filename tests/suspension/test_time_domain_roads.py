"""Random roads: their formula, their density, their period, and what a step holds of them."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path

import numpy as np
import pytest
from inerter.suspension.quarter_car import Road
from inerter.suspension.time_domain.profile import profile_named
from inerter.suspension.time_domain.road import (
    PeriodicRoad,
    iso_road,
    paper_road,
    road_named,
)
from numpy.typing import NDArray


def test_amplitudes_are_those_the_paper_prints() -> None:
    road = paper_road()
    omega = 2 * np.pi * road.frequencies
    kappa_v, spacing = 5e-7 * 25, 2 * np.pi * 0.1
    assert road.frequencies[[0, -1]] == pytest.approx([0.1, 1000.0])
    assert road.amplitudes == pytest.approx(np.sqrt(8 * np.pi * kappa_v * spacing) / omega)


def test_the_papers_road_has_20_3_mm_and_repeats_every_10_s() -> None:
    road = paper_road()
    values = road.instants(3, 20_002)
    # the sum of 1/i^2 is pi^2/6
    assert road.rms == pytest.approx(0.0203, abs=5e-5)
    assert road.rms == pytest.approx(math.sqrt(2 * 1.25e-5 / 0.1 * np.pi**2 / 6), rel=1e-4)
    assert np.sqrt(np.mean(values**2)) == pytest.approx(road.rms, rel=1e-9)
    times = np.array([0.0, 1.234, 7.7])
    assert road.at(times + 10.0, 3) == pytest.approx(road.at(times, 3), abs=1e-9)
    assert abs(road.at(times + 5.0, 3) - road.at(times, 3)).max() > 1e-3


def test_the_fft_is_the_sum_of_sines() -> None:
    road = dataclasses.replace(paper_road(), first=2, last=70)
    count = 200
    times = 10.0 * np.arange(count) / count
    assert road.instants(5, count) == pytest.approx(road.at(times, 5), abs=1e-14)


@pytest.mark.parametrize("name", ["paper", "iso:A", "iso:C", "iso:H"])
def test_density_of_the_values_is_the_formula(name: str) -> None:
    road = road_named(name, 25.0)
    count = 20_002
    lines = np.fft.rfft(road.instants(1, count))
    density = 2 * np.abs(lines / count) ** 2 / 0.1
    f = 0.1 * np.arange(lines.size)
    inside = slice(road.first, road.last + 1)
    if name == "paper":
        expected = 2 * 5e-7 * 25.0 / f[inside] ** 2
    else:
        # ISO 8608, per class four times as much: G(n) = G(n0) (n / 0.1)^-2, S(f) = G(f / V) / V
        level = 16e-6 * 4.0 ** "ABCDEFGH".index(name[-1])
        expected = level * (f[inside] / 25.0 / 0.1) ** -2 / 25.0
    assert density[inside] == pytest.approx(expected, rel=1e-6)
    density[inside] = 0.0
    assert density.max() < 1e-20


def test_iso_roads_end_where_the_standard_ends() -> None:
    road = iso_road("B", 20.0)
    assert road.frequencies[[0, -1]] == pytest.approx([0.2, 200.0])


def test_what_is_held_contains_every_sinusoid_exactly() -> None:
    road = dataclasses.replace(paper_road(), last=45)
    count, fine = 100, 400
    held = np.repeat(road.held(2, count), fine)
    # the Fourier coefficients of the staircase itself: each tread integrated
    lines = np.fft.rfft(held)[1:46] / held.size
    tread = np.exp(-1j * np.pi * np.arange(1, 46) / (count * fine))
    tread *= np.sinc(np.arange(1, 46) / (count * fine))
    expected = -0.5j * road.amplitudes * np.exp(1j * road.phases(2))
    assert lines * tread == pytest.approx(expected, abs=1e-15)


def test_what_a_step_cannot_follow_is_accounted_for() -> None:
    road, count = paper_road(), 3000
    kept = np.mean(road.instants(1, count) ** 2)
    assert kept + road.left_out(count) == pytest.approx(road.rms**2, rel=1e-12)
    assert 0.0 < road.left_out(count) < 1e-3 * road.rms**2
    assert road.left_out(20_002) == 0.0


def test_seeds_choose_the_phases() -> None:
    road = paper_road()
    assert np.array_equal(road.phases(4), road.phases(4))
    assert abs(np.corrcoef(road.instants(0, 2000), road.instants(1, 2000))[0, 1]) < 0.99
    phases = np.concatenate([road.phases(seed) for seed in range(5)])
    # uniform: the mean of exp(i phase) of n draws is about 1/sqrt(n)
    assert abs(np.exp(1j * phases).mean()) < 5 / math.sqrt(phases.size)


@pytest.mark.parametrize("name", ["iso:I", "iso:", "iso", "smooth", ""])
def test_unknown_roads(name: str) -> None:
    with pytest.raises(ValueError, match="give paper or iso:A"):
        road_named(name)


def test_numbers_out_of_range() -> None:
    with pytest.raises(ValueError, match="speed is -1 m/s"):
        iso_road("A", -1.0)
    with pytest.raises(ValueError, match="strength"):
        PeriodicRoad("none", 0.0)
    with pytest.raises(ValueError, match="count from 1"):
        PeriodicRoad("none", 1.0, first=5, last=4)
    assert paper_road(Road(velocity=50.0)).strength == 2 * paper_road().strength


def road_file(folder: Path, x: NDArray[np.float64], heights: NDArray[np.float64]) -> str:
    path = folder / "road.csv"
    rows = [f"{a!r},{b!r}" for a, b in zip(x.tolist(), heights.tolist(), strict=True)]
    path.write_text("\n".join(["distance,height", *rows]))
    return str(path)


def test_rows_that_are_missing_are_no_straight_road(tmp_path: Path) -> None:
    x = np.arange(0, 2001) / 10
    rough = 0.01 * np.sin(x)
    kept = (x <= 100.0) | (x >= 130.0)
    told = r"no rows between distance 100 and 130 m, where rows are usually 0\.1 m apart"
    with pytest.raises(ValueError, match=told):
        profile_named(road_file(tmp_path, x[kept], rough[kept]), 20.0)
    whole = profile_named(road_file(tmp_path, x, rough), 20.0)
    assert whole is not None
    assert np.array_equal(whole.left, rough)
    # a few rows that are missing, and what is drawn with a flat road before it
    few = (x < 100.0) | (x > 100.75)
    assert profile_named(road_file(tmp_path, x[few], rough[few]), 20.0)
    drawn = np.array([0.0, 50.0, 50.1, 50.2, 50.3, 50.4, 100.0])
    assert profile_named(road_file(tmp_path, drawn, np.array([0, 0, 1, 2, 1, 0, 0]) / 100), 20.0)


@pytest.mark.parametrize(
    ("cell", "told"),
    [
        ("nan", "height of row 2 is nan: give a number"),
        ("", "height of row 2 is empty: give a number"),
        ("O.1", r"height of row 2 is O\.1: give a number"),
        ("50", "changes by .* did you mean mm"),
    ],
)
def test_a_cell_that_is_no_height_is_named(cell: str, told: str, tmp_path: Path) -> None:
    path = tmp_path / "road.csv"
    path.write_text(f"distance,height\n0,0\n5,{cell}\n10,0\n")
    with pytest.raises(ValueError, match=told):
        profile_named(str(path), 20.0)


def test_hills_may_be_high_and_millimetres_not_metres(tmp_path: Path) -> None:
    x = np.arange(0, 5001) / 10
    rough = 0.008 * np.sin(2.0 * x) + 0.002 * np.sin(0.3 * x)
    hill = 30.0 * np.sin(x / 100.0) ** 2
    assert profile_named(road_file(tmp_path, x, rough + hill), 20.0)
    with pytest.raises(ValueError, match="did you mean mm"):
        profile_named(road_file(tmp_path, x, 1e3 * rough), 20.0)
