"""Devices drawn for a model: where they are attached, and parameters that matter there."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import mujoco
import numpy as np
from inerter import Device, add_device
from inerter.core import friction_laws

INTEGRATORS = {
    name.removeprefix("mjINT_"): getattr(mujoco.mjtIntegrator, name)
    for name in dir(mujoco.mjtIntegrator)
    if name.startswith("mjINT_")
}
G = 9.81


@dataclass
class Drawn:
    """One device to add: target says where, keys are its parameters."""

    name: str
    target: dict[str, Any]
    keys: dict[str, float | str]
    gear: float = 1.0
    words: str = ""
    # the two points of a straight line: (body, position), for the oracle
    points: tuple[tuple[str, np.ndarray], tuple[str, np.ndarray]] | None = None
    joint: str | None = None

    def device(self) -> Device:
        """As the device that it is."""
        return Device(**self.keys)


@dataclass
class Case:
    """What is drawn for a model beside its state."""

    devices: list[Drawn] = field(default_factory=list)
    integrator: str = "EULER"
    tight: bool = True


def draw(
    rng: np.random.Generator, spec: mujoco.MjSpec, model: mujoco.MjModel, data: mujoco.MjData
) -> Case:
    """One to four devices anywhere in a model that stands at the state of `data`."""
    case = Case(integrator=str(rng.choice(list(INTEGRATORS))), tight=bool(rng.random() < 0.7))
    wanted = int(rng.choice([1, 1, 2, 2, 3, 4]))
    for _ in range(10 * wanted):
        if len(case.devices) == wanted:
            break
        place = _place(rng, spec, model, data, f"zoo_{len(case.devices)}")
        if place is not None:
            mass = effective_mass(model, data, place)
            # a line that hardly lengthens shows a mass beside which nothing else counts
            if 1e-9 < mass < (1e9 if place.joint else 10 * model.body_subtreemass[0]):
                # RK4 takes every force explicitly: nothing stiffer than it resolves
                slow = 8.0 if case.integrator == "RK4" else 1.0
                place.keys |= parameters(rng, mass, slow * model.opt.timestep)
                case.devices.append(place)
    return case


# --- where --------------------------------------------------------------------------------------


def _place(
    rng: np.random.Generator,
    spec: mujoco.MjSpec,
    model: mujoco.MjModel,
    data: mujoco.MjData,
    name: str,
) -> Drawn | None:
    """A slide or hinge joint, a tendon of the model, or a line between two points."""
    hinges = [
        joint.name
        for joint in spec.joints
        if joint.name and joint.type in (mujoco.mjtJoint.mjJNT_SLIDE, mujoco.mjtJoint.mjJNT_HINGE)
    ]
    ropes = [tendon.name for tendon in spec.tendons if tendon.name]
    kind = rng.choice(["joint", "line", "line", "tendon"])
    if kind == "joint" and hinges:
        joint = str(rng.choice(hinges))
        gear = float(rng.choice([1.0, 1.0, -2.0]))
        return Drawn(name, {"joint": joint}, {}, gear, f"joint {joint}", joint=joint)
    if kind == "tendon" and ropes:
        rope = str(rng.choice(ropes))
        return Drawn(name, {"tendon": rope}, {}, 1.0, f"tendon {rope}")
    return _line(rng, spec, model, data, name)


def _line(
    rng: np.random.Generator,
    spec: mujoco.MjSpec,
    model: mujoco.MjModel,
    data: mujoco.MjData,
    name: str,
) -> Drawn | None:
    """Two points of bodies that can move against each other."""
    bodies = np.array([body.name for body in spec.bodies if body.name])
    moving = [b for b in bodies if model.body_weldid[model.body(b).id]]
    if not moving:
        return None
    for _ in range(20):
        first = str(rng.choice(bodies))
        second = str(rng.choice(moving))
        if model.body_weldid[model.body(first).id] == model.body_weldid[model.body(second).id]:
            continue
        points = [_point(rng, spec, model, body) for body in (first, second)]
        ends = [data.body(body).xpos + data.body(body).xmat.reshape(3, 3) @ p for body, p in points]
        if np.linalg.norm(ends[1] - ends[0]) > 1e-2 * model.stat.extent:
            words = f"line {first} - {second}"
            pair = (points[0], points[1])
            return Drawn(name, {"between": pair}, {}, 1.0, words, pair)
    return None


def _point(
    rng: np.random.Generator, spec: mujoco.MjSpec, model: mujoco.MjModel, body: str
) -> tuple[str, np.ndarray]:
    """A point near the body's centre of mass."""
    index = model.body(body).id
    spread = 0.03 * min(model.stat.extent, 3.0)
    return body, model.body_ipos[index] * (index > 0) + spread * rng.standard_normal(3)


def effective_mass(model: mujoco.MjModel, data: mujoco.MjData, place: Drawn) -> float:
    """Mass that the terminals show along the device [kg or kg m^2], 0 where it moves nothing."""
    row = np.zeros((1, model.nv))
    if place.joint is not None:
        row[0, model.joint(place.joint).dofadr[0]] = place.gear
    elif place.points is not None:
        row[0] = line_row(model, data, place.points)
    else:
        row[0] = tendon_row(model, data, model.tendon(place.target["tendon"]).id)
    answer = np.zeros_like(row)
    mujoco.mj_solveM(model, data, answer, row)
    mobility = float((row * answer).sum())
    return 1 / mobility if mobility > 1e-12 else 0.0


