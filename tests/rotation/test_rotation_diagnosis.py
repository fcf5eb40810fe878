"""The same numbers as of a device that moves along a line and as of one that turns.

Nothing but the units may differ, to the last bit: the laws are the same.
"""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest
from inerter import Device, rig
from inerter.core import DeviceError, parameters
from inerter.device_file import device_text, read_device, read_motion
from inerter.diagnose import Diagnosis, diagnose
from inerter.identify.estimate import identify
from inerter.identify.output import write_identification
from inerter.mjcf import device_of_model, motion_of_model
from inerter.motion_units import Kind, unit
from inerter.records import Record, read_records
from inerter.records.stated import reading
from inerter.report.output import write_outputs
from inerter.unit_text import parse_unit

HEADERS = {"translation": "time,displacement,force", "rotation": "time,angle[rad],torque[N*m]"}
# every unit and word that may differ, the longest first
_UNITS = (
    "N*m*s/rad", "N m s/rad", "N*s/m", "N s/m", "N*m", "N m", "N", "kg*m^2", "kg m^2", "kg",
    "mrad", "mm", "rad", "m", "force", "torque",
)  # fmt: skip
_WORDS = re.compile(r"(?<![A-Za-z])(?:" + "|".join(map(re.escape, _UNITS)) + r")(?![A-Za-z*^])")


def record_text(header: str) -> str:
    """A flywheel of 0.3 kg m^2 with viscous and dry friction, driven by two sines."""
    random = np.random.default_rng(5)
    time = np.arange(2000) / 400
    phases = [2 * np.pi * 1.1 * time, 2 * np.pi * 2.7 * time + 1.0]
    rates = [2 * np.pi * 1.1, 2 * np.pi * 2.7]
    sizes = [0.4, 0.2]
    x, v, a = (
        sum(
            s * w**k * np.sin(p + k * np.pi / 2)
            for s, w, p in zip(sizes, rates, phases, strict=True)
        )
        for k in range(3)
    )
    force = 0.3 * a + 0.5 * v + 0.8 * np.tanh(v / 0.01) + 0.02 * random.normal(size=time.size)
    x = x + 1e-5 * random.normal(size=time.size)
    rows = "\n".join(
        f"{t!r},{p!r},{f!r}"
        for t, p, f in zip(*map(np.ndarray.tolist, (time, x, force)), strict=True)
    )
    return f"{header}\n{rows}\n"


@pytest.fixture(scope="module")
def both(tmp_path_factory: pytest.TempPathFactory) -> dict[str, tuple[Diagnosis, Path]]:
    """Diagnoses of the same numbers, each with the folder of its files."""
    found = {}
    for motion, header in HEADERS.items():
        folder = tmp_path_factory.mktemp(motion)
        (folder / "bench.csv").write_text(record_text(header))
        diagnosis = diagnose([folder / "bench.csv"])
        write_outputs(diagnosis, folder)
        found[motion] = diagnosis, folder
    return found


def leaves(value: Any, path: str = "") -> dict[str, Any]:
    """The values of a JSON by their place."""
    if isinstance(value, dict):
        return {
            k: v for key, each in value.items() for k, v in leaves(each, f"{path}/{key}").items()
        }
    if isinstance(value, list | tuple):
        return {
            k: v for i, each in enumerate(value) for k, v in leaves(each, f"{path}/{i}").items()
        }
    return {path: value}


def test_nothing_but_units_differs(both: dict[str, tuple[Diagnosis, Path]]) -> None:
    along, about = (leaves(both[m][0].json()) for m in HEADERS)
    assert along.keys() == about.keys()
    assert along.pop("/motion"), about.pop("/motion") == ("translation", "rotation")
    for place, value in along.items():
        other = about[place]
        if place.startswith("/engines/mujoco"):
            assert other == pytest.approx(value, rel=1e-12)
        elif place.endswith("/unit"):
            assert other == unit("rotation", value)
        elif isinstance(value, str):
            assert _WORDS.sub("", other).split() == _WORDS.sub("", value).split(), place
        else:
            assert other == value, place
    findings = {f.effect: f for f in both["rotation"][0].findings}
    assert {"viscous_friction", "coulomb_friction"} <= set(findings)
    viscous = findings["viscous_friction"].parameters["viscous"]
    assert abs(viscous.value - 0.5) < 4 * viscous.stderr + 0.01
    assert viscous.unit == "N*m*s/rad"


def test_no_text_speaks_of_newtons_or_metres(both: dict[str, tuple[Diagnosis, Path]]) -> None:
    diagnosis, folder = both["rotation"]
    texts = [
        diagnosis.verdict,
        diagnosis.unexplained.summary,
        *(f.evidence for f in diagnosis.findings),
    ]
    page = (folder / "report.html").read_text("utf-8")
    page = re.sub(r"<(script|style).*?</\1>", "", page, flags=re.S)
    texts.append(re.sub(r"<[^>]+>", " ", page))
    for text in texts:
        assert not re.search(
            r"\d N (?!m)|\d\u00a0N\b(?! m| m|·m)|\[N\]|\[m\]|\bkg\b(?!.?m)|N s/m", text
        )


