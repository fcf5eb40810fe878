"""Which optima are asked for, in a user's words, and the errors of those words."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field

import numpy as np

from inerter.suspension.indices import INDICES, indices_of
from inerter.suspension.layouts import HARD, LAYOUTS, SOFT, SeriesPair
from inerter.suspension.own_index import is_own
from inerter.suspension.problem import Catalogue, SuspensionProblem
from inerter.suspension.quarter_car import QuarterCar, Road
from inerter.suspension.variations import scenes_of
from inerter.suspension.vehicle.cars import Vehicle
from inerter.suspension.vehicle.problem import VehicleProblem

SERIES: Mapping[str, SeriesPair | None] = {"none": None, "soft": SOFT, "hard": HARD}
"""Series pairs that have a name."""


class StudyError(ValueError):
    """What is asked for cannot be computed: one sentence with the value and what is allowed."""


@dataclass(frozen=True, kw_only=True)
class Case:
    """One optimum that is asked for: its name in the results and the problem behind it.

    `stiffness` is that of the front where front and `rear` have their own.
    """

    layout: str
    index: str
    stiffness: float
    series: str
    problem: SuspensionProblem | VehicleProblem
    rear: float | None = None


@dataclass(frozen=True, kw_only=True)
class Study:
    """Every combination of layouts, indices, stiffnesses [N/m] and series pairs by name.

    `fixed` variables have a value, those of a `catalogue` one of some; `limits` are kept. What may
    `vary` by factors is averaged over. A half- or full car has `stiffnesses` of front and rear, and
    struts that may be `equal` but for those.
    """

    layouts: tuple[str, ...]
    indices: tuple[str, ...]
    stiffnesses: tuple[float, ...] | tuple[tuple[float, float], ...]
    series: Mapping[str, SeriesPair | None]
    car: QuarterCar | Vehicle = field(default_factory=QuarterCar)
    road: Road = field(default_factory=Road)
    equal: bool = False
    fixed: tuple[tuple[str, float], ...] = ()
    limits: tuple[tuple[str, float], ...] = ()
    catalogue: Catalogue = ()
    vary: tuple[tuple[str, tuple[float, ...]], ...] = ()

    def __post_init__(self) -> None:
        """Refuse an index that the car, or what varies, has not."""
        if self.vary and "J5" in (*self.indices, *dict(self.limits)):
            raise StudyError("J5 with --vary: a largest value has no mean; take another index")
        refuse_turning((*self.indices, *dict(self.limits)), self.car)

    def cases(self) -> Iterator[Case]:
        """The combinations in order. S1 has no inerter: its problem is the same in each series."""
        for layout in self.layouts:
            for index in self.indices:
                for name, pair in self.series.items():
                    used = pair if LAYOUTS[layout].has_inerter else None
                    for k in self.stiffnesses:
                        yield self._case(layout, index, k, name, used)

    def _case(
        self,
        layout: str,
        index: str,
        stiffness: float | tuple[float, float],
        name: str,
        pair: SeriesPair | None,
    ) -> Case:
        if isinstance(self.car, QuarterCar):
            if isinstance(stiffness, tuple):
                raise StudyError("stiffness: a quarter-car has one, not front and rear")
            problem = SuspensionProblem(
                car=self.car,
                road=self.road,
                layout=layout,
                index=index,
                stiffness=stiffness,
                pair=pair,
                fixed=self.fixed,
                limits=self.limits,
                catalogue=self.catalogue,
                scenes=scenes_of(self.car, self.road, dict(self.vary)),
            )
            _refuse_many(problem)
            return Case(
                layout=layout, index=index, stiffness=stiffness, series=name, problem=problem
            )
        if not isinstance(stiffness, tuple):
            raise StudyError("stiffness: a half- or full car has two, front and rear")
        problem = VehicleProblem(
            car=self.car,
            road=self.road,
            layout=layout,
            index=index,
            stiffnesses=stiffness,
            pair=pair,
            equal=self.equal,
            fixed=(self.fixed, self.fixed),
            limits=self.limits,
            catalogue=self.catalogue,
            scenes=scenes_of(self.car, self.road, dict(self.vary)),
        )
        _refuse_many(problem)
        return Case(
            layout=layout,
            index=index,
            stiffness=stiffness[0],
            series=name,
            problem=problem,
            rear=stiffness[1],
        )


MOST_CHOICES = (20_000, 400, 60)
"""Choices from a catalogue that are tried: nothing else free; a quarter-car; two axles."""


def _refuse_many(problem: SuspensionProblem | VehicleProblem) -> None:
    sizes = {name: len(x) for name, x in problem.catalogue if name in problem.network.variables}
    vehicle = isinstance(problem, VehicleProblem)
    count = math.prod(sizes.values()) ** (2 if vehicle and not problem.equal else 1)
    fixed = problem.fixed[0] if isinstance(problem, VehicleProblem) else problem.fixed
    free = not set(problem.network.variables) <= {*sizes, *(name for name, _ in fixed)}
    most = MOST_CHOICES[(2 if vehicle else 1) if free else 0]
    if count > most:
        raise StudyError(
            f"catalogue: {count} choices for {problem.layout}, at most {most} are tried where "
            f"{'the rest is sought' if free else 'nothing else is free'}; shorten it, --hold a "
            "variable, or put all of them into the catalogue"
            + (", or take --equal struts" if vehicle and not problem.equal else "")
        )


def read_catalogue(text: str | None, known: Iterable[str], what: str = "catalogue") -> Catalogue:
    """NAME=VALUE/VALUE/... with commas between names, SI units.

    Raises
    ------
    StudyError
        A name that is not known, or values that are not positive.
    """
    found: dict[str, tuple[float, ...]] = {}
    for word in _words(text, what) if text else []:
        name, sign, values = word.partition("=")
        if not sign:
            raise StudyError(f"{what} {word!r}: write NAME=VALUE/VALUE, as in damping=0.8/1.2")
        (own,) = read_names(name, known, what)
        sizes = {_positive(each, f"{what} of {own}") for each in values.split("/")}
        found[own] = tuple(sorted(sizes))
    return tuple(found.items())


def refuse_turning(indices: Iterable[str], car: QuarterCar | Vehicle) -> None:
    """Raise StudyError for an index of pitch or roll of a car that has none."""
    sides = None if isinstance(car, QuarterCar) else car.sides
    for name in indices:
        own = INDICES[name]
        # of a function also the signals that its parts are of
        parts = [x for part in own.parts for x in (part, INDICES[part].signal)]
        for each in (name, own.signal, *parts):
            if each in ("pitch", "roll") and each not in indices_of(sides):
                of = "a quarter-car has none" if sides is None else "it takes a full car"
                raise StudyError(f"index {name!r} is of {each}: {of}")


def read_names(text: str, known: Iterable[str], what: str) -> tuple[str, ...]:
    """Names from a list with commas.

    Raises
    ------
    StudyError
        One of them is not known.
    """
    allowed = {name.lower(): name for name in known}
    words = _words(text, what)
    for word in words:
        if what in ("index", "limit") and is_own(word):
            # it is read now: what is wrong in it is said before the work
            allowed[word.lower()] = INDICES[word].name
        if word.lower() not in allowed:
            raise StudyError(f"{what} {word!r} is not known: choose from {', '.join(known)}")
    return tuple(dict.fromkeys(allowed[word.lower()] for word in words))


def read_layouts(text: str) -> tuple[str, ...]:
    """Names of layouts from a list with commas."""
    return read_names(text, LAYOUTS, "layout")


def read_indices(text: str) -> tuple[str, ...]:
    """Names of indices from a list with commas."""
    return read_names(text, INDICES, "index")


def read_stiffnesses(text: str) -> tuple[float, ...]:
    """Stiffnesses [N/m]: numbers and ranges first:last:count, with commas between.

    Raises
    ------
    StudyError
        Not a number, not positive, or not a range.
    """
    values: list[float] = []
    for word in _words(text, "stiffness"):
        parts = word.split(":")
        if len(parts) == 1:
            values.append(stiffness_of(word))
        elif len(parts) == 3:
            first, last = (stiffness_of(part) for part in parts[:2])
            if not (parts[2].strip().isdigit() and 2 <= int(parts[2]) <= 100_000):
                raise StudyError(
                    f"stiffness range {word!r}: the count {parts[2]!r} is not a whole number "
                    "from 2; give FIRST:LAST:COUNT as in 10e3:300e3:59"
                )
            values += np.linspace(first, last, int(parts[2])).tolist()
        else:
            raise StudyError(
                f"stiffness {word!r} is neither a number nor a range FIRST:LAST:COUNT, "
                "as in 120e3 or 10e3:300e3:59"
            )
    return tuple(dict.fromkeys(values))


def read_axle_stiffnesses(text: str | None, car: Vehicle) -> tuple[tuple[float, float], ...]:
    """Stiffnesses [N/m] of front and rear: KF/KR, or as `read_stiffnesses` for the front.

    Where the front's is given alone the rear's follows with the ratio of the car's own; without a
    text both are the car's own.

    Raises
    ------
    StudyError
        Not a number, not positive, not a range or not a pair.
    """
    ratio = car.rear.stiffness / car.front.stiffness
    if text is None:
        return ((car.front.stiffness, car.rear.stiffness),)
    values: list[tuple[float, float]] = []
    for word in _words(text, "stiffness"):
        parts = word.split("/")
        if len(parts) == 2:
            front, rear = (stiffness_of(part) for part in parts)
            values.append((front, rear))
        elif len(parts) == 1:
            values += [(k, k * ratio) for k in read_stiffnesses(word)]
        else:
            raise StudyError(
                f"stiffness {word!r} is not of the form KF/KR, front and rear, as in 20e3/18e3"
            )
    return tuple(dict.fromkeys(values))


def read_series(text: str) -> dict[str, SeriesPair | None]:
    """Series pairs by name, or KS/CS in N/m and N s/m, with commas between.

    Raises
    ------
    StudyError
        Neither a name nor two positive numbers.
    """
    pairs: dict[str, SeriesPair | None] = {}
    for word in _words(text, "series"):
        if word.lower() in SERIES:
            pairs[word.lower()] = SERIES[word.lower()]
            continue
        parts = word.split("/")
        if len(parts) != 2:
            raise StudyError(
                f"series {word!r} is not known: choose from {', '.join(SERIES)} or give KS/CS "
                "in N/m and N s/m, as in 1e6/3200"
            )
        stiffness = _positive(parts[0], "series stiffness")
        pairs[word] = SeriesPair(stiffness, _positive(parts[1], "series damping"))
    return pairs


def read_pairs(text: str | None, known: Iterable[str], what: str) -> tuple[tuple[str, float], ...]:
    """NAME=VALUE with commas between, values positive and in SI units.

    Raises
    ------
    StudyError
        A name that is not known, or not of this form.
    """
    pairs: dict[str, float] = {}
    for word in _words(text, what) if text else []:
        name, sign, value = word.partition("=")
        if not sign:
            raise StudyError(f"{what} {word!r}: write NAME=VALUE, as in {next(iter(known))}=1")
        (found,) = read_names(name, known, what)
        pairs[found] = _positive(value, f"{what} of {found}")
    return tuple(pairs.items())


def _words(text: str, what: str) -> list[str]:
    words = [word.strip() for word in text.split(",") if word.strip()]
    if not words:
        raise StudyError(f"{what} is empty: give one or more, with commas between")
    return words


SOFTEST = 1e3
"""Stiffness [N/m] below which no car stands: the unit most likely is another."""


def stiffness_of(text: str) -> float:
    """A stiffness [N/m] that a car can have.

    Raises
    ------
    StudyError
        Not a positive number, or so small that it most likely is in kN/m.
    """
    value = _positive(text, "stiffness")
    if value < SOFTEST:
        raise StudyError(
            f"stiffness is {value:g} N/m, on which no car stands: give N/m; did you mean "
            f"{value:g}e3, {value:g} kN/m?"
        )
    return value


def _positive(text: str, what: str) -> float:
    try:
        value = float(text)
    except ValueError:
        raise StudyError(
            f"{what} {text.strip()!r} is not a number: write it in SI units, without the unit"
        ) from None
    if not (math.isfinite(value) and value > 0.0):
        raise StudyError(f"{what} is {text.strip()}: give a positive number")
    return value
