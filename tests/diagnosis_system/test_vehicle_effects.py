"""Effects of the vehicle, hidden in records that SciPy makes, are named with their values."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hidden_vehicles import Car, diagnose, records
from inerter.diagnose.result import StatedValue
from inerter.records import VehicleRecord
from inerter.records.quality import check_records
from inerter.report.text import effect_notes, finding_name


def test_stated_value_stands_beside_the_one_found() -> None:
    found = diagnose(records(Car(damping=3300.0), runs=2))
    value = found.findings[0].parameters["viscous"]
    assert found.findings[0].effect == "viscous_friction"
    assert value.value == pytest.approx(3300.0, rel=0.01)
    assert isinstance(value, StatedValue)
    assert value.stated == found.json()["parameters"]["viscous"]["stated"] == 3705.4
    assert "stated 3705" in found.findings[0].evidence


def test_channels_are_told_in_their_units() -> None:
    found = diagnose(records(Car(), runs=2))
    json = found.json()
    channels = json["extended"]["channels"]
    assert {name: each["unit"] for name, each in channels.items()} == {
        "body_acceleration": "m/s^2",
        "wheel_acceleration": "m/s^2",
        "suspension_travel": "m",
        "tyre_force": "N",
    }
    # the share is the root of the mean over channels of error per spread
    runs = [run for run in found.curves if run.role == "holdout"]
    shares = [channels[run.quantity.replace(" ", "_")]["rmse"] / np.std(run.force) for run in runs]
    assert json["extended"]["rmse"] == pytest.approx(np.sqrt(np.mean(np.square(shares))), rel=0.1)
    assert json["engines"]["reference"] == {"rmse": None}


@pytest.mark.long
def test_nothing_is_found_where_nothing_is_hidden() -> None:
    for seed in (21, 31):
        found = diagnose(records(Car(), seed=seed))
        assert found.findings == []
        assert not found.unexplained.significant
        assert found.extended.rmse == found.baseline.rmse < 1.1 * found.noise_floor


def test_single_run_is_judged_on_blocks_of_it() -> None:
    found = diagnose(records(Car(unsprung_mass=28.0), runs=1, duration=8.0))
    assert [finding.effect for finding in found.findings] == ["wheel_mass_error"]
    assert found.findings[0].parameters["wheel_mass"].value == pytest.approx(28.0, rel=0.01)
    assert "blocks" in found.method["split"]
    assert found.findings[0].rmse_after < 0.5 * found.findings[0].rmse_before


@pytest.mark.long
def test_two_effects_are_both_found() -> None:
    found = diagnose(records(Car(tyre_damping=150.0, sprung_mass=195.0)))
    assert {finding.effect for finding in found.findings} == {"tyre_damping", "body_mass_error"}
    assert found.parameters["tyre_damping"].value == pytest.approx(150.0, rel=0.02)
    assert found.parameters["body_mass"].value == pytest.approx(195.0, rel=0.005)


@pytest.mark.long
def test_start_in_motion_is_no_effect() -> None:
    # cut out of a longer drive: what the car did before is not in the record
    cut = []
    for run in records(Car(), runs=2, duration=6.0):
        part = run.time >= 2.0
        channels: dict[str, Any] = {n: c[part] for n, c in run.channels().items()}
        cut.append(VehicleRecord(name=run.name, time=run.time[part], **channels))
    assert diagnose(cut).findings == []


@pytest.mark.long
def test_offset_of_an_accelerometer_is_no_effect() -> None:
    shifted = []
    for run in records(Car(), runs=2):
        channels: dict[str, Any] = run.channels()
        channels["body_acceleration"] = channels["body_acceleration"] + 9.81
        shifted.append(VehicleRecord(name=run.name, time=run.time, **channels))
    found = diagnose(shifted)
    assert found.findings == []
    assert found.baseline.rmse < 1.1 * found.noise_floor


@pytest.mark.long
def test_other_sign_of_the_tyre_force_is_no_effect() -> None:
    turned = []
    for run in records(Car(), runs=2):
        channels: dict[str, Any] = run.channels()
        channels["tyre_force"] = -channels["tyre_force"]
        turned.append(VehicleRecord(name=run.name, time=run.time, **channels))
    found = diagnose(turned)
    assert found.findings == []
    assert found.method["signs"] == ["tyre_force counted with the other sign"]


def test_an_accelerometer_turned_round_is_told_before_any_cause() -> None:
    turned = []
    for run in records(Car(), runs=2):
        channels: dict[str, Any] = run.channels()
        channels["body_acceleration"] = -channels["body_acceleration"]
        turned.append(VehicleRecord(name=run.name, time=run.time, **channels))
    verdict = diagnose(turned).verdict
    assert verdict.startswith("Look at the records first: run1: 'body_acceleration' runs against")


@pytest.mark.long
def test_a_copy_of_a_drive_is_left_out() -> None:
    runs = records(Car(sprung_mass=200.0), runs=2)
    alone, beside = diagnose(runs), diagnose(check_records([*runs, replace(runs[0], name="copy")]))
    assert [(each.name, each.role) for each in beside.records][2:] == [("copy", "unused")]
    assert beside.extended == alone.extended


@pytest.mark.long
def test_fits_of_long_runs_begin_on_a_part_and_find_the_same() -> None:
    runs = records(Car(tyre_damping=150.0), runs=2, duration=20.0)
    found = diagnose(runs)
    (finding,) = found.findings
    assert finding.effect == "tyre_damping"
    value = finding.parameters["tyre_damping"]
    assert value.value == pytest.approx(150.0, abs=max(4 * value.stderr, 0.5))
    assert found.extended.rmse < 1.1 * found.noise_floor


@pytest.mark.parametrize(
    ("column", "gain"), [("road", 0.94), ("suspension_travel", 1.08), ("body_acceleration", 0.9)]
)
def test_a_wrong_scale_of_a_channel_is_told_from_masses_and_springs(
    column: str, gain: float
) -> None:
    runs = []
    for run in records(Car(), runs=2):
        channels: dict[str, Any] = run.channels()
        channels[column] = gain * channels[column]
        runs.append(VehicleRecord(name=run.name, time=run.time, **channels))
    found = diagnose(runs)
    assert [finding.effect for finding in found.findings] == ["sensor_gain_error"]
    value = found.findings[0].parameters[f"{column}.gain"]
    assert value.value == pytest.approx(gain, abs=max(4 * value.stderr, 1e-4))
    assert f"a wrong scale in {column}" in found.verdict
    assert found.extended.rmse < 1.1 * found.noise_floor


def test_a_road_of_another_clock_is_one_delay() -> None:
    """A profile that another logger wrote comes 8 ms early: every channel is late of it."""
    late = 0.008
    runs = [
        replace(run, road=np.interp(run.time + late, run.time, run.road))
        for run in records(Car(), runs=2)
    ]
    found = diagnose(runs)
    assert [finding.effect for finding in found.findings] == ["sensor_delay"]
    value = found.findings[0].parameters["every channel.delay"]
    assert value.value == pytest.approx(late, abs=2e-4)
    assert "a delay in every channel" in found.verdict
    assert finding_name(found.findings[0]) == "a delay in every channel"
    # nothing of a force channel, which a vehicle need not have
    assert "force" not in " ".join(effect_notes(found.findings[0]).values())
