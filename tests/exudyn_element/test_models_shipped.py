"""The Exudyn models: numbers, names and errors; scripts and README; what is installed."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest
from inerter.model_parameters import QUARTER_CAR, TEST_RIG
from inerter.models import exudyn_model, exudyn_model_names, model_names, model_path

# a module of Exudyn, not "exudyn": this very folder would be taken for that
pytest.importorskip("exudyn.itemInterface")

import exudyn as exu
from inerter.exudyn.model_parts import simulate
from model_cases import ELASTIC, LAYOUTS

# ------------------------------ numbers, names, errors ------------------------------


def actuators(name: str, file: str = "model.xml") -> set[str]:
    spec = mujoco.MjSpec.from_file(str(model_path(name, file)))
    return {actuator.name for actuator in spec.actuators}


@pytest.mark.parametrize("name", model_names())
def test_names_are_those_of_the_mjcf_model(name: str) -> None:
    """Inputs and inerters are its actuators; a wrong input is answered with the right ones."""
    assert exudyn_model_names() == model_names()
    module, container = exudyn_model(name), exu.SystemContainer()
    model = module.build(container.AddSystem())
    with pytest.raises(ValueError, match="inputs: no 'nothing', there is") as raised:
        module.build(container.AddSystem(), inputs={"nothing": np.sin})
    there = str(raised.value).split("there is ")[1].split(", ")
    assert {*there, *model.inerters} == actuators(name)
    with pytest.raises(ValueError, match="initial_velocities: no 'nothing', there is ") as raised:
        module.build(container.AddSystem(), initial_velocities={"nothing": 1.0})
    assert str(raised.value).split("there is ")[1].split(", ") == list(model.coordinates)


def mass_of(mbs: Any, name: str) -> float:
    return mbs.GetObjectParameter(mbs.GetObjectNumber(name), "mass")


@pytest.mark.parametrize("layout", LAYOUTS)
def test_numbers_of_the_quarter_car(layout: str) -> None:
    """The shared numbers, the Exudyn model and the MJCF file say the same."""
    car, strut = QUARTER_CAR, QUARTER_CAR.struts[layout]
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    exudyn_model("quarter_car").build(mbs, layout=layout)
    assert (mass_of(mbs, "body"), mass_of(mbs, "wheel")) == (car.sprung_mass, car.unsprung_mass)
    found = {
        name: mbs.GetObject(mbs.GetObjectNumber(name)) for name in ("tyre", "spring", "damper")
    }
    assert found["tyre"]["stiffness"] == car.tyre_stiffness
    assert (found["spring"]["stiffness"], found["damper"]["damping"]) == (
        car.stiffness,
        strut.damping,
    )

    spec = mujoco.MjSpec.from_file(str(model_path("quarter_car", f"model_{layout.lower()}.xml")))
    model = spec.compile()
    masses = [model.body(name).mass[0] for name in ("sprung", "unsprung")]
    assert masses == [car.sprung_mass, car.unsprung_mass]
    assert model.actuator("road").gainprm[0] == car.tyre_stiffness
    told = {key: float(value) for plugin in spec.plugins for key, value in plugin.config.items()}
    if layout == "S2":
        assert told == {
            "inertance": strut.inertance,
            "viscous": strut.damping,
            "stiffness": car.stiffness,
            "rest_length": car.strut_length,
        }
    else:
        assert told == ({"inertance": strut.inertance} if layout == "S3" else {})
        assert sorted(model.tendon_stiffness)[-1] == car.stiffness
        assert sorted(model.tendon_damping[:, 0] if model.tendon_damping.ndim > 1
                      else model.tendon_damping)[-1] == strut.damping  # fmt: skip


@pytest.mark.parametrize("name", ["half_car", "full_car"])
def test_numbers_of_the_vehicles(name: str) -> None:
    """Masses, places and springs, corner by corner, against the MJCF file."""
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    model = exudyn_model(name).build(mbs)
    compiled = mujoco.MjModel.from_xml_path(str(model_path(name)))
    data = mujoco.MjData(compiled)
    mujoco.mj_kinematics(compiled, data)
    assert mass_of(mbs, "body") == compiled.body("sprung").mass[0]
    body = mbs.GetNodeParameter(model.coordinates["heave"][0], "referenceCoordinates")
    assert list(body[:3]) == compiled.body("sprung").pos.tolist()
    for strut in model.inerters:
        corner = strut.removeprefix("strut_")
        wheel = compiled.body(f"wheel_{corner}")
        assert mass_of(mbs, f"wheel_{corner}") == wheel.mass[0]
        place = mbs.GetNodeParameter(
            model.coordinates[f"wheel_{corner}"][0], "referenceCoordinates"
        )
        assert list(place) == wheel.pos.tolist()
        tyre = mbs.GetObject(mbs.GetObjectNumber(f"tyre_{corner}"))
        assert tyre["stiffness"] == compiled.actuator(f"road_{corner}").gainprm[0]
        top = mbs.GetMarkerParameter(mbs.GetMarkerNumber(f"Marker1:{strut}"), "localPosition")
        assert np.allclose(top, compiled.site(f"strut_upper_{corner}").pos, rtol=0, atol=1e-15)


def test_numbers_of_the_test_rig() -> None:
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    model = exudyn_model("test_rig").build(mbs)
    compiled = mujoco.MjModel.from_xml_path(str(model_path("test_rig")))
    assert mass_of(mbs, "table") == TEST_RIG.table_mass == compiled.body("table").mass[0]
    spec = mujoco.MjSpec.from_file(str(model_path("test_rig")))
    told = float(spec.plugins[0].config["inertance"])
    assert model.inerters["device"].device.inertance == TEST_RIG.inertance == told


@pytest.mark.parametrize("solver", ["RK44", "GeneralizedAlpha"])
def test_the_rig_imposes_the_motion(solver: str) -> None:
    """X = A sin(w t) to the solver's error, F = -b w^2 x; the device moves nothing."""
    amplitude, w = 3e-3, 6 * np.pi
    container = exu.SystemContainer()
    model = exudyn_model("test_rig").build(
        container.AddSystem(),
        inputs={"shaker": lambda t: -amplitude * w * w * np.sin(w * t)},
        initial_velocities={"table": amplitude * w},
    )
    found = simulate(model, 1.0, solver=solver)
    tolerance = 1e-8 if solver == "RK44" else 1e-3
    motion = amplitude * np.sin(w * found.time)
    assert np.abs(found.displacement["table"] - motion).max() < tolerance * amplitude
    force = -TEST_RIG.inertance * w * w * motion
    assert np.abs(found.force["device"] - force)[1:].max() < tolerance * np.abs(force).max()


