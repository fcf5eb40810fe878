"""What is held out must not take away what it alone tells."""

from __future__ import annotations

import numpy as np
from inerter.diagnose import diagnose_bench
from inerter.records import Record

TIME = np.arange(0, 8, 1 / 400)


def records(draw: np.random.Generator) -> list[Record]:
    """60 kg beside a cubic spring, which shows in the second of two runs alone."""
    found = []
    for name, size, lines in (("small", 4e-3, (1.5, 3.1, 4.7)), ("large", 0.04, (0.6, 1.1, 1.7))):
        x, a = np.zeros((2, TIME.size))
        for frequency in lines:
            w, phase = 2 * np.pi * frequency, draw.uniform(0, 6)
            x += size / 3 * np.sin(w * TIME + phase)
            a -= size / 3 * w**2 * np.sin(w * TIME + phase)
        found.append(
            Record(
                name=name,
                time=TIME,
                displacement=x + 1e-6 * draw.standard_normal(TIME.size),
                force=60 * a + 8e5 * x**3 + 0.4 * draw.standard_normal(TIME.size),
            )
        )
    return found


def test_another_run_is_held_out_where_the_usual_one_alone_tells(effects_seed: int) -> None:
    made = records(np.random.default_rng(effects_seed))
    told = diagnose_bench(made)
    assert [each.effect for each in told.findings] == ["hardening_stiffness"]
    roles = {each.name: each.role for each in told.records}
    assert roles == {"small": "holdout", "large": "fit"}
    # who names a run to hold out gets that
    asked = diagnose_bench(made, holdout=["large"])
    assert {each.name: each.role for each in asked.records}["large"] == "holdout"
    if not asked.findings:
        assert "Try --holdout small" in asked.verdict
