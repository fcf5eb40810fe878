"""The series element between terminal 2 and the flywheel: spring, damper, backlash or slip.

    F_s = phi(d) + c_s (s' - gap'),   d = s - gap,   -eps <= gap <= eps
    in contact (gap = +eps and F_s >= 0, or gap = -eps and F_s <= 0):   gap' = 0
    in the gap:   F_s = 0, the shaft relaxes:   gap' = s' + phi(d) / c_s
    with slip in the place of a gap, see `clutch.py`: gap' = u

Symbols: s series deflection [m], gap position within the free play [m], d deflection of the
shaft [m], c_s `series_damping` [N s/m], eps `backlash` [m] (half the free play), phi see
`series_spring.py`.
Sign: tension positive.
Range: without backlash gap = 0. c_s = 0: the shaft has no memory, gap = s limited to +-eps (a dead
zone). k_s = 0: a dashpot in series, s then only drifts.
Stored: U(d). Dissipated: F_s s' - phi d' = c_s d'^2, never negative.
Source: Nordin, Galic and Gutman, "New models for backlash and gear play", 1997; the release set
is Wang and Su's eq. (7): contact is lost when the force, not the position, changes sign.
Why not the dead zone with a damper: its damper pulls while the teeth part, and jumps at contact.
Not modelled: impact losses other than c_s, friction inside the gap.

A contact is +1 (at +eps), -1 (at -eps) or 0 (in the gap). Whoever integrates with event location
states it; elsewhere (`contact` None) it follows from the states.
"""

from __future__ import annotations

import numpy as np

from . import clutch, series_spring
from .device_parameters import DeviceParameters
from .parameters import Quantity

Contact = int | None


def gap_position(parameters: DeviceParameters, series: Quantity, gap: Quantity) -> Quantity:
    """The gap [m]: the state, or where it follows from s alone (no damper) that."""
    if parameters.has_clutch:
        return gap
    if parameters.backlash == 0.0:
        return 0.0 * series
    if parameters.series_damping == 0.0:
        return np.minimum(parameters.backlash, np.maximum(-parameters.backlash, series))
    return gap


def gap_rate(
    parameters: DeviceParameters,
    series: Quantity,
    series_rate: Quantity,
    gap: Quantity,
    contact: Contact = None,
) -> Quantity:
    """Rate of the gap [m/s] at s [m], s' [m/s] and gap [m], which broadcast together."""
    if parameters.has_clutch:
        spring = series_spring.force(parameters, series - gap)
        return clutch.rate(parameters, spring, series_rate)
    eps = parameters.backlash
    if eps == 0.0 or (contact is not None and contact != 0):
        return 0.0 * series_rate
    if parameters.series_damping == 0.0:
        free = abs(series) < eps if contact is None else True
        return np.where(free, series_rate, 0.0)
    relaxing = series_rate + series_spring.force(parameters, series - gap) / (
        parameters.series_damping
    )
    if contact == 0:
        return relaxing
    upper = np.where(gap >= eps, np.minimum(0.0, relaxing), relaxing)
    return np.where(gap <= -eps, np.maximum(0.0, relaxing), upper)


def force(
    parameters: DeviceParameters,
    series: Quantity,
    series_rate: Quantity,
    gap: Quantity,
    contact: Contact = None,
) -> Quantity:
    """Force F_s [N] through the element."""
    if parameters.has_clutch:
        spring = series_spring.force(parameters, series - gap)
        return clutch.force(parameters, spring, series_rate)
    if contact == 0 and parameters.backlash > 0.0:
        return 0.0 * series_rate
    if contact is not None and parameters.backlash > 0.0:
        position: Quantity = contact * parameters.backlash
    else:
        position = gap_position(parameters, series, gap)
    shaft_rate = series_rate - gap_rate(parameters, series, series_rate, gap, contact)
    return (
        series_spring.force(parameters, series - position) + parameters.series_damping * shaft_rate
    )


def stored_energy(parameters: DeviceParameters, series: Quantity, gap: Quantity) -> Quantity:
    """Energy U [J] in the shaft."""
    return series_spring.stored_energy(parameters, series - gap_position(parameters, series, gap))


def dissipated_power(
    parameters: DeviceParameters, series: Quantity, series_rate: Quantity, gap: Quantity
) -> Quantity:
    """Heat F_s s' - phi d' [W]."""
    shaft = series_spring.force(parameters, series - gap_position(parameters, series, gap))
    shaft_rate = series_rate - gap_rate(parameters, series, series_rate, gap)
    return force(parameters, series, series_rate, gap) * series_rate - shaft * shaft_rate


def guards(
    parameters: DeviceParameters, series: float, series_rate: float, gap: float, contact: int
) -> list[tuple[float, int]]:
    """What ends a contact: (value, next contact) pairs, a value falls through zero at the end."""
    eps = parameters.backlash
    place = series if parameters.series_damping == 0.0 else gap
    if contact == 0:
        return [(eps - place, 1), (eps + place, -1)]
    if parameters.series_damping == 0.0:
        return [(contact * series - eps, 0)]
    return [(contact * float(force(parameters, series, series_rate, gap, contact)), 0)]


def contact_of(parameters: DeviceParameters, series: float, series_rate: float, gap: float) -> int:
    """The contact that the states mean."""
    eps = parameters.backlash
    place = series if parameters.series_damping == 0.0 else gap
    for side in (1, -1):
        if side * place >= eps and guards(parameters, series, series_rate, gap, side)[0][0] >= 0.0:
            return side
    return 0
