"""A car as a MuJoCo model in XML, equal to the car's equations for motions of any size.

Body and wheels move upward, the body pitches and rolls; struts are fixed tendons, so geometry does
not bend. Names are those of the shipped cars: controls `road`, `road_front` ... are road heights
[m], devices `strut...`; springs, dampers and stops are tendons and actuators without control.

| part | in the model |
| --- | --- |
| node between damper and inerter (S3 ... SW8) | body without mass on the wheel, its joint the device's displacement: the device's inertance is its inertia |
| damper behind a relaxation spring (SR, S5, SW8) | a viscoelastic branch of a device: its state in place of a node without mass |
| friction, play, shaft of the inerter | the plugin's, in the device |
| damper table, bump stop | actuators whose force is linear and clipped, one for each piece |
| tyre | position actuator with a force range: it pulls by at most its static load |
| damping of a tyre | that actuator's `kv`; its control is then the road's height plus `lead` times its rate, lead = ct / kt [s] in a numeric `lead_road...` |
"""  # noqa: E501

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping
from xml.etree import ElementTree as ET

from inerter.cars.parts import AxleParts, CarParts, StrutParts
from inerter.core import Device

LEAD = "lead_"
"""Before the name of a tyre's control: the numeric with its lead."""
FAR = 1e9
"""A force that no tyre and no stop reaches [N]."""
_HEIGHT, _WHEEL = 0.55, 0.31
NODES = ("S3", "S4", "S5", "S6", "SW7", "SW8")
"""Layouts with a node between damper and inerter."""
_BEHIND_SPRING = ("SR", "S5", "SW8")

Coefficients = dict[str, float]


def car_mjcf(car: CarParts) -> str:
    """The text of the model.

    Raises
    ------
    ValueError
        A damper table in a layout whose damper is behind a relaxation spring.
    """
    root = ET.Element("mujoco", model=car.name)
    ET.SubElement(root, "compiler", autolimits="true")
    ET.SubElement(root, "option", timestep="0.001", integrator="RK4", gravity="0 0 0")
    extension = ET.SubElement(root, "extension")
    world = ET.SubElement(root, "worldbody")
    parts = {name: ET.SubElement(root, name) for name in ("tendon", "actuator", "sensor", "custom")}
    _add_body(world, car)
    _sensor(parts, "framelinacc", "body_acceleration", objtype="body", objname="sprung")
    if car.kind != "quarter":
        for name in _angles(car):
            _sensor(parts, "jointpos", name, joint=name)
        name = "body_angular_acceleration"
        _sensor(parts, "frameangacc", name, objtype="body", objname="sprung")
    plugin = None
    for place, axle, x, y in _corners(car):
        corner = _Corner(car, axle, f"_{place}" if place else "", x, y)
        corner.add(world, parts)
        for config in corner.devices:
            if plugin is None:
                plugin = ET.SubElement(extension, "plugin", plugin="inerter.device")
            plugin.append(config)
    for name, axle in car.axles.items():
        if axle.anti_roll_stiffness:
            _add_bar(parts["tendon"], name, axle.anti_roll_stiffness, car.track)
    if plugin is None:
        root.remove(extension)
    if not len(parts["custom"]):
        root.remove(parts["custom"])
    ET.indent(root)
    return ET.tostring(root, encoding="unicode") + "\n"


def _angles(car: CarParts) -> list[str]:
    return ["heave", *(["roll"] if car.kind == "full" else []), "pitch"]


def _corners(car: CarParts) -> Iterator[tuple[str, AxleParts, float, float]]:
    """Place, axle, and position forward and to the left of the centre of mass [m]."""
    if car.kind == "quarter":
        yield "", car.front, 0.0, 0.0
        return
    for name, axle in car.axles.items():
        x = axle.distance if name == "front" else -axle.distance
        if car.kind == "half":
            yield name, axle, x, 0.0
        else:
            yield f"{name}_left", axle, x, car.track / 2.0
            yield f"{name}_right", axle, x, -car.track / 2.0


