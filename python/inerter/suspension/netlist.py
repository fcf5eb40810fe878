"""A strut as a netlist: springs, dampers and inerters between named nodes, as many as one likes.

    spring   k   body   wheel      25e3
    inerter  b   body   n1         120
    damper   c   n1     wheel      1500

Nodes without mass between the terminals are eliminated exactly: with the polynomials
K + C s + B s^2 of the nodes' stiffness, damping and inertance,

    D(s) = det(N) / det(N_inner)

N over the inner nodes and one terminal while the other is held, N_inner over the inner nodes. That
is analytic in every value, so a complex step gives derivatives. Factors of s above and below, which
a series of damper and inerter leaves behind, are cancelled.
Range: up to 6 inner nodes. Not modelled: mass of nodes, gears other than the inerter itself.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from inerter.suspension.rational import Rational, add, multiply, polynomial

KINDS = {"spring": 0, "damper": 1, "inerter": 2}
"""Power of s in the dynamic stiffness of an element."""
TERMINALS = ("body", "wheel")
MOST_NODES = 6


class NetlistError(ValueError):
    """A netlist that is no strut; one line."""


@dataclass(frozen=True)
class Element:
    """`kind` "spring" [N/m], "damper" [N s/m] or "inerter" [kg] between `nodes`, by its `name`.

    `sought`: its value is to be found; `value` stands in its place until then.
    """

    kind: str
    name: str
    nodes: tuple[str, str]
    value: float
    sought: bool = False


@dataclass(frozen=True)
class Netlist:
    """Elements between "body", "wheel" and inner nodes.

    Raises
    ------
    NetlistError
        An unknown kind, a name twice, a value that is not positive, an element from a node to
        itself, a node that leads nowhere, too many nodes, or nothing between body and wheel.
    """

    elements: tuple[Element, ...]

    def __post_init__(self) -> None:
        """Check what was given, see Raises."""
        seen: set[str] = set()
        ends: dict[str, int] = {}
        for element in self.elements:
            if element.kind not in KINDS:
                raise NetlistError(f"{element.kind!r}: an element is {', '.join(KINDS)}")
            if element.name in seen:
                raise NetlistError(f"element {element.name!r} is there twice; rename one")
            seen.add(element.name)
            if not (np.isfinite(element.value) and element.value > 0.0):
                raise NetlistError(f"{element.name} is {element.value:g}: give a positive number")
            first, second = element.nodes
            if first == second:
                raise NetlistError(f"{element.name} leads from {first!r} to itself")
            for node in element.nodes:
                ends[node] = ends.get(node, 0) + 1
        for node in self.inner:
            if ends[node] < 2:
                raise NetlistError(f"node {node!r} leads nowhere: connect a second element")
        if len(self.inner) > MOST_NODES:
            raise NetlistError(f"{len(self.inner)} inner nodes: at most {MOST_NODES}")
        if not self._joined():
            raise NetlistError("nothing leads from 'body' to 'wheel': name the terminals so")

    @property
    def inner(self) -> tuple[str, ...]:
        """The nodes between the terminals."""
        nodes = dict.fromkeys(node for element in self.elements for node in element.nodes)
        return tuple(node for node in nodes if node not in TERMINALS)

    def _joined(self) -> bool:
        reached = {"body"}
        for _ in self.elements:
            for element in self.elements:
                if reached & set(element.nodes):
                    reached |= set(element.nodes)
        every = {node for element in self.elements for node in element.nodes}
        return "wheel" in reached and reached == every

    def stiffness(self, values: Mapping[str, ArrayLike] | None = None) -> Rational:
        """Dynamic stiffness D(s); `values` in place of the elements' own, by name, broadcast."""
        own = {element.name: element.value for element in self.elements}
        unknown = set(values or {}) - set(own)
        if unknown:
            raise NetlistError(f"no element {min(unknown)!r}: there are {', '.join(own)}")
        values = {**own, **(values or {})}
        nodes = ["body", *self.inner]
        matrix: list[list[Any]] = [[polynomial(0.0) for _ in nodes] for _ in nodes]
        for element in self.elements:
            power, value = KINDS[element.kind], np.asarray(values[element.name])
            part = polynomial(*([0.0] * power), value)
            places = [nodes.index(node) for node in element.nodes if node in nodes]
            for i in places:
                matrix[i][i] = add(matrix[i][i], part)
            if len(places) == 2:
                i, j = places
                matrix[i][j] = add(matrix[i][j], -part)
                matrix[j][i] = add(matrix[j][i], -part)
        top = _determinant(matrix)
        below = _determinant([row[1:] for row in matrix[1:]])
        while below.shape[-1] > 1 and not top[..., 0].any() and not below[..., 0].any():
            top, below = top[..., 1:], below[..., 1:]
        return Rational(top, below)


