"""The rig in MuJoCo: many parameter sets through many sweeps in one batch.

The model is `fluid_inerter/model_charge.xml`, whose RK4 keeps its order; the dry rig is the same
without water. Parameters that a fit varies are live: a `numeric` named after the device holds each,
and every simulation of the batch has its own values.
The load cell between armature and piston is worked out from the states at the sample, the device's
force by its own laws:
    F = m_p x'' + F_device,   (m_a + m_p) x'' = alpha_1 q' - c x' - k x - F_device
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import mujoco
import numpy as np
from numpy.typing import NDArray

from inerter.core import parameters
from inerter.device_in_model import device_of
from inerter.engine_batch import batch
from inerter.model_parameters import FLUID_INERTER, SHAKER
from inerter.models import model_path
from inerter.plugin import load_plugin
from inerter.studies.fluid_rig.signals import Signals
from inerter.studies.fluid_rig.sweeps import Sweep

Array = NDArray[np.float64]
Values = Mapping[str, float]
Configuration = Literal["dry", "complete"]

DEVICE = "device"
_DRY_KEYS = ("friction", "coulomb_force", "static_force", "stribeck_velocity", "viscous")
# simulations in one call: what bounds the memory
_AT_ONCE = 64
_CHUNK = 2.0


@dataclass(frozen=True)
class Rig:
    """The rig in one configuration.

    configuration: "dry" or "complete". live: names of the device's parameters that vary. rate:
    samples per second of the records. step: time step [s]; the sample interval is a multiple.
    threads: of the batch, 0 for one per processor.
    """

    configuration: Configuration
    live: tuple[str, ...]
    rate: float = 200.0
    step: float = 5e-4
    threads: int = 0

    def __post_init__(self) -> None:
        multiple = 1 / (self.rate * self.step)
        if abs(multiple - round(multiple)) > 1e-6 or round(multiple) < 1:
            raise ValueError(
                f"step: {self.step:g} s does not divide the sample interval {1 / self.rate:g} s; "
                "choose another step or rate"
            )
        unknown = [name for name in self.live if name not in parameters()]
        if unknown:
            raise ValueError(
                f"live: {unknown[0]!r} is no parameter of a device; see `inerter parameters`"
            )

    @cached_property
    def model(self) -> mujoco.MjModel:
        """The compiled model; its live parameters are numerics `device.<name>`."""
        load_plugin()
        spec = mujoco.MjSpec.from_file(str(model_path("fluid_inerter", "model_charge.xml")))
        instance = spec.plugin(DEVICE)
        config = dict(instance.config)
        if self.configuration == "dry":
            config = {"inertance": "0"} | {key: config[key] for key in _DRY_KEYS}
            instance.config = config
            spec.actuator(DEVICE).actdim = -1
        # energies and forces of the sensors are not needed
        for sensor in list(spec.sensors):
            spec.delete(sensor)
        for name in self.live:
            value = float(config.get(name, parameters()[name].initial))
            spec.add_numeric(name=f"{DEVICE}.{name}", data=[value], size=1)
        spec.option.timestep = self.step
        return spec.compile()

    def simulate(self, tests: Sequence[tuple[Sweep, Values]]) -> list[Signals | None]:
        """Signals of tests, each with its values of the live parameters, in their order.

        A parameter that a test does not state has the model's value. None where a simulation did
        not reach its end.

        Raises
        ------
        mujoco.batch.SimulationError
            A value that the device does not allow.
        """
        # the same test with the same values once only
        keys = [(sweep, tuple(sorted(values.items()))) for sweep, values in tests]
        different = list(dict.fromkeys(keys))
        found: dict[object, Signals | None] = {}
        for duration in {sweep.duration for sweep, _ in different}:
            group = [key for key in different if key[0].duration == duration]
            for first in range(0, len(group), _AT_ONCE):
                part = group[first : first + _AT_ONCE]
                found |= zip(part, self._run(part), strict=True)
        return [found[key] for key in keys]

    def _run(
        self, tests: Sequence[tuple[Sweep, tuple[tuple[str, float], ...]]]
    ) -> list[Signals | None]:
        """Signals of tests of one duration."""
        model, count = self.model, len(tests)
        runs = batch.Batch(model, count, self.threads)
        if self.live:
            held = runs.expand("numeric_data")
            for row, (_, values) in zip(held, tests, strict=True):
                for name, value in values:
                    row[model.numeric(f"{DEVICE}.{name}").adr[0]] = value
        runs.reset(keyframe=0)

        every = round(1 / (self.rate * self.step))
        samples = round(tests[0][0].duration * self.rate)
        steps = (samples - 1) * every
        piston, charge = model.joint("piston"), model.joint("charge")
        coil = model.actuator("coil").id

        # at time 0 all is at rest
        x, v, current = (np.zeros((count, samples)) for _ in range(3))
        states = np.zeros((count, samples, model.na))
        farthest = np.zeros(count)
        chunk = every * round(_CHUNK * self.rate)
        for begin in range(0, steps, chunk):
            number = min(chunk, steps - begin)
            middle = np.asarray((begin + np.arange(number) + 0.5) * self.step, dtype=np.float64)
            control = np.zeros((count, number, model.nu))
            for row, (sweep, _) in zip(control, tests, strict=True):
                row[:, coil] = SHAKER.gain * sweep.voltage(middle)
            record = runs.rollout(
                number, control, int(mujoco.mjtState.mjSTATE_CTRL), ("qpos", "qvel", "act")
            )
            # row r is the state after step r
            there = slice(begin // every + 1, (begin + number) // every + 1)
            position, velocity = record["qpos"], record["qvel"]
            x[:, there] = position[:, every - 1 :: every, piston.qposadr[0]]
            v[:, there] = velocity[:, every - 1 :: every, piston.dofadr[0]]
            current[:, there] = velocity[:, every - 1 :: every, charge.dofadr[0]]
            states[:, there] = record["act"][:, every - 1 :: every]
            if model.na:
                water = np.abs(position[..., piston.qposadr[0]] - record["act"][..., 0])
                farthest = np.maximum(farthest, water.max(axis=1))
        reached = np.array(runs.bind("time")).ravel() > (steps - 0.5) * self.step
        good = reached & np.isfinite(x).all(axis=1) & np.isfinite(v).all(axis=1)
        return [
            self._signals(dict(values), x[n], v[n], current[n], states[n], float(farthest[n]))
            if good[n]
            else None
            for n, (_, values) in enumerate(tests)
        ]

    def _signals(
        self, values: Values, x: Array, v: Array, current: Array, states: Array, farthest: float
    ) -> Signals:
        """Displacement and load cell from the states of one test."""
        device = device_of(self.model, DEVICE).device.replace(**values)
        pull = device.evaluate(x, v, np.zeros_like(x), states if states.shape[1] else 0.0)["total"]
        shaker = SHAKER.force_constant * current - SHAKER.damping * v - SHAKER.stiffness * x
        a = (shaker - pull) / (SHAKER.armature_mass + FLUID_INERTER.piston_mass)
        return Signals(self.rate, x, FLUID_INERTER.piston_mass * a + pull, farthest)
