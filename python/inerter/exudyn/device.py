"""The device as Exudyn needs it: forces at the terminals, rates of the states, energy.

    F = T + F_friction + N + lambda |N|      lambda by the sign of N v

T: `beside.py`; friction: `friction.py`; N, through the inertance: `flywheel.py`, behind the series
element of `series.py` if there is one. States z: friction_state, series_deflection s,
flywheel_velocity w, gap_position or slip_position, each only where it is needed.

With `friction_side` "flywheel" and a series element, whose force is S: F = T + S, and
S = N + F_friction + lambda |N| at the flywheel's displacement and velocity w.
"""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass
from typing import Any

from inerter.exudyn import beside, branches, control, damper_spring, flywheel, friction, series
from inerter.exudyn.functions import NUMBERS, Functions, Value
from inerter.exudyn.parameters import Parameters


@dataclass(frozen=True)
class Term:
    """An expression and where it counts: at the terminals [N per unit], in rates of states."""

    value: Value
    terminals: float = 0.0
    rates: tuple[tuple[int, float], ...] = ()


@dataclass(frozen=True)
class States:
    """The states by what they are; 0 where there is none. Those of maxwell_slip are a tuple."""

    friction: Any = 0.0
    deflection: Value = 0.0
    speed: Value = 0.0
    gap: Value = 0.0


def states_of(p: Parameters, z: Sequence[Value]) -> States:
    """The states of a sequence in the device's order."""
    names = dict(zip(p.state_names, range(p.nstate), strict=True))
    found = {
        field: z[names[name]]
        for field, name in (
            ("friction", "friction_state"),
            ("deflection", "series_deflection"),
            ("speed", "flywheel_velocity"),
            ("gap", "gap_position"),
            ("gap", "slip_position"),
        )
        if name in names
    }
    several = tuple(z[at] for name, at in names.items() if name.startswith("friction_state_"))
    return States(**found | ({"friction": several} if several else {}))


def terms(
    f: Functions, p: Parameters, x: Value, v: Value, z: Sequence[Value], a: Value = 0.0
) -> list[Term]:
    """All but the inertance of `mass`; the acceleration counts where a load bends a bristle.

    x [m] is the length minus rest_length, v [m/s] its rate; p of `control.present`.
    """
    state, place = states_of(p, z), {name: i for i, name in enumerate(p.state_names)}
    rubbing = _rubbing(f, p, x, v, state, _bearing(f, p, x, v, a, state))
    at_terminals = beside.force(f, p, x, v)
    found: list[Term] = []
    for spring, dashpot, e, at in branches.deflections(p, z):
        found.append(Term(e, spring, ((at, -spring / dashpot),)))
        found.append(Term(v, 0.0, ((at, 1.0),)))
    if damper_spring.is_there(p):
        at_terminals = at_terminals + damper_spring.force(f, p, z)
        rates = ((damper_spring.place(p), 1.0),)
        found.append(Term(damper_spring.rate(f, p, v, z), 0.0, rates))
    if control.lags(p):
        found.append(Term(control.rate(p, z), 0.0, ((p.nstate - 1, 1.0),)))
    wheel = rubs_flywheel(p)
    if not wheel:
        at_terminals = at_terminals + rubbing.bound
    if isinstance(rubbing.rate, tuple):
        for i, each in enumerate(rubbing.rate):
            found.append(Term(each, 0.0, ((place[f"friction_state_{i + 1}"], 1.0),)))
    elif rubbing.rate is not None:
        rates = ((place["friction_state"], 1.0),)
        found.append(Term(rubbing.rate, 0.0 if wheel else rubbing.damping, rates))

    if not series.is_there(p):
        rest = flywheel.inertance(f, p, x, v)[1] + flywheel.force(f, p, x, v)
        return [*found, Term(at_terminals + rest, 1.0)]

    rate, y = v - state.speed, x - state.deflection
    shaft = series.at(f, p, state.deflection, rate, state.gap)
    mass, rest = flywheel.inertance(f, p, y, state.speed)
    rest = rest + flywheel.force(f, p, y, state.speed)
    if wheel:
        # all that friction takes of the shaft's force
        rest = rest + shaft.force - carried(f, p, x, v, 0.0, z)
    elif rubs_by_load(p):
        share = _load_share(f, p, v, shaft.force, state.friction)
        at_terminals = at_terminals + share * f.abs(shaft.force)
    spinning = place["flywheel_velocity"]
    if flywheel.varies(p) or (control.lags(p) and p.control == "inertance"):
        found.append(Term(shaft.force, 1.0))
        found.append(Term((shaft.force - rest) / mass, 0.0, ((spinning, 1.0),)))
    else:
        found.append(Term(shaft.force, 1.0, ((spinning, 1.0 / mass),)))
        found.append(Term(rest, 0.0, ((spinning, -1.0 / mass),)))
    found.append(Term(rate, 0.0, ((place["series_deflection"], 1.0),)))
    if "slip_position" in place:
        found.append(Term(shaft.gap_rate, 0.0, ((place["slip_position"], 1.0),)))
    if p.backlash and p.series_damping:
        found.append(Term(shaft.gap_rate, 0.0, ((place["gap_position"], 1.0),)))
    return [*found, Term(at_terminals, 1.0)]


