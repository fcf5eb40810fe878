"""Is an inerter right wherever it is mounted, with every integrator?

`python test_topologies.py` prints the table: error of the positions over the run, relative to the
way travelled, at h = 1 ms, and the order observed.
"""

from __future__ import annotations

import re
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from plugin_models import INTEGRATORS, RK4_TURNS
from topology_mechanisms import Array
from topology_models import ONE, TWO, Topology, cases, quarter_car, two_bodies

CASES = cases()
QUARTER_CARS = list(CASES)[:3]
TIMES = np.arange(0, 0.4001, 0.02)

# steps over which the order is observed; RK4 reaches rounding below
STEPS = dict.fromkeys(INTEGRATORS, (2e-3, 1e-3, 5e-4)) | {"RK4": (1e-2, 5e-3, 2.5e-3)}

# errors at 1 ms over 0.4 s: explicit first order on the wheel's 36 rad/s; springs that discrete
# integrates implicitly are damped
QUARTER_CAR = {"Euler": 0.02, "implicit": 0.03, "implicitfast": 0.03, "discrete": 0.1, "RK4": 1e-7}
IN_SPACE = dict.fromkeys(INTEGRATORS, 6e-3) | {"RK4": 1e-9 if RK4_TURNS else 2e-5}
RK4_ORDER = 3.7 if RK4_TURNS else 1.8


@cache
def truth(name: str) -> Array:
    """Rows of qpos at TIMES."""
    return CASES[name].truth(TIMES)


def error(topology: Topology, expected: Array, integrator: str, h: float) -> float:
    """Largest error of the positions, relative to the way travelled."""
    found = topology.path(integrator, h, TIMES)
    return float(np.abs(found - expected).max() / np.abs(expected - expected[0]).max())


def order(topology: Topology, expected: Array, integrator: str) -> float:
    """Observed order of convergence."""
    steps = STEPS[integrator]
    errors = [error(topology, expected, integrator, h) for h in steps]
    return float(np.polyfit(np.log(steps), np.log(errors), 1)[0])


def table() -> str:
    """Error at 1 ms and order, for every topology and integrator."""
    lines = ["topology".ljust(26) + "".join(name.rjust(15) for name in INTEGRATORS)]
    for name, topology in CASES.items():
        cells = ""
        for integrator in INTEGRATORS:
            at_1_ms = error(topology, truth(name), integrator, 1e-3)
            cells += f"{at_1_ms:10.1e}{order(topology, truth(name), integrator):5.2f}"
        lines.append(name.ljust(26) + cells)
    return "\n".join(lines)


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("name", CASES)
def test_the_motion_converges_to_the_equations(name: str, integrator: str) -> None:
    topology = CASES[name]
    allowed, fast = (QUARTER_CAR, 3.8) if name in QUARTER_CARS else (IN_SPACE, RK4_ORDER)
    assert error(topology, truth(name), integrator, 1e-3) < allowed[integrator]
    observed = order(topology, truth(name), integrator)
    assert observed > (fast if integrator == "RK4" else 0.85), observed


@pytest.mark.parametrize("name", CASES)
def test_the_inerter_matters_and_is_where_it_should_be(name: str) -> None:
    # the truth without inertance is far from the one with it: no error above hides in smallness
    topology = CASES[name]
    model = topology.model()
    native = model.actuator_armature[:] > 0
    assert tuple(native) == topology.native
    without = replace(
        topology, xml=re.sub('"inertance" value="[^"]*"', '"inertance" value="0"', topology.xml)
    )
    assert error(without, truth(name), "RK4", 1e-3) > 0.02


# --------------------------- light and heavy inerters ---------------------------------------------

RATIOS = (0.01, 0.1, 1.0, 10.0, 1000.0)


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("ratio", RATIOS)
@pytest.mark.parametrize("layout", ["nested", "fixed", "spatial"])
def test_any_inertance_in_the_quarter_car(layout: str, ratio: float, integrator: str) -> None:
    topology = quarter_car(layout, inertance=ratio * 206.75)
    expected = topology.truth(TIMES)
    # a light inerter leaves the wheel at 85 rad/s, a heavy one holds it
    factor = 10 if integrator == "RK4" and ratio < 1 else 4
    assert error(topology, expected, integrator, 1e-3) < factor * QUARTER_CAR[integrator]
    observed = order(topology, expected, integrator)
    assert observed > (3.7 if integrator == "RK4" else 0.8), observed


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("ratio", RATIOS)
def test_any_inertance_between_tumbling_bodies(ratio: float, integrator: str) -> None:
    topology = two_bodies(ratio * (ONE.mass + TWO.mass))
    expected = topology.truth(TIMES)
    assert error(topology, expected, integrator, 1e-3) < IN_SPACE[integrator]
    observed = order(topology, expected, integrator)
    assert observed > (RK4_ORDER if integrator == "RK4" else 0.85), observed


if __name__ == "__main__":
    print(table())
