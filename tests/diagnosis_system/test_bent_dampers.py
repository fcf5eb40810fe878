"""A damper that bends with the speed, where the model's is a straight one of a tendon."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest
from hidden_vehicles import Car, records
from inerter.diagnose.vehicle.build import UserModel, model_of_text, read_model
from inerter.diagnose.vehicle.candidate import Scale, VehicleCandidate
from inerter.diagnose.vehicle.diagnosis import diagnose_system
from inerter.diagnose.vehicle.drive import RecordedDrive
from inerter.diagnose.vehicle.effects import Effects
from inerter.diagnose.vehicle.mapping import map_columns
from inerter.diagnose.vehicle.model import Added, VehicleModel
from inerter.diagnose.vehicle.outcome import SystemDiagnosis
from inerter.diagnose.vehicle.search import VehicleScored
from inerter.diagnose.vehicle.split import split_drives
from inerter.diagnose.vehicle.values import parameter_values
from inerter.records import VehicleRecord

CAR = Car()
SCALE = Scale(
    force=500.0, x=5e-3, v=0.1, a=5.0, largest=0.02, smallest=-0.02, step=2e-3, explicit=True
)
MODEL = f"""<mujoco><option timestep="0.002" integrator="RK4" gravity="0 0 0"/>
<extension><plugin plugin="inerter.device"/></extension><worldbody>
<body name="wheel"><joint name="wheel" type="slide" axis="0 0 1"/>
  <geom size=".1" mass="{CAR.unsprung_mass}" contype="0" conaffinity="0"/>
  <site name="lower"/></body>
<body name="frame" pos="0 0 .5"><joint name="frame" type="slide" axis="0 0 1"/>
  <geom size=".1" mass="{CAR.sprung_mass}" contype="0" conaffinity="0"/><site name="upper"/></body>
</worldbody><tendon>
<spatial name="spring" stiffness="{CAR.stiffness}" damping="DAMPING" springlength=".5">
  <site site="lower"/><site site="upper"/></spatial>
<spatial name="line"><site site="lower"/><site site="upper"/></spatial></tendon><actuator>
<position name="road" joint="wheel" kp="{CAR.tyre_stiffness}"/>
<plugin name="strut" plugin="inerter.device" tendon="line">
  <config key="inertance" value="{CAR.inertance}"/><config key="rest_length" value=".5"/>OWN
