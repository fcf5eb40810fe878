"""The device: an inertance with everything that stands beside it.

    F = F_b + c v + c2 v |v| + k x + k3 x^3 + f0 + F_friction + F_load
    F_b = b(x) a + b'(x) v^2 / 2,  b(x) = b max(0.01, 1 + q x + r x^2)

The second part of F_b keeps the kinetic energy b(x) v^2 / 2; q `inertance_gradient` [1/m],
r `inertance_curvature` [1/m^2].
Sign: x = x2 - x1 (length minus rest_length), positive = longer; F is the force that lengthens the
device (tension positive) and acts on the bodies as -F along the line. By hand: b = 2 kg,
a = 3 m/s^2 gives F = +6 N.
Each term's law, range and source stand in its own file in `laws/`.
Not modelled: anything in series with the inertance (shaft twist, backlash, compressible fluid).
"""

from __future__ import annotations

from dataclasses import asdict, dataclass

import numpy as np

from .laws import FRICTION, FrictionParameters, Quantity, load, parallel, parameter


@dataclass(frozen=True, kw_only=True)
class ReferenceDevice(FrictionParameters):
    """All parameters of one device; SI units, every default harmless.

    Arguments of the methods: x [m] the length, from which `rest_length` is taken, v [m/s],
    a [m/s^2], z [m] are numbers or arrays that broadcast together; results have their common
    shape. `z` is the friction law's state; a law without one (`nstate == 0`) ignores it.

    Raises
    ------
    ValueError
        A parameter is outside its bounds; the message names it, its value and what is allowed.
    """

    inertance: float = parameter(0.0, "kg", "inertance b", at_least=0.0)
    inertance_gradient: float = parameter(0.0, "1/m", "relative rise of b per x")
    inertance_curvature: float = parameter(0.0, "1/m^2", "relative rise of b per x^2")
    viscous: float = parameter(0.0, "N s/m", "linear damping c")
    quadratic_damping: float = parameter(0.0, "N s^2/m^2", "quadratic damping c2")
    stiffness: float = parameter(0.0, "N/m", "linear stiffness k")
    stiffness_cubic: float = parameter(0.0, "N/m^3", "cubic stiffness k3")
    rest_length: float = parameter(0.0, "m", "length at which the displacement is zero")
    force_offset: float = parameter(0.0, "N", "constant force f0")
    load_friction: float = parameter(
        0.0, "-", "friction share mu of the inertance force", at_least=0.0
    )

    def __post_init__(self) -> None:
        """Check what was given, see Raises."""
        super().__post_init__()
        if self.load_friction >= 1.0:
            raise ValueError(
                f"load_friction: {self.load_friction} locks the device (no unique acceleration); "
                "keep it below 1"
            )

    @property
    def nstate(self) -> int:
        """Number of states of the friction law: 0 or 1."""
        return FRICTION[self.friction].STATES

    def force(self, x: Quantity, v: Quantity, a: Quantity, z: Quantity = 0.0) -> Quantity:
        """Total force F [N], tension positive."""
        carried = self.inertance_force(x, v, a)
        return carried + self.load_friction_force(v, carried) + self.rest_force(x, v, z)

    def inertance_at(self, x: Quantity) -> tuple[Quantity, Quantity]:
        """Inertance b(x) [kg] and its slope b'(x) [kg/m]."""
        stretch = x - self.rest_length
        factor = 1.0 + (self.inertance_gradient + self.inertance_curvature * stretch) * stretch
        slope = self.inertance_gradient + 2.0 * self.inertance_curvature * stretch
        return (
            self.inertance * np.maximum(0.01, factor),
            self.inertance * np.where(factor < 0.01, 0.0, slope),
        )

    def inertance_force(self, x: Quantity, v: Quantity, a: Quantity) -> Quantity:
        """The force through the inertance F_b [N]."""
        inertance, slope = self.inertance_at(x)
        return inertance * a + 0.5 * slope * v * v

    def rest_force(self, x: Quantity, v: Quantity, z: Quantity = 0.0) -> Quantity:
        """The part of F [N] that does not depend on the acceleration."""
        spring = parallel.spring_force(x - self.rest_length, self.stiffness, self.stiffness_cubic)
        damper = parallel.damping_force(v, self.viscous, self.quadratic_damping)
        return spring + damper + self.force_offset + self.friction_force(x, v, z)

    def friction_force(self, x: Quantity, v: Quantity, z: Quantity = 0.0) -> Quantity:
        """Force of the friction law alone [N], without load friction and without `viscous`."""
        return FRICTION[self.friction].force(self, x - self.rest_length, v, z)

    def load_friction_force(self, v: Quantity, carried: Quantity) -> Quantity:
        """Load-dependent friction mu |F_b| tanh(v / v_t) [N], F_b the force carried."""
        return load.force(
            carried,
            v,
            load_friction=self.load_friction,
            transition_velocity=self.transition_velocity,
        )

    def load_share(self, v: Quantity) -> Quantity:
        """The factor mu tanh(v / v_t) [-] on |b a|."""
        return load.share(
            v, load_friction=self.load_friction, transition_velocity=self.transition_velocity
        )

    def acceleration(
        self, x: Quantity, v: Quantity, force: Quantity, z: Quantity = 0.0
    ) -> Quantity:
        """The acceleration [m/s^2] at which the device carries `force` [N]: `force` inverted.

        Raises
        ------
        ValueError
            The inertance is zero: the force then says nothing about the acceleration.
        """
        if self.inertance == 0.0:
            raise ValueError("inertance: 0 kg gives no acceleration for a force; give more than 0")
        remainder = force - self.rest_force(x, v, z)
        carried = remainder / (1.0 + self.load_share(v) * np.sign(remainder))
        inertance, slope = self.inertance_at(x)
        return (carried - 0.5 * slope * v * v) / inertance

    def state_rate(self, x: Quantity, v: Quantity, z: Quantity = 0.0) -> Quantity:
        """Rate z' of the friction law's state [m/s]; zero for a law without one."""
        return FRICTION[self.friction].rate(self, x - self.rest_length, v, z)

    def stored_energy(self, x: Quantity, v: Quantity, z: Quantity = 0.0) -> Quantity:
        """Kinetic, spring and bristle energy [J]."""
        kinetic = 0.5 * self.inertance_at(x)[0] * v * v
        stretch = x - self.rest_length
        spring = parallel.spring_energy(stretch, self.stiffness, self.stiffness_cubic)
        return kinetic + spring + FRICTION[self.friction].stored_energy(self, stretch, v, z)

    def dissipated_power(
        self, x: Quantity, v: Quantity, a: Quantity, z: Quantity = 0.0
    ) -> Quantity:
        """Power turned into heat [W]: F v - f0 v - d(stored)/dt.

        The work of `force_offset` is external and counts as neither stored nor dissipated.
        """
        damper = parallel.damping_force(v, self.viscous, self.quadratic_damping) * v
        friction = FRICTION[self.friction].dissipated_power(self, x - self.rest_length, v, z)
        return damper + friction + self.load_friction_force(v, self.inertance_force(x, v, a)) * v

    def parameters(self) -> dict[str, float | str]:
        """Every parameter by name, defaults included."""
        return asdict(self)