def _add_body(world: ET.Element, car: CarParts) -> None:
    body = ET.SubElement(world, "body", name="sprung", pos=f"0 0 {_HEIGHT}")
    ET.SubElement(body, "joint", name="heave", type="slide", axis="0 0 1")
    if car.kind == "full":
        ET.SubElement(body, "joint", name="roll", type="hinge", axis="1 0 0")
    if car.kind != "quarter":
        ET.SubElement(body, "joint", name="pitch", type="hinge", axis="0 1 0")
    roll, pitch = car.roll_inertia or 1.0, car.pitch_inertia or 1.0
    inertia = f"{roll:.10g} {pitch:.10g} {max(roll, pitch):.10g}"
    mass = f"{car.body_mass:.10g}"
    ET.SubElement(body, "inertial", pos="0 0 0", mass=mass, diaginertia=inertia)
    front = car.front.distance or 0.6
    rear = car.rear.distance if car.rear else 0.6
    size = f"{0.5 * (front + rear):.4g} {max(0.5 * car.track, 0.2):.4g} 0.15"
    ET.SubElement(
        body, "geom", type="box", size=size, pos=f"{0.5 * (front - rear):.4g} 0 0.2", mass="0",
        contype="0", conaffinity="0", rgba="0.3 0.5 0.8 0.5",
    )  # fmt: skip


def _sensor(parts: dict[str, ET.Element], kind: str, name: str, **values: str) -> None:
    ET.SubElement(parts["sensor"], kind, {"name": name, **values})


def _add_bar(tendons: ET.Element, axle: str, stiffness: float, track: float) -> None:
    """Half of what each wheel feels against the other, between both."""
    coefficients = {"roll": track, f"wheel_{axle}_left": -1.0, f"wheel_{axle}_right": 1.0}
    tendon = ET.SubElement(tendons, "fixed", name=f"bar_{axle}", stiffness=f"{stiffness / 2:.10g}")
    tendon.set("springlength", "0")
    for joint, value in coefficients.items():
        ET.SubElement(tendon, "joint", joint=joint, coef=f"{value:.10g}")


