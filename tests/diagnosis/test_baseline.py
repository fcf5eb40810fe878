"""The user's own device as baseline: right, wrong, and read back from what was written."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np
import pytest
from bench_runs import measured
from inerter import Device
from inerter.catalogue.coordinates import search_range
from inerter.catalogue.scales import Scales
from inerter.core import DeviceError
from inerter.device_file import device_text, read_delay, read_device
from inerter.diagnose import diagnose, diagnose_bench
from inerter.diagnose.baseline import baseline_model
from inerter.diagnose.composition import submodel
from inerter.diagnose.result import Diagnosis, StatedValue
from inerter.diagnose.wording import verdict
from inerter.mjcf import device_of_model
from inerter.records import Record
from inerter.records.quality import check_records
from inerter.reference import ReferenceDevice, response, strokes, sum_of_sines
from inerter.report.output import write_outputs

TRUE = {"inertance": 80.0, "viscous": 40.0, "friction": "coulomb", "coulomb_force": 12.0}


@pytest.fixture(scope="module")
def records() -> list[Record]:
    """Two short runs of a device with viscous and Coulomb friction."""
    motions = [
        sum_of_sines([0.01, 0.003, 0.001], [0.7, 1.9, 4.1], [0.0, 1.0, 2.0]),
        strokes([0.0, 0.03, 0.0, 0.02, 0.0], [1.0, 3.0, 5.0, 7.0], [0.6, 0.8, 0.5, 0.9]),
    ]
    return measured(ReferenceDevice(**TRUE), motions, np.arange(0, 9, 2e-3))  # type: ignore[arg-type]


def test_right_device_brings_no_finding(records) -> None:
    diagnosis = diagnose_bench(records, Device(**TRUE))
    assert diagnosis.findings == []
    assert diagnosis.baseline.device["coulomb_force"] == 12.0


@pytest.mark.long
def test_a_stated_friction_law_of_any_kind_may_be_uneven() -> None:
    """The data say that friction after Brown and McPhee differs between the directions."""
    stated = {
        "inertance": 80.0, "friction": "brown_mcphee", "coulomb_force": 12.0,
        "static_force": 15.0, "stribeck_velocity": 0.02,
    }  # fmt: skip
    truth = ReferenceDevice(**stated, friction_asymmetry=0.2)  # type: ignore[arg-type]
    random = np.random.default_rng(3)
    rates, phases = random.uniform(0.5, 5, (2, 5)), random.uniform(0, 6, (2, 5))
    motions = [sum_of_sines(0.01 / (1 + r), r, p) for r, p in zip(rates, phases, strict=True)]
    runs = measured(truth, motions, np.arange(0, 8, 2e-3))
    diagnosis = diagnose_bench(runs, Device(**stated))
    assert [each.effect for each in diagnosis.findings] == ["asymmetric_friction"]
    value = diagnosis.findings[0].parameters["friction_asymmetry"].value
    assert value == pytest.approx(0.2, rel=0.02)


def test_the_rest_length_is_where_a_record_counts_from(tmp_path: Path) -> None:
    # a spring tells a displacement that is off by the rest length
    truth = response(
        ReferenceDevice(inertance=80.0, stiffness=5e3),
        sum_of_sines([0.01, 0.003, 0.001], [0.7, 1.9, 4.1], [0.0, 1.0, 2.0]),
        np.arange(0, 9, 2e-3),
    )
    noise = np.random.default_rng(6).normal(0, 0.2, truth.time.size)
    columns = np.column_stack([truth.time, truth.displacement, truth.force + noise])
    np.savetxt(
        tmp_path / "run.csv", columns, delimiter=",", header="time,displacement,force", comments=""
    )
    stated = Device(inertance=80.0, stiffness=5e3, rest_length=0.4)
    diagnosis = diagnose([tmp_path / "run.csv"], stated)
    assert diagnosis.findings == []
    write_outputs(diagnosis, tmp_path / "out")
    assert read_device(tmp_path / "out" / "device.toml").rest_length == 0.4


@pytest.mark.long
def test_a_device_with_every_part_can_be_the_baseline(records) -> None:
    # what the data cannot show (a stiff shaft, a weak gas spring) stays as it was stated
    stated = Device(
        **TRUE, series_stiffness=1e9, series_damping=1e4, gas_law="expanded", gas_pressure=1e5,
        gas_area=1e-7, gas_volume=1e-6,
    )  # fmt: skip
    diagnosis = diagnose_bench(records, stated)
    assert diagnosis.findings == []
    assert diagnosis.extended.device["gas_law"] == "expanded"
    assert diagnosis.extended.device["series_stiffness"] == 1e9
    channel = Device(piston_area=1e-3, channel_area=1e-5, channel_length=1.0)
    with pytest.raises(DeviceError, match=r"state inertance = 100 in their place"):
        diagnose_bench(records, channel)


@pytest.fixture(scope="module")
def of_wrong_inertance(records) -> Diagnosis:
    """80 kg, stated as 70."""
    return diagnose_bench(records, Device(**{**TRUE, "inertance": 70.0}))


def test_wrong_inertance_is_named_alone(of_wrong_inertance: Diagnosis) -> None:
    diagnosis = of_wrong_inertance
    assert [finding.effect for finding in diagnosis.findings] == ["inertance_error"]
    found = diagnosis.parameters["inertance"]
    assert found.value == pytest.approx(80, rel=0.01)
    assert diagnosis.extended.device["viscous"] == 40.0
    # what the data contradict is told in units and in per cent
    assert isinstance(found, StatedValue)
    assert found.stated == 70.0
    assert found.difference == pytest.approx(10, abs=0.8)
    assert re.search(r"stated 70, \+(9\.\d+|10(\.\d)?) kg, \+1[345] %", diagnosis.verdict)
    told = diagnosis.json()
    assert told["parameters"]["inertance"]["stated"] == 70.0
    # one finding: its gain is the whole one
    low, high = told["findings"][0]["gain_interval"]
    assert low < told["gain"]["value"] < high
    assert told["gain"]["interval"] == pytest.approx([low, high], rel=1e-6)


@pytest.mark.parametrize(
    ("stated", "told"),
    [
        (76.4, "stated 76.4, +3.6 kg, +4.7 %"),
        (76.6, None),
        (83.4, None),
        (83.6, "stated 83.6, -3.6 kg"),
    ],
)
def test_a_contradiction_is_more_than_the_error_of_the_fit(
    of_wrong_inertance: Diagnosis, stated: float, told: str | None
) -> None:
    # 80 +- 1.15 kg: three standard errors reach from 76.55 to 83.45
    value = StatedValue(80.0, 1.15, "kg", stated)
    words = verdict(replace(of_wrong_inertance, parameters={"inertance": value}))
    assert ("contradict" in words) == (told is not None)
    assert told is None or told in words


def test_missing_friction_is_named_beside_stated_values(records) -> None:
    stated = Device(inertance=80.0, viscous=40.0)
    diagnosis = diagnose_bench(records, stated)
    assert [finding.effect for finding in diagnosis.findings] == ["coulomb_friction"]
    assert diagnosis.parameters["coulomb_force"].value == pytest.approx(12, rel=0.03)
    assert "inertance" not in diagnosis.parameters
    assert diagnosis.json()["parameters"]["coulomb_force"]["stated"] is None
    assert "contradict" not in diagnosis.verdict


@pytest.mark.long
def test_two_effects_are_found_without_a_device(records) -> None:
    diagnosis = diagnose_bench(records)
    assert {f.effect for f in diagnosis.findings} == {"coulomb_friction", "viscous_friction"}
    gains = [finding.gain for finding in diagnosis.findings]
    assert gains == sorted(gains, reverse=True)


@pytest.mark.long
def test_outputs_load_and_say_the_same(records, tmp_path: Path) -> None:
    diagnosis = diagnose_bench(records)
    write_outputs(diagnosis, tmp_path)
    names = {"diagnosis.json", "report.html", "device.toml", "model.xml"}
    assert {path.name for path in tmp_path.iterdir()} == names
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "model.xml"))
    assert model.nactuator >= 1
    from_toml, from_model = (
        read_device(tmp_path / "device.toml"),
        device_of_model(tmp_path / "model.xml"),
    )
    assert from_toml.given == diagnosis.extended.device
    assert from_model.given == from_toml.given

    # the extended device as baseline leaves nothing to find
    assert diagnose_bench(records, from_toml).findings == []


def test_a_baseline_from_a_file_of_another_kind_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "run.csv"
    path.write_text("time,displacement\n", encoding="utf-8")
    with pytest.raises(DeviceError, match=r"run\.csv: .* give a model, \.xml$"):
        device_of_model(path)


def test_device_file_round_trip(tmp_path: Path) -> None:
    device = Device(inertance=113.25, friction="lugre", coulomb_force=10.0, static_force=12.0)
    path = tmp_path / "device.toml"
    path.write_text(device_text(device, delay=1e-3, title="a test"), encoding="utf-8")
    assert read_device(path).given == device.given


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[device\n", "not TOML"),
        ("inertance = 3\n", "no [device] table"),
        ('[device]\ninertance = "12 mm"\n', "inertance is"),
        ("[device]\ninertnce = 12\n", "did you mean inertance"),
        ("[device]\ninertance = -1\n", "out of range"),
        ("[device]\ninertance = [1]\n", "give a number"),
        ('[device]\nfriction = "magic"\n', "no such law"),
    ],
)
def test_bad_device_files(tmp_path: Path, text: str, words: str) -> None:
    path = tmp_path / "device.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ValueError, match=r"device\.toml") as caught:
        read_device(path)
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)


def test_units_in_device_files(tmp_path: Path) -> None:
    path = tmp_path / "device.toml"
    path.write_text('[device]\ninertance = "0.5 tonne"\nrest_length = "30 mm"\n', encoding="utf-8")
    device = read_device(path)
    assert (device.inertance, device.rest_length) == (pytest.approx(500), pytest.approx(0.03))


@pytest.mark.parametrize(
    ("text", "found"),
    [("0.05", 0.05), ("-0.002", -0.002), ('"2 ms"', 0.002), ('"-30 ms"', -0.03)],
)
def test_a_stated_delay_is_what_a_fit_begins_with(tmp_path: Path, text: str, found: float) -> None:
    path = tmp_path / "device.toml"
    path.write_text(f"[device]\ninertance = 3\n[channels]\nforce_delay = {text}\n")
    assert read_delay(path) == pytest.approx(found)
    how = search_range("delay", Scales(force=1.0, displacement=1.0, velocity=1.0, acceleration=1.0))
    assert how.decode(how.encode(read_delay(path))) == pytest.approx(found)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[channels]\nforce_delay = 0.2\n", "beyond the 0.05 s"),
        ('[channels]\nforce_delay = "-51 ms"\n', "inerter prepare --delay -0.051"),
        ("[channels]\nforce_delay = nan\n", "give seconds"),
        ("[channels]\nforce_delay = true\n", "give seconds"),
        ('[channels]\nforce_delay = "2 mm"\n', "a text in s"),
        ("channels = 0.001\n", "write a [channels] table"),
    ],
)
def test_delays_that_cannot_be_held_are_refused(tmp_path: Path, text: str, words: str) -> None:
    path = tmp_path / "device.toml"
    path.write_text(text)
    with pytest.raises(DeviceError, match=re.escape(words)):
        read_delay(path)


@pytest.mark.long
def test_a_doubtful_record_is_told_before_any_cause(records) -> None:
    turned = [replace(record, force=-record.force) for record in records]
    checked = check_records(turned)
    assert any(w.code == "sign_flip" for record in checked for w in record.warnings)
    diagnosis = diagnose_bench(checked)
    assert diagnosis.verdict.startswith("Look at the records first: run_")
    right = diagnose_bench(check_records(records))
    assert right.verdict.startswith("The simulation")


TRAIN = {"inertance": 80.0, "series_stiffness": 7.1e5, "series_damping": 800.0}
CYLINDER = {
    "inertance": 80.0, "gas_pressure": 2e5, "gas_area": 1e-3, "gas_volume": 1e-4,
    "gas_exponent": 1.3,
}  # fmt: skip
SLIDE = {
    "inertance": 80.0, "friction": "lugre", "coulomb_force": 12.0, "static_force": 16.0,
    "stribeck_velocity": 0.02, "bristle_stiffness": 2e4, "bristle_damping": 60.0,
}  # fmt: skip
GREASED = {
    "inertance": 80.0, "friction": "brown_mcphee", "coulomb_force": 12.0, "static_force": 16.0,
    "stribeck_velocity": 0.03,
}  # fmt: skip
WIRE = {
    "inertance": 80.0, "friction": "bouc_wen", "bw_stiffness": 3e4, "bw_alpha": 0.9,
    "bw_beta": 1500.0, "bw_gamma": 500.0, "bw_exponent": 1.0, "bw_ratio": 0.05,
}  # fmt: skip


def two_runs(true: dict, seconds: float = 7.0) -> list[Record]:
    motions = [
        sum_of_sines([0.01, 0.003, 0.001], [0.7, 1.9, 4.1], [0.0, 1.0, 2.0]),
        sum_of_sines([0.015, 0.002, 0.0007], [0.5, 2.3, 5.1], [0.0, 0.5, 1.0]),
    ]
    return measured(ReferenceDevice(**true), motions, np.arange(0, seconds, 2e-3))


@pytest.mark.long
@pytest.mark.parametrize(
    ("true", "wrong", "effect"),
    [
        (SLIDE, {"bristle_stiffness": 6e4}, "hysteretic_friction"),
        (GREASED, {"coulomb_force": 8.0, "static_force": 12.0}, "stribeck_friction"),
        (TRAIN, {"series_stiffness": 1.4e6}, "series_elasticity"),
        (CYLINDER, {"gas_pressure": 3e5}, "gas_spring"),
        (WIRE, {"bw_stiffness": 5e4}, "hysteretic_friction"),
    ],
)
def test_any_stated_parameter_can_be_contradicted(true: dict, wrong: dict, effect: str) -> None:
    diagnosis = diagnose_bench(two_runs(true), Device(**{**true, **wrong}))
    assert [finding.effect for finding in diagnosis.findings] == [effect]
    assert diagnosis.gain > 0.8
    for name, value in wrong.items():
        found = diagnosis.parameters[name]
        assert isinstance(found, StatedValue)
        assert found.stated == value
        assert found.value == pytest.approx(true[name], rel=0.06)
    assert "contradict what is stated" in diagnosis.verdict


@pytest.mark.long
@pytest.mark.parametrize("true", [GREASED, TRAIN, CYLINDER])
def test_what_is_stated_right_is_held(true: dict) -> None:
    diagnosis = diagnose_bench(two_runs(true, 5.0), Device(**true))
    assert diagnosis.findings == []
    for name, value in true.items():
        assert diagnosis.extended.device[name] == value


def test_a_stated_law_in_words_outlasts_a_finding() -> None:
    """A finding that is dropped or added does not change how the gas is stated to behave."""
    stated = Device(**{**CYLINDER, "gas_law": "expanded"})
    model = baseline_model(stated, 80.0, 1e-3)
    assert model.texts == {"gas_law": "expanded"}
    assert submodel(model.adding(None, viscous=20.0), [], model).texts == model.texts
