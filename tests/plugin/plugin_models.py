"""Models and truths that the plugin's tests share.

Everything here is written from the equations: neither the C core nor `inerter.reference` takes part
in the truths.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

# MuJoCo 3 turns free bodies in second order under RK4, also without a device
ENGINE = tuple(int(number) for number in mujoco.mj_versionString().split(".")[:3])
RK4_TURNS = ENGINE >= (4,)

INTEGRATORS = ("Euler", "implicit", "implicitfast", "discrete", "RK4")

# quarter-car of Wang & Su 2008; strut of middling stiffness
SPRUNG, UNSPRUNG, TYRE = 181.75, 25.0, 120e3
STRUT, DAMPER, INERTANCE = 60e3, 1500.0, 113.0

# one device per friction law; levels that matter beside the damper's force
FRICTION: dict[str, dict[str, float]] = {
    "none": {},
    "coulomb": {"coulomb_force": 100, "transition_velocity": 2e-2},
    "stribeck": {
        "coulomb_force": 80, "static_force": 120, "stribeck_velocity": 0.05,
        "transition_velocity": 2e-2,
    },
    "dahl": {"coulomb_force": 100, "bristle_stiffness": 5e4},
    "lugre": {
        "coulomb_force": 80, "static_force": 120, "stribeck_velocity": 0.05,
        "bristle_stiffness": 5e4, "bristle_damping": 200,
    },
    "bouc_wen": {
        "bw_alpha": 1, "bw_beta": 300, "bw_gamma": 200, "bw_exponent": 1, "bw_stiffness": 5e4,
        "bw_ratio": 0.2,
    },
    "brown_mcphee": {"coulomb_force": 80, "static_force": 120, "stribeck_velocity": 0.05},
}  # fmt: skip


def plugin_actuator(
    keys: Mapping[str, float | str], target: str = 'tendon="strut"', name: str = "strut",
    attributes: str = "",
) -> str:  # fmt: skip
    """An actuator that carries a device; `actdim` follows the friction law."""
    states = int(keys.get("friction") in ("dahl", "lugre", "bouc_wen"))
    config = "".join(f'<config key="{key}" value="{value}"/>' for key, value in keys.items())
    if "actdim" not in attributes and states:
        attributes += f' actdim="{states}"'
    return f'<plugin name="{name}" plugin="inerter.device" {target} {attributes}>{config}</plugin>'


def instance_actuator(
    keys: Mapping[str, float | str], target: str = 'tendon="strut"', name: str = "strut"
) -> tuple[str, str, str]:
    """A device that a sensor reads: the texts for extension, actuator and sensor."""
    states = int(keys.get("friction") in ("dahl", "lugre", "bouc_wen", "rate_state"))
    config = "".join(f'<config key="{key}" value="{value}"/>' for key, value in keys.items())
    actdim = f' actdim="{states}"' if states else ""
    return (
        f'<instance name="{name}">{config}</instance>',
        f'<plugin name="{name}" instance="{name}" plugin="inerter.device" {target}{actdim}/>',
        f'<plugin name="{name}" instance="{name}" plugin="inerter.device"/>',
    )


def quarter_car_xml(
    actuator: str, *, option: str = "", instance: str = "", sensor: str = "",
    stiffness: float = STRUT, damping: float = DAMPER, tendon: str = "", extra: str = "",
) -> str:  # fmt: skip
    """The quarter-car with the sprung body nested in the unsprung one.

    Joint `wheel` is zu, joint `travel` is zs - zu; the tendon `strut` is the travel.
    """
    return f"""
<mujoco>
  <extension><plugin plugin="inerter.device">{instance}</plugin></extension>
  <option gravity="0 0 0" {option}/>
  <worldbody>
    <body name="unsprung">
      <joint name="wheel" type="slide" axis="0 0 1" stiffness="{TYRE}"/>
      <geom name="wheel" size="0.1" mass="{UNSPRUNG}" contype="0" conaffinity="0"/>
      <body name="sprung" pos="0 0 0.5">
        <joint name="travel" type="slide" axis="0 0 1"/>
        <geom name="body" size="0.1" mass="{SPRUNG}" contype="0" conaffinity="0"/>
      </body>
    </body>
  </worldbody>
  <tendon>
    <fixed name="strut" stiffness="{stiffness}" damping="{damping}" {tendon}>
      <joint joint="travel" coef="1"/>
    </fixed>
  </tendon>
  <actuator>{actuator}</actuator>
  <sensor>{sensor}</sensor>
  {extra}
