"""OpenSees' inerter, `InertiaTruss`, against the equations and the three engines.

OpenSees is a finite-element program for earthquakes; its element's authors (Ji, Cheng, Yu, Tsinghua
University) share nothing with this project. Newmark's average acceleration is of second order, so
that two step sizes extrapolate to the exact motion: (4 y(h / 2) - y(h)) / 3.

`setNodeVel` starts a run with a velocity but without the acceleration that belongs to it. Newmark's
rule then begins with a wrong half step and is of first order; `setNodeAccel` mends that.

Needs the package openseespy and, on Debian, libblas3 and liblapack3; skipped where it cannot be
imported. There is one model in a process: every run begins with `wipe`.
"""

from __future__ import annotations

import functools
import importlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np
import pytest
from inerter.model_parameters import FRAME
from inerter.models import exudyn_model, model_path
from inerter.reference import FloorDevice, ReferenceDevice, ShearFrame, frame_state_matrix
from numpy.typing import NDArray
from scipy.linalg import expm
from shipped_runs import error, path

Array = NDArray[np.float64]


def opensees() -> Any:
    """The interpreter of OpenSees; skips the test where it is not there."""
    try:
        return importlib.import_module("openseespy.opensees")
    except ImportError:
        pytest.skip("OpenSees is not installed: pip install openseespy")
    except RuntimeError as problem:
        # its package turns a missing library into this
        pytest.skip(f"OpenSees: {problem} On Debian it needs libblas3 and liblapack3.")


@dataclass(frozen=True)
class Chain:
    """Nodes on one line, 0 is the ground: masses [kg], and between pairs (spring, damper), inerter.

    `velocity` and `acceleration` are those of the nodes at the start.
    """

    mass: Sequence[float]
    springs: Sequence[tuple[int, int, float, float]]
    inerters: Sequence[tuple[int, int, float]]
    velocity: Sequence[float] | Array
    acceleration: Sequence[float] | Array


def newmark(chain: Chain, times: Array, step: float) -> Array:
    """Displacements (times, nodes) of a chain from OpenSees, average acceleration."""
    ops = opensees()
    ops.wipe()
    try:
        ops.model("basic", "-ndm", 1, "-ndf", 1)
        for tag in range(len(chain.mass) + 1):
            ops.node(tag, float(tag))
        ops.fix(0, 1)
        for tag, mass in enumerate(chain.mass, 1):
            ops.mass(tag, mass)
        # a bar of length L and area 1 is a spring E / L; no element may have the length 0
        for tag, (i, j, stiffness, damping) in enumerate(chain.springs, 1):
            length = float(abs(j - i))
            ops.uniaxialMaterial("Elastic", tag, stiffness * length, damping * length)
            ops.element("Truss", tag, i, j, 1.0, tag)
        for tag, (i, j, inertance) in enumerate(chain.inerters, 1 + len(chain.springs)):
            ops.element("InertiaTruss", tag, i, j, inertance)
        for tag, (v, a) in enumerate(zip(chain.velocity, chain.acceleration, strict=True), 1):
            ops.setNodeVel(tag, 1, float(v), "-commit")
            ops.setNodeAccel(tag, 1, float(a), "-commit")
        ops.constraints("Plain")
        ops.numberer("Plain")
        ops.system("FullGeneral")
        ops.algorithm("Linear")
        ops.integrator("Newmark", 0.5, 0.25)
        ops.analysis("Transient")
        rows = [[0.0] * len(chain.mass)]
        for _ in times[1:]:
            assert ops.analyze(round(float(times[1]) / step), step) == 0
            rows.append([ops.nodeDisp(tag, 1) for tag in range(1, 1 + len(chain.mass))])
        return np.array(rows)
    finally:
        ops.wipe()


# --------------------------- quarter-car ----------------------------------------------------------

