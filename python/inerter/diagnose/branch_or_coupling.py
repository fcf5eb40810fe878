"""A spring that relaxes, or a force channel that does not hold a constant force: often one.

What is linear looks alike behind a high-pass of the channel and with a branch, with w the corner:

    s / (s + w) (b s^2 + c s + k) = b s^2 + (c - b w) s + K s / (s + w),  K = k - w (c - b w)

Only friction, which is no linear function of the motion, tells them apart, or a branch without
passivity.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

from inerter.diagnose import wording
from inerter.diagnose.leak_or_filter import as_good_as
from inerter.diagnose.result import Finding, ParameterValue
from inerter.diagnose.values import parameter_units
from inerter.identify.fit import Fit, parameter_errors
from inerter.identify.model import Model

if TYPE_CHECKING:
    from inerter.diagnose.search import Search

_BRANCH = ("branch_stiffness_1", "branch_time_1")
_BESIDE = ("viscous", "stiffness")


def with_coupling(finding: Finding, search: Search, fit: Fit) -> Finding:
    """A branch, or a high-pass of the force, with the other one where the data cannot tell them."""
    if finding.effect not in _TWINS or finding.members:
        return finding
    other, name, twin_of = _TWINS[finding.effect]
    model = twin_of(fit.model)
    if model is None or not search.may_be(model):
        return finding
    twin = as_good_as([search.problem.fit(model)], search, fit)
    if twin is None:
        return finding
    value, error = parameter_errors(twin)[name]
    known = ParameterValue(value, error, parameter_units(finding.motion)[name])
    told = replace(
        finding,
        members=(finding.effect, other),
        parameters={**finding.parameters, name: known},
        rivals=[rival for rival in finding.rivals if rival.effect != other],
    )
    return replace(told, evidence=wording.evidence(told))


def _coupled(model: Model) -> Model | None:
    """A high-pass in the place of the only branch."""
    if not {*_BRANCH} <= {*model.free} or "branch_time_2" in model.values:
        return None
    rate = 1.0 / model.values["branch_time_1"]
    inertance, damping = (model.values.get(name, 0.0) for name in ("inertance", "viscous"))
    stiffness = model.values["branch_stiffness_1"] + rate * damping
    bare = model.without((*_BRANCH, *_BESIDE))
    return bare.adding(
        None, viscous=damping + inertance * rate, stiffness=stiffness,
        force_coupling=0.5 * rate / math.pi,
    )  # fmt: skip


def _branched(model: Model) -> Model | None:
    """A branch in the place of a high-pass."""
    if "force_coupling" not in model.free or _BRANCH[0] in model.values:
        return None
    rate = 2.0 * math.pi * model.values["force_coupling"]
    inertance, damping, stiffness = (
        model.values.get(name, 0.0) for name in ("inertance", "viscous", "stiffness")
    )
    damping -= inertance * rate
    branch = stiffness - rate * damping
    if not (damping >= 0.0 and branch > 0.0):
        return None
    bare = model.without(("force_coupling", *_BESIDE))
    return bare.adding(None, viscous=damping, branch_stiffness_1=branch, branch_time_1=1.0 / rate)


_TWINS = {
    "viscoelasticity": ("sensor_coupling", "force_coupling", _coupled),
    "sensor_coupling": ("viscoelasticity", "branch_stiffness_1", _branched),
}
