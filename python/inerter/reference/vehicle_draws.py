"""What each hidden effect changes in a drawn vehicle or its channels, and by how much.

Sizes are shares of what the stated vehicle does on its roads: of the force of inerter and damper,
of its travel x, rate v and acceleration a (rms). `strength` 1 is the usual size.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from .sizes import rounded
from .vehicle_making import Making

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Sizes:
    """Of a corner on its roads: rms travel, rate, acceleration and force; SI units.

    largest, smallest: travel; guide_rate: of what a guide holds, the wheel or over an arm the body;
    pull: with which the tyre would have to pull on the road, at most [N].
    """

    x: float
    v: float
    a: float
    force: float
    largest: float
    smallest: float
    guide_rate: float
    pull: float


@dataclass(frozen=True)
class Draw:
    """What the functions below need."""

    making: Making
    random: Generator
    corner: int
    size: Sizes
    strength: float
    columns: list[str]
    spacing: float

    @property
    def stated(self) -> Any:
        """The corner's numbers."""
        return self.making.stated.corners[self.corner]

    @property
    def place(self) -> str:
        """The corner's name."""
        return self.making.stated.names[self.corner]

    def between(self, low: float, high: float) -> float:
        """A size that grows with the strength."""
        return float(self.random.uniform(low, high)) * self.strength

    def off(self, low: float, high: float) -> float:
        """A factor above or below 1."""
        share = min(self.between(low, high), 0.5)
        return 1.0 + float(self.random.choice([-1.0, 1.0])) * share

    def device(self, effect: str, told: Mapping[str, float] | None = None, **values: Any) -> None:
        """Parameters of the corner's device; told: of them those to be found, all numbers else."""
        kept = {k: rounded(v) if isinstance(v, float) else v for k, v in values.items()}
        self.making.devices.setdefault(self.corner, {}).update(kept)
        numbers = {k: v for k, v in kept.items() if isinstance(v, float)}
        self.making.tell(effect, self.place, numbers if told is None else told)


def _number(effect: str, name: str, told: str, low: float = 0.08, high: float = 0.2) -> None:
    """A number of the corner that is wrong."""

    def draw(d: Draw) -> None:
        value = rounded(getattr(d.stated, name) * d.off(low, high))
        d.making.corners.setdefault(d.corner, {})[name] = value
        d.making.tell(effect, d.place, {told: value})

    _DRAWS[effect] = draw


_DRAWS: dict[str, Callable[[Draw], None]] = {}
_number("inertance_error", "inertance", "inertance", 0.1, 0.3)
_number("viscous_friction", "damping", "viscous", 0.1, 0.3)
_number("parallel_stiffness", "stiffness", "stiffness", 0.1, 0.25)
_number("tyre_stiffness_error", "tyre_stiffness", "tyre_stiffness")
_number("wheel_mass_error", "wheel_mass", "wheel_mass", 0.1, 0.25)


def _draws(effect: str) -> Callable[[Callable[[Draw], None]], Callable[[Draw], None]]:
    def keep(function: Callable[[Draw], None]) -> Callable[[Draw], None]:
        _DRAWS[effect] = function
        return function

    return keep


@_draws("body_mass_error")
def _body_mass(d: Draw) -> None:
    d.making.body = d.off(0.08, 0.2)
    mass = d.making.stated.body_mass * d.making.body
    d.making.tell("body_mass_error", "", {"body_mass": mass})


def _sharp(d: Draw) -> dict[str, float]:
    return {"transition_velocity": rounded(0.01 * d.size.v)}


@_draws("coulomb_friction")
def _coulomb(d: Draw) -> None:
    level = rounded(d.between(0.06, 0.25) * d.size.force)
    d.device("coulomb_friction", {"coulomb_force": level}, friction="coulomb",
             coulomb_force=level, **_sharp(d))  # fmt: skip


def _hysteretic(d: Draw, law: str) -> None:
    level = rounded(d.between(0.1, 0.3) * d.size.force)
    stiffness = rounded(level / (d.size.x * d.random.uniform(0.03, 0.3)))
    values: dict[str, Any] = {
        "friction": law, "coulomb_force": level, "bristle_stiffness": stiffness,
    }  # fmt: skip
    if law == "lugre":
        values["static_force"] = level * float(d.random.uniform(1.3, 1.8))
        values["stribeck_velocity"] = d.size.v * float(d.random.uniform(0.15, 0.5))
    told = {"coulomb_force": level, "bristle_stiffness": stiffness}
    d.device("hysteretic_friction", told, **values)


@_draws("quadratic_damping")
def _quadratic(d: Draw) -> None:
    size = d.between(0.06, 0.25) * d.size.force / d.size.v**2
    d.device("quadratic_damping", quadratic_damping=size)


@_draws("load_dependent_friction")
def _load(d: Draw) -> None:
    mu = rounded(min(d.between(0.1, 0.3), 0.6))
    d.device("load_dependent_friction", {"load_friction": mu}, load_friction=mu, **_sharp(d))


