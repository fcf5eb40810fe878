"""Cars as MJCF with one device in each strut, made in several ways.

Quarter-, half- and full-car with their published numbers, in two topologies: `nested`, the wheels
children of the body, where MuJoCo's inertia matrix has a place for the inertance, and `branches`,
wheels and body side by side in the world, where its own armature drops the coupling between them.
Struts are spatial tendons, springs and dampers are the tendon's own; nothing is drawn or sensed, so
that as little as possible is common to what is compared.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from inerter.benchmark.laws import INERTANCE, LAWS, parameters_of
from inerter.core import Device
from inerter.model_parameters import FULL_CAR, HALF_CAR, QUARTER_CAR, AxleParameters

STRUT = 0.5
"""Length of a strut at rest [m]."""

INTEGRATORS = ("Euler", "implicit", "implicitfast", "discrete", "RK4")


@dataclass(frozen=True, kw_only=True)
class Wheel:
    """A wheel at (x, y) [m] from the body's centre, with its strut and tyre."""

    x: float
    y: float
    mass: float
    stiffness: float
    damping: float
    tyre_stiffness: float


@dataclass(frozen=True)
class Car:
    """Body mass [kg], the joints of the body with its inertia about each [kg m^2], the wheels."""

    mass: float
    joints: Mapping[str, str]
    inertia: tuple[float, float, float]
    wheels: Sequence[Wheel]


def _wheel(x: float, y: float, axle: AxleParameters) -> Wheel:
    return Wheel(
        x=x,
        y=y,
        mass=axle.wheel_mass,
        stiffness=axle.stiffness,
        damping=axle.damping,
        tyre_stiffness=axle.tyre_stiffness,
    )


_HEAVE = {"heave": 'type="slide" axis="0 0 1"'}
_PITCH = _HEAVE | {"pitch": 'type="hinge" axis="0 1 0"'}
_ROLL = _PITCH | {"roll": 'type="hinge" axis="1 0 0"'}
_AXLES = ((HALF_CAR.front.distance, "front"), (-HALF_CAR.rear.distance, "rear"))

CARS = {
    "quarter-car": Car(
        QUARTER_CAR.sprung_mass,
        _HEAVE,
        (1.0, 1.0, 1.0),
        [
            Wheel(
                x=0.0, y=0.0, mass=QUARTER_CAR.unsprung_mass, stiffness=QUARTER_CAR.stiffness,
                damping=QUARTER_CAR.struts["S2"].damping, tyre_stiffness=QUARTER_CAR.tyre_stiffness,
            )
        ],
    ),
    "half-car": Car(
        HALF_CAR.body_mass,
        _PITCH,
        (HALF_CAR.pitch_inertia, HALF_CAR.pitch_inertia, HALF_CAR.pitch_inertia),
        [_wheel(x, 0.0, getattr(HALF_CAR, axle)) for x, axle in _AXLES],
    ),
    "full-car": Car(
        FULL_CAR.body_mass,
        _ROLL,
        (FULL_CAR.roll_inertia, FULL_CAR.pitch_inertia, FULL_CAR.yaw_inertia),
        [
            _wheel(x, y, getattr(FULL_CAR, axle))
            for x, axle in _AXLES
            for y in (-0.5 * FULL_CAR.track, 0.5 * FULL_CAR.track)
        ],
    ),
}  # fmt: skip
"""By name; with 1, 2 and 4 devices."""

NATIVE = ("bare", "armature", "native friction loss", "native lugre")
"""What MuJoCo makes of a strut itself: nothing, inertance, inertance with Coulomb friction as a
constraint, inertance with LuGre friction. The inertance counts in nested cars only."""

PLUGIN = tuple(f"plugin {law}" for law in LAWS)
"""A device with each friction law."""


