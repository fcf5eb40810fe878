"""What a finding could be in a real device, read off its figures."""

from __future__ import annotations

import math

import pytest
from inerter.diagnose.guesses import what_it_could_be
from inerter.diagnose.result import Finding, ParameterValue
from inerter.motion_units import Kind


def finding(effect: str, motion: Kind, **values: tuple[float, float]) -> Finding:
    return Finding(
        effect=effect, law=None, confidence=1.0, rmse_before=5.0, rmse_after=1.0, evidence="",
        parameters={n: ParameterValue(v, e, "1") for n, (v, e) in values.items()}, rivals=[],
        motion=motion,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("effect", "motion", "values", "text"),
    [
        (
            "variable_inertance", "rotation", {"inertance_period_1": (math.pi, 1e-4)},
            "2 times a turn: a universal joint",
        ),
        (
            "variable_inertance", "rotation", {"inertance_period_1": (2 * math.pi / 17, 1e-4)},
            "17 times a turn: so many teeth",
        ),
        (
            "variable_inertance", "translation", {"inertance_period_1": (0.02, 1e-5)},
            "20 mm is one turn of a gear",
        ),
        ("end_stop", "translation", {"stop_lower": (3e-6, 4e-6)}, "stiffer one way than the other"),
        (
            "digressive_damping", "translation",
            {"viscous": (900.0, 1), "damping_knee": (0.1, 0.01), "damping_exponent": (-1.0, 0.01)},
            "an eddy-current brake has -1",
        ),
        ("parallel_stiffness", "translation", {"stiffness": (-400.0, 3.0)}, "snaps through"),
        (
            "hysteretic_friction", "translation",
            {"bw_stiffness": (1e5, 1), "bw_beta": (3e5, 1), "bw_gamma": (1e5, 1),
             "bw_exponent": (2.0, 0.1)},
            "yields at 158 N, over 0.0016 m",
        ),
    ],
)  # fmt: skip
def test_figures_say_what_it_could_be(
    effect: str, motion: Kind, values: dict[str, tuple[float, float]], text: str
) -> None:
    assert text in what_it_could_be(finding(effect, motion, **values))


def test_figures_that_say_nothing_more() -> None:
    assert not what_it_could_be(finding("end_stop", "translation", stop_lower=(0.02, 1e-5)))
    odd = finding("variable_inertance", "rotation", inertance_period_1=(0.7 * math.pi, 1e-4))
    assert not what_it_could_be(odd)
    assert not what_it_could_be(finding("viscous_friction", "translation", viscous=(30.0, 1.0)))
