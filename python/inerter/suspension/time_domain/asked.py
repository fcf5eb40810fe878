"""What a user asks for, in words: cars, cases, designs, and the errors of those words."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from inerter.cars.read import read_car
from inerter.model_parameters import QUARTER_CAR
from inerter.suspension.car_options import linear_car, refuse_faint_damping
from inerter.suspension.layouts import LAYOUTS
from inerter.suspension.quarter_car import QuarterCar
from inerter.suspension.study import stiffness_of
from inerter.suspension.time_domain.cases import CASES, NUMBERED, Case, case_named
from inerter.suspension.time_domain.device_case import NAME, read_case
from inerter.suspension.time_domain.model import Car
from inerter.suspension.vehicle.cars import FullCar, HalfCar, full_car, half_car

BEST = "best"
"""What --inertance is where the inertance of a device's file is not to be kept."""

_DEFAULT = "ideal,friction,elastic,both"


@dataclass(frozen=True)
class Asked:
    """A car with what goes with it: front `stiffness` [N/m], `amplitude` [N], `settle` [s]."""

    car: Car
    stiffness: float
    amplitude: float
    settle: float


def car_named(name: str) -> Asked:
    """The quarter-car of Wang and Su, the published half- or full car, or that of a file.

    Raises
    ------
    ValueError
        No such car.
    """
    if name == "quarter":
        return Asked(QuarterCar(), QUARTER_CAR.stiffness, 1000.0, 4.0)
    if name in ("half", "full"):
        car = half_car() if name == "half" else full_car()
        return _of_two_axles(car)
    if name.lower().endswith(".toml"):
        parts = read_car(name)
        own = linear_car(parts)
        if isinstance(own, QuarterCar):
            return Asked(own, parts.front.strut.wheel_rate, 1000.0, 4.0)
        return _of_two_axles(own)
    raise ValueError(f"car {name!r}: take quarter, half or full, or a file car.toml")


def _of_two_axles(car: HalfCar | FullCar) -> Asked:
    # pitch rings for longer; the load is one for each side
    return Asked(car, car.front.stiffness, 2000.0 * car.sides, 10.0)


def refuse_ratio(car: str, device: Path | None) -> None:
    """A device of a strut that moves by another way than its wheel.

    Raises
    ------
    ValueError
        The values of its file are the strut's, and would be taken for the wheel's.
    """
    if device is None or not car.lower().endswith(".toml"):
        return
    parts = read_car(car)
    for name, axle in (("front", parts.front), ("rear", parts.rear)):
        ratio = axle.strut.motion_ratio if axle else 1.0
        if ratio != 1.0:
            raise ValueError(
                f"{car}: {name}.strut.motion_ratio is {ratio:g}, but a device of --device is taken "
                f'to move as the wheel does: state device = "{device.name}" under [{name}.strut] '
                "and take --layout own, or a motion_ratio of 1 and the device as the wheel feels it"
            )


def cases_asked(
    text: str | None, device: Path | None, step: float
) -> tuple[tuple[Case, ...], float | None]:
    """The cases, and the inertance of the device's file [kg], None without a device.

    Raises
    ------
    ValueError
        A case that is not known, a file that cannot be used.
    """
    default = _DEFAULT if device is None else "ideal"
    wanted = words(default if text is None else text, "case")
    if wanted == ("tables",):
        numbered = {each.case for each in NUMBERED}
        wanted = tuple(name for name in CASES if name in numbered)
    if device is None:
        if NAME in wanted:
            raise ValueError(f"case {NAME!r} is that of a file: give it with --device device.toml")
        return tuple(case_named(name) for name in wanted), None
    case, own = read_case(device, step)
    return (*(case_named(name) for name in wanted if name != NAME), case), own


def given_struts(
    damping: str | None, inertance: str | None, own: float | None, car: str
) -> tuple[tuple[float | None, float | None], ...]:
    """(c, b) of every strut, None for what is sought; empty where both are to be optimal.

    `own` is the inertance of the device's file [kg]: it is kept unless --inertance says otherwise,
    a number or "best".

    Raises
    ------
    ValueError
        They are not numbers, or the file states no inertance.
    """
    if inertance is None and own is not None:
        if not own > 0.0:
            raise ValueError(
                "the file of --device states no inertance: give it there, or --inertance here "
                "(best: the best one for each layout)"
            )
        inertance = repr(own)
    if inertance == BEST:
        inertance = None
    if damping is None and inertance is None:
        return ()
    dampings = (None,) if damping is None else _struts(damping, "damping", car)
    inertances = (None,) if inertance is None else _struts(inertance, "inertance", car)
    count = max(len(dampings), len(inertances))
    dampings, inertances = (x * (count // len(x)) for x in (dampings, inertances))
    return tuple(zip(dampings, inertances, strict=True))


def layouts_asked(text: str) -> tuple[str, ...]:
    """Layouts by the names that they have here, whichever they are asked for by."""
    asked = words(text, "layout")
    return tuple(dict.fromkeys(LAYOUTS[n].own if n in LAYOUTS else n for n in asked))


def tyre_named(name: str | None) -> bool | None:
    """Whether tyres leave the road; None where that is not said.

    Raises
    ------
    ValueError
        Neither "one-sided" nor "pulling".
    """
    known = {None: None, "one-sided": True, "pulling": False}
    if name not in known:
        raise ValueError(f"--tyre is {name!r}: give one-sided or pulling")
    return known[name]


def words(text: str, option: str) -> tuple[str, ...]:
    """Names separated by commas, each once.

    Raises
    ------
    ValueError
        There are none.
    """
    found = tuple(dict.fromkeys(part.strip() for part in text.split(",") if part.strip()))
    if not found:
        raise ValueError(f"--{option} is empty; see --help")
    return found


def numbers(text: str, option: str) -> tuple[float, ...]:
    """Numbers separated by commas.

    Raises
    ------
    ValueError
        One of them is none.
    """
    try:
        values = tuple(float(name) for name in words(text, option))
    except ValueError:
        raise ValueError(
            f"--{option} is {text!r}: give numbers, such as 120e3, with commas between them"
        ) from None
    if option == "stiffness":
        for value in values:
            if value > 0.0:
                stiffness_of(repr(value))
    return values


def _struts(text: str, option: str, car: str) -> tuple[float, ...]:
    """One number, or front/rear."""
    parts = text.split("/")
    if len(parts) > (1 if car == "quarter" else 2):
        raise ValueError(f"--{option} is {text!r}: give one number for the {car}-car's strut")
    try:
        values = tuple(float(part) for part in parts)
    except ValueError:
        form = "a number" if car == "quarter" else "a number or FRONT/REAR"
        raise ValueError(f"--{option} is {text!r}: give {form}") from None
    for value in values if option == "damping" else ():
        refuse_faint_damping(value, "--damping")
    return values
