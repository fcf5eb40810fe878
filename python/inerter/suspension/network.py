"""A strut as a netlist of springs, dampers and inerters: its dynamic stiffness, exactly.

With the admittances y(s) = k, c s, b s^2 of the elements, forces per displacement, and terminals
"body" and "wheel", the nodes between having no mass, the matrix-tree theorem gives

    D(s) = T / F,  T = sum over spanning trees of the products of their y,
                   F = the same over forests of two trees that part the terminals.

Every product is one power of s with a positive coefficient, so nothing cancels: inner nodes are
eliminated exactly, and a power of s that numerator and denominator share is taken out as such.
Source: Kirchhoff; Seshu and Reed, Linear Graphs and Electrical Networks, 1961, chapter 7.
Not modelled: masses at nodes, friction, transformers (levers) inside the network.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any

from inerter.suspension.rational import Rational, polynomial

TERMINALS = ("body", "wheel")
POWERS: Mapping[str, int] = {"spring": 0, "damper": 1, "inerter": 2}
"""Kinds of elements, and the power of s of each."""

_MOST_NODES, _MOST_ELEMENTS = 7, 12


class NetworkError(ValueError):
    """A netlist that is none: one sentence with the element, what is wrong and what to do."""


@dataclass(frozen=True)
class Element:
    """`kind` "spring", "damper" or "inerter" between nodes `first` and `second`.

    `value`: a number [N/m], [N s/m], [kg], or the name of the parameter that gives it.
    """

    kind: str
    value: str | float
    first: str
    second: str


@dataclass(frozen=True)
class Network:
    """Elements between the terminals "body" and "wheel" and inner nodes without mass.

    Raises
    ------
    NetworkError
        An unknown kind, a value that is not positive, an element without effect, terminals that
        are not joined, more nodes or elements than are handled.
    """

    elements: tuple[Element, ...]

    def __post_init__(self) -> None:
        for one in self.elements:
            name = f"{one.kind} {one.value} between {one.first} and {one.second}"
            if one.kind not in POWERS:
                raise NetworkError(f"{name}: a kind is one of {', '.join(POWERS)}")
            if one.first == one.second:
                raise NetworkError(f"{name}: both ends are one node; give two")
            number = one.value
            if not isinstance(number, str) and not 0.0 < number < math.inf:
                raise NetworkError(f"{name}: give a positive number or a name")
        if len(self.elements) > _MOST_ELEMENTS or len(self.nodes) > _MOST_NODES:
            raise NetworkError(
                f"a network of {len(self.elements)} elements and {len(self.nodes)} nodes: at most "
                f"{_MOST_ELEMENTS} and {_MOST_NODES}; join elements of one kind"
            )
        if not self._trees[0]:
            raise NetworkError("the elements do not join body and wheel and all nodes: join them")
        used = {n for tree in self._trees[0] for n in tree}
        for n, one in enumerate(self.elements):
            alone = all(n in tree for tree in self._trees[0])
            dangling = alone and all(n in forest for forest in self._trees[1])
            if n not in used or dangling:
                raise NetworkError(
                    f"{one.kind} {one.value} between {one.first} and {one.second} carries no "
                    "force: one of its nodes leads nowhere"
                )

    @cached_property
    def nodes(self) -> tuple[str, ...]:
        """The terminals, then the inner nodes."""
        ends = (node for one in self.elements for node in (one.first, one.second))
        return tuple(dict.fromkeys([*TERMINALS, *ends]))

    @cached_property
    def parameters(self) -> dict[str, str]:
        """Kind of each named parameter."""
        return {one.value: one.kind for one in self.elements if isinstance(one.value, str)}

    @cached_property
    def _trees(self) -> tuple[tuple[tuple[int, ...], ...], tuple[tuple[int, ...], ...]]:
        place = {node: n for n, node in enumerate(self.nodes)}
        edges = tuple((place[one.first], place[one.second]) for one in self.elements)
        return _spanning(edges, len(self.nodes), False), _spanning(edges, len(self.nodes), True)

    def stiffness(self, values: Mapping[str, Any]) -> Rational:
        """D(s) for values of the named parameters, numbers or arrays that broadcast."""
        numbers = [
            values[one.value] if isinstance(one.value, str) else one.value for one in self.elements
        ]
        top, below = (self._sum(trees, numbers) for trees in self._trees)
        shared = min(min(top), min(below))
        return Rational(_dense(top, shared), _dense(below, shared))

    def behind(self, pair: Mapping[str, float]) -> Network:
        """The same with every inerter behind a spring and a damper side by side.

        `pair`: "spring" [N/m] and "damper" [N s/m]; what is 0 is left out.
        """
        found: list[Element] = []
        for n, one in enumerate(self.elements):
            if one.kind != "inerter":
                found.append(one)
                continue
            node = f"shaft {n}"
            found.append(Element("inerter", one.value, one.first, node))
            found += [Element(kind, x, node, one.second) for kind, x in pair.items() if x]
        return Network(tuple(found))

    def without(self, parameter: str) -> Network:
        """The same without the elements of a parameter."""
        return Network(tuple(one for one in self.elements if one.value != parameter))

    def _sum(self, trees: tuple[tuple[int, ...], ...], numbers: list[Any]) -> dict[int, Any]:
        found: dict[int, Any] = {}
        for tree in trees:
            power = sum(POWERS[self.elements[n].kind] for n in tree)
            product = math.prod((numbers[n] for n in tree), start=1.0)
            found[power] = found[power] + product if power in found else product
        return found


def _dense(terms: Mapping[int, Any], shared: int) -> Any:
    return polynomial(*(terms.get(power, 0.0) for power in range(shared, max(terms) + 1)))


@cache
def _spanning(
    edges: tuple[tuple[int, int], ...], nodes: int, merged: bool
) -> tuple[tuple[int, ...], ...]:
    """Spanning trees as places of edges; `merged`: of the graph whose terminals are one node."""
    if merged:
        edges = tuple((1 if a == 0 else a, 1 if b == 0 else b) for a, b in edges)
    size = nodes - 2 if merged else nodes - 1
    found = []
    for chosen in itertools.combinations(range(len(edges)), size):
        root = list(range(nodes))
        for n in chosen:
            a, b = (_find(root, end) for end in edges[n])
            if a == b:
                break
            root[a] = b
        else:
            found.append(chosen)
    return tuple(found)


def _find(root: list[int], node: int) -> int:
    while root[node] != node:
        node = root[node]
    return node


def joined(first: str, *names: str | tuple[str, ...]) -> Network:
    """Helper of the layouts: the spring `first` beside stages in series.

    Each stage is a name or names side by side; the kind follows from the name's last word.
    """
    kinds = {"stiffness": "spring", "damping": "damper", "inertance": "inerter"}
    nodes = ["body", *(f"n{n}" for n in range(1, len(names))), "wheel"]
    elements = [Element("spring", first, "body", "wheel")]
    for n, stage in enumerate(names):
        for name in (stage,) if isinstance(stage, str) else stage:
            kind = kinds[name.rsplit("_", 1)[-1]]
            elements.append(Element(kind, name, nodes[n], nodes[n + 1]))
    return Network(tuple(elements))
