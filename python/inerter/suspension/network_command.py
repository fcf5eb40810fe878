"""`inerter suspension network`: the best values of any network of springs, dampers, inerters."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from inerter.console import AsJson, number, out, refusing
from inerter.suspension.quarter_car import Road

_ROAD = Road()


def network_command(
    netlist: Annotated[
        Path,
        typer.Argument(help="Lines KIND NAME NODE NODE VALUE between body and wheel; ? is sought."),
    ],
    index: Annotated[
        str, typer.Option(help="One of J1, J1w, J3, travel, or file.toml, file.py:FUNCTION.")
    ] = "J1",
    car: Annotated[str, typer.Option(help="quarter, or a file car.toml of one.")] = "quarter",
    limit: Annotated[
        str | None, typer.Option(help="Not above: INDEX=VALUE in SI, with commas.")
    ] = None,
    velocity: Annotated[float, number("m/s", "V [m/s].")] = _ROAD.velocity,
    roughness: Annotated[float, number("m^3/cycle", "kappa [m^3/cycle].")] = _ROAD.roughness,
    as_json: AsJson = False,
) -> None:
    """Values of a network of springs, dampers and inerters that minimise an index of a quarter-car.

    \b
    Example of a netlist:
      spring  k  body wheel 25e3
      damper  c  body a     ?
      inerter b  a    wheel ?
    """
    import numpy as np

    from inerter.folder import json_text
    from inerter.suspension.car_options import chosen_car
    from inerter.suspension.indices import INDICES
    from inerter.suspension.limited import best_within
    from inerter.suspension.netlist import NetlistError, read_netlist
    from inerter.suspension.network_problem import NetworkProblem
    from inerter.suspension.optimum import best_point
    from inerter.suspension.quarter_car import QuarterCar
    from inerter.suspension.study import StudyError, read_indices, read_pairs

    with refusing(None):
        try:
            lines = netlist.read_text(encoding="utf-8").splitlines()
        except (OSError, UnicodeDecodeError):
            raise StudyError(f"{netlist}: cannot be read; give a text file") from None
        which = chosen_car(car, {})
        if not isinstance(which, QuarterCar):
            raise StudyError(f"--car {car}: a network is sought for a quarter-car")
        (chosen, *more) = read_indices(index)
        if more:
            raise StudyError(f"index {index!r}: give one")
        try:
            problem = NetworkProblem(
                car=which,
                road=Road(velocity=velocity, roughness=roughness),
                index=chosen,
                limits=read_pairs(limit, INDICES, "limit"),
                netlist=read_netlist(lines),
            )
        except NetlistError as error:
            raise StudyError(f"{netlist}: {error}") from None
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
