"""A device on the simulated test rig: along a recorded motion, and as a model to load."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from xml.etree import ElementTree

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from inerter.core import Device
from inerter.models import model_path
from inerter.motion_units import ROTATION, TRANSLATION, Kind
from inerter.plugin import load_plugin

# samples whose pieces are worked out at once
_AT_ONCE = 4096
# longest step in times of the series element, and share of it from which on one will do: the motion
# within a piece is of an even acceleration
_RESOLVED, _SHORT = 0.2, 0.1
# share of a spacing by which a turn of the motion is away from a sample that it is not at
_AT_SAMPLE = 1e-6


def device_mjcf(
    device: Device,
    name: str = "device",
    timestep: float = 1e-3,
    motion: Kind = TRANSLATION,
    before: float = 0.0,
) -> str:
    """A complete model in MJCF: the device on the test rig, ready to load.

    Parameters
    ----------
    device : Device
        The device; what it was given becomes the configuration.
    name : str
        Name of the model.
    timestep : float
        Time step [s].
    motion : str
        In rotation the table turns on a hinge and the device acts on that.
    before : float
        Mass [kg] that moves with the terminal before the device's shaft: a second inerter.

    Returns
    -------
    str
        XML text; `mujoco.MjModel.from_xml_string` loads it wherever the plugin is installed.
    """
    # the shipped file with its comments, so that the result reads like one written by hand
    parser = ElementTree.XMLParser(target=ElementTree.TreeBuilder(insert_comments=True))
    root = ElementTree.parse(model_path("test_rig"), parser).getroot()
    root.set("model", name)
    _only(root, "option").set("timestep", repr(float(timestep)))

    # what the user stated, and the number of states that follows
    instance = _only(root, "extension/plugin/instance")
    instance[:] = _configuration(device)
    if device.nstate:
        _only(root, "actuator/plugin").set("actdim", str(device.nstate))
    if before:
        _beside(root, "before_the_shaft", Device(friction="none", inertance=before))
    if motion == ROTATION:
        _turning(root)
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="unicode") + "\n"


def _beside(root: ElementTree.Element, name: str, device: Device) -> None:
    """Put a second device between the same terminals."""
    whole = ElementTree.Element("instance", name=name)
    whole[:] = _configuration(device)
    _only(root, "extension/plugin").append(whole)
    for path in ("actuator", "sensor"):
        parent, there = _only(root, path), _only(root, f"{path}/plugin")
        acting = {k: v for k, v in there.attrib.items() if k != "actdim"}
        parent.append(ElementTree.Element("plugin", {**acting, "name": name, "instance": name}))


def _configuration(device: Device) -> list[ElementTree.Element]:
    """What the user stated of a device."""
    given = device.given.items()
    return [ElementTree.Element("config", key=key, value=str(value)) for key, value in given]


def _turning(root: ElementTree.Element) -> None:
    """Make the table of the rig one that turns, as heavy, about the axis of the device."""
    joint, table = _only(root, "worldbody/body/joint"), _only(root, "worldbody/body")
    joint.set("type", "hinge")
    heavy = _only(root, "actuator/motor").get("gear", "1e12")
    inertia = ElementTree.Element(
        "inertial", pos="0 0 0", mass="1", diaginertia=" ".join([heavy] * 3)
    )
    table.insert(0, inertia)
    # the line that shows the device does not turn
    tendon = _only(root, "tendon")
    root.remove(tendon)
    for comment in root.iter():
        if comment.tag is not ElementTree.Comment:
            continue
        text = (comment.text or "").replace("m/s^2", "rad/s^2").replace("[N]", "[N m]")
        comment.text = text.replace("too heavy to be held", "too heavy to be turned by it")


def _only(root: ElementTree.Element, path: str) -> ElementTree.Element:
    found = root.find(path)
    if found is None:
        raise ValueError(f"the shipped test rig has no {path}; reinstall inerter")
    return found


@contextmanager
def quiet() -> Iterator[None]:
    """Keep the engine from printing warnings and leaving a MUJOCO_LOG.TXT where it runs."""
    before = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(lambda text: None)
    try:
        yield
    finally:
        mujoco.set_mju_user_warning(before)


def simulate_along(
    device: Device,
    h: float,
    x: ArrayLike,
    v: ArrayLike,
    a: ArrayLike,
    state: ArrayLike = 0.0,
    motion: Kind = TRANSLATION,
    every: int = 1,
) -> dict[str, NDArray[np.float64]]:
    """Run a device in MuJoCo along a sampled motion, on the test rig.

    At each sample the rig is put at x and v and accelerated by a; the sensor gives the force of
    that instant (which the stages of RK4 are made of). Then the table moves on to the next sample,
    which advances the states: at constant velocity by the laws' own steps (Euler; two where the
    motion turns on the way), or with a series element along the quintic through both samples, by
    stages of RK4 short enough for it. This is what `Device.along` does, so that both agree to
    rounding (1e-9 of the force for inertances far below the table's 1e12 kg), with a series element
    to the error of its second-order steps, with load friction on a bristle to that of first-order
    ones. Viscoelastic branches and dampers behind a spring take these steps at constant velocity
    too, where `Device.along` follows the quintic.

    Parameters
    ----------
    device : Device
        The device.
    h : float
        Sample spacing [s].
    x, v, a : array_like (n,)
        Relative displacement [m], velocity, acceleration.
    state : float or sequence (nstate,)
        States at the first sample; one number is the first of them, the others are 0.
    motion : str
        In rotation the rig turns: x is an angle [rad], forces are torques [N m].
    every : int
        Forces and states are given at every so many samples, which divide n - 1; reading them costs
        more than a step.

    Returns
    -------
    dict of ndarray
        total [N], friction [N], shape (m,), m = 1 + (n - 1) / every; states (m, nstate); state
        (m,), the first of them (0 without states).

    Raises
    ------
    ValueError
        h is not positive, x, v, a are not of one length, or `every` does not divide n - 1.
    """
    x, v, a = (np.asarray(channel, dtype=float) for channel in (x, v, a))
    if x.ndim != 1 or x.shape != v.shape or x.shape != a.shape:
        shapes = f"{x.shape}, {v.shape}, {a.shape}"
        raise ValueError(f"x, v, a must be arrays of one length; their shapes are {shapes}")
    if not h > 0:
        raise ValueError(f"h is {h}: give a sample spacing > 0 s")
    if every < 1 or (x.size - 1) % every:
        raise ValueError(f"every is {every}: give a divisor of the {x.size - 1} sample spacings")
    load_plugin()
    model = mujoco.MjModel.from_xml_string(device_mjcf(device, timestep=h, motion=motion))
    data = mujoco.MjData(model)
    if np.ndim(state):
        data.act[:] = state
    elif device.nstate:
        data.act[0] = state

    # views into the engine's memory, fetched once
    qpos, qvel, ctrl, act = data.qpos, data.qvel, data.ctrl, data.act
    sensor = data.sensor("device").data
    told = 1 + (x.size - 1) // every
    total, friction = np.zeros((2, told))
    states = np.zeros((told, device.nstate))
    between, turns = np.append(np.diff(x) / h, 0.0), _turns(h, x, v)
    instant = mujoco.mjtIntegrator.mjINT_RK4
    pieces = _pieces(device, h, float(np.max(np.abs(v), initial=0.0)))
    moving = instant if pieces else mujoco.mjtIntegrator.mjINT_EULER
    model.opt.timestep = h / max(pieces, 1)
    for i, gains in enumerate(_gains(h, x, v, a, pieces)):
        # the sample: position, velocity and acceleration as recorded
        qpos[0], qvel[0], ctrl[0] = x[i], v[i], a[i]
        if i % every == 0:
            model.opt.integrator = instant
            mujoco.mj_forward(model, data)
            total[i // every], friction[i // every] = sensor[0], sensor[2]
            states[i // every] = act

        # on to the next sample
        model.opt.integrator = moving
        if not pieces:
            for time, velocity in turns.get(i, ((h, between[i]),)):
                model.opt.timestep = time
                qvel[0], ctrl[0] = velocity, 0.0
                mujoco.mj_step(model, data)
            continue
        for gain in gains:
            ctrl[0] = gain
            mujoco.mj_step(model, data)
    first = states[:, 0] if device.nstate else np.zeros(told)
    return {"total": total, "friction": friction, "state": first, "states": states}


def _turns(h: float, x: NDArray, v: NDArray) -> dict[int, tuple[tuple[float, float], ...]]:
    """Of samples behind which the motion turns: times to and from there, and mean velocities.

    As `Device.along` has it, the velocity taken as straight between the samples.
    """
    turning = np.flatnonzero(v[:-1] * v[1:] < 0)
    begin, end = v[turning], v[turning + 1]
    shares = begin / (begin - end)
    places = x[turning] + 0.5 * begin * shares * h
    behind = x[turning + 1] - places
    between = (shares > _AT_SAMPLE) & (shares < 1.0 - _AT_SAMPLE) & (behind * end > 0)
    rows = zip(turning[between], shares[between] * h, begin[between], behind[between], strict=True)
    return {
        int(i): ((float(time), float(0.5 * speed)), (float(h - time), float(way / (h - time))))
        for i, time, speed, way in rows
    }


def _gains(h: float, x: NDArray, v: NDArray, a: NDArray, pieces: int) -> Iterator[list[float]]:
    """For every sample the mean accelerations in the pieces of the spacing behind it.

    Of the quintic through x, v and a; none behind the last sample, or in no pieces.
    """
    share = np.arange(pieces + 1) / max(pieces, 1)
    powers = np.array([share, share**2, share**3, share**4])
    for begin in range(0, x.size - 1, _AT_ONCE):
        near = slice(begin, begin + _AT_ONCE + 1)
        here, speed, pull = x[near], v[near], a[near]
        if not pieces:
            yield from ([] for _ in here[1:])
            continue
        rest = np.diff(here) / h - speed[:-1] - 0.5 * h * pull[:-1]
        turn, bend = np.diff(speed) - h * pull[:-1], 0.5 * h * np.diff(pull)
        # what the velocity gains up to a share of the spacing, by powers of that
        terms = np.column_stack(
            [
                h * pull[:-1],
                3.0 * (10.0 * rest - 4.0 * turn + bend),
                4.0 * (7.0 * turn - 15.0 * rest - 2.0 * bend),
                5.0 * (6.0 * rest - 3.0 * turn + bend),
            ]
        )
        yield from (np.diff(terms @ powers) * (pieces / h)).tolist()
    if x.size:
        yield []


def _pieces(device: Device, h: float, fastest: float) -> int:
    """Into how many steps of RK4 a spacing is cut to resolve the series element; 0 without one.

    fastest: the largest speed of the terminals [m/s], which a slip seldom exceeds.
    """
    stiffness, inertance = device.series_stiffness, device.inertance
    leak = device.leak_damping + 2.0 * device.leak_quadratic_damping * fastest
    if not (stiffness or device.series_damping or leak):
        return 0
    spring = np.sqrt(stiffness / inertance)
    damper = (device.series_damping if stiffness or not leak else leak) / inertance
    relaxation = 0.0
    if device.backlash or device.clutch_force or leak:
        slope = device.series_damping + leak
        relaxation = stiffness / slope if slope else 0.0
    length = h * max(spring, damper, relaxation) / _RESOLVED
    return 1 if length < _SHORT else max(2, int(np.ceil(length)))
