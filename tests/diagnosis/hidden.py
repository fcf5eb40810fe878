"""Hidden cases as records, and one diagnosis each."""

from __future__ import annotations

from functools import cache

from inerter import Device
from inerter.blind_test.case import records_of
from inerter.diagnose import Diagnosis, diagnose_bench
from inerter.reference import HiddenCase, hide_effect


@cache
def solve(seed: int, effect: str, law: str | None = None) -> tuple[HiddenCase, Diagnosis]:
    """Hide an effect by the reference, diagnose the noisy records."""
    case = hide_effect(seed, effect, law=law)
    return case, diagnose_bench(records_of(case), Device(**case.stated) if case.stated else None)
