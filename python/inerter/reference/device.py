"""The device: an inertance with everything that stands beside it and in series with it.

    F = T(x, v, z) + N + lambda(v, z) |N|
    T = D(v) + k x + k3 x^3 + f0 + F_friction + F_stops                   at the terminals
        + f(x) + c_x(x) v + F_map(x, v), see `laws/stroke.py` and `laws/force_map.py`
    D(v) = c v + c2 v |v|, bent, see `laws/parallel.py`; at w_d in place of v behind a spring, see
           `laws/damper_spring.py`
    without a series element:  N = B(x, v) a + R(x, v) + G(x, v)
    with one:                  N = F_s(s, s', gap),   B(y, w) w' + R(y, w) + G(y, w) = F_s
    G(y, w) = c_w w + pipe(w) + gas(y)                                    at the flywheel
    friction_side "flywheel" with a series element: F = T + F_s, T without friction, and
    F_s = N + F_friction(y, w, z) + lambda(w) |N|,   N = B(y, w) w' + R(y, w) + G(y, w)

Symbols: x = x2 - x1 (length minus rest_length); s = x - y series deflection, y and w = y'
displacement and velocity of the flywheel side; c_w `flywheel_viscous` [N s/m]. Without a series
element y = x and w = v. Each term's law, range and source stand in its own file in `laws/`.
Sign: positive x = longer; F is the force that lengthens the device (tension positive) and acts on
the bodies as -F along the line. By hand: b = 2 kg, a = 3 m/s^2 gives F = +6 N.
States, each only if needed: friction_state [m], series_deflection s [m], flywheel_velocity w
[m/s], gap_position or slip_position [m], branch_deflection_i [m], damper_velocity w_d [m/s],
control_change (`laws/control.py`). All zero: unloaded, flywheel at rest, middle of the
gap, every parameter as stated.
Not modelled: masses of the terminals, several series elements.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .device_states import DeviceStates, at_command
from .laws import (
    FRICTION,
    Quantity,
    branches,
    channel,
    control,
    damper_spring,
    end_stops,
    gas,
    inertance,
    load,
    parallel,
    series,
)
from .laws.series import Contact

MOST_ROUNDS = 200
"""In which the acceleration of a loaded bristle with a damper is found."""


@dataclass(frozen=True, kw_only=True)
class ReferenceDevice(DeviceStates):
    """One device: its parameters, and what follows from them.

    Arguments of the methods: x [m] the length, from which `rest_length` is taken, v [m/s],
    a [m/s^2] are numbers or arrays that broadcast together; results have their common shape.
    `z` holds the states: for `nstate` 0 it is ignored, for 1 it has the shape of x, for more it
    has shape (..., nstate); the number 0 means all states zero. `contact` (see `laws/series.py`)
    is for integrators that locate contacts; without it the states decide.
    """

    @property
    def total_inertance(self) -> float:
        """The inertance [kg]: `inertance`, or what the channel's geometry gives."""
        return self.inertance if self.channel_area == 0.0 else channel.inertance(self)

    @at_command
    def force(
        self, x: Quantity, v: Quantity, a: Quantity, z: Quantity = 0.0, *, contact: Contact = None
    ) -> Quantity:
        """Total force F [N], tension positive."""
        if self.rubs_flywheel:
            return self._series_force(x, v, z, contact) + self._beside(x, v, z)
        carried = self.inertance_force(x, v, a, z, contact=contact)
        along = self.load_friction_force(v, carried, z)
        return carried + along + self.rest_force(x, v, z, a=a)

    @at_command
    def branch(
        self, x: Quantity, v: Quantity, z: Quantity = 0.0, *, contact: Contact = None
    ) -> tuple[Quantity, Quantity]:
        """B [kg] and r [N] of the inertance branch's force N = B a + r at the terminals.

        With a series element B is zero and r the series element's force.
        """
        if self.has_series:
            return 0.0, self._series_force(x, v, z, contact)
        stretch = x - self.rest_length
        mass, rest = inertance.branch(self, self.total_inertance, stretch, v)
        return mass, rest + self._flywheel_side(stretch, v)

    @at_command
    def inertance_force(
        self, x: Quantity, v: Quantity, a: Quantity, z: Quantity = 0.0, *, contact: Contact = None
    ) -> Quantity:
        """The force through the inertance branch N [N]."""
        if self.rubs_flywheel:
            return self._flywheel_share(x, v, z, contact)
        mass, rest = self.branch(x, v, z, contact=contact)
        return mass * a + rest

    @at_command
    def rest_force(
        self, x: Quantity, v: Quantity, z: Quantity = 0.0, *, a: Quantity = 0.0
    ) -> Quantity:
        """The part T of F [N] that stands beside the inertance branch; a as in `friction_force`."""
        if self.rubs_flywheel:
            return self._beside(x, v, z)
        return self._beside(x, v, z) + self.friction_force(x, v, z, a=a)

    @at_command
    def total_friction(self, x: Quantity, v: Quantity, a: Quantity, z: Quantity = 0.0) -> Quantity:
        """Friction law and load friction [N], on the side where they act."""
        speed = self._states(z)[2] if self.rubs_flywheel else v
        carried = self.inertance_force(x, v, a, z)
        along = self.load_friction_force(speed, carried, z)
        return self.friction_force(x, v, z, a=a) + along

    @at_command
    def friction_force(
        self,
        x: Quantity,
        v: Quantity,
        z: Quantity = 0.0,
        *,
        a: Quantity = 0.0,
        contact: Contact = None,
    ) -> Quantity:
        """Force of the friction law alone [N], without `viscous`.

        Without load friction, but where the load raises the level of a bristle: there the damper of
        LuGre follows it, without a series element with the acceleration a [m/s^2].
        """
        state, deflection, speed, _ = self._states(z)
        stretch = x - self.rest_length
        place, rate = (stretch - deflection, speed) if self.rubs_flywheel else (stretch, v)
        loaded = self._loaded(x, v, a, z, contact)
        return FRICTION[self.friction].force(loaded, place, rate, state)

    def load_friction_force(self, v: Quantity, carried: Quantity, z: Quantity = 0.0) -> Quantity:
        """Load friction lambda |N| [N] of a law without a bristle, N the force carried."""
        return load.force(self, carried, v, self._states(z)[0])

    def load_share(self, v: Quantity, carried: Quantity, z: Quantity = 0.0) -> Quantity:
        """The factor lambda [-] on |N| at the terminals, by the sign of N."""
        if self.rubs_flywheel:
            return 0.0 * v
        return load.share(self, carried, v, self._states(z)[0])

    def _loaded(
        self, x: Quantity, v: Quantity, a: Quantity, z: Quantity, contact: Contact = None
    ) -> ReferenceDevice:
        """The device with what the load adds to the level of its bristle."""
        if not load.bends(self):
            return self
        friction, deflection, speed, _ = self._states(z)
        if not self.rubs_flywheel:
            mass, rest = self.branch(x, v, z, contact=contact)
            return self._with_value("load_level", load.level(self, mass * a + rest, v))
        place = x - self.rest_length - deflection
        spring = FRICTION[self.friction].force(self._undamped, place, speed, friction)
        left = self._series_force(x, v, z, contact) - spring
        return self._with_value("load_level", load.level(self, left, speed))

    @property
    def _undamped(self) -> ReferenceDevice:
        """The device without the damper of LuGre."""
        return self if self.bristle_damping == 0.0 else self._with_value("bristle_damping", 0.0)

    @at_command
    def acceleration(
        self, x: Quantity, v: Quantity, force: Quantity, z: Quantity = 0.0
    ) -> Quantity:
        """The acceleration [m/s^2] at which the device carries `force` [N]: `force` inverted.

        Raises
        ------
        ValueError
            The inertance is zero or has a series element before it: the force then says nothing
            about the terminals' acceleration.
        RuntimeError
            The damper of a bristle grows too fast with its load for one acceleration to fit.
        """
        if self.total_inertance == 0.0:
            raise ValueError("inertance: 0 kg gives no acceleration for a force; give more than 0")
        if self.has_series:
            raise ValueError(
                "series_stiffness: with a series element the force does not depend on the "
                "terminals' acceleration; ask state_rate for the flywheel's"
            )
        mass, rest = self.branch(x, v, z)
        found: Quantity = 0.0
        for _ in range(MOST_ROUNDS):
            before = found
            remainder = force - self.rest_force(x, v, z, a=before)
            share = self.load_share(v, remainder, z) * np.sign(remainder)
            found = (remainder / (1.0 + share) - rest) / mass
            # only the damper of a loaded bristle asks for the acceleration
            same = abs(found - before) <= 1e-14 * (abs(found) + abs(before))
            if not (load.bends(self) and self.bristle_damping > 0.0) or np.all(same):
                return found
        raise RuntimeError(
            "the load on a bristle and the acceleration do not settle; is load_friction "
            "bristle_damping |v| below the friction level?"
        )

    def state_rate(
        self,
        x: Quantity,
        v: Quantity,
        z: Quantity = 0.0,
        *,
        a: Quantity = 0.0,
        contact: Contact = None,
    ) -> Quantity:
        """Rates of the states, in the form of `z`; zero for a device without any.

        The acceleration a [m/s^2] counts where a load raises the level of a bristle, as in
        `friction_force`.
        """
        if self.control == "force":
            return self._own_rate(x, v, z, a, contact)
        present, inner = self._at_present(z)
        if not control.count(self):
            return present._own_rate(x, v, inner, a, contact)
        change = np.asarray(control.rate(self, self._change(z)))
        if self.nstate == 1:
            return change + 0.0 * np.asarray(v)
        rates = np.asarray(present._own_rate(x, v, inner, a, contact))
        columns = [rates] if present.nstate == 1 else list(np.moveaxis(rates, -1, 0))
        return _beside([*columns, change])

    def control_power(self, x: Quantity, v: Quantity, z: Quantity = 0.0) -> Quantity:
        """Power that the control's actuator gives to the device [W]: dE/dp p'."""
        if not control.count(self):
            return 0.0 * np.asarray(v)
        present, inner = self._at_present(z)
        return present._energy_per(self.control, x, v, inner) * control.value_rate(
            self, self._change(z)
        )

    def _energy_per(self, name: str, x: Quantity, v: Quantity, z: Quantity) -> Quantity:
        """Stored energy per unit of a parameter that it is linear in [J]; 0 where in none."""
        friction, deflection, speed, _ = self._states(z)
        stretch = x - self.rest_length
        position, speed = (stretch - deflection, speed) if self.has_series else (stretch, v)
        if name == "stiffness":
            return parallel.spring_energy(stretch, 1.0, 0.0)
        if name == "inertance":
            return inertance.stored_energy(self, 1.0, position, speed)
        if name == "bw_stiffness":
            place, rate = (position, speed) if self.rubs_flywheel else (stretch, v)
            unit = self._with_value(name, 1.0)
            return FRICTION[self.friction].stored_energy(unit, place, rate, friction)
        return 0.0 * np.asarray(v)

    def _own_rate(
        self, x: Quantity, v: Quantity, z: Quantity, a: Quantity, contact: Contact
    ) -> Quantity:
        """The same without a state of the control."""
        inner = self._inner_rate(x, v, z, a, contact)
        count = branches.count(self) + self._springy_damper
        if not count:
            return inner
        _, deflections, own = self._split(z)
        columns = list(np.moveaxis(branches.rates(self, v, deflections), -1, 0))
        if self._springy_damper:
            columns.append(np.asarray(damper_spring.rate(self, v, own)))
        if self.nstate == 1:
            return columns[0]
        if self.nstate > count:
            several = self.nstate - count > 1
            columns = [*(np.moveaxis(np.asarray(inner), -1, 0) if several else [inner]), *columns]
        return _beside(columns)

    def _inner_rate(
        self, x: Quantity, v: Quantity, z: Quantity, a: Quantity, contact: Contact
    ) -> Quantity:
        """The same of all states but those of the branches."""
        friction, deflection, speed, gap = self._states(z)
        stretch = x - self.rest_length
        place, rubbing = (stretch - deflection, speed) if self.rubs_flywheel else (stretch, v)
        loaded = self._loaded(x, v, a, z, contact)
        rates = [FRICTION[self.friction].rate(loaded, place, rubbing, friction)]
        if not self.has_series:
            return rates[0]

        # the flywheel is driven by the series element
        if self.friction_states > 1:
            rates = list(np.moveaxis(np.asarray(rates[0]), -1, 0))
        elif not self.friction_states:
            rates = []
        series_rate = v - speed
        if self.rubs_flywheel:
            pull = self._flywheel_share(x, v, z, contact)
        else:
            pull = series.force(self, deflection, series_rate, gap, contact)
        position = stretch - deflection
        mass, rest = inertance.branch(self, self.total_inertance, position, speed)
        rates += [series_rate, (pull - rest - self._flywheel_side(position, speed)) / mass]
        if self.backlash > 0.0 or self.has_clutch:
            rates.append(series.gap_rate(self, deflection, series_rate, gap, contact))
        return _beside(rates)

    @at_command
    def stored_energy(self, x: Quantity, v: Quantity, z: Quantity = 0.0) -> Quantity:
        """Kinetic, spring, bristle, stop and gas energy [J]."""
        friction, deflection, speed, gap = self._states(z)
        stretch = x - self.rest_length
        position, speed = (stretch - deflection, speed) if self.has_series else (stretch, v)
        energy = parallel.spring_energy(stretch, self.stiffness, self.stiffness_cubic)
        if "force" in self.along:
            energy = energy + self.along["force"].integral(stretch)
        energy = energy + (self.surface.stored_energy(stretch) if self.surface else 0.0)
        place, rate = (position, speed) if self.rubs_flywheel else (stretch, v)
        energy = energy + FRICTION[self.friction].stored_energy(self, place, rate, friction)
        energy = energy + end_stops.stored_energy(self, stretch)
        energy = energy + inertance.stored_energy(self, self.total_inertance, position, speed)
        energy = energy + gas.stored_energy(self, position)
        if self.has_series:
            energy = energy + series.stored_energy(self, deflection, gap)
        _, deflections, own = self._split(z)
        if self._springy_damper:
            energy = energy + damper_spring.stored_energy(self, own)
        return energy + branches.stored_energy(self, deflections)

    @at_command
    def dissipated_power(
        self, x: Quantity, v: Quantity, a: Quantity, z: Quantity = 0.0
    ) -> Quantity:
        """Power turned into heat [W]: F v - f0 v - d(stored)/dt.

        The work of `force_offset` is external and counts as neither stored nor dissipated.
        """
        friction, deflection, speed, gap = self._states(z)
        stretch = x - self.rest_length
        _, deflections, own = self._split(z)
        rate_there = own if self._springy_damper else v
        heat = self._damper(stretch, v, own) * rate_there
        heat = heat + (self.surface.dissipated_power(stretch, v) if self.surface else 0.0)
        place, rate = (stretch - deflection, speed) if self.rubs_flywheel else (stretch, v)
        loaded = self._loaded(x, v, a, z)
        heat = heat + FRICTION[self.friction].dissipated_power(loaded, place, rate, friction)
        heat = heat + end_stops.dissipated_power(self, stretch, v)
        carried = self.inertance_force(x, v, a, z)
        heat = heat + self.load_friction_force(rate, carried, z) * rate
        if self.has_series:
            heat = heat + series.dissipated_power(self, deflection, v - speed, gap)
        else:
            speed = v
        heat = heat + branches.dissipated_power(self, v, deflections)
        flywheel = self.flywheel_viscous * speed * speed
        return heat + flywheel + channel.dissipated_power(self, speed)

    @at_command
    def gas_valid(self, x: Quantity, z: Quantity = 0.0) -> bool | NDArray[np.bool_]:
        """Whether the gas law is inside its validity; true without gas."""
        deflection = self._states(z)[1]
        return gas.valid(self, x - self.rest_length - deflection)

    @at_command
    def contact_of(self, v: float, z: Quantity) -> int:
        """The contact of the backlash that the states mean: +1, -1 or 0 (in the gap)."""
        _, deflection, speed, gap = self._states(z)
        return series.contact_of(self, float(deflection), v - float(speed), float(gap))

    @at_command
    def contact_guards(self, v: float, z: Quantity, contact: int) -> list[tuple[float, int]]:
        """What ends the contact, see `series.guards`."""
        _, deflection, speed, gap = self._states(z)
        return series.guards(self, float(deflection), v - float(speed), float(gap), contact)

    def _damper(self, stretch: Quantity, v: Quantity, own: Quantity) -> Quantity:
        """Force [N] of what damps between the terminals; `own` velocity behind a spring."""
        if self._springy_damper:
            return damper_spring.force(self, own) + 0.0 * v
        viscous, *shape = self.damper
        if "viscous" in self.along:
            viscous = viscous + self.along["viscous"](stretch)
        return parallel.damping_force(v, viscous, *shape)

    def _beside(self, x: Quantity, v: Quantity, z: Quantity) -> Quantity:
        """T [N] without friction."""
        stretch = x - self.rest_length
        spring = parallel.spring_force(stretch, self.stiffness, self.stiffness_cubic)
        _, deflections, own = self._split(z)
        damper = self._damper(stretch, v, own)
        if "force" in self.along:
            spring = spring + self.along["force"](stretch)
        force = spring + damper + self.force_offset + end_stops.force(self, stretch, v)
        force = force + (self.surface.force(stretch, v) if self.surface else 0.0)
        return force + branches.force(self, deflections)

    def _flywheel_share(self, x: Quantity, v: Quantity, z: Quantity, contact: Contact) -> Quantity:
        """N [N] where friction takes its part of F_s behind the series element."""
        rubbing = self.friction_force(x, v, z, contact=contact)
        left = self._series_force(x, v, z, contact) - rubbing
        friction, _, speed, _ = self._states(z)
        share = load.share(self, left, speed, friction)
        return left / (1.0 + share * np.sign(left))

    def _series_force(self, x: Quantity, v: Quantity, z: Quantity, contact: Contact) -> Quantity:
        _, deflection, speed, gap = self._states(z)
        return series.force(self, deflection, v - speed, gap, contact) + 0.0 * x

    def _flywheel_side(self, displacement: Quantity, velocity: Quantity) -> Quantity:
        """G [N]: damper, pipe and gas between the flywheel and terminal 1."""
        pipe = channel.force(self, velocity)
        return self.flywheel_viscous * velocity + pipe + gas.force(self, displacement)


def _beside(columns: Sequence[Quantity]) -> NDArray[np.float64]:
    """States or their rates (n,) or (..., n), from those of each."""
    if all(isinstance(each, float) for each in columns):
        return np.array(columns)
    return np.stack(np.broadcast_arrays(*columns), axis=-1)