SPRUNG, UNSPRUNG, TYRE = 181.75, 25.0, 120e3
SPRING, DAMPER, INERTANCE, KERB = 60e3, 1500.0, 113.0, 0.3
END = np.array([0.0, 2.0])


@functools.cache
def quarter_car_matrix() -> Array:
    """A of y' = A y, y = (z_u, z_s, z_u', z_s')."""
    mass = np.array([[UNSPRUNG + INERTANCE, -INERTANCE], [-INERTANCE, SPRUNG + INERTANCE]])
    stiffness = np.array([[TYRE + SPRING, -SPRING], [-SPRING, SPRING]])
    damping = DAMPER * np.array([[1.0, -1.0], [-1.0, 1.0]])
    lower = -np.linalg.solve(mass, np.hstack((stiffness, damping)))
    return np.asarray(np.vstack((np.eye(2, 4, 2), lower)), dtype=np.float64)


def quarter_car(consistent: bool) -> Chain:
    """Wheel and body after a kerb, with the acceleration that belongs to it or without any."""
    acceleration = quarter_car_matrix()[2:] @ [0, 0, KERB, 0]
    return Chain(
        mass=(UNSPRUNG, SPRUNG),
        springs=((0, 1, TYRE, 0.0), (1, 2, SPRING, DAMPER)),
        inerters=((1, 2, INERTANCE),),
        velocity=(KERB, 0.0),
        acceleration=acceleration * consistent,
    )


@pytest.mark.parametrize(("consistent", "order"), [(True, 2.0), (False, 1.0)])
def test_quarter_car(consistent: bool, order: float) -> None:
    """Wheel and body at 2 s against the matrix exponential, and the order of the approach.

    Without an acceleration at the start, OpenSees gives z_u = -5.12484e-5 m with h = 1e-4 s against
    the exact -5.12105e-5 m: of first order, 7e-4 away.
    """
    exact = (expm(quarter_car_matrix() * END[1]) @ [0, 0, KERB, 0])[:2]
    steps = (4e-4, 2e-4, 1e-4)
    found = np.array([newmark(quarter_car(consistent), END, step)[-1] for step in steps])
    errors = abs(found / exact - 1)
    assert np.log2(errors[:-1] / errors[1:]) == pytest.approx(np.full((2, 2), order), abs=0.05)
    assert errors[-1].max() < (1e-5 if consistent else 1e-3)


# --------------------------- frame of three storeys -----------------------------------------------

TIMES = np.linspace(0, 2.0, 101)
JOLT = {"floor_1": 0.445, "floor_2": 0.802, "floor_3": 1.0}
DEVICES: dict[str, dict[str, Any]] = {
    "rigid": {"inertance": FRAME.inertance},
    "tuned": {
        "inertance": FRAME.inertance,
        "series_stiffness": FRAME.series_stiffness,
        "series_damping": FRAME.series_damping,
    },
}
PLACES = {"floors": (1, 3), "ground": (0, 1)}


def frame(device: str, place: str) -> ShearFrame:
    lower, upper = PLACES[place]
    made = FloorDevice(lower=lower, upper=upper, device=ReferenceDevice(**DEVICES[device]))
    return ShearFrame(devices=(made,))


def start_of(made: ShearFrame) -> Array:
    """The jolted floors; a tuned damper's spring unloaded, its flywheel at rest."""
    start = np.zeros(made.nstate)
    start[3:6] = list(JOLT.values())
    return start


def exact(device: str, place: str) -> Array:
    """Floors, from the matrix exponential of the reference's closed form."""
    made = frame(device, place)
    matrix = frame_state_matrix(made)
    return np.array([(expm(matrix * t) @ start_of(made))[:3] for t in TIMES])


