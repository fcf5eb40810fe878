"""A drawn vehicle with what has been hidden in it and in its channels so far."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline

from .device import ReferenceDevice
from .drawn_vehicle import Changed, DrawnVehicle

Array = NDArray[np.float64]


@dataclass(kw_only=False)
class Making:
    """A vehicle with what has been hidden in it so far."""

    stated: DrawnVehicle
    body: float = 1.0
    corners: dict[int, dict[str, float]] = field(default_factory=dict)
    devices: dict[int, dict[str, Any]] = field(default_factory=dict)
    guides: dict[int, dict[str, Any]] = field(default_factory=dict)
    others: dict[int, dict[str, Any]] = field(default_factory=dict)
    rider: tuple[float, float, float] | None = None
    late: dict[str, float] = field(default_factory=dict)
    scales: dict[str, float] = field(default_factory=dict)
    behind: dict[str, tuple[float, float]] = field(default_factory=dict)
    patch: float = 0.0
    lean: float = 0.0
    gain: float = 1.0
    lag: float = 0.0
    on_body: Callable[[Array, int], Array] | None = None
    on_wheel: Callable[[Array, int], Array] | None = None
    names: dict[str, dict[str, float]] = field(default_factory=dict)
    places: dict[str, str] = field(default_factory=dict)

    def tell(self, effect: str, place: str, values: Mapping[str, float]) -> None:
        """Keep what an effect's true parameters are."""
        self.names[effect], self.places[effect] = dict(values), place

    def built(self) -> DrawnVehicle:
        """The vehicle that is driven."""
        corners, changed = [], {}
        for i, corner in enumerate(self.stated.corners):
            own = replace(corner, **self.corners.get(i, {}))
            corners.append(own)
            device = replace(own.device, **self.devices[i]) if i in self.devices else None
            guide = ReferenceDevice(**self.guides[i]) if i in self.guides else None
            changed[i] = Changed(device=device, guide=guide, **self.others.get(i, {}))
        return replace(
            self.stated, corners=tuple(corners), changed=changed, rider=self.rider,
            wheel_lean=self.lean,
            body_mass=self.stated.body_mass * self.body,
            pitch_inertia=self.stated.pitch_inertia * self.body,
            roll_inertia=self.stated.roll_inertia * self.body,
        )  # fmt: skip

    def felt(self, name: str, times: Array, values: Array) -> Array:
        """A channel as its sensor shows it: behind a mount or a low-pass, in its scale, late."""
        if (element := self.behind.get(name)) is not None:
            values = _behind(times, values, *element)
        values = self.scales.get(name, 1.0) * values
        if (late := self.late.get(name, 0.0)) != 0.0:
            values = CubicSpline(times, values)(np.clip(times - late, times[0], times[-1]))
        return values


def _behind(times: Array, values: Array, frequency: float, loss: float) -> Array:
    """What stands behind a mass on a spring, s'' + 2 D w s' + w^2 (s - y) = 0, from rest at y."""
    omega, given = 2.0 * np.pi * frequency, CubicSpline(times, values)

    def rate(t: float, state: Array) -> Array:
        pull = omega**2 * (float(given(t)) - state[0])
        return np.array([state[1], pull - 2.0 * loss * omega * state[1]])

    run = solve_ivp(
        rate, (float(times[0]), float(times[-1])), [float(values[0]), 0.0], t_eval=times,
        rtol=1e-6, atol=1e-8 * float(np.std(values)), max_step=0.1 / frequency,
    )  # fmt: skip
    return np.asarray(run.y[0], dtype=np.float64)
