"""What one step of a quarter-car costs, with the device made in different ways.

Rounds go through all variants in turn, so that a slow moment of the machine meets each of them
alike; a variant's cost is the median over the rounds, a ratio the median of the ratios within
rounds.

    python benchmarks/step_cost.py [--quick] [--json FILE]
"""

from __future__ import annotations

import argparse
import json
import statistics
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import inerter
import mujoco
import numpy as np

INTEGRATORS = ("Euler", "implicitfast", "discrete", "RK4")
LUGRE = {
    "bristle_stiffness": 5e4, "bristle_damping": 200.0, "coulomb_force": 80.0,
    "static_force": 120.0, "stribeck_velocity": 0.05,
}  # fmt: skip

MODEL = """
<mujoco>
  <extension><plugin plugin="inerter.device">{instance}</plugin></extension>
  <option timestep="1e-3" gravity="0 0 0" integrator="{integrator}"/>
  <worldbody>
    <body>
      <joint name="wheel" type="slide" axis="0 0 1" stiffness="120e3"/>
      <geom size="0.1" mass="25" contype="0" conaffinity="0"/>
      <body>
        <joint name="travel" type="slide" axis="0 0 1"/>
        <geom size="0.1" mass="181.75" contype="0" conaffinity="0"/>
      </body>
    </body>
  </worldbody>
  <tendon>
    <fixed name="strut" stiffness="60e3" damping="500"><joint joint="travel" coef="1"/></fixed>
  </tendon>
  <actuator>{actuator}</actuator>
  <sensor>{sensor}</sensor>
</mujoco>"""

# the same masses as siblings of the world: an inertance between two branches of the tree
SIBLINGS = MODEL.replace(
    """      <body>
        <joint name="travel" type="slide" axis="0 0 1"/>
        <geom size="0.1" mass="181.75" contype="0" conaffinity="0"/>
      </body>
    </body>
""",
    """    </body>
    <body>
      <joint name="body" type="slide" axis="0 0 1"/>
      <geom size="0.1" mass="181.75" contype="0" conaffinity="0"/>
    </body>
""",
).replace(
    '<joint joint="travel" coef="1"/>',
    '<joint joint="body" coef="1"/><joint joint="wheel" coef="-1"/>',
)

_CONFIG = "".join(f'<config key="{key}" value="{value}"/>' for key, value in LUGRE.items())
_IDEAL = '<config key="inertance" value="113"/>'
_LUGRE = f'{_IDEAL}<config key="friction" value="lugre"/>{_CONFIG}'
_COULOMB = (
    f'{_IDEAL}<config key="friction" value="coulomb"/><config key="coulomb_force" value="80"/>'
    '<config key="transition_velocity" value="0.02"/>'
)
_SERIES = (
    f'{_IDEAL}<config key="series_stiffness" value="1e6"/>'
    '<config key="series_damping" value="3200"/>'
)
_PLUGIN = '<plugin name="strut" plugin="inerter.device" tendon="strut"'

# name: (actuator, what it is compared with)
VARIANTS: dict[str, tuple[str, str | None]] = {
    "no device": ("", None),
    "native armature": ('<general tendon="strut" gainprm="0" armature="113"/>', "no device"),
    "plugin, ideal": (f"{_PLUGIN}>{_IDEAL}</plugin>", "native armature"),
    "native LuGre": (
        '<dcmotor tendon="strut" input="none" motorconst="0 0" resistance="1" armature="113" '
        'lugre="5e4 200 80 120 0.05"/>',
        "native armature",
    ),
    "plugin, LuGre": (f'{_PLUGIN} actdim="1">{_LUGRE}</plugin>', "native LuGre"),
    "plugin, LuGre, sensor": ("instance", "native LuGre"),
    "plugin, Coulomb": (f"{_PLUGIN}>{_COULOMB}</plugin>", "native armature"),
    "plugin, series element": (f'{_PLUGIN} actdim="2">{_SERIES}</plugin>', "native armature"),
    "siblings, no device": ("", "no device"),
    "siblings, ideal": (f"{_PLUGIN}>{_IDEAL}</plugin>", "native armature"),
    "siblings, LuGre": (f'{_PLUGIN} actdim="1">{_LUGRE}</plugin>', "native LuGre"),
    "siblings, series element": (f'{_PLUGIN} actdim="2">{_SERIES}</plugin>', "native armature"),
    "Python callback, LuGre": (
        '<general tendon="strut" gainprm="0" armature="113"/>',
        "plugin, LuGre",
    ),
}


