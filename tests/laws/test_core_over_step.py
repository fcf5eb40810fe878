"""The core's force over a step: consistent, continuous, never falling, stable however stiff.

A mass on the device is stepped by a = a0 - mobility F(a), as an implicit integrator does it.
"""

from collections.abc import Callable

import numpy as np
import pytest
from core_draws import (
    LAWS,
    MEMORY,
    Parameters,
    draw_complete,
    draw_friction,
    draw_points,
    draw_states,
    state_limit,
)
from core_telling import Array
from inerter.core import Device
from scipy.integrate import solve_ivp
from scipy.optimize import root_scalar

FORCES = ("total", "inertance", "friction")


def drawn(rng: np.random.Generator, law: str) -> tuple[Parameters, float, float, float, Array]:
    """A complete device with a friction law, and a point x, v, a, z, the bristle in its range."""
    p = draw_complete(rng) | {"transition_velocity": 0.02}
    for name in ("friction", "coulomb_force", "bristle_stiffness", "dahl_exponent"):
        p.pop(name, None)
    p |= draw_friction(rng, law)
    z = draw_states(rng, 1, p)[0]
    if law in MEMORY:
        z[0] = state_limit(p) * rng.uniform(-0.95, 0.95)
    if p.get("backlash"):
        z[-1] = np.clip(z[-1], -p["backlash"], p["backlash"])
    x, v, a, _ = draw_points(rng, 1, 1.0, 0.5)
    return p, float(x[0]), float(v[0]), float(a[0]), z


def not_falling(p: Parameters) -> Parameters:
    """The same without what lets a law fall with speed: Stribeck, micro-damping, A beyond 1."""
    changed = dict(p)
    if "static_force" in p and p["friction"] != "stribeck":
        changed["static_force"] = p["coulomb_force"]
    if "bristle_damping" in p:
        changed["bristle_damping"] = 0.0
    if "bw_ratio" in p:
        changed["bw_ratio"] = float(np.clip(p["bw_ratio"], 0.0, 0.9))
    return changed


# ------------------------------ consistency ------------------------------


@pytest.mark.parametrize("law", LAWS)
def test_a_short_step_is_the_force_itself(law: str) -> None:
    rng = np.random.default_rng(LAWS.index(law))
    orders = []
    for _ in range(80):
        p, x, v, a, z = drawn(rng, law)
        device = Device(**p)
        now = device.evaluate(x, v, a, z)
        size = sum(abs(now[name][0]) for name in FORCES) + 1.0
        errors = []
        # friction at a flywheel of little inertance (down to 0.05 kg here) stops it within 1e-7 s
        short = 1e-9 if p.get("friction_side") == "flywheel" else 1e-7
        for h in (short, 0.1 * short, 0.0):
            force, end = device.over_step(x, v, a, z, h, 0.1)
            errors.append(max(abs(force[name] - now[name][0]) for name in FORCES))
        np.testing.assert_array_equal(end, z)
        assert errors[2] == 0.0
        assert errors[0] < 0.05 * size, p
        assert errors[1] < 0.005 * size, p
        if errors[1] > 1e-10 * size:
            orders.append(np.log10(errors[0] / errors[1]))
    # first order
    assert np.median(orders) == pytest.approx(1.0, abs=0.02)


@pytest.mark.parametrize("law", ["none", *MEMORY])
def test_states_at_the_end_are_those_of_the_equations(law: str) -> None:
    # one step is wrong by h^2: first order over a run
    rng = np.random.default_rng(10 + LAWS.index(law))
    orders, worst = [], []
    for _ in range(25):
        p, x, v, a, z = drawn(rng, law)
        device = Device(**p)
        if not device.nstate:
            continue

        def rates(
            t: float, state: Array, device: Device = device, x: float = x, v: float = v,
            a: float = a,
        ) -> Array:  # fmt: skip
            now = device.evaluate(x + v * t + a * t**2 / 2.0, v + a * t, a, state[np.newaxis])
            return now["state_rate"][0]

        speed = np.max(abs(rates(0.0, z)) / (abs(z) + 1e-3)) + 10.0
        h = 1e-2 / speed
        errors = []
        for part in (1.0, 0.25):
            run = solve_ivp(rates, (0.0, part * h), z, rtol=1e-9, atol=1e-13, method="LSODA")
            _, end = device.over_step(x, v, a, z, part * h, 0.1)
            errors.append(np.max(abs(end - run.y[:, -1]) / (abs(z) + 1e-3)))
        worst.append(errors[0])
        if errors[1] > 1e-9:
            orders.append(np.log(errors[0] / errors[1]) / np.log(4.0))
    # where the play opens or closes within a step the error is larger
    assert np.median(worst) < 1e-2
    assert np.median(orders) == pytest.approx(2.0, abs=0.15)


