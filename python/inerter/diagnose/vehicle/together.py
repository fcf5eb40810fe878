"""Stated values that are wrong together: all freed at once where one after another leads nowhere.

A model whose masses, stiffnesses and dampings are several times off has no effect of which one
alone helps in the right direction. Here all that is stated and linear is freed, fitted over a part
of the runs; what is not needed there is taken back to its stated value, the rest fitted to all.
"""

from __future__ import annotations

from dataclasses import replace

from inerter.catalogue.scales import Range
from inerter.diagnose.decision import not_needed
from inerter.diagnose.statistics import advantage, win_shares
from inerter.diagnose.vehicle.model import VehicleModel
from inerter.diagnose.vehicle.problem import fit_all
from inerter.diagnose.vehicle.search import Array, Step, VehicleScored, VehicleSearch

# an error that is left, per spread, from which on this is tried
LEFT = 0.2
LINEAR = (
    "tyre_stiffness_error", "parallel_stiffness", "body_mass_error", "wheel_mass_error",
    "viscous_friction", "tyre_damping", "joint_damping", "inertance_error", "actuator_gain_error",
)  # fmt: skip


def stated_together(search: VehicleSearch) -> tuple[VehicleScored, list[Step]] | None:
    """The best model of stated values alone, and the steps that say what each one is worth."""
    model, sizes = _all(search)
    if len(model.effects) < 2:
        return None
    search.progress("all stated values together: fitting")
    short = replace(search, problem=search.part, steps=[])
    (begun,) = fit_all(short.problem, [(model, sizes)], iterations=20)
    (fitted,) = short.refit([(begun.model, sizes)])
    simpler: list[VehicleScored] = []
    while len(fitted.model.effects) > 1:
        search.progress(f"which of {len(fitted.model.effects)} stated values are wrong")
        trials = [short.without(fitted, i) for i in range(len(fitted.model.effects))]
        simpler = short.refit(trials)
        worth = [advantage(each.squares, fitted.squares) for each in simpler]
        spare = [
            each
            for each, value in zip(simpler, worth, strict=True)
            if not_needed(each, fitted, value)
        ]
        if not spare:
            break
        fitted = min(spare, key=lambda each: each.squares.sum())
    shares = [win_shares([fitted.squares, each.squares]) for each in simpler]
    (whole,) = search.refit([(fitted.model, fitted.fit.sizes)])
    return whole, [_step(whole, i, each) for i, each in enumerate(shares)]


def _all(search: VehicleSearch) -> tuple[VehicleModel, dict[str, Range]]:
    """The user's model with every stated linear value free, where it stands."""
    model, sizes = VehicleModel(), {}
    for found in search.effects.candidates(model):
        if found.added.effect not in LINEAR or found.friction is not None:
            continue
        start = {name: search.effects.stated(name, model) for name in found.starts[0]}
        # off a bound, where a search would be stuck
        start = {
            name: max(value, found.sizes[name].lower + 1e-3 * found.sizes[name].size)
            for name, value in start.items()
        }
        model = model.adding(found.added, start)
        sizes |= found.sizes
    return model, sizes


def _step(whole: VehicleScored, index: int, shares: Array) -> Step:
    """What one of the values is worth: the model in which it is the last to be added."""
    effects = list(whole.model.effects)
    last = effects.pop(index)
    model = replace(whole.model, effects=(*effects, last))
    return Step(whole, replace(whole, fit=replace(whole.fit, model=model)), [], shares)
