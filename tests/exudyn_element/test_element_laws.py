"""The element's own laws against the C core, and recorded as expressions against themselves."""

from __future__ import annotations

import functools
from typing import Any

import numpy as np
import pytest
from inerter.core import Device
from laws.core_draws import (  # pyright: ignore[reportMissingImports]
    LAWS,
    MEMORY,
    SEVERAL,
    draw_complete,
    draw_friction,
    draw_levels,
    draw_states,
)

pytest.importorskip("exudyn.itemInterface")

from element_systems import Array, line
from inerter.exudyn import CreateInerter
from inerter.exudyn import device as law
from inerter.exudyn.functions import NUMBERS
from inerter.exudyn.parameters import Parameters

SAME = 1e-11
"""Relative to the sizes of what is added up; 1e-13 is seen."""
POINTS = 8


@functools.cache
def devices(friction: str) -> list[tuple[Device, Array, Array]]:
    """Random complete devices with one friction law, motions (points, 3), states."""
    rng = np.random.default_rng((LAWS + SEVERAL).index(friction))
    found = []
    for _ in range(80):
        chosen = draw_complete(rng)
        for name in ("coulomb_force", "bristle_stiffness", "dahl_exponent"):
            chosen.pop(name, None)
        levels = draw_levels(rng)
        if friction in ("none", "bouc_wen"):
            levels = {"transition_velocity": levels["transition_velocity"]}
        chosen |= draw_friction(rng, friction) | levels
        motion = np.column_stack(
            [
                rng.normal(0.0, 0.02, POINTS),
                rng.normal(0.0, 1.0, POINTS) * 10 ** rng.uniform(-4, 0, POINTS),
                rng.normal(0.0, 10.0, POINTS),
            ]
        )
        if len(found) % 3 == 1:
            # by the direction of power
            backward = chosen.pop("load_friction")
            chosen |= {"mu_forward": float(rng.uniform(0.0, 2.0)), "mu_backward": backward}
        states = draw_states(rng, POINTS, chosen)
        if friction in MEMORY and len(found) % 2:
            # in the gap, at its edges, engaged
            half = chosen["friction_backlash"] = float(10 ** rng.uniform(-6, -2))
            inside, side = rng.uniform(-1, 1, POINTS), np.sign(states[:, 0])
            places = [half * inside, half * side, states[:, 0] + half * side]
            states[:, 0] = np.choose(rng.integers(0, 3, POINTS), places)
        device = Device(**chosen)
        if device.backlash:
            # what is a little outside belongs to solvers' steps, see below
            states[:, -1] = np.clip(states[:, -1], -device.backlash, device.backlash)
            if not device.series_damping:
                states[:, -1] = np.clip(states[:, -3], -device.backlash, device.backlash)
        if len(found) % 5 == 2:
            # viscoelastic branches, whose states are the last
            device = device.replace(
                branch_stiffness_1=2e4, branch_damping_1=500.0, branch_stiffness_2=3e3,
                branch_damping_2=900.0,
            )  # fmt: skip
            states = np.column_stack([states, rng.normal(0.0, 0.01, (POINTS, 2))])
        found.append((device, motion, states))
    return found


def telling(device: Device, x: float, v: float, a: float, z: Array) -> dict[str, float]:
    """All that the element says of a device at one point."""
    p, states = Parameters.of(device), z.tolist()
    stretch = x - device.rest_length
    said = law.forces(p, stretch, v, a, states)
    through = said["inertance"]
    said["stored_energy"] = law.stored_energy(p, stretch, v, states)
    said["dissipated_power"] = law.dissipated_power(NUMBERS, p, stretch, v, states, through)
    return said


def rigid(device: Device) -> bool:
    return "series_deflection" not in device.state_names


def core_telling(device: Device, motion: Array, states: Array) -> dict[str, Array]:
    x, v, a = motion.T
    return device.evaluate(x, v, a, states if device.nstate else 0.0)


@pytest.mark.parametrize("friction", LAWS + SEVERAL)
def test_forces_and_energies_are_the_cores(friction: str) -> None:
    worst: dict[str, float] = {}
    for device, motion, states in devices(friction):
        true = core_telling(device, motion, states)
        for i, (x, v, a) in enumerate(motion.tolist()):
            for name, value in telling(device, x, v, a, states[i]).items():
                scale = abs(true[name][i]) + 1e-3 * (1.0 + abs(true["inertance"][i]))
                worst[name] = max(worst.get(name, 0.0), abs(value - true[name][i]) / scale)
    assert len(worst) == 5
    assert max(worst.values()) < SAME, worst


@pytest.mark.parametrize("friction", LAWS + SEVERAL)
def test_terms_add_up_to_the_force_and_the_state_rates(friction: str) -> None:
    """What Exudyn integrates: mass times acceleration plus the terms, and the terms' rates."""
    for device, motion, states in devices(friction):
        p, true = Parameters.of(device), core_telling(device, motion, states)
        rates = true["state_rate"].reshape(POINTS, -1)
        for i, (x, v, a) in enumerate(motion.tolist()):
            stretch, z = x - device.rest_length, states[i].tolist()
            total, found = 0.0, np.zeros(device.nstate)
            for term in law.terms(NUMBERS, p, stretch, v, z, a):
                total += term.terminals * term.value
                for place, share in term.rates:
                    found[place] += share * term.value
            sign = np.sign(true["inertance"][i])
            rubbed = law.states_of(p, z).friction
            total += law.mass(NUMBERS, p, stretch, v, sign, rubbed) * a
            if rigid(device):
                total += law.load_rest(NUMBERS, p, stretch, v, sign, rubbed)
            assert total == pytest.approx(true["total"][i], rel=SAME, abs=SAME * 1e3)
            for name, rate, expected in zip(device.state_names, found, rates[i], strict=False):
                if name == "gap_position" and not device.series_damping:
                    # it follows from the deflection, GetStates says it
                    assert rate == 0.0
                else:
                    assert rate == pytest.approx(expected, rel=SAME, abs=SAME)


