"""Identification of measured devices, judged on data that were left out."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from inerter.identify.estimate import identify
from inerter.identify.simulated import Simulator, fit_simulated, start_from
from inerter.records import read_records


def test_rack_inerter_by_named_causes(measured_data: Path) -> None:
    """The authors' model leaves 34 to 47 N on a run that it has not seen."""
    records = read_records(str(measured_data / "rack_inerter" / "r0_*.csv"), "bench")
    result = identify(records, ["viscous", "dahl+load+variable+offset"], intervals="normal").best
    assert result.law.startswith("dahl")
    assert result.rmse < 15
    assert result.parameters["inertance"].value == pytest.approx(61.35, rel=0.05)


def test_emps_gives_its_authors_parameters(measured_data: Path) -> None:
    records = read_records(measured_data / "emps" / "emps.csv", "bench")
    law = "coulomb+offset+asymmetry+delay"
    found = identify(records, [law], intervals="normal").best.parameters
    published = {"inertance": 95.1089, "viscous": 203.5034, "coulomb_force": 20.3935}
    for name, value in published.items():
        each = found[name]
        assert abs(each.value - value) < 3 * each.stderr + 0.005 * value, name


def test_friction_damper_on_a_run_left_out(measured_data: Path) -> None:
    """Its authors' LuGre model leaves 3031 N on harmonic runs."""
    records = read_records(measured_data / "friction_damper", "bench")
    result = identify(records, ["lugre"], intervals="normal").best
    assert result.rmse < 2000
    assert result.high < 3031


@pytest.mark.long
def test_friction_damper_has_free_play_before_its_friction(measured_data: Path) -> None:
    """Its force stays at zero over some 3.6 mm at every reversal."""
    records = read_records(measured_data / "friction_damper", "bench")
    result = identify(records, ["lugre", "lugre+play"], intervals="normal")
    loose, tight = result.results
    assert loose.law == "lugre+play"
    assert loose.rmse < 900
    assert loose.high < tight.low
    half = loose.parameters["friction_backlash"]
    assert half.value == pytest.approx(1.8e-3, abs=0.1e-3)
    assert half.stderr < 0.1e-3
    # a bristle that need not stand in for the play is stiffer
    stiffness = (each.parameters["bristle_stiffness"].value for each in (loose, tight))
    assert next(stiffness) > 1.5 * next(stiffness)


def test_magnetorheological_damper_without_voltage(measured_data: Path) -> None:
    """Dahl and viscous friction, as its authors have it."""
    records = read_records(str(measured_data / "mr_damper" / "off_*.csv"), "bench")
    result = identify(records, ["dahl+offset", "bouc_wen_any+offset"], intervals="normal")
    assert {each.law for each in result.results} == {"dahl+offset", "bouc_wen_any+offset"}
    for each in result.results:
        assert each.rmse < 12
        assert each.parameters["force_offset"].value == pytest.approx(135, abs=10)


@pytest.mark.long
def test_bouc_wen_oscillator_down_to_its_noise(measured_data: Path) -> None:
    """Simulated on a stretch it has not seen; what the true parameters leave is the noise."""
    (record,) = read_records(measured_data / "boucwen" / "train_multisine.csv", "bench")
    count = round(14.0 * record.sample_rate)
    columns = ("time", "displacement", "force")
    part = replace(record, **{name: getattr(record, name)[:count] for name in columns})
    bench = identify([part], ["bouc_wen_any+stiffness"], intervals="normal").best
    # alpha is beyond what force and motion tell apart: products count
    assert bench.parameters["bw_beta"].value == pytest.approx(1e3 * 0.8, rel=0.05)
    assert bench.parameters["bw_gamma"].value == pytest.approx(1e3 * -1.1, rel=0.05)
    fit = fit_simulated([Simulator(part, finer=3, settle=1.0)], start_from(bench.model), 10.0, 6)
    rest = (part.displacement - fit.displacement[0])[round(10.0 * record.sample_rate) :]
    assert np.std(rest) < 8e-6
    for name, truth in (("inertance", 2), ("stiffness", 5e4), ("bw_stiffness", 5e4)):
        assert fit.model.values[name] == pytest.approx(truth, rel=0.01), name