@_draws("end_stop")
def _stop(d: Draw) -> None:
    upper = bool(d.random.integers(2))
    reach = d.size.largest if upper else d.size.smallest
    place = rounded(reach * d.random.uniform(0.35, 0.65) / d.strength)
    stiffness = d.between(2.0, 8.0) * d.size.force / d.size.x
    name = "stop_upper" if upper else "stop_lower"
    d.device("end_stop", None, **{name: place, "stop_stiffness": stiffness})


def _shaft(d: Draw, low: float, high: float) -> dict[str, float]:
    slow = float(np.sqrt(d.size.a / d.size.x))
    omega = slow * float(d.random.uniform(low, high)) / d.strength**0.5
    stiffness = d.stated.inertance * omega**2
    loss = 2 * d.random.uniform(0.05, 0.3) * np.sqrt(stiffness * d.stated.inertance)
    return {"series_stiffness": rounded(stiffness), "series_damping": rounded(loss)}


@_draws("series_elasticity")
def _series(d: Draw) -> None:
    d.device("series_elasticity", None, **_shaft(d, 1.5, 4.0))


@_draws("backlash")
def _backlash(d: Draw) -> None:
    gap = rounded(d.between(0.1, 0.5) * d.size.x)
    d.device("backlash", {"backlash": gap}, backlash=gap, **_shaft(d, 4.0, 8.0))


@_draws("variable_inertance")
def _variable(d: Draw) -> None:
    size = min(d.between(0.08, 0.2), 0.3) / d.size.x * float(d.random.choice([-1, 1]))
    d.device("variable_inertance", inertance_gradient=size)


@_draws("spring_hardening")
def _hardening(d: Draw) -> None:
    size = d.between(0.15, 0.5) * d.stated.stiffness / (3 * d.size.x**2)
    d.device("spring_hardening", stiffness_cubic=size)


@_draws("damper_asymmetry")
def _asymmetry(d: Draw) -> None:
    rebound = d.stated.damping * (1 + min(d.between(0.15, 0.5), 1.0))
    bump = d.stated.damping * (1 - min(d.between(0.15, 0.4), 0.8))
    told = {"rebound_damping": rebound, "bump_damping": bump}
    asymmetry = (rebound - bump) / (rebound + bump)
    mean = 0.5 * (rebound + bump)
    d.making.devices.setdefault(d.corner, {}).update(viscous=mean, damping_asymmetry=asymmetry)
    d.making.tell("damper_asymmetry", d.place, told)


@_draws("tyre_damping")
def _tyre_damping(d: Draw) -> None:
    size = float(np.sqrt(d.stated.tyre_stiffness * d.stated.wheel_mass))
    value = rounded(d.between(0.05, 0.2) * size)
    d.making.others.setdefault(d.corner, {})["tyre_damping"] = value
    d.making.tell("tyre_damping", d.place, {"tyre_damping": value})


@_draws("tyre_liftoff")
def _liftoff(d: Draw) -> None:
    value = rounded(d.random.uniform(0.3, 0.55) * d.size.pull / d.strength)
    d.making.others.setdefault(d.corner, {})["static_load"] = value
    d.making.tell("tyre_liftoff", d.place, {"tyre_static_load": value})


@_draws("joint_friction")
def _joint_friction(d: Draw) -> None:
    level = rounded(d.between(0.08, 0.3) * d.size.force)
    guide = {"friction": "coulomb", "coulomb_force": level,
             "transition_velocity": rounded(0.005 * d.size.guide_rate)}  # fmt: skip
    d.making.guides.setdefault(d.corner, {}).update(guide)
    d.making.tell("joint_friction", d.place, {"joint_friction": level})


@_draws("joint_damping")
def _joint_damping(d: Draw) -> None:
    value = rounded(d.between(0.08, 0.3) * d.size.force / d.size.guide_rate)
    d.making.guides.setdefault(d.corner, {})["viscous"] = value
    d.making.tell("joint_damping", d.place, {"joint_damping": value})


@_draws("sensor_delay")
def _delay(d: Draw) -> None:
    column = str(d.random.choice(d.columns))
    value = rounded(d.between(0.5, 3.0) * d.spacing)
    d.making.late[column] = value
    d.making.tell("sensor_delay", column, {"delay": value})


@_draws("actuator_gain_error")
def _gain(d: Draw) -> None:
    d.making.gain = rounded(d.off(0.2, 0.45))
    d.making.tell("actuator_gain_error", "actuator_force", {"actuator_gain": d.making.gain})


@_draws("actuator_lag")
def _lag(d: Draw) -> None:
    d.making.lag = rounded(d.between(0.008, 0.03))
    d.making.tell("actuator_lag", "actuator_force", {"actuator_lag": d.making.lag})


def _element(d: Draw, effect: str, columns: list[str], loss: tuple[float, float]) -> None:
    column = str(d.random.choice(columns))
    frequency = rounded(d.random.uniform(15.0, 40.0) / d.strength)
    share = rounded(d.random.uniform(*loss))
    d.making.behind[column] = frequency, share
    told = {"mount_frequency": frequency, "mount_loss": share}
    if effect == "sensor_filter":
        told = {"filter_frequency": frequency}
    d.making.tell(effect, column, told)