class _Corner:
    """A wheel with tyre and strut; `devices` are the plugin's instances that it needs."""

    def __init__(self, car: CarParts, axle: AxleParts, place: str, x: float, y: float) -> None:
        self.car, self.axle, self.place, self.at = car, axle, place, (x, y)
        self.strut: StrutParts = axle.strut
        self.devices: list[ET.Element] = []
        self.node = f"device{place}"
        wheel: Coefficients = {"heave": 1.0, f"wheel{place}": -1.0}
        if car.kind != "quarter":
            wheel["pitch"] = -x
        if car.kind == "full":
            wheel["roll"] = y
        self.wheel_travel = wheel
        self.travel = {name: self.strut.motion_ratio * value for name, value in wheel.items()}
        layout = self.strut.layout
        if layout in _BEHIND_SPRING and self.strut.damper_bump:
            raise ValueError(
                f"layout {layout}: its damper is behind a relaxation spring and has to be linear; "
                "give damping in place of the tables"
            )

    def add(self, world: ET.Element, parts: dict[str, ET.Element]) -> None:
        """Everything of the corner."""
        place, load = self.place, self._static_load()
        body = ET.SubElement(
            world, "body", name=f"wheel{place}", pos=f"{self.at[0]:.10g} {self.at[1]:.10g} {_WHEEL}"
        )
        ET.SubElement(body, "joint", name=f"wheel{place}", type="slide", axis="0 0 1")
        ET.SubElement(
            body, "geom", type="cylinder", size="0.3 0.1", euler="90 0 0",
            mass=f"{self.axle.wheel_mass:.10g}", contype="0", conaffinity="0",
            rgba="0.2 0.2 0.2 1",
        )  # fmt: skip
        ET.SubElement(
            parts["actuator"], "position", name=f"road{place}", joint=f"wheel{place}",
            kp=f"{self.axle.tyre_stiffness:.10g}", forcerange=f"{-load:.10g} {FAR:.0f}",
        )  # fmt: skip
        if self.axle.tyre_damping:
            parts["actuator"][-1].set("kv", f"{self.axle.tyre_damping:.10g}")
            lead = self.axle.tyre_damping / self.axle.tyre_stiffness
            data = f"{lead:.10g}"
            ET.SubElement(parts["custom"], "numeric", name=f"{LEAD}road{place}", data=data)
        if self.strut.layout in NODES:
            node = ET.SubElement(body, "body", name=f"node{place}")
            joint = ET.SubElement(node, "joint", name=self.node, type="slide", axis="0 0 1")
            ET.SubElement(node, "inertial", pos="0 0 0", mass="1e-9", diaginertia="1e-9 1e-9 1e-9")
            if self.strut.layout in ("SW7", "SW8"):
                joint.set("stiffness", f"{self.strut.inerter_stiffness:.10g}")
            if self.strut.layout == "S4" and not self.strut.damper_bump:
                joint.set("damping", f"{self.strut.damping:.10g}")
        self._add_strut(parts)
        self._add_stops(parts["actuator"])
        _sensor(parts, "framelinacc", f"wheel_acceleration{place}", objtype="body",
                objname=f"wheel{place}")  # fmt: skip
        self._tendon(parts["tendon"], f"travel{place}", self.wheel_travel)
        _sensor(parts, "tendonpos", f"suspension_travel{place}", tendon=f"travel{place}")
        _sensor(parts, "actuatorfrc", f"tyre_force{place}", actuator=f"road{place}")

    def _add_strut(self, parts: dict[str, ET.Element]) -> None:
        s, place, tendons = self.strut, self.place, parts["tendon"]
        behind = {**self.travel, self.node: -1.0}
        spring = self._tendon(tendons, f"spring{place}", self.travel, stiffness=_beside(s))
        damped: tuple[str, str] = ("tendon", f"spring{place}")
        if s.layout in ("S1", "S2"):
            self._damping(spring)
        elif s.layout == "S4":
            damped = ("joint", self.node)
            stiffness = s.relaxation_stiffness
            self._tendon(tendons, f"damper{place}", behind, stiffness=stiffness)
        elif s.layout in NODES:
            damped = ("tendon", f"damper{place}")
            tendon = self._tendon(tendons, f"damper{place}", behind, stiffness=_over_damper(s))
            if s.layout not in _BEHIND_SPRING:
                self._damping(tendon)
        if s.layout in _BEHIND_SPRING:
            k, c = _branch(s)
            config = {"branch_stiffness_1": k, "branch_damping_1": c}
            self._device(parts, f"relaxation{place}", damped, config, states=1)
        if s.layout == "S2" or s.layout in NODES:
            where = damped if s.layout == "S2" else ("joint", self.node)
            device: dict[str, float | str] = {"inertance": s.inertance, **dict(s.device)}
            self._device(parts, f"strut{place}", where, device, Device(**device).nstate)
        for sign, table in ((1.0, s.damper_rebound), (-1.0, s.damper_bump)):
            self._add_table(parts["actuator"], damped, sign, table)

    def _static_load(self) -> float:
        return self.car.static_loads["rear" if "rear" in self.place else "front"]

    def _damping(self, tendon: ET.Element) -> None:
        if not self.strut.damper_bump:
            tendon.set("damping", f"{self.strut.damping:.10g}")

    def _tendon(
        self, tendons: ET.Element, name: str, coefficients: Coefficients, stiffness: float = 0.0
    ) -> ET.Element:
        tendon = ET.SubElement(tendons, "fixed", name=name)
        if stiffness:
            tendon.set("stiffness", f"{stiffness:.10g}")
            tendon.set("springlength", "0")
        for joint, value in coefficients.items():
            ET.SubElement(tendon, "joint", joint=joint, coef=f"{value:.10g}")
        return tendon

    def _device(
        self,
        parts: dict[str, ET.Element],
        name: str,
        where: tuple[str, str],
        config: Mapping[str, float | str],
        states: int = 0,
    ) -> None:
        instance = ET.Element("instance", name=name)
        for key, value in config.items():
            text = value if isinstance(value, str) else f"{value:.10g}"
            ET.SubElement(instance, "config", key=key, value=text)
        self.devices.append(instance)
        values = {"name": name, "plugin": "inerter.device", "instance": name, where[0]: where[1]}
        if states:
            values["actdim"] = str(states)
        ET.SubElement(parts["actuator"], "plugin", values)
        ET.SubElement(parts["sensor"], "plugin", name=name, plugin="inerter.device", instance=name)

    def _add_table(
        self, actuators: ET.Element, where: tuple[str, str], sign: float, table: tuple
    ) -> None:
        """Rebound (sign 1) and bump: each piece between two points rises, then stays."""
        word = "rebound" if sign > 0.0 else "bump"
        points = [(0.0, 0.0), *table]
        for n, ((v0, f0), (v1, f1)) in enumerate(itertools.pairwise(points)):
            slope = (f1 - f0) / (v1 - v0)
            if not slope:
                continue
            most = FAR if n == len(table) - 1 else f1 - f0
            limits = (-most, 0.0) if sign > 0.0 else (0.0, most)
            bias = (sign * slope * v0, 0.0, -slope)
            _clipped(actuators, f"{word}_{n + 1}{self.place}", where, bias, limits)

    def _add_stops(self, actuators: ET.Element) -> None:
        s, where = self.strut, ("tendon", f"spring{self.place}")
        if k := s.bump_stop_stiffness:
            bias, limits = (-k * s.bump_stop_gap, -k, 0.0), (0.0, FAR)
            _clipped(actuators, f"bump_stop{self.place}", where, bias, limits)
        if k := s.rebound_stop_stiffness:
            bias, limits = (k * s.rebound_stop_gap, -k, 0.0), (-FAR, 0.0)
            _clipped(actuators, f"rebound_stop{self.place}", where, bias, limits)


