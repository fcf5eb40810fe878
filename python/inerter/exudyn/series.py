"""The element between terminal and flywheel: an elastic, damped shaft, with free play or slip.

    rigid teeth:       F_s = phi(s) + c_s s'
    play, c_s > 0:     r = s' + phi(s - g) / c_s;  F_s = c_s r where the teeth press, else 0
    play, c_s = 0:     F_s = phi(d), d the part of s outside the play
    a clutch or leak:  `clutch.py`, g is how far it has slipped, g' = u
    phi(d) = k_s (1 + q d) d, constant where its tangent would turn negative

Symbols: s series deflection [m], g position within the play [m], |g| <= eps `backlash`. Teeth
press at g = eps while r > 0 and at g = -eps while r < 0; elsewhere the shaft relaxes with g' = r.
Sign: tension positive. Source: Nordin, Galic and Gutman 1997.

At the edge the force of a damped shaft jumps, and a step of an implicit solver may have no
solution. `smooth_play` makes a corner of the jump: the teeth press from r = K (eps - g) on, K being
`EAGER` k_s / c_s; the play then seems shorter by r / K.

A solver's last step may carry g a little past the edge; the force takes the edge, and g is drawn
back at the shaft's own rate k_s / c_s.
"""

from __future__ import annotations

from typing import NamedTuple

from inerter.exudyn import clutch
from inerter.exudyn.functions import Functions, Value
from inerter.exudyn.parameters import Parameters

EAGER = 10.0
"""With smooth play the teeth begin to press this many times faster than the shaft relaxes."""


class Series(NamedTuple):
    """Force [N], and the rate of the position in the play, or of the slip [m/s]."""

    force: Value
    gap_rate: Value


def is_there(p: Parameters) -> bool:
    """Whether the device has such an element."""
    return bool(p.series_stiffness or p.series_damping or clutch.is_there(p))


def at(f: Functions, p: Parameters, s: Value, rate: Value, gap: Value) -> Series:
    """What the element does at deflection s [m], s' [m/s], position in the play [m]."""
    if clutch.is_there(p):
        return Series(*clutch.at(f, p, _spring(f, p, s - gap), rate))
    eps = p.backlash
    if not eps:
        return Series(_spring(f, p, s) + p.series_damping * rate, 0.0)
    if not p.series_damping:
        return Series(_spring(f, p, s - position(f, p, s, gap)), 0.0)
    relaxing = rate + _spring(f, p, s - position(f, p, s, gap)) / p.series_damping
    if p.smooth_play and p.series_stiffness:
        eager = EAGER * p.series_stiffness / p.series_damping
        upper = f.greatest(0.0, relaxing + eager * (gap - eps))
        pressing = upper + f.least(0.0, relaxing + eager * (gap + eps))
        return Series(p.series_damping * pressing, relaxing - pressing)
    pressing = f.choose(
        gap >= eps, f.greatest(0.0, relaxing), f.choose(gap <= -eps, f.least(0.0, relaxing), 0.0)
    )
    overshoot = gap - position(f, p, s, gap)
    back = p.series_stiffness / p.series_damping * overshoot
    return Series(p.series_damping * pressing, relaxing - pressing - back)


def position(f: Functions, p: Parameters, s: Value, gap: Value) -> Value:
    """Position in the play [m]: the state, or s itself where the shaft has no damper."""
    if clutch.is_there(p):
        return gap
    if not p.backlash:
        return 0.0
    place = gap if p.series_damping else s
    return f.least(p.backlash, f.greatest(-p.backlash, place))


def stored_energy(f: Functions, p: Parameters, s: Value, gap: Value) -> Value:
    """Energy in the shaft [J]."""
    deflection = s - position(f, p, s, gap)
    inside = _inside(f, p, deflection)
    share = 0.5 + p.series_hardening * inside / 3.0
    energy = p.series_stiffness * inside * inside * share
    return energy + _spring(f, p, deflection) * (deflection - inside)


def dissipated_power(f: Functions, p: Parameters, s: Value, rate: Value, gap: Value) -> Value:
    """Heat in the shaft: c_s (s' - g')^2 [W]; of what slips F_s g' besides."""
    if clutch.is_there(p):
        force, slip = at(f, p, s, rate, gap)
        return (force - _spring(f, p, s - gap)) * (rate - slip) + force * slip
    if not p.series_damping:
        return 0.0
    if not p.backlash:
        return p.series_damping * rate * rate
    spring, shaft = _spring(f, p, s - position(f, p, s, gap)), at(f, p, s, rate, gap)
    # (F_s - phi) / c_s is the rate at which the shaft itself deforms
    deforming = (shaft.force - spring) / p.series_damping
    heat = p.series_damping * deforming * deforming
    # teeth that press before the edge give way
    return heat + shaft.force * shaft.gap_rate if p.smooth_play else heat


def _inside(f: Functions, p: Parameters, d: Value) -> Value:
    """The deflection, limited to where the spring's tangent is not negative."""
    if not p.series_hardening:
        return d
    corner = -0.5 / p.series_hardening
    return f.greatest(d, corner) if p.series_hardening > 0.0 else f.least(d, corner)


def _spring(f: Functions, p: Parameters, d: Value) -> Value:
    if not p.series_hardening:
        return p.series_stiffness * d
    inside = _inside(f, p, d)
    return p.series_stiffness * (1.0 + p.series_hardening * inside) * inside