</mujoco>"""


def simulate(
    model: mujoco.MjModel, duration: float, every: int = 1, start: float = 0.3
) -> NDArray[np.float64]:
    """Rows (qpos, qvel, act) every so many steps; wheel and travel start as after a kerb."""
    data = mujoco.MjData(model)
    data.qvel[:2] = start, -start
    rows = [np.concatenate([data.qpos, data.qvel, data.act])]
    for i in range(1, round(duration / model.opt.timestep) + 1):
        mujoco.mj_step(model, data)
        if i % every == 0:
            rows.append(np.concatenate([data.qpos, data.qvel, data.act]))
    return np.array(rows)


# --------------------------- friction laws from the equations -------------------------------------


@dataclass
class Law:
    """A friction law by its equations; `p` its parameters."""

    name: str
    p: Mapping[str, float] = field(default_factory=dict)

    def stribeck(self, v: float) -> float:
        p = self.p
        excess = p["static_force"] - p["coulomb_force"]
        return p["coulomb_force"] + excess * np.exp(-((v / p["stribeck_velocity"]) ** 2))

    def rate(self, v: float, z: float) -> float:
        p = self.p
        if self.name == "dahl":
            return v - p["bristle_stiffness"] * abs(v) * z / p["coulomb_force"]
        if self.name == "lugre":
            return v - p["bristle_stiffness"] * abs(v) * z / self.stribeck(v)
        if self.name == "bouc_wen":
            return p["bw_alpha"] * v - p["bw_beta"] * abs(v) * z - p["bw_gamma"] * v * abs(z)
        return 0.0

    def force(self, x: float, v: float, z: float) -> float:
        p = self.p
        if self.name == "coulomb":
            return p["coulomb_force"] * np.tanh(v / p["transition_velocity"])
        if self.name == "stribeck":
            return self.stribeck(v) * np.tanh(v / p["transition_velocity"])
        if self.name == "dahl":
            return p["bristle_stiffness"] * z
        if self.name == "lugre":
            return p["bristle_stiffness"] * z + p["bristle_damping"] * self.rate(v, z)
        if self.name == "bouc_wen":
            share = p["bw_ratio"]
            return p["bw_stiffness"] * (share * x + (1 - share) * z)
        if self.name == "brown_mcphee":
            r = v / p["stribeck_velocity"]
            peak = (p["static_force"] - p["coulomb_force"]) * r / (r * r / 4 + 0.75) ** 2
            return p["coulomb_force"] * np.tanh(4 * r) + peak
        return 0.0


def quarter_car_truth(
    law: Law, times: NDArray, *, inertance: float = INERTANCE, load: float = 0.0,
    width: float = 1e-4, gradient: float = 0.0, curvature: float = 0.0, start: float = 0.3,
) -> NDArray[np.float64]:  # fmt: skip
    """Rows (zu, x, zu', x', z) at the times, by an adaptive implicit integration.

    m_u zu'' = u - k_t zu,  m_s (zu'' + x'') = -u,  u = k x + c v + F + N + mu |N| sign(v)
    N = B x'' + B' v^2 / 2,  B = b (1 + gradient x + curvature x^2)
    """
    w = 1 / SPRUNG + 1 / UNSPRUNG

    def slope(_: float, y: NDArray[np.float64]) -> list[float]:
        zu, x, vu, v, z = y
        rest = STRUT * x + DAMPER * v + law.force(x, v, z)
        varying = inertance * (1 + gradient * x + curvature * x * x)
        rate = inertance * (gradient + 2 * curvature * x) * v * v / 2
        # x'' = free - w (N + mu |N| t), which is linear once the sign of N is known
        free = TYRE * zu / UNSPRUNG - w * rest
        n = (varying * free + rate) / (1 + w * varying)
        share = 1 + load * np.tanh(v / width) * np.sign(n)
        n = (varying * free + rate) / (1 + w * varying * share)
        a = free - w * share * n
        u = rest + share * n
        return [vu, v, (u - TYRE * zu) / UNSPRUNG, a, law.rate(v, z)]

    result = solve_ivp(
        slope, (times[0], times[-1]), [0, 0, start, -start, 0], method="Radau", t_eval=times,
        rtol=1e-10, atol=1e-13,
    )  # fmt: skip
    return result.y.T
