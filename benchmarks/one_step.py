"""What one step of a car costs in MuJoCo: plugin, MuJoCo's own elements, Python, no device.

Quarter-, half- and full-car with 1, 2 and 4 devices, every friction law, every integrator; wheels
in the body (where native elements can say the same) and beside it (where they cannot).
"""

from __future__ import annotations

from pathlib import Path

from inerter.benchmark.cars import CARS, INTEGRATORS, PLUGIN
from inerter.benchmark.rows import Row
from inerter.benchmark.step import step_costs

from benchmarks.picture import COLOURS, figure, save


def run(quick: bool = False) -> list[Row]:
    """Rows as `inerter.benchmark.step.step_costs` gives them."""
    return step_costs(tuple(CARS), INTEGRATORS, *((7, 200) if quick else (41, 500)))


def picture(rows: list[Row], path: Path) -> None:
    """Cost of a step as a multiple of the armature's, by integrator; a panel for each car."""
    topologies = {"nested": "wheels in the body", "branches": "wheels beside the body"}
    made = figure(13.0, 7.0)
    panels = made.subplots(len(topologies), len(CARS), sharex=True, sharey="row", squeeze=False)
    shown = ["bare", "native lugre", *PLUGIN]
    for line, (topology, meaning) in zip(panels, topologies.items(), strict=True):
        for axes, car in zip(line, CARS, strict=True):
            here = [row for row in rows if (row["car"], row["topology"]) == (car, topology)]
            for k, variant in enumerate(shown):
                _dots(axes, here, variant, k / (len(shown) - 1) - 0.5)
            axes.axhline(1.0, color=COLOURS["text"], lw=0.8)
            axes.set_xticks(range(len(INTEGRATORS)), INTEGRATORS)
            axes.set_title(f"{car}, {meaning}", fontsize=9.5, loc="left")
    for line in panels:
        line[0].set_ylim(bottom=0.7)
        line[0].set_ylabel("cost of a step / armature's", fontsize=9)
    handles, labels = panels[0][0].get_legend_handles_labels()
    made.legend(handles, labels, loc="outside lower center", ncols=(len(shown) + 1) // 2,
                frameon=False, fontsize=8.5)  # fmt: skip
    save(made, path)


def _dots(axes, rows: list[Row], variant: str, shift: float) -> None:
    """A variant's cost over the armature's under each integrator."""
    cost = {(row["integrator"], row["variant"]): row["microseconds"] for row in rows}
    there = [i for i, name in enumerate(INTEGRATORS) if (name, variant) in cost]
    values = [cost[INTEGRATORS[i], variant] / cost[INTEGRATORS[i], "armature"] for i in there]
    style = {"bare": ("s", COLOURS["measured"]), "native lugre": ("D", COLOURS["before"])}
    shades = dict(zip(PLUGIN, COLOURS["laws"], strict=True))
    mark, colour = style.get(variant, ("o", shades.get(variant)))
    axes.plot(
        [i + 0.7 * shift for i in there], values, mark, color=colour, ms=5, label=variant,
    )  # fmt: skip
