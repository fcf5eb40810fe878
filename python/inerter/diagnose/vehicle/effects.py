"""The effects that are tried in a user's model: what they are, and where their fits start."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field

import numpy as np

from inerter.catalogue.coordinates import COORDINATES
from inerter.catalogue.friction import FRICTION
from inerter.catalogue.scales import Range
from inerter.diagnose.vehicle.around import around
from inerter.diagnose.vehicle.build import UserModel
from inerter.diagnose.vehicle.candidate import Scale, VehicleCandidate, candidate
from inerter.diagnose.vehicle.dampers import along, bent, out_of_the_bend
from inerter.diagnose.vehicle.model import BENT, Added, VehicleModel


@dataclass(frozen=True)
class Effects:
    """Everything that can be tried in a user's model.

    scales: by device; loads: sprung and unsprung mass on each tyre by its element [kg]; columns:
    time between samples [s] by compared column; shaken: those of accelerometers, with the axes that
    each would show if it leaned; speed: whether the record has that of the vehicle; roads: columns
    of the road's height.
    """

    user: UserModel
    scales: Mapping[str, Scale]
    loads: Mapping[str, float] = field(default_factory=dict)
    columns: Mapping[str, float] = field(default_factory=dict)
    shaken: Mapping[str, str] = field(default_factory=dict)
    speed: bool = False
    roads: tuple[str, ...] = ()

    def candidates(self, model: VehicleModel) -> Iterator[VehicleCandidate]:
        """Every effect that a model does not have yet."""
        done = {(added.effect, added.element, added.law) for added in model.effects}
        for found in self._all(model):
            added = found.added
            tried = added.effect != BENT and (added.effect, added.element, added.law) in done
            if not tried and not self._doubled(added):
                yield found

    def _all(self, model: VehicleModel) -> Iterator[VehicleCandidate]:
        for device in self.user.devices:
            for build in _DEVICE:
                yield from build(self, device.name, model)
        yield from around(self, model)

    def _doubled(self, added: Added) -> bool:
        """Whether the vehicle's own spring or damper says the same between the same bodies."""
        part = next((p for p in self.user.parts.suspensions if p.device == added.element), None)
        if part is None:
            return False
        spring, damper = part.spring, part.damper
        return (
            (added.effect == "hardening_stiffness" and spring is not None)
            or (
                added.effect == "parallel_stiffness"
                and spring is not None
                and spring.kind != "device"
            )
            or (
                added.effect == "viscous_friction"
                and damper is not None
                and damper.kind != "device"
            )
        )

    def stated(self, name: str, model: VehicleModel) -> float:
        """A coordinate as it stands in a model; what does nothing where nobody states it."""
        none = 1.0 if name.endswith(".gain") else 0.0
        return model.values.get(name, self.user.stated.get(name, none))

    def damping(self, device: str, model: VehicleModel) -> float:
        """The damping of a suspension's damper as it stands [N s/m]."""
        part = next(p for p in self.user.parts.suspensions if p.device == device)
        assert part.damper is not None
        if part.damper.kind == "device" or model.bends(device):
            return self.stated(f"{device}.viscous", model)
        return self.stated(f"{part.damper.element}.damping", model)

    def law(self, device: str, model: VehicleModel) -> str:
        """A device's friction law."""
        return model.friction.get(device, self.user.device(device).device.friction)

    def stated_law(self, device: str, model: VehicleModel) -> str:
        """The friction law that a device states and a model still has; "none" where it has not."""
        stated = self.user.device(device).device.friction
        return stated if self.law(device, model) == stated else "none"


Builder = Callable[[Effects, str, VehicleModel], Iterator[VehicleCandidate]]


# --- inside the device -----------------------------------------------------------------------


def _stated(effect: str, name: str, unit: str) -> Builder:
    """A linear term: a stated value that is wrong, or one that is missing."""

    def build(effects: Effects, device: str, model: VehicleModel) -> Iterator[VehicleCandidate]:
        scale = effects.scales[device]
        full = f"{device}.{name}"
        if full in model.free or (name == "viscous" and f"{device}.bump_damping" in model.free):
            return
        size = scale.force / getattr(scale, unit)
        now = effects.stated(full, model)
        lower = -np.inf if name == "stiffness" else 0.0
        start = now + 0.05 * max(size, now)
        sizes = {name: Range(max(size, now), lower)}
        yield candidate(effect, device, [{name: start}], sizes, (name,))

    return build


