"""Models with inerters in every topology, and the oracle of linear ones."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import mujoco
import numpy as np
from scipy.linalg import expm
from topology_mechanisms import Array, Body, Chains, Device, FreeBodies, Link, World, motion, text


@dataclass(frozen=True)
class Topology:
    """A model with its start and its truth, rows of qpos at given times."""

    xml: str
    qpos: Array | None
    qvel: Array
    truth: Callable[[Array], Array]
    native: tuple[bool, ...]  # whether the engine's matrix holds the device

    def model(self, integrator: str = "RK4", h: float = 1e-3) -> mujoco.MjModel:
        """The compiled model."""
        option = f'timestep="{h}" integrator="{integrator}"'
        return mujoco.MjModel.from_xml_string(self.xml.replace("{option}", option))

    def data(self, model: mujoco.MjModel) -> mujoco.MjData:
        """The start."""
        data = mujoco.MjData(model)
        if self.qpos is not None:
            data.qpos[:] = self.qpos
        data.qvel[:] = self.qvel
        return data

    def path(self, integrator: str, h: float, times: Array) -> Array:
        """Rows of qpos at the times, which start at 0 and are multiples of h."""
        model = self.model(integrator, h)
        data = self.data(model)
        rows = [data.qpos.copy()]
        for count in np.diff(np.rint(times / h).astype(int)):
            mujoco.mj_step(model, data, int(count))
            rows.append(data.qpos.copy())
        return np.array(rows)


def device_texts(
    keys: Mapping[str, float | str], target: str, name: str
) -> tuple[str, str, str]:  # fmt: skip
    """A device that a sensor reads: the texts for extension, actuator and sensor."""
    states = int(keys.get("friction") in ("dahl", "lugre", "bouc_wen", "rate_state"))
    states += sum(key.startswith("slip_stiffness") for key in keys)
    if "series_stiffness" in keys or "series_damping" in keys:
        states += 3 if "backlash" in keys else 2
    config = "".join(f'<config key="{key}" value="{value}"/>' for key, value in keys.items())
    plugin = f'<plugin name="{name}" instance="{name}" plugin="inerter.device"'
    return (
        f'<instance name="{name}">{config}</instance>',
        f'{plugin} {target} actdim="{states}"/>',
        f"{plugin}/>",
    )


def mjcf(
    world: str, tendons: str, devices: Sequence[tuple[Mapping[str, float | str], str]], *,
    gravity: Sequence[float] = (0, 0, 0), actuators: str = "", rest: str = "", option: str = "",
) -> str:  # fmt: skip
    """A model whose devices d0, d1, ... have the given keys and targets; `{option}` is left."""
    texts = [device_texts(keys, target, f"d{k}") for k, (keys, target) in enumerate(devices)]
    return f"""
<mujoco>
  <extension><plugin plugin="inerter.device">{"".join(t[0] for t in texts)}</plugin></extension>
  <option gravity="{text(gravity)}" {option} {{option}}/>
  <worldbody>{world}
  </worldbody>
  <tendon>{tendons}</tendon>
  <actuator>{actuators}{"".join(t[1] for t in texts)}</actuator>
  <sensor>{"".join(t[2] for t in texts)}</sensor>
  {rest}
</mujoco>"""


def linear_motion(
    mass: Array, damping: Array, stiffness: Array, force: Array, start: Array, times: Array
) -> Array:
    """Rows (q, v) of M q'' + D q' + K q = f at the times, by the matrix exponential."""
    n = len(mass)
    a = np.zeros((2 * n + 1, 2 * n + 1))
    a[:n, n:-1] = np.eye(n)
    a[n:-1] = np.linalg.solve(mass, np.column_stack([-stiffness, -damping, force]))
    y = np.append(start, 1.0)
    return np.array([(expm(a * t) @ y)[: 2 * n] for t in times])


# --------------------------- quarter-car ----------------------------------------------------------

# masses and stiffnesses [kg, N/m, N*s/m] of Wang & Su 2008 with a middling strut
WHEEL, CAR, TYRE, STRUT, DAMPER, INERTANCE = 25.0, 181.75, 120e3, 60e3, 1500.0, 113.0

SLIDE = """
    <body name="{name}" pos="0 0 {height}">
      <joint name="{name}" type="slide" axis="0 0 1" {joint}/>
      <geom size="0.1" mass="{mass}" contype="0" conaffinity="0"/>
      <site name="{name}"/>{inner}
    </body>"""


