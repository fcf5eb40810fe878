"""Models that the tests of `inerter simulate` share."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from inerter.simulate.run import SimulatedRun

EXTENSION = '<extension><plugin plugin="inerter.device"/></extension>'


def config(**keys: float | str) -> str:
    return "".join(f'<config key="{key}" value="{value}"/>' for key, value in keys.items())


def device(target: str = 'joint="x"', name: str = "strut", states: int = 0, **keys: object) -> str:
    """An actuator with a device, configured in place."""
    return (
        f'<plugin name="{name}" plugin="inerter.device" {target} actdim="{states}">'
        f"{config(**keys)}</plugin>"  # type: ignore[arg-type]
    )


def oscillator(actuators: str, option: str = "", extra: str = "", joint: str = "") -> str:
    """20 kg on a spring of 3e4 N/m, at x = 0; the tendon `rope` is as long as 0.5 m + x."""
    return f"""
<mujoco>
  <option gravity="0 0 0" timestep="1e-3" {option}/>{EXTENSION}
  <worldbody>
    <site name="a"/>
    <body name="mass" pos="0.5 0 0">
      <joint name="x" type="slide" axis="1 0 0" stiffness="3e4" {joint}/>
      <geom size="0.1" mass="20" contype="0" conaffinity="0"/>
      <site name="b"/>
    </body>
  </worldbody>
  <tendon><spatial name="rope"><site site="a"/><site site="b"/></spatial></tendon>
  <actuator><motor name="push" joint="x"/>{actuators}</actuator>
  {extra}
</mujoco>"""


def written(folder: Path, xml: str, name: str = "model.xml") -> Path:
    path = folder / name
    path.write_text(xml)
    return path


def columns(run: SimulatedRun, index: int = 0) -> dict[str, np.ndarray]:
    return run.devices[index].columns


PULL = '<keyframe><key name="pulled" qpos="0.01"/></keyframe>'