def line_row(model: mujoco.MjModel, data: mujoco.MjData, points: Any) -> np.ndarray:
    """How a line between two points of bodies lengthens with each degree of freedom."""
    ends, slopes = [], []
    for body, position in points:
        index = model.body(body).id
        end = data.xpos[index] + data.xmat[index].reshape(3, 3) @ position
        slope = np.zeros((3, model.nv))
        mujoco.mj_jac(model, data, slope, None, end, index)
        ends.append(end)
        slopes.append(slope)
    line = ends[1] - ends[0]
    return (slopes[1] - slopes[0]).T @ (line / np.linalg.norm(line))


def tendon_row(model: mujoco.MjModel, data: mujoco.MjData, tendon: int) -> np.ndarray:
    """How a tendon lengthens with each degree of freedom."""
    row = np.zeros(model.nv)
    start = int(model.ten_J_rowadr[tendon])
    count = int(model.ten_J_rownnz[tendon])
    row[model.ten_J_colind[start : start + count]] = data.ten_J.ravel()[start : start + count]
    return row


# --- what ---------------------------------------------------------------------------------------


def parameters(rng: np.random.Generator, mass: float, h: float) -> dict[str, float | str]:
    """A device beside an effective mass that is stepped by h."""
    keys: dict[str, float | str] = {"inertance": mass * 10.0 ** rng.uniform(-2, 1)}
    heavy = mass + float(keys["inertance"])
    law = str(rng.choice(list(friction_laws())))
    if law != "none":
        keys |= _friction(rng, law, mass, heavy, h)
    if rng.random() < 0.3:
        keys["stiffness"] = heavy * (rng.uniform(0.01, 0.2) / h) ** 2
    if rng.random() < 0.15:
        keys["viscous"] = heavy * 10.0 ** rng.uniform(-3, -1) / h
        if rng.random() < 0.3:
            keys |= {"damping_asymmetry": rng.uniform(-0.9, 0.9), "damping_knee": 0.1}
            keys |= {"damping_beyond": rng.uniform(0.1, 2.0), "damping_sharpness": 5.0}
    if rng.random() < 0.25:
        keys["series_stiffness"] = heavy * (10.0 ** rng.uniform(-1.5, 0.5) / h) ** 2
        keys["series_damping"] = 2 * 0.1 * np.sqrt(keys["series_stiffness"] * heavy)
        if rng.random() < 0.3:
            keys["backlash"] = 10.0 ** rng.uniform(-5, -3)
    if rng.random() < 0.1:
        keys["load_friction"] = rng.uniform(0.01, 0.2)
    if rng.random() < 0.1:
        keys |= {"stop_upper": rng.uniform(1e-3, 0.1), "stop_stiffness": heavy * (0.5 / h) ** 2}
    if rng.random() < 0.15:
        keys |= _control(rng, keys, heavy, h)
    return {key: value if isinstance(value, str) else float(value) for key, value in keys.items()}


def _control(
    rng: np.random.Generator, keys: dict[str, float | str], heavy: float, h: float
) -> dict[str, float | str]:
    """A control that sets damping, inertance or stiffness, some with a lag of a few steps."""
    name = str(rng.choice(["viscous", "inertance", "stiffness"]))
    stated = keys.get(name, heavy * (1e-3 / h if name == "viscous" else (0.02 / h) ** 2))
    lag = h * 10.0 ** rng.uniform(0, 2) * rng.integers(0, 2)
    bounds = {"control_lower": 0.5 * float(stated), "control_upper": 2.0 * float(stated)}
    return {name: stated, "control": name, "control_lag": float(lag), **bounds}


def _friction(
    rng: np.random.Generator, law: str, mass: float, heavy: float, h: float
) -> dict[str, float | str]:
    """A law with a level from a thousandth of the weight to three times it."""
    level = mass * G * 10.0 ** rng.uniform(-3, 0.5)
    stiff = heavy * (10.0 ** rng.uniform(-1.5, 0.7) / h) ** 2
    keys: dict[str, float | str] = {"friction": law}
    if law == "bouc_wen":
        slip = level / stiff
        keys |= {"bw_stiffness": stiff, "bw_beta": 0.6 / slip, "bw_gamma": 0.4 / slip}
        return keys
    if law == "maxwell_slip":
        for i, share in enumerate((0.5, 0.3, 0.2), 1):
            keys |= {f"slip_stiffness_{i}": stiff / 3, f"slip_force_{i}": level * share}
        return keys
    keys["coulomb_force"] = level
    if law in ("stribeck", "lugre", "brown_mcphee"):
        keys |= {"static_force": level * rng.uniform(1, 2), "stribeck_velocity": 0.01}
    if law == "rate_state":
        keys |= {
            "age_effect": rng.uniform(0, 0.1),
            "transition_velocity": 10 ** rng.uniform(-3, -2),
        }
    if law in ("coulomb", "stribeck", "brown_mcphee") and rng.random() < 0.3:
        keys["transition_velocity"] = 10.0 ** rng.uniform(-3, -1)
    if law in ("dahl", "lugre"):
        keys["bristle_stiffness"] = stiff
    if law == "lugre":
        keys["bristle_damping"] = 10.0 ** rng.uniform(-1, 1.5) * heavy / h * rng.integers(0, 2)
    return keys


def added(spec: mujoco.MjSpec, case: Case) -> mujoco.MjSpec:
    """A copy of the spec with the devices.

    Raises
    ------
    ValueError
        A device is refused.
    """
    whole = spec.copy()
    for each in case.devices:
        device = each.device()
        add_device(whole, each.name, device, rest_length="initial", gear=each.gear, **each.target)
    return whole
