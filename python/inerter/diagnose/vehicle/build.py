"""The user's MJCF with a diagnosis' changes in it: edits of an MjSpec, so that it can be written.

ELEMENT.NAME                what changes (tyre:ACTUATOR, tendon:, joint: or body:NAME)
DEVICE.*                    the configuration of the inerter.device (`catalogue.coordinates`)
TYRE.tyre_stiffness         gain of the road's position actuator [N/m]
TYRE.tyre_damping           a further velocity actuator, whose control is the road's rate [N s/m]
TYRE.tyre_static_load       force range of the road's actuator: it cannot pull by more [N]
DEVICE.rebound_damping, DEVICE.bump_damping   the suspension's damper: the smaller one stays
                            where the user has it, the rest acts in its direction alone [N s/m];
                            of one that bends both are the device's
DEVICE.damping_gradient     its damping grows along the stroke by this share per metre [1/m]
tyres.patch_length, patch_time   no part of a model: what tyres average the road over [m, s]
joint:NAME.joint_friction, joint_damping   of a wheel's or body's own joint [N, N s/m]
actuator:NAME.actuator_gain, actuator_lag   of a force that the record drives [1, s]
LINK.stiffness, LINK.stiffness_cubic, LINK.damping   of a joint or tendon
BODY.mass                   of a body, its inertia in proportion [kg]
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from xml.sax.saxutils import escape

import mujoco
import numpy as np

from inerter.cars.mjcf import LEAD
from inerter.cars.read import CarError
from inerter.cars.spec import model_spec
from inerter.catalogue.coordinates import parameters_of
from inerter.catalogue.friction import FRICTION, LAW_COORDINATES, law_coordinates
from inerter.core import Device, DeviceError, parameters
from inerter.device_in_model import DeviceInModel, devices_of
from inerter.diagnose.vehicle.changes import (
    add_one_sided,
    change_force,
    change_guide,
    change_tyre,
    rate_actuator,
    set_first,
    split_damping,
)
from inerter.diagnose.vehicle.inputs import MOCAP, actuator_of, mocap_of
from inerter.diagnose.vehicle.model import VehicleModel
from inerter.diagnose.vehicle.parts import Parts, Suspension, VehicleLink, find_parts
from inerter.engine_errors import (
    COMPILE_ERRORS,
    cannot_be_opened,
    engine_text,
    timestep_fault,
)
from inerter.model_bounds import refuse_not_a_number, refuse_unbounded
from inerter.plugin import load_plugin


@dataclass(kw_only=True)
class UserModel:
    """A user's model file, its devices and the parts of its vehicle.

    Attributes
    ----------
    path : Path
        The file.
    spec : MjSpec
        As read; never changed.
    model : MjModel
        As compiled.
    devices : list of DeviceInModel
        With names, in the order of the actuators.
    parts : Parts
        Of the vehicle; set by `with_roads`.
    """

    path: Path
    spec: mujoco.MjSpec
    model: mujoco.MjModel
    devices: list[DeviceInModel]
    parts: Parts = field(default_factory=Parts)
    roads: list[int] = field(default_factory=list)
    tables: list[int] = field(default_factory=list)

    def with_inputs(self, targets: Iterable[str]) -> None:
        """Say what the records drive, as `Channels.inputs` has it."""
        named = list(targets)
        for target in named:
            if mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_NUMERIC, LEAD + target) >= 0:
                raise ValueError(
                    f"{target}: its tyre has damping (tyre_damping), which a diagnosis does not "
                    "drive; leave it out of the car's file"
                )
        actuators = [actuator_of(self.model, target) for target in named]
        bodies = [mocap_of(self.model, target) for target in named]
        self.with_roads([i for i in actuators if i >= 0], [b for b in bodies if b >= 0])

    def with_roads(self, roads: list[int], tables: Sequence[int] = ()) -> None:
        """Say which actuators and which mocap bodies the records drive."""
        self.roads, self.tables = roads, list(tables)
        self.parts = find_parts(self.model, roads, tables)

    def road_inputs(self, targets: Sequence[str]) -> list[int]:
        """Which of the inputs are roads under tyres: of tyres' actuators, upright mocap bodies."""
        tyres = {tyre.actuator for tyre in self.parts.tyres}
        return [
            i
            for i, target in enumerate(targets)
            if (target.startswith(MOCAP) and target.endswith(".z"))
            or actuator_of(self.model, target) in tyres
        ]  # fmt: skip

    def with_timestep(self, step: float) -> UserModel:
        """The same model with another timestep."""
        spec = self.spec.copy()
        spec.option.timestep = step
        model = spec.copy().compile()
        return UserModel(
            path=self.path,
            spec=spec,
            model=model,
            devices=devices_of(model),
            parts=self.parts,
            roads=self.roads,
            tables=self.tables,
        )

    @cached_property
    def stated(self) -> dict[str, float]:
        """Coordinates of everything stated that a diagnosis may change."""
        found: dict[str, float] = {}
        for device in self.devices:
            for name, value in stated_coordinates(device, self.model).items():
                found[f"{device.name}.{name}"] = value
        for tyre in self.parts.tyres:
            found[f"{tyre.element}.tyre_stiffness"] = tyre.stiffness
            rate = mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_ACTUATOR, rate_actuator(tyre))
            if rate >= 0:
                found[f"{tyre.element}.tyre_damping"] = -float(self.model.actuator_biasprm[rate, 2])
        for link in self.parts.road_springs:
            found[f"{link.element}.tyre_stiffness"] = self._of_link(link, "stiffness")
        for joint in self.guides:
            dof = int(self.model.jnt_dofadr[joint])
            found[f"{self.joint(joint)}.joint_friction"] = float(self.model.dof_frictionloss[dof])
            found[f"{self.joint(joint)}.joint_damping"] = float(self.model.dof_damping[dof])
        for actuator in self.forces:
            element = self.actuator(actuator)
            found |= {f"{element}.actuator_gain": 1.0, f"{element}.actuator_lag": 0.0}
        for part in self.parts.suspensions:
            for body in (part.wheel, part.body):
                found[f"{self.body(body)}.mass"] = float(self.model.body_mass[body])
            for link, names in ((part.spring, ("stiffness",)), (part.damper, ("damping",))):
                if link is not None and link.kind != "device":
                    for name in names:
                        found[f"{link.element}.{name}"] = self._of_link(link, name)
        return found

    @cached_property
    def guides(self) -> list[int]:
        """Joints that guide a wheel or a body against what is neither: slides and hinges."""
        model, found = self.model, set()
        for part in self.parts.suspensions:
            pair = (part.wheel, part.body)
            for joint in range(model.njnt):
                own = int(model.jnt_bodyid[joint])
                if (
                    own in pair
                    and int(model.body_parentid[own]) not in pair
                    and (int(model.jnt_type[joint]) in (2, 3))
                ):
                    found.add(joint)
        return sorted(found)

    @cached_property
    def forces(self) -> list[int]:
        """Actuators that a record drives with a force: fixed gain, no bias, no dynamics."""
        model = self.model
        tyres = {tyre.actuator for tyre in self.parts.tyres}
        return [
            i
            for i in self.roads
            if i not in tyres
            and model.actuator_gaintype[i] == mujoco.mjtGain.mjGAIN_FIXED
            and model.actuator_biastype[i] == mujoco.mjtBias.mjBIAS_NONE
            and model.actuator_dyntype[i] == mujoco.mjtDyn.mjDYN_NONE
        ]

    def joint(self, index: int) -> str:
        """A joint's name in coordinates."""
        return f"joint:{self.model.joint(index).name or index}"

    def actuator(self, index: int) -> str:
        """An actuator's name in coordinates."""
        return f"actuator:{self.model.actuator(index).name or index}"

    def _of_link(self, link: VehicleLink, name: str) -> float:
        if link.kind == "tendon":
            return float(getattr(self.model, f"tendon_{name}")[link.index])
        if name == "stiffness":
            return float(self.model.jnt_stiffness[link.index])
        return float(self.model.dof_damping[self.model.jnt_dofadr[link.index]])

    def damping(self, part: Suspension) -> float:
        """Stated damping of a suspension's damper [N s/m]."""
        assert part.damper is not None
        if part.damper.kind == "device":
            return self.stated[f"{part.device}.viscous"]
        return self._of_link(part.damper, "damping")

    def body(self, index: int) -> str:
        """A body's name in coordinates."""
        return f"body:{self.model.body(index).name or index}"

    def device(self, name: str) -> DeviceInModel:
        """A device by name."""
        return next(d for d in self.devices if d.name == name)

    def device_of(self, name: str, change: VehicleModel) -> Device:
        """A device with the changes of a model."""
        found = self.device(name)
        given = found.stated(self.model)
        values = {
            k: v for k, v in change.of(name).items() if k not in ("rebound_damping", "bump_damping")
        }
        slope = values.pop("damping_gradient", 0.0)
        law = change.friction.get(name, found.device.friction)
        if not values and law == found.device.friction:
            base = Device(**given)
        else:
            texts = {k: v for k, v in given.items() if isinstance(v, str) and k != "friction"}
            coordinates = {**stated_coordinates(found, self.model), **values}
            own = FRICTION[law]
            # what another law has is none of this one's
            kept = {*own.coordinates, *own.constants, "friction_backlash"}
            for other in {*LAW_COORDINATES} - kept:
                coordinates.pop(other, None)
            base = Device(friction=law, **parameters_of(coordinates), **texts)
        if own_damping := self._damping_by_direction(name, change):
            base = base.replace(**own_damping)
        return _sloping(base, slope) if slope else base

    def has_damping_curve(self, name: str) -> bool:
        """Whether a device states how its damping changes along the stroke."""
        return "curve_lower" in self.device(name).stated(self.model)

    def _damping_by_direction(self, name: str, change: VehicleModel) -> dict[str, float]:
        """A device's own damping where its damper differs by direction.

        One that bends has all of it, with a valve for each direction; else the larger part of one
        direction is beside it.
        """
        part = next((p for p in self.parts.suspensions if p.device == name), None)
        split = split_damping(name, change)
        if split is None or part is None or part.damper is None:
            return {}
        if change.bends(name):
            rebound, bump = split
            share = part.direction * (rebound - bump) / ((rebound + bump) or 1.0)
            return {"viscous": 0.5 * (rebound + bump), "damping_asymmetry": share}
        return {"viscous": min(split)} if part.damper.kind == "device" else {}

    def build(self, change: VehicleModel) -> mujoco.MjSpec:
        """The spec with the changes of a model in it."""
        spec = self.spec.copy()
        states = False
        for device in self.devices:
            if change.of(device.name) or device.name in change.friction:
                states |= self._configure(spec, device, self.device_of(device.name, change))
        for part in self.parts.suspensions:
            self._change_suspension(spec, part, change)
        for tyre in self.parts.tyres:
            change_tyre(spec, tyre, change.of(tyre.element))
        for link in self.parts.road_springs:
            if "tyre_stiffness" in (values := change.of(link.element)):
                set_first(spec.tendons[link.index], "stiffness", values["tyre_stiffness"])
        for index in {b for p in self.parts.suspensions for b in (p.wheel, p.body)}:
            if (mass := change.of(self.body(index)).get("mass")) is not None:
                self._weigh(spec, index, mass)
        for joint in self.guides:
            change_guide(spec.joints[joint], change.of(self.joint(joint)), spec.option.timestep)
        for index in self.forces:
            states |= change_force(spec.actuators[index], change.of(self.actuator(index)))
        if states:
            # a keyframe that states the device's states has too few of them now
            for keyframe in spec.keys:
                keyframe.act = []
        return spec

    def compile(self, change: VehicleModel) -> mujoco.MjModel:
        """The compiled model with changes.

        Raises
        ------
        ValueError
            MuJoCo refuses it.
        """
        return self.build(change).compile()

    def xml(self, change: VehicleModel) -> str:
        """The extended model as MJCF; its asset folders are absolute, it may lie anywhere."""
        spec = self.build(change)
        folder = self.path.resolve().parent
        for name in ("meshdir", "texturedir"):
            if getattr(spec, name) or _has_files(spec):
                setattr(spec, name, str(folder / getattr(spec, name)))
        spec.compile()
        # the compiler states a device's inertance and damping twice, in fewer digits
        names = "|".join(re.escape(escape(device.name)) for device in self.devices)
        return re.sub(
            rf'<plugin name="({names})"[^>]*>',
            lambda found: re.sub(r' (armature|damping)="[^"]*"', "", found.group()),
            spec.to_xml(),
        )

    def _configure(self, spec: mujoco.MjSpec, found: DeviceInModel, device: Device) -> bool:
        """Write a device into its actuator or instance; whether its number of states changes."""
        actuator = spec.actuators[found.actuator]
        holder = actuator.plugin
        if holder.name:
            holder = spec.plugin(holder.name)
        config = {k: str(v) for k, v in device.given.items() if np.isfinite(_number(v))}
        holder.config = config
        for name, value in config.items():
            if (numeric := spec.numeric(f"{found.name}.{name}")) is not None:
                numeric.data = [float(value)]
        # what a saved model states beside the keys
        if actuator.armature:
            actuator.armature = 0.0
        if actuator.damping[0]:
            actuator.damping = np.zeros_like(actuator.damping)
        if device.nstate == found.device.nstate:
            return False
        actuator.actdim = device.nstate if device.nstate else -1
        return True

    def _change_suspension(
        self, spec: mujoco.MjSpec, part: Suspension, change: VehicleModel
    ) -> None:
        for link in {part.spring, part.damper} - {None}:
            if link is None or link.kind == "device":
                continue
            element = (spec.tendons if link.kind == "tendon" else spec.joints)[link.index]
            values = change.of(link.element)
            for name, column, place in (
                ("stiffness", "stiffness", 0),
                ("stiffness_cubic", "stiffness", 2),
                ("damping", "damping", 0),
            ):
                if name in values:
                    set_first(element, column, values[name], place)
        split = split_damping(part.device, change)
        if split is None or part.damper is None or change.bends(part.device):
            return
        rebound, bump = split
        link = part.damper
        if link.kind != "device":
            element = (spec.tendons if link.kind == "tendon" else spec.joints)[link.index]
            set_first(element, "damping", min(split))
        add_one_sided(spec, link, rebound, bump)

    def _weigh(self, spec: mujoco.MjSpec, index: int, mass: float) -> None:
        body, model = spec.bodies[index], self.model
        spec.compiler.inertiafromgeom = mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_AUTO
        body.explicitinertial = True
        body.mass = mass
        body.inertia = model.body_inertia[index] * mass / model.body_mass[index]
        body.ipos, body.iquat = model.body_ipos[index], model.body_iquat[index]
        body.fullinertia = np.full(6, np.nan)


