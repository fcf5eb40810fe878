"""A device on the simulated test rig: along a recorded motion, and as a model to load."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from xml.etree import ElementTree

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from inerter.core import Device
from inerter.models import model_path
from inerter.motion_units import ROTATION, TRANSLATION, Kind
from inerter.plugin import load_plugin


def device_mjcf(
    device: Device, name: str = "device", timestep: float = 1e-3, motion: Kind = TRANSLATION
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
    instance[:] = [
        ElementTree.Element("config", key=key, value=str(value))
        for key, value in device.given.items()
    ]
    if device.nstate:
        _only(root, "actuator/plugin").set("actdim", str(device.nstate))
    if motion == ROTATION:
        _turning(root)
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="unicode") + "\n"


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
) -> dict[str, NDArray[np.float64]]:
    """Run a device in MuJoCo along a sampled motion, on the test rig.

    At each sample the rig is put at x and v and accelerated by a; the sensor gives the force of
    that instant (which the stages of RK4 are made of). Then the table moves on to the next sample,
    which advances the states: at constant velocity by the laws' own steps (Euler), or with a series
    element along the quintic through both samples, by stages of RK4 short enough for it. This is
    what `Device.along` does, so that both agree to rounding (1e-9 of the force for inertances far
    below the table's 1e12 kg), with a series element to the error of its second-order steps, with
    load friction on a bristle to that of first-order ones. Viscoelastic branches take these steps
    at constant velocity too, where `Device.along` follows the quintic.

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

    Returns
    -------
    dict of ndarray
        total [N], friction [N], shape (n,); states (n, nstate); state (n,), the first of them (0
        without states).

    Raises
    ------
    ValueError
        h is not positive, or x, v, a are not of one length.
    """
    x, v, a = (np.asarray(channel, dtype=float) for channel in (x, v, a))
    if x.ndim != 1 or x.shape != v.shape or x.shape != a.shape:
        shapes = f"{x.shape}, {v.shape}, {a.shape}"
        raise ValueError(f"x, v, a must be arrays of one length; their shapes are {shapes}")
    if not h > 0:
        raise ValueError(f"h is {h}: give a sample spacing > 0 s")
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
    total, friction = np.zeros((2, x.size))
    states = np.zeros((x.size, device.nstate))
    between = np.append(np.diff(x) / h, 0.0)
    instant = mujoco.mjtIntegrator.mjINT_RK4
    pieces = _pieces(device, h)
    gains = _gains(h, x, v, a, pieces)
    moving = instant if pieces > 1 else mujoco.mjtIntegrator.mjINT_EULER
    model.opt.timestep = h / pieces
    for i in range(x.size):
        # the sample: position, velocity and acceleration as recorded
        qpos[0], qvel[0], ctrl[0] = x[i], v[i], a[i]
        model.opt.integrator = instant
        mujoco.mj_forward(model, data)
        total[i], friction[i] = sensor[0], sensor[2]
        states[i] = act

        # on to the next sample
        model.opt.integrator = moving
        if pieces == 1:
            qvel[0], ctrl[0] = between[i], 0.0
            mujoco.mj_step(model, data)
            continue
        for gain in gains(i) if i + 1 < x.size else ():
            ctrl[0] = gain
            mujoco.mj_step(model, data)
    first = states[:, 0] if device.nstate else np.zeros(x.size)
    return {"total": total, "friction": friction, "state": first, "states": states}


def _gains(
    h: float, x: NDArray, v: NDArray, a: NDArray, pieces: int
) -> Callable[[int], list[float]]:
    """Mean accelerations in the pieces of a sample spacing, of the quintic through x, v and a."""
    rest = np.diff(x) / h - v[:-1] - 0.5 * h * a[:-1]
    turn, bend = np.diff(v) - h * a[:-1], 0.5 * h * np.diff(a)
    # what the velocity gains up to a share of the spacing, by powers of that
    terms = np.column_stack(
        [
            h * a[:-1],
            3.0 * (10.0 * rest - 4.0 * turn + bend),
            4.0 * (7.0 * turn - 15.0 * rest - 2.0 * bend),
            5.0 * (6.0 * rest - 3.0 * turn + bend),
        ]
    )
    share = np.arange(pieces + 1) / pieces
    powers = np.array([share, share**2, share**3, share**4])

    def of(i: int) -> list[float]:
        return (np.diff(terms[i] @ powers) * (pieces / h)).tolist()

    return of


def _pieces(device: Device, h: float) -> int:
    """Into how many steps a sample spacing is cut so that RK4 resolves the series element."""
    if not (device.series_stiffness or device.series_damping):
        return 1
    spring = np.sqrt(device.series_stiffness / device.inertance)
    damper = device.series_damping / device.inertance
    relaxation = device.series_stiffness / device.series_damping if device.backlash else 0.0
    return max(2, int(np.ceil(h * max(spring, damper, relaxation) / 0.2)))
