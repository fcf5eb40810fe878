"""What a calculator asks for: each input declared once, read with or without a unit.

The command line, its help, the error texts and design.json all come from these declarations.
"""

from __future__ import annotations

import difflib
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from inerter.unit_text import parse_unit, split_quantity, unit_registry

PAPER = "printed in the ball-screw paper, Table 1"
CHOSEN = "chosen here, not printed"

# [m]; the parts of a device are shorter, a longer number is likelier millimetres
LONGEST_BARE = 1.0


class DesignError(ValueError):
    """An input that cannot be: names it, its value, what is allowed and what to do."""


@dataclass(frozen=True, kw_only=True)
class Input:
    """One number that a calculator needs.

    `unit` is its SI unit ("" for a plain number), `default` None where the part is absent or where
    it follows from others, `source` says where the default comes from. Values lie between `lower`
    and `upper`; `open_lower`, `open_upper` exclude the bound itself. `hint` ends an error about the
    range. A length above `longest_bare` [m] needs its unit: without one it is likelier millimetres.
    """

    name: str
    unit: str
    meaning: str
    default: float | None = None
    source: str = ""
    lower: float = 0.0
    upper: float = math.inf
    open_lower: bool = True
    open_upper: bool = False
    whole: bool = False
    required: bool = False
    hint: str = ""
    longest_bare: float = LONGEST_BARE

    def read(self, given: float | str) -> float:
        """The value in SI units of a number, or of a text such as "10 mm".

        Raises
        ------
        DesignError
            Not a number, another quantity's unit, out of range, a long length without a unit.
        """
        value = self._number(given)
        too_low = value < self.lower or (self.open_lower and value == self.lower)
        too_high = value > self.upper or (self.open_upper and value == self.upper)
        if not math.isfinite(value) or too_low or too_high or (self.whole and value % 1):
            hint = f"; {self.hint}" if self.hint else ""
            raise DesignError(f"{self.name} is {given} ({self.meaning}): give {self.allowed}{hint}")
        if self.unit == "m" and value > self.longest_bare and _is_bare(given):
            raise DesignError(
                f"{self.name} is {given} without a unit, which is {value:g} m ({self.meaning}): "
                f'above {self.longest_bare:g} m write the unit, "{value:g} mm" or "{value:g} m"'
            )
        return value

    @property
    def allowed(self) -> str:
        """The range in words."""
        bounds = [f"{'above' if self.open_lower else 'at least'} {self.lower:g}"]
        if math.isfinite(self.upper):
            bounds.append(f"{'below' if self.open_upper else 'at most'} {self.upper:.4g}")
        kind = "a whole number " if self.whole else "a number "
        return kind + " and ".join(bounds) + (f" {self.unit}" if self.unit else "")

    @property
    def help(self) -> str:
        """Meaning, unit, default and its source."""
        text = f"{self.meaning} [{self.unit or '-'}]"
        if self.default is not None:
            text += f"; default {self.default:g}"
        return text + (f" ({self.source})" if self.source else "") + "."

    def _number(self, given: float | str) -> float:
        if isinstance(given, bool) or not isinstance(given, (int, float, str)):
            raise DesignError(f"{self.name} is {given!r}: give a number or a text with a unit")
        if not isinstance(given, str):
            return float(given)
        found = split_quantity(given)
        if found is None:
            raise DesignError(
                f"{self.name} is {given!r}, not a number: write it as {self._example}"
            )
        number, unit = found
        return number if not unit else self._converted(number, unit, given)

    def _converted(self, number: float, unit: str, given: str) -> float:
        parsed = parse_unit(unit)
        refusal = DesignError(
            f"{self.name} is {given!r}, whose unit is not that of {self.meaning}: "
            f"write it as {self._example}"
        )
        if parsed is None:
            raise refusal
        try:
            quantity = unit_registry().Quantity(number, parsed).to(self.unit or "dimensionless")
        except (ArithmeticError, TypeError, ValueError):
            # another quantity
            raise refusal from None
        return float(quantity.magnitude)

    @property
    def _example(self) -> str:
        return f'a number in {self.unit}, or with a unit as in "3 {self.unit}"' if self.unit else (
            "a plain number"
        )  # fmt: skip