def test_dampers_and_stops_are_taken_at_the_end() -> None:
    device = Device(
        inertance=10.0, viscous=3.0, quadratic_damping=2.0, stiffness=7.0, flywheel_viscous=5.0,
        stop_upper=0.1, stop_stiffness=1e3, stop_damping=0.5, load_friction=0.1,
    )  # fmt: skip
    x, v, a, h = 0.099, 0.1, 4.0, 0.05
    end = v + h * a
    depth = x + h * end - 0.1
    inertance = 10.0 * a + 5.0 * end
    parallel = 3.0 * end + 2.0 * end**2 + 7.0 * x + 1e3 * depth * (1.0 + 0.5 * end)
    force, _ = device.over_step(x, v, a, 0.0, h, 1.0)
    assert force["inertance"] == pytest.approx(inertance)
    assert force["friction"] == pytest.approx(0.1 * inertance)
    assert force["total"] == pytest.approx(1.1 * inertance + parallel)


def test_series_step_by_hand() -> None:
    # least implicit share: h^2 k (mobility + 1 / b) = 1.5, so 1 / 3
    b, k, c, h, mobility = 10.0, 1e6, 40.0, 1e-3, 1.4
    device = Device(inertance=b, series_stiffness=k, series_damping=c)
    s, w, v, a = 1e-3, 0.2, 0.5, -30.0
    end = v + h * a
    slope = h * k / 3.0 + c
    after = (b / h * w + k * s + slope * end) / (b / h + slope)
    force, states = device.over_step(0.0, v, a, [s, w], h, mobility)
    assert force["total"] == pytest.approx(k * s + slope * (end - after))
    assert states == pytest.approx([s + h * (end - after), after])
    # resolved: the spring is explicit
    force, states = device.over_step(0.0, v, a, [s, w], 1e-4, mobility)
    end = v + 1e-4 * a
    after = (b / 1e-4 * w + k * s + c * end) / (b / 1e-4 + c)
    assert force["total"] == pytest.approx(k * s + c * (end - after))


# ------------------------------ a function that can be solved ------------------------------


def force_of(device: Device, x: float, v: float, z: Array, h: float) -> Callable[[float], float]:
    return lambda a: device.over_step(x, v, a, z, h, 0.1)[0]["total"]


@pytest.mark.parametrize("law", LAWS)
def test_force_never_falls_with_the_acceleration(law: str) -> None:
    rng = np.random.default_rng(20 + LAWS.index(law))
    for _ in range(60):
        p, x, v, _, z = drawn(rng, law)
        device = Device(**not_falling(p))
        if "static_force" in p and law in MEMORY:
            z[0] *= p["coulomb_force"] / p["static_force"]
        h = float(10.0 ** rng.uniform(-5.0, -1.5))
        force = force_of(device, x, v, z, h)
        # around where the velocity at the end is 0, from very near to far
        near = -v / h + np.geomspace(1e-4, 1e2, 150) / h
        a = np.sort(np.concatenate([near, -2.0 * v / h - near]))
        found = np.array([force(value) for value in a])
        rounding = 1e-13 * (np.max(abs(found)) + device.inertance * np.max(abs(a)))
        assert np.all(np.diff(found) >= -rounding), (p, h, np.min(np.diff(found)))


@pytest.mark.parametrize("law", LAWS)
def test_force_and_end_are_continuous_in_the_acceleration(law: str) -> None:
    # halve the interval with the larger difference: at a jump it would stay
    rng = np.random.default_rng(30 + LAWS.index(law))
    for _ in range(60):
        p, x, v, _, z = drawn(rng, law)
        device = Device(**p)
        h = float(10.0 ** rng.uniform(-5.0, -1.5))
        force = force_of(device, x, v, z, h)
        span = float(10.0 ** rng.uniform(-2.0, 1.0)) / h
        low, high = -v / h - span, -v / h + span
        whole = abs(force(high) - force(low)) + 1e-6
        for _ in range(45):
            middle = 0.5 * (low + high)
            first, second = abs(force(middle) - force(low)), abs(force(high) - force(middle))
            low, high = (low, middle) if first > second else (middle, high)
        rest = abs(force(high) - force(low))
        assert rest < 1e-6 * whole + 1e-10 * (abs(force(low)) + device.inertance * span), p


@pytest.mark.parametrize("asymmetry", [-0.9, 0.0, 0.9])
def test_what_falls_with_speed_is_that_of_the_start(asymmetry: float) -> None:
    device = Device(
        friction="stribeck", coulomb_force=5.0, static_force=20.0, stribeck_velocity=0.05,
        transition_velocity=1e-3, friction_asymmetry=asymmetry,
    )  # fmt: skip
    h, a = 1e-3, np.linspace(-500.0, 500.0, 2001)
    for v in (0.0, 0.01, -0.05, 0.2):
        force = force_of(device, 0.0, v, np.zeros(0), h)
        found = np.array([force(value) for value in a])
        assert np.all(np.diff(found) >= 0.0)
        # against the motion at the end of the step, so that it only takes energy
        assert np.all(found * (v + h * a) >= 0.0)
        # and of the law itself where the speed does not change
        assert force(0.0) == pytest.approx(
            device.evaluate(0.0, v, 0.0, np.zeros((1, 0)))["total"][0], rel=1e-12
        )


