"""car.toml: a car in a file.

[car]
kind = "half"                        # quarter, half (one side) or full
body_mass_kg = 730
pitch_inertia_kg_m2 = 1230
[front]
distance_m = 1.011
wheel_mass_kg = 40
tyre_stiffness_kN_per_m = 175.5
[front.strut]
layout = "S2"
stiffness_kN_per_m = 19.96
damping_N_s_per_m = 1290
inertance_kg = 30
device = "rack.toml"                 # friction, play, shaft of the inerter; its inertance too
[rear] ...

Units stand in the names, see `keys`. A quarter-car has [front] alone.
"""

from __future__ import annotations

import difflib
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from inerter.cars.keys import AXLE_KEYS, CAR_KEYS, STRUT_KEYS, UNITS, Key
from inerter.cars.parts import AxleParts, CarParts, StrutParts, Table
from inerter.cars.strut_device import strut_device
from inerter.device_file import read_bench_device
from inerter.input_file import read_toml

KINDS = ("quarter", "half", "full")
SHIPPED = Path(__file__).parents[1] / "data" / "cars"
"""Where the shipped cars are: quarter.toml, half.toml, full.toml."""

_SPRINGS = ("relaxation_stiffness", "damper_stiffness", "inerter_stiffness")
NEEDS: Mapping[str, tuple[str, ...]] = {
    "S1": (),
    "S2": ("inertance",),
    "S3": ("inertance",),
    "S4": ("inertance", "relaxation_stiffness"),
    "S5": ("inertance", "relaxation_stiffness"),
    "S6": ("inertance", "relaxation_stiffness"),
    "SR": ("relaxation_stiffness",),
    "SW7": ("inertance", "damper_stiffness", "inerter_stiffness"),
    "SW8": ("inertance", *_SPRINGS),
}
"""What a strut of each layout has beside spring and damper."""
SAME = {"SW1": "S1", "SW2": "SR", "SW3": "S2", "SW4": "S4", "SW5": "S3", "SW6": "S5"}
"""Layouts by other names."""


class CarError(ValueError):
    """A car file that cannot be used; one line: file, key, value, what is allowed."""


def read_car(path: str | Path) -> CarParts:
    """The car in a file.

    Raises
    ------
    CarError
        The file cannot be read, a key is not known or has no unit, a value is missing, impossible
        or not plausible.
    """
    path = Path(path)
    try:
        content = read_toml(path)
    except ValueError as error:
        raise CarError(str(error)) from None
    try:
        return _car(content, path)
    except CarError as error:
        raise CarError(f"{path}: {error}") from None


def shipped_car(kind: str) -> CarParts:
    """A shipped car, "quarter", "half" or "full"."""
    return read_car(SHIPPED / f"{kind}.toml")


def _car(content: Mapping[str, Any], path: Path) -> CarParts:
    extra = set(content) - {"schema", "car", "front", "rear"}
    if extra:
        raise CarError(f"table [{min(extra)}] is not known: there are [car], [front], [rear]")
    table = _table(content, "car")
    kind = table.pop("kind", None)
    if kind not in KINDS:
        raise CarError(f"[car] kind is {kind!r}: give one of {', '.join(KINDS)}")
    name = str(table.pop("name", path.stem))
    unusual = table.pop("unusual", [])
    if not isinstance(unusual, list) or not all(isinstance(each, str) for each in unusual):
        raise CarError('[car] unusual: give a list of names, as in ["front.tyre_stiffness"]')
    values = _values("car", table, CAR_KEYS, unusual)
    wanted = {"half": ("pitch_inertia",), "full": ("pitch_inertia", "roll_inertia", "track")}
    for key in wanted.get(kind, ()):
        if not values.get(key):
            raise CarError(
                f"[car] {CAR_KEYS[key].spellings(key)[0]} is missing: a {kind} car has it"
            )
    front = _axle("front", _table(content, "front"), unusual, kind, path.parent)
    if kind == "quarter":
        if "rear" in content:
            raise CarError("[rear]: a quarter-car has one wheel, [front]")
        rear = None
    else:
        rear = _axle("rear", _table(content, "rear"), unusual, kind, path.parent)
    every: dict[str, Any] = dict(values)
    car = CarParts(kind=kind, name=name, front=front, rear=rear, **every)
    _refuse_sagging(car, unusual)
    return car


