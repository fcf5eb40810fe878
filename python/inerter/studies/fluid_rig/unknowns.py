"""What is identified: names, bounds, and how values become parameters of the device.

Dry: f_d, f_s - f_d (so that f_s >= f_d), v_s, c_d, over their logarithms. Complete: k_0, k', c_f,
and c_a after each preload; k' may have either sign, the others are searched over their logarithms.
Bounds are a tenth and ten times the published values.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from inerter.catalogue.scales import Range
from inerter.estimation.variables import Variables
from inerter.model_parameters import FLUID_INERTER
from inerter.studies.fluid_rig.rig import Configuration
from inerter.studies.fluid_rig.signals import Signals
from inerter.studies.fluid_rig.sweeps import Sweep
from inerter.studies.fluid_rig.truth import published_air_damping

Array = NDArray[np.float64]

_WIDE = 10.0
DRY_LIVE = ("coulomb_force", "static_force", "stribeck_velocity", "viscous")
COMPLETE_LIVE = (
    *DRY_LIVE,
    "series_stiffness",
    "series_hardening",
    "series_damping",
    "flywheel_viscous",
)
UNITS = {
    "coulomb_force": "N",
    "static_force": "N",
    "static_excess": "N",
    "stribeck_velocity": "m/s",
    "viscous": "N s/m",
    "series_stiffness": "N/m",
    "series_hardening": "1/m",
    "series_damping": "N s/m",
    "flywheel_viscous": "N s/m",
}
SYMBOLS = {
    "coulomb_force": "f_d",
    "static_force": "f_s",
    "stribeck_velocity": "v_s",
    "viscous": "c_d",
    "series_stiffness": "k_0",
    "series_hardening": "k'",
    "series_damping": "c_f",
    "flywheel_viscous": "c_a",
}


@dataclass(frozen=True)
class Unknowns:
    """Coordinates of a fit by name, in the order of the search variables.

    A name with `@` and a preload, such as "flywheel_viscous@0.05", counts in the tests after that
    preload only.
    """

    coordinates: Mapping[str, Range]

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the coordinates."""
        return tuple(self.coordinates)

    @cached_property
    def _variables(self) -> Variables:
        return Variables.among(self.coordinates, self.coordinates)

    @property
    def bounds(self) -> tuple[Array, Array]:
        """Lower and upper bounds of the search variables, shape (p,) each."""
        return self._variables.bounds

    def encode(self, values: Mapping[str, float]) -> Array:
        """Parameters, as `parameters` gives them, to search variables, shape (p,)."""
        given = dict(values)
        if "static_excess" in self.coordinates:
            given["static_excess"] = given["static_force"] - given["coulomb_force"]
        return self._variables.encode(given)

    def parameters(self, variables: Array) -> dict[str, float]:
        """Search variables (p,) to parameters as they are reported: f_s itself, c_a by preload."""
        found = self._variables.decode(variables)
        if "static_excess" in found:
            found["static_force"] = found["coulomb_force"] + found.pop("static_excess")
        return found

    def gradient(self, variables: Array) -> Array:
        """Derivatives of the parameters by the search variables, shape (p, p)."""
        step, columns = 1e-6, []
        for i in range(variables.size):
            ends = []
            for sign in (1, -1):
                moved = variables.copy()
                moved[i] += sign * step
                ends.append(list(self.parameters(moved).values()))
            columns.append((np.array(ends[0]) - np.array(ends[1])) / (2 * step))
        return np.column_stack(columns)


def device_values(parameters: Mapping[str, float], sweep: Sweep) -> dict[str, float]:
    """Parameters that the device has in one test."""
    values = {}
    for name, value in parameters.items():
        key, at, preload = name.partition("@")
        if not at or sweep.preload == float(preload):
            values[key] = value
    return values


def published(configuration: Configuration, sweeps: Sequence[Sweep]) -> dict[str, float]:
    """Values of the paper, by the names of the parameters."""
    keys = DRY_LIVE if configuration == "dry" else COMPLETE_LIVE[4:7]
    values = {key: float(getattr(FLUID_INERTER, key)) for key in keys}
    if configuration == "complete":
        for preload in _preloads(sweeps):
            values[f"flywheel_viscous@{preload:.2f}"] = published_air_damping(preload)
    return values


def unknowns(configuration: Configuration, sweeps: Sequence[Sweep]) -> Unknowns:
    """The coordinates of a configuration's fit."""
    values = published(configuration, sweeps)
    if configuration == "dry":
        excess = values["static_force"] - values["coulomb_force"]
        values = {"coulomb_force": values["coulomb_force"], "static_excess": excess} | {
            key: values[key] for key in ("stribeck_velocity", "viscous")
        }
    return Unknowns({name: _range(name, value) for name, value in values.items()})


def label(name: str) -> str:
    """How a parameter is written in tables and pictures."""
    key, at, preload = name.partition("@")
    return f"{SYMBOLS[key]} ({preload} V)" if at else SYMBOLS[key]


def unit(name: str) -> str:
    """Unit of a parameter."""
    return UNITS[name.partition("@")[0]]


def random_start(
    configuration: Configuration,
    sweeps: Sequence[Sweep],
    generator: np.random.Generator,
    factor: float = 2.0,
) -> dict[str, float]:
    """Published values times random factors from 1 / `factor` to `factor`, even in the logarithm.

    f_s is at least 1.1 f_d.
    """
    start = {
        name: value * factor ** generator.uniform(-1, 1)
        for name, value in published(configuration, sweeps).items()
    }
    if configuration == "dry":
        start["static_force"] = max(start["static_force"], 1.1 * start["coulomb_force"])
    return start


def water_limit() -> float:
    """Displacement of the water beyond which the printed law of the air softens to nothing [m]."""
    return FLUID_INERTER.air_column / (FLUID_INERTER.gas_exponent + 1)


def left_the_law(signals: Signals) -> bool:
    """Whether the water went beyond what the printed law of the air is good for."""
    return signals.farthest > water_limit()


def _preloads(sweeps: Sequence[Sweep]) -> list[float]:
    return sorted({sweep.preload for sweep in sweeps if sweep.preload is not None})


def _range(name: str, value: float) -> Range:
    if name == "series_hardening":
        return Range(value, -_WIDE * value, _WIDE * value)
    return Range(value, value / _WIDE, value * _WIDE, logarithmic=True)
