"""`inerter suspension evaluate --layout own`: the car as its file states it."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import Any

from rich.table import Table

from inerter.cars.parts import CarParts
from inerter.cars.read import read_car, shipped_car
from inerter.console import out, progress_bar, refusing
from inerter.folder import json_text, write_files
from inerter.suspension.car_options import CARS
from inerter.suspension.indices import INDICES
from inerter.suspension.study import read_catalogue, read_indices
from inerter.suspension.time_domain.asked import tyre_named
from inerter.suspension.time_domain.own_struts import UNITS, OwnEvaluation, evaluate_own
from inerter.suspension.time_domain.own_varied import (
    OF_STRUT,
    OwnVaried,
    evaluate_varied,
    varied_cars,
)
from inerter.suspension.time_domain.profile import Profile, profile_named
from inerter.suspension.time_domain.road import PeriodicRoad, road_named
from inerter.suspension.time_domain.simulate import RunSettings
from inerter.suspension.time_domain.varied import summary
from inerter.suspension.variations import OF_CAR

OWN = "own"
"""What --layout is where the struts are those of the car's file."""

_SETTLE = 4.0


def own_command(
    *,
    car: str,
    road: str,
    speed: float,
    seeds: int,
    tyre: str | None,
    step: float,
    settle: float | None,
    jobs: int,
    indices: str | None,
    vary: str | None,
    others: Mapping[str, Any],
    out_dir: Path,
    as_json: bool,
) -> None:
    """Work it out, print it, write evaluation.json and .csv; `others`: options that do not fit."""
    names = ("evaluation.json", "evaluation.csv", *(["variations.csv"] if vary else []))
    with refusing(out_dir, *names):
        factors = dict(read_catalogue(vary, (*OF_CAR, *OF_STRUT), "vary"))
        for name, value in others.items():
            if value is not None:
                raise ValueError(f"{name}: with --layout own the car's file states it; change it")
        parts = _car(car)
        chosen = _road(road, speed)
        one_sided = tyre_named(tyre)
        settings = RunSettings(step=step, settle=settle or _SETTLE, jobs=jobs)
        more: dict[str, Any] = {
            "one_sided": road != "paper" if one_sided is None else one_sided,
            "keep_settle": settle is not None,
            "indices": read_indices(indices) if indices else (),
        }
        with progress_bar("driving", as_json) as progress:
            # what cannot be varied is told before anything is driven
            varied_cars(parts, factors)
            found = evaluate_own(parts, chosen, seeds, settings, progress=progress, **more)
        varied = OwnVaried({}, ())
        if factors:
            with progress_bar("driving the variations", as_json) as progress:
                varied = evaluate_varied(
                    parts, factors, partial(_road, road, speed), seeds, settings,
                    progress=progress, **more,
                )  # fmt: skip
        document = _document(parts, chosen.name, speed, found)
        if factors:
            document |= _varied_document(factors, found, varied)
        files = {"evaluation.json": json_text(document), "evaluation.csv": _csv(found)}
        if factors:
            files["variations.csv"] = _varied_csv(varied)
        written = write_files(out_dir, files)
    if as_json:
        print(json_text(document), end="")
        return
    profile = isinstance(chosen, Profile)
    what = chosen.name if profile else f"{found.roads} roads {chosen.name}"
    out.print(f"{parts.name} as its file states it, {what}, {speed:g} m/s", markup=False)
    table = Table(box=None, padding=(0, 1, 0, 0), header_style="dim")
    table.add_column("figure", no_wrap=True)
    for name in ("value", *([] if profile else ["± 95 %", "linear, exact"])):
        table.add_column(name, justify="right", no_wrap=True)
    table.add_column("unit", no_wrap=True)
    for each in found.figures:
        half = 0.5 * (each.high - each.low)
        cells = [f"{half:.1g}" if half else "", _number(each.linear)]
        shown = [each.name, _number(each.value), *([] if profile else cells), _unit(each.name)]
        table.add_row(*shown)
    out.print(table)
    if factors:
        out.print(_varied_table(found, varied))
    for note in (*found.notes, *varied.notes):
        out.print(note, markup=False, soft_wrap=True)
    out.print(f"Written to {out_dir}: {', '.join(written)}")


def _car(name: str) -> CarParts:
    if name.lower().endswith(".toml"):
        return read_car(name)
    if name.lower() in CARS:
        return shipped_car(name.lower())
    raise ValueError(f"car {name!r}: take {', '.join(CARS)}, or a file car.toml")


def _road(name: str, speed: float, factor: float = 1.0) -> Profile | PeriodicRoad:
    return profile_named(name, speed * factor) or road_named(name, speed * factor)


def _unit(name: str) -> str:
    return UNITS[name] if name in UNITS else INDICES[name].unit


def _number(value: float | None) -> str:
    return "" if value is None else f"{value:.5g}"


def _document(car: CarParts, road: str, speed: float, found: OwnEvaluation) -> dict[str, Any]:
    return {
        "schema": "inerter.suspension.own/1",
        "car": asdict(car),
        "road": road,
        "speed": speed,
        "roads": found.roads,
        "road_period": found.road_period,
        "settle": found.settle,
        "figures": {each.name: asdict(each) | {"unit": _unit(each.name)} for each in found.figures},
        "notes": list(found.notes),
    }


def _csv(found: OwnEvaluation) -> str:
    table = io.StringIO()
    writer = csv.writer(table, lineterminator="\n")
    writer.writerow(["figure", "unit", "value", "low", "high", "linear"])
    for each in found.figures:
        line = [each.value, each.low, each.high, "" if each.linear is None else each.linear]
        writer.writerow([each.name, _unit(each.name), *line])
    return table.getvalue()


def _varied_document(
    factors: Mapping[str, tuple[float, ...]], found: OwnEvaluation, varied: OwnVaried
) -> dict[str, Any]:
    nominal = {each.name: each.value for each in found.figures}
    return {
        "vary": {name: list(values) for name, values in factors.items()},
        "variations": {
            name: {**summary(nominal[name], each), "each": [asdict(one) for one in each]}
            for name, each in varied.figures.items()
        },
        "variation_notes": list(varied.notes),
    }


def _varied_csv(varied: OwnVaried) -> str:
    table = io.StringIO()
    writer = csv.writer(table, lineterminator="\n")
    writer.writerow(["figure", "unit", "variation", "value", "low", "high", "linear"])
    for name, each in varied.figures.items():
        for one in each:
            linear = "" if one.linear is None else one.linear
            writer.writerow([name, _unit(name), one.name, one.value, one.low, one.high, linear])
    return table.getvalue()


def _varied_table(found: OwnEvaluation, varied: OwnVaried) -> Table:
    """As planned, mean and worst of each figure."""
    table = Table(box=None, padding=(0, 1, 0, 0), header_style="dim")
    table.add_column("figure", no_wrap=True)
    for name in ("as planned", "mean", "worst"):
        table.add_column(name, justify="right", no_wrap=True)
    table.add_column("worst when", overflow="fold")
    for each in found.figures:
        told = summary(each.value, varied.figures[each.name])
        cells = [_number(told[name]) for name in ("nominal", "mean", "worst")]
        table.add_row(each.name, *cells, told["worst_when"])
    return table
