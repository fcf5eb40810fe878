"""The rig's batch: against the reference, parameter sets kept apart, published figures."""

from dataclasses import replace

import numpy as np
import pytest
from inerter.model_parameters import FLUID_INERTER
from inerter.studies.fluid_rig.rig import Configuration, Rig
from inerter.studies.fluid_rig.signals import Signals
from inerter.studies.fluid_rig.spectra import spectra
from inerter.studies.fluid_rig.statements import DRY_AT_ONE_HERTZ, anti_resonance
from inerter.studies.fluid_rig.sweeps import COMPLETE, DRY, Sweep
from inerter.studies.fluid_rig.truth import experiment, published_air_damping, true_signals
from inerter.studies.fluid_rig.unknowns import COMPLETE_LIVE, DRY_LIVE


def one(rig: Rig, sweep: Sweep, **values: float) -> Signals:
    (found,) = rig.simulate([(sweep, values)])
    assert found is not None
    return found


@pytest.mark.parametrize(("configuration", "sweep"), [("dry", DRY[3]), ("complete", COMPLETE[1])])
def test_rig_agrees_with_the_reference(configuration: Configuration, sweep: Sweep) -> None:
    """Other parameters than the model's, so that they must have come through the batch."""
    other = replace(
        FLUID_INERTER,
        static_force=40.0,
        viscous=400.0,
        series_stiffness=1e5,
        series_hardening=-60.0,
    )
    short = sweep.shortened(4.0)
    true = true_signals(experiment(configuration, short, 200.0, other))
    values = {"static_force": 40.0, "viscous": 400.0}
    if configuration == "complete":
        values |= {"series_stiffness": 1e5, "series_hardening": -60.0, "flywheel_viscous": 700.0}
    live = DRY_LIVE if configuration == "dry" else COMPLETE_LIVE
    found = one(Rig(configuration, live, step=2.5e-4), short, **values)
    np.testing.assert_allclose(found.displacement, true.displacement, atol=2e-7)
    np.testing.assert_allclose(found.force, true.force, atol=0.02)
    assert found.farthest == pytest.approx(true.farthest, rel=1e-3)


def test_load_cell_is_what_moves_piston_and_device() -> None:
    """Without friction, water or motion of its own nothing but m_p x'' is left."""
    rig = Rig("dry", DRY_LIVE)
    found = one(rig, DRY[0].shortened(4.0), coulomb_force=1e-9, static_force=1e-9, viscous=0.0)
    x, h = found.displacement, 1 / found.rate
    # x'' by the five-point formula
    a = (-x[:-4] + 16 * x[1:-3] - 30 * x[2:-2] + 16 * x[3:-1] - x[4:]) / (12 * h * h)
    np.testing.assert_allclose(found.force[2:-2][100:], a[100:], atol=0.02 * np.abs(a).max())


def test_sets_of_a_batch_do_not_mix() -> None:
    rig = Rig("dry", DRY_LIVE)
    sweep = DRY[1].shortened(2.0)
    sets = [{"viscous": 300.0}, {"viscous": 700.0}, {"coulomb_force": 20.0}]
    together = rig.simulate([(sweep, values) for values in sets])
    for values, found in zip(sets, together, strict=True):
        alone = one(rig, sweep, **values)
        assert found is not None
        np.testing.assert_array_equal(found.displacement, alone.displacement)
        np.testing.assert_array_equal(found.force, alone.force)
    again = rig.simulate([(sweep, sets[0]), (sweep, sets[1]), (sweep, sets[0])])
    assert again[0] is again[2]


def test_dry_receptance_at_one_hertz() -> None:
    rig = Rig("dry", ())
    for sweep, printed in zip(DRY, DRY_AT_ONE_HERTZ, strict=True):
        found = one(rig, sweep.shortened(8.0))
        shown = spectra(found.displacement, found.force, found.rate)
        at = int(np.argmin(np.abs(shown.frequency - 1.0)))
        assert 1e3 * shown.magnitude[at] == pytest.approx(printed, abs=5e-4)


def test_anti_resonance_rises_with_the_damping_of_the_air() -> None:
    rig = Rig("complete", ("flywheel_viscous",))
    sweep = COMPLETE[0].shortened(32.0)
    found = [
        anti_resonance(one(rig, sweep, flywheel_viscous=c), sweep) for c in (300.0, 500.0, 700.0)
    ]
    assert 4.4 < found[0] <= found[1] <= found[2] < 4.9
    assert found[0] < found[2]


def test_a_run_that_does_not_reach_its_end_is_none() -> None:
    """A pale friction that is far too steep for the step makes the state grow without bound."""
    rig = Rig("complete", COMPLETE_LIVE)
    sweep = COMPLETE[0].shortened(2.0)
    assert rig.simulate([(sweep, {"series_damping": 1e8})]) == [None]


def test_what_cannot_be_is_said() -> None:
    with pytest.raises(ValueError, match=r"step: 0\.003 s does not divide"):
        Rig("dry", (), step=3e-3)
    with pytest.raises(ValueError, match="'visc' is no parameter"):
        Rig("dry", ("visc",))
    with pytest.raises(ValueError, match=r"preload: 0\.2 V; the paper has"):
        published_air_damping(0.2)
    with pytest.raises(ValueError, match=r"the anti-resonance needs 28 s"):
        anti_resonance(Signals(200.0, np.zeros(2000), np.zeros(2000)), DRY[0].shortened(10.0))
