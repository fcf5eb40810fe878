"""A force channel on a clock of its own."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from inerter.diagnose import diagnose_bench
from inerter.diagnose.clock_rate import on_one_clock
from inerter.records import Record
from sines import moved

TIME = np.arange(0, 12, 1 / 250)


def bench(
    seed: int,
    rate: float,
    frequencies: Sequence[float] = (0.7, 1.9, 4.3),
    runs: int = 2,
    coulomb: float = 15.0,
) -> list[Record]:
    """60 kg, 90 N s/m and Coulomb friction [N]; the force's clock loses the rate."""
    draw, found = np.random.default_rng([seed, 23]), []
    for i in range(runs):
        phases = np.random.default_rng([seed, 24, i])
        # what the force's logger writes at t is the force at (1 + rate) t: its clock is slow
        _, v, a = moved(phases, TIME * (1 + rate), frequencies, 4e-3)
        force = 60 * a + 90 * v + coulomb * np.tanh(v / 1e-3)
        phases = np.random.default_rng([seed, 24, i])
        x, _, _ = moved(phases, TIME, frequencies, 4e-3)
        shown = x + 1e-6 * draw.standard_normal(TIME.size)
        force += 0.5 * draw.standard_normal(TIME.size)
        found.append(Record(name=f"run {i}", time=TIME, displacement=shown, force=force))
    return found


@pytest.mark.parametrize("rate", [3e-3, -2e-3])
def test_its_rate_is_told_and_put_right(rate: float, effects_seed: int) -> None:
    records = bench(effects_seed, rate)
    right, found = on_one_clock(records)
    assert found is not None
    assert found.stderr < 0.01 * abs(rate)
    assert found.value == pytest.approx(rate, abs=5 * found.stderr)
    assert f" % {'slow' if rate > 0 else 'fast'} against" in found.in_words()
    true = bench(effects_seed, 0.0)
    for before, after, each in zip(records, right, true, strict=True):
        inner = slice(500, after.samples - 500)
        missed, left = (float(np.std((r.force - each.force[: r.samples])[inner])) for r in (
            before, after,
        ))  # fmt: skip
        # a jump between two samples is not where it was
        assert left < 0.1 * missed


@pytest.mark.parametrize("frequencies", [(0.7, 1.9, 4.3), (1.9,)])
def test_one_clock_stays(frequencies: tuple[float, ...], effects_seed: int) -> None:
    records = bench(effects_seed, 0.0, frequencies)
    same, found = on_one_clock(records)
    assert found is None
    assert same is records


def test_along_one_sine_nothing_tells_it(effects_seed: int) -> None:
    """There a force that is ever later is a damping that grows."""
    assert on_one_clock(bench(effects_seed, 2e-3, (1.9,), coulomb=0.0))[1] is None


def test_nothing_else_is_named_for_it(effects_seed: int) -> None:
    found = diagnose_bench(bench(effects_seed, 2e-3))
    assert found.method["clock_rate"][0] == pytest.approx(2e-3, rel=0.02)
    assert "put on the clock of the displacement" in found.verdict
    assert {each.effect for each in found.findings} == {"coulomb_friction", "viscous_friction"}
    assert found.parameters["inertance"].value == pytest.approx(60, rel=0.01)
    assert not found.unexplained.significant