def car_xml(car: str, made: str, integrator: str, *, branches: bool = False) -> str:
    """MJCF of a car.

    Parameters
    ----------
    car
        One of `CARS`.
    made
        How the device is made: one of `NATIVE` or `PLUGIN`.
    integrator
        One of `INTEGRATORS`; the step is 1 ms.
    branches
        Wheels beside the body rather than in it.
    """
    model = CARS[car]
    numbered = list(enumerate(model.wheels))
    bodies = "".join(_wheel_body(i, wheel, branches) for i, wheel in numbered)
    body = f"""
      {"".join(f'<joint name="{name}" {kind}/>' for name, kind in model.joints.items())}
      <inertial pos="0 0 0" mass="{model.mass}" diaginertia="{_numbers(model.inertia)}"/>
      {"".join(f'<site name="upper{i}" pos="{w.x} {w.y} 0"/>' for i, w in numbered)}"""
    plugin = made in PLUGIN
    return f"""
<mujoco model="{car}">
  <extension>{'<plugin plugin="inerter.device"/>' if plugin else ""}</extension>
  <option timestep="1e-3" gravity="0 0 0" integrator="{integrator}"/>
  <worldbody>
    <body name="body" pos="0 0 {STRUT}">{body}{"" if branches else bodies}</body>
    {bodies if branches else ""}
  </worldbody>
  <tendon>
    {"".join(_tendons(i, wheel, model, made, branches) for i, wheel in numbered)}
  </tendon>
  <actuator>{"".join(_actuator(i, made) for i, _ in numbered)}</actuator>
</mujoco>"""


def jolt(car: str) -> list[float]:
    """Velocities at the start, nested or not [m/s]: the wheels have met a kerb."""
    model = CARS[car]
    return [0.0] * len(model.joints) + [0.3 + 0.05 * i for i in range(len(model.wheels))]


def _wheel_body(i: int, wheel: Wheel, branches: bool) -> str:
    height = 0.0 if branches else -STRUT
    tyre = f'stiffness="{wheel.tyre_stiffness}"' if branches else ""
    return f"""
      <body name="wheel{i}" pos="{wheel.x} {wheel.y} {height}">
        <joint name="wheel{i}" type="slide" axis="0 0 1" {tyre}/>
        <inertial pos="0 0 0" mass="{wheel.mass}" diaginertia="1 1 1"/>
        <site name="lower{i}"/>
      </body>"""


def _tendons(i: int, wheel: Wheel, model: Car, made: str, branches: bool) -> str:
    own = {
        "armature": f'armature="{INERTANCE}"',
        "native friction loss": f'armature="{INERTANCE}" frictionloss="80"',
    }.get(made, "")
    strut = f"""
    <spatial name="strut{i}" stiffness="{wheel.stiffness}" damping="{wheel.damping}" {own}>
      <site site="lower{i}"/><site site="upper{i}"/>
    </spatial>"""
    if branches:
        return strut

    # height of a wheel that stands in the body, for small angles
    arms = {"heave": 1.0, "pitch": -wheel.x, "roll": wheel.y, f"wheel{i}": 1.0}
    joints = [f'<joint joint="{n}" coef="{c}"/>' for n, c in arms.items() if _has(model, n)]
    return f"""{strut}
    <fixed stiffness="{wheel.tyre_stiffness}">{"".join(joints)}</fixed>"""


def _has(model: Car, joint: str) -> bool:
    return joint in model.joints or joint.startswith("wheel")


def _actuator(i: int, made: str) -> str:
    if made == "native lugre":
        keys = ("bristle_stiffness", "bristle_damping", "coulomb_force", "static_force")
        law = [LAWS["lugre"][key] for key in (*keys, "stribeck_velocity")]
        return f"""
    <dcmotor tendon="strut{i}" input="none" motorconst="0 0" resistance="1"
             armature="{INERTANCE}" lugre="{_numbers(law)}"/>"""
    if made not in PLUGIN:
        return ""
    given: dict[str, Any] = {**parameters_of(made.removeprefix("plugin ")), "rest_length": STRUT}
    keys = "".join(f'<config key="{key}" value="{value}"/>' for key, value in given.items())
    states = Device(**given).nstate
    return f"""
    <plugin name="strut{i}" plugin="inerter.device" tendon="strut{i}" actdim="{states}">
      {keys}
    </plugin>"""


def _numbers(values: Sequence[float]) -> str:
    return " ".join(str(value) for value in values)
