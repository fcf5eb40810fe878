"""A mass that moves with the terminal, before a shaft: a nut, a grip, a first flywheel."""

from __future__ import annotations

from pathlib import Path

import mujoco
import numpy as np
import pytest
from inerter import rig
from inerter.diagnose import diagnose_bench
from inerter.diagnose.candidates import candidates
from inerter.diagnose.cannot_tell import is_hidden
from inerter.identify.model import Model
from inerter.identify.runs import scales, thin
from inerter.records import Record
from inerter.records.preparation import prepare
from inerter.report.output import write_outputs

TIME = np.arange(0, 10, 1 / 500)
FREQUENCIES = np.array([0.7, 1.9, 4.3, 8.9, 13.7, 19.1])
# acceleration of every sine [m/s^2]
SIZES = np.array([0.4, 0.8, 1.5, 1.5, 1.5, 1.5])
INERTANCE, STIFFNESS, DAMPING, COULOMB = 40.0, 2.3e5, 600.0, 12.0


def record(seed: int, mass: float, noise: float = 0.5) -> Record:
    """Of 40 kg on a shaft of 12 Hz behind a mass [kg], in closed form for every sine."""
    draw = np.random.default_rng([seed, 31])
    s = 2j * np.pi * FREQUENCIES
    phases = draw.uniform(0, 2 * np.pi, FREQUENCIES.size)
    pull = STIFFNESS + DAMPING * s
    # of the flywheel's acceleration over the terminal's
    share = pull / (INERTANCE * s**2 + pull)
    rows = SIZES * np.exp(1j * (2 * np.pi * np.outer(TIME, FREQUENCIES) + phases))
    a = np.real(rows).sum(axis=1)
    force = np.real(rows * (mass + INERTANCE * share)).sum(axis=1)
    v, x = np.real(rows / s).sum(axis=1), np.real(rows / s**2).sum(axis=1)
    assert np.allclose(np.gradient(v, TIME)[1:-1], a[1:-1], atol=0.02 * np.abs(a).max())
    force += COULOMB * np.tanh(v / 1e-3) + noise * draw.standard_normal(TIME.size)
    shown = x + 1e-7 * draw.standard_normal(TIME.size)
    return Record(name="bench", time=TIME, displacement=shown, force=force)


@pytest.mark.parametrize("mass", [50.0, 4.0])
def test_it_is_named_beside_the_shaft(mass: float, effects_seed: int, tmp_path: Path) -> None:
    found = diagnose_bench([record(effects_seed, mass)])
    effects = {each.effect: each for each in found.findings}
    assert effects.keys() == {"series_elasticity", "grip_mass", "coulomb_friction"}
    told = effects["grip_mass"].parameters["grip_mass"]
    assert told.value == pytest.approx(mass, abs=max(4 * told.stderr, 0.01 * mass))
    assert found.parameters["inertance"].value == pytest.approx(INERTANCE, rel=0.02)
    stiffness = effects["series_elasticity"].parameters["series_stiffness"]
    assert stiffness.value == pytest.approx(STIFFNESS, rel=0.02)
    assert "weigh the grip" in effects["grip_mass"].evidence
    told_by = [error for error in found.engines.values() if error is not None]
    assert told_by == pytest.approx([found.extended.rmse] * len(told_by), rel=0.03)

    write_outputs(found, tmp_path)
    assert "a second inerter between the same terminals" in (tmp_path / "device.toml").read_text()
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "model.xml"))
    assert model.nu == 3
    data = mujoco.MjData(model)
    data.ctrl[0] = 2.0
    mujoco.mj_forward(model, data)
    # a shaft that is not bent yet: what acts at once is the mass before it
    pushed = data.sensor("before_the_shaft").data[0]
    assert abs(pushed) == pytest.approx(2.0 * told.value, rel=1e-6)


def test_none_is_named_where_there_is_none(effects_seed: int) -> None:
    found = diagnose_bench([record(effects_seed, 0.0)])
    assert {each.effect for each in found.findings} == {"series_elasticity", "coulomb_friction"}


def test_without_what_gives_it_is_inertance(effects_seed: int) -> None:
    run = thin(prepare([record(effects_seed, 5.0)]).motions[0])
    sizes = scales([run])
    rigid = Model("none", {"inertance": 40.0, "transition_velocity": 1e-3}, ("inertance",))
    assert "grip_mass" not in {each.effect for each in candidates(rigid, sizes)}
    on_shaft = rigid.adding(series_frequency=12.0, series_loss=0.1, grip_mass=5.0)
    rigid_again = on_shaft.without(("series_frequency", "series_loss"))
    assert rigid_again.free == ("inertance",)
    assert "grip_mass" not in rigid_again.values
    assert is_hidden({"grip_mass"}, rigid, sizes, 20)
    assert not is_hidden({"grip_mass"}, on_shaft, sizes, 20)
    # and the device alone has no second one
    assert "before_the_shaft" not in rig.device_mjcf(on_shaft.device())