def read_netlist(lines: Iterable[str]) -> Netlist:
    """A netlist from lines "kind name node node value", "?" for a value that is sought; "#" begins
    a remark.

    Raises
    ------
    NetlistError
        A line that is not of this form, or what `Netlist` refuses.
    """
    found = []
    for number, line in enumerate(lines, 1):
        words = line.split("#")[0].split()
        if not words:
            continue
        if len(words) != 5:
            raise NetlistError(
                f"line {number}: {' '.join(words)!r}: write KIND NAME NODE NODE VALUE, as in "
                "damper c body n1 1500"
            )
        kind, name, first, second, text = words
        if text == "?":
            found.append(Element(kind, name, (first, second), 1.0, sought=True))
            continue
        try:
            value = float(text)
        except ValueError:
            raise NetlistError(f"line {number}: {text!r} is no number, in SI units") from None
        found.append(Element(kind, name, (first, second), value))
    return Netlist(tuple(found))


def is_positive_real(admittance: Rational, tolerance: float = 1e-9) -> bool:
    """Whether an admittance (force per velocity) is one of springs, dampers and inerters.

    No pole on the right, those on the axis simple with a positive real residue, and no negative
    real part at any frequency: at the real zeros of its even part and between them.

    Parameters
    ----------
    admittance
        Y(s) = D(s)/s of one design.
    tolerance
        Relative, of what counts as negative.
    """
    top, below = (_trimmed(np.real(p).ravel()) for p in
                  (admittance.numerator, admittance.denominator))  # fmt: skip
    if len(top) - len(below) > 1 or not below.any():
        return False
    unit = (abs(below[np.flatnonzero(below)[0]] / below[-1])) ** (1.0 / max(len(below) - 1, 1))
    unit = unit if np.isfinite(unit) and unit > 0.0 else 1.0
    top, below = top * unit ** np.arange(len(top)), below * unit ** np.arange(len(below))
    poles = np.roots(below[::-1])
    if np.any(poles.real > 1e-7 * np.maximum(1.0, np.abs(poles))):
        return False
    on_axis = poles[np.abs(poles.real) <= 1e-7 * np.maximum(1.0, np.abs(poles))]
    slope = np.polyder(np.poly1d(below[::-1]))
    for n, pole in enumerate(on_axis):
        if np.any(np.abs(np.delete(on_axis, n) - pole) < 1e-6):
            return False
        residue = np.polyval(top[::-1], pole) / slope(pole)
        if residue.real < -tolerance or abs(residue.imag) > 1e-6 * max(abs(residue), 1e-12):
            return False
    if len(top) > len(below) and top[-1] / below[-1] < 0.0:
        return False
    # real part of top(iw) conj(below(iw)), even in w: a polynomial in w^2
    product = np.polymul(top[::-1], (below * (-1.0) ** np.arange(len(below)))[::-1])[::-1]
    even = product[::2] * (-1.0) ** np.arange(len(product[::2]))
    # what is left of terms that cancel is none
    size = np.polymul(np.abs(top[::-1]), np.abs(below[::-1]))[::-1][::2]
    even = _trimmed(np.where(np.abs(even) <= 1e-12 * size, 0.0, even))
    roots = np.roots(even[::-1])
    real = roots.real[(np.abs(roots.imag) < 1e-7 * np.maximum(1.0, np.abs(roots)))]
    edges = np.unique(np.concatenate([[0.0], real[real > 0.0], [1e-6, 1e6]]))
    places = np.sqrt(np.concatenate([edges[1:], 0.5 * (edges[1:] + edges[:-1])]))
    values = np.polyval(even[::-1], places**2)
    scale = np.abs(np.polyval(np.abs(even[::-1]), places**2))
    return bool(np.all(values >= -1e3 * tolerance * scale))


def _trimmed(p: NDArray[Any]) -> NDArray[Any]:
    last = np.flatnonzero(p)
    return p[: last[-1] + 1] if last.size else p[:1]


def _determinant(matrix: list[list[Any]]) -> NDArray[Any]:
    """By the first row; polynomials do not divide."""
    if not matrix:
        return np.ones(1)
    total = polynomial(0.0)
    for column, entry in enumerate(matrix[0]):
        if not np.any(entry):
            continue
        rest = [row[:column] + row[column + 1 :] for row in matrix[1:]]
        term = multiply(entry, _determinant(rest))
        total = add(total, -term if column % 2 else term)
    return total
