"""The effects that are tried around a device: of the vehicle, its inputs and its channels."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from inerter.catalogue.scales import Range
from inerter.diagnose.vehicle.candidate import VehicleCandidate, candidate
from inerter.diagnose.vehicle.model import TYRES, VehicleModel
from inerter.diagnose.vehicle.parts import Suspension, Tyre
from inerter.diagnose.vehicle.sensing import EVERY_CHANNEL

if TYPE_CHECKING:
    from inerter.diagnose.vehicle.effects import Effects

_GRAVITY = 9.81
_GAINS = 0.1, 10.0  # of one channel, which nobody overlooks beyond
MOST_DELAY = 0.05  # s, of one channel


def _tyres(effects: Effects, model: VehicleModel) -> Iterator[VehicleCandidate]:
    for tyre in effects.user.parts.tyres:
        stiffness = effects.stated(f"{tyre.element}.tyre_stiffness", model)
        rate = _wheel_rate(effects, tyre)
        now = effects.stated(f"{tyre.element}.tyre_damping", model)
        yield candidate(
            "tyre_damping", tyre.element, [{"tyre_damping": now + 0.03 * stiffness / rate}],
            {"tyre_damping": Range(0.1 * stiffness / rate, 0.0)}, ("tyre_damping",),
        )  # fmt: skip
        yield candidate(
            "tyre_stiffness_error", tyre.element, [{"tyre_stiffness": 1.05 * stiffness}],
            {"tyre_stiffness": Range(stiffness, 0.02 * stiffness)}, ("tyre_stiffness",),
        )  # fmt: skip
        load = _GRAVITY * effects.loads.get(tyre.element, 0.0)
        if load > 0:
            # without gravity in the model, forces count from the static load
            weightless = not np.any(effects.user.model.opt.gravity)
            size = Range(load, 1e-3 * load if weightless else -0.5 * load, 5 * load, weightless)
            starts = (1.0, 0.6, 0.3) if weightless else (0.0, 0.1)
            yield candidate(
                "tyre_liftoff", tyre.element, [{"tyre_static_load": r * load} for r in starts],
                {"tyre_static_load": size}, (),
            )  # fmt: skip


def _road(effects: Effects, model: VehicleModel) -> Iterator[VehicleCandidate]:
    """What all tyres do to the road, and the stiffness of a spring to a mocap body."""
    user = effects.user
    for link in user.parts.road_springs:
        stiffness = effects.stated(f"{link.element}.tyre_stiffness", model)
        yield candidate(
            "tyre_stiffness_error", link.element, [{"tyre_stiffness": 1.05 * stiffness}],
            {"tyre_stiffness": Range(stiffness, 0.02 * stiffness)}, ("tyre_stiffness",),
        )  # fmt: skip
    if user.parts.tyres or user.tables:
        # a wave shrinks with the square of what is covered: starts of two sizes
        name, starts, most = ("patch_length", (0.1, 0.3), 1.5) if effects.speed else (
            "patch_time", (0.006, 0.02), 0.15)  # fmt: skip
        yield candidate(
            "tyre_enveloping", TYRES, [{name: start} for start in starts],
            {name: Range(starts[0], 0.1 * starts[0], most, logarithmic=True)}, (),
        )  # fmt: skip


def _wheel_rate(effects: Effects, tyre: Tyre) -> float:
    """Wheel hop [rad/s]."""
    part = next((p for p in effects.user.parts.suspensions if p.tyre == tyre), None)
    if part is None:
        return 60.0
    return float(np.sqrt(tyre.stiffness / effects.user.model.body_mass[part.wheel]))


def _suspensions(effects: Effects, model: VehicleModel) -> Iterator[VehicleCandidate]:
    user = effects.user
    bodies = set()
    for part in user.parts.suspensions:
        yield from _damper(effects, part, model)
        yield from _spring(effects, part, model)
        bodies |= {(part.body, "body_mass_error"), (part.wheel, "wheel_mass_error")}
    for index, effect in sorted(bodies, key=lambda pair: pair[1]):
        element = user.body(index)
        mass = user.stated[f"{element}.mass"]
        yield candidate(
            effect, element, [{"mass": 1.05 * effects.stated(f"{element}.mass", model)}],
            {"mass": Range(mass, 0.05 * mass)}, ("mass",),
        )  # fmt: skip


def _damper(effects: Effects, part: Suspension, model: VehicleModel) -> Iterator[VehicleCandidate]:
    if part.damper is None:
        return
    link = part.damper
    now = effects.damping(part.device, model)
    sizes = {"rebound_damping": Range(now, 0.0), "bump_damping": Range(now, 0.0)}
    starts = [
        {"rebound_damping": r * now, "bump_damping": b * now} for r, b in ((1.1, 0.9), (1.1, 1.0))
    ]
    yield candidate(
        "damper_asymmetry", part.device, starts, sizes, ("rebound_damping", "bump_damping")
    )
    # one that bends has all of the damping in the device
    if link.kind != "device" and not model.bends(part.device):
        yield candidate(
            "viscous_friction", link.element, [{"damping": 1.05 * now}],
            {"damping": Range(now, 0.0)}, ("damping",),
        )  # fmt: skip


def _spring(effects: Effects, part: Suspension, model: VehicleModel) -> Iterator[VehicleCandidate]:
    if part.spring is None:
        return
    link, scale = part.spring, effects.scales[part.device]
    name = f"{link.element}.stiffness"
    now = effects.stated(name, model)
    cubic = Range(max(now, 0.1 * scale.force / scale.x) / scale.x**2)
    before = effects.stated(f"{link.element}.stiffness_cubic", model)
    yield candidate(
        "spring_hardening", link.element, [{"stiffness_cubic": before + 0.02 * cubic.size}],
        {"stiffness_cubic": cubic}, ("stiffness_cubic",),
    )  # fmt: skip
    if link.kind != "device":
        yield candidate(
            "parallel_stiffness", link.element, [{"stiffness": 1.05 * now}],
            {"stiffness": Range(now, 0.0)}, ("stiffness",),
        )  # fmt: skip


def _guides(effects: Effects, model: VehicleModel) -> Iterator[VehicleCandidate]:
    """Friction and damping of the joints on which a wheel or a body moves."""
    user = effects.user
    for index in user.guides:
        element, scale = user.joint(index), next(iter(effects.scales.values()))
        for effect, size in (
            ("joint_friction", 0.1 * scale.force), ("joint_damping", 0.1 * scale.force / scale.v)
        ):  # fmt: skip
            now = effects.stated(f"{element}.{effect}", model)
            yield candidate(
                effect, element, [{effect: now + 0.5 * size}], {effect: Range(size, 0.0)},
                (effect,),
            )  # fmt: skip


def _forces(effects: Effects, model: VehicleModel) -> Iterator[VehicleCandidate]:
    """A recorded force that acts with another size, or later."""
    user = effects.user
    for index in user.forces:
        element = user.actuator(index)
        now = effects.stated(f"{element}.actuator_gain", model)
        yield candidate(
            "actuator_gain_error", element, [{"actuator_gain": 1.05 * now}],
            {"actuator_gain": Range(1.0, -3.0, 3.0)}, ("actuator_gain",),
        )  # fmt: skip
        step = float(user.model.opt.timestep)
        yield candidate(
            "actuator_lag", element, [{"actuator_lag": r * step} for r in (2.0, 10.0)],
            {"actuator_lag": Range(10 * step, 0.5 * step, 500 * step, logarithmic=True)}, (),
        )  # fmt: skip


def _channels(effects: Effects, model: VehicleModel) -> Iterator[VehicleCandidate]:
    """One channel that is late, or early, of all others, or shows less of what is fast, or of all.

    The road's may show another size, too. All together are late, or early, of a road or a drive
    that was recorded with another clock.
    """
    del model
    if len(effects.columns) > 1:
        spacing = max(effects.columns.values())
        yield candidate(
            "sensor_delay", EVERY_CHANNEL, [{"delay": spacing}, {"delay": -spacing}],
            {"delay": Range(spacing, -MOST_DELAY, MOST_DELAY)}, ("delay",),
        )  # fmt: skip
    for column in (*effects.columns, *effects.roads):
        yield candidate(
            "sensor_gain_error", f"channel:{column}", [{"gain": 1.05}],
            {"gain": Range(1.0, *_GAINS)}, ("gain",),
        )  # fmt: skip
    for column, spacing in effects.columns.items():
        element, most = f"channel:{column}", 0.4 / spacing
        yield candidate(
            "sensor_delay", element, [{"delay": spacing}],
            {"delay": Range(spacing, -MOST_DELAY, MOST_DELAY)}, ("delay",),
        )  # fmt: skip
        frequency = Range(0.1 * most, 0.01 * most, 2 * most, logarithmic=True)
        starts = (0.1 * most, 0.3 * most)
        yield candidate(
            "sensor_filter", element, [{"filter_frequency": start} for start in starts],
            {"filter_frequency": frequency}, (),
        )  # fmt: skip
        if column in effects.shaken:
            loss = Range(0.1, 5e-3, 3.0, logarithmic=True)
            yield candidate(
                "sensor_compliance", element,
                [{"mount_frequency": start, "mount_loss": 0.1} for start in starts],
                {"mount_frequency": frequency, "mount_loss": loss}, (),
            )  # fmt: skip
        for axis in effects.shaken.get(column, ""):
            name = f"angle_toward_{axis}"
            yield candidate(
                "mounting_angle", element, [{name: 0.05}], {name: Range(0.1, -0.8, 0.8)}, (name,),
                law=axis,
            )  # fmt: skip


def around(effects: Effects, model: VehicleModel) -> Iterator[VehicleCandidate]:
    """Everything around the devices that can be tried."""
    for build in (_tyres, _road, _suspensions, _guides, _forces, _channels):
        yield from build(effects, model)
