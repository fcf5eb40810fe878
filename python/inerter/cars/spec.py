"""The model of a file: MJCF as it stands, or the model of a car file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import mujoco

from inerter.cars.mjcf import car_mjcf
from inerter.cars.read import read_car


def is_car_file(path: Path) -> bool:
    """Whether a file is one of a car, by its name."""
    return path.suffix.lower() == ".toml"


def model_spec(path: Path) -> Any:
    """The specification of a model file, .xml or the .toml of a car.

    Raises
    ------
    ValueError
        The file cannot be read as a model (of MuJoCo), or as a car (`CarError`).
    """
    if is_car_file(path):
        return mujoco.MjSpec.from_string(car_mjcf(read_car(path)))
    # the engine looks up attached models wrongly where the path is relative
    return mujoco.MjSpec.from_file(str(path.absolute()))