def _axle(
    name: str, table: dict[str, Any], unusual: list[str], kind: str, folder: Path
) -> AxleParts:
    strut = table.pop("strut", None)
    if not isinstance(strut, dict):
        raise CarError(
            f"[{name}.strut] is missing: give stiffness, damping and layout of the strut"
        )
    values = _values(name, table, AXLE_KEYS, unusual)
    if kind != "quarter" and not values.get("distance"):
        raise CarError(f"[{name}] distance_m is missing: from the centre of mass to the axle")
    if kind != "full" and values.get("anti_roll_stiffness"):
        raise CarError(f"[{name}] anti_roll_stiffness: a {kind} car does not roll; give a full car")
    every: dict[str, Any] = dict(values)
    return AxleParts(strut=_strut(f"{name}.strut", dict(strut), unusual, folder), **every)


def _strut(name: str, table: dict[str, Any], unusual: list[str], folder: Path) -> StrutParts:
    layout = str(table.pop("layout", "S1"))
    layout = SAME.get(layout, layout)
    if layout not in NEEDS:
        raise CarError(f"[{name}] layout is {layout!r}: there are {', '.join([*NEEDS, *SAME])}")
    tables: dict[str, Table] = {}
    for key in ("damper_bump", "damper_rebound"):
        for unit, factor in UNITS["table"].items():
            if f"{key}_{unit}" in table:
                where = f"[{name}] {key}_{unit}"
                tables[key] = _damper(where, table.pop(f"{key}_{unit}"), factor)
    device: dict[str, float | str] = {}
    if "device" in table:
        own, device = _device(name, layout, table.pop("device"), folder)
        if own and not any(key.startswith("inertance_") for key in table):
            table["inertance_kg"] = own
    values = _values(name, table, STRUT_KEYS, unusual)
    for key in NEEDS[layout]:
        if not values.get(key):
            needed = STRUT_KEYS[key].spellings(key)[0]
            raise CarError(f"[{name}] {needed} is missing: layout {layout} has it")
    for key in ("inertance", *_SPRINGS):
        if values.get(key) and key not in NEEDS[layout]:
            raise CarError(f"[{name}] {key}: layout {layout} has none; choose another layout")
    if tables and values.get("damping"):
        raise CarError(f"[{name}] damping and a damper table: give one of the two")
    if len(tables) == 1:
        raise CarError(f"[{name}] one damper table: give damper_bump and damper_rebound")
    if not tables and not values.get("damping"):
        raise CarError(f"[{name}] damping_N_s_per_m is missing, or two damper tables")
    every: dict[str, Any] = {**values, **tables}
    return StrutParts(layout=layout, device=tuple(device.items()), **every)


def _device(
    name: str, layout: str, file: Any, folder: Path
) -> tuple[float, dict[str, float | str]]:
    """Inertance [kg] of a device's file, 0 where it states none, and what else it has."""
    if not isinstance(file, str):
        raise CarError(f"[{name}] device is {file!r}: give the name of its file, device.toml")
    if "inertance" not in NEEDS[layout]:
        raise CarError(f"[{name}] device: layout {layout} has no inerter; choose another layout")
    try:
        device = read_bench_device(folder / file)
        return float(device.given.get("inertance", 0.0)), strut_device(device)
    except ValueError as error:
        raise CarError(f"[{name}] device = {file!r}: {error}") from None