def read_model(path: Path) -> UserModel:
    """A user's model with the devices in it.

    Raises
    ------
    DeviceError
        It cannot be read or compiled, or there is no device in it.
    """
    load_plugin()
    try:
        refuse_unbounded(path)
        spec = model_spec(path)
        model = spec.copy().compile()
        refuse_not_a_number(model)
    except CarError as error:
        raise DeviceError(str(error)) from None
    except OSError as error:
        raise DeviceError(cannot_be_opened(path, error)) from None
    except COMPILE_ERRORS as error:
        raise DeviceError(f"{path}: {engine_text(error)}") from None
    if fault := timestep_fault(model.opt.timestep):
        raise DeviceError(f"{path}: {fault} in its <option>")
    devices = devices_of(model)
    if not devices:
        raise DeviceError(
            f"{path}: no inerter.device in the model; add one (docs: an actuator with "
            'plugin="inerter.device"), or diagnose bench records without --model'
        )
    unnamed = [d.actuator for d in devices if not d.name]
    if unnamed:
        raise DeviceError(
            f"{path}: the inerter.device on actuator {unnamed[0]} has no name; name the actuator"
        )
    return UserModel(path=path, spec=spec, model=model, devices=devices)


def model_of_text(text: str, path: Path) -> UserModel:
    """A model from the text of an MJCF; path: where it is said to come from."""
    spec = mujoco.MjSpec.from_string(text)
    model = spec.copy().compile()
    return UserModel(path=path, spec=spec, model=model, devices=devices_of(model))


def stated_coordinates(device: DeviceInModel, model: mujoco.MjModel) -> dict[str, float]:
    """A device's stated numbers as coordinates of a fit."""
    numbers = {
        name: float(value)
        for name, value in device.stated(model).items()
        if not isinstance(value, str) and name in parameters()
    }
    # of a law also what is left to its defaults, for the simulation has it
    law = FRICTION[device.device.friction].of_device(device.device)
    return {**law, **law_coordinates(device.device, numbers)}


def _sloping(device: Device, gradient: float) -> Device:
    """A device with damping viscous (1 + gradient x), held above a tenth and below twice of it."""
    share = np.linspace(-1.4, 1.4, 29)
    values = device.viscous * np.sign(gradient) * np.clip(share, -0.9, 0.9)
    return device.replace(
        viscous_curve=" ".join(repr(float(value)) for value in values),
        curve_lower=-1.4 / abs(gradient),
        curve_upper=1.4 / abs(gradient),
    )


def _number(value: float | str) -> float:
    return 0.0 if isinstance(value, str) else value


def _has_files(spec: mujoco.MjSpec) -> bool:
    return any(getattr(each, "file", "") for kind in (spec.meshes, spec.textures, spec.hfields)
               for each in kind)  # fmt: skip