def _coulomb(effects: Effects, device: str, model: VehicleModel) -> Iterator[VehicleCandidate]:
    scale, law = effects.scales[device], effects.law(device, model)
    level = Range(0.1 * scale.force, 0.0)
    if law == "none":
        start = {"coulomb_force": 0.05 * scale.force, **_width(scale)}
        yield candidate(
            "coulomb_friction", device, [start],
            {"coulomb_force": level, "transition_velocity": _widths(scale)},
            ("coulomb_force",), "coulomb",
        )  # fmt: skip
        if starts := out_of_the_bend(effects, device, model, _width(scale)):
            yield candidate(
                "coulomb_friction", device, starts,
                {"coulomb_force": level, "transition_velocity": _widths(scale)},
                (), "coulomb", telling=("coulomb_force",),
            )  # fmt: skip
    elif law == "coulomb":
        now = effects.stated(f"{device}.coulomb_force", model)
        yield candidate(
            "coulomb_friction", device, [{"coulomb_force": now + 0.03 * scale.force}],
            {"coulomb_force": level}, ("coulomb_force",),
        )  # fmt: skip


def _width(scale: Scale) -> dict[str, float]:
    # sign(v) no sharper than a step of the model resolves
    return {"transition_velocity": 0.02 * scale.v}


def _widths(scale: Scale) -> Range:
    return Range(scale.v, 0.005 * scale.v, 0.08 * scale.v, logarithmic=True)


def _presliding(scale: Scale) -> Range:
    # a bristle relaxes within presliding / speed, which an explicit step has to resolve
    least = 2.5 * scale.v * scale.step if scale.explicit else 2e-3 * scale.x
    return Range(scale.x, least, max(3 * scale.x, 2 * least), logarithmic=True)


def _stribeck(effects: Effects, device: str, model: VehicleModel) -> Iterator[VehicleCandidate]:
    scale = effects.scales[device]
    if effects.law(device, model) not in ("none", "coulomb"):
        return
    level = effects.stated(f"{device}.coulomb_force", model) or 0.05 * scale.force
    sizes = {
        "coulomb_force": Range(0.1 * scale.force, 1e-6 * scale.force),
        "static_excess": Range(0.1 * scale.force, 0.0),
        "stribeck_velocity": Range(scale.v, 0.05 * scale.v, 2 * scale.v, logarithmic=True),
        "transition_velocity": _widths(scale),
    }
    starts = [
        {"coulomb_force": level, "static_excess": 0.6 * level, "stribeck_velocity": r * scale.v,
         **_width(scale)} for r in (0.1, 0.4)
    ]  # fmt: skip
    yield candidate(
        "stribeck_friction", device, starts, sizes, ("coulomb_force", "static_excess"), "stribeck",
        telling=("static_excess",),
    )  # fmt: skip


def _hysteretic(effects: Effects, device: str, model: VehicleModel) -> Iterator[VehicleCandidate]:
    scale, law = effects.scales[device], effects.law(device, model)
    if law not in ("none", "coulomb", "dahl"):
        return
    level = effects.stated(f"{device}.coulomb_force", model) or 0.05 * scale.force
    sizes = {
        "coulomb_force": Range(0.1 * scale.force, 1e-6 * scale.force),
        "presliding": _presliding(scale),
    }
    if law != "dahl":
        starts = [{"coulomb_force": level, "presliding": r * scale.x} for r in (0.02, 0.15, 0.6)]
        yield candidate(
            "hysteretic_friction", device, starts, sizes, ("coulomb_force",), "dahl", "dahl"
        )
    if law == "dahl":
        presliding = effects.stated(f"{device}.presliding", model)
        more = {
            "static_excess": Range(0.1 * scale.force, 0.0),
            "stribeck_velocity": Range(scale.v, 0.02 * scale.v, 2 * scale.v, logarithmic=True),
        }
        start = {"coulomb_force": level, "presliding": presliding, "static_excess": 0.5 * level}
        yield candidate(
            "hysteretic_friction", device, [{**start, "stribeck_velocity": 0.2 * scale.v}],
            {**sizes, **more}, ("static_excess",), "lugre", "lugre",
        )  # fmt: skip


