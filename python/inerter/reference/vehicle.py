"""What half-car and full car share: a rigid body on corners, each a strut, a wheel and a tyre.

    body:  m z'' = F - sum u_i,   I_p theta'' = M_p + sum x_i u_i,   I_r phi'' = M_r - sum y_i u_i
    wheel: m_i w_i'' = u_i - k_i (w_i - road_i)
    body point above wheel i:  z - x_i theta + y_i phi

Symbols: z heave, theta pitch, phi roll of the body about its centre of mass, w_i wheel
displacement, u_i strut force (tension positive, see `strut.py`), x_i, y_i position of the corner.
Sign: x forward, y to the left, z up, rotations right-handed: positive pitch is nose down,
positive roll lifts the left side.
Range: small angles about equilibrium, linear geometry.
A tyre with a `static_load` leaves the road where it would have to pull by more.
Not modelled: gravity, tyre damping, lift-off without `static_load`, anti-roll bars, steering and
drive forces.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from inerter.model_parameters import AxleParameters

from .device import ReferenceDevice
from .structure import RunOptions, Structure, StructureRun
from .strut import Strut

Array = NDArray[np.float64]
Road = Callable[[float], float]


@dataclass(frozen=True, kw_only=True)
class Corner:
    """One wheel: `distance` [m] of its axle from the centre of mass, always positive.

    `wheel_mass` [kg], `tyre_stiffness` [N/m] and `static_load` [N] have to be above 0, else
    ValueError.
    """

    distance: float
    wheel_mass: float
    tyre_stiffness: float
    strut: Strut
    static_load: float = np.inf

    def __post_init__(self) -> None:
        """Check what was given."""
        require_positive(self, "distance", "wheel_mass", "tyre_stiffness", "static_load")


def corner_of(
    axle: AxleParameters, layout: str = "S2", device: ReferenceDevice | None = None
) -> Corner:
    """The corner of a published axle; without `device`, an ideal inerter of its inertance."""
    ideal = ReferenceDevice(inertance=axle.inertance)
    return Corner(
        distance=axle.distance,
        wheel_mass=axle.wheel_mass,
        tyre_stiffness=axle.tyre_stiffness,
        strut=Strut(
            layout=layout,
            stiffness=axle.stiffness,
            damping=axle.damping,
            device=ideal if device is None else device,
        ),
    )


@dataclass(frozen=True, kw_only=True)
class VehicleResult:
    """A run: body arrays of shape (times,), wheel arrays of shape (times, wheels), SI units.

    `device_states` has one array (times, nstate) per wheel.
    """

    time: Array
    heave: Array
    pitch: Array
    heave_velocity: Array
    pitch_velocity: Array
    heave_acceleration: Array
    pitch_acceleration: Array
    wheel_displacement: Array
    wheel_velocity: Array
    wheel_acceleration: Array
    suspension_travel: Array
    strut_force: Array
    tyre_force: Array
    device_displacement: Array
    device_velocity: Array
    device_force: Array
    device_states: tuple[Array, ...]


def assemble(body: Sequence[float], rows: ArrayLike, corners: Sequence[Corner]) -> Structure:
    """The vehicle as a structure with coordinates (body coordinates, wheels).

    `body` are the inertias of the body's coordinates, `rows` of shape (wheels, len(body)) says
    how each lifts the body point above each wheel.
    """
    parts, wheels = len(body), len(corners)
    tyres = [corner.tyre_stiffness for corner in corners]
    pull = np.array([np.inf] * parts + [corner.static_load for corner in corners])
    return Structure(
        mass=np.diag([*body, *(corner.wheel_mass for corner in corners)]),
        damping=np.zeros((parts + wheels, parts + wheels)),
        stiffness=np.diag([0.0] * parts + tyres),
        directions=np.vstack((np.asarray(rows, dtype=np.float64).T, -np.eye(wheels))),
        struts=tuple(corner.strut for corner in corners),
        pull=None if np.isinf(pull).all() else pull,
    )


def drive(
    structure: Structure,
    corners: Sequence[Corner],
    roads: Sequence[Road],
    times: ArrayLike,
    loads: Callable[[float], ArrayLike] | None,
    **options: Unpack[RunOptions],
) -> tuple[StructureRun, dict[str, object]]:
    """Run over the roads; the second result are the fields that all vehicles share.

    `loads`: time -> force and moments on the body's coordinates; `options` go to
    `Structure.simulate`. Raises ValueError if there is not one road for each wheel.
    """
    if len(roads) != len(corners):
        raise ValueError(f"roads: {len(roads)} given, but the vehicle has {len(corners)} wheels")
    parts = len(structure.mass) - len(corners)
    tyres = np.array([corner.tyre_stiffness for corner in corners])

    def surface(t: float) -> Array:
        return np.array([float(road(t)) for road in roads])

    def forces(t: float) -> Array:
        on_body = np.zeros(parts) if loads is None else np.asarray(loads(t), dtype=np.float64)
        return np.concatenate((on_body, tyres * surface(t)))

    run = structure.simulate(forces, times, **options)
    wheels = run.position[:, parts:]
    shared: dict[str, object] = {
        "time": run.time,
        "heave": run.position[:, 0],
        "pitch": run.position[:, 1],
        "heave_velocity": run.velocity[:, 0],
        "pitch_velocity": run.velocity[:, 1],
        "heave_acceleration": run.acceleration[:, 0],
        "pitch_acceleration": run.acceleration[:, 1],
        "wheel_displacement": wheels,
        "wheel_velocity": run.velocity[:, parts:],
        "wheel_acceleration": run.acceleration[:, parts:],
        "suspension_travel": run.position @ structure.directions,
        "strut_force": run.strut_force,
        "tyre_force": np.minimum(
            tyres * (wheels - np.array([surface(float(t)) for t in run.time])),
            [corner.static_load for corner in corners],
        ),
        "device_displacement": run.device_displacement,
        "device_velocity": run.device_velocity,
        "device_force": run.device_force,
        "device_states": run.device_states,
    }
    return run, shared


def require_positive(owner: object, *names: str) -> None:
    """Raise ValueError for the first of the named attributes that is not above 0."""
    for name in names:
        if not getattr(owner, name) > 0.0:
            raise ValueError(f"{name}: {getattr(owner, name)} must be above 0")