def mass(
    f: Functions, p: Parameters, x: Value, v: Value, load_sign: Value = 0.0, rubbed: Any = 0.0
) -> Value:
    """Inertance at the terminals [kg].

    For load friction: `load_sign` is the sign of N, `rubbed` the friction state.
    """
    if series.is_there(p):
        return 0.0
    inertance = flywheel.inertance(f, p, x, v)[0]
    if not rubs_by_load(p):
        return inertance
    return inertance * (1.0 + load_sign * _load_share(f, p, v, load_sign, rubbed))


def load_rest(
    f: Functions, p: Parameters, x: Value, v: Value, load_sign: Value, rubbed: Any
) -> Value:
    """Load friction of that part of N that does not depend on acceleration [N]."""
    rest = flywheel.inertance(f, p, x, v)[1] + flywheel.force(f, p, x, v)
    return load_sign * _load_share(f, p, v, load_sign, rubbed) * rest


def carried(f: Functions, p: Parameters, x: Value, v: Value, a: Value, z: Sequence[Value]) -> Value:
    """N, the force through the inertance [N]."""
    state = states_of(p, z)
    bearing = _bearing(f, p, x, v, a, state)
    if not rubs_flywheel(p):
        return bearing
    left = bearing - _law_force(_rubbing(f, p, x, v, state, bearing))
    if not rubs_by_load(p):
        return left
    return left / (1.0 + _load_share(f, p, state.speed, left, state.friction) * f.sign(left))


def _bearing(f: Functions, p: Parameters, x: Value, v: Value, a: Value, state: States) -> Value:
    """N, or the force of the series element [N]."""
    if series.is_there(p):
        return series.at(f, p, state.deflection, v - state.speed, state.gap).force
    inertance, rest = flywheel.inertance(f, p, x, v)
    return inertance * a + rest + flywheel.force(f, p, x, v)


def forces(
    p: Parameters, x: Value, v: Value, a: Value, z: Sequence[Value], f: Functions = NUMBERS
) -> dict[str, Value]:
    """Total force, force through the inertance, friction with load friction [N]."""
    through, state = carried(f, p, x, v, a, z), states_of(p, z)
    rub = _law_force(_rubbing(f, p, x, v, state, _bearing(f, p, x, v, a, state)))
    if rubs_by_load(p):
        speed = state.speed if rubs_flywheel(p) else v
        rub = rub + _load_share(f, p, speed, through, state.friction) * f.abs(through)
    total = beside.force(f, p, x, v) + branches.force(p, z) + rub + through
    if damper_spring.is_there(p):
        total = total + damper_spring.force(f, p, z)
    return {"total": total, "inertance": through, "friction": rub}


def stored_energy(
    p: Parameters, x: Value, v: Value, z: Sequence[Value], f: Functions = NUMBERS
) -> Value:
    """Kinetic, elastic, bristle, gas and stop energy [J]."""
    state = states_of(p, z)
    place = x - state.deflection if rubs_flywheel(p) else x
    energy = beside.stored_energy(f, p, x) + branches.stored_energy(p, z)
    if damper_spring.is_there(p):
        energy = energy + damper_spring.stored_energy(f, p, z)
    energy = energy + friction.stored_energy(f, p, place, state.friction)
    if not series.is_there(p):
        return energy + flywheel.stored_energy(f, p, x, v)
    shaft = series.stored_energy(f, p, state.deflection, state.gap)
    return energy + shaft + flywheel.stored_energy(f, p, x - state.deflection, state.speed)


