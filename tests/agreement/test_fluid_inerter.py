"""The fluid inerter in MuJoCo, on its shaker and alone, against the printed equations.

The truth here is the paper's: coordinates x1 (piston), x2 (water), q (charge), typed anew.
    (m_a + m_p) x1'' = alpha_1 q' - c x1' - k x1 - f(x1') - S,   b x2'' = S - c_a x2' - k_a(x2) x2
    L q'' = V - R q' - alpha_2 x1',   S = k_f (x1 - x2) + c_f (x1' - x2')
The reference's models must agree with it as well.
"""

from __future__ import annotations

from collections.abc import Callable

import mujoco
import numpy as np
import pytest
from inerter.models import model_path
from inerter.reference import (
    FLUID_INERTER,
    SHAKER,
    FluidInerterTest,
    ReferenceDevice,
    complete_device,
    dry_device,
    sweep_voltage,
)
from scipy.integrate import solve_ivp
from shipped_runs import Array, compiled, error, path, stated

P, S = FLUID_INERTER, SHAKER
TIMES = np.arange(0, 1.0 + 1e-9, 0.01)
SHAKEN = {"dry": "model_dry_shaker.xml", "complete": "model_shaker.xml"}
PRELOAD = (300.0, P.piston_area * 0.016)  # c_a, V0 in the file


def friction(v: float) -> float:
    r = v / P.stribeck_velocity
    peak = (P.static_force - P.coulomb_force) * r / (r * r / 4 + 0.75) ** 2
    return P.coulomb_force * np.tanh(4 * r) + peak + P.viscous * v


def rates(state: Array, voltage: float, wet: bool, shaker: bool) -> list[float]:
    """Rates of (x1, x2, q, x1', x2', q') at a coil voltage; without shaker a force in its place."""
    x1, x2, _, v1, v2, i = state
    series = air = 0.0
    b = P.fluid_density * P.channel_length * P.piston_area**2 / P.channel_area
    if wet:
        stiffness = P.series_stiffness * (1 - P.series_hardening * (x2 - x1))
        series = stiffness * (x1 - x2) + P.series_damping * (v1 - v2)
        c_a, volume = PRELOAD
        share = P.piston_area / volume
        k_a = P.gas_exponent * P.gas_pressure * P.piston_area * share
        k_a *= 1 - (P.gas_exponent + 1) / 2 * share * x2
        air = c_a * v2 + k_a * x2
    if shaker:
        mass = S.armature_mass + P.piston_mass
        push = S.force_constant * i - S.damping * v1 - S.stiffness * x1
        i_rate = (voltage - S.resistance * i - S.voltage_constant * v1) / S.inductance
    else:
        mass, push, i_rate = P.piston_mass, voltage, 0.0
    return [v1, v2, i, (push - friction(v1) - series) / mass, (series - air) / b, i_rate]


def truth(
    voltage: Callable[[float], float], wet: bool, shaker: bool = True, start: float = 0.0
) -> Array:
    """Rows (x1, x1', i, q, x2, x2'); the piston starts at `start` [m] with the water."""
    initial = [start, start if wet else 0, 0, 0, 0, 0]
    found = solve_ivp(
        lambda t, y: rates(y, voltage(t), wet, shaker), (0, TIMES[-1]), initial, method="DOP853",
        t_eval=TIMES, rtol=1e-11, atol=1e-14,
    )  # fmt: skip
    return found.y[[0, 3, 5, 2, 1, 4]].T


def gained(t: float) -> float:
    """Voltage of the coil: the published sweep, from a second in, through the amplifier."""
    return S.gain * sweep_voltage(0.35, 0.55)(t + 2.0)


def seen(data) -> Array:
    """Piston, its velocity, current, water, its velocity."""
    x, v = data.joint("piston").qpos[0], data.joint("piston").qvel[0]
    if len(data.act) < 3:
        return np.array([x, v, data.act[0]])
    # the device's states: x - y and w; the coil's current stands last
    return np.array([x, v, data.act[2], x - data.act[0], data.act[1]])


@pytest.fixture(scope="module")
def shaken() -> dict[str, Array]:
    return {name: truth(gained, name == "complete") for name in SHAKEN}


@pytest.mark.parametrize(
    ("file", "device"),
    [
        ("model.xml", complete_device()),
        ("model_shaker.xml", complete_device()),
        ("model_charge.xml", complete_device()),
        ("model_dry.xml", dry_device()),
        ("model_dry_shaker.xml", dry_device()),
    ],
)
def test_the_model_has_the_published_numbers(file: str, device: ReferenceDevice) -> None:
    keys = stated("fluid_inerter", file, "device")
    assert keys["friction"] == "brown_mcphee"
    # exactly the keys that differ from a device without anything
    empty = ReferenceDevice()
    names = set(keys) | {n for n in vars(empty) if getattr(device, n) != getattr(empty, n)}
    for name in names:
        expected = getattr(device, name)
        assert keys.get(name, getattr(empty, name)) == (
            expected
            if isinstance(expected, str)
            else pytest.approx(expected, rel=1e-12, nan_ok=True)
        ), name
    model = mujoco.MjModel.from_xml_path(str(model_path("fluid_inerter", file)))
    if file != "model_charge.xml":
        assert model.body("piston").mass[0] == P.piston_mass