# ------------------------------ stability ------------------------------


class Mass:
    """A mass on the device, held by nothing else; a constant force may push it."""

    def __init__(self, device: Device, mass: float, v: float = 0.0, x: float = 0.0) -> None:
        self.device, self.mass, self.x, self.v = device, mass, x, v
        self.z = np.zeros(device.nstate)

    def step(self, h: float, push: float = 0.0) -> float:
        """One implicit step; the force of the device."""
        mobility = 1.0 / self.mass

        def rest(a: float) -> float:
            force, _ = self.device.over_step(self.x, self.v, a, self.z, h, mobility)
            return a - mobility * (push - force["total"])

        width = 1.0
        while rest(-width) > 0.0 or rest(width) < 0.0:
            width *= 8.0
        a = root_scalar(rest, bracket=(-width, width), xtol=1e-12, rtol=1e-14).root
        force, self.z = self.device.over_step(self.x, self.v, a, self.z, h, mobility)
        self.v += h * a
        self.x += h * self.v
        return force["total"]

    @property
    def energy(self) -> float:
        stored = self.device.evaluate(self.x, self.v, 0.0, self.z)["stored_energy"][0]
        return float(stored) + 0.5 * self.mass * self.v**2


@pytest.mark.parametrize("stiffness", [1e3, 1e5, 1e6, 4e6, 1e8, 1e10, 1e12])
@pytest.mark.parametrize("damping", [0.0, 50.0, 1e5])
@pytest.mark.parametrize("backlash", [0.0, 1e-5, 1e-3])
def test_stable_at_any_stiffness(stiffness: float, damping: float, backlash: float) -> None:
    # mass 1 kg thrown at an inertance of 10 kg behind the spring, h = 1 ms
    device = Device(
        inertance=10.0, series_stiffness=stiffness, series_damping=damping, backlash=backlash
    )
    mass = Mass(device, 1.0, v=1.0)
    energy = []
    for _ in range(600):
        mass.step(1e-3)
        energy.append(mass.energy)
        # momentum is kept by every step
        assert mass.v + 10.0 * mass.z[1] == pytest.approx(1.0, abs=1e-9)
    # at h omega = 1 the energy of a neutral step swings by 2 / 3 about its mean
    assert max(energy) < 0.5 * 1.7
    assert max(energy[-100:]) <= max(energy[:100]) * (1.0 + 1e-4)
    if stiffness >= 4e6:
        # not resolved: both move as one, but for the play
        assert mass.energy == pytest.approx(0.5 / 11.0, rel=2e-3)
        assert backlash > 0.0 or mass.v == pytest.approx(1.0 / 11.0, rel=1e-6)


@pytest.mark.parametrize("backlash", [0.0, 1e-6])
def test_stiffer_and_stiffer_is_the_ideal_inerter(backlash: float) -> None:
    # a force of 5 N on the mass: a = 5 / (m + b)
    errors = []
    for stiffness in (1e7, 1e8, 1e9, 1e12):
        device = Device(
            inertance=10.0, series_stiffness=stiffness, series_damping=20.0, backlash=backlash
        )
        mass = Mass(device, 1.0)
        force = 0.0
        for _ in range(300):
            force = mass.step(1e-3, push=5.0)
        assert force == pytest.approx(50.0 / 11.0, rel=1e-6)
        errors.append(abs(mass.v - 0.3 * 5.0 / 11.0))
    assert errors[-1] < 1e-9 + 10.0 * backlash
    assert errors[0] < 1e-4 + 10.0 * backlash


@pytest.mark.parametrize("law", MEMORY)
@pytest.mark.parametrize("stiffness", [1e4, 1e7, 1e11])
def test_stiff_bristles_hold_a_mass(law: str, stiffness: float) -> None:
    # pushed below the level of friction it stays, above it slides at (push - level) / mass
    bristle = {"coulomb_force": 10.0, "bristle_stiffness": stiffness}
    yielding = {"bw_stiffness": stiffness}
    yielding |= {"bw_beta": stiffness / 20.0, "bw_gamma": stiffness / 20.0}
    device = Device(friction=law, **(yielding if law == "bouc_wen" else bristle))
    mass = Mass(device, 2.0)
    for _ in range(400):
        mass.step(1e-3, push=6.0)
    held = 10.0 / stiffness * np.log(10.0 / 4.0)
    assert abs(mass.v) < 5.0 * np.sqrt(10.0 / stiffness)
    assert abs(mass.x) < 5.0 * held + 1e-6
    sliding = Mass(device, 2.0)
    for _ in range(400):
        sliding.step(1e-3, push=16.0)
    assert sliding.v == pytest.approx(0.4 * 3.0, rel=0.1)
    assert sliding.v / 0.4 == pytest.approx(3.0, abs=0.3 + 30.0 / np.sqrt(stiffness))


