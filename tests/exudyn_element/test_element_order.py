"""The solvers keep their order with the element, against the reference ODE and by halving steps."""

from __future__ import annotations

import functools
from typing import Any

import numpy as np
import pytest
from inerter.reference import ReferenceDevice
from inerter.reference.structure import Structure, StructureRun
from inerter.reference.strut import Strut

pytest.importorskip("exudyn.itemInterface")

from element_systems import LUGRE, Array, System, bodies, line, point, settings, solve
from inerter.exudyn import CreateInerter

MASSES, START, SPRING = [2.0, 3.0, 1.0], [0.5, -0.3, 0.1], 300.0
END = 0.5
SMOOTH: dict[str, Any] = {
    "friction": "coulomb", "coulomb_force": 4.0, "transition_velocity": 0.2, "viscous": 1.0,
}  # fmt: skip
DEVICES: dict[str, dict[str, Any]] = {
    "ideal": {"inertance": 4.0},
    "varying": {"inertance": 4.0, "inertance_gradient": 8.0, "inertance_curvature": 50.0},
    "friction": {"inertance": 4.0, **SMOOTH},
    "along the stroke": {
        "inertance": 4.0,
        "inertance_periods": (0.2, 0.05, 1.0),
        "force_periods": (0.3, 5.0, 0.5),
        "viscous": 3.0,
        "viscous_periods": (0.15, 1.5, 0.0),
    },
    "series": {"inertance": 4.0, "series_stiffness": 800.0, "series_damping": 6.0, **SMOOTH},
    "lugre": {"inertance": 4.0, **LUGRE, "bristle_stiffness": 500.0},
    "free play": {
        "inertance": 4.0,
        "friction": "dahl",
        "coulomb_force": 8.0,
        "bristle_stiffness": 500.0,
        "friction_backlash": 5e-3,
    },
}
# |v| in the rate of a bristle is a corner, which solvers of high order feel
CORNERS = ("lugre", "free play")
Ends = tuple[tuple[int | None, int], ...]
ONE: Ends = ((0, 1),)
MANY: Ends = ((0, 1), (1, 2), (2, 0), (None, 1))


@functools.cache
def truth(name: str, ends: Ends) -> StructureRun:
    """Masses on springs to the ground with devices between them, at the end."""
    directions = np.zeros((3, len(ends)))
    for column, (first, second) in enumerate(ends):
        directions[second, column] += 1.0
        if first is not None:
            directions[first, column] -= 1.0
    strut = Strut(layout="S2", device=ReferenceDevice(**DEVICES[name]))
    made = Structure(
        mass=np.diag(MASSES),
        damping=np.zeros((3, 3)),
        stiffness=SPRING * np.eye(3),
        directions=directions,
        struts=(strut,) * len(ends),
    )
    state = np.zeros(made.nstate)
    state[3:6] = START
    return made.simulate(
        lambda t: np.zeros(3), [0.0, END], initial=state, method="DOP853", rtol=1e-12, atol=1e-14
    )


def chain(name: str, ends: Ends, symbolic: bool | None = None) -> tuple[System, list[Any]]:
    system = line(MASSES, START, SPRING)
    made = []
    for i, (first, second) in enumerate(ends):
        terminals = [None if first is None else system.parts[first], system.parts[second]]
        made.append(
            CreateInerter(
                system.mbs,
                f"d{i}",
                terminals,
                symbolic=symbolic,
                **DEVICES[name],
                # as in the reference
                initialStates={"flywheel_velocity": 0.0} if name == "series" else {},
            )
        )
    return system, made


def error(name: str, ends: Ends, solver: str, chosen: Any, symbolic: bool | None = None) -> float:
    """Largest error of displacements, velocities and states, relative to the largest of each."""
    system, made = chain(name, ends, symbolic)
    solve(system.mbs, chosen, solver)
    true = truth(name, ends)
    pairs = [(system.positions, true.position[-1]), (system.velocities, true.velocity[-1])]
    pairs += [
        (device.GetStates(), states[-1])
        for device, states in zip(made, true.device_states, strict=True)
        if states.size
    ]
    return max(float(np.abs(a - b).max() / np.abs(b).max()) for a, b in pairs)