def _is_bare(given: float | str) -> bool:
    """Whether a number was given without a unit."""
    found = split_quantity(given) if isinstance(given, str) else (given, "")
    return found is not None and not found[1]


@dataclass(frozen=True, kw_only=True)
class Choice:
    """One input that is a word out of several."""

    name: str
    meaning: str
    choices: tuple[str, ...]
    default: str
    source: str = ""

    def read(self, given: object) -> str:
        """The word.

        Raises
        ------
        DesignError
            Not one of the choices.
        """
        if given not in self.choices:
            close = difflib.get_close_matches(str(given), self.choices, 1)
            hint = f" (did you mean {close[0]!r}?)" if close else ""
            raise DesignError(
                f"{self.name} is {given!r}{hint}: choose from {', '.join(self.choices)}"
            )
        return str(given)

    @property
    def help(self) -> str:
        """Meaning, choices and default."""
        source = f" ({self.source})" if self.source else ""
        return f"{self.meaning}: {', '.join(self.choices)}; default {self.default}{source}."


Declared = Sequence[Input | Choice]


@dataclass(frozen=True)
class Values:
    """The inputs of one calculation: what was given, and the defaults for the rest.

    `sources` says where a value comes from that stands in `given` without being stated by the user.
    """

    declared: Declared
    given: Mapping[str, float | str]
    sources: Mapping[str, str] = field(default_factory=dict)

    def number(self, name: str) -> float:
        """Value of an input that has a default or was given, SI units."""
        value = self.maybe(name)
        if value is None:
            raise KeyError(name)
        return value

    def maybe(self, name: str) -> float | None:
        """Value of an input, or None where it was not given and has no default."""
        found = self.given.get(name, self._of(name).default)
        return None if found is None else float(found)

    def word(self, name: str) -> str:
        """Value of a choice."""
        return str(self.given.get(name, self._of(name).default))

    def replace(self, **values: float | str) -> Values:
        """The same inputs with some values stated anew."""
        return Values(self.declared, {**self.given, **values}, self.sources)

    def derived(self, source: str, **values: float) -> Values:
        """The same inputs with values that were not stated, and where they come from."""
        sources = {**self.sources, **dict.fromkeys(values, source)}
        return Values(self.declared, {**self.given, **values}, sources)

    def stated(self, name: str) -> bool:
        """Whether the user stated an input."""
        return name in self.given and name not in self.sources

    def json(self) -> dict[str, Any]:
        """Every input with its value, unit, meaning and where it comes from."""
        found: dict[str, Any] = {}
        for item in self.declared:
            value = self.given.get(item.name, item.default)
            if value is None:
                continue
            found[item.name] = {
                "value": value,
                "unit": item.unit if isinstance(item, Input) else "",
                "meaning": item.meaning,
                "source": self._source(item),
            }
        return found

    def _source(self, item: Input | Choice) -> str:
        if item.name in self.given:
            return self.sources.get(item.name, "given")
        return f"default, {item.source}" if item.source else "default"

    def _of(self, name: str) -> Input | Choice:
        return next(item for item in self.declared if item.name == name)


def read_inputs(declared: Declared, given: Mapping[str, Any]) -> Values:
    """Read what was given against what is declared; None counts as not given.

    Raises
    ------
    DesignError
        An unknown name, or a value that cannot be.
    """
    known = {item.name: item for item in declared}
    for name in given:
        if name not in known:
            close = difflib.get_close_matches(name, known, 1)
            hint = f" (did you mean {close[0]!r}?)" if close else ""
            raise DesignError(f"{name} is not an input{hint}: the inputs are {', '.join(known)}")
    for item in declared:
        if isinstance(item, Input) and item.required and given.get(item.name) is None:
            raise DesignError(f"{item.name} is not given ({item.meaning}): give {item.allowed}")
    return Values(
        declared,
        {name: known[name].read(value) for name, value in given.items() if value is not None},
    )