def _values(
    where: str, table: Mapping[str, Any], keys: Mapping[str, Key], unusual: list[str]
) -> dict[str, float]:
    found: dict[str, float] = {}
    spelled = {
        spelling: (name, factor)
        for name, key in keys.items()
        for spelling, factor in zip(key.spellings(name), UNITS[key.quantity].values(), strict=True)
    }
    for spelling, value in table.items():
        if spelling in keys and spelling not in spelled:
            units = ", ".join(keys[spelling].spellings(spelling))
            raise CarError(f"[{where}] {spelling} has no unit: write {units}")
        if spelling not in spelled:
            near = difflib.get_close_matches(spelling, spelled, n=1)
            hint = f"; did you mean {near[0]}?" if near else f"; there are {', '.join(spelled)}"
            raise CarError(f"[{where}] {spelling} is not known{hint}")
        name, factor = spelled[spelling]
        if name in found:
            raise CarError(f"[{where}] {name} is there twice, in two units: leave one out")
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise CarError(f"[{where}] {spelling} is {value!r}: give a number")
        found[name] = _plausible(where, name, spelling, float(value), factor, keys[name], unusual)
    for name, key in keys.items():
        if key.needed and name not in found:
            raise CarError(f"[{where}] {key.spellings(name)[0]} is missing: {key.meaning}")
    return found


def _plausible(
    where: str, name: str, spelling: str, number: float, factor: float, key: Key, unusual: list[str]
) -> float:
    value = number * factor
    if not (math.isfinite(value) and value >= 0.0) or (key.needed and value == 0.0):
        raise CarError(f"[{where}] {spelling} is {number:g}: give a positive number")
    if (value == 0.0 and not key.needed) or key.low <= value <= key.high:
        return value
    if f"{where}.{name}" in unusual:
        return value
    meant = [
        other
        for other, scale in zip(key.spellings(name), UNITS[key.quantity].values(), strict=True)
        if key.low <= number * scale <= key.high
    ]
    question = f"; did you mean {meant[0]} = {number:g}?" if meant else ""
    raise CarError(
        f"[{where}] {spelling} is {number:g}, {key.meaning}: usual is {key.low / factor:g} to "
        f'{key.high / factor:g}{question} If it is right, write unusual = ["{where}.{name}"] '
        "under [car]"
    )


def _damper(where: str, value: Any, factor: float) -> Table:
    try:
        points = tuple((float(v) * factor, float(force)) for v, force in value)
    except (TypeError, ValueError):
        raise CarError(
            f"{where}: give pairs [speed, force], as in [[0.1, 300], [0.5, 900]]"
        ) from None
    speeds, forces = [v for v, _ in points], [f for _, f in points]
    rising = all(a < b for a, b in zip([0.0, *speeds], speeds, strict=False))
    climbing = all(a <= b for a, b in zip([0.0, *forces], forces, strict=False))
    if not points or not (rising and climbing and all(math.isfinite(x) for x in speeds + forces)):
        raise CarError(
            f"{where}: speeds have to increase from above 0, forces may not fall or be negative"
        )
    if speeds[-1] > 20.0:
        raise CarError(
            f"{where}: {speeds[-1]:g} m/s; did you mean mm/s, a name that ends mm_per_s_N?"
        )
    return points


def _refuse_sagging(car: CarParts, unusual: list[str]) -> None:
    """Springs that are so soft that the body would rest a metre lower have another unit."""
    for name, load in car.static_loads.items():
        axle = car.axles[name]
        sag = (load - 9.81 * axle.wheel_mass) / axle.strut.wheel_rate
        if sag > 1.0 and f"{name}.sag" not in unusual:
            raise CarError(
                f"[{name}.strut] stiffness {axle.strut.stiffness:g} N/m yields {sag:.2g} m under "
                f"the body's {load:.0f} N: check unit, motion ratio and mass, or write unusual = "
                f'["{name}.sag"] under [car]'
            )


def _table(content: Mapping[str, Any], name: str) -> dict[str, Any]:
    table = content.get(name)
    if not isinstance(table, dict):
        raise CarError(
            f"[{name}] is missing; a car file has [car], [front] and, but for a quarter, [rear]"
        )
    return dict(table)
