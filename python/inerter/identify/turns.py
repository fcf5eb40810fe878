"""Runs whose turning points are not lost between two samples.

A bristle follows the path of the motion, from sample to sample. Where the motion turns between two
of them, the way on to the turning point and back is missing: a bristle that yields within less than
that way keeps its side for a sample too long, or for many, and no parameter makes up for it, so
that Dahl friction with the shortest bristle fell behind Coulomb friction, which reads the velocity.
With the last sample before a turn put to the turning point the path is whole, at no cost. A series
element needs the samples where they are: it differentiates them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from inerter.catalogue.friction import BRISTLES
from inerter.identify.laws import FittedLaw
from inerter.identify.runs import BenchRun

Array = NDArray[np.float64]


def needs_turns(law: FittedLaw, fixed: Mapping[str, float | str]) -> bool:
    """Whether a law follows the path of the motion and nothing but that."""
    series = {"series_frequency", "series_stiffness"} & {*law.starts, *fixed}
    return law.friction in BRISTLES and not series


def with_turns(run: BenchRun) -> BenchRun:
    """The run with its turning points in the path that a bristle follows."""
    if run.measured is None:
        return replace(run, displacement=turned(run.displacement, run.velocity, run.spacing))
    x, v, a = run.measured
    return replace(run, measured=(turned(x, v, run.fine_spacing), v, a))


def turned(x: Array, v: Array, spacing: float) -> Array:
    """Displacement with the last sample before each turn put to the turning point, shape (n,).

    Between the two samples the velocity is a straight line: it is 0 a share of the spacing before
    the second one, whose way back from the turn follows.
    """
    last = np.flatnonzero(v[:-1] * v[1:] < 0)
    back = spacing * v[last + 1] / (v[last + 1] - v[last])
    found = x.copy()
    found[last] = x[last + 1] - 0.5 * v[last + 1] * back
    return found