@pytest.mark.parametrize("symbolic", [True, False])
@pytest.mark.parametrize("name", [name for name in DEVICES if name not in CORNERS])
def test_fourth_order_under_rk44(name: str, symbolic: bool) -> None:
    coarse, fine = (
        error(name, ONE, "RK44", settings(END, step), symbolic) for step in (2e-3, 1e-3)
    )
    assert fine < 1e-7
    assert 12 < coarse / fine < 20


@pytest.mark.parametrize("name", DEVICES)
def test_second_order_under_generalized_alpha(name: str) -> None:
    coarse, fine = (
        error(name, ONE, "GeneralizedAlpha", settings(END, step)) for step in (1e-3, 5e-4)
    )
    assert fine < 2e-4
    # where in its step a bristle meets the edge of its play is left to chance
    low, high = (3.0, 5.0) if name == "free play" else (3.6, 4.4)
    assert low < coarse / fine < high


@pytest.mark.parametrize("name", DEVICES)
def test_to_its_tolerance_under_dopri5(name: str) -> None:
    for tolerance in (1e-7, 1e-9):
        chosen = settings(END, 1e-2)
        chosen.timeIntegration.automaticStepSize = True
        chosen.timeIntegration.relativeTolerance = tolerance
        chosen.timeIntegration.absoluteTolerance = tolerance
        corners = {"lugre": 1500.0, "free play": 5000.0}
        assert error(name, ONE, "DOPRI5", chosen) < corners.get(name, 100.0) * tolerance


@pytest.mark.parametrize("name", [name for name in DEVICES if name not in CORNERS])
def test_devices_that_share_masses(name: str) -> None:
    """Four of them on three masses and the ground: all coupled through the mass matrix."""
    coarse, fine = (error(name, MANY, "RK44", settings(END, step)) for step in (2e-3, 1e-3))
    assert fine < 1e-7
    assert 12 < coarse / fine < 20
    assert error(name, MANY, "GeneralizedAlpha", settings(END, 5e-4)) < 5e-4


# in space, where there is no reference: halving the step twice


def place(kind: str, solver: str, step: float, **device: Any) -> Array:
    system = bodies(kind)
    CreateInerter(
        system.mbs, "d", system.parts, localPosition0=[0.05, 0.02, -0.03],
        localPosition1=[-0.04, 0.1, 0.02], rest_length=0.5, **device,
    )  # fmt: skip
    solve(system.mbs, settings(0.2, step), solver)
    return np.concatenate([point(system.mbs, part, "Position") for part in system.parts])


@pytest.mark.parametrize("name", ["ideal", "varying", "series"])
@pytest.mark.parametrize(
    ("kind", "solver", "order"),
    [
        ("RigidBodyRxyz", "RK44", 4),
        ("RigidBodyRotVecLG", "RK44", 4),
        ("RigidBodyRxyz", "GeneralizedAlpha", 2),
        ("RigidBodyRotVecLG", "GeneralizedAlpha", 2),
        ("RigidBodyEP", "GeneralizedAlpha", 2),
    ],
)
def test_order_in_space(kind: str, solver: str, order: int, name: str) -> None:
    step = 2e-3 if order == 4 else 4e-3
    runs = [place(kind, solver, step / 2**i, **DEVICES[name]) for i in range(3)]
    far, near = (np.abs(a - b).max() for a, b in ((runs[0], runs[1]), (runs[1], runs[2])))
    assert near < 1e-5
    assert 2**order * 0.75 < far / near < 2**order * 1.35


def test_two_devices_on_the_same_two_bodies() -> None:
    """They are one of the summed inertance, stiffness and damping."""
    ends = []
    for count in (1, 2):
        system = bodies("RigidBodyRxyz")
        for i in range(count):
            CreateInerter(
                system.mbs, f"d{i}", system.parts, localPosition0=[0.05, 0.02, -0.03],
                localPosition1=[-0.04, 0.1, 0.02], inertance=4.0 / count,
                stiffness=60.0 / count, viscous=2.0 / count, rest_length=0.4,
            )  # fmt: skip
        solve(system.mbs, settings(0.2, 2e-3))
        ends.append([point(system.mbs, part, "Position") for part in system.parts])
    np.testing.assert_allclose(ends[1], ends[0], rtol=1e-11)
