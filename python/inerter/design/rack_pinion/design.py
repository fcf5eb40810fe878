"""A rack-and-pinion inerter from its gear train.

    n_0 = 1, n_i = n_(i-1) ratio_i            turns of shaft i per turn of the pinion
    b_i = J_i n_i^2 / r^2,   b = sum b_i      inertance
    eps = (play_0 + sum r play_i / n_i) / 2   half gap at the rack
    1 / k_s = sum r^2 / (k_i n_i^2)           series stiffness at the rack
    mu  = sum b_i (1 / e_i - 1) / b           load friction, e_i product of efficiencies up to i

Symbols: r [m] pitch radius of the pinion, J_i [kg m^2] inertia of shaft i, play_0 [m] at the rack,
play_i [rad] at the driven shaft of stage i, k_i [N m/rad] torsional stiffness.
Range: mu is exact when the rack drives; when the inertia drives, efficiencies give
sum b_i (1 - e_i) / b instead, less by the square of the losses.
Source: inertance: M. C. Smith, "Synthesis of mechanical networks: the inerter", IEEE Trans. Autom.
Control 47(10), 2002, b = m (gamma / r_3)^2 (r_2 / r_1)^2 for one stage; the rest is energy and
virtual work.
Not modelled: where along the train play and elasticity sit (the device has them all between the
terminal and the whole inertance, right when the last shaft holds most of it), stiffness of teeth,
mass of the rack, which is a mass at its terminal and no inertance.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from inerter.core import Device
from inerter.design.inputs import DesignError, read_inputs
from inerter.design.rack_pinion.inputs import INPUTS, Stage, read_stage
from inerter.design.result import Curve, Design, Figure, Panel


def design_rack_pinion(
    stages: Sequence[str | Mapping[str, float | str]] = (), **inputs: float | str
) -> Design:
    """Inertance, play, elasticity and losses of a rack, a pinion and a gear train.

    Parameters
    ----------
    stages : sequence
        Gear stages from the pinion on: mappings of the inputs in `STAGE`, or texts such as
        "ratio=4,inertia=1e-4,play=0.1 deg".
    **inputs : float or str
        See `inerter.design.rack_pinion.inputs.INPUTS`; SI units, or texts with a unit.

    Raises
    ------
    DesignError
        An input that cannot be, no inertia, or a train that its losses lock.
    """
    values = read_inputs(INPUTS, inputs)
    train = [
        Stage(
            1.0, values.number("pinion_inertia"), values.number("rack_efficiency"),
            0.0, values.maybe("pinion_stiffness"),
        )
    ]  # fmt: skip
    train += [read_stage(number, stage) for number, stage in enumerate(stages, start=1)]
    radius = values.number("pinion_radius")
    turns = np.cumprod([stage.ratio for stage in train])
    efficiency = np.cumprod([stage.efficiency for stage in train])
    shares = np.array([stage.inertia for stage in train]) * (turns / radius) ** 2
    inertance = float(np.sum(shares))
    if not inertance > 0.0:
        raise DesignError("nothing turns: give pinion_inertia or a stage with inertia above 0")
    mu = float(np.sum(shares * (1.0 / efficiency - 1.0))) / inertance
    if mu >= 1.0:
        raise DesignError(
            f"the meshes take {mu:.2g} times the inertance force: from 1 on the inertia cannot "
            "drive the rack; give higher efficiencies or fewer stages"
        )
    plays = [radius * s.play / n for s, n in zip(train, turns, strict=True)]
    gap = 0.5 * (values.number("rack_play") + sum(plays))
    springs = [
        s.stiffness * (n / radius) ** 2
        for s, n in zip(train, turns, strict=True)
        if s.stiffness is not None
    ]
    stiffness = 1.0 / sum(1.0 / k for k in springs) if springs else math.inf
    if gap > 0.0 and not springs:
        raise DesignError(
            f"there is play ({2 * gap:.3g} m at the rack), but every shaft is rigid: a gap needs "
            "elasticity behind it; give pinion_stiffness or a stage's stiffness"
        )

    figures = [
        Figure("inertance", inertance, "kg", "inertance b, sum of the reflected masses"),
        Figure("speed_ratio", float(turns[-1]), "", "turns of the last shaft per pinion's turn"),
    ]  # fmt: skip
    for number, share in enumerate(shares):
        name = f"stage_{number}_mass" if number else "pinion_mass"
        figures.append(Figure(name, float(share), "kg", "mass of this shaft as the rack feels it"))
    figures += [
        Figure("load_friction", mu, "", "friction per inertance force while the rack drives"),
        Figure("backlash", gap, "m", "half of the free play at the rack"),
    ]
    device: dict[str, float | str] = {"inertance": inertance}
    if mu > 0.0:
        device["load_friction"] = mu
    panels: tuple[Panel, ...] = ()
    if springs:
        device["series_stiffness"] = stiffness
        resonance = math.sqrt(stiffness / inertance) / (2.0 * math.pi)
        figures += [
            Figure("series_stiffness", stiffness, "N/m", "stiffness of the shafts at the rack"),
            Figure("antiresonance", resonance, "Hz", "at which shafts and inertia resonate"),
        ]  # fmt: skip
        panels = (_over_frequency(inertance, resonance, values.number("highest_frequency")),)
    if gap > 0.0:
        device["backlash"] = gap
    notes = []
    if values.number("rack_mass") > 0.0:
        notes.append(
            f"The rack's {values.number('rack_mass'):g} kg move with its terminal: add them to the "
            "body there, they are not inertance."
        )
    if (gap > 0.0 or springs) and shares[-1] < 0.8 * inertance:
        notes.append(
            f"The last shaft holds {100 * shares[-1] / inertance:.0f} % of the inertance: play and "
            "elasticity between terminal and all of it, as the device has them, are a coarse "
            "picture."
        )
    comments = {
        "inertance": "kg, sum of J n^2 / r^2",
        "load_friction": "share of the inertance force that the meshes take",
        "backlash": "m, half of the play at the rack",
        "series_stiffness": "N/m, torsion of the shafts at the rack",
    }
    tables = {
        "shafts": [
            {
                "shaft": number, "turns": float(n), "inertia": stage.inertia, "mass": float(share),
                "efficiency": float(e), "play": stage.play, "stiffness": stage.stiffness,
            }
            for number, (stage, n, share, e) in enumerate(
                zip(train, turns, shares, efficiency, strict=True)
            )
        ]
    }  # fmt: skip
    return Design(
        kind="rack-pinion",
        inputs=values,
        figures=tuple(figures),
        device=Device(**device),
        comments=comments,
        panels=panels,
        tables=tables,
        notes=tuple(notes),
    )


def _over_frequency(inertance: float, resonance: float, highest: float) -> Panel:
    """Force per acceleration b / |1 - (f / f_0)^2| [kg], without losses and play."""
    frequency = np.linspace(highest / 400.0, highest, 400)
    distance = np.abs(1.0 - (frequency / resonance) ** 2)
    # the pole itself is left out
    felt = np.where(distance > 0.01, inertance / np.maximum(distance, 0.01), np.nan)
    x = frequency.tolist()
    return Panel(
        name="inertance",
        title="Force per acceleration, no losses, no play",
        x_title="frequency [Hz]",
        y_title="inertance [kg]",
        curves=(
            Curve("with elastic shafts", x, felt.tolist()),
            Curve("rigid", x, [inertance] * len(x), dashed=True),
        ),
        log_y=True,
    )
