"""The study's settings, statements, files and command."""

import json
from pathlib import Path

import numpy as np
import pytest
from inerter.commands import app
from inerter.rig import quiet
from inerter.studies.fluid_rig.identify import Held, IdentifiedRig
from inerter.studies.fluid_rig.output import write_study
from inerter.studies.fluid_rig.rig import Configuration, Rig
from inerter.studies.fluid_rig.settings import Settings, StudyError
from inerter.studies.fluid_rig.signals import Noise, Signals
from inerter.studies.fluid_rig.statements import statements
from inerter.studies.fluid_rig.study import RigRun, Study, measured_tests, outside
from inerter.studies.fluid_rig.summary import recovery, study_json
from inerter.studies.fluid_rig.sweeps import COMPLETE, DRY, LEVELS, RATE_OF_RISE, Sweep
from inerter.studies.fluid_rig.truth import published_air_damping
from inerter.studies.fluid_rig.unknowns import published
from typer.testing import CliRunner

DURATION = 30.0


def fit(
    configuration: Configuration, sweeps: tuple[Sweep, ...], signals, off: float
) -> IdentifiedRig:
    """A fit that found every parameter off by a share, with standard errors of a per cent."""
    names = tuple(published(configuration, sweeps))
    values = np.array(list(published(configuration, sweeps).values()))
    covariance = np.diag((0.01 * values) ** 2)
    covariance[0, 1] = covariance[1, 0] = 0.99 * 0.01**2 * values[0] * values[1]
    errors = 0.01 * values
    return IdentifiedRig(
        configuration=configuration, objective="spectra", names=names, values=values * (1 + off),
        covariance=covariance, held=Held(), cost_ratio=1.0, together=errors,
        alone={"receptance": 3 * errors, "density": 2 * errors}, noise=Noise(), step_shift=0.0,
        signals=signals, start={}, searches=1, simulations=1, seconds=1.0,
    )  # fmt: skip


@pytest.fixture(scope="module")
def made() -> Study:
    """A study whose truth and fits are runs of the rig: what is tested is not what it finds."""
    settings = Settings(objectives=("spectra",), seeds=(3, 4), duration=DURATION)
    dry, complete, levels = (
        tuple(sweep.shortened(DURATION) for sweep in group) for group in (DRY, COMPLETE, LEVELS)
    )
    wet = (*complete, levels[1])
    truth: dict[tuple[Configuration, Sweep], Signals] = {}
    for sweep, found in zip(dry, Rig("dry", ()).simulate([(s, {}) for s in dry]), strict=True):
        assert found is not None
        truth["dry", sweep] = found
    damping = [{"flywheel_viscous": published_air_damping(s.preload or 0.0)} for s in wet]
    rig = Rig("complete", ("flywheel_viscous",))
    with quiet():
        runs_of_wet = rig.simulate(list(zip(wet, damping, strict=True)))
    for sweep, found in zip(wet, runs_of_wet, strict=True):
        assert found is not None
        truth["complete", sweep] = found
    dry_signals = tuple(truth["dry", s] for s in dry)
    wet_signals = tuple(truth["complete", s] for s in complete)
    runs = tuple(
        RigRun(seed, "spectra", fit("dry", dry, dry_signals, off),
            fit("complete", complete, wet_signals, off))
        for seed, off in ((3, 0.01), (4, -0.03))
    )  # fmt: skip
    level = truth["complete", levels[1]]
    return Study(
        settings=settings, truth=truth, measured=measured_tests(settings, 3, truth), runs=runs,
        level=level, seconds=(1.0, 2.0),
        statements=statements(
            truth, dry, complete, levels, runs[0].dry, runs[0].complete, level
        ),
    )  # fmt: skip


def test_statements_of_the_paper(made: Study) -> None:
    """All but one: with the printed parameters the level matters no less than dry."""
    assert [each.text[:40] for each in made.statements if not each.holds] == [
        "complete: a higher level changes the rec"
    ]
    level = next(each for each in made.statements if not each.holds)
    change = level.figures["median_change_of_ln_receptance"]
    assert change["complete"] > change["dry"] > 0.1
    near = level.figures["near_the_anti_resonance"]
    assert near["complete"] < 0.5 * near["dry"]
    assert level.figures["median_ratio_of_density"]["complete"] > 1.2
    shift = next(each for each in made.statements if "anti-resonance" in each.text)
    assert len(shift.figures["hertz"]) == 2