def slide(name: str, mass: float, height: float = 0, joint: str = "", inner: str = "") -> str:
    """A body on a vertical slide, with a site at its centre."""
    return SLIDE.format(name=name, mass=mass, height=height, joint=joint, inner=inner)


def quarter_car(
    layout: str, inertance: float = INERTANCE, damper: float = DAMPER, strut: float = STRUT
) -> Topology:
    """Wheel and car as nested slides, siblings with a fixed or with a spatial tendon."""
    # one damper in the device, one parallel to it
    keys = {"inertance": inertance, "viscous": damper / 2}
    if layout == "nested":
        world = slide("wheel", WHEEL, 0, f'stiffness="{TYRE}"', slide("car", CAR, 1))
        joints = '<joint joint="car" coef="1"/>'
    else:
        world = slide("wheel", WHEEL, 0, f'stiffness="{TYRE}"') + slide("car", CAR, 1)
        joints = '<joint joint="wheel" coef="-1"/><joint joint="car" coef="1"/>'
    spring = f'name="strut" stiffness="{strut}" damping="{damper / 2}"'
    tendon = f"<fixed {spring}>{joints}</fixed>"
    if layout == "spatial":
        tendon = f'<spatial {spring}><site site="wheel"/><site site="car"/></spatial>'
    nested = layout == "nested"

    # in zu, zs; the nested joint is zs - zu
    apart = np.array([[1.0, -1.0], [-1.0, 1.0]])
    mass = np.diag([WHEEL, CAR]) + inertance * apart
    stiffness = np.diag([TYRE, 0]) + strut * apart

    def truth(times: Array) -> Array:
        z = linear_motion(
            mass, damper * apart, stiffness, np.zeros(2), np.array([0, 0, 0.3, 0]), times
        )[:, :2]
        return np.column_stack([z[:, 0], z[:, 1] - z[:, 0]]) if nested else z

    return Topology(
        mjcf(world, tendon, [(keys, 'tendon="strut"')]),
        None,
        np.array([0.3, -0.3 if nested else 0.0]),
        truth,
        (nested,),
    )


# --------------------------- mechanisms in space --------------------------------------------------


def model_of(
    mechanism: FreeBodies | Chains, native: Sequence[bool], targets: Sequence[str] | None = None,
    gravity: Sequence[float] = (0, 0, 0),
) -> Topology:  # fmt: skip
    """The model and the truth of a mechanism."""
    if isinstance(mechanism, Chains):
        world, tendons, found = mechanism.mjcf(targets)
        links = [link for _, chain in mechanism.chains for link in chain]
        velocity = np.array([link.speed for link in links])
    else:
        world, tendons, found = mechanism.mjcf()
        velocity = np.concatenate([[*body.velocity, *body.spin] for body in mechanism.bodies])
    keys = [device.keys() for device in mechanism.devices]
    return Topology(
        mjcf(world, tendons, list(zip(keys, found, strict=True)), gravity=gravity),
        mechanism.shown(mechanism.start()[0]),
        velocity,
        lambda times: motion(mechanism, times),
        tuple(native),
    )


# tumbling bodies, their centres and sites off the origins of their frames
ONE = Body((0, 0, 0), (0.8, -0.6, 0.4), (5.0, -4.0, 3.0), 1.2, (0.05, 0, -0.03),
           (0.04, 0.05, 0.06, 0.005, -0.004, 0.003))  # fmt: skip
TWO = Body((0.9, 0.2, 0.1), (1.2, 0.8, 0.5), (-3.0, 5.0, 4.0), 0.8, (0, 0.04, 0.02),
           (0.03, 0.025, 0.02, 0, 0.002, 0), (0.9, 0.1, -0.3, 0.2))  # fmt: skip
THREE = Body((0.3, 0.9, -0.2), (0.2, -1.5, 0.8), (2.0, 4.0, -5.0), 2.0, (0, 0, 0),
             (0.08, 0.06, 0.07, 0, 0, 0), (0.7, 0.3, 0.4, -0.2))  # fmt: skip
SIMPLE = Body((0, 0, 0), (0.6, 0, 0.5), (4, 6, -3), 1.2, inertia=(0.04, 0.05, 0.06, 0, 0, 0))
ON_ONE, ON_TWO, ON_THREE = (0, (0.15, 0.1, -0.05)), (1, (-0.1, 0.12, 0.06)), (2, (0.1, -0.1, 0.08))
HIGH = (World, (0.2, 0.1, 1.5))
FALL = (0.0, 0.0, -9.81)


