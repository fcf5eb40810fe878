"""Effects of one machine that are tried together."""

from __future__ import annotations

from dataclasses import replace
from unittest.mock import Mock, patch

import numpy as np
import pytest
from inerter.catalogue.scales import Scales
from inerter.diagnose import diagnose_bench
from inerter.diagnose.bent_damping import bends_each_way, struts
from inerter.diagnose.candidates import candidates
from inerter.diagnose.together import mounts, whole_strut
from inerter.identify.model import Model
from inerter.records import Record
from scipy.signal import lfilter

SIZES = Scales(force=300.0, displacement=0.02, velocity=0.2, acceleration=3.0)
BASELINE = Model("none", {"inertance": 5.0, "transition_velocity": 1e-3}, ("inertance",))
BENT = {"viscous": 3000.0, "damping_knee": 0.1, "damping_beyond": 0.0}


def test_a_damper_that_bends_gets_all_that_one_has() -> None:
    found = bends_each_way(BASELINE.adding(None, **BENT, quadratic_damping=90.0), SIZES)
    # from what there is and anew, without and with memory
    assert [each.friction for each in found] == ["coulomb", "dahl"] * 2
    whole = found[0]
    assert set(whole.free) - {"inertance", *BENT} == {
        "damping_asymmetry", "damping_sharpness", "damping_knee_back", "damping_beyond_back",
        "coulomb_force", "transition_velocity",
    }  # fmt: skip
    assert whole.values["damping_knee_back"] == 0.1
    # a slope of nothing beyond the knee would stay where it is
    assert whole.values["damping_beyond"] > 0.0
    assert [each.friction for each in bends_each_way(whole, SIZES)] == ["dahl"] * 2


def test_uneven_friction_of_a_damper_may_be_a_constant_force() -> None:
    uneven = BASELINE.adding("coulomb", coulomb_force=20.0, friction_asymmetry=-0.9, **BENT)
    kept, offset, dahl, *_ = bends_each_way(uneven, SIZES)
    assert (kept.friction, offset.friction, dahl.friction) == ("coulomb", "coulomb", "dahl")
    assert kept.values["friction_asymmetry"] == -0.9
    assert "friction_asymmetry" not in offset.values
    assert offset.values["force_offset"] == pytest.approx(-18.0)


def test_a_power_of_the_speed_becomes_lines_first() -> None:
    power = {"viscous": 9e3, "damping_power_knee": 0.01, "damping_exponent": 0.4}
    model = BASELINE.adding(None, **power).holding(damping_beyond=0.0)
    found = bends_each_way(model, SIZES)
    assert found
    assert all("damping_power_knee" not in each.values for each in found)
    assert all("damping_knee_back" in each.free for each in found)


def test_branches_become_a_mount() -> None:
    one = {"branch_stiffness_1": 2e5, "branch_time_1": 3.0}
    two = {**one, "branch_stiffness_2": 4e4, "branch_time_2": 0.05}
    assert mounts(BASELINE.adding(None, **one), SIZES) == []
    (mount,) = mounts(BASELINE.adding(None, **two), SIZES)
    assert {"stiffness", "force_offset", "branch_stiffness_3", "branch_time_3"} <= set(mount.free)
    assert 1e5 < mount.values["stiffness"] < 2e5
    assert mounts(mount, SIZES) == []


def test_a_spring_is_tried_with_a_damper_where_there_is_neither() -> None:
    def tried(model: Model, sizes: Scales = SIZES) -> list[tuple[str, ...]]:
        every = [each for each in candidates(model, sizes) if each.effect == "parallel_stiffness"]
        return [each.starts[0].free for each in every]

    alone, both = ("inertance", "stiffness"), ("inertance", "stiffness", "viscous")
    assert tried(BASELINE) == [alone, both]
    assert tried(BASELINE.adding(None, viscous=1.0)) == [("inertance", "viscous", "stiffness")]
    # along one sine it is an inertance of another size
    assert tried(BASELINE, replace(SIZES, one_tone=True)) == []


def test_a_strut_bends_and_rubs_behind_its_top_mount() -> None:
    damped = BASELINE.adding(None, viscous=900.0)
    (strut,) = struts(damped, SIZES)
    assert strut.friction == "dahl"
    assert {"damping_knee", "damping_beyond", "damper_stiffness", "presliding"} <= set(strut.free)
    assert struts(BASELINE, SIZES) == []
    assert struts(strut, SIZES) == []
    assert struts(damped.adding("lugre", coulomb_force=9.0, presliding=1e-4), SIZES) == []
    kept = {"coulomb_force": 9.0, "presliding": 1e-4}
    (strut,) = struts(damped.adding("dahl", **kept), SIZES)
    assert {name: strut.values[name] for name in kept} == kept