def dissipated_power(
    f: Functions, p: Parameters, x: Value, v: Value, z: Sequence[Value], through: Value
) -> Value:
    """Power turned into heat [W]; `through` is N [N], read for load friction only."""
    state = states_of(p, z)
    bearing = _bearing(f, p, x, v, 0.0, state) if series.is_there(p) else through
    rubbing = _rubbing(f, p, x, v, state, bearing)
    place, speed = (x - state.deflection, state.speed) if rubs_flywheel(p) else (x, v)
    heat = beside.dissipated_power(f, p, x, v) + branches.dissipated_power(p, z)
    if damper_spring.is_there(p):
        heat = heat + damper_spring.dissipated_power(f, p, z)
    heat = heat + rubbing.bound * speed
    if rubbing.rate is not None:
        stored = friction.stored_power(f, p, place, speed, state.friction, rubbing.rate)
        if rubbing.damping:
            heat = heat + rubbing.damping * rubbing.rate * speed
        heat = heat - stored
    if rubs_by_load(p):
        share = _load_share(f, p, speed, through, state.friction)
        heat = heat + share * f.abs(through) * speed
    if not series.is_there(p):
        return heat + flywheel.dissipated_power(f, p, v)
    shaft = series.dissipated_power(f, p, state.deflection, v - state.speed, state.gap)
    return heat + shaft + flywheel.dissipated_power(f, p, state.speed)


def rubs_flywheel(p: Parameters) -> bool:
    """Whether friction acts behind a series element."""
    return p.friction_side == "flywheel" and series.is_there(p)


def _rubbing(
    f: Functions, p: Parameters, x: Value, v: Value, state: States, bearing: Value
) -> friction.Friction:
    """The friction law where it acts, under the load of `_bearing`."""
    if rubs_flywheel(p):
        x, v = x - state.deflection, state.speed
    law = friction.LAWS[p.friction]
    if not bends(p):
        return law(f, p, x, v, state.friction)
    if rubs_flywheel(p):
        # without the damper of LuGre
        if p.friction == "lugre":
            bearing = bearing - p.bristle_stiffness * friction.bristle(f, p, state.friction)
        else:
            bearing = bearing - law(f, p, x, v, state.friction).bound
    now = copy(p)
    now.load_level = _by_power(f, p, v, bearing) * f.abs(bearing)
    return law(f, now, x, v, state.friction)


def _law_force(rubbing: friction.Friction) -> Value:
    if not rubbing.damping:
        return rubbing.bound
    return rubbing.bound + rubbing.damping * rubbing.rate


def rubs_by_load(p: Parameters) -> bool:
    """Whether friction grows with the force through the inertance."""
    return bool(p.mu_forward or p.mu_backward)


def bends(p: Parameters) -> bool:
    """Whether the load raises the level of a bristle."""
    return rubs_by_load(p) and p.friction in ("dahl", "lugre", "bouc_wen", "maxwell_slip")


def _by_power(f: Functions, p: Parameters, v: Value, through: Value) -> Value:
    """Mu [-]: forward where N v >= 0, else backward."""
    if p.mu_backward == p.mu_forward:
        return p.mu_forward
    return f.choose(through * v < 0.0, p.mu_backward, p.mu_forward)


def _load_share(f: Functions, p: Parameters, v: Value, through: Value, rubbed: Any) -> Value:
    """Load friction per |N| of a law without a bristle [-]; of N the sign counts."""
    if not rubs_by_load(p) or bends(p):
        return 0.0
    mu = _by_power(f, p, v, through)
    if p.friction == "rate_state":
        mu = mu * friction.bracket(f, p, v, rubbed)
        mu = f.choose(through * v < 0.0, f.least(0.999, mu), mu)
    return mu * f.tanh(v / friction.sign_width(p))
