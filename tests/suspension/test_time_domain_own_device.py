"""A user's own device in the study: carried as the reference has it, or refused by its key."""

from __future__ import annotations

import dataclasses
import json
import math
from pathlib import Path

import numpy as np
import pytest
import typer
from inerter.core import Device
from inerter.reference import QuarterCar, ReferenceDevice
from inerter.suspension.indices import ride_comfort
from inerter.suspension.layouts import LAYOUTS
from inerter.suspension.quarter_car import QuarterCar as LinearCar
from inerter.suspension.quarter_car import Road
from inerter.suspension.time_domain.cases import CASES, TRANSITION_VELOCITY
from inerter.suspension.time_domain.command import evaluate_command
from inerter.suspension.time_domain.device_case import case_of
from inerter.suspension.time_domain.model import Design, compiled
from inerter.suspension.time_domain.simulate import RunSettings, load_gains
from typer.testing import CliRunner

SHORT = RunSettings(settle=1.0, jobs=2)
DESIGNS = {"S2": Design(120e3, 3705.4, 128.57), "S3": Design(120e3, 7544.2, 366.52)}
SERIES = {"series_stiffness": 1e6, "series_damping": 3200.0}
CARRIED = [
    {"quadratic_damping": 2000.0},
    {"load_friction": 0.05},
    {"flywheel_viscous": 500.0, **SERIES},
    {"flywheel_viscous": 500.0},
    {"stiffness": 2e4},
    {"stiffness_cubic": 3e8},
    {"inertance_speed_gradient": 0.3},
    {"stop_lower": -0.01, "stop_upper": 0.01, "stop_stiffness": 5e5, "stop_damping": 0.5},
    {"friction": "lugre", "coulomb_force": 5.0, "static_force": 8.0, "bristle_stiffness": 1e5},
    {"friction": "stribeck", "coulomb_force": 50.0, "static_force": 80.0},
    {"friction": "brown_mcphee", "coulomb_force": 25.0, "static_force": 50.0},
    {"friction": "dahl", "coulomb_force": 62.0, "friction_asymmetry": 0.2},
    {"series_hardening": 43.0, "series_stiffness": 1.25e5, "series_damping": 950.0},
    {"backlash": 5e-5, **SERIES},
]
TEXT = """schema = "inerter.device/1"
[device]
inertance = "113 kg"
friction = "coulomb"
coulomb_force = 10.0
series_stiffness = 1e6
series_damping = 3200.0
rest_length = 0.4
"""

app = typer.Typer(pretty_exceptions_enable=False)
app.command()(evaluate_command)


@pytest.mark.parametrize("layout", ["S2", "S3"])
@pytest.mark.parametrize("values", CARRIED, ids=lambda v: "-".join(map(str, v)))
def test_what_is_carried_is_what_the_reference_has(values: dict, layout: str) -> None:
    """1000 N at 2 Hz; every part is felt, so that one that is lost would be seen."""
    design, frequency, amplitude = DESIGNS[layout], 2.0, 1000.0
    case, _ = case_of(Device(inertance=design.inertance, **values), 1e-3)
    found = load_gains(compiled(layout, case), [design], [[frequency]], amplitude, SHORT)[0, 0]
    device = ReferenceDevice(
        inertance=design.inertance,
        friction=case.friction,
        **case.parameters,  # type: ignore[arg-type]
    )
    car = QuarterCar(
        layout=layout, stiffness=design.stiffness, damping=design.damping, device=device
    )

    def load(t: float) -> float:
        fade = 0.5 * (1 - math.cos(np.pi * min(t, 1.0)))
        return amplitude * fade * math.sin(2 * np.pi * frequency * t)

    run = car.simulate(
        lambda t: 0.0, np.arange(0.0, 2.0, 1e-3), body_force=load,
        rtol=1e-6, atol=1e-9, max_step=0.02,
    )  # fmt: skip
    body = run.body_displacement[1000:]
    assert found == pytest.approx(np.sqrt(np.mean(body**2) / (0.5 * amplitude**2)), rel=5e-4)
    ideal = load_gains(
        compiled(layout, CASES["ideal"]), [design], [[frequency]], amplitude, SHORT
    )[0, 0]  # fmt: skip
    assert abs(found / ideal - 1.0) > 1.5e-3


