"""Integration of a system with backlashes: each change of contact is located as an event.

Between two changes every backlash stays in its contact (+1, -1, in the gap) and the rates are
smooth; the solver runs on those rates beyond the change, the change's time is found on its
interpolant, and the run starts again from there. Position alone never decides: a contact ends
where its force passes zero (see `laws/series.py`).
Range: a contact that opens and closes again within one step of the solver is missed.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from .device import ReferenceDevice
from .laws import Quantity

Array = NDArray[np.float64]
Contacts = tuple[int, ...]
Rates = Callable[[float, Array, Contacts], Array]

MOST_CHANGES = 100_000
SAME_MOMENT = 1e-9
"""Share of the free play (of its force) within which two changes count as one moment."""


@dataclass(frozen=True)
class Clutch:
    """One backlash inside a system.

    Attributes
    ----------
    device
        The device with the backlash.
    terminals
        (time [s], system state, contact) -> the device's terminal velocity [m/s] and states.
    gap_index, series_index
        Where the device's gap and series deflection stand in the system's state.
    """

    device: ReferenceDevice
    terminals: Callable[[float, Array, int], tuple[float, Quantity]]
    gap_index: int
    series_index: int

    def contact(self, t: float, state: Array) -> int:
        """The contact that the states mean."""
        found = 0
        for trial in (1, -1):
            v, z = self.terminals(t, state, trial)
            found = self.device.contact_of(v, z) if found == 0 else found
        return found

    def settle(self, state: Array, contact: int) -> None:
        """Put the gap exactly where the contact has it."""
        eps = self.device.backlash
        if contact:
            state[self.gap_index] = contact * eps
        elif self.device.series_damping == 0.0:
            state[self.gap_index] = np.clip(state[self.series_index], -eps, eps)


def integrate(
    rates: Rates,
    initial: Array,
    stops: Array,
    clutches: Sequence[Clutch] = (),
    *,
    method: str,
    rtol: float,
    atol: float | Array,
    max_step: float = np.inf,
) -> Array:
    """The states at `stops`, shape (stops, states); the first stop is where `initial` stands.

    Raises RuntimeError where the solver gives up or the contacts change without end.
    """
    path = np.empty((stops.size, initial.size))
    path[0] = initial
    now, state, done = float(stops[0]), np.array(initial, dtype=np.float64), 1
    contacts = tuple(clutch.contact(now, state) for clutch in clutches)
    for _ in range(MOST_CHANGES):
        if done == stops.size:
            return path
        held = contacts
        changes = _changes(clutches, held)
        solution = solve_ivp(
            lambda t, y: rates(t, y, held),  # noqa: B023 - used within this turn only
            (now, float(stops[-1])),
            state,
            method=method,  # pyright: ignore[reportArgumentType]
            t_eval=stops[done:],
            events=[event for event, _, _ in changes] or None,
            rtol=rtol,
            atol=atol,
            max_step=max_step,
            **_jacobian(rates, held, method),  # pyright: ignore[reportArgumentType]
        )
        if not solution.success:
            raise RuntimeError(f"{method} stopped after {now:.9g} s: {solution.message}")
        # an empty list, not an array, if the change comes before the next stop
        if len(solution.t):
            path[done : done + len(solution.t)] = solution.y.T
            done += len(solution.t)
        if solution.status == 1:
            hit = next(i for i, times in enumerate(solution.t_events) if times.size)
            now = float(solution.t_events[hit][-1])
            state = np.array(solution.y_events[hit][-1])
            _, which, following = changes[hit]
            contacts = _switch(clutches, held, state, which, following)
            for other in range(len(clutches)):
                if other != which:
                    contacts = _join(clutches, contacts, now, state, other)
    raise RuntimeError(f"contacts keep changing near {now:.9g} s; give series_damping")


def _switch(
    clutches: Sequence[Clutch], contacts: Contacts, state: Array, which: int, following: int
) -> Contacts:
    """The contacts after one of them has changed; its gap in `state` is put right."""
    clutches[which].settle(state, following)
    return (*contacts[:which], following, *contacts[which + 1 :])


def _join(
    clutches: Sequence[Clutch], contacts: Contacts, t: float, state: Array, which: int
) -> Contacts:
    """The contacts after `which` has changed too, if it is at its own change in this moment.

    Equal devices on equal paths change together; the second change would otherwise lie exactly at
    the start of the next run, where no solver sees it.
    """
    clutch, contact = clutches[which], contacts[which]
    v, z = clutch.terminals(t, state, contact)
    device = clutch.device
    size = device.backlash * (device.series_stiffness if contact else 1.0)
    for value, following in device.contact_guards(v, z, contact):
        if value > SAME_MOMENT * size:
            continue
        # one that has just opened stands at its edge as well, but would be pulled there
        moved = state.copy()
        clutch.settle(moved, following)
        v, z = clutch.terminals(t, moved, following)
        if following == 0 or device.contact_guards(v, z, following)[0][0] > 0.0:
            return _switch(clutches, contacts, state, which, following)
    return contacts


def _jacobian(rates: Rates, contacts: Contacts, method: str) -> dict[str, object]:
    """A Jacobian for the methods that want one, by differences of a fixed size.

    SciPy's own widens its step without end for a state that nothing depends on, such as the
    shaker's charge or the deflection of a dashpot.
    """
    if method not in ("Radau", "BDF"):
        return {}

    def jacobian(t: float, state: Array) -> Array:
        base = rates(t, state, contacts)
        columns = np.empty((base.size, state.size))
        for i, value in enumerate(state):
            moved = state.copy()
            moved[i] += 1e-8 * max(abs(float(value)), 1e-2)
            columns[:, i] = (rates(t, moved, contacts) - base) / (moved[i] - value)
        return columns

    return {"jac": jacobian}


def _changes(
    clutches: Sequence[Clutch], contacts: Contacts
) -> list[tuple[Callable[[float, Array], float], int, int]]:
    """Events that end the present contacts: (event, which clutch, its next contact)."""
    found: list[tuple[Callable[[float, Array], float], int, int]] = []
    for which, (clutch, contact) in enumerate(zip(clutches, contacts, strict=True)):
        for number in range(1 if contact else 2):
            event = _Falling(clutch, contact, number)
            following = 0 if contact else (1, -1)[number]
            found.append((event, which, following))
    return found


class _Falling:
    """A guard as `solve_ivp` wants it: terminal, when it falls through zero."""

    terminal = True
    direction = -1.0

    def __init__(self, clutch: Clutch, contact: int, number: int) -> None:
        """Guard `number` of the clutch in its contact."""
        self.clutch, self.contact, self.number = clutch, contact, number

    def __call__(self, t: float, state: Array) -> float:
        """Value of the guard."""
        v, z = self.clutch.terminals(t, state, self.contact)
        return self.clutch.device.contact_guards(v, z, self.contact)[self.number][0]
