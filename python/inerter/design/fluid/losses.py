"""Losses of the channel: the simulators' own law, and closed forms to read it by.

    laminar    F = 8 pi mu l (A1 / A2)^2 v               Hagen-Poiseuille
    turbulent  f = 0.3164 Re^(-1/4)                      Blasius, smooth, Re 4000 to 1e5
    ends       F = A1 K rho u^2 / 2,  u = v A1 / A2
    coil       f_c / f = 1 / (1 - (1 - (11.6 / De)^0.45)^2.2),  De = Re sqrt(D / D_c)

Symbols: F [N] at the piston, v [m/s] its speed, u [m/s] in the channel, D [m] its diameter, l [m]
its length, D_c [m] diameter of the coil, Re = rho u D / mu, De Dean number.
The curves that count come from the core (Churchill's friction factor, all regimes), so that the
calculator and the simulators cannot differ. The coil's factor is not in them.
Source: coil: C. M. White, Proc. R. Soc. A 123, 1929, laminar, De 11.6 to 2000; others: textbooks.
Not modelled: entrance length, unsteady friction of a fast oscillation.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from inerter.core import Device
from inerter.design.fluid.inputs import Geometry
from inerter.design.fluid.liquids import Properties

LAMINAR_REYNOLDS = 2300.0


@dataclass(frozen=True)
class Channel:
    """A channel with its liquid; `roughness` [m], `minor_loss` K [-]."""

    geometry: Geometry
    liquid: Properties
    roughness: float
    minor_loss: float

    @property
    def keys(self) -> dict[str, float | str]:
        """The device parameters that give the simulators this channel."""
        return {
            "piston_area": self.geometry.piston_area,
            "channel_area": self.geometry.channel_area,
            "channel_length": self.geometry.length,
            "fluid_density": self.liquid.density,
            "fluid_viscosity": self.liquid.viscosity,
            "channel_roughness": self.roughness,
            "minor_loss": self.minor_loss,
        }

    @property
    def inertance(self) -> float:
        """Inertance rho l A1^2 / A2 [kg]."""
        return self.mass * self.geometry.ratio**2

    @property
    def mass(self) -> float:
        """Mass of the liquid in the channel [kg]."""
        return self.liquid.density * self.geometry.length * self.geometry.channel_area

    def reynolds(self, speed: float) -> float:
        """Reynolds number in the channel at a speed [m/s] of the piston."""
        flow = self.geometry.ratio * speed
        return self.liquid.density * flow * self.geometry.diameter / self.liquid.viscosity

    @property
    def transition_speed(self) -> float:
        """Speed [m/s] of the piston at which Re is 2300."""
        return LAMINAR_REYNOLDS / self.reynolds(1.0)

    @property
    def laminar_damping(self) -> float:
        """Damping [N s/m] of the walls in laminar flow."""
        geometry = self.geometry
        return 8.0 * math.pi * self.liquid.viscosity * geometry.length * geometry.ratio**2

    def blasius(self, speed: NDArray[np.float64]) -> NDArray[np.float64]:
        """Force (n,) [N] of smooth walls in turbulent flow at speeds (n,) [m/s]."""
        geometry = self.geometry
        reynolds = self.reynolds(1.0) * speed
        factor = 0.3164 * reynolds**-0.25
        dynamic = 0.5 * self.liquid.density * (geometry.ratio * speed) ** 2
        return geometry.piston_area * factor * geometry.length / geometry.diameter * dynamic

    def ends(self, speed: float) -> float:
        """Force [N] of bends and ends at a speed [m/s]."""
        dynamic = 0.5 * self.liquid.density * (self.geometry.ratio * speed) ** 2
        return self.geometry.piston_area * self.minor_loss * dynamic

    def force(self, speed: ArrayLike, acceleration: ArrayLike = 0.0) -> NDArray[np.float64]:
        """Force on the liquid (n,) [N] at speeds [m/s] and accelerations [m/s^2]."""
        return Device(**self.keys).evaluate(0.0, speed, acceleration, 0.0)["total"]

    def coil_factor(self, speed: float) -> float:
        """Factor of a coil's laminar friction [-] at a speed [m/s]; 1 for a straight channel.

        NaN beyond De 2000, where the formula ends.
        """
        if self.geometry.coil_diameter == 0.0:
            return 1.0
        dean = self.dean(speed)
        if dean <= 11.6:
            return 1.0
        if dean > 2000.0:
            return math.nan
        return 1.0 / (1.0 - (1.0 - (11.6 / dean) ** 0.45) ** 2.2)

    def dean(self, speed: float) -> float:
        """Dean number at a speed [m/s]; 0 for a straight channel."""
        coil = self.geometry.coil_diameter
        return self.reynolds(speed) * math.sqrt(self.geometry.diameter / coil) if coil else 0.0
