"""Values of a finding that a table tells."""

from __future__ import annotations

import pytest
from inerter.diagnose.result import Finding, ParameterValue
from inerter.report.text import told_values


@pytest.mark.parametrize(("stderr", "told"), [(0.02, True), (0.3, False), (0.06, False)])
def test_what_a_level_may_change_by_is_no_value_where_it_is_not_determined(
    stderr: float, told: bool
) -> None:
    values = {
        "coulomb_force": ParameterValue(8.0, 9.0, "N"),
        "rate_effect": ParameterValue(0.1, stderr, ""),
    }
    finding = Finding(
        effect="coulomb_friction", law=None, confidence=1.0, parameters=values, rmse_before=2.0,
        rmse_after=1.0, evidence="", rivals=[],
        members=("coulomb_friction", "rate_state_friction"),
    )  # fmt: skip
    assert ("rate_effect" in told_values(finding)) is told
    # its level is, however badly it is known
    assert "coulomb_force" in told_values(finding)
