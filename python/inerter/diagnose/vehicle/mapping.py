"""Which column of a record drives which actuator, and which one a sensor is compared with."""

from __future__ import annotations

import difflib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import mujoco

from inerter.device_in_model import devices_of, sensor_names
from inerter.diagnose.vehicle.inputs import AXES, MOCAP, mocap_bodies

_SENSOR = mujoco.mjtSensor
ACCELEROMETERS = (
    int(_SENSOR.mjSENS_ACCELEROMETER),
    int(_SENSOR.mjSENS_FRAMELINACC),
    int(_SENSOR.mjSENS_FRAMEANGACC),
)
# lengths, which records count from another place than models do
LENGTHS = (int(_SENSOR.mjSENS_TENDONPOS), int(_SENSOR.mjSENS_ACTUATORPOS))
PLACES = (int(_SENSOR.mjSENS_FRAMEPOS), int(_SENSOR.mjSENS_RANGEFINDER))
# load cells, whose zero has whatever hangs on them at rest
CELLS = (int(_SENSOR.mjSENS_FORCE), int(_SENSOR.mjSENS_TORQUE))
VEHICLE_INPUT = "road"
SPEED = "speed"
"""Column of the vehicle's speed [m/s], by which a tyre's patch is told in metres."""
VEHICLE_OUTPUTS = ("body_acceleration", "wheel_acceleration", "suspension_travel", "tyre_force")


class MappingError(ValueError):
    """Columns that cannot be brought together with a model; one line."""


@dataclass(frozen=True)
class Output:
    """A column, the sensor it is compared with and the component of that sensor.

    floating: nobody knows its zero (accelerometers, lengths, places, load cells); load: a tyre's
    force, whose static part is unknown.
    """

    column: str
    sensor: str
    component: int
    floating: bool
    load: bool = False


@dataclass(frozen=True)
class Channels:
    """inputs: by column the actuator, or "mocap:BODY.AXIS"; outputs: in the order of the record's
    columns; unused: columns that neither drive nor are compared; speed: the column of the
    vehicle's speed, "" where there is none.
    """

    inputs: Mapping[str, str]
    outputs: tuple[Output, ...]
    unused: tuple[str, ...] = ()
    speed: str = ""

    def spaced(self, spacing: float) -> dict[str, float]:
        """Time between samples by compared column [s]."""
        return {output.column: spacing for output in self.outputs}

    def shaken(self, model: mujoco.MjModel) -> tuple[str, ...]:
        """Columns of accelerometers, whose brackets may swing."""
        kinds = {o.column: int(model.sensor(o.sensor).type[0]) for o in self.outputs}
        return tuple(column for column, kind in kinds.items() if kind in ACCELEROMETERS)

    @property
    def used(self) -> tuple[str, ...]:
        """Every column that a diagnosis reads."""
        speed = (self.speed,) if self.speed else ()
        return (*self.inputs, *(output.column for output in self.outputs), *speed)


def read_options(options: Sequence[str], name: str) -> dict[str, str]:
    """COLUMN=NAME options as a mapping.

    Raises
    ------
    MappingError
        An option without "=", or a column given twice.
    """
    found: dict[str, str] = {}
    for option in options:
        column, sign, target = option.partition("=")
        if not (sign and column.strip() and target.strip()):
            raise MappingError(f"--{name} {option}: write COLUMN=NAME, such as road=road")
        if column.strip() in found:
            raise MappingError(f"--{name} {option}: column {column.strip()!r} is given twice")
        found[column.strip()] = target.strip()
    return found


def map_columns(
    model: mujoco.MjModel,
    columns: Sequence[str],
    inputs: Mapping[str, str],
    sensors: Mapping[str, str],
) -> Channels:
    """Bring columns and model together.

    Parameters
    ----------
    model : MjModel
        The user's model.
    columns : sequence of str
        Of the records, without time.
    inputs, sensors : mapping
        Actuator (or mocap body, "NAME" along z or "NAME.x") and sensor by column, as the user gave
        them; sensor "NAME.z" is a component.
        What is not given goes by equal names, and by kind where a kind is there once.

    Raises
    ------
    MappingError
        Nothing to drive or nothing to compare, or a name that is not there; says what there is.
    """
    names = _Names(model, columns)
    for option, given in (("input", inputs), ("sensor", sensors)):
        for column in given:
            if column not in columns:
                raise names.error(f"--{option} {column}={given[column]}: no column {column!r}")
    driven = {column: names.target(column, name) for column, name in inputs.items()}
    for column in columns:
        if column in sensors or column in driven:
            continue
        if column in names.actuators:
            driven[column] = column
        elif column in names.mocaps:
            driven[column] = f"{MOCAP}{column}.z"
        elif column == VEHICLE_INPUT and (only := names.only_road):
            driven[column] = only
    if len(set(driven.values())) < len(driven):
        raise names.error("two columns drive one actuator or mocap body")
    if not driven:
        raise names.error("no column drives an actuator or a mocap body")
    outputs = []
    for column in columns:
        if column in driven:
            continue
        sensor = sensors.get(column) or names.sensor_like(column)
        if sensor is not None:
            outputs.append(names.output(column, sensor, column in sensors))
    if not outputs:
        raise names.error("no column is compared with a sensor")
    used = {*driven, *(output.column for output in outputs)}
    speed = SPEED if SPEED in columns and SPEED not in used else ""
    unused = tuple(c for c in columns if c not in used and c != speed)
    return Channels(driven, tuple(outputs), unused, speed)