def _model(actuator: str, integrator: str, siblings: bool) -> mujoco.MjModel:
    instance = sensor = ""
    if actuator == "instance":
        instance = f'<instance name="strut">{_LUGRE}</instance>'
        actuator = f'{_PLUGIN} instance="strut" actdim="1"/>'
        sensor = '<plugin name="strut" plugin="inerter.device" instance="strut"/>'
    return mujoco.MjModel.from_xml_string(
        (SIBLINGS if siblings else MODEL).format(
            instance=instance, actuator=actuator, sensor=sensor, integrator=integrator
        )
    )


def _callback() -> Callable[[mujoco.MjModel, mujoco.MjData], None]:
    """The same LuGre law as a passive force in Python, its state stepped in the callback."""
    s0, s1, fc, fs, vs = (LUGRE[key] for key in LUGRE)
    state = [0.0]

    def passive(model: mujoco.MjModel, data: mujoco.MjData) -> None:
        v, z = data.qvel[1], state[0]
        level = fc + (fs - fc) * np.exp(-((v / vs) ** 2))
        rate = v - s0 * abs(v) * z / level
        data.qfrc_passive[1] -= s0 * z + s1 * rate
        state[0] = z + 1e-3 * rate

    return passive


def _seconds(model: mujoco.MjModel, data: mujoco.MjData, steps: int, name: str) -> float:
    """Time of one step, from a fresh start."""
    mujoco.mj_resetData(model, data)
    data.qvel[:] = 0.3, -0.3
    if name.startswith("Python"):
        mujoco.set_mjcb_passive(_callback())
    try:
        start = time.perf_counter()
        mujoco.mj_step(model, data, steps)
        return (time.perf_counter() - start) / steps
    finally:
        mujoco.set_mjcb_passive(None)


def run(quick: bool = False) -> list[dict[str, Any]]:
    """Measure every variant under every integrator.

    Returns
    -------
    list of dict
        benchmark, integrator, variant, microseconds (median), against (name of the variant it is
        compared with, or None) and ratio (median of the cost ratio within rounds, or None).
    """
    inerter.load_plugin()
    rounds, steps = (5, 1000) if quick else (25, 4000)
    rows: list[dict[str, Any]] = []
    for integrator in INTEGRATORS:
        models = {
            name: _model(actuator, integrator, name.startswith("siblings"))
            for name, (actuator, _) in VARIANTS.items()
        }
        datas = {name: mujoco.MjData(model) for name, model in models.items()}
        times: dict[str, list[float]] = {name: [] for name in VARIANTS}
        for round_ in range(-1, rounds):  # the first one warms up
            for name in VARIANTS:
                count = steps // 10 if name.startswith("Python") else steps
                spent = _seconds(models[name], datas[name], count, name)
                if round_ >= 0:
                    times[name].append(spent)
        for name, (_, against) in VARIANTS.items():
            ratio = None
            if against is not None:
                pairs = zip(times[name], times[against], strict=True)
                ratio = statistics.median(own / other for own, other in pairs)
            rows.append(
                {
                    "benchmark": "step_cost", "integrator": integrator, "variant": name,
                    "microseconds": 1e6 * statistics.median(times[name]),
                    "against": against, "ratio": ratio,
                }
            )  # fmt: skip
    return rows


def main() -> None:
    """Print the table; write it as JSON if asked."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="fewer and shorter rounds")
    parser.add_argument("--json", type=Path, help="file to write")
    arguments = parser.parse_args()
    rows = run(arguments.quick)
    print(f"{'integrator':13}{'variant':26}{'us/step':>8}   ratio")
    for row in rows:
        ratio = f"{row['ratio']:.2f} x {row['against']}" if row["against"] else ""
        print(f"{row['integrator']:13}{row['variant']:26}{row['microseconds']:8.3f}   {ratio}")
    if arguments.json:
        arguments.json.parent.mkdir(parents=True, exist_ok=True)
        arguments.json.write_text(json.dumps(rows, indent=1) + "\n")


if __name__ == "__main__":
    main()