</plugin>
</actuator><sensor><framelinacc name="body_acceleration" objtype="body" objname="frame"/>
<framelinacc name="wheel_acceleration" objtype="body" objname="wheel"/>
<tendonpos name="suspension_travel" tendon="line"/></sensor></mujoco>"""


def model(folder: Path, damping: float, own: str = "") -> UserModel:
    path = folder / "model.xml"
    path.write_text(MODEL.replace("DAMPING", repr(damping)).replace("OWN", own))
    return read_model(path)


def drives(car: Car, amplitude: float) -> list[VehicleRecord]:
    """Without the force of the tyre, which few have."""
    return [
        VehicleRecord(
            name=run.name, time=run.time, road=run.road,
            body_acceleration=run.body_acceleration, wheel_acceleration=run.wheel_acceleration,
            suspension_travel=run.suspension_travel,
        )
        for run in records(car, runs=2, amplitude=amplitude)
    ]  # fmt: skip


CORNER = Car(damping=3000.0, knee=0.12, beyond=0.4, coulomb_force=60.0)


def bend_and_friction(user: UserModel, runs: list[VehicleRecord], within: float) -> SystemDiagnosis:
    """The diagnosis of runs of `CORNER`, which has to name both, to a share of their values."""
    columns = list(runs[0].channels())
    found = diagnose_system(runs, user, map_columns(user.model, columns, {}, {}))
    assert {each.effect for each in found.findings} == {"digressive_damping", "coulomb_friction"}
    true = {"viscous": 3000.0, "damping_knee": 0.12, "damping_beyond": 0.4, "coulomb_force": 60.0}
    for name, value in true.items():
        told = found.parameters[name]
        assert told.value == pytest.approx(value, abs=max(4 * told.stderr, within * value)), name
    assert found.extended.rmse < 1.1 * found.noise_floor
    return found


def test_a_corner_in_the_damping_and_dry_friction_beside_a_straight_damper(tmp_path: Path) -> None:
    found = bend_and_friction(model(tmp_path, 3000.0), drives(CORNER, amplitude=0.3), within=0.02)
    # what is written is the damper that was found, in the place of the straight one
    assert found.engines["mujoco"] == pytest.approx(found.extended.rmse, rel=0.01)
    written = model_of_text(found.model_xml or "", tmp_path / "written.xml")
    assert written.model.tendon_damping[0] == 0.0


@pytest.mark.parametrize("damper", ["the device's", "a tendon's"])
def test_a_damper_that_bends_may_differ_between_rebound_and_bump(
    tmp_path: Path, damper: str
) -> None:
    own = '<config key="viscous" value="2000"/>' if damper == "the device's" else ""
    user = model(tmp_path, 0.0 if own else 2000.0, own)
    user.with_inputs(["road"])
    (part,) = user.parts.suspensions
    assert part.alike
    values = {
        "strut.damping_knee": 0.1, "strut.damping_beyond": 0.3,
        "strut.rebound_damping": 2400.0, "strut.bump_damping": 1600.0,
    }  # fmt: skip
    displaced = () if own else ("tendon:spring.damping",)
    bent = Added("digressive_damping", "strut", ("strut.damping_knee",), None, displaced)
    change = VehicleModel().adding(bent, values)
    device = user.device_of("strut", change)
    for velocity, slope in ((0.02, 2400.0), (-0.02, 1600.0)):
        force = device.evaluate(0.0, velocity, 0.0, 0.0)["total"].item()
        # a little below: the knee is rounded
        assert force == pytest.approx(slope * velocity, rel=0.03)
    built = user.compile(change)
    assert built.nactuator == user.model.nactuator
    assert np.all(built.tendon_damping == 0.0)


def test_without_the_bend_the_straight_damper_is_there_again(tmp_path: Path) -> None:
    user = model(tmp_path, 2000.0)
    user.with_inputs(["road"])
    effects, stated = Effects(user, {"strut": SCALE}), VehicleModel()

    def of(change: VehicleModel) -> dict[tuple[str, str], VehicleCandidate]:
        return {(c.added.effect, c.added.element): c for c in effects.candidates(change)}

    bend = of(stated)["digressive_damping", "strut"]
    bent = bend.model(stated, bend.starts[0])
    assert user.compile(bent).tendon_damping[0] == 0.0
    assert user.device_of("strut", bent).viscous == pytest.approx(2200.0)
    assert bent.without(0) == stated
    # a straight one beside it would say the same twice; one that was found before is in the bend
    straight = "viscous_friction", "tendon:spring"
    assert straight not in of(bent)
    found = of(stated)[straight]
    both = found.model(stated, {"tendon:spring.damping": 2500.0})
    again = of(both)["digressive_damping", "strut"]
    after = again.model(both, again.starts[0])
    assert [added.effect for added in after.effects] == ["digressive_damping"]
    assert "tendon:spring.damping" not in after.free
    assert user.device_of("strut", after).viscous == pytest.approx(2750.0)


def test_a_bend_that_is_drawn_more_sharply_stays_where_it_was() -> None:
    """What was found after it stands on it: each effect is judged on top of those before it."""
    bend = Added("digressive_damping", "strut", ("strut.damping_knee",))
    friction = Added("coulomb_friction", "strut", ("strut.coulomb_force",))
    tyre = Added("tyre_stiffness_error", "tyre:road", ("tyre:road.tyre_stiffness",))
    sharp = Added("digressive_damping", "strut", ("strut.damping_knee", "strut.damping_sharpness"))
    found = VehicleModel()
    for added in (tyre, bend, friction, sharp):
        found = found.adding(added, dict.fromkeys(added.coordinates, 1.0))
    assert found.effects == (tyre, sharp, friction)
    assert set(found.free) == {*tyre.coordinates, *friction.coordinates, *sharp.coordinates}
    # of another device it is another one
    other = Added("digressive_damping", "rear", ("rear.damping_knee",))
    assert found.adding(other, {"rear.damping_knee": 1.0}).effects[-1] == other


@pytest.mark.long
def test_a_small_and_a_large_run_tell_friction_and_a_corner(tmp_path: Path) -> None:
    """In the small one the damper hardly bends, in the large one friction hardly shows."""
    small, large = drives(CORNER, amplitude=0.1)[0], drives(CORNER, amplitude=0.4)[1]
    runs = [replace(small, name="small"), replace(large, name="large")]
    found = bend_and_friction(model(tmp_path, 2600.0), runs, within=0.03)
    # both were learnt from
    assert [record.role for record in found.records] == ["fit", "fit"]


def test_of_two_runs_of_different_size_blocks_of_both_are_held_out() -> None:
    def run(name: str, size: float) -> RecordedDrive:
        measured = size * np.random.default_rng(1).normal(size=(1000, 2))
        return cast(
            RecordedDrive, SimpleNamespace(name=name, time=np.arange(1000.0), measured=measured)
        )

    fit, held, text = split_drives([run("a", 1.0), run("b", 1.2)], ())
    assert sorted(mask.mean() for mask in held) == [0.0, 1.0]
    fit, held, text = split_drives([run("a", 1.0), run("b", 2.0)], ())
    assert text == "held out: blocks 4, 7, 9 of 10 of every run"
    for own, left in zip(fit, held, strict=True):
        assert left.mean() == pytest.approx(0.3)
        assert (own ^ left).all()
    # what a user names is held out as a whole
    assert split_drives([run("a", 1.0), run("b", 2.0)], ["b"])[2] == "held out: b"


def test_a_value_at_the_end_of_its_range_has_an_error(tmp_path: Path) -> None:
    """The sharpest corner there is: derivatives are taken inward."""
    user = model(tmp_path, 2000.0)
    user.with_inputs(["road"])
    effects, stated = Effects(user, {"strut": SCALE}), VehicleModel()

    def bend(change: VehicleModel) -> VehicleCandidate:
        each = [c for c in effects.candidates(change) if c.added.effect == "digressive_damping"]
        return each[0]

    first = bend(stated)
    bent = first.model(stated, first.starts[0])
    again = bend(bent)
    sharpest = again.model(bent, {**again.starts[-1], "strut.damping_sharpness": 64.0})
    assert "strut.damping_sharpness" in sharpest.free
    random = np.random.default_rng(2)
    fit = SimpleNamespace(
        residual=random.normal(size=300), jacobian=random.normal(size=(300, len(sharpest.free))),
        units=lambda: np.ones(len(sharpest.free)), sizes={**first.sizes, **again.sizes},
    )  # fmt: skip
    scored = cast(VehicleScored, SimpleNamespace(model=sharpest, fit=fit))
    told = parameter_values(user, scored)[0]["damping_sharpness"]
    assert told.value == 64.0
    assert 0.0 < told.stderr < 1.0


def test_only_a_damper_that_moves_with_the_device_is_displaced(tmp_path: Path) -> None:
    text = MODEL.replace("DAMPING", "2000.0").replace("OWN", "")
    beside = text.replace(
        '<site name="lower"/></body>',
        '<site name="lower"/><site name="aside" pos=".3 0 0"/></body>',
    ).replace('springlength=".5">\n  <site site="lower"/>', '>\n  <site site="aside"/>')
    assert beside != text
    path = tmp_path / "model.xml"
    path.write_text(beside)
    user = read_model(path)
    user.with_inputs(["road"])
    (part,) = user.parts.suspensions
    assert part.damper is not None
    assert not part.alike
