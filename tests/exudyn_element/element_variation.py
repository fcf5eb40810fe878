"""A model function as users write one for ParameterVariation; run as a script, it varies itself.

    python element_variation.py     prints [parameters, values] as JSON

A script, because exudyn.processing starts processes that import the module of the function.
"""

from __future__ import annotations

import json
from typing import Any

from element_systems import line, settings, solve
from exudyn.processing import ParameterVariation
from inerter.exudyn import CreateInerter

VARIED = {"inertance": [1.0, 4.0, 9.0], "coulomb_force": [2.0, 5.0]}


def simulate(parameters: dict[str, Any]) -> float:
    """Displacement of the first mass at the end, of an inerter with a bristle."""
    system = line([2.0, 3.0], [0.5, -0.4], 300.0)
    CreateInerter(
        system.mbs,
        "d",
        system.parts,
        inertance=parameters["inertance"],
        friction="dahl",
        bristle_stiffness=500.0,
        coulomb_force=parameters["coulomb_force"],
    )
    solve(system.mbs, settings(0.2, 1e-3))
    return float(system.positions[0])


if __name__ == "__main__":
    found = [
        ParameterVariation(
            parameterFunction=simulate,
            parameters=VARIED,
            useMultiProcessing=many,
            numberOfThreads=2,
            showProgress=False,
        )
        for many in (False, True)
    ]
    print("\n" + json.dumps([[{k: list(v) for k, v in p.items()}, list(v)] for p, v in found]))
