"""Which elements of a user's model are the wheel, the body, the spring, the damper and the tyre.

Found by topology: a device's two ends are fixed to two bodies; the one that the road drives is the
wheel, the other one the sprung body. Springs and dampers between the same two bodies are the
suspension's. What cannot be known is left out, and `Parts.unknown` says why.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import mujoco
import numpy as np

from inerter.device_in_model import DeviceInModel, devices_of

# a body lighter than this share of the other one is a node, not a wheel or a sprung body
_NODE = 1e-4
# how far it is looked on whether two lengths go together, with speeds of about 1 m/s [s]
_FURTHER = 0.02
_WRAP_SITE = int(mujoco.mjtWrap.mjWRAP_SITE)
_WRAP_JOINT = int(mujoco.mjtWrap.mjWRAP_JOINT)


@dataclass(frozen=True)
class VehicleLink:
    """An element between two bodies that follows a length.

    kind: "tendon", "joint" or "device"; index: of the tendon, joint or actuator; name: to print;
    direction: +1 where it grows as the two bodies part, -1 where it shrinks.
    """

    kind: str
    index: int
    name: str
    direction: float = 1.0

    @property
    def element(self) -> str:
        """Its name in coordinates: that of the device, or the kind and the name."""
        return self.name if self.kind == "device" else f"{self.kind}:{self.name}"


@dataclass(frozen=True)
class Tyre:
    """A position actuator that stands for a tyre: force = stiffness (road - wheel).

    pull: +1 where a negative force pulls the wheel down to the road, -1 where a positive one does.
    """

    name: str
    actuator: int
    stiffness: float
    pull: float

    @property
    def element(self) -> str:
        """Its name in coordinates."""
        return f"tyre:{self.name}"


@dataclass(frozen=True, kw_only=True)
class Suspension:
    """What lies between one wheel and the body. spring, damper: None where there is none.

    direction: +1 where the device grows as the two part, -1 where it shrinks; alike: the damper's
    length changes by as much as the device's, so that the device may damp in its place.
    """

    device: str
    wheel: int
    body: int
    spring: VehicleLink | None
    damper: VehicleLink | None
    tyre: Tyre | None
    direction: float = 1.0
    alike: bool = False


@dataclass(frozen=True)
class Parts:
    """Suspensions and tyres of a model; unknown: what is not there, in words.

    road_springs: tendons between a wheel and a mocap body under it.
    """

    suspensions: tuple[Suspension, ...] = ()
    tyres: tuple[Tyre, ...] = ()
    road_springs: tuple[VehicleLink, ...] = ()
    unknown: list[str] = field(default_factory=list)


def find_parts(model: mujoco.MjModel, roads: list[int], tables: Sequence[int] = ()) -> Parts:
    """The vehicle in a compiled model.

    Parameters
    ----------
    model : MjModel
        The user's model.
    roads : list of int
        Actuators that the record drives.
    tables : sequence of int
        Mocap bodies that the record drives.
    """
    tyres = [tyre for road in roads if (tyre := _tyre(model, road)) is not None]
    # a road tells the wheel; another input, such as a measured force, only where there is no road
    on_roads = [tyre.actuator for tyre in tyres] or roads
    driven = {_driven_body(model, road): road for road in on_roads}
    springs = []
    for table in tables:
        wheels, links = _on_table(model, table)
        driven |= dict.fromkeys(wheels, -1)
        springs += links
    unknown: list[str] = []
    found = []
    for device in devices_of(model):
        suspension = _suspension(model, device, driven, tyres, unknown)
        if suspension is not None:
            found.append(suspension)
    if springs:
        unknown.append(
            "damping and lift-off of the tyre, as MuJoCo gives a mocap body no velocity and a "
            "tendon's spring may pull (a position actuator from road to wheel has both)"
        )
    elif not tyres and not found:
        # no vehicle at all, such as a robot
        unknown = ["effects of a vehicle, as no wheel, body and tyre were recognised"]
    elif not tyres:
        unknown.append(
            "effects of the tyre, as none was recognised (a position actuator from road to wheel)"
        )
    return Parts(tuple(found), tuple(tyres), tuple(springs), unknown)


def _on_table(model: mujoco.MjModel, table: int) -> tuple[list[int], list[VehicleLink]]:
    """Bodies that a mocap body drives by a tendon or a constraint, and the springs to them."""
    wheels, springs = [], []
    for i in range(model.ntendon):
        ends = _tendon_ends(model, i)
        if ends is not None and table in ends and len(set(ends)) == 2:
            wheels.append(ends[0] if ends[1] == table else ends[1])
            if model.tendon_stiffness[i] > 0:
                springs.append(VehicleLink("tendon", i, model.tendon(i).name or f"tendon {i}"))
    for i in range(model.neq):
        if model.eq_objtype[i] == mujoco.mjtObj.mjOBJ_BODY:
            pair = int(model.eq_obj1id[i]), int(model.eq_obj2id[i])
            wheels += [body for body in pair if table in pair and body != table]
    return wheels, springs


def _suspension(
    model: mujoco.MjModel,
    device: DeviceInModel,
    driven: dict[int, int],
    tyres: list[Tyre],
    unknown: list[str],
) -> Suspension | None:
    pair = _ends(model, device.actuator)
    nodes = set(pair or ())
    if pair is not None:
        pair = _past_nodes(model, pair)
    if pair is None or 0 in pair or len(set(pair)) != 2:
        unknown.append(
            f"effects of the vehicle around device {device.name!r}, whose ends are not at a wheel "
            "and a sprung body"
        )
        return None
    wheels = [body for body in pair if body in driven]
    if len(wheels) != 1:
        unknown.append(
            f"effects of the vehicle around device {device.name!r}, as the road's actuators do not "
            "tell which of its ends is the wheel"
        )
        return None
    wheel = wheels[0]
    body = pair[0] if pair[1] == wheel else pair[1]
    spring = _between(model, wheel, body, nodes, device, "stiffness")
    damper = _between(model, wheel, body, nodes, device, "damping")
    tyre = next((t for t in tyres if t.actuator == driven[wheel]), None)
    own = VehicleLink("device", device.actuator, device.name)
    return Suspension(
        device=device.name,
        wheel=wheel,
        body=body,
        spring=spring,
        damper=damper,
        tyre=tyre,
        direction=_direction(model, own, wheel, body),
        alike=damper is not None and _alike(model, own, damper),
    )


def _between(
    model: mujoco.MjModel,
    wheel: int,
    body: int,
    nodes: set[int],
    device: DeviceInModel,
    quantity: str,
) -> VehicleLink | None:
    """The one spring or damper between wheel and body, the device's own included.

    nodes: bodies without mass between them, at which an element may end too.
    """
    inside = {wheel, body} | nodes
    found = []
    for kind, count in (("tendon", model.ntendon), ("joint", model.njnt)):
        for i in range(count):
            if kind == "tendon":
                value = getattr(model, f"tendon_{quantity}")[i]
                ends = _tendon_ends(model, i)
                name = model.tendon(i).name
            else:
                value = (
                    model.jnt_stiffness[i]
                    if quantity == "stiffness"
                    else model.dof_damping[model.jnt_dofadr[i]]
                )
                ends = (int(model.jnt_bodyid[i]), int(model.body_parentid[model.jnt_bodyid[i]]))
                name = model.joint(i).name
                if model.jnt_type[i] not in (2, 3):
                    continue
            if value > 0 and ends is not None and set(ends) <= inside:
                link = VehicleLink(kind, i, name or f"{kind} {i}")
                found.append(VehicleLink(kind, i, link.name, _direction(model, link, wheel, body)))
    stated = device.stated(model)
    own = float(stated.get("stiffness" if quantity == "stiffness" else "viscous", 0.0))
    if own > 0 and set(_ends(model, device.actuator) or (0,)) <= inside:
        link = VehicleLink("device", device.actuator, device.name)
        found.append(
            VehicleLink(
                "device", device.actuator, device.name, _direction(model, link, wheel, body)
            )
        )
    return found[0] if len(found) == 1 else None


def _rate(model: mujoco.MjModel, data: mujoco.MjData, link: VehicleLink) -> float:
    """How fast a length changes."""
    if link.kind == "tendon":
        return float(data.ten_velocity[link.index])
    if link.kind == "joint":
        return float(data.qvel[model.jnt_dofadr[link.index]])
    return float(data.actuator_velocity[link.index])


def _moving(model: mujoco.MjModel) -> Iterator[mujoco.MjData]:
    """A model that moves, as it may, where it is at the beginning."""
    data = mujoco.MjData(model)
    random = np.random.default_rng(0)
    for _ in range(8):
        data.qvel[:] = random.standard_normal(model.nv)
        mujoco.mj_forward(model, data)
        yield data


def _alike(model: mujoco.MjModel, one: VehicleLink, other: VehicleLink) -> bool:
    """Whether two lengths change by as much, or against one another, also a little further on."""
    for data in _moving(model):
        mujoco.mj_integratePos(model, data.qpos, data.qvel, _FURTHER)
        mujoco.mj_forward(model, data)
        rates = abs(_rate(model, data, one)), abs(_rate(model, data, other))
        if abs(rates[0] - rates[1]) > 1e-6 * rates[0]:
            return False
    return True


def _direction(model: mujoco.MjModel, link: VehicleLink, wheel: int, body: int) -> float:
    """Whether a length grows (+1) or shrinks (-1) as the two bodies move apart."""
    product = 0.0
    for data in _moving(model):
        apart = data.xipos[body] - data.xipos[wheel]
        velocity = np.zeros((2, 6))
        for row, each in enumerate((wheel, body)):
            mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_BODY, each, velocity[row], 0)
        rate = _rate(model, data, link)
        product += float(rate * (velocity[1, 3:] - velocity[0, 3:]) @ apart)
    return 1.0 if product >= 0 else -1.0


def _tyre(model: mujoco.MjModel, actuator: int) -> Tyre | None:
    gain, bias = model.actuator_gainprm[actuator], model.actuator_biasprm[actuator]
    affine = model.actuator_biastype[actuator] == mujoco.mjtBias.mjBIAS_AFFINE
    up = _upward(model, actuator)
    if not (affine and gain[0] > 0 and np.isclose(gain[0], -bias[1])) or up is None:
        return None
    name = model.actuator(actuator).name or f"actuator {actuator}"
    return Tyre(name, actuator, float(gain[0]), 1.0 if up > 0 else -1.0)


def _upward(model: mujoco.MjModel, actuator: int) -> float | None:
    """How an actuator's length grows with the height of what it moves; None: it lifts nothing.

    A slide that is nearly upright, or a site against one of the ground (`refsite`) along z alone.
    """
    kind, target = model.actuator_trntype[actuator], int(model.actuator_trnid[actuator, 0])
    gear = model.actuator_gear[actuator]
    if kind == mujoco.mjtTrn.mjTRN_SITE:
        ground = int(model.actuator_trnid[actuator, 1])
        if ground < 0 or model.site_bodyid[ground] != 0 or np.any(np.delete(gear, 2)):
            return None
        data = mujoco.MjData(model)
        mujoco.mj_kinematics(model, data)
        height = float(data.site_xmat[ground].reshape(3, 3)[2, 2])
        return float(gear[2]) * height if abs(height) > 0.7 else None
    if kind != mujoco.mjtTrn.mjTRN_JOINT or model.jnt_type[target] != mujoco.mjtJoint.mjJNT_SLIDE:
        return None
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    height = float(data.xaxis[target][2])
    return height * float(gear[0]) if abs(height) > 0.7 else None


def _driven_body(model: mujoco.MjModel, actuator: int) -> int:
    """The body that an actuator moves; -1 where that is not one body."""
    kind, target = model.actuator_trntype[actuator], int(model.actuator_trnid[actuator, 0])
    if kind == mujoco.mjtTrn.mjTRN_JOINT:
        return int(model.jnt_bodyid[target])
    if kind == mujoco.mjtTrn.mjTRN_SITE:
        return int(model.site_bodyid[target])
    if kind == mujoco.mjtTrn.mjTRN_TENDON:
        ends = _tendon_ends(model, target)
        if ends is not None and 0 in ends:
            return max(ends)
    return -1


def _ends(model: mujoco.MjModel, actuator: int) -> tuple[int, int] | None:
    """The two bodies that an actuator acts between."""
    kind, target = model.actuator_trntype[actuator], int(model.actuator_trnid[actuator, 0])
    if kind == mujoco.mjtTrn.mjTRN_TENDON:
        return _tendon_ends(model, target)
    if kind == mujoco.mjtTrn.mjTRN_JOINT:
        body = int(model.jnt_bodyid[target])
        return body, int(model.body_parentid[body])
    return None


def _tendon_ends(model: mujoco.MjModel, tendon: int) -> tuple[int, int] | None:
    first = int(model.tendon_adr[tendon])
    last = first + int(model.tendon_num[tendon]) - 1
    kinds, objects = model.wrap_type, model.wrap_objid
    if kinds[first] == _WRAP_SITE and kinds[last] == _WRAP_SITE:
        return int(model.site_bodyid[objects[first]]), int(model.site_bodyid[objects[last]])
    if kinds[first] != _WRAP_JOINT:
        return None
    joints = [int(objects[i]) for i in range(first, last + 1)]
    bodies = sorted({int(model.jnt_bodyid[j]) for j in joints})
    parents = {int(model.body_parentid[b]) for b in bodies}
    if len(bodies) == 1 and len(joints) == 1:
        return bodies[0], parents.pop()
    # joints of two bodies on one parent, as heave and pitch of a body and its wheel: between them
    if len(bodies) == 2 and len(parents) == 1:
        return bodies[0], bodies[1]
    return None


def _past_nodes(model: mujoco.MjModel, pair: tuple[int, int]) -> tuple[int, int] | None:
    """The pair with a body without mass replaced by the one that the next element leads to."""
    masses = model.body_mass
    heavy = max(float(masses[body]) for body in pair)
    ends = []
    for body, other in (pair, pair[::-1]):
        if body == 0 or masses[body] > _NODE * heavy:
            ends.append(body)
            continue
        beyond = set()
        for tendon in range(model.ntendon):
            found = _tendon_ends(model, tendon)
            if found is not None and body in found:
                beyond |= set(found) - {body, other}
        if len(beyond) != 1:
            return None
        ends.append(beyond.pop())
    return ends[0], ends[1]