def test_files_are_of_a_device_that_turns(both: dict[str, tuple[Diagnosis, Path]]) -> None:
    for motion, (diagnosis, folder) in both.items():
        model = mujoco.MjModel.from_xml_path(str(folder / "model.xml"))
        kind = mujoco.mjtJoint.mjJNT_HINGE if motion == "rotation" else mujoco.mjtJoint.mjJNT_SLIDE
        assert model.jnt_type[0] == kind
        assert motion_of_model(folder / "model.xml") == motion
        assert (
            device_of_model(folder / "model.xml").given == read_device(folder / "device.toml").given
        )
        text = (folder / "device.toml").read_text()
        assert ("kg*m^2 (standard error" in text) == (motion == "rotation")
        assert read_motion(folder / "device.toml") == (None if motion == "translation" else motion)
        assert diagnosis.motion == motion


def test_a_device_of_the_other_kind_is_refused(both: dict[str, tuple[Diagnosis, Path]]) -> None:
    record = both["rotation"][1] / "bench.csv"
    with pytest.raises(DeviceError, match=r"moves along a line .* bench turns"):
        diagnose([record], model=both["translation"][1] / "model.xml")
    line = both["translation"][1] / "bench.csv"
    with pytest.raises(DeviceError, match=r"device turns .* bench moves along"):
        diagnose([line], device=both["rotation"][1] / "device.toml")


def test_units_of_a_stated_device(tmp_path: Path) -> None:
    path = tmp_path / "device.toml"
    path.write_text('[device]\ninertance = "3000 g*cm^2"\nviscous = "2 mN*m*s/deg"\n')
    device = read_device(path)
    assert read_motion(path) == "rotation"
    assert device.inertance == pytest.approx(3e-4)
    assert device.viscous == pytest.approx(2e-3 * 180 / np.pi)
    path.write_text('[device]\ninertance = "3 kg"\nviscous = "2 N*m*s/rad"\n')
    with pytest.raises(DeviceError, match=r'inertance = "3 kg" .* viscous = "2 N\*m\*s/rad"'):
        read_motion(path)


@pytest.mark.parametrize("motion", ["translation", "rotation"])
def test_every_unit_that_is_written_can_be_read(motion: Kind, tmp_path: Path) -> None:
    for name, known in parameters().items():
        text = unit(motion, known.unit).replace("^-n", "")
        assert text == "1" or parse_unit(text) is not None, name
    device = Device(friction="lugre", inertance=2.0, coulomb_force=1.0, bristle_stiffness=300.0)
    path = tmp_path / "device.toml"
    path.write_text(device_text(device, motion=motion))
    assert read_device(path).given == device.given


def test_engines_turn_as_they_move() -> None:
    time = np.arange(400) / 400
    x, v, a = np.sin(9 * time), 9 * np.cos(9 * time), -81 * np.sin(9 * time)
    device = Device(
        inertance=0.3, viscous=0.5, friction="dahl", coulomb_force=2.0, bristle_stiffness=400.0,
        series_stiffness=900.0, series_damping=0.4,
    )  # fmt: skip
    simulate = [rig.simulate_along]
    pytest.importorskip("exudyn")
    from inerter.exudyn.rig import simulate_along

    for along in [*simulate, simulate_along]:
        line = along(device, 1 / 400, x, v, a)["total"]
        turned = along(device, 1 / 400, x, v, a, motion="rotation")["total"]
        np.testing.assert_allclose(turned, line, atol=1e-11 * np.abs(line).max())


def test_identify_gives_units_and_a_hinge(tmp_path: Path) -> None:
    records: list[Record] = []
    results = {}
    for motion, header in HEADERS.items():
        path = tmp_path / f"{motion}.csv"
        path.write_text(record_text(header))
        records = read_records(path, "bench")
        results[motion] = identify(records, ("coulomb",), intervals="normal")
    along, about = results.values()
    for name, each in along.best.parameters.items():
        other = about.best.parameters[name]
        assert (other.value, other.stderr) == (each.value, each.stderr)
        assert other.unit == unit("rotation", each.unit)
    write_identification(about, tmp_path)
    assert json.loads((tmp_path / "identification.json").read_text())["motion"] == "rotation"
    assert motion_of_model(tmp_path / "model.xml") == "rotation"


def test_a_drift_is_told_in_the_units_of_the_angle(tmp_path: Path) -> None:
    path = tmp_path / "speed.csv"
    text = record_text("time,angular_velocity[rad/s],torque[N*m]")
    path.write_text(text)
    with reading() as told:
        (record,) = read_records(path, "bench")
    assert record.motion == "rotation"
    assert any("mrad was taken out" in line for line in told.told)
