"""Coordinates that are combinations of parameters: from the ones to the others, in place."""

from __future__ import annotations

import numpy as np

Values = dict[str, float]

GAS_AREA = 1e-3


def gas(values: Values) -> None:
    area = values.get("piston_area", GAS_AREA)
    # one that is compressed as the device lengthens has an area below 0
    above = values.pop("gas_reach_above", None)
    area = abs(values.setdefault("gas_area", area if above is None else -area))
    values["gas_pressure"] = values.pop("gas_push") / area
    values["gas_volume"] = (values.pop("gas_reach") if above is None else above) * area


def branch(values: Values) -> None:
    """Relaxation times in the place of the dashpots of viscoelastic branches."""
    for i in (1, 2, 3):
        if (time := values.pop(f"branch_time_{i}", None)) is not None:
            values[f"branch_damping_{i}"] = values[f"branch_stiffness_{i}"] * time


def shaft(values: Values) -> None:
    rate, inertance = 2 * np.pi * values.pop("series_frequency"), values["inertance"]
    values["series_stiffness"] = inertance * rate**2
    if (loss := values.pop("series_loss", None)) is not None:
        values["series_damping"] = 2 * loss * rate * inertance


def leak(values: Values) -> None:
    values["leak_damping"] = 2 * np.pi * values.pop("leak_corner") * values["inertance"]


def breakaway(values: Values) -> None:
    values["static_force"] = values["coulomb_force"] + values.pop("static_excess")
    if "presliding" in values or not {"transition_velocity", "stribeck_velocity"} <= values.keys():
        return
    # a rise wider than the fall would take breakaway away again
    narrow = values["stribeck_velocity"] / 5
    values["transition_velocity"] = min(values["transition_velocity"], narrow)


def bristle(values: Values) -> None:
    distance = values.pop("presliding")
    if "bw_level" not in values:
        values["bristle_stiffness"] = values["coulomb_force"] / distance
        return
    level, shape = values.pop("bw_level"), values.pop("bw_shape")
    limit = distance ** -values.get("bw_exponent", 1.0)
    values["bw_stiffness"] = level / distance / (1 - values.get("bw_ratio", 0.0))
    values["bw_beta"], values["bw_gamma"] = shape * limit, (1 - shape) * limit


def power_knee(values: Values) -> None:
    values["damping_knee"] = values.pop("damping_power_knee")
