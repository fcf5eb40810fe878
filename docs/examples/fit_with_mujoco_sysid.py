"""One record, two ways to the parameters of a LuGre device: mujoco.sysid and inerter.identify.

A device between ground and a light carriage is driven by a measured force; the carriage's position
is measured. mujoco.sysid simulates the model from the force and fits what the sensor shows; its
modifier writes the plugin's configuration into the MjSpec. inerter.identify runs the device's law
along the measured motion and fits the force.

Needs `pip install "inerter[lab]" "mujoco[sysid]"`.
"""

from __future__ import annotations

import logging
import time

import mujoco
import numpy as np
from inerter import load_plugin
from inerter.identify.estimate import identify
from inerter.identify.fit import Problem
from inerter.identify.model import Model
from inerter.identify.runs import thin
from inerter.records import Record
from inerter.records.preparation import prepare
from mujoco import rollout, sysid

TRUTH = {
    "inertance": 60.0,
    "viscous": 150.0,
    "coulomb_force": 20.0,
    "static_force": 28.0,
    "stribeck_velocity": 0.02,
    "bristle_stiffness": 2e4,
    "bristle_damping": 200.0,
}
CARRIAGE = 1e-3  # kg: the force of the drive is that of the device
STEP = 1e-3
SECONDS = 10.0

MODEL = """
<mujoco model="bench">
  <extension><plugin plugin="inerter.device"/></extension>
  <option timestep="{step}" integrator="RK4" gravity="0 0 0"><flag contact="disable"/></option>
  <worldbody>
    <body name="carriage">
      <joint name="carriage" type="slide" axis="1 0 0"/>
      <inertial pos="0 0 0" mass="{carriage}" diaginertia="1e-6 1e-6 1e-6"/>
    </body>
  </worldbody>
  <actuator>
    <motor name="drive" joint="carriage"/>
    <plugin name="strut" plugin="inerter.device" joint="carriage" actdim="1">
      <config key="friction" value="lugre"/>
      {config}
    </plugin>
  </actuator>
  <sensor><jointpos name="position" joint="carriage"/></sensor>
</mujoco>
"""


def bench(values: dict[str, float]) -> mujoco.MjSpec:
    """The bench with a device."""
    load_plugin()
    config = "".join(f'<config key="{k}" value="{v}"/>' for k, v in values.items())
    return mujoco.MjSpec.from_string(MODEL.format(step=STEP, carriage=CARRIAGE, config=config))


def measured(seed: int = 0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Time, force and noisy position of the true device under a sum of sines."""
    t = STEP * np.arange(round(SECONDS / STEP))
    force = 90 * np.sin(2 * np.pi * 0.7 * t) + 60 * np.sin(2 * np.pi * 2.3 * t + 1.0)
    force *= np.minimum(t / 0.5, 1.0)
    model = bench(TRUTH).compile()
    data = mujoco.MjData(model)
    start = sysid.create_initial_state(model, data.qpos, data.qvel, data.act)
    control = np.column_stack([force, np.zeros_like(force)])
    states, _ = rollout.rollout(model, data, start, control[:-1])
    position = np.concatenate([[0.0], states[0, :, 1]])
    random = np.random.default_rng(seed)
    return t, force, position + 1e-7 * random.standard_normal(t.size)


def record_of(t: np.ndarray, force: np.ndarray, position: np.ndarray) -> Record:
    """What a bench would store."""
    # the drive holds its force over a step: at an instant it is between two of them
    at_instant = 0.5 * (force + np.concatenate([[0.0], force[:-1]]))
    return Record(name="bench", time=t, displacement=position, force=at_instant)


def device_of(point: np.ndarray) -> dict[str, float]:
    """Parameters from logarithms; static_force as what it is above coulomb_force."""
    values = dict(zip(TRUTH, np.exp(point).tolist(), strict=True))
    values["static_force"] += values["coulomb_force"]
    return values


def point_of(values: dict[str, float]) -> np.ndarray:
    """The logarithms that `device_of` takes."""
    excess = values["static_force"] - values["coulomb_force"]
    return np.log([*({**values, "static_force": excess}).values()])


def start_values() -> dict[str, float]:
    """Where fits begin: off by a third, up and down in turn."""
    point = point_of(TRUTH)
    return device_of(point + np.log(1.3) * np.where(np.arange(point.size) % 2, -1, 1))


def write(spec: mujoco.MjSpec, parameter: sysid.Parameter) -> None:
    """The device of a parameter vector into the spec."""
    values = {key: repr(value) for key, value in device_of(parameter.value).items()}
    spec.actuator("strut").plugin.config = {"friction": "lugre", **values}


def by_sysid(t: np.ndarray, force: np.ndarray, position: np.ndarray) -> dict[str, float]:
    """Parameters as mujoco.sysid finds them, from values that are off by a third."""
    truth = point_of(TRUTH)
    spec = bench(TRUTH)
    model = spec.compile()
    data = mujoco.MjData(model)
    begin = sysid.create_initial_state(model, data.qpos, data.qvel, data.act)
    device = sysid.Parameter("device", truth, truth - 1.5, truth + 1.5, modifier=write)
    device.value[:] = point_of(start_values())
    parameters = sysid.ParameterDict({"device": device})
    control = sysid.TimeSeries(t, np.column_stack([force, np.zeros_like(force)]))
    # after a step, a rollout has the sensors of the step's beginning
    sensors = sysid.TimeSeries.from_names(t[1:], position[:-1, None], model)
    sequences = sysid.ModelSequences("bench", spec, "run", begin, control, sensors)
    found, _ = sysid.optimize(
        initial_params=parameters,
        residual_fn=sysid.build_residual_fn(models_sequences=[sequences]),
        optimizer="mujoco",
        verbose=False,
    )
    return device_of(found["device"].value)


def by_one_fit(record: Record, guess: dict[str, float]) -> dict[str, float]:
    """One fit of the force along the motion, from the start that mujoco.sysid has."""
    runs = [thin(motion) for motion in prepare([record]).motions]
    problem = Problem(runs, [np.ones(run.force.size, bool) for run in runs])
    start = {**guess, "static_excess": guess["static_force"] - guess["coulomb_force"]}
    start["presliding"] = guess["coulomb_force"] / start.pop("bristle_stiffness")
    del start["static_force"]
    fit = problem.fit(Model("lugre", start, tuple(start)), 100)
    return {key: float(getattr(fit.model.device(), key)) for key in TRUTH}


if __name__ == "__main__":
    logging.disable(logging.INFO)
    t, force, position = measured()
    begin = time.perf_counter()
    one = by_sysid(t, force, position)
    between = time.perf_counter()
    record = record_of(t, force, position)
    single = by_one_fit(record, start_values())
    after = time.perf_counter()
    other = identify([record], ["lugre"]).best
    end = time.perf_counter()
    print(f"{'':20}{'truth':>12}{'mujoco.sysid':>14}{'one fit':>12}{'identify':>12}")
    for key, value in TRUTH.items():
        found = (one[key], single[key], other.parameters[key].value)
        print(f"{key:20}{value:12.5g}{found[0]:14.5g}{found[1]:12.5g}{found[2]:12.5g}")
    seconds = (between - begin, after - between, end - after)
    print(f"{'seconds':20}{'':12}{seconds[0]:14.2f}{seconds[1]:12.2f}{seconds[2]:12.2f}")
