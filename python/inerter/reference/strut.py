"""A strut: a spring with a damper and a device, in one of three layouts.

    S1: u = k x + c v             S2: u = k x + c v + F_device(x, v, a, z)
    S3: u = k x + F,  F = F_device(y, y', y'', z) = c (v - y')     (device in series with damper)

Symbols: x, v, a elongation of the strut [m, m/s, m/s^2]; y the device's own displacement in S3;
k `stiffness` [N/m], c `damping` [N s/m].
Sign: u is tension positive.
Source: Wang and Su, "Inerter nonlinearities and the impact on suspension control", ACC 2008.

In S3, y'' follows from F; if the device has a series element of its own, its force does not
depend on y'', and y' itself is the solution of F_device(y, y') = c (v - y'), which is unique
because the left side rises with y' and the right side falls.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from .device import ReferenceDevice
from .laws import Quantity, load

LAYOUTS = ("S1", "S2", "S3")

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class StrutPoint:
    """What a strut does at one moment.

    Its force is `known` + N + `share` |N| with N = `mass` a + `rest` ([N], [kg], [N], [-]), the
    first of `share` where N > 0, the second where N < 0; `rates` are those of its own states; the
    others describe the device.
    """

    known: float
    mass: float
    rest: float
    share: tuple[float, float]
    rates: Array
    device_displacement: float
    device_velocity: float
    device_state: Quantity


@dataclass(frozen=True, kw_only=True)
class Strut:
    """Spring, damper and device between two points.

    Own states: for S3 the device's displacement and (without a series element) velocity, then
    the device's states; for S1 none.

    Raises
    ------
    ValueError
        Unknown layout, or S3 without damping or inertance.
    """

    layout: str = "S2"
    stiffness: float = 0.0
    damping: float = 0.0
    device: ReferenceDevice = field(default_factory=ReferenceDevice)

    def __post_init__(self) -> None:
        """Check what was given, see Raises."""
        if self.layout not in LAYOUTS:
            raise ValueError(f"layout: '{self.layout}' is not one of {', '.join(LAYOUTS)}")
        inertance = self.device.total_inertance
        if self.layout == "S3" and not (self.damping > 0.0 and inertance > 0.0):
            raise ValueError(
                f"S3: damping {self.damping} N s/m and inertance {inertance} kg stand "
                "in series and both have to be above 0"
            )

    @property
    def own_motion(self) -> int:
        """Number of states that describe the device's own motion: 0, 1 or 2."""
        if self.layout != "S3":
            return 0
        return 1 if self.device.has_series else 2

    @property
    def nstate(self) -> int:
        """Number of own states."""
        return 0 if self.layout == "S1" else self.own_motion + self.device.nstate

    @property
    def bends(self) -> bool:
        """Whether a load raises the level of a bristle between the strut's ends."""
        return self.layout == "S2" and load.bends(self.device) and not self.device.has_series

    def at(
        self, x: float, v: float, own: Array, contact: int | None = None, a: float = 0.0
    ) -> StrutPoint:
        """What the strut does at elongation x [m], v [m/s] with its own states, shape (nstate,).

        The acceleration a [m/s^2] counts where it `bends`.
        """
        spring = self.stiffness * x
        if self.layout == "S1":
            return StrutPoint(
                known=spring + self.damping * v,
                mass=0.0,
                rest=0.0,
                share=(0.0, 0.0),
                rates=np.empty(0),
                device_displacement=0.0,
                device_velocity=0.0,
                device_state=np.empty(0),
            )
        z = self.device.state_argument(own[self.own_motion :])
        if self.layout == "S2":
            mass, rest = self.device.branch(x, v, z, contact=contact)
            return StrutPoint(
                known=spring + self.damping * v + float(self.device.rest_force(x, v, z, a=a)),
                mass=float(mass),
                rest=float(rest),
                share=(
                    float(self.device.load_share(v, 1.0, z)),
                    float(self.device.load_share(v, -1.0, z)),
                ),
                rates=self._device_rates(x, v, z, a, contact),
                device_displacement=x,
                device_velocity=v,
                device_state=z,
            )

        # the device moves on its own, the damper carries its force
        y = float(own[0])
        speed = self._series_speed(v, own, contact)
        through = self.damping * (v - speed)
        motion = [speed]
        bend = 0.0
        if not self.device.has_series:
            bend = float(self.device.acceleration(y, speed, through, z))
            motion.append(bend)
        rates = np.concatenate((motion, self._device_rates(y, speed, z, bend, contact)))
        return StrutPoint(
            known=spring + through,
            mass=0.0,
            rest=0.0,
            share=(0.0, 0.0),
            rates=rates,
            device_displacement=y,
            device_velocity=speed,
            device_state=z,
        )

    def device_terminals(
        self, x: float, v: float, own: Array, contact: int | None = None
    ) -> tuple[float, Quantity]:
        """The device's velocity [m/s] and states."""
        z = self.device.state_argument(own[self.own_motion :])
        return (v if self.layout == "S2" else self._series_speed(v, own, contact)), z

    def _device_rates(
        self, x: float, v: float, z: Quantity, a: float, contact: int | None
    ) -> Array:
        if self.device.nstate == 0:
            return np.empty(0)
        return np.atleast_1d(
            np.asarray(self.device.state_rate(x, v, z, a=a, contact=contact), dtype=float)
        )

    def _series_speed(self, v: float, own: Array, contact: int | None) -> float:
        """The device's velocity y' [m/s] in S3."""
        if not self.device.has_series:
            return float(own[1])
        y, z = float(own[0]), self.device.state_argument(own[1:])

        def excess(speed: float) -> float:
            force = float(self.device.force(y, speed, 0.0, z, contact=contact))
            return force - self.damping * (v - speed)

        # the force at the strut's velocity says on which side y' lies, and how far at most
        other = v - excess(v) / self.damping
        low, high = min(v, other), max(v, other)
        low, high = low - 1e-9 * (1.0 + abs(low)), high + 1e-9 * (1.0 + abs(high))
        root = brentq(excess, low, high, xtol=1e-15, rtol=4 * np.finfo(float).eps)
        return float(root)  # pyright: ignore[reportArgumentType]