def spatial(*points: tuple[int, Sequence[float]]) -> list:
    """A tendon of one branch."""
    return [(1.0, points)]


LEFT = ((0.0, 0.0), [Link(-0.9, 1.0), Link(0.5, -1.5, mass=0.7)])
RIGHT = ((0.9, 0.1), [Link(-2.0, 0.8, mass=1.4), Link(-0.4, 1.1, inertia=0.02)])
DEEP = ((0.0, 0.0), [
    Link(-0.8, 0.5), Link(0.3, -0.7, mass=0.8), Link(0.4, 0.9, mass=0.6), Link(-0.5, -1.2, mass=0.5)
])  # fmt: skip


def two_bodies(inertance: float) -> Topology:
    """Two tumbling bodies with a device between them."""
    device = Device(inertance, 1.5, 80.0, 0.7)
    return model_of(FreeBodies([ONE, TWO], [spatial(ON_ONE, ON_TWO)], [device]), [False])


def cases() -> dict[str, Topology]:
    """All topologies by name."""
    soft = Device(2.0, 1.5, 80.0, 0.7)
    return {
        "nested slides": quarter_car("nested"),
        "siblings, fixed tendon": quarter_car("fixed"),
        "siblings, spatial tendon": quarter_car("spatial"),
        "two free bodies": two_bodies(2.0),
        "free body to world": model_of(
            FreeBodies([ONE], [spatial(HIGH, ON_ONE)], [soft], FALL), [True], gravity=FALL
        ),
        "simple body to world": model_of(
            FreeBodies(
                [SIMPLE],
                [spatial(HIGH, ON_ONE)], [soft], FALL,
            ), [False], gravity=FALL,
        ),
        "sites on three bodies": model_of(
            FreeBodies(
                [ONE, TWO, THREE],
                [spatial(HIGH, ON_ONE, (0, (-0.1, 0.1, 0)), ON_TWO, ON_THREE)],
                [Device(3.0, 1.0, 50.0, 3.0)],
            ), [False],
        ),
        "pulley tendon": model_of(
            FreeBodies(
                [ONE, TWO, THREE],
                [[(1.0, [HIGH, ON_ONE]), (2.0, [ON_TWO, ON_THREE]),
                  (2.0, [(1, (0.1, 0, 0)), ON_ONE])]],
                [Device(3.0, 1.0, 50.0, 2.0)],
            ), [False],
        ),
        "hinge with gear": model_of(
            Chains([((0.0, 0.0), [Link(-0.9, 1.0)])], [Device(0.01, 0.02, 0.05)],
                   angles=[{(0, 0): 3.0}]),
            [True], ['joint="j0_0" gear="3"'], FALL,
        ),
        "two hinges, fixed tendon": model_of(
            Chains([LEFT, RIGHT], [Device(0.2, 0.05, 0.3)],
                   angles=[{(0, 1): 1.0, (1, 0): -2.5}]), [False], gravity=FALL,
        ),
        "triangle and world": model_of(
            FreeBodies(
                [ONE, TWO, THREE],
                [spatial(ON_ONE, ON_TWO), spatial(ON_TWO, (2, (0, 0.1, 0.1))),
                 spatial(ON_THREE, (0, (-0.1, 0, 0.1))), spatial(HIGH, (1, (0.1, 0, -0.1)))],
                [Device(2.0, 1.0, 50.0, 0.6), Device(0.3, 0, 20.0, 0.8),
                 Device(5.0, 2.0, 80.0, 0.9), Device(1.0, 0.5, 30.0, 1.2)],
            ), [False, False, False, True],
        ),
        "deep chain and cable": model_of(
            Chains([DEEP, RIGHT], [Device(0.05, 0.01, 0.2), Device(1.5, 0.5, 4.0, 0.5)],
                   angles=[{(0, 2): 2.0}], cables=[((0, 3, 0.35), (1, 1, 0.3))]),
            [True, False], ['joint="j0_2" gear="2"'], FALL,
        ),
        "cables to the world": model_of(
            Chains([DEEP, RIGHT], [Device(1.0, 0.5, 2.0, 0.5), Device(1.5, 0.5, 4.0, 0.5)],
                   cables=[((0.8, 0.9), (0, 3, 0.35)), ((0, 1, 0.3), (1, 0, 0.25))]),
            [True, False], gravity=FALL,
        ),
    }  # fmt: skip
