"""A user's own network from a TOML file, as a layout of the study.

    name = "mine"
    [[element]]
    kind = "spring"                 # spring, damper or inerter
    between = ["body", "wheel"]
    value = "stiffness"             # the spring that is given
    [[element]]
    kind = "damper"
    between = ["body", "n1"]        # inner nodes have any name, and no mass
    value = "damping"               # a name is sought, a number in SI units is given

Exactly one element has the value "stiffness": a spring between body and wheel.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from inerter.input_file import read_toml
from inerter.suspension.layouts import LAYOUTS, Layout
from inerter.suspension.network import TERMINALS, Element, Network

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,39}")


def read_network(path: Path) -> Layout:
    """The layout of a file.

    Raises
    ------
    ValueError
        The file cannot be read, or is no network: one sentence with the element and what to do.
    """
    content = read_toml(path)
    try:
        return _layout(path.stem, content)
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None


def _layout(stem: str, content: dict[str, Any]) -> Layout:
    name = str(content.get("name", stem))
    if not _NAME.fullmatch(name) or name.upper() in LAYOUTS:
        raise ValueError(f"name = {name!r}: give letters and digits that are no layout's already")
    given = content.get("element")
    if not isinstance(given, list) or not given:
        raise ValueError("there is no [[element]]: give one for each spring, damper and inerter")
    network = Network(tuple(_element(n, one) for n, one in enumerate(given, 1)))
    main = [one for one in network.elements if one.value == "stiffness"]
    if (
        len(main) != 1
        or main[0].kind != "spring"
        or {main[0].first, main[0].second} != set(TERMINALS)
    ):
        raise ValueError('one spring between body and wheel has to have the value "stiffness"')
    names = [one.value for one in network.elements if isinstance(one.value, str)]
    for twice in {x for x in names if names.count(x) > 1}:
        kinds = {one.kind for one in network.elements if one.value == twice}
        if len(kinds) > 1:
            raise ValueError(f"value {twice!r} is of a {' and a '.join(sorted(kinds))}: name two")
    variables = tuple(dict.fromkeys(x for x in names if x != "stiffness"))
    if not variables:
        raise ValueError('nothing is sought: give an element the value "damping" or another name')
    return Layout(name, network, variables, f"own network of {len(network.elements)} elements")


def _element(number: int, one: Any) -> Element:
    if not isinstance(one, dict):
        raise ValueError(f"element {number} is no table: write [[element]]")
    unknown = set(one) - {"kind", "between", "value"}
    if unknown:
        raise ValueError(f"element {number}: {sorted(unknown)[0]!r} is not kind, between or value")
    ends, value, kind = one.get("between"), one.get("value"), one.get("kind")
    if not (isinstance(ends, list) and len(ends) == 2 and all(isinstance(x, str) for x in ends)):
        raise ValueError(f"element {number}: between = {ends!r}: give two nodes by name")
    if isinstance(value, bool) or not isinstance(value, str | int | float):
        raise ValueError(f"element {number}: value = {value!r}: give a name or a number in SI")
    if isinstance(value, str) and not _NAME.fullmatch(value):
        raise ValueError(f"element {number}: value = {value!r}: a name has letters, digits and _")
    return Element(str(kind), value if isinstance(value, str) else float(value), *ends)
