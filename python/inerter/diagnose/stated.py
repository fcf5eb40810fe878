"""What a user's device states, set free: the models by which the data can contradict it.

Inertance, damping, stiffness, levels and their variations are coordinates that `candidates` sets
free itself. A law's other parameters, a shaft, stops and a gas are set free here, each as a whole.
A stated free play is held.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from inerter.diagnose.candidate import Candidate
from inerter.diagnose.composition import LAW_EFFECT, STATED_AS, width
from inerter.diagnose.effects import EFFECTS, LAW_CONSTANTS, LAW_COORDINATES
from inerter.identify.coordinates import Scales
from inerter.identify.model import Model

# least share of the critical damping from which a stated shaft's is searched
_LOSS = 1e-3
# share of a stated stiffness from which on one that is not there is sought
_NOTHING = 1e-3


def stated_candidates(model: Model, sizes: Scales) -> Iterator[Candidate]:
    """Each part that a model states and holds, set free from its stated values."""
    yield from _law(model)
    yield from _shaft(model, sizes)
    yield from _gas(model)
    stops = {name: model.values[name] for name in _held(model, EFFECTS["end_stop"].coordinates)}
    if stops:
        yield Candidate("end_stop", None, _starts(model, stops, "stop_stiffness"))


def _held(model: Model, names: tuple[str, ...]) -> list[str]:
    return [name for name in names if name in model.values and name not in model.free]


def _starts(model: Model, values: dict[str, float], size: str) -> tuple[Model, ...]:
    """From what is stated, and from next to nothing: it may not be there at all."""
    stated = model.adding(None, **values)
    if size not in values:
        return (stated,)
    return stated, model.adding(None, **{**values, size: _NOTHING * values[size]})


def _law(model: Model) -> Iterator[Candidate]:
    # of Coulomb friction the level is all, and a candidate already
    held = [name for name in _held(model, LAW_COORDINATES) if name not in LAW_CONSTANTS]
    if model.friction not in LAW_EFFECT or model.friction == "coulomb" or not held:
        return
    effect = LAW_EFFECT[model.friction]
    values = {name: model.values[name] for name in held}
    law = model.friction if effect == "hysteretic_friction" else None
    starts = _starts(model, {**values, **width(model)}, "bw_stiffness")
    yield Candidate(effect, law, starts)


def shafts(sizes: Scales) -> list[dict[str, float]]:
    """Coordinates of shafts of which one lies near enough to any that the data can show.

    A fit does not find its way from one side of a resonance to the other.
    """
    slow = sizes.frequency
    fast = max(2 * sizes.cutoff, 4 * slow) if np.isfinite(sizes.cutoff) else 20 * slow
    resonances = np.geomspace(1.5 * slow, fast, 4)
    return [{"series_frequency": float(f), "series_loss": 0.1} for f in resonances]


def _shaft(model: Model, sizes: Scales) -> Iterator[Candidate]:
    device = model.device()
    if "series_frequency" in model.values or not device.series_stiffness:
        return
    inertance, stiffness = device.inertance, device.series_stiffness
    loss = device.series_damping / (2 * np.sqrt(stiffness * inertance))
    stated = {
        "series_frequency": float(np.sqrt(stiffness / inertance) / (2 * np.pi)),
        "series_loss": max(float(loss), _LOSS),
    }
    rigid = model.without(STATED_AS["series_elasticity"])
    starts = tuple(rigid.adding(None, **shaft) for shaft in (stated, *shafts(sizes)))
    yield Candidate("series_elasticity", None, starts)


def _gas(model: Model) -> Iterator[Candidate]:
    device = model.device()
    if "gas_push" in model.values or not device.gas_pressure:
        return
    start = model.without(STATED_AS["gas_spring"]).adding(
        None,
        gas_push=device.gas_pressure * device.gas_area,
        gas_reach=device.gas_volume / device.gas_area,
        gas_exponent=device.gas_exponent,
    )
    yield Candidate("gas_spring", None, (start,))
