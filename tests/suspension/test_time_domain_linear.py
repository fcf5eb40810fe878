"""Linear cases in the time domain against norms and transfer functions made here."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from inerter.suspension.time_domain.cases import CASES
from inerter.suspension.time_domain.load_peaks import load_peaks, peaks_of
from inerter.suspension.time_domain.model import CarModel, Design, compiled
from inerter.suspension.time_domain.road import PeriodicRoad, iso_road, paper_road
from inerter.suspension.time_domain.simulate import RunSettings, load_gains, road_indices
from time_domain_car import KT, SOFT, body_per_load, norms, road_responses

# wang and su, table 1, optimal in J1
DESIGNS = {
    "S1": Design(120e3, 4981.0),
    "S2": Design(120e3, 3705.4, 128.57),
    "S3": Design(120e3, 7544.2, 366.52),
}
LINEAR = [("S1", "ideal"), ("S2", "ideal"), ("S3", "ideal"), ("S2", "elastic"), ("S3", "elastic")]
SETTINGS = RunSettings(jobs=2)
QUICK = RunSettings(step=2e-3, jobs=2)


def arguments(layout: str, case: str) -> tuple:
    design = DESIGNS[layout]
    pair = SOFT if case == "elastic" else None
    return layout, design.stiffness, design.damping, design.inertance, pair


def indices(car: CarModel, design: Design, road: PeriodicRoad, settings: RunSettings) -> np.ndarray:
    found = road_indices(car, [design], road, [1, 2], settings)
    return np.array([found["J1"][0], found["J3"][0]])


@pytest.mark.parametrize(("layout", "case"), LINEAR)
def test_indices_are_the_norms(layout: str, case: str) -> None:
    """0.1 %: the paper's sinusoids end at 1000 Hz, the norm does not."""
    found = indices(compiled(layout, CASES[case]), DESIGNS[layout], paper_road(), SETTINGS)
    assert found[:, 0] == pytest.approx(norms(*arguments(layout, case)), rel=1e-3)
    # the sum over the sinusoids has no such gap, and no phase in it
    road = paper_road()
    gains = road_responses(road.frequencies, *arguments(layout, case))
    exact = [np.sqrt(0.5 * np.sum((gain * road.amplitudes) ** 2)) for gain in gains]
    assert found[:, 0] == pytest.approx(exact, rel=2e-4)
    assert found[:, 1] == pytest.approx(found[:, 0], rel=1e-5)


def test_table_1() -> None:
    values = [norms(*arguments(layout, "ideal"))[0] for layout in DESIGNS]
    assert values == pytest.approx([2.9882, 2.5773, 2.4281], abs=6e-5)


@pytest.mark.parametrize("layout", ["S2", "S3"])
def test_indices_do_not_depend_on_the_step(layout: str) -> None:
    car = compiled(layout, CASES["ideal"])
    fine = indices(car, DESIGNS[layout], paper_road(), RunSettings(step=4e-4))
    coarse = indices(car, DESIGNS[layout], paper_road(), RunSettings(step=1e-3))
    coarser = indices(car, DESIGNS[layout], paper_road(), RunSettings(step=2e-3))
    assert coarse == pytest.approx(fine, rel=5e-5)
    assert coarser == pytest.approx(fine, rel=1e-3)


def test_indices_scale_with_the_road() -> None:
    car = compiled("S2", CASES["elastic"])
    road = iso_road("B")
    four = dataclasses.replace(road, strength=16.0 * road.strength)
    found = indices(car, DESIGNS["S2"], road, SETTINGS)
    assert indices(car, DESIGNS["S2"], four, SETTINGS) == pytest.approx(4.0 * found, rel=1e-9)


@pytest.mark.parametrize(("layout", "case"), LINEAR)
def test_gains_are_the_transfer_function(layout: str, case: str) -> None:
    f = np.array([0.7, 1.9, 3.1, 4.5, 9.0, 17.3])
    car = compiled(layout, CASES[case])
    found = load_gains(car, [DESIGNS[layout]], f[None], settings=SETTINGS)[0]
    assert found == pytest.approx(body_per_load(f, *arguments(layout, case)), rel=1.5e-4)
    small = load_gains(car, [DESIGNS[layout]], f[None], 1.0, settings=SETTINGS)[0]
    assert small == pytest.approx(found, rel=1e-9)


@pytest.mark.parametrize(
    ("layout", "design"), [("S2", (9301.3, 328.34)), ("S3", (11174.0, 1232.4))]
)
def test_j5_is_the_largest_gain_at_both_peaks(layout: str, design: tuple[float, float]) -> None:
    """The optima of Table 1 have two peaks, equal to the digits that are printed."""
    (found,) = load_peaks(
        compiled(layout, CASES["ideal"]), [Design(120e3, *design)], settings=QUICK
    )
    f = np.geomspace(0.5, 30.0, 20_000)
    gain = body_per_load(f, layout, 120e3, *design, None)
    inner = 1 + np.flatnonzero((gain[1:-1] > gain[:-2]) & (gain[1:-1] > gain[2:]))
    assert len(inner) == len(found.peaks) == 2
    assert [at for at, _ in found.peaks] == pytest.approx(f[inner], rel=5e-3)
    assert [top for _, top in found.peaks] == pytest.approx(gain[inner], rel=5e-5)
    assert found.value == pytest.approx(gain.max(), rel=5e-5)


def test_j5_knows_the_static_load() -> None:
    """At k <= 50 kN/m no strut does better than 1/k + 1/kt, here reached at frequency 0."""
    car = compiled("S2", CASES["ideal"])
    (found,) = load_peaks(car, [Design(30e3, 9000.0, 100.0)], settings=QUICK)
    assert found.value == 1 / 30e3 + 1 / KT
    assert found.peaks[0] == (0.0, found.value)


def test_peaks_of_a_resonance() -> None:
    # 1 / |1 - r^2 + 2 i z r|: the peak is 1 / (2 z sqrt(1 - z^2)) at f0 sqrt(1 - 2 z^2)
    f0, z = np.array([2.0, 7.3]), 0.1

    def gains(which: object, f: np.ndarray) -> np.ndarray:
        r = f / f0[np.asarray(which)][:, None]
        return 1 / np.abs(1 - r**2 + 2j * z * r)

    top = 1 / (2 * z * np.sqrt(1 - z * z))
    found = peaks_of(gains, 2, [1.0, None])
    assert [each.value for each in found] == pytest.approx([top, top], rel=2e-5)
    frequencies = [each.peaks[-1][0] for each in found]
    assert frequencies == pytest.approx(f0 * np.sqrt(1 - 2 * z * z), rel=3e-4)
