"""Curves along the stroke: what changes with the place, in values or in periods.

    f(x) = S(x) + sum over k of A_k sin(2 pi x / L_k + phi_k)

Symbols: x displacement [m]; S a cubic spline through values at evenly spaced places from
`curve_lower` to `curve_upper` [m], with slope 0 at both ends and constant beyond; L_k [m], A_k
[unit of f], phi_k [rad] length, amplitude and phase of each period.
Six quantities have one: `friction`, `friction_back` (relative rise of the level; the second for
v < 0), `inertance`, `inertance_back` (relative rise of b, alike), `force` [N], `viscous` [N s/m].
Each has two parameters, NAME_curve and NAME_periods (three numbers for every period).
Sign: tension positive for `force`.
Range: at most 64 values and 8 periods; friction level at least 0.001, inertance at least 0.01 of
what is stated, viscous damping at least 0.
Stored: the integral of `force` from 0 to x. The others store nothing here.
Source: SciPy's clamped cubic spline.
Not modelled: unevenly spaced values.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

Quantity = float | NDArray[np.float64]
"""A number, or an array of numbers that broadcasts against its neighbours."""

STROKES = ("friction", "friction_back", "inertance", "inertance_back", "force", "viscous")
LISTS = tuple(f"{name}_{kind}" for name in STROKES for kind in ("curve", "periods"))
MOST_VALUES, MOST_PERIODS = 64, 8


def flat(numbers: Any) -> tuple[float, ...]:
    """Numbers of a sequence, of one in threes, or of a text with blanks."""
    if isinstance(numbers, str):
        return tuple(float(word) for word in numbers.split())
    return tuple(float(number) for number in np.ravel(np.array(numbers, dtype=np.float64)))


@dataclass(frozen=True)
class Curve:
    """One quantity along the stroke; `values` from `lower` to `upper`, `periods` in threes."""

    values: tuple[float, ...]
    lower: float
    upper: float
    periods: tuple[float, ...]

    def __bool__(self) -> bool:
        """Whether there is anything."""
        return bool(self.values or self.periods)

    def __call__(self, x: Quantity) -> Quantity:
        """The quantity [its unit] at x [m]."""
        return self._of(x, 0)

    def slope(self, x: Quantity) -> Quantity:
        """Rate of f over x [its unit / m]."""
        return self._of(x, 1)

    def integral(self, x: Quantity) -> Quantity:
        """Integral of f from 0 to x [its unit m]."""
        return self._primitive(x) - self._primitive(0.0)

    def _of(self, x: Quantity, derivative: int) -> Quantity:
        total: Quantity = 0.0 * x
        if self.values:
            inside = np.clip(x, self.lower, self.upper)
            spline = _spline(self.values, self.lower, self.upper)
            found = spline(inside, derivative)
            total = total + (np.where(inside == x, found, 0.0) if derivative else found)
        for length, amplitude, phase in self._threes():
            wave = 2.0 * np.pi / length
            turned = np.cos if derivative else np.sin
            total = total + amplitude * wave**derivative * turned(wave * x + phase)
        return total

    def _primitive(self, x: Quantity) -> Quantity:
        total: Quantity = 0.0 * x
        if self.values:
            inside = np.clip(x, self.lower, self.upper)
            spline = _spline(self.values, self.lower, self.upper)
            total = total + spline.antiderivative()(inside) + spline(inside) * (x - inside)
        for length, amplitude, phase in self._threes():
            wave = 2.0 * np.pi / length
            total = total - amplitude / wave * np.cos(wave * x + phase)
        return total

    def _threes(self) -> list[tuple[float, ...]]:
        return [self.periods[i : i + 3] for i in range(0, len(self.periods), 3)]

    def least(self) -> tuple[float, float]:
        """The smallest value that is found, and where [m]."""
        lengths = [three[0] for three in self._threes()]
        margin = max(lengths, default=0.0)
        lower, upper = (self.lower, self.upper) if self.values else (0.0, 0.0)
        parts = [(upper - lower) / 16.0 / max(1, len(self.values) - 1)] if self.values else []
        fine = min([*parts, *(length / 32.0 for length in lengths)])
        count = min(4096, 1 + int((upper - lower + 2.0 * margin) / fine))
        places = np.linspace(lower - margin, upper + margin, count + 1)
        found = np.asarray(self(places))
        return float(found.min()), float(places[found.argmin()])


@lru_cache(maxsize=256)
def _spline(values: tuple[float, ...], lower: float, upper: float) -> CubicSpline:
    places = np.linspace(lower, upper, len(values))
    return CubicSpline(places, values, bc_type="clamped")


@dataclass(frozen=True, kw_only=True)
class StrokeParameters:
    """The lists of numbers; a sequence, one in threes for periods, or a text with blanks.

    Raises
    ------
    ValueError
        Too many numbers, a number that is not finite, a curve without its range, or one that leaves
        no inertance, friction level or damping somewhere.
    """

    friction_curve: Any = ()
    friction_periods: Any = ()
    friction_back_curve: Any = ()
    friction_back_periods: Any = ()
    inertance_curve: Any = ()
    inertance_periods: Any = ()
    inertance_back_curve: Any = ()
    inertance_back_periods: Any = ()
    force_curve: Any = ()
    force_periods: Any = ()
    viscous_curve: Any = ()
    viscous_periods: Any = ()

    @cached_property
    def along(self) -> dict[str, Curve]:
        """What changes along the stroke, by name; empty curves left out."""
        # those below are declared with the parameters that are numbers
        lower, upper = float(getattr(self, "curve_lower")), float(getattr(self, "curve_upper"))  # noqa: B009
        found = {}
        for name in STROKES:
            values, periods = getattr(self, f"{name}_curve"), getattr(self, f"{name}_periods")
            if values or periods:
                found[name] = Curve(values, lower, upper, periods)
        return found

    def _check_lists(self) -> None:
        for name in LISTS:
            numbers = flat(getattr(self, name))
            object.__setattr__(self, name, numbers)
            if not np.isfinite(numbers).all():
                raise ValueError(f"{name}: {numbers} has a number that is not finite")
            if name.endswith("_curve"):
                if len(numbers) == 1 or len(numbers) > MOST_VALUES:
                    raise ValueError(f"{name}: {len(numbers)} values; give 2 to {MOST_VALUES}")
            elif len(numbers) % 3 or len(numbers) > 3 * MOST_PERIODS:
                raise ValueError(f"{name}: {len(numbers)} numbers; give three for each period")
            elif any(length <= 0.0 for length in numbers[::3]):
                raise ValueError(f"{name}: {numbers} has a length that is not above 0; give m")

    def _check_along(self, friction: str, asymmetry: float, viscous: float) -> None:
        """How the lists fit to the rest, whose values these are."""
        given = {name for name, curve in self.along.items() if curve.values}
        lower, upper = getattr(self, "curve_lower"), getattr(self, "curve_upper")  # noqa: B009
        stated = not np.isnan(lower) or not np.isnan(upper)
        if stated != bool(given) or (given and not lower < upper):
            raise ValueError(
                f"curve_lower: {lower} m and curve_upper {upper} m; give both, in this order, "
                f"where there is a curve ({', '.join(sorted(given)) or 'none'}), and only there"
            )
        if friction == "none" and {"friction", "friction_back"} & set(self.along):
            raise ValueError("friction: 'none' has no level that changes; choose a friction law")
        if asymmetry != 0.0 and "friction_back" in self.along:
            raise ValueError(
                f"friction_asymmetry: {asymmetry} beside friction_back, which says the same; "
                "remove one of them"
            )
        base = {"inertance": (1.0, 0.01), "friction": (1.0, 1e-3), "viscous": (viscous, 0.0)}
        for name, curve in self.along.items():
            if name == "force":
                continue
            stated_value, least = base[name.removesuffix("_back")]
            value, where = curve.least()
            if stated_value + value < least:
                raise ValueError(
                    f"{name}: {stated_value + value} at x = {where} m is below {least}; give "
                    "values that leave at least that along the stroke"
                )
