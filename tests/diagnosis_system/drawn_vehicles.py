"""Vehicles, roads and the effects hidden in them, drawn from a seed.

The vehicle that is stated is the shipped quarter-car with every number drawn anew; what is driven
differs from it by one effect. Everything follows from the seed that a session of tests shows.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any
from zlib import crc32

import numpy as np
from hidden_vehicles import S2, Car, Road, records, reference_records
from inerter.diagnose.vehicle.build import model_of_text
from inerter.diagnose.vehicle.diagnosis import diagnose_system
from inerter.diagnose.vehicle.mapping import map_columns
from inerter.diagnose.vehicle.outcome import SystemDiagnosis
from inerter.models import model_path
from inerter.records import VehicleRecord
from inerter.reference import QuarterCar, ReferenceDevice

OF_VEHICLE = (
    "tyre_damping", "tyre_liftoff", "damper_asymmetry", "spring_hardening", "body_mass_error",
    "wheel_mass_error", "tyre_stiffness_error", "viscous_friction",
)  # fmt: skip
OF_DEVICE = (
    "coulomb_friction", "hysteretic_friction", "inertance_error", "end_stop", "series_elasticity",
)  # fmt: skip
_RUNS, _SECONDS = 3, 4.0


@dataclass(frozen=True)
class DrawnVehicle:
    """A vehicle as stated, drives of it with an effect, and the true values of its parameters."""

    seed: int
    effect: str
    stated: Car
    records: list[VehicleRecord]
    parameters: dict[str, float]

    def diagnose(self) -> SystemDiagnosis:
        """Against the vehicle as stated, with steps of 2 ms to save time."""
        user = model_of_text(_mjcf(self.stated), model_path("quarter_car", "model.xml"))
        user = user.with_timestep(0.002)
        columns = list(self.records[0].channels())
        return diagnose_system(self.records, user, map_columns(user.model, columns, {}, {}))


def draw(seed: int, effect: str) -> DrawnVehicle:
    """A vehicle with an effect; "none": with nothing hidden."""
    random = np.random.default_rng([seed, crc32(effect.encode())])

    def near(value: float, share: float) -> float:
        return float(value * random.uniform(1 - share, 1 + share))

    usual = Car()
    stated = Car(
        sprung_mass=near(usual.sprung_mass, 0.2), unsprung_mass=near(usual.unsprung_mass, 0.2),
        tyre_stiffness=near(usual.tyre_stiffness, 0.15), stiffness=near(usual.stiffness, 0.15),
        damping=near(usual.damping, 0.2), inertance=near(usual.inertance, 0.2),
    )  # fmt: skip
    amplitude, road = float(random.uniform(0.07, 0.1)), int(random.integers(1, 10_000))
    if effect in OF_DEVICE:
        values, parameters = _of_device(stated, effect, random)
        device = ReferenceDevice(
            **{"inertance": stated.inertance, "viscous": stated.damping,
               "stiffness": stated.stiffness, **values}
        )  # fmt: skip
        car = QuarterCar(
            sprung_mass=stated.sprung_mass, unsprung_mass=stated.unsprung_mass,
            tyre_stiffness=stated.tyre_stiffness, stiffness=0.0, damping=0.0, device=device,
        )  # fmt: skip
        driven = reference_records(car, _RUNS, _SECONDS, road, amplitude=amplitude)
        return DrawnVehicle(seed, effect, stated, driven, parameters)
    if effect == "tyre_liftoff":
        amplitude = 0.2
    car, parameters = _of_vehicle(stated, effect, random, Road(road, _SECONDS, amplitude))
    driven = records(car, _RUNS, _SECONDS, road, amplitude=amplitude)
    return DrawnVehicle(seed, effect, stated, driven, parameters)


def _of_vehicle(
    stated: Car, effect: str, random: np.random.Generator, road: Road
) -> tuple[Car, dict[str, float]]:
    """The vehicle that is driven, and what is to be found."""

    def other(least: float, most: float) -> float:
        """A share of a stated value, above or below it."""
        return float(1 + random.choice([-1.0, 1.0]) * random.uniform(least, most))

    if effect == "none":
        return stated, {}
    if effect == "tyre_damping":
        value = float(random.uniform(100.0, 250.0))
        return replace(stated, tyre_damping=value), {"tyre_damping": value}
    if effect == "tyre_liftoff":
        (run,) = records(stated, 1, _SECONDS, road.seed, amplitude=road.amplitude)
        force = run.channels()["tyre_force"]
        value = float(random.uniform(0.3, 0.5) * np.max(-force))
        return replace(stated, static_load=value), {"tyre_static_load": value}
    if effect == "damper_asymmetry":
        values = {
            "rebound_damping": stated.damping * float(random.uniform(1.12, 1.3)),
            "bump_damping": stated.damping * float(random.uniform(0.7, 0.88)),
        }
        return replace(stated, **values), values
    if effect == "spring_hardening":
        (run,) = records(stated, 1, _SECONDS, road.seed, amplitude=road.amplitude)
        size = float(np.std(run.channels()["suspension_travel"]))
        value = float(random.uniform(0.2, 0.5) * stated.stiffness / (3 * size) ** 2)
        return replace(stated, stiffness_cubic=value), {"stiffness_cubic": value}
    name, told = {
        "body_mass_error": ("sprung_mass", "body_mass"),
        "wheel_mass_error": ("unsprung_mass", "wheel_mass"),
        "tyre_stiffness_error": ("tyre_stiffness", "tyre_stiffness"),
        "viscous_friction": ("damping", "viscous"),
    }[effect]
    value = getattr(stated, name) * other(0.08, 0.2)
    return replace(stated, **{name: value}), {told: value}


def _of_device(
    stated: Car, effect: str, random: np.random.Generator
) -> tuple[dict[str, Any], dict[str, float]]:
    """What the device has beside what is stated, and what is to be found."""

    def spread(middle: float, factor: float) -> float:
        return float(middle * factor ** random.uniform(-1, 1))

    if effect == "coulomb_friction":
        values = {"coulomb_force": spread(70.0, 1.5)}
        return {"friction": "coulomb", **values}, values
    if effect == "hysteretic_friction":
        values = {"coulomb_force": spread(100.0, 1.3), "bristle_stiffness": spread(1e5, 1.5)}
        return {"friction": "dahl", **values}, values
    if effect == "inertance_error":
        values = {"inertance": stated.inertance * float(random.choice([0.85, 0.92, 1.1, 1.2]))}
    elif effect == "end_stop":
        values = {"stop_upper": spread(0.003, 1.15), "stop_stiffness": spread(5e5, 1.3)}
    else:
        values = {"series_stiffness": spread(3e5, 1.3), "series_damping": spread(500.0, 1.3)}
    return dict(values), values


def _mjcf(car: Car) -> str:
    """The shipped model with a vehicle's numbers."""
    text = Path(model_path("quarter_car", "model.xml")).read_text(encoding="utf-8")
    for pattern, value in (
        (r'(key="inertance" value=")[^"]*', car.inertance),
        (r'(key="viscous" value=")[^"]*', car.damping),
        (r'(key="stiffness" value=")[^"]*', car.stiffness),
        (r'(name="wheel" type="cylinder"[^>]*mass=")[^"]*', car.unsprung_mass),
        (r'(name="body" type="box"[^>]*mass=")[^"]*', car.sprung_mass),
        (r'(name="road" joint="wheel" kp=")[^"]*', car.tyre_stiffness),
    ):
        text, count = re.subn(pattern, rf"\g<1>{value!r}", text)
        assert count == 1, pattern
    return text


assert S2.damping == Car().damping, "the shipped vehicle is the one that is drawn about"