@pytest.mark.parametrize(
    ("name", "arguments", "message"),
    [
        ("quarter_car", {"layout": "S4"}, "layout: 'S4' is not one of S1, S2, S3"),
        ("half_car", {"layout": "S4"}, "layout: 'S4' is not one of S1, S2, S3"),
        ("full_car", {"layout": "S1", "device": {}}, "layout S1 has no inerter"),
        ("quarter_car", {"layout": "S3", "device": {"inertance": 0}}, "inertance above 0"),
        ("quarter_car", {"layout": "S3", "device": {"inertance": 9, **ELASTIC}}, "choose S2"),
        ("half_car", {"layout": "S3", "device": {"inertance": 9, **ELASTIC}}, "series_stiffness"),
        ("fluid_inerter", {"variant": "wet"}, "'wet' is not one of complete, dry"),
        ("fluid_inerter", {"inputs": {"coil": np.sin}}, "no 'coil', there is force"),
        ("full_car", {"inputs": {"road_frontleft": np.sin}}, "did you mean 'road_front_left'"),
        ("test_rig", {"device": {"inertance": -1}}, "inertance"),
    ],
)
def test_what_cannot_be_is_said(name: str, arguments: dict[str, Any], message: str) -> None:
    container = exu.SystemContainer()
    with pytest.raises(ValueError, match=message):
        exudyn_model(name).build(container.AddSystem(), **arguments)


def test_an_unknown_model_is_named() -> None:
    with pytest.raises(ValueError, match="no Exudyn model 'bicycle'; the models are fluid_inerter"):
        exudyn_model("bicycle")


def test_without_exudyn_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("inerter.models.installed", lambda: False)
    with pytest.raises(ImportError, match="pip install exudyn"):
        exudyn_model("quarter_car")


# ------------------------------ what is shipped ------------------------------


@pytest.mark.parametrize("name", exudyn_model_names())
def test_a_model_runs_as_a_script(name: str, tmp_path: Path) -> None:
    """It prints figures, draws them, and neither it nor Exudyn warns of anything."""
    path = Path(str(exudyn_model(name).__file__))
    done = subprocess.run(
        [sys.executable, "-W", "error", path], cwd=tmp_path, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    assert not done.stderr
    assert "WARNING" not in done.stdout
    drawn = [line.strip() for line in done.stdout.splitlines() if line.endswith(".png")]
    assert len(drawn) >= 2
    for file in drawn:
        assert (tmp_path / file).read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize("name", exudyn_model_names())
def test_the_readme_shows_what_runs(name: str) -> None:
    text = Path(str(exudyn_model(name).__file__)).with_name("README.md").read_text("utf-8")
    for part in ("**Provenance.**", "**Coordinates.**", "**What to look at.**"):
        assert part in text
    blocks = re.findall(r"```python\n(.*?)```", text, re.S)
    assert blocks
    for code in blocks:
        names: dict[str, Any] = {}
        exec(code, names)
        found = names["run"]
        assert all(np.isfinite(values).all() for values in found.displacement.values())
        assert max(np.abs(values).max() for values in found.displacement.values()) > 1e-6


def test_every_model_of_the_checkout_is_installed() -> None:
    checkout = Path(__file__).parents[2] / "exudyn_models"
    if not checkout.is_dir():
        pytest.skip("there is no checkout around these tests")
    for name in exudyn_model_names():
        folder = Path(str(exudyn_model(name).__file__)).parent
        for file in (checkout / name).glob("*.*"):
            assert (folder / file.name).read_bytes() == file.read_bytes(), file.name