def test_a_parallel_spring_carries_the_static_load() -> None:
    """By hand: beside the spring in S2, behind a damper that yields in S3."""
    case, _ = case_of(Device(inertance=100.0, stiffness=3e4), 1e-3)
    design = Design(12e4, 5e3, 100.0)
    tyre = 1 / 120e3
    assert compiled("S2", case).static_compliance(design) == pytest.approx(1 / 15e4 + tyre)
    assert compiled("S3", case).static_compliance(design) == pytest.approx(1 / 12e4 + tyre)


def test_stiff_bristles_are_stepped_by_another_integrator() -> None:
    stiff, _ = case_of(Device(inertance=100.0, friction="dahl", coulomb_force=5.0), 1e-3)
    soft, _ = case_of(Device(inertance=100.0, friction="dahl", coulomb_force=500.0), 1e-3)
    assert compiled("S2", stiff).implicit
    assert not compiled("S2", soft).implicit


def test_a_file_is_the_case_that_it_describes(tmp_path: Path) -> None:
    """The paper's device in a file is the case "both", to the last digit."""
    (tmp_path / "device.toml").write_text(TEXT)
    common = ["--layout", "S2,S3", "--index", "J1", "--seeds", "2", "--step", "0.002", "--json"]
    rows = []
    device = ["--device", str(tmp_path / "device.toml"), "--inertance", "best"]
    for asked in (["--case", "both"], device):
        run = CliRunner().invoke(app, [*asked, *common, "--out", str(tmp_path / "out")])
        assert run.exit_code == 0, run.output
        rows.append([row for row in json.loads(run.stdout)["rows"] if row["case"] != "ideal"])
    for expected, found in zip(*rows, strict=True):
        assert found.pop("case") == "device"
        assert expected.pop("case") == "both"
        assert expected.pop("numbers")
        assert not found.pop("numbers")
        assert found == expected


def test_a_given_design_is_evaluated_as_it_is(tmp_path: Path) -> None:
    """Its loss is against the optimum of the ideal inerter, which the given design is not."""
    (tmp_path / "device.toml").write_text(TEXT)
    run = CliRunner().invoke(
        app,
        f"--device {tmp_path / 'device.toml'} --damping 3000 --index J1 --seeds 2 --step 0.002 "
        f"--json --out {tmp_path / 'out'}",
    )
    assert run.exit_code == 0, run.output
    rows = json.loads(run.stdout)["rows"]
    assert {(row["damping"], row["inertance"]) for row in rows if row["layout"] != "S1"} == {
        (3000.0, 113.0)
    }
    assert {(row["layout"], row["case"]) for row in rows} == {
        ("S1", "ideal"), ("S2", "ideal"), ("S2", "device"), ("S3", "ideal"), ("S3", "device"),
    }  # fmt: skip
    assert all(row["change"] > 0.0 for row in rows)
    exact = {row["layout"]: row["exact"] for row in rows if row["case"] == "ideal"}
    assert [exact[name] for name in ("S1", "S2", "S3")] > [2.9882, 2.5773, 2.4281]


def test_the_inertance_of_the_file_is_kept(tmp_path: Path) -> None:
    """60 kg stay 60 kg in every layout, with the c that is best for them."""
    path = tmp_path / "device.toml"
    path.write_text(TEXT.replace('"113 kg"', '"60 kg"'))
    common = "--index J1 --seeds 2 --step 0.002 --json --out"
    run = CliRunner().invoke(app, [f"--device={path}", *common.split(), str(tmp_path)])
    assert run.exit_code == 0, run.output
    rows = [row for row in json.loads(run.stdout)["rows"] if row["layout"] != "S1"]
    assert {row["inertance"] for row in rows} == {60.0}
    run = CliRunner().invoke(
        app, ["--inertance=60", "--case=ideal", *common.split(), str(tmp_path)]
    )
    assert run.exit_code == 0, run.output
    car, best = LinearCar(), {row["layout"]: row for row in json.loads(run.stdout)["rows"]}
    for name in ("S2", "S3"):
        c, value = best[name]["damping"], best[name]["exact"]
        for other in (0.98 * c, 1.02 * c):
            strut = LAYOUTS[name].stiffness(120e3, other, 60.0)
            assert ride_comfort(car, Road(), strut) > value * (1.0 + 1e-6)


def test_a_file_without_inertance_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "device.toml"
    path.write_text('[device]\nfriction = "coulomb"\ncoulomb_force = "10 N"\n')
    run = CliRunner().invoke(app, ["--device", str(path), "--out", str(tmp_path / "out")])
    assert run.exit_code == 2
    assert "the file of --device states no inertance" in run.stderr