class _Names:
    """What can be mapped in a model, and the one error about it."""

    def __init__(self, model: mujoco.MjModel, columns: Sequence[str]) -> None:
        self.model, self.columns = model, columns
        devices = {d.actuator for d in devices_of(model)}
        all_actuators = [model.actuator(i).name for i in range(model.nactuator)]
        self.actuators = [name for name in all_actuators if name]
        affine = mujoco.mjtBias.mjBIAS_AFFINE
        self.positions = [
            name
            for i, name in enumerate(all_actuators)
            if name and i not in devices and model.actuator_biastype[i] == affine
        ]
        self.bodies = [model.body(i).name for i in range(model.nbody)]
        self.mocaps = [model.body(body).name for body in mocap_bodies(model)]
        self.sensors = [model.sensor(i).name for i in range(model.nsensor)]
        self.driven = {i: name in self.positions for i, name in enumerate(all_actuators)}
        self.devices = {d.instance: d for d in devices_of(model)}

    def error(self, what: str) -> MappingError:
        return MappingError(
            f"{what}; columns: {', '.join(self.columns) or 'none'}; actuators: "
            f"{', '.join(self.actuators) or 'none'}; mocap bodies: "
            f"{', '.join(filter(None, self.mocaps)) or 'none'}; sensors: "
            f"{', '.join(filter(None, self.sensors)) or 'none'}; map them with "
            "--input COLUMN=ACTUATOR, --input COLUMN=BODY.z and --sensor COLUMN=SENSOR"
        )

    def target(self, column: str, name: str) -> str:
        """The input of a name: an actuator, or an axis of a mocap body."""
        if name in self.actuators:
            return name
        body, dot, axis = name.rpartition(".")
        if not dot or name in self.mocaps:
            body, axis = name, "z"
        if body in self.mocaps:
            if axis not in AXES:
                raise self.error(f"--input {column}={name}: write .x, .y or .z after {body}")
            return f"{MOCAP}{body}.{axis}"
        close = difflib.get_close_matches(name, [*self.actuators, *self.mocaps], n=1)
        hint = f" (did you mean {close[0]!r}?)" if close else ""
        fixed = " (that body is not one of mocap)" if body in self.bodies else ""
        raise self.error(
            f"--input {column}={name}: no actuator {name!r} in the model, nor a mocap body"
            f"{hint or fixed}"
        )

    @property
    def only_road(self) -> str:
        """The one input that can be a road; "" where there are several, or none."""
        if len(self.positions) == 1:
            return self.positions[0]
        return f"{MOCAP}{self.mocaps[0]}.z" if not self.positions and len(self.mocaps) == 1 else ""

    def sensor_like(self, column: str) -> str | None:
        """The sensor of a column's name, or the only one of its kind."""
        if column in self.sensors:
            return column
        if column not in VEHICLE_OUTPUTS:
            return None
        kinds = {
            "suspension_travel": LENGTHS,
            "tyre_force": (int(_SENSOR.mjSENS_ACTUATORFRC),),
            "body_acceleration": ACCELEROMETERS[:2],
            "wheel_acceleration": (),
        }[column]
        same = [self.sensors[i] for i in range(self.model.nsensor)
                if self.sensors[i] and int(self.model.sensor_type[i]) in kinds]  # fmt: skip
        return same[0] if len(same) == 1 else None

    def output(self, column: str, wanted: str, given: bool) -> Output:
        name, dot, part = wanted.rpartition(".")
        if wanted in self.sensors or not dot:
            name, part = wanted, ""
        if name not in self.sensors:
            raise self.error(f"--sensor {column}={wanted}: no sensor {name!r} in the model")
        index = self.sensors.index(name)
        size, kind = int(self.model.sensor_dim[index]), int(self.model.sensor_type[index])
        # under gravity a model's travel counts from its design, a record's from standing still
        sags = column == "suspension_travel" and bool(self.model.opt.gravity.any())
        floating = kind in (*ACCELEROMETERS, *LENGTHS, *PLACES, *CELLS) or sags
        if kind == _SENSOR.mjSENS_JOINTPOS:
            # the zero of an angle is told by gravity, that of a slide by nothing
            joint = int(self.model.sensor_objid[index])
            slides = int(self.model.jnt_type[joint]) == mujoco.mjtJoint.mjJNT_SLIDE
            floating = sags or (slides and column not in VEHICLE_OUTPUTS)
        component = self._component(column, wanted, index, part, size, given)
        # the static load of a tyre is not in a model without gravity
        of = int(self.model.sensor_objid[index])
        load = bool(kind == _SENSOR.mjSENS_ACTUATORFRC and self.driven.get(of, False))
        return Output(column, name, component, floating, load)

    def _component(
        self, column: str, wanted: str, index: int, part: str, size: int, given: bool
    ) -> int:
        if self.model.sensor_type[index] == _SENSOR.mjSENS_PLUGIN:
            device = self.devices.get(int(self.model.sensor_plugin[index]))
            shown = sensor_names(device.device) if device else ()
            if not part and shown:
                return 0
            if part in shown:
                return shown.index(part)
            if part.isdigit() and int(part) < size:
                return int(part)
            raise self.error(f"--sensor {column}={wanted}: write one of {', '.join(shown)} "
                             "after the dot")  # fmt: skip
        if part in AXES and AXES.index(part) < size:
            return AXES.index(part)
        if part.isdigit() and int(part) < size:
            return int(part)
        if part or (size > 1 and given and column not in VEHICLE_OUTPUTS):
            raise self.error(f"--sensor {column}={wanted}: the sensor has {size} components, "
                             "write .x, .y or .z after its name")  # fmt: skip
        # up, for a vehicle
        return 2 if size == 3 else 0
