"""Models of any size for `growth`: cars beside one another, bodies, floors of a building.

A car is a wheel on its tyre and a body on its strut, along the vertical; the device is LuGre. In a
branch the body stands in the wheel, between branches beside it.
"""

from __future__ import annotations

from collections.abc import Callable

import mujoco
import mujoco.batch
from inerter.benchmark.cars import car_xml, jolt
from inerter.benchmark.laws import parameters_of
from inerter.benchmark.timing import Work
from inerter.plugin import load_plugin

# the same motion at every size: what it costs hangs on what it meets
STEPS = 60
_GEOM = '<inertial pos="0 0 0" mass="{}" diaginertia="1 1 1"/>'
_STOP = 'limited="true" range="-0.002 0.002"'


def _mjcf(world: str, tendons: str, actuators: str) -> str:
    return f"""<mujoco><extension><plugin plugin="inerter.device"/></extension>
      <option timestep="1e-3" gravity="0 0 0" integrator="implicitfast" jacobian="sparse"/>
      <worldbody>{world}</worldbody><tendon>{tendons}</tendon><actuator>{actuators}</actuator>
      </mujoco>"""


def _slide(name: str, mass: float, attributes: str = "", inside: str = "") -> str:
    joint = f'<joint name="{name}" type="slide" axis="0 0 1" {attributes}/>'
    return f"<body>{joint}{_GEOM.format(mass)}{inside}</body>"


def _device(i: int) -> str:
    keys = "".join(f'<config key="{k}" value="{v}"/>' for k, v in parameters_of("lugre").items())
    return f'<plugin plugin="inerter.device" tendon="strut{i}" actdim="1">{keys}</plugin>'


def _strut(i: int, joints: dict[str, float], stiffness: float = 60e3) -> str:
    ends = "".join(f'<joint joint="{name}" coef="{coef}"/>' for name, coef in joints.items())
    return f'<fixed name="strut{i}" stiffness="{stiffness}" damping="500">{ends}</fixed>'


def cars(count: int, made: str) -> str:
    """MJCF of cars; `made` names what is in them: nested, branches, device, stops."""
    world = tendons = devices = ""
    stop = _STOP if "stops" in made else ""
    for i in range(count):
        body, tyre = f"body{i}", 'stiffness="120e3"'
        if "branches" in made:
            world += _slide(f"wheel{i}", 25.0, f"{tyre} {stop}") + _slide(body, 181.75)
            tendons += _strut(i, {body: 1.0, f"wheel{i}": -1.0})
        else:
            world += _slide(f"wheel{i}", 25.0, tyre, _slide(body, 181.75))
            tendons += _strut(i, {body: 1.0})
        devices += _device(i) if "device" in made else ""
    return _mjcf(world, tendons, devices)


def _steps(xml: str) -> Work:
    """Steps from a jolt on."""
    load_plugin()
    model = mujoco.MjModel.from_xml_string(xml)
    data = mujoco.MjData(model)

    def start() -> None:
        mujoco.mj_resetData(model, data)
        data.qvel[::2] = 0.3

    return Work(lambda: mujoco.mj_step(model, data, STEPS), STEPS, start)


def _cars(made: str) -> Callable[[int], Work]:
    return lambda count: _steps(cars(count, made))


bare = _cars("nested")
nested = _cars("nested, device")
branches = _cars("branches, device")
bare_stops = _cars("branches, stops")
stops = _cars("branches, stops, device")


def bodies(count: int) -> Work:
    """Steps of one device between branches, beside bodies that have none."""
    others = "".join(_slide(f"other{i}", 10.0, 'stiffness="1e4"') for i in range(count - 2))
    world = _slide("wheel", 25.0, 'stiffness="120e3"') + _slide("body", 181.75) + others
    return _steps(_mjcf(world, _strut(0, {"body": 1.0, "wheel": -1.0}), _device(0)))


def floors(count: int) -> Work:
    """Steps of a building, its floors beside one another in the tree: all feel each other."""
    world = "".join(_slide(f"floor{i}", 1000.0) for i in range(count))
    below = [{f"floor{i}": 1.0} | ({f"floor{i - 1}": -1.0} if i else {}) for i in range(count)]
    tendons = "".join(_strut(i, joints, 1e6) for i, joints in enumerate(below))
    return _steps(_mjcf(world, tendons, "".join(map(_device, range(count)))))


def _compiled(made: str) -> Callable[[int], Work]:
    def make(count: int) -> Work:
        load_plugin()
        xml = cars(count, made)
        return Work(lambda: mujoco.MjModel.from_xml_string(xml))

    return make


compile_bare = _compiled("nested")
compile_nested = _compiled("nested, device")


def batch(count: int) -> Work:
    """A step of every simulation of a batch."""
    load_plugin()
    xml = car_xml("quarter-car", "plugin lugre", "implicitfast")
    worlds = mujoco.batch.Batch(mujoco.MjModel.from_xml_string(xml), count, 1)
    speeds = worlds.bind("qvel")
    steps = max(1, 8192 // count)

    def start() -> None:
        worlds.reset(stage=mujoco.mjtStage.mjSTAGE_NONE)
        speeds[:] = jolt("quarter-car")

    return Work(lambda: worlds.step(nstep=steps), steps, start)
