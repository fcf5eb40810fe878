"""`inerter suspension model`: a car file as a model of MuJoCo and of Exudyn."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from inerter.console import Folder, out, refusing

_EXUDYN = '''"""The car of {name} in Exudyn; needs the extra `exudyn`. Run it for a bump."""

from math import cos, pi
from pathlib import Path

import exudyn as exu
from inerter.cars.exudyn_model import build_car
from inerter.cars.read import read_car
from inerter.exudyn.model_parts import simulate

CAR = read_car(Path(__file__).with_name("car.toml"))


def bump(t: float) -> float:
    """30 mm high, felt by every wheel at once."""
    return 0.015 * (1.0 - cos(40.0 * pi * (t - 0.1))) if 0.1 < t < 0.15 else 0.0


if __name__ == "__main__":
    names = {roads!r}
    mbs = exu.SystemContainer().AddSystem()
    model = build_car(mbs, CAR, dict.fromkeys(names, bump))
    run = simulate(model, 2.0, write_period=2e-3, solver="{solver}")
    for name, values in run.displacement.items():
        print(f"{{name}}: {{values.min():.4g}} to {{values.max():.4g}}")
'''


_STIFF = 1000.0


def model_command(
    car: Annotated[Path, typer.Argument(help="The car: a file car.toml.")],
    out_dir: Folder = Path("out/car"),
) -> None:
    """Write a car file as models: model.xml for MuJoCo, model.py for Exudyn, and the file itself.

    An inerter with friction, play or a shaft (device = ...) is MuJoCo's: then model.xml alone.

    \b
    Example:
      inerter suspension model car.toml --out out/car
    """
    from inerter.cars.equations import car_equations
    from inerter.cars.mjcf import car_mjcf
    from inerter.cars.read import read_car
    from inerter.folder import write_files

    with refusing(out_dir, "model.xml", "model.py", "car.toml"):
        parts = read_car(car)
        files = {"model.xml": car_mjcf(parts), "car.toml": car.read_text(encoding="utf-8")}
        told = ""
        try:
            equations = car_equations(parts)
            # steps of 1 ms are too long for a relaxation spring that is stiffer than that
            solver = "RK44" if equations.relaxation_rate < _STIFF else "GeneralizedAlpha"
            files["model.py"] = _EXUDYN.format(name=car.name, roads=equations.roads, solver=solver)
        except ValueError as error:
            told = f"No model.py: {error}"
        names = write_files(out_dir, files)
    if told:
        out.print(told, markup=False)
    out.print(f"Written to {out_dir}: {', '.join(names)}")