@_draws("sensor_filter")
def _filter(d: Draw) -> None:
    _element(d, "sensor_filter", d.columns, (0.5**0.5, 0.5**0.5))


@_draws("sensor_compliance")
def _mount(d: Draw) -> None:
    shaken = [column for column in d.columns if "acceleration" in column]
    _element(d, "sensor_compliance", shaken, (0.03, 0.3))


@_draws("mounting_angle")
def _lean(d: Draw) -> None:
    d.making.lean = rounded(d.off(0.08, 0.2) - 1.0)
    d.making.tell("mounting_angle", LEANING, {"angle_toward_x": d.making.lean})


@_draws("tyre_enveloping")
def _enveloping(d: Draw) -> None:
    d.making.patch = rounded(d.between(0.12, 0.35))
    d.making.tell("tyre_enveloping", "", {"patch_length": d.making.patch})


@_draws("digressive_damping")
def _digressive(d: Draw) -> None:
    damping = rounded(d.stated.damping * d.random.uniform(1.1, 1.5))
    knee = rounded(d.size.v * d.random.uniform(0.3, 0.9))
    beyond = rounded(d.random.uniform(0.15, 0.5) / d.strength)
    d.device("digressive_damping", None, viscous=damping, damping_knee=knee, damping_beyond=beyond)


@_draws("position_dependent_damping")
def _bypass(d: Draw) -> None:
    reach = max(d.size.largest, -d.size.smallest)
    slope = rounded(min(d.between(0.3, 0.6), 0.65) / reach * float(d.random.choice([-1, 1])))
    ends = 1.3 * reach
    rise = d.stated.damping * slope * np.linspace(-ends, ends, 41)
    d.device(
        "position_dependent_damping", {"damping_gradient": slope},
        viscous_curve=tuple(map(float, rise)), curve_lower=-ends, curve_upper=ends,
    )  # fmt: skip


@_draws("viscoelasticity")
def _bush(d: Draw) -> None:
    stiffness = rounded(d.between(0.15, 0.5) * d.size.force / d.size.x)
    period = 2.0 * np.pi * float(np.sqrt(d.size.x / d.size.a))
    damping = rounded(stiffness * period * d.random.uniform(0.1, 0.6))
    d.device("viscoelasticity", None, branch_stiffness_1=stiffness, branch_damping_1=damping)


@_draws("sensor_gain_error")
def _scale(d: Draw) -> None:
    column = str(d.random.choice(d.columns))
    value = rounded(d.off(0.06, 0.2))
    d.making.scales[column] = value
    d.making.tell("sensor_gain_error", column, {"gain": value})


VEHICLE_EFFECTS = (*_DRAWS, "hysteretic_friction")
"""Every effect that can be hidden in a vehicle."""
ACTIVE_EFFECTS = ("actuator_gain_error", "actuator_lag")
LEANING = "wheel_acceleration"
"""The channel of a sensor that leans: the wheel's on an arm, which moves forward too."""
_LAWS = ("coulomb_friction", "hysteretic_friction")
_CLASHES = (
    _LAWS,
    ("series_elasticity", "backlash"),
    # the same number twice, or one of which the other is a part
    ("parallel_stiffness", "spring_hardening"),
    ("inertance_error", "variable_inertance"),
    ("load_dependent_friction", "coulomb_friction"),
    ("load_dependent_friction", "hysteretic_friction"),
    ("load_dependent_friction", "series_elasticity"),
    ("load_dependent_friction", "backlash"),
    ("variable_inertance", "series_elasticity"),
    ("variable_inertance", "backlash"),
    ("variable_inertance", "load_dependent_friction"),
    # one curve of the damping, one element of a channel
    *combinations(
        ("viscous_friction", "damper_asymmetry", "quadratic_damping", "digressive_damping",
         "position_dependent_damping"), 2,
    ),
    *combinations(
        ("sensor_delay", "sensor_filter", "sensor_compliance", "mounting_angle",
         "sensor_gain_error"), 2,
    ),
    ("viscoelasticity", "hysteretic_friction"),
    # the one is hidden on an arm alone, the other never
    ("mounting_angle", "backlash"),
)  # fmt: skip


def compatible_in_vehicles(effects: tuple[str, ...]) -> bool:
    """Whether effects can be hidden together."""
    if len(set(effects)) < len(effects):
        return False
    return not any(set(pair) <= set(effects) for pair in _CLASHES)


def draw_vehicle_effect(
    making: Making,
    effect: str,
    law: str | None,
    random: Generator,
    sizes: list[Sizes],
    strength: float,
    columns: list[str],
    spacing: float,
) -> None:
    """Hide one effect."""
    corner = int(random.integers(len(sizes)))
    if making.devices or making.places:
        # a second one in the same corner, as two parts of one strut are worn together
        told = [p for p in making.places.values() if p in making.stated.names]
        corner = making.stated.names.index(told[0]) if told else corner
    draw = Draw(making, random, corner, sizes[corner], strength, columns, spacing)
    if effect == "hysteretic_friction":
        _hysteretic(draw, str(law))
    else:
        _DRAWS[effect](draw)