@functools.cache
def in_opensees(device: str, place: str, step: float) -> Array:
    """Floors; the flywheel of a tuned damper is a node without mass."""
    made = frame(device, place)
    rates = frame_state_matrix(made) @ start_of(made)
    velocity, acceleration = start_of(made)[3:6], rates[3:6]
    storeys = zip(range(3), range(1, 4), FRAME.storey_stiffness, FRAME.storey_damping, strict=True)
    springs, mass = list(storeys), FRAME.storey_mass
    lower, upper = PLACES[place]
    inerters = ((lower, upper, FRAME.inertance),)
    if device == "tuned":
        # behind the spring the flywheel moves with the lower floor, plus what it turns
        ground = lower == 0
        mass = (*mass, 0.0)
        springs.append((4, upper, FRAME.series_stiffness, FRAME.series_damping))
        inerters = ((lower, 4, FRAME.inertance),)
        velocity = np.append(velocity, 0.0 if ground else velocity[lower - 1])
        turn = rates[7] + (0.0 if ground else acceleration[lower - 1])
        acceleration = np.append(acceleration, turn)
    return newmark(Chain(mass, springs, inerters, velocity, acceleration), TIMES, step)[:, :3]


def extrapolated(device: str, place: str) -> Array:
    """OpenSees' motion without its step size."""
    fine, coarse = (in_opensees(device, place, step) for step in (5e-5, 1e-4))
    return (4 * fine - coarse) / 3


def reference(device: str, place: str) -> Array:
    """Floors of the reference's ODE, DOP853."""
    made = frame(device, place)
    run = made.simulate(TIMES, initial=start_of(made), method="DOP853", rtol=1e-11, atol=1e-13)
    return run.displacement


def in_mujoco(device: str, place: str) -> Array:
    """Floors of the shipped model under RK4, its damper's series element taken out for `rigid`."""
    file = {"floors": "model.xml", "ground": "model_ground.xml"}[place]
    spec = mujoco.MjSpec.from_file(str(model_path("tuned_inerter_damper", file)))
    if device == "rigid":
        (damper,) = [plugin for plugin in spec.plugins if plugin.name == "damper"]
        damper.config = {
            key: value for key, value in damper.config.items() if not key.startswith("series_")
        }
        spec.actuator("damper").actdim = 0
    spec.option.timestep = 5e-4
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_RK4
    return path(spec.compile(), TIMES, lambda data: data.qpos.copy(), velocities=JOLT)


def in_exudyn(device: str, place: str) -> Array:
    """Floors of the shipped model under RK44."""
    exu: Any = pytest.importorskip("exudyn")
    from inerter.exudyn.model_parts import simulate

    mbs = exu.SystemContainer().AddSystem()
    model = exudyn_model("tuned_inerter_damper").build(
        mbs, ground=place == "ground", device=DEVICES[device], initial_velocities=JOLT
    )
    run = simulate(model, float(TIMES[-1]), 5e-4, float(TIMES[1]), "RK44")
    return np.array([run.displacement[name] for name in JOLT]).T


ENGINES: dict[str, Callable[[str, str], Array]] = {
    "reference": reference,
    "mujoco": in_mujoco,
    "exudyn": in_exudyn,
}
cases = pytest.mark.parametrize(
    ("device", "place"), [(device, place) for device in DEVICES for place in PLACES]
)


@cases
def test_frame_of_second_order(device: str, place: str) -> None:
    """OpenSees' free motion of the frame goes to the closed form in second order."""
    true = exact(device, place)
    errors = np.array([
        error(in_opensees(device, place, step), true) for step in (2e-4, 1e-4, 5e-5)
    ])  # fmt: skip
    assert np.log2(errors[:-1] / errors[1:]) == pytest.approx([2.0, 2.0], abs=0.01)
    assert error(extrapolated(device, place), true) < 1e-8


@cases
@pytest.mark.parametrize("engine", ENGINES)
def test_frame_in_the_engines(engine: str, device: str, place: str) -> None:
    """Each engine's free motion of the frame is OpenSees'; Runge-Kutta at h = 0.5 ms."""
    true = extrapolated(device, place)
    assert error(ENGINES[engine](device, place), true) < 1e-7