def _clipped(
    actuators: ET.Element,
    name: str,
    where: tuple[str, str],
    bias: tuple[float, float, float],
    limits: tuple[float, float],
) -> None:
    ET.SubElement(
        actuators, "general", {
            "name": name, where[0]: where[1], "gainprm": "0", "biastype": "affine",
            "biasprm": " ".join(f"{x:.10g}" for x in bias),
            "forcerange": " ".join(f"{x:.10g}" for x in limits),
        },
    )  # fmt: skip


def _beside(s: StrutParts) -> float:
    """The spring beside: what centring springs leave of the whole [N/m]."""
    if s.layout not in ("SW7", "SW8"):
        return s.stiffness
    yields = 1.0 / s.damper_stiffness + 1.0 / s.inerter_stiffness
    yields += 1.0 / s.relaxation_stiffness if s.layout == "SW8" else 0.0
    left = s.stiffness - 1.0 / yields
    if left < 0.0 and not math.isclose(s.stiffness, 1.0 / yields, rel_tol=1e-9):
        raise ValueError(
            f"layout {s.layout}: its inner springs carry {1.0 / yields:.6g} N/m at rest, more than "
            f"the stiffness {s.stiffness:g} N/m of the whole strut; soften them"
        )
    return max(left, 0.0)


def _over_damper(s: StrutParts) -> float:
    """The spring between the body and the node that is felt at once, for ever [N/m]."""
    if s.layout == "S6":
        return s.relaxation_stiffness
    if s.layout == "SW7":
        return s.damper_stiffness
    if s.layout == "SW8":
        # (k_1 beside c) behind k_b is this spring beside a branch, see _branch
        k1, kb = s.damper_stiffness, s.relaxation_stiffness
        return k1 * kb / (k1 + kb)
    return 0.0


def _branch(s: StrutParts) -> tuple[float, float]:
    """Spring [N/m] and damper [N s/m] in series that the damper behind its spring comes to."""
    share = s.relaxation_stiffness
    if s.layout == "SW8":
        share = s.relaxation_stiffness / (s.relaxation_stiffness + s.damper_stiffness)
        return s.relaxation_stiffness * share, s.damping * share**2
    return share, s.damping
