"""A low-pass of one channel: found by its amplitude, told from a delay, or stated."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from inerter import Device
from inerter.catalogue.effects import EFFECTS
from inerter.catalogue.scales import Scales
from inerter.device_file import DeviceError, device_text, read_delay, read_device, read_filters
from inerter.diagnose import diagnose, diagnose_bench, low_passes
from inerter.diagnose.baseline import baseline_of
from inerter.diagnose.composition import effects_of, stripped
from inerter.diagnose.data import divided
from inerter.diagnose.exchangeable import with_delay
from inerter.diagnose.low_passes import filters, noise_taken
from inerter.diagnose.result import Finding, ParameterValue, Rival
from inerter.diagnose.search import Search
from inerter.diagnose.wording import effect_in_words
from inerter.identify.channel_filter import Filter, named
from inerter.identify.fit import Fit
from inerter.identify.model import Model
from inerter.identify.runs import thin
from inerter.records import Record
from inerter.records.preparation import prepare, weighed
from inerter.reference.bench_channel import Channel, low_passed

SIZES = Scales(force=10.0, displacement=0.01, velocity=0.1, acceleration=1.0, cutoff=30.0)
RATE, FINE = 500.0, 10
BESSEL = Filter("bessel", 4, 50.0)


def run(seed: int, channel: str | None, delay: float = 0.0) -> Record:
    """8 s of 60 kg with 80 N s/m and 12 N of friction behind a Bessel filter or a delay."""
    random = np.random.default_rng(seed)
    time = np.arange(-500 * FINE, 4000 * FINE) / (RATE * FINE)
    x, v, a = np.zeros((3, time.size))
    for frequency, size in ((0.8, 0.02), (2.1, 0.008), (4.7, 0.002), (9.0, 6e-4)):
        w, phase = 2 * np.pi * frequency, 2 * np.pi * frequency * time + random.uniform(0, 6)
        x += size * np.sin(phase)
        v += size * w * np.cos(phase)
        a -= size * w**2 * np.sin(phase)
    force = 60 * a + 80 * v + 12 * np.tanh(v / 1e-3)
    low_pass = Channel(force_filter=50.0, force_filter_order=4.0, force_filter_bessel=1.0)
    if channel == "force":
        force = low_passed(low_pass, time, force)
    if delay:
        force = np.interp(time - delay, time, force)
    rows = slice(500 * FINE, None, FINE)
    count = time[rows].size
    return Record(
        name=f"run {seed}",
        time=time[rows] + 20 * seed,
        displacement=x[rows] + 1e-6 * random.normal(size=count),
        force=force[rows] + 0.4 * random.normal(size=count),
    )


def test_every_order_and_kind_is_tried_as_late_as_the_delay() -> None:
    model = baseline_of(None, SIZES).adding(None, delay=6e-3)
    tried = list(filters(model, model.delay))
    assert len(tried) == 7
    for each in tried:
        (start,) = each.starts
        channel, kind, order = (each.law or "").split()
        assert channel == "force"
        assert "delay" not in start.values
        assert "force_filter" in start.free
        assert not {"force_filter_order", "force_filter_bessel"} & set(start.free)
        found = Filter(kind, int(order), start.values["force_filter"])
        assert found.lateness == pytest.approx(6e-3)
        # read off the model, and taken out of it again
        assert effects_of(start, baseline_of(None, SIZES)) == [("sensor_filter", None)]
        bare = stripped(start, "sensor_filter", baseline_of(None, SIZES))
        assert not set(EFFECTS["sensor_filter"].coordinates) & set(bare.values)


def test_a_force_that_comes_early_is_a_displacement_that_is_filtered() -> None:
    model = baseline_of(None, SIZES)
    assert not list(filters(model))
    tried = list(filters(model, -4e-3))
    assert all((each.law or "").startswith("displacement") for each in tried)
    # one that is stated stays alone
    assert not list(filters(model.holding(force_filter=50.0), 6e-3))


@pytest.mark.long
def test_a_bessel_filter_is_found_and_no_shaft() -> None:
    channel = "force"
    found = diagnose_bench([run(0, channel), run(1, channel)])
    named = {finding.effect: finding for finding in found.findings}
    assert set(named) == {"sensor_filter", "coulomb_friction", "viscous_friction"}
    cutoff = named["sensor_filter"].parameters[f"{channel}_filter"]
    assert abs(cutoff.value - 50.0) < max(1.0, 4 * cutoff.stderr)
    assert named["sensor_filter"].law == f"{channel}, {BESSEL.words}"
    assert abs(named["viscous_friction"].parameters["viscous"].value - 80) < 1.5
    assert found.extended.filters.keys() == {channel}
    assert found.engines["mujoco"] == pytest.approx(found.extended.rmse, rel=1e-3)


@pytest.mark.long
def test_a_delay_stays_a_delay() -> None:
    found = diagnose_bench([run(0, None, 6.7e-3), run(1, None, 6.7e-3)])
    assert "sensor_delay" in {finding.effect for finding in found.findings}
    assert "sensor_filter" not in {finding.effect for finding in found.findings}


@pytest.mark.long
def test_a_stated_filter_is_no_finding() -> None:
    runs = [run(0, "force"), run(1, "force")]
    found = diagnose_bench(runs, filters={"force": BESSEL})
    assert {f.effect for f in found.findings} == {"coulomb_friction", "viscous_friction"}
    assert found.baseline.filters == {"force": BESSEL.text}


def test_a_device_file_keeps_the_filter(tmp_path: Path) -> None:
    path = tmp_path / "device.toml"
    device = Device(inertance=60.0)
    path.write_text(device_text(device, delay=1e-3, filters={"force": BESSEL.text}))
    assert read_filters(path) == {"force": "bessel:50.0:4"}
    assert (read_delay(path), read_device(path).given) == (1e-3, device.given)
    path.write_text("[device]\ninertance = 60.0\n[channels]\nforce_filter = 50\n")
    with pytest.raises(DeviceError, match=r"force_filter is 50; give a text"):
        read_filters(path)


@pytest.mark.parametrize("given", ["bessel:50", "torque=bessel:50", "force=50"])
def test_what_is_no_filter_of_a_channel_is_refused(given: str, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"--filter .* such as .*bessel:50"):
        diagnose([tmp_path / "none.csv"], filters=[given])


def sine_behind(cutoff: float, highest: float) -> tuple[Finding, Search, Fit]:
    """A finding of a Butterworth low-pass of order 4 in front of 60 kg along sines."""
    random = np.random.default_rng(3)
    time = np.arange(-1000 * FINE, 4000 * FINE) / (RATE * FINE)
    x, a = np.zeros((2, time.size))
    for frequency in highest * np.array([0.2, 0.45, 0.7, 1.0]):
        w, phase = 2 * np.pi * frequency, random.uniform(0, 6)
        x += 8.0 / w**2 * np.sin(w * time + phase)
        a -= 8.0 * np.sin(w * time + phase)
    low_pass = Channel(force_filter=cutoff, force_filter_order=4.0)
    force, rows = low_passed(low_pass, time, 60 * a), slice(1000 * FINE, None, FINE)
    record = Record(
        name="run", time=time[rows],
        displacement=x[rows] + 1e-7 * random.normal(size=4000),
        force=force[rows] + 2.0 * random.normal(size=4000),
    )  # fmt: skip
    data = divided([record], prepare([record]), ())
    baseline = Model("none", {"inertance": 60.0}, ("inertance",))
    search = Search(data.runs, data.split, baseline)
    found = named("force", Filter("butterworth", 4, cutoff))
    model = baseline.adding(None, force_filter=found.pop("force_filter")).holding(**found)
    finding = Finding(
        effect="sensor_filter", law="force, Butterworth, order 4", confidence=0.99,
        parameters={"force_filter": ParameterValue(cutoff, 0.01, "Hz")},
        rmse_before=9.0, rmse_after=0.5, evidence="It is there.", rivals=[],
    )  # fmt: skip
    return finding, search, search.problem.fit(model)


def test_a_low_pass_far_above_the_motion_may_be_another_one_with_a_delay() -> None:
    finding, search, fit = sine_behind(60.0, 6.0)
    told = with_delay(finding, search, fit)
    assert told.members == ("sensor_filter", "sensor_delay")
    assert told.confidence == finding.confidence
    delay = told.parameters["delay"]
    assert delay.stderr >= abs(delay.value) > 0
    assert told.parameters["force_filter"].stderr > 0.01
    assert "with a delay of" in told.evidence
    assert ", with or without a delay" in effect_in_words(told)


def test_one_within_the_motion_is_told() -> None:
    finding, search, fit = sine_behind(10.0, 12.0)
    assert with_delay(finding, search, fit) is finding


def test_what_a_shafts_damping_takes_of_the_motions_noise_is_added_again() -> None:
    record = run(1, None)
    prepared = weighed([record], prepare([record]))
    (thinned,) = (replace(each, corner=8.0, noise=0.4) for each in map(thin, prepared.motions))
    counted = [(0, np.arange(100))]
    stiff, loose = (
        Model("none", {"inertance": 60.0, "series_frequency": f, "series_loss": 2.0}, ())
        for f in (3e3, 6.0)
    )
    assert noise_taken(stiff, [thinned], counted)[0] < 0.02 * 100 * 0.4**2
    assert noise_taken(loose, [thinned], counted)[0] > 0.1 * 100 * 0.4**2


def test_along_one_sine_a_low_pass_may_be_a_damper() -> None:
    random = np.random.default_rng(4)
    time = np.arange(0, 8, 1 / RATE)
    w = 2 * np.pi * 2.0
    x, v = 0.01 * np.sin(w * time), 0.01 * w * np.cos(w * time)
    a = -(w**2) * x
    record = Record(
        name="sine", time=time, displacement=x + 1e-6 * random.normal(size=time.size),
        force=60 * a + 50 * v + 0.5 * random.normal(size=time.size),
    )  # fmt: skip
    data = divided([record], prepare([record]), ())
    search = Search(data.runs, data.split, Model("none", {"inertance": 60.0}, ("inertance",)))
    assert search.problem.scales.one_tone
    found = named("force", Filter("bessel", 2, 12.0))
    model = search.baseline.adding(None, force_filter=found.pop("force_filter")).holding(**found)
    fit = search.problem.fit(model)
    value = fit.model.values["force_filter"]
    finding = Finding(
        effect="sensor_filter", law="force, Bessel, order 2", confidence=0.9,
        parameters={"force_filter": ParameterValue(value, 0.1, "Hz")},
        rmse_before=4.0, rmse_after=0.5, evidence="It is there.",
        rivals=[Rival("sensor_delay", 0.1)],
    )  # fmt: skip
    told = with_delay(finding, search, fit)
    assert told.members == ("sensor_filter", "viscous_friction", "sensor_delay")
    assert told.confidence == pytest.approx(0.45)
    assert told.parameters["viscous"].value == pytest.approx(50.0, rel=0.05)
    assert [rival.effect for rival in told.rivals] == ["viscous_friction"]
    assert "this motion cannot tell" in told.evidence


@pytest.mark.long
def test_beside_a_hum_a_delay_may_be_a_filter(effects_seed: int) -> None:
    """A filter of order two is as late up to where the motion goes; the hum tells nothing of it."""
    random = np.random.default_rng(effects_seed)
    rate, fine, seconds = 1000, 10, 14.0
    time = np.arange(-rate * fine, int(seconds * rate * fine)) / (rate * fine)
    x, v, a = np.zeros((3, time.size))
    for frequency, size in ((0.7, 0.025), (1.9, 0.008), (4.3, 0.002)):
        w, phase = 2 * np.pi * frequency, 2 * np.pi * frequency * time + random.uniform(0, 6)
        x += size * np.sin(phase)
        v += size * w * np.cos(phase)
        a -= size * w**2 * np.sin(phase)
    bristle = Device(friction="dahl", coulomb_force=55.0, bristle_stiffness=2.2e5)
    force = 75 * a + bristle.along(1 / (rate * fine), x, v, a)["friction"]
    low_pass = Channel(force_filter=60.0, force_filter_order=2.0, force_filter_bessel=0.0)
    shown = low_passed(low_pass, time, force)[rate * fine :: fine]
    at = np.arange(shown.size) / rate
    hum = 4.0 * np.sin(2 * np.pi * 50.02 * at + 1.0)
    record = Record(
        name="hum", time=at, force=shown + hum + random.normal(0, 0.8, at.size),
        displacement=x[rate * fine :: fine] + random.normal(0, 3e-6, at.size),
    )  # fmt: skip
    found = {each.effect: each for each in diagnose_bench([record]).findings}
    (late,) = {"sensor_delay", "sensor_filter"} & found.keys()
    members = {late, *found[late].members, *(rival.effect for rival in found[late].rivals)}
    assert {"sensor_delay", "sensor_filter"} <= members
    assert "periodic_disturbance" in found


@pytest.mark.parametrize(("also", "asked"), [({}, 0.0), ({"backlash": 1e-4}, 5e-3)])
def test_behind_a_play_a_low_pass_is_asked_for_where_no_delay_shows(
    also: dict[str, float], asked: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What strikes is rounded by it more than it is late."""
    told: list[float] = []

    def best(*given: Any) -> list[Any]:
        told.append(given[3])
        return []

    monkeypatch.setattr(low_passes, "_best", best)
    values = {"inertance": 90.0, "series_frequency": 15.0, "series_loss": 0.5, **also}
    fit = Fit(Model("none", values, tuple(values)), [np.ones(9)], np.eye(len(values)), 1)
    search = SimpleNamespace(
        problem=SimpleNamespace(masks=[np.ones(9, bool)]), excluded=frozenset(), spacing=5e-3
    )
    low_passes.where_late(cast(Any, search), cast(Any, SimpleNamespace(fit=fit)), [])
    assert told == [asked]
