"""What a user's device states, set free: the models by which the data can contradict it.

Inertance, damping, stiffness, levels and their variations are coordinates that `candidates` sets
free itself. A law's other parameters, a shaft, a leak, a clutch, stops and a gas are
set free here, each as a whole;
of a law also what the user leaves to its default, for the simulation has it. A stated free play is
held.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from inerter.catalogue.coordinates import COORDINATES
from inerter.catalogue.effects import EFFECTS
from inerter.catalogue.friction import FRICTION
from inerter.catalogue.scales import Scales
from inerter.diagnose.candidate import Candidate
from inerter.diagnose.composition import width
from inerter.identify.model import Model

# least share of the critical damping from which a stated shaft's is searched
_LOSS = 1e-3
# share of a stated stiffness from which on one that is not there is sought
_NOTHING = 1e-3
# where a peak and a damping begin that are none as stated: of the level, of the rms force per speed
_PEAK, _DAMPING = 0.5, 1e-3


def stated_candidates(model: Model, sizes: Scales) -> Iterator[Candidate]:
    """Each part that a model states and holds, set free from its stated values."""
    yield from _law(model, sizes)
    yield from _shaft(model, sizes)
    yield from _gas(model)
    yield from _slipping(model)
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


def _law(model: Model, sizes: Scales) -> Iterator[Candidate]:
    """The whole law, stated or by default; from its defaults others lie far."""
    law = FRICTION[model.friction]
    effect = EFFECTS.get(law.effect)
    # of one whose level is all that is a candidate already
    if effect is None or law.set_free == (law.level,):
        return
    device = law.of_device(model.device())
    values = {name: model.values.get(name, value) for name, value in device.items()}
    # one that a search found has all of its coordinates, and all of them free
    by_default = law.varies and any(name not in model.values for name in values)
    if not by_default and not _held(model, law.set_free):
        return
    told = law.name if effect.tells_law else None
    starts = _starts(model, {**values, **width(model)}, "bw_stiffness")
    if any(name not in model.values for name in values):
        starts += tuple(
            model.adding(None, **{**values, **begin, **width(model)})
            for begin in _elsewhere(model, values, sizes)
        )
    yield Candidate(effect.name, told, starts)


def _elsewhere(model: Model, values: dict[str, float], sizes: Scales) -> Iterator[dict[str, float]]:
    """Where what is left to its default may begin too."""
    law = FRICTION[model.friction]
    level = values.get("coulomb_force", 0.0)
    none = {
        "static_excess": _PEAK * level,
        "bristle_damping": _DAMPING * sizes.force / sizes.velocity,
    }
    begun = {n: v for n, v in none.items() if n in values and n not in model.values}
    for row in range(max((len(ratios) for ratios in law.grid.values()), default=0)):
        yield begun | {
            name: ratios[row % len(ratios)] * COORDINATES[name].start_unit(sizes)
            for name, ratios in law.grid.items()
            if name in values and name not in model.values
        }


def shafts(sizes: Scales) -> list[dict[str, float]]:
    """Coordinates of shafts of which one lies near enough to any that the data can show.

    A fit does not find its way from one side of a resonance to the other.
    """
    slow = sizes.frequency
    fast = max(2 * sizes.cutoff, 4 * slow) if np.isfinite(sizes.cutoff) else 20 * slow
    resonances = np.geomspace(1.5 * slow, fast, 4)
    return [{"series_frequency": float(f), "series_loss": 0.1} for f in resonances]


def _shaft(model: Model, sizes: Scales) -> Iterator[Candidate]:
    device, effect = model.device(), EFFECTS["series_elasticity"]
    if "series_frequency" in model.values or not device.series_stiffness:
        return
    stated = {name: COORDINATES[name].of(device) for name in effect.coordinates}
    stated["series_loss"] = max(stated["series_loss"], _LOSS)
    rigid = model.without(effect.stated_as)
    starts = tuple(rigid.adding(None, **shaft) for shaft in (stated, *shafts(sizes)))
    yield Candidate(effect.name, None, starts)


def _slipping(model: Model) -> Iterator[Candidate]:
    """A leak, and a clutch."""
    device, (corner, bent) = model.device(), EFFECTS["leak"].coordinates
    leak = {name: model.values[name] for name in _held(model, (bent,))}
    bare = model
    if _held(model, EFFECTS["leak"].stated_as[:1]) and device.leak_damping:
        bare = model.without(EFFECTS["leak"].stated_as[:1])
        leak[corner] = COORDINATES[corner].of(device)
    if leak:
        yield Candidate("leak", None, (bare.adding(None, **leak),))
    if held := _held(model, EFFECTS["clutch_slip"].coordinates[:1]):
        clutch = {name: model.values[name] for name in held}
        yield Candidate("clutch_slip", None, (model.adding(None, **clutch),))


def _gas(model: Model) -> Iterator[Candidate]:
    device, effect = model.device(), EFFECTS["gas_spring"]
    if "gas_push" in model.values or not device.gas_pressure:
        return
    reach = "gas_reach_above" if device.gas_area < 0 else "gas_reach"
    names = ("gas_push", reach, "gas_exponent")
    stated = {name: COORDINATES[name].of(device) for name in names}
    yield Candidate(effect.name, None, (model.without(effect.stated_as).adding(None, **stated),))
