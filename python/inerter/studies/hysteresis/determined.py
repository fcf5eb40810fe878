"""Which of the identified parameters the tests determine, and which combinations of the others.

Errors are those of the logarithms of the parameters at the identified set, from white noise on the
force, so they do not depend on units or scales. Groups and combinations are named by
`inerter.identify.identifiability`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inerter.core import Device
from inerter.identify.fit import Problem
from inerter.identify.identifiability import Combination, identifiability
from inerter.identify.model import Model
from inerter.studies.hysteresis.loops import loop
from inerter.studies.hysteresis.objective import Objective, force_of
from inerter.studies.hysteresis.published import MODELS
from inerter.studies.hysteresis.settings import Settings
from inerter.studies.hysteresis.virtual_tests import cleaned_tests, virtual_tests

Array = NDArray[np.float64]

_STEP = 1e-4
# relative errors beyond this are told as none
UNKNOWN = 1e3


@dataclass(frozen=True, kw_only=True)
class Determined:
    """What tests at `frequencies` [Hz] tell of a model's identified parameters.

    Attributes
    ----------
    errors
        Standard error of each parameter's logarithm by symbol: about its relative error; infinite
        where the tests say nothing.
    directions
        Errors along the principal directions of the logarithms, the best known first, shape (p,).
    groups, combinations
        Parameters that cannot be told apart, and what of them is known.
    quantities
        Values and standard errors of what no scaling of parameters changes, see `invariants`.
    """

    model: str
    frequencies: tuple[float, ...]
    errors: dict[str, float]
    directions: Array
    groups: tuple[tuple[str, ...], ...]
    combinations: tuple[Combination, ...]
    quantities: dict[str, tuple[float, float]]

    def json(self) -> dict[str, object]:
        """Plain data; null for a parameter of which nothing is known."""
        return {
            "model": self.model,
            "frequencies": list(self.frequencies),
            "relative_errors": {
                name: error if error < UNKNOWN else None for name, error in self.errors.items()
            },
            "directions": [min(float(each), 1e9) for each in self.directions],
            "undetermined": [list(group) for group in self.groups],
            "combinations": [
                {
                    "expression": each.expression,
                    "value": float(each.value),
                    "relative_error": float(each.relative_error),
                }
                for each in self.combinations
            ],
            "quantities": {
                name: {"value": value, "stderr": error if error < 1e9 else None}
                for name, (value, error) in self.quantities.items()
            },
        }


def determined(model: str, frequencies: tuple[float, ...], settings: Settings) -> Determined:
    """What tests of the device that Table 3 describes tell of its parameters, without denoising."""
    s, paper = settings, MODELS[model]
    every = cleaned_tests(model, s.rate, s.duration, s.noise, s.seed, "none")
    data = [pair for pair in every if pair[0].frequency in frequencies]
    jacobian = logarithmic_jacobian(Objective(paper, data))
    noise = max(s.noise, 1e-6)
    sizes, vectors = np.linalg.eigh(jacobian.T @ jacobian / noise**2)
    # what rounding leaves of an exact zero is none
    along = 1 / np.sqrt(np.maximum(sizes, 1e-13 * sizes[-1]))
    errors = np.sqrt(np.sum((vectors * along) ** 2, axis=1))
    runs = [test.run(cleaned) for test, cleaned in data]
    problem = Problem(runs, [run.inner for run in runs])
    values = {k: v for k, v in paper.values(paper.identified).items() if not isinstance(v, str)}
    told = identifiability(problem, Model(paper.name, values, ()), 1.0)
    return Determined(
        model=model,
        frequencies=frequencies,
        errors=dict(zip(paper.symbols, map(float, errors), strict=True)),
        directions=along[::-1],
        groups=told.groups,
        combinations=told.combinations,
        quantities=_with_errors(model, s, vectors * along),
    )


def invariants(model: str, vector: Array | tuple[float, ...], s: Settings) -> dict[str, float]:
    """Quantities that do not change with the scale of a hidden state.

    Of every model: apparent inertance [kg], the force's part in phase with the acceleration per
    acceleration, and equivalent damping [N s/m], at 1 and 4 Hz. Of Bouc-Wen also the two
    stiffnesses A k0 and (1 - A) k0 alpha and their sum [N/m], and the distance over which the
    hysteretic part yields, (alpha / (beta + gamma))^(1/n) / alpha [m].
    """
    paper = MODELS[model]
    device = Device(**paper.values(vector))
    found = {}
    tests = virtual_tests(model, s.rate, s.duration)
    for test in (tests[0], tests[-1]):
        seen = loop(test, force_of(device, test))
        name = f"{test.frequency:g} Hz"
        found[f"apparent inertance at {name} [kg]"] = seen.inertance
        found[f"equivalent damping at {name} [N s/m]"] = seen.damping
    if model == "bouc_wen":
        alpha, beta, gamma, n, ratio, _, stiffness, _ = map(float, vector)
        beside, hysteretic = ratio * stiffness, (1 - ratio) * stiffness * alpha
        found["A k_0 [N/m]"] = beside
        found["(1 - A) k_0 alpha [N/m]"] = hysteretic
        found["their sum [N/m]"] = beside + hysteretic
        found["yield distance [m]"] = (alpha / (beta + gamma)) ** (1 / n) / alpha
    return found


def _with_errors(model: str, s: Settings, spread: Array) -> dict[str, tuple[float, float]]:
    """Invariants of the identified set with standard errors.

    spread: principal directions of the logarithms times their errors, shape (p, p).
    """
    paper, vector = MODELS[model], np.array(MODELS[model].identified)
    here = invariants(model, vector, s)
    slopes = {name: np.zeros(vector.size) for name in here}
    for i, parameter in enumerate(paper.names):
        up, down, width = _moved(vector, i, parameter)
        above, below = (invariants(model, each, s) for each in (up, down))
        for name in here:
            slopes[name][i] = (above[name] - below[name]) / width
    return {
        name: (value, float(np.linalg.norm(slopes[name] @ spread))) for name, value in here.items()
    }


def logarithmic_jacobian(objective: Objective) -> Array:
    """Derivatives [N] of the force by the logarithms of the identified parameters, (m, p)."""
    vector = np.array(objective.model.identified)
    columns = []
    for i, name in enumerate(objective.model.names):
        up, down, width = _moved(vector, i, name)
        columns.append((objective.residual(up) - objective.residual(down)) / width)
    return np.column_stack(columns)


def _moved(vector: Array, i: int, name: str) -> tuple[Array, Array, float]:
    """The vector with one parameter a little larger and smaller, and how far apart (logarithm)."""
    up, down = vector.copy(), vector.copy()
    up[i] *= 1 + _STEP
    # an exponent of 1 is its smallest
    down[i] *= 1 if name == "bw_exponent" and vector[i] == 1 else 1 - _STEP
    return up, down, float(np.log(up[i] / down[i]))