def test_what_no_device_can_be_is_not_tried() -> None:
    """Damping that falls with the speed has no spring before it."""
    falls = {"viscous": 900.0, "damping_power_knee": 0.1, "damping_exponent": -0.1}
    model = BASELINE.adding(None, **falls).holding(damping_beyond=0.0)
    (strut,) = struts(model, SIZES)
    assert not strut.is_possible
    fit = Mock(model=model)
    fit.rmse.return_value = 50.0
    search = Mock()
    search.problem.scales = SIZES
    with patch("inerter.diagnose.together.is_near_noise", return_value=False):
        assert whole_strut(search, Mock(model=model, fit=fit)) is None
    search.trials.fit.assert_not_called()


@pytest.mark.long
def test_a_strut_behind_its_top_mount_is_found_beside_its_spring() -> None:
    """Its own simulation, steps that are implicit in the speed of the damper."""
    draw = np.random.default_rng(2)
    step = 1 / (500 * 10)
    time = np.arange(0, 8, step)
    frequency = np.sort(draw.uniform(0.4, 8, 20))[:, None]
    size = frequency**-0.7
    size *= 0.01 / np.sqrt((size**2).sum() / 2)
    speed = 2 * np.pi * frequency
    angle = speed * time + draw.uniform(0, 2 * np.pi, frequency.shape)
    x, a = (size * np.sin(angle)).sum(0), -(size * speed**2 * np.sin(angle)).sum(0)
    mount, rubs = 2e5, 3e4
    speeds = np.linspace(-3, 3, 60001)
    force_at = 2200 * speeds / np.sqrt(1 + (speeds / 0.15) ** 2) + 500 * speeds
    force, behind = np.empty_like(x), x[0]
    for i, place in enumerate(x):
        # D(w) = k (x - y - h w)
        w = np.interp(mount * (place - behind), force_at + mount * step * speeds, speeds)
        behind += step * w
        force[i] = mount * (place - behind)
    bristle = 0.0
    for i, moved in enumerate(np.diff(x, prepend=x[0])):
        bristle += rubs * moved * (1 - np.sign(moved) * bristle / 20.0)
        force[i] += bristle + 14e3 * x[i] + 2.0 * a[i]
    x, force = x[::10], force[::10]
    record = Record(
        name="strut", time=time[::10], displacement=x + 2e-6 * draw.standard_normal(x.size),
        force=force + 1.0 * draw.standard_normal(x.size),
    )  # fmt: skip
    found = diagnose_bench([record])
    assert {each.effect for each in found.findings} >= {
        "parallel_stiffness", "hysteretic_friction", "digressive_damping", "damper_elasticity",
    }  # fmt: skip
    assert found.baseline.rmse > 200.0
    assert found.extended.rmse < 2.0
    values = {name: each.value for name, each in found.parameters.items()}
    assert values["damper_stiffness"] == pytest.approx(mount, rel=0.1)
    assert values["stiffness"] == pytest.approx(14e3, rel=0.02)
    assert values["coulomb_force"] == pytest.approx(20.0, rel=0.2)


@pytest.mark.long
def test_a_mount_of_rubber_is_a_spring_that_relaxes_over_decades(effects_seed: int) -> None:
    """Seven Maxwell elements from 3 ms to 30 s beside 200 kN/m; its own simulation, exact steps."""
    draw = np.random.default_rng(effects_seed)
    time = np.arange(0, 10, 1 / 500)
    frequency = np.sort(draw.uniform(0.3, 20, 30))[:, None]
    size = draw.uniform(0.6, 1.4, frequency.shape) * frequency**-0.7
    size *= 1.2e-3 / np.sqrt((size**2).sum() / 2)
    angle = 2 * np.pi * frequency * time + draw.uniform(0, 2 * np.pi, frequency.shape)
    x = (size * np.sin(angle)).sum(0)
    a = -(size * (2 * np.pi * frequency) ** 2 * np.sin(angle)).sum(0)
    force = 2e5 * x + 0.8 * a
    for relaxes in np.logspace(-2.5, 1.5, 7):
        # of a straight piece of motion the element keeps the mean of its decay
        kept = np.exp(-0.002 / relaxes)
        slope = relaxes / 0.002 * (1 - kept)
        stretch = lfilter([slope], [1, -kept], np.diff(x, prepend=x[0]))
        force += 3e4 * (0.1 / relaxes) ** 0.22 * stretch
    record = Record(
        name="mount", time=time, displacement=x + 5e-7 * draw.standard_normal(time.size),
        force=force + 0.8 * draw.standard_normal(time.size),
    )  # fmt: skip
    found = diagnose_bench([record])
    named = {each.effect for each in found.findings}
    assert {"viscoelasticity", "parallel_stiffness"} <= named
    assert found.extended.rmse < 2.0
    # which part of what hardly relaxes is the spring's is not told well, all of it is
    values = {name: each.value for name, each in found.parameters.items()}
    lasting = values["stiffness"]
    for i in (1, 2, 3):
        branch = values.get(f"branch_stiffness_{i}", 0.0)
        lasting += branch * (branch * 0.5 < values.get(f"branch_damping_{i}", 0.0))
    assert lasting == pytest.approx(2.37e5, rel=0.08)
    assert values["stiffness"] > 1.5e5
