"""The element as an ObjectGenericODE2: what its coordinates are, its forces, its mass.

    M = B (1 + lambda) J'J + own masses,   f = [-J' (forces + B bias), forces of own coordinates]

The coordinates are those of the terminals' nodes, then the device's own. The flywheel behind a
series element is a true coordinate: its displacement y, with the inertance as its mass; the
series deflection follows, s = x - y. What has a rate only is the velocity of a coordinate with unit
mass, so that every solver of second order integrates it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from inerter.exudyn import control, flywheel, series
from inerter.exudyn import device as law
from inerter.exudyn.functions import NUMBERS, Functions, Value
from inerter.exudyn.kinematics import Line, Motion, Span, Twist
from inerter.exudyn.parameters import Parameters

HOLD = 1e-20
"""Stiffness that holds the position of a coordinate whose velocity alone means something, so that a
static solution exists; far below the rounding of what it is added to [N/m per kg]."""

HEAT = "dissipated_energy"
FLYWHEEL = "flywheel_velocity"
TURNED = "turned_angle"
"""Integrated angle of a torsional device, which tells how many turns there have been."""


class Recorded(NamedTuple):
    """Forces on all coordinates, the motion of the terminals, the inertance that joins them."""

    forces: list[Value]
    motion: Motion
    inertance: Value


@dataclass(frozen=True)
class Element:
    """The device, its kinematics, whether heat is added up."""

    device: Parameters
    kinematics: Line | Span | Twist
    heat: bool = False

    @property
    def own(self) -> tuple[str, ...]:
        """The device's own coordinates, each by the name of the state that is its velocity."""
        p = self.device
        there = [name for name in p.state_names if name != "series_deflection"]
        # without a damper the place in the play follows from the deflection
        if "gap_position" in there and not p.series_damping:
            there.remove("gap_position")
        if isinstance(self.kinematics, Twist):
            there.append(TURNED)
        return (*there, *((HEAT,) if self.heat else ()))

    @property
    def first(self) -> int:
        """Where the own coordinates begin."""
        return self.kinematics.size

    @property
    def size(self) -> int:
        """Number of coordinates of the object."""
        return self.first + len(self.own)

    @property
    def loaded(self) -> bool:
        """Whether load friction acts on a rigidly driven inertance, and needs accelerations."""
        return law.rubs_by_load(self.device) and not series.is_there(self.device)

    @property
    def constant_mass(self) -> bool:
        """Whether the mass matrix never changes."""
        p = self.device
        if control.lags(p) and p.control == "inertance" and not series.is_there(p):
            return False
        rigid = not series.is_there(p) and p.inertance > 0.0
        if not rigid:
            return True
        straight = isinstance(self.kinematics, Line)
        return straight and not flywheel.varies(self.device) and not self.loaded

    def motion(self, f: Functions, q: Sequence[Value], q_t: Sequence[Value]) -> Motion:
        """The terminals' motion; an angle goes on beyond a turn."""
        found = self.kinematics.at(f, q, q_t)
        if TURNED not in self.own:
            return found
        integrated = q_t[self.first + self.own.index(TURNED)]
        turns = f.round((integrated - found.length) / (2.0 * math.pi))
        return found._replace(length=found.length + 2.0 * math.pi * turns)

    def states(self, x: Value, q: Sequence[Value], q_t: Sequence[Value]) -> list[Value]:
        """The device's states at stretch x [m] and all coordinates."""
        place = {name: self.first + i for i, name in enumerate(self.own)}
        found: list[Value] = []
        for name in self.device.state_names:
            if name == "series_deflection":
                found.append(x - q[place[FLYWHEEL]])
            else:
                found.append(q_t[place[name]] if name in place else 0.0)
        return found

    def own_mass(self, name: str) -> float:
        """Mass of an own coordinate: the flywheel's is the inertance [kg], else 1."""
        return self.device.inertance if name == FLYWHEEL else 1.0

    def mass_matrix(self) -> NDArray[np.float64]:
        """The constant part of the mass matrix, shape (size, size)."""
        matrix = np.zeros((self.size, self.size))
        own = range(self.first, self.size)
        matrix[own, own] = [self.own_mass(name) for name in self.own]
        if self.constant_mass and isinstance(self.kinematics, Line):
            row = np.array(self.kinematics.row)
            inertance = law.mass(NUMBERS, self.device, 0.0, 0.0)
            matrix[: self.first, : self.first] = inertance * np.outer(row, row)
        return matrix

    def hold_matrix(self) -> NDArray[np.float64]:
        """Stiffness that holds what has no stiffness of its own, shape (size, size)."""
        matrix = np.zeros((self.size, self.size))
        own = range(self.first, self.size)
        matrix[own, own] = [HOLD * self.own_mass(name) for name in self.own]
        return matrix

    def record(
        self, f: Functions, q: Sequence[Value], q_t: Sequence[Value], q_tt: Sequence[Value] = ()
    ) -> Recorded:
        """All that a user function tells; q_tt, the latest accelerations, only if `loaded`."""
        p, motion = self.device, self.motion(f, q, q_t)
        x, v = motion.length - p.rest_length, motion.rate
        z = self.states(x, q, q_t)
        p = control.present(f, p, z)
        forces: list[Value] = [0.0] * self.size
        at_terminals: Value = 0.0
        a: Value = 0.0
        if self.loaded:
            a = motion.bias
            for share, latest in zip(motion.row, q_tt, strict=False):
                a = a + share * latest
        for term in law.terms(f, p, x, v, z, a):
            at_terminals = at_terminals + term.terminals * term.value
            for place, share in self.own_shares(term):
                forces[place] = forces[place] + share * term.value
        sign: Value = 0.0
        rubbed = law.states_of(p, z).friction
        if self.loaded:
            through = law.carried(f, p, x, v, a, z)
            # where N changes sign the friction passes 0: a sign late by a step costs little
            sign = f.choose(through < 0.0, -1.0, 1.0)
            at_terminals = at_terminals + law.load_rest(f, p, x, v, sign, rubbed)
        inertance = 0.0 if self.constant_mass else law.mass(f, p, x, v, sign, rubbed)
        at_terminals = at_terminals + inertance * motion.bias
        for place, share in enumerate(motion.row):
            forces[place] = -(share * at_terminals)
        if TURNED in self.own:
            forces[self.first + self.own.index(TURNED)] = v
        if self.heat:
            through = law.carried(f, p, x, v, a, z) if law.rubs_by_load(p) else 0.0
            forces[-1] = law.dissipated_power(f, p, x, v, z, through)
        return Recorded(forces, motion, inertance)

    def own_shares(self, term: law.Term) -> list[tuple[int, float]]:
        """The own coordinates that a term drives, and its factors there."""
        names, own, found = self.device.state_names, self.own, []
        for place, share in term.rates:
            name = names[place]
            if name in own:
                found.append((self.first + own.index(name), share * self.own_mass(name)))
        return found