@pytest.mark.parametrize("file", SHAKEN.values())
def test_the_shaker_has_the_published_numbers(file: str) -> None:
    model = mujoco.MjModel.from_xml_path(str(model_path("fluid_inerter", file)))
    armature = model.tendon("armature").id
    assert model.tendon_armature[armature] == S.armature_mass
    assert model.tendon_stiffness[armature] == S.stiffness
    assert model.tendon_damping[armature] == S.damping
    coil = model.actuator("coil")
    assert coil.gainprm[0] == S.resistance
    assert coil.gainprm[1] == S.force_constant == S.voltage_constant
    assert coil.dynprm[0] == pytest.approx(S.inductance / S.resistance, rel=1e-15)


@pytest.mark.parametrize("name", SHAKEN)
def test_the_reference_is_the_printed_equations(name: str, shaken: dict[str, Array]) -> None:
    device = dry_device() if name == "dry" else complete_device()
    result = FluidInerterTest(device=device).simulate(
        lambda t: gained(t) / S.gain, TIMES, rtol=1e-9, atol=1e-13
    )
    found = np.column_stack([result.displacement, result.velocity, result.current])
    assert error(found, shaken[name][:, :3]) < 1e-6


@pytest.mark.parametrize("integrator", ["RK4", "implicitfast"])
@pytest.mark.parametrize("name", SHAKEN)
def test_sweep(name: str, integrator: str, shaken: dict[str, Array]) -> None:
    """First order in both: the engine steps the coil's current by itself, even within RK4.

    So the limit is looked at as well: extrapolated to step 0 the runs are right to 5e-5.
    """
    true = shaken[name][:, [0, 1, 2] if name == "dry" else [0, 1, 2, 4, 5]]
    runs = []
    for step in (1e-4, 5e-5):
        model = compiled("fluid_inerter", SHAKEN[name], integrator, step)
        runs.append(path(model, TIMES, seen, controls={"coil": gained}))
    errors = [error(run, true) for run in runs]
    assert errors[1] < 0.005
    assert 1.8 < errors[0] / errors[1] < 2.2
    assert error(2 * runs[1] - runs[0], true) < 5e-5


def test_the_current_is_the_rate_of_the_charge(shaken: dict[str, Array]) -> None:
    """The engine's state is q'; its integral is the coordinate of the printed equations."""
    model = compiled("fluid_inerter", SHAKEN["complete"], "RK4", 1e-4)
    data, charge, rows = mujoco.MjData(model), 0.0, []
    while data.time < TIMES[-1] + 1e-9:
        rows.append(charge)
        data.actuator("coil").ctrl = gained(data.time + 5e-5)
        before = data.act[2]
        mujoco.mj_step(model, data)
        charge += 5e-5 * (before + data.act[2])
    assert error(np.array(rows)[::100, None], shaken["complete"][:, 3:4]) < 1e-3


def test_the_spinning_table_has_the_published_numbers() -> None:
    """Masses, suspension and coil, once the particle and its centrifugal force are taken off."""
    model = mujoco.MjModel.from_xml_path(str(model_path("fluid_inerter", "model_charge.xml")))
    m, w = model.body("particle").mass[0], model.key("rest").qvel[0]
    piston, charge = model.joint("piston"), model.joint("charge")
    assert 2 * m * w == S.force_constant == S.voltage_constant
    assert piston.armature[0] + m == pytest.approx(S.armature_mass + P.piston_mass, rel=1e-14)
    assert charge.armature[0] + m == pytest.approx(S.inductance, rel=1e-14)
    assert piston.stiffness[0] - m * w * w == pytest.approx(S.stiffness, rel=1e-10)
    assert charge.stiffness[0] == m * w * w
    assert (piston.damping[0], charge.damping[0]) == (S.damping, S.resistance)


def test_charge_as_a_coordinate(shaken: dict[str, Array]) -> None:
    """Coriolis' force is the coupling of coil and piston; here RK4 keeps its order.

    The voltage is held over a step at its middle: second order.
    """

    def state(data) -> list[float]:
        piston, charge = data.joint("piston"), data.joint("charge")
        x = piston.qpos[0]
        return [
            x, piston.qvel[0], charge.qvel[0], charge.qpos[0], x - data.act[0], data.act[1]
        ]  # fmt: skip

    errors = []
    for step in (2e-4, 1e-4):
        model = compiled("fluid_inerter", "model_charge.xml", "RK4", step)
        turning = {"spin": model.key("rest").qvel[0]}
        found = path(model, TIMES, state, velocities=turning, controls={"coil": gained})
        errors.append(error(found, shaken["complete"]))
    assert errors[1] < 1e-5
    assert errors[0] / errors[1] > 3.5


def test_let_go() -> None:
    """The complete device alone, pushed in by 5 mm and let go: RK4, 1e-6."""
    found = path(
        compiled("fluid_inerter", "model.xml", "RK4", 1e-4),
        TIMES,
        lambda data: [*data.joint("piston").qpos, *data.joint("piston").qvel],
        positions={"piston": -0.005},
    )
    true = truth(lambda t: 0.0, wet=True, shaker=False, start=-0.005)
    assert error(found, true[:, :2]) < 1e-6


def test_a_force_on_the_dry_device() -> None:
    """120 N at 2 Hz on the piston; second order in the step."""

    def force(t: float) -> float:
        return 120.0 * float(np.sin(4 * np.pi * t))

    true = truth(force, wet=False, shaker=False)[:, :2]
    errors = []
    for step in (2e-4, 1e-4):
        model = compiled("fluid_inerter", "model_dry.xml", "RK4", step)
        found = path(
            model, TIMES, lambda data: [*data.joint("piston").qpos, *data.joint("piston").qvel],
            controls={"force": force},
        )  # fmt: skip
        errors.append(error(found, true))
    assert errors[1] < 1e-5
    assert errors[0] / errors[1] > 3.5
