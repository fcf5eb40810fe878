"""A gas whose values are not known one by one is a spring, and that is known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from inerter.diagnose.result import Finding, ParameterValue
from inerter.diagnose.slope_of_gas import stiffness_of_gas, with_stiffness_of_gas
from inerter.identify.fit import Fit
from inerter.identify.model import Model
from inerter.motion_units import ROTATION, TRANSLATION

GAS = {"gas_push": 150.0, "gas_reach": 0.12, "gas_exponent": 1.2}
FREE = ("inertance", *GAS)


def fitted(error: float, gas: tuple[str, ...] = FREE) -> Fit:
    """Push, reach and exponent known to a share of `error` each, their stiffness to 2 %."""
    values = {"inertance": 2.0, **GAS}
    # the stiffness has the exponents 1, -1, 1: what goes along (1, 1, 0) leaves it as it is
    along = np.array([1.0, 1.0, 0.0])
    across = np.array([1.0, -1.0, 1.0]) / 3
    sizes = np.array([GAS[name] for name in GAS])
    moved = error**2 * np.outer(along, along) + 0.02**2 * np.outer(across, across)
    covariance = np.zeros((4, 4))
    covariance[1:, 1:] = moved * np.outer(sizes, sizes)
    free = tuple(name for name in FREE if name in gas)
    rows = [FREE.index(name) for name in free]
    return Fit(Model("none", values, free), [], covariance[np.ix_(rows, rows)], 1)


def finding(error: float) -> Finding:
    values = {
        "gas_pressure": ParameterValue(1.5e5, error * 1.5e5, "Pa"),
        "gas_exponent": ParameterValue(1.2, 0.1, "1"),
    }
    return Finding(
        effect="gas_spring", law=None, confidence=0.97, parameters=values, rmse_before=30.0,
        rmse_after=12.0, evidence="Told.", rivals=[],
    )  # fmt: skip


def test_its_stiffness_is_known_where_its_values_are_not() -> None:
    known = stiffness_of_gas(fitted(3.0))
    assert known == (pytest.approx(1500.0), pytest.approx(30.0, rel=1e-6))
    told = with_stiffness_of_gas(finding(3.0), fitted(3.0), TRANSLATION)
    assert told.evidence.endswith("where the displacement is 0 it is a spring of 1500 ± 30 N/m.")
    turned = with_stiffness_of_gas(finding(3.0), fitted(3.0), ROTATION)
    assert "1500 ± 30 N*m/rad" in turned.remark


def test_nothing_is_said_of_one_that_is_known_or_none() -> None:
    assert with_stiffness_of_gas(finding(0.2), fitted(0.2), TRANSLATION) == finding(0.2)
    other = replace(finding(3.0), effect="end_stop")
    assert with_stiffness_of_gas(other, fitted(3.0), TRANSLATION) == other
    stated = fitted(3.0, ("inertance",))
    assert stiffness_of_gas(stated) is None
    assert with_stiffness_of_gas(finding(3.0), stated, TRANSLATION) == finding(3.0)


def test_nothing_is_said_of_a_stiffness_that_is_not_known_either() -> None:
    unknown = fitted(3.0)
    unknown = replace(unknown, covariance=unknown.covariance + np.diag([0, 150.0**2, 0, 0]))
    assert with_stiffness_of_gas(finding(3.0), unknown, TRANSLATION) == finding(3.0)
