"""Undamped oscillators with an inerter: their frequencies, and where nothing moves, on paper.

Two bodies on one line: a base M on a spring K to the ground, a mass m on a spring k to the base; an
inerter b stands between them or between ground and mass. A base of 1e12 kg moves as it likes and
lets the mass feel it. In MuJoCo both bodies are children of the world.

Source: M. C. Smith, "Synthesis of mechanical networks: the inerter", IEEE TAC 47(10), 2002: in the
force-current analogy an inerter is a capacitor, a spring an inductor, so that spring and inerter
side by side block at sqrt(k / b) (parallel LC circuit) and in series they are a short circuit there
(series LC circuit).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import mujoco
import numpy as np
import pytest
from inerter.reference import ReferenceDevice, Structure, Strut
from numpy.typing import NDArray

Array = NDArray[np.float64]

HEAVY = 1e12
MASS, SPRING, INERTANCE, SERIES = 2.0, 800.0, 5.0, 600.0
STEPS_PER_SAMPLE, SAMPLES, PERIODS = 20, 20, 20
SERIES_STATES = ("series_deflection", "flywheel_velocity")


@dataclass(frozen=True)
class System:
    """Masses [kg], springs [N/m], where the device stands and its parameters, the start.

    `start` holds y, x, y', x' of base and mass [m, m/s], `states` those of the device by name.
    """

    base: float = HEAVY
    base_spring: float = 0.0
    between: bool = False  # base and mass, else ground and mass
    device: dict[str, Any] = field(default_factory=lambda: {"inertance": INERTANCE})
    start: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)
    states: dict[str, float] = field(default_factory=dict)


def reference(system: System, times: Array) -> Array:
    """Displacements (times, 2) of base and mass, by DOP853."""
    device = ReferenceDevice(**system.device)
    structure = Structure(
        mass=np.diag([system.base, MASS]),
        damping=np.zeros((2, 2)),
        stiffness=np.array([[system.base_spring + SPRING, -SPRING], [-SPRING, SPRING]]),
        directions=np.array([[-float(system.between)], [1.0]]),
        struts=(Strut(layout="S2", device=device),),
    )
    own = [system.states.get(name, 0.0) for name in device.state_names]
    run = structure.simulate(
        lambda t: np.zeros(2), times, initial=[*system.start, *own], method="DOP853",
        rtol=1e-12, atol=1e-15,
    )  # fmt: skip
    return run.position


def in_mujoco(system: System, times: Array) -> Array:
    """The same by RK4."""
    step = float(times[1]) / STEPS_PER_SAMPLE
    target = 'tendon="pair"' if system.between else 'joint="mass"'
    states = 2 if "series_stiffness" in system.device else 0
    config = "".join(f'<config key="{k}" value="{v}"/>' for k, v in system.device.items())
    bodies = "".join(
        f'<body><joint name="{name}" type="slide" axis="1 0 0" stiffness="{spring}"/>'
        f'<inertial pos="0 0 0" mass="{mass}" diaginertia="1 1 1"/></body>'
        for name, mass, spring in (("base", system.base, system.base_spring), ("mass", MASS, 0.0))
    )
    model = mujoco.MjModel.from_xml_string(
        f"""
    <mujoco>
      <extension><plugin plugin="inerter.device"/></extension>
      <option gravity="0 0 0" timestep="{step!r}" integrator="RK4"/>
      <worldbody>{bodies}</worldbody>
      <tendon>
        <fixed name="pair" stiffness="{SPRING}">
          <joint joint="base" coef="-1"/><joint joint="mass" coef="1"/>
        </fixed>
      </tendon>
      <actuator>
        <plugin name="device" plugin="inerter.device" {target} actdim="{states}">{config}</plugin>
      </actuator>
    </mujoco>""".replace('actdim="0"', "")
    )
    data = mujoco.MjData(model)
    data.qpos[:], data.qvel[:] = system.start[:2], system.start[2:]
    data.act[:] = [system.states.get(name, 0.0) for name in SERIES_STATES[:states]]
    rows = [data.qpos.copy()]
    for _ in times[1:]:
        mujoco.mj_step(model, data, STEPS_PER_SAMPLE)
        rows.append(data.qpos.copy())
    return np.array(rows)


def in_exudyn(system: System, times: Array) -> Array:
    """The same by RK44."""
    exu: Any = pytest.importorskip("exudyn")
    items: Any = pytest.importorskip("exudyn.itemInterface")
    from inerter.exudyn import CreateInerter

    mbs = exu.SystemContainer().AddSystem()
    nodes = [
        mbs.AddNode(
            items.Node1D(
                referenceCoordinates=[0.0],
                initialCoordinates=[system.start[i]],
                initialVelocities=[system.start[2 + i]],
            )
        )
        for i in range(2)
    ]
    for node, mass in zip(nodes, (system.base, MASS), strict=True):
        mbs.AddObject(items.Mass1D(nodeNumber=node, mass=mass))
    ground, base, body = (
        mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=0))
        for node in (mbs.AddNode(items.NodePointGround()), *nodes)
    )
    for markers, stiffness in (([ground, base], system.base_spring), ([base, body], SPRING)):
        mbs.AddObject(items.CoordinateSpringDamper(markerNumbers=markers, stiffness=stiffness))
    CreateInerter(
        mbs,
        name="device",
        itemNumbers=[nodes[0] if system.between else None, nodes[1]],
        initialStates=system.states,
        **system.device,
    )
    sensors = [
        mbs.AddSensor(
            items.SensorNode(
                nodeNumber=node,
                outputVariableType=exu.OutputVariableType.Coordinates,
                storeInternal=True,
                writeToFile=False,
            )
        )
        for node in nodes
    ]
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = times[1]
    settings.timeIntegration.endTime = times[-1]
    settings.timeIntegration.numberOfSteps = STEPS_PER_SAMPLE * (len(times) - 1)
    assert mbs.SolveDynamic(settings, solverType=exu.DynamicSolverType.RK44)
    stored = [np.array(mbs.GetSensorStoredData(sensor)) for sensor in sensors]
    assert stored[0][:, 0] == pytest.approx(times, abs=1e-9)
    return np.array([column[:, 1] for column in stored]).T


ENGINES: dict[str, Callable[[System, Array], Array]] = {
    "reference": reference,
    "mujoco": in_mujoco,
    "exudyn": in_exudyn,
}
engines = pytest.mark.parametrize("engine", ENGINES)


def over(omega: float) -> Array:
    """Times of so many periods."""
    return np.linspace(0, PERIODS * 2 * np.pi / omega, PERIODS * SAMPLES + 1)


# RK4 with 400 steps in a period is late by (omega h)^4 / 120 of the phase: 6e-8 after 20 periods
BOUND = 2e-7


@engines
def test_inertance_to_the_ground(engine: str) -> None:
    """Motion X cos(omega t), omega = sqrt(k / (m + b)): the inertance adds to the mass."""
    omega = np.sqrt(SPRING / (MASS + INERTANCE))
    times = over(omega)
    found = ENGINES[engine](System(start=(0.0, 0.01, 0.0, 0.0)), times)
    assert abs(found[:, 1] / 0.01 - np.cos(omega * times)).max() < BOUND


@engines
def test_inertance_between_two_free_masses(engine: str) -> None:
    """Distance D cos(omega t), omega = sqrt(k / (mu + b)), 1 / mu = 1 / M + 1 / m."""
    other = 3.0
    omega = np.sqrt(SPRING / (MASS * other / (MASS + other) + INERTANCE))
    times = over(omega)
    shares = np.array([-MASS, other]) / (MASS + other)
    start = (0.01 * shares[0], 0.01 * shares[1], 0.0, 0.0)
    found = ENGINES[engine](System(base=other, between=True, start=start), times)
    true = np.outer(np.cos(omega * times), shares)
    assert abs(found / 0.01 - true).max() < BOUND


@engines
@pytest.mark.parametrize("ratio", [0.5, 1.0, 2.0])
def test_isolator(ratio: float, engine: str) -> None:
    """Spring and inerter side by side: x / y = (k - b omega^2) / (k - (m + b) omega^2).

    At omega = sqrt(k / b) the isolator transmits nothing: the mass never moves.
    """
    omega = ratio * np.sqrt(SPRING / INERTANCE)
    inner = SPRING - INERTANCE * omega**2
    share = inner / (inner - MASS * omega**2) if ratio != 1.0 else 0.0
    times = over(omega)
    system = System(
        base_spring=HEAVY * omega**2,
        between=True,
        start=(0.0, 0.0, 0.01 * omega, 0.01 * share * omega),
    )
    found = ENGINES[engine](system, times)
    true = np.outer(np.sin(omega * times), [1.0, share])
    assert abs(found / 0.01 - true).max() < BOUND * abs(true).max()


@engines
@pytest.mark.parametrize("ratio", [0.7, 1.0, 1.5])
def test_absorber(ratio: float, engine: str) -> None:
    """Spring k_s and inerter in series hold the mass at sqrt(k_s / b), like a tuned absorber.

    x / y = k (k_s - b omega^2) / [(k - m omega^2) (k_s - b omega^2) - k_s b omega^2]
    """
    omega = ratio * np.sqrt(SERIES / INERTANCE)
    shaft = SERIES - INERTANCE * omega**2 if ratio != 1.0 else 0.0
    drop = SERIES * INERTANCE * omega**2
    share = SPRING * shaft / ((SPRING - MASS * omega**2) * shaft - drop)
    deflection = (SPRING * (1 - share) + MASS * omega**2 * share) / SERIES
    times = over(omega)
    system = System(
        base_spring=HEAVY * omega**2,
        device={"inertance": INERTANCE, "series_stiffness": SERIES},
        start=(0.0, 0.0, 0.01 * omega, 0.01 * share * omega),
        states={"flywheel_velocity": 0.01 * (share - deflection) * omega},
    )
    found = ENGINES[engine](system, times)
    true = np.outer(np.sin(omega * times), [1.0, share])
    assert abs(found / 0.01 - true).max() < BOUND * abs(true).max()


@engines
@pytest.mark.parametrize("mode", [0, 1])
def test_modes_of_the_absorber(mode: int, engine: str) -> None:
    """Free motion in a mode: m b omega^4 - (k b + k_s b + k_s m) omega^2 + k k_s = 0."""
    middle = SPRING * INERTANCE + SERIES * (INERTANCE + MASS)
    squares = np.sort(np.roots([MASS * INERTANCE, -middle, SPRING * SERIES]))
    omega = np.sqrt(squares[mode])
    flywheel = SERIES / (SERIES - INERTANCE * omega**2)
    times = over(omega)
    system = System(
        device={"inertance": INERTANCE, "series_stiffness": SERIES},
        start=(0.0, 0.01, 0.0, 0.0),
        states={"series_deflection": 0.01 * (1 - flywheel)},
    )
    found = ENGINES[engine](system, times)
    assert abs(found[:, 1] / 0.01 - np.cos(omega * times)).max() < BOUND