@pytest.mark.parametrize("stiffness", [1e3, 1e6, 1e10])
@pytest.mark.parametrize("damping", [0.0, 1.0, 1e3])
def test_stops_of_any_stiffness_bring_a_mass_back(stiffness: float, damping: float) -> None:
    device = Device(
        inertance=1.0, stop_lower=-0.02, stop_upper=0.02, stop_stiffness=stiffness,
        stop_damping=damping,
    )  # fmt: skip
    mass = Mass(device, 1.0, v=1.0)
    reach = 0.0
    energy = [mass.energy]
    for _ in range(1500):
        mass.step(1e-3)
        reach = max(reach, abs(mass.x))
        energy.append(mass.energy)
    # a spring takes the mass to v sqrt(m / k), a step at most v h further
    assert reach < 0.02 + np.sqrt(2.0 / stiffness) + 1e-3
    # implicit stops take energy, they give none
    assert np.all(np.diff(energy) < 1e-9)


@pytest.mark.parametrize("h", [2e-3, 1e-3, 5e-4, 1e-4])
def test_a_stop_without_damping_takes_what_a_backward_step_does(h: float) -> None:
    # half a period of an oscillator of omega, whose amplitude falls by sqrt(1 + (omega h)^2) a step
    mass = Mass(Device(inertance=1.0, stop_upper=0.0, stop_stiffness=1e5), 2.0, v=1.0, x=-1e-9)
    while mass.v > 0.0 or mass.x > 0.0:
        mass.step(h)
    omega = np.sqrt(1e5 / 3.0)
    assert -mass.v == pytest.approx(np.exp(-np.pi * omega * h / 2.0), abs=0.03)


def test_thin_channels_and_quick_flywheels_stay_put() -> None:
    # flywheel damping of any size, beside the inertance and behind a spring
    for series in ({}, {"series_stiffness": 1e4}, {"series_damping": 1e6}):
        for viscous in (1e3, 1e9):
            device = Device(inertance=1.0, flywheel_viscous=viscous, **series)
            mass = Mass(device, 1.0, v=1.0)
            energy = [mass.energy]
            for _ in range(300):
                mass.step(1e-3)
                energy.append(mass.energy)
            assert max(np.diff(energy)) < 0.06
            assert energy[-1] < energy[0]


@pytest.mark.parametrize("damping", [0.0, 20.0])
def test_backlash_takes_no_energy_out_of_nothing(damping: float) -> None:
    # a mass on a spring, the flywheel rattling in its play: whatever cycle it finds, it fades
    for stiffness in (1e4, 1e6, 1e9):
        device = Device(
            inertance=0.5, series_stiffness=stiffness, series_damping=damping, backlash=1e-3,
            stiffness=400.0,
        )  # fmt: skip
        mass = Mass(device, 1.0, x=0.01)
        energy = []
        for _ in range(3000):
            mass.step(1e-3)
            energy.append(mass.energy)
        peaks = [max(energy[i : i + 500]) for i in range(0, 3000, 500)]
        assert peaks[0] < 1.1 * 0.5 * 400.0 * 0.01**2
        assert np.all(np.diff(peaks) <= 1e-9), (stiffness, peaks)


@pytest.mark.parametrize("mobility", [0.0, 1e-3, 20.0])
def test_a_bristle_that_bends_within_the_step_gives_no_more_than_it_can(mobility: float) -> None:
    """LuGre: what the damper of a bristle adds over a step is its change of length per step.

    At 0.07 m/s this one is bent in 4e-6 s. sigma1 v, the damper's force before it has bent, is
    5000 times its level.
    """
    level, stiffness, damping, h = 0.0089, 31_300.0, 610.0, 2e-3
    device = Device(
        friction="lugre", inertance=0.0, coulomb_force=level, static_force=2 * level,
        stribeck_velocity=0.01, bristle_stiffness=stiffness, bristle_damping=damping,
    )  # fmt: skip
    for v in np.geomspace(1e-6, 10, 60):
        for bent in (-1.0, 0.0, 1.0):
            force, end = device.over_step(0.0, v, 0.0, bent * level / stiffness, h, mobility)
            most = 2 * level + damping * abs(end[0] - bent * level / stiffness) / h
            assert abs(force["total"]) <= most * (1 + 1e-12)
            assert abs(force["total"]) <= 2 * level * (1 + 2 * damping / (stiffness * h))