def test_recovery_counts_errors_and_intervals(made: Study) -> None:
    found = recovery(made)["spectra"]
    assert set(found) == {*published("dry", DRY), *published("complete", COMPLETE)}
    for each in found.values():
        assert each["largest_error"] == pytest.approx(0.03, rel=1e-9)
        assert each["rms_error"] == pytest.approx(np.sqrt((0.01**2 + 0.03**2) / 2), rel=1e-9)
        # 1 % is within 1.96 standard errors, 3 % is not
        assert each["intervals_right"] == 0.5


def test_pairs_that_make_up_for_each_other_are_named(made: Study) -> None:
    names = made.shown.dry.names
    assert made.shown.dry.hardly_apart == ((names[1], names[0], pytest.approx(0.99)),)
    assert made.shown.dry.undetermined == ()


def test_files(made: Study, tmp_path: Path) -> None:
    names = write_study(made, tmp_path)
    assert set(names) == {
        "fluid_rig.json", "fluid_rig.html", "dry.png", "complete.png", "levels.png"
    }  # fmt: skip
    found = json.loads((tmp_path / "fluid_rig.json").read_text())
    assert found["recovery"]["spectra"]["viscous"]["largest_error"] == pytest.approx(0.03)
    assert len(found["parameters"]) == 2 * 9
    for name in ("dry", "complete", "levels"):
        assert (tmp_path / f"{name}.png").read_bytes().startswith(b"\x89PNG")
    page = (tmp_path / "fluid_rig.html").read_text()
    assert "<script src" not in page
    assert "flywheel" not in page.split("<script>")[0]


def test_the_higher_level_leaves_the_law_of_the_air_and_that_is_said(made: Study) -> None:
    name = f"complete, {LEVELS[1].name}"
    assert list(outside(made.truth)) == [name]
    assert outside(made.truth)[name] == pytest.approx(0.0071, abs=1e-4)
    assert study_json(made)["outside_the_law_of_the_air"] == outside(made.truth)


def test_noise_of_a_seed_is_the_same_again(made: Study) -> None:
    again = measured_tests(made.settings, 3, made.truth)
    other = measured_tests(made.settings, 4, made.truth)
    one = made.measured["dry"].signals[0].displacement
    np.testing.assert_array_equal(again["dry"].signals[0].displacement, one)
    assert np.std(other["dry"].signals[0].displacement - one) == pytest.approx(
        np.sqrt(2) * made.settings.noise.displacement, rel=0.05
    )


def test_sweeps_are_the_published_ones() -> None:
    time = np.arange(0, 60, 1e-3)
    for sweep in DRY:
        # frequency from the zero crossings of the last second, half a second before the end
        voltage = sweep.voltage(time)
        assert sweep.highest == pytest.approx(12.0)
        late = voltage[time >= 59]
        crossings = np.count_nonzero(np.diff(np.sign(late)) != 0)
        assert crossings / 2 == pytest.approx(12.0 - 0.5 * RATE_OF_RISE, abs=0.5)
        assert np.abs(late).max() == pytest.approx(sweep.last, abs=0.005)
        assert np.abs(voltage[time < 2]).max() == pytest.approx(sweep.first, abs=0.008)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"objectives": ("spectrum",)}, "'spectrum' is none of spectra, time"),
        ({"duration": 10.0}, "duration: 10 s; give 30 to 60 s"),
        ({"noise": Noise(displacement=0.0)}, "noise of displacement: 0; give an rms above 0"),
        ({"factor": 20.0}, "factor: 20"),
        ({"seeds": ()}, "at least one of each"),
        ({"starts": 0}, "starts: 0"),
    ],
)
def test_settings_that_cannot_be(wrong: dict, message: str) -> None:
    with pytest.raises(StudyError, match=message):
        Settings(**wrong)


def test_the_command_refuses_in_one_line(tmp_path: Path) -> None:
    done = CliRunner().invoke(
        app, ["study", "fluid-rig", "--duration", "5", "--out", str(tmp_path / "new")]
    )
    assert done.exit_code == 2
    assert "duration: 5 s; give 30 to 60 s" in done.stderr
    assert not (tmp_path / "new").exists()
