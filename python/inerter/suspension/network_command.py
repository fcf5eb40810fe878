"""`inerter suspension network`: the best values of any network of springs, dampers, inerters."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from inerter.console import AsJson, out, refusing
from inerter.suspension import options
from inerter.suspension.quarter_car import QuarterCar, Road


def network_command(
    netlist: Annotated[
        Path,
        typer.Argument(
            help="Lines KIND NAME NODE NODE VALUE between body and wheel; ? is sought. Or a "
            "file.toml of an admittance, whose indices are told."
        ),
    ],
    index: Annotated[
        str, typer.Option(help="One of J1, J1w, J3, travel, or file.toml, file.py:FUNCTION.")
    ] = "J1",
    car: Annotated[str, typer.Option(help="quarter, or a file car.toml of one.")] = "quarter",
    limit: options.Limit = None,
    speed: options.Speed = options.ROAD.velocity,
    velocity: options.OldSpeed = None,
    roughness: options.Roughness = options.ROAD.roughness,
    as_json: AsJson = False,
) -> None:
    """Find the values of a network of springs, dampers and inerters that minimise an index.

    \b
    A netlist of a quarter-car:
      spring  k  body wheel 25e3
      damper  c  body a     ?
      inerter b  a    wheel ?

    \b
    Example:
      inerter suspension network strut.net --index J3
    """
    import numpy as np

    from inerter.folder import json_text
    from inerter.suspension.car_options import chosen_car
    from inerter.suspension.indices import INDICES
    from inerter.suspension.limited import best_within
    from inerter.suspension.netlist import NetlistError, read_netlist
    from inerter.suspension.network_problem import NetworkProblem
    from inerter.suspension.optimum import best_point
    from inerter.suspension.study import StudyError, read_indices, read_pairs
    from inerter.suspension.white_road import refuse_infinite

    with refusing(None):
        which = chosen_car(car, {})
        if not isinstance(which, QuarterCar):
            raise StudyError(f"--car {car}: a network is sought for a quarter-car")
        road = options.road_asked(speed, velocity, roughness)
        if netlist.suffix.lower() == ".toml":
            _tell_admittance(netlist, which, road, as_json)
            return
        try:
            lines = netlist.read_text(encoding="utf-8").splitlines()
        except (OSError, UnicodeDecodeError):
            raise StudyError(f"{netlist}: cannot be read; give a text file") from None
        (chosen, *more) = read_indices(index)
        if more:
            raise StudyError(f"index {index!r}: give one")
        try:
            problem = NetworkProblem(
                car=which,
                road=road,
                index=chosen,
                limits=read_pairs(limit, INDICES, "limit"),
                netlist=read_netlist(lines),
            )
        except NetlistError as error:
            raise StudyError(f"{netlist}: {error}") from None
        refuse_infinite(problem)
        reached: tuple[str, ...] = ()
        if problem.limits:
            found = best_within(problem)
            value, point, reached = found.value, found.point, found.reached
        else:
            value, point = best_point(problem)
        values = dict(zip(problem.variables, np.exp(point).tolist(), strict=True))
    if as_json:
        row = {"index": chosen, "value": value, "design": values, "reached": list(reached)}
        print(json_text(row), end="")
        return
    out.print(f"{chosen} = {value:.6g} {INDICES[chosen].unit}", markup=False)
    units = {"spring": "N/m", "damper": "N s/m", "inerter": "kg"}
    for each in problem.netlist.elements:
        size = values.get(each.name, each.value)
        end = "" if each.sought else ", given"
        out.print(f"  {each.kind} {each.name}: {size:.6g} {units[each.kind]}{end}", markup=False)
    for name in reached:
        out.print(f"held back by the limit of {name}", markup=False)


def _tell_admittance(path: Path, car: QuarterCar, road: Road, as_json: bool) -> None:
    """Indices of an admittance, and the network that has it where one is known."""
    import numpy as np

    from inerter.folder import json_text
    from inerter.suspension.admittance import ladder, read_admittance, stiffness_of
    from inerter.suspension.indices import INDICES, indices_of, is_infinite

    admittance = read_admittance(path)
    strut, network = stiffness_of(admittance), ladder(admittance)
    values = {
        name: float(np.squeeze(INDICES[name].evaluate(car, road, strut)))
        for name in indices_of(None)
    }
    rest = float(strut.numerator[0] / strut.denominator[0])
    elements = [] if network is None else list(network.elements)
    if as_json:
        plain = [
            {"kind": e.kind, "name": e.name, "nodes": list(e.nodes), "value": e.value}
            for e in elements
        ]
        document = {
            "positive_real": True,
            "stiffness": rest,
            "values": {n: x if np.isfinite(x) else None for n, x in values.items()},
            "network": plain or None,
        }
        print(json_text(document), end="")
        return
    out.print(f"positive real; {rest:.6g} N/m at rest", markup=False)
    for name, value in values.items():
        told = f"{value:.6g} {INDICES[name].unit}"
        if not np.isfinite(value) and is_infinite(name, car, strut):
            told = "infinite: with tyre_damping it follows a road of white velocity at once"
        out.print(f"{name} = {told}", markup=False)
    if network is None:
        out.print("no network of few elements is known here; it was used as it is", markup=False)
    for e in elements:
        out.print(f"{e.kind} {e.name} {' '.join(e.nodes)} {e.value:.6g}", markup=False)