def _law_sizes(scale: Scale) -> dict[str, Range]:
    """How the coordinates of friction laws are searched in a vehicle."""
    force, stiffness = scale.force, scale.force / scale.x
    return {
        "coulomb_force": Range(0.1 * force, 1e-6 * force),
        "static_excess": Range(0.1 * force, 0.0),
        "stribeck_velocity": Range(scale.v, 0.02 * scale.v, 2 * scale.v, logarithmic=True),
        "presliding": _presliding(scale),
        "bristle_damping": Range(0.1 * force / scale.v, 0.0),
        "bw_stiffness": Range(stiffness, 1e-6 * stiffness),
        "bw_beta": Range(1 / scale.x),
        "bw_gamma": Range(1 / scale.x),
        "bw_exponent": Range(1.0, 1.0, 6.0),
        "bw_ratio": Range(0.1, -0.5, 0.9),
    }


def _stated_law(effects: Effects, device: str, model: VehicleModel) -> Iterator[VehicleCandidate]:
    """The friction law that the user states, all of it, stated or left to its defaults."""
    law, scale = FRICTION[effects.stated_law(device, model)], effects.scales[device]
    names = law.set_free
    # of one whose level is all that is a candidate already
    if names in ((), (law.level,)) or f"{device}.{names[-1]}" in model.free:
        return
    of = effects.user.device(device).device
    own, data = _law_sizes(scale), scale.of_data
    sizes = {name: own.get(name) or COORDINATES[name].range(data) for name in names}
    stated = effects.user.stated
    now = {name: stated.get(f"{device}.{name}", COORDINATES[name].of(of)) for name in sizes}
    starts = []
    for name, size in sizes.items():
        moved = 1.3 * now[name] if size.logarithmic else now[name] + 0.3 * (now[name] or size.size)
        starts.append({**now, name: moved})
    amplitudes = tuple(name for name, size in sizes.items() if not size.logarithmic)
    told = law.name if law.memory else None
    yield candidate(
        law.effect, device, starts, sizes, amplitudes, law.name, told, telling=tuple(sizes)
    )  # fmt: skip


def _added(effect: str, size: Callable[[Scale], dict[str, Range]], share: float) -> Builder:
    """Further terms of the device, each of which alone may be what is missing."""

    def build(effects: Effects, device: str, model: VehicleModel) -> Iterator[VehicleCandidate]:
        sizes = size(effects.scales[device])
        now = {name: effects.stated(f"{device}.{name}", model) for name in sizes}
        starts = []
        for name, each in sizes.items():
            starts.append({**now, name: now[name] + share * each.size})
        yield candidate(effect, device, starts, sizes, tuple(sizes))

    return build


def _series(effects: Effects, device: str, model: VehicleModel) -> Iterator[VehicleCandidate]:
    scale = effects.scales[device]
    if not effects.stated(f"{device}.inertance", model) > 0:
        return
    stated = effects.stated(f"{device}.series_stiffness", model) > 0
    known = model.values.get(f"{device}.series_frequency")
    slow = np.sqrt(scale.a / scale.x) / (2 * np.pi)
    fast = 1.0 / (2 * np.pi * scale.step)
    sizes = {
        "series_frequency": Range(slow, 0.3 * slow, fast, logarithmic=True),
        "series_loss": Range(0.1, 1e-3, 3.0, logarithmic=True),
    }
    if known is None and not stated:
        starts = [
            {"series_frequency": min(r * slow, 0.9 * fast), "series_loss": 0.2}
            for r in (1.5, 3.0, 8.0)
        ]
        yield candidate("series_elasticity", device, starts, sizes, ())
    gap = Range(scale.x, 1e-3 * scale.x, 3 * scale.x, logarithmic=True)
    if effects.stated(f"{device}.backlash", model) > 0 or stated:
        return
    starts = [
        {"backlash": r * scale.x, "series_frequency": frequency, "series_loss": 0.1}
        for r in (0.03, 0.1, 0.3, 1.0)
        for frequency in ([known] if known else [4 * slow, min(10 * slow, 0.7 * fast)])
    ]
    yield candidate("backlash", device, starts, {"backlash": gap, **sizes}, ())


