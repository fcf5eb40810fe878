"""The MJCF that a user would have of a drawn vehicle: as it is stated, nothing hidden in it."""

from __future__ import annotations

import math

from inerter.reference import DrawnVehicle

_HEIGHT, _WHEEL = 0.6, 0.3
_STEP = 0.002
_GEOM = 'contype="0" conaffinity="0"'


def vehicle_mjcf(vehicle: DrawnVehicle, active: bool = False) -> str:
    """The text: a body on wheels that slide, or on one that a trailing arm guides.

    active: with a motor "actuator_force" that lengthens the first strut [N].
    """
    arm = vehicle.kind == "arm"
    world = _on_an_arm(vehicle) if arm else _on_wheels(vehicle)
    plugins, tendons, actuators, sensors = [], [], [], []
    for corner, name in zip(vehicle.corners, vehicle.names, strict=True):
        strut, wheel = f"strut{name}", "hub" if arm else f"wheel{name}"
        length = _HEIGHT - _WHEEL
        if arm:
            reach, height = vehicle.strut_reach, vehicle.strut_height
            turned = 2.0 * reach * height * math.sin(vehicle.arm_angle)
            length = math.sqrt(reach**2 + height**2 - turned)
        values = {
            "inertance": corner.inertance, "viscous": corner.damping,
            "stiffness": corner.stiffness, "rest_length": length,
        }  # fmt: skip
        config = "".join(f'<config key="{k}" value="{v!r}"/>' for k, v in values.items())
        plugins.append(f'<instance name="{strut}">{config}</instance>')
        tendons.append(
            f'<spatial name="{strut}"><site site="lower{name}"/>'
            f'<site site="upper{name}"/></spatial>'
        )
        where = 'site="hub" refsite="ground" gear="0 0 1 0 0 0"' if arm else f'joint="{wheel}"'
        actuators += [
            f'<position name="road{name}" {where} kp="{corner.tyre_stiffness!r}"/>',
            f'<plugin name="{strut}" plugin="inerter.device" instance="{strut}" tendon="{strut}"/>',
        ]
        kind = 'objtype="site" objname="hub"' if arm else f'objtype="body" objname="{wheel}"'
        sensors += [
            f'<framelinacc name="wheel_acceleration{name}" {kind}/>',
            f'<tendonpos name="suspension_travel{name}" tendon="{strut}"/>',
            f'<actuatorfrc name="tyre_force{name}" actuator="road{name}"/>',
        ]
    if active:
        actuators.append(f'<motor name="actuator_force" tendon="strut{vehicle.names[0]}"/>')
    sensors.append('<framelinacc name="body_acceleration" objtype="body" objname="sprung"/>')
    if vehicle.kind in ("half", "full"):
        sensors.append(
            '<frameangacc name="body_angular_acceleration" objtype="body" objname="sprung"/>'
        )
    return f"""<mujoco model="{vehicle.kind}">
  <option timestep="{_STEP}" integrator="RK4" gravity="0 0 0"/>
  <extension><plugin plugin="inerter.device">{"".join(plugins)}</plugin></extension>
  <worldbody>{world}</worldbody>
  <tendon>{"".join(tendons)}</tendon>
  <actuator>{"".join(actuators)}</actuator>
  <sensor>{"".join(sensors)}</sensor>
</mujoco>"""


def sensors_of(vehicle: DrawnVehicle) -> dict[str, str]:
    """Sensors of columns that their name alone does not tell."""
    if vehicle.kind in ("half", "full"):
        return {"body_angular_acceleration": "body_angular_acceleration.y"}
    return {}


def _on_wheels(vehicle: DrawnVehicle) -> str:
    pitch, roll = vehicle.pitch_inertia or 1.0, vehicle.roll_inertia or 1.0
    joints = '<joint name="heave" type="slide" axis="0 0 1"/>'
    if vehicle.kind == "full":
        joints += '<joint name="roll" type="hinge" axis="1 0 0"/>'
    if vehicle.kind in ("half", "full"):
        joints += '<joint name="pitch" type="hinge" axis="0 1 0"/>'
    sites = "".join(
        f'<site name="upper{name}" pos="{c.x!r} {c.y!r} 0"/>'
        for c, name in zip(vehicle.corners, vehicle.names, strict=True)
    )
    inertia = f"{roll!r} {pitch!r} {max(roll, pitch)!r}"
    text = (
        f'<body name="sprung" pos="0 0 {_HEIGHT}">{joints}'
        f'<inertial pos="0 0 0" mass="{vehicle.body_mass!r}" diaginertia="{inertia}"/>'
        f"{sites}</body>"
    )
    for corner, name in zip(vehicle.corners, vehicle.names, strict=True):
        text += (
            f'<body name="wheel{name}" pos="{corner.x!r} {corner.y!r} {_WHEEL}">'
            f'<joint name="wheel{name}" type="slide" axis="0 0 1"/>'
            f'<geom type="sphere" size="0.1" mass="{corner.wheel_mass!r}" {_GEOM}/>'
            f'<site name="lower{name}"/></body>'
        )
    return text


def _on_an_arm(vehicle: DrawnVehicle) -> str:
    corner, length = vehicle.corners[0], vehicle.arm_length
    inertia = " ".join([f"{vehicle.arm_inertia!r}"] * 3)
    # the arm points forward: turning about -y lifts its end; it turns from where it stands, and so
    # does the road begin
    hub = _HEIGHT + length * math.sin(vehicle.arm_angle)
    return (
        f'<site name="ground" pos="0 0 {hub!r}"/><body name="sprung" pos="0 0 {_HEIGHT}">'
        '<joint name="heave" type="slide" axis="0 0 1"/>'
        f'<geom type="box" size="0.3 0.3 0.1" mass="{vehicle.body_mass!r}" {_GEOM}/>'
        f'<site name="upper" pos="0 0 {vehicle.strut_height!r}"/>'
        f'<body name="arm" euler="0 {-math.degrees(vehicle.arm_angle)!r} 0">'
        '<joint name="arm" type="hinge" axis="0 -1 0"/>'
        f'<inertial pos="{length!r} 0 0" mass="{corner.wheel_mass!r}" diaginertia="{inertia}"/>'
        f'<site name="lower" pos="{vehicle.strut_reach!r} 0 0"/>'
        f'<site name="hub" pos="{length!r} 0 0"/></body></body>'
    )
