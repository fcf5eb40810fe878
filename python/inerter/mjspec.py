"""A device in a model that is made with `mujoco.MjSpec`."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import mujoco
import numpy as np

from inerter.controls import remove_control
from inerter.core import Device, DeviceError, lists, parameters
from inerter.device_in_model import PLUGIN, DeviceInModel, device_of, devices_of
from inerter.mjspec_blank import blank
from inerter.mjspec_remove import devices_in, new_name, remove
from inerter.plugin import load_plugin

# a site by name or object, or a body and a position in it [m]
Terminal = Any
_FREE = (mujoco.mjtJoint.mjJNT_FREE, mujoco.mjtJoint.mjJNT_BALL)


@dataclass(frozen=True)
class AddedDevice:
    """What `add_device` has put into an MjSpec, by name.

    name: of the actuator, and of the plugin instance. sensor: its sensor, None without. tendon or
    joint: what it acts on, the other None. sites: terminals, where it made or was given them;
    made: those of them that it made. numerics: the parameters that can be changed in the compiled
    model, by their key. rest_length: [m], as measured or stated.
    """

    name: str
    device: Device
    sensor: str | None
    tendon: str | None
    joint: str | None
    sites: tuple[str, ...] = ()
    made: tuple[str, ...] = ()
    numerics: dict[str, str] = field(default_factory=dict)

    @property
    def actuator(self) -> str:
        """Name of the actuator."""
        return self.name

    @property
    def instance(self) -> str:
        """Name of the plugin instance."""
        return self.name

    @property
    def rest_length(self) -> float:
        """Length at which the displacement is 0 [m] (a hinge: rad)."""
        return self.device.rest_length

    def of(self, model: mujoco.MjModel, name: str | None = None) -> DeviceInModel:
        """Where the device is in the compiled model: sensor values, states, live parameters.

        Parameters
        ----------
        model : mujoco.MjModel
            Compiled from the spec that the device was added to, or from one that this was attached
            to: the prefix and the suffix are found.
        name : str, optional
            Of the device's actuator in the model, where its spec was attached more than once.

        Raises
        ------
        ValueError
            The model has no such device (it was compiled before the device was added), or more than
            one.
        """
        if name is None:
            present = {each.name: each.device for each in devices_of(model)}
            name = new_name(self.name, self.device, present)
        return device_of(model, name or self.name)


def add_device(
    spec: mujoco.MjSpec,
    name: str = "device",
    device: Device | None = None,
    *,
    between: tuple[Terminal, Terminal] | None = None,
    tendon: Any = None,
    joint: Any = None,
    rest_length: float | str | None = None,
    gear: float = 1.0,
    sensor: bool = True,
    live: Sequence[str] = (),
    control: bool | str | None = None,
    **values: float | str | Sequence[Any],
) -> AddedDevice:
    """Add a device to a model under construction, with everything that it needs.

    Parameters
    ----------
    spec : mujoco.MjSpec
        The model. It is changed only if the whole device can be added.
    name : str
        Name of the actuator, of the plugin instance, of the sensor and of a tendon that it makes.
    device : Device, optional
        The device; or give its parameters by name (`inertance=113, friction="lugre", ...`).
    between : pair, optional
        Terminals 1 and 2. Each is a site (its name or its mjsSite), or a pair (body, position in
        the body's frame [m]) at which a site is made; the body is a name ("world" allowed) or an
        mjsBody. A spatial tendon is made between them.
    tendon, joint : str or element, optional
        In place of `between`: an existing tendon, or a slide or hinge joint.
    rest_length : float or "initial", optional
        Length at which the displacement is 0 [m]; "initial": the length in the model's initial
        pose (`qpos0`). The default is the device's own.
    gear : float
        The displacement is gear times the length (or angle), less the rest length.
    sensor : bool
        Add a sensor that shows forces, states and energies.
    live : sequence of str
        Parameters and lists to read from the model at every step: each becomes a numeric
        "NAME.key", whose values in `mjModel.numeric_data` can be changed without compiling again.
    control : bool or str
        True: a control that is a force beside the device [N]; a name (`"viscous"`): one that sets
        this parameter, from `control_lower` to `control_upper`, which become its `ctrlrange`; the
        default is that of the device. Without a control `nu` stays as it was. A model that is saved
        as XML has the control again.
    **values : float or str
        Parameters by name, SI units; beside `device` they replace its own.

    Returns
    -------
    AddedDevice
        The names; `of(model)` finds the device in the compiled model.

    Raises
    ------
    DeviceError
        A parameter that cannot be.
    ValueError
        A name that is taken or unknown, a terminal given twice, a free or ball joint, a rest
        length that cannot be measured. One line; the spec is as it was.
    """
    load_plugin()
    if isinstance(control, str):
        values["control"] = control
    device = _device(device, values)
    sets = device.control != "force"
    if sets and isinstance(control, bool) and not control:
        raise ValueError(
            f"control is False, but the device's control sets {device.control}; leave it out, or "
            "give a device without one"
        )
    if sum(given is not None for given in (between, tendon, joint)) != 1:
        raise ValueError("give one of between=(site, site), tendon=... or joint=...")
    if not (np.isfinite(gear) and gear != 0):
        raise ValueError(f"gear is {gear}: give a finite number that is not 0")
    _refuse_taken_names(spec, name, sensor, between is not None)

    # everything that can be wrong is looked at before the spec is changed
    sites = [_Site(spec, end, f"{name}_{i}") for i, end in enumerate(between or (), 1)]
    if len(sites) == 2 and sites[0].same_as(sites[1]):
        raise ValueError(f"both terminals are {sites[0]}; give two different sites")
    if sites and len(sites) != 2:
        raise ValueError(f"between has {len(sites)} terminals; give two")
    if tendon is not None:
        target = _element(spec.tendon, tendon, "tendon", spec.tendons)
    elif joint is not None:
        target = _joint(spec, joint)
    else:
        target = name
    if rest_length == "initial":
        rest_length = gear * _initial_length(spec, sites, target, is_joint=joint is not None)
    if isinstance(rest_length, str):
        raise ValueError(f'rest_length is {rest_length!r}: give a length [m] or "initial"')
    if rest_length is not None:
        device = device.replace(rest_length=rest_length)
    numerics = _live_values(spec, name, device, live)

    _add(spec, name, device, sites, target, gear, sensor, is_joint=joint is not None)
    if not (control or sets):
        remove_control(spec.actuator(name))
    for key, found in numerics.items():
        spec.add_numeric(name=f"{name}.{key}", data=found, size=len(found))
    return AddedDevice(
        name=name,
        device=device,
        sensor=name if sensor else None,
        tendon=None if joint is not None else target,
        joint=target if joint is not None else None,
        sites=tuple(site.name for site in sites),
        made=tuple(site.name for site in sites if site.body is not None),
        numerics={key: f"{name}.{key}" for key in numerics},
    )


def remove_device(spec: mujoco.MjSpec, device: AddedDevice | str) -> None:
    """Take a device out of a model under construction, with everything that only it uses.

    Actuator, plugin instance, sensors, live parameters and what keyframes hold of them. It also
    takes the rest along of a device whose actuator, or the body of whose terminal, was deleted:
    such a model does not compile.

    Parameters
    ----------
    spec : mujoco.MjSpec
        The model that holds the device, under its name or, attached, with a prefix and a suffix.
    device : AddedDevice or str
        What `add_device` gave: the tendon and the sites that it made go too, unless something else
        refers to them. Or the name of the device's actuator or instance: tendon and sites stay.

    Raises
    ------
    ValueError
        There is no such device, or more than one; the spec is as it was.
    """
    if isinstance(device, str):
        remove(spec, device)
        return
    if not isinstance(device, AddedDevice):
        raise ValueError(f"device is {device!r}: give what add_device returned, or a name")
    name = new_name(device.name, device.device, devices_in(spec)) or device.name
    before, _, after = name.partition(device.name)
    made = device.tendon if device.sites else None
    remove(
        spec,
        name,
        None if made is None else before + made + after,
        [before + site + after for site in device.made],
    )


def _device(device: Device | None, values: dict[str, Any]) -> Device:
    if device is None:
        return Device(**values)
    if not isinstance(device, Device):
        raise ValueError(f"device is {device!r}: give an inerter.Device, or parameters by name")
    return device.replace(**values) if values else device


def _add(
    spec: mujoco.MjSpec,
    name: str,
    device: Device,
    sites: Sequence[_Site],
    target: str,
    gear: float,
    sensor: bool,
    is_joint: bool,
) -> None:
    """Extension, instance, sites and tendon, actuator, sensor; no default class reaches them."""
    spec.activate_plugin(PLUGIN)
    instance = spec.add_plugin(name=name, plugin_name=PLUGIN, active=True)
    instance.config = {key: str(value) for key, value in device.given.items()}
    if device.inertance == 0:
        # said, so that the plugin does not ask whether that is meant
        instance.config = {"inertance": "0", **instance.config}
    if sites:
        _add_tendon(spec, target, sites)
    actuator = blank(spec.add_actuator(name=name))
    actuator.target = target
    actuator.trntype = mujoco.mjtTrn.mjTRN_JOINT if is_joint else mujoco.mjtTrn.mjTRN_TENDON
    actuator.gear = [gear, 0, 0, 0, 0, 0]
    if device.nstate:
        actuator.actdim = device.nstate
    readers = [actuator]
    if sensor:
        readers.append(blank(spec.add_sensor(name=name)))
        readers[-1].type = mujoco.mjtSensor.mjSENS_PLUGIN
    for element in readers:
        element.plugin.plugin_name = PLUGIN
        element.plugin.name = name
        element.plugin.active = True


# --- terminals ----------------------------------------------------------------------------------


class _Site:
    """A terminal: an existing site, or one to be made at a position in a body."""

    def __init__(self, spec: mujoco.MjSpec, end: Terminal, new_name: str) -> None:
        self.body, self.position = None, np.zeros(3)
        if isinstance(end, (tuple, list)):
            self.body, self.position = _place(spec, end)
            self.name = new_name
            if spec.site(new_name) is not None:
                raise ValueError(f"a site {new_name!r} is there already; choose another name")
        else:
            # a tendon finds its sites by name
            if isinstance(end, mujoco.MjsSite) and not end.name:
                raise ValueError("a site given as a terminal has no name; name it")
            self.name = _element(spec.site, end, "site", spec.sites)

    def same_as(self, other: _Site) -> bool:
        """Whether both terminals are the same point of the same body."""
        if self.body is None or other.body is None:
            return self.name == other.name
        return self.body == other.body and bool(np.array_equal(self.position, other.position))

    def add(self, spec: mujoco.MjSpec) -> None:
        """Make the site where there is none."""
        if self.body is not None:
            blank(spec.body(self.body).add_site(name=self.name)).pos = self.position

    def __str__(self) -> str:
        if self.body is None:
            return f"site {self.name!r}"
        return f"the point {self.position.tolist()} of body {self.body!r}"


def _place(spec: mujoco.MjSpec, pair: Sequence[Any]) -> tuple[str, np.ndarray]:
    if len(pair) != 2:
        raise ValueError(f"terminal {pair!r}: give a site, or a pair (body, position)")
    body = _element(spec.body, pair[0], "body", spec.bodies)
    try:
        position = np.asarray(pair[1], dtype=float)
    except (TypeError, ValueError):
        position = np.empty(0)
    if position.shape != (3,) or not np.isfinite(position).all():
        raise ValueError(f"terminal at body {body!r}: position {pair[1]!r} is not three numbers")
    return body, position


def _add_tendon(spec: mujoco.MjSpec, name: str, sites: Sequence[_Site]) -> None:
    tendon = blank(spec.add_tendon(name=name))
    for site in sites:
        site.add(spec)
        tendon.wrap_site(site.name)


# --- names --------------------------------------------------------------------------------------


def _element(find: Callable[[str], Any], given: Any, kind: str, all_of: Sequence[Any]) -> str:
    """Name of an element of the spec, given by name or as the element."""
    if isinstance(given, str):
        if find(given) is None:
            names = [element.name for element in all_of if element.name]
            raise ValueError(f"no {kind} {given!r}{_suggestion(given, names)}")
        return given
    name = getattr(given, "name", None)
    if not isinstance(name, str):
        raise ValueError(f"{kind} is {given!r}: give a name or an element of the spec")
    if not name:
        raise ValueError(f"a {kind} given to the device has no name; name it")
    if find(name) != given:
        raise ValueError(f"{kind} {name!r} belongs to another spec; take the one of this spec")
    return name


def _joint(spec: mujoco.MjSpec, given: Any) -> str:
    name = _element(spec.joint, given, "joint", spec.joints)
    kind = spec.joint(name).type
    if kind in _FREE:
        word = "free" if kind == mujoco.mjtJoint.mjJNT_FREE else "ball"
        raise ValueError(
            f"joint {name!r} is a {word} joint; a device needs a slide or hinge joint, or two sites"
        )
    return name


def _refuse_taken_names(spec: mujoco.MjSpec, name: str, sensor: bool, tendon: bool) -> None:
    if not name:
        raise ValueError("name is empty; give the device a name")
    kinds = [("actuator", spec.actuator(name)), ("plugin instance", spec.plugin(name))]
    kinds += [("sensor", spec.sensor(name))] * sensor + [("tendon", spec.tendon(name))] * tendon
    for kind, found in kinds:
        if found is not None:
            raise ValueError(f"name {name!r} is taken by {_article(kind)}; choose another")


def _article(kind: str) -> str:
    return f"{'an' if kind[0] in 'aeiou' else 'a'} {kind}"


def _suggestion(given: str, names: Sequence[str]) -> str:
    import difflib

    close = difflib.get_close_matches(given, names, n=3)
    if close:
        return f"; did you mean {', '.join(map(repr, close))}?"
    return f"; there is {', '.join(map(repr, names[:12]))}" if names else "; there is none yet"


# --- values -------------------------------------------------------------------------------------


def _live_values(
    spec: mujoco.MjSpec, name: str, device: Device, keys: Sequence[str]
) -> dict[str, list[float]]:
    """The numerics to make: values by key."""
    if isinstance(keys, str):
        raise ValueError(f"live is {keys!r}: give a sequence of names, such as ({keys!r},)")
    found = {}
    for key in keys:
        if key not in parameters() and key not in lists():
            raise ValueError(
                f"live parameter {key!r} is not a number of a device"
                f"{_suggestion(key, [*parameters(), *lists()])}"
            )
        if spec.numeric(f"{name}.{key}") is not None:
            raise ValueError(f"a numeric {name}.{key} is there already; remove it or the live key")
        values = np.atleast_1d(getattr(device, key)).astype(float)
        if not (values.size and np.isfinite(values).all()):
            raise DeviceError(f"live parameter {key!r} has no value; state it")
        found[key] = values.tolist()
    return found


def _initial_length(
    spec: mujoco.MjSpec, sites: Sequence[_Site], target: str, is_joint: bool
) -> float:
    """Length of the tendon, or position of the joint, in the initial pose, from a copy."""
    trial = spec.copy()
    if sites:
        _add_tendon(trial, target, sites)
    try:
        model = trial.compile()
    except ValueError as error:
        text = " ".join(dict.fromkeys(str(error).split("\n"))).strip()
        needs = "a model that compiles as it is"
        if sites and _compiles(spec):
            needs = f"a line between {sites[0]} and {sites[1]}"
        raise ValueError(f'rest_length "initial" needs {needs}: {text}; or give a number') from None
    data = mujoco.MjData(model)
    if is_joint:
        return float(data.qpos[model.joint(target).qposadr[0]])
    mujoco.mj_forward(model, data)
    length = float(data.ten_length[model.tendon(target).id])
    if sites and length == 0:
        raise ValueError(
            "both terminals are at the same place in the initial pose: a line between them has no "
            "direction; move one of them"
        )
    return length


def _compiles(spec: mujoco.MjSpec) -> bool:
    try:
        spec.copy().compile()
    except ValueError:
        return False
    return True