def test_a_gap_position_beyond_the_edge() -> None:
    """A step may end there: force and heat are the edge's, and the position is drawn back."""
    values: dict[str, Any] = {
        "inertance": 5.0, "series_stiffness": 1e4, "series_damping": 20.0, "backlash": 1e-3,
    }  # fmt: skip
    p = Parameters.of(Device(**values))
    for side in (1.0, -1.0):
        for speed in (0.5, -0.5):
            z = [side * 3e-3, speed, side * 1e-3]
            past = [side * 3e-3, speed, side * 1.1e-3]
            assert law.forces(p, 0.0, 0.1, 0.0, past) == law.forces(p, 0.0, 0.1, 0.0, z)
            edge, beyond = (law.terms(NUMBERS, p, 0.0, 0.1, at)[-2].value for at in (z, past))
            assert beyond - edge == pytest.approx(-side * 1e-4 * 1e4 / 20.0)


def test_more_coordinates_than_exudyn_evaluates_by_itself() -> None:
    values: dict[str, Any] = {f"slip_stiffness_{i}": 1e4 for i in range(1, 7)}
    values |= {f"slip_force_{i}": 1.0 for i in range(1, 7)}
    system = line([2.0, 3.0], [0.0, 0.0])
    with pytest.raises(ValueError, match=r"at most 7 coordinates \(here 8\)"):
        CreateInerter(
            system.mbs, "d", system.parts, friction="maxwell_slip", symbolic=True, **values
        )
    strut = CreateInerter(system.mbs, "d", system.parts, friction="maxwell_slip", **values)
    assert not strut.symbolic


@pytest.mark.parametrize("heat", [False, True])
@pytest.mark.parametrize("friction", LAWS + SEVERAL)
def test_three_ways_to_evaluate_are_one(friction: str, heat: bool) -> None:
    """Plain numbers, the tape in C, and matrices with expressions that Exudyn evaluates."""
    compared = 0
    for device, motion, states in devices(friction)[::4]:
        system = line([2.0, 3.0], [0.0, 0.0])
        given: dict[str, Any] = device.given
        if rigid(device):
            # that one Exudyn cannot evaluate by itself
            for name in ("load_friction", "mu_forward", "mu_backward"):
                given.pop(name, None)
        # more coordinates than Exudyn evaluates by itself
        several = 2 + device.nstate + heat > 7
        made = [
            CreateInerter(
                system.mbs, f"d{symbolic}", system.parts, symbolic=symbolic, dissipatedEnergy=heat,
                **given,
            )
            for symbolic in (None if several else True, False)
        ]  # fmt: skip
        system.mbs.Assemble()
        element, items = made[0].element, [each.functions for each in made]
        for i, (x, v, _) in enumerate(motion.tolist()):
            z = dict(zip(device.state_names, states[i].tolist(), strict=True))
            q, q_t = coordinates(element, x, v, z)
            plain = np.array(element.record(NUMBERS, q, q_t).forces)
            found = [forces(system.mbs, item, q, q_t) for item in items]
            scale = SAME * np.abs(plain).max()
            for each in found:
                np.testing.assert_allclose(each, plain, rtol=SAME, atol=scale)
            compared += 1
    assert compared == 20 * POINTS


def coordinates(
    element: Any, x: float, v: float, states: dict[str, float]
) -> tuple[list[float], list[float]]:
    """Coordinates and velocities at a length, its rate and the device's states."""
    stretch = x - element.device.rest_length
    own = [0.3 if name == "dissipated_energy" else states[name] for name in element.own]
    places = [
        stretch - states["series_deflection"] if name == "flywheel_velocity" else 0.0
        for name in element.own
    ]
    return [-0.4 * x, 0.6 * x, *places], [-0.1 * v, 0.9 * v, *own]


def forces(mbs: Any, functions: Any, q: list[float], q_t: list[float]) -> Array:
    """What an ObjectGenericODE2 with these parameters does, and the connector if there is one."""
    item = functions.parameters
    total = np.zeros(len(q))
    if len(item.get("forceVector", [])):
        total += item["forceVector"]
    if function := item["forceUserFunction"]:
        evaluate = getattr(function, "Evaluate", function)
        total += evaluate(mbs, 0.0, 0, q, q_t)
    if function := functions.spring_force:
        between = function.Evaluate(mbs, 0.0, 0, q[1] - q[0], q_t[1] - q_t[0], 0.0, 0.0, 0.0)
        total[:2] += between, -between
    for name, values in (("stiffnessMatrix", q), ("dampingMatrix", q_t)):
        if len(item.get(name, [])):
            total -= item[name] @ values
    return total