def _gas(effects: Effects, device: str, model: VehicleModel) -> Iterator[VehicleCandidate]:
    scale = effects.scales[device]
    if effects.stated(f"{device}.gas_pressure", model) > 0:
        return
    # only pressure times area and volume per area act: the area is a choice
    area, pressure = 1e-3, 0.2 * scale.force / 1e-3
    length = max(-scale.smallest, scale.x)
    starts = [
        {"gas_area": area, "gas_pressure": r * pressure, "gas_volume": area * r * 2 * length}
        for r in (1.0, 3.0)
    ]
    sizes = {
        "gas_pressure": Range(pressure, 1e-3 * pressure, 1e3 * pressure, logarithmic=True),
        "gas_volume": Range(area * length, 0.3 * area * length, 1e2 * area * length, True),
    }
    yield candidate("gas_spring", device, starts, sizes, ("gas_pressure",))


def _stops(effects: Effects, device: str, model: VehicleModel) -> Iterator[VehicleCandidate]:
    scale = effects.scales[device]
    size = scale.force / scale.x
    stiff = Range(size, 0.3 * size, 1e3 * size, logarithmic=True)
    known = model.values.get(f"{device}.stop_stiffness")
    for name, reach, side in (
        ("stop_upper", scale.largest, "rebound"), ("stop_lower", scale.smallest, "bump")
    ):  # fmt: skip
        if reach == 0 or f"{device}.{name}" in effects.user.stated:
            continue
        place = Range(abs(reach), min(0.2 * reach, 1.2 * reach), max(0.2 * reach, 1.2 * reach))
        # a device has one stiffness for both of its ends
        starts = [
            {name: r * reach, "stop_stiffness": known or s * size}
            for r, s in ((0.5, 2.0), (0.75, 8.0))
        ]
        yield candidate(
            "end_stop", device, starts, {name: place, "stop_stiffness": stiff}, (), law=side
        )


def _relaxing(effects: Effects, device: str, model: VehicleModel) -> Iterator[VehicleCandidate]:
    """A spring that relaxes: a rubber bush, a damper on a soft mount."""
    if effects.stated(f"{device}.branch_stiffness_1", model) > 0:
        return
    scale = effects.scales[device]
    stiffness, period = scale.force / scale.x, 2 * np.pi * np.sqrt(scale.x / scale.a)
    least = 2.5 * scale.step if scale.explicit else 0.1 * scale.step
    sizes = {
        "branch_stiffness_1": Range(stiffness, 1e-3 * stiffness),
        "branch_time_1": Range(period, least, max(30 * period, 2 * least), logarithmic=True),
    }
    starts = [
        {"branch_stiffness_1": 0.1 * stiffness, "branch_time_1": max(r * period, 1.5 * least)}
        for r in (0.1, 0.6)
    ]
    yield candidate("viscoelasticity", device, starts, sizes, ("branch_stiffness_1",))


_DEVICE: tuple[Builder, ...] = (
    _stated("inertance_error", "inertance", "a"),
    _stated("viscous_friction", "viscous", "v"),
    _stated("parallel_stiffness", "stiffness", "x"),
    _coulomb,
    _stribeck,
    _hysteretic,
    _stated_law,
    _added("hardening_stiffness", lambda s: {"stiffness_cubic": Range(s.force / s.x**3)}, 0.02),
    _added("quadratic_damping", lambda s: {"quadratic_damping": Range(s.force / s.v**2, 0)}, 0.02),
    _added("load_dependent_friction", lambda s: {"load_friction": Range(0.1, 0.0, 0.95)}, 0.5),
    _added("force_offset", lambda s: {"force_offset": Range(0.1 * s.force)}, 0.5),
    _added(
        "variable_inertance",
        lambda s: {
            "inertance_gradient": Range(0.1 / s.x, -0.5 / s.x, 0.5 / s.x),
            "inertance_curvature": Range(0.1 / s.x**2, -0.2 / s.x**2, 3 / s.x**2),
        },
        0.5,
    ),
    _series,
    _gas,
    _stops,
    bent,
    along,
    _relaxing,
)  # fmt: skip