def test_widths_and_zeros() -> None:
    case, own = case_of(
        Device(inertance=50.0, friction="coulomb", coulomb_force=3.0, backlash=0.0), 1e-3
    )
    assert own == 50.0
    assert dict(case.parameters) == {
        "coulomb_force": 3.0, "transition_velocity": TRANSITION_VELOCITY,
    }  # fmt: skip
    stated, _ = case_of(
        Device(friction="coulomb", coulomb_force=3.0, transition_velocity=5e-4), 1e-3
    )
    assert stated.parameters["transition_velocity"] == 5e-4


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"force_offset": 5.0}, "force_offset = 5.0 moves the ride height"),
        ({"stiffness": -100.0}, "stiffness = -100 is negative"),
        ({"gas_pressure": 1e5, "gas_area": 1e-3, "gas_volume": 1e-4}, "is of a gas spring"),
        (
            {"piston_area": 1e-3, "channel_area": 1e-5, "channel_length": 1.0},
            "piston_area = 0.001 gives the inertance by geometry",
        ),
    ],
)
def test_what_cannot_be_carried_is_named(values: dict, said: str) -> None:
    with pytest.raises(ValueError, match=said):
        case_of(Device(**values), 1e-3)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ("--device nowhere.toml", "nowhere.toml: cannot be opened"),
        ("--case device", "give it with --device device.toml"),
        ("--inertance 0 --layout S3", "S3: inertance is 0"),
        ("--damping 3000/2000 --inertance 30", "give one number for the quarter-car's strut"),
        ("--damping 3000 --inertance x", "--inertance is 'x': give a number"),
        ("--damping 3000 --inertance -1", "inertance is -1 kg"),
        ("--damping 3000 --inertance 30 --reoptimise", "cannot be sought anew"),
        ("--car lorry", "car 'lorry': take quarter, half or full, or a file car.toml"),
        ("--settle 0.1", "settle is 0.1 s"),
    ],
)
def test_bad_input_is_one_line(given: str, said: str, tmp_path: Path) -> None:
    run = CliRunner().invoke(app, [*given.split(), "--out", str(tmp_path / "out")])
    assert run.exit_code == 2
    assert said in run.stderr
    assert run.stderr.count("\n") == 1


def test_a_bad_file_is_named(tmp_path: Path) -> None:
    path = tmp_path / "device.toml"
    path.write_text(TEXT + "force_offset = 5.0\n")
    run = CliRunner().invoke(app, ["--device", str(path), "--out", str(tmp_path / "out")])
    assert run.exit_code == 2
    assert run.stderr.startswith(f"inerter: {path}: force_offset = 5.0")


def test_designs_of_a_device_may_differ_in_its_parameters() -> None:
    case, _ = case_of(Device(friction="coulomb", coulomb_force=10.0), 1e-3)
    car, design = compiled("S2", case), DESIGNS["S2"]
    rough = dataclasses.replace(design, parameters={"coulomb_force": 100.0})
    f = [[2.0], [2.0]]
    both = load_gains(car, [design, rough], f, 1000.0, SHORT)[:, 0]
    assert abs(both[1] / both[0] - 1.0) > 0.01


def test_the_literatures_names_are_taken(tmp_path: Path) -> None:
    run = CliRunner().invoke(
        app, f"--layout SW5 --case ideal --index J1 --seeds 2 --step 0.002 --json --out {tmp_path}"
    )
    assert run.exit_code == 0, run.output
    assert [row["layout"] for row in json.loads(run.stdout)["rows"]] == ["S3"]


def test_a_device_of_a_strut_that_moves_less_than_its_wheel_is_refused(tmp_path: Path) -> None:
    """Its values are the strut's: as the wheel's they would be 1 / ratio^2 too large."""
    (tmp_path / "device.toml").write_text(TEXT)
    car = tmp_path / "car.toml"
    car.write_text(
        "[car]\nkind = 'quarter'\nbody_mass_kg = 90\n[front]\nwheel_mass_kg = 14\n"
        "tyre_stiffness_kN_per_m = 150\n[front.strut]\nlayout = 'S2'\nstiffness_N_per_mm = 60\n"
        "damping_N_s_per_m = 2500\ninertance_kg = 8\nmotion_ratio = 0.6\n"
    )
    app = typer.Typer()
    app.command()(evaluate_command)
    asked = ["--car", str(car), "--device", str(tmp_path / "device.toml"), "--layout", "S2"]
    found = CliRunner().invoke(app, [*asked, "--out", str(tmp_path / "out")])
    assert found.exit_code == 2
    assert "front.strut.motion_ratio is 0.6" in " ".join(found.output.split())
    assert not (tmp_path / "out").exists()
