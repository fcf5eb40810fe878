"""Fluid inerter in Exudyn: a piston that moves water through a pipe, alone or on its shaker.

    (m_p + m_a) x'' + c x' + k x = force + alpha_1 q' - F_device,   L q'' + R q' + alpha_2 x' = coil

Coordinates, variants and numbers: README.md. Run this file for a sweep on the shaker.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import exudyn as exu
import numpy as np
from exudyn.itemInterface import Mass1D, Node1D, ObjectGenericODE2
from inerter.exudyn import CreateInerter
from inerter.exudyn.model_parts import (
    Model,
    chosen,
    drive_coordinate,
    flywheel_at_rest,
    named,
    save_picture,
    simulate,
)
from inerter.model_parameters import FLUID_INERTER, SHAKER

VARIANTS = ("complete", "dry")


def published_device(variant: str) -> dict[str, Any]:
    """Parameters of the device, "dry" (its seals alone) or "complete" (with water and air)."""
    fluid = FLUID_INERTER
    seals = {
        "friction": "brown_mcphee",
        "coulomb_force": fluid.coulomb_force,
        "static_force": fluid.static_force,
        "stribeck_velocity": fluid.stribeck_velocity,
        "viscous": fluid.viscous,
    }
    if chosen("variant", variant, VARIANTS) == "dry":
        return seals
    return seals | {
        "piston_area": fluid.piston_area,
        "channel_area": fluid.channel_area,
        "channel_length": fluid.channel_length,
        "fluid_density": fluid.fluid_density,
        "series_stiffness": fluid.series_stiffness,
        "series_hardening": fluid.series_hardening,
        "series_damping": fluid.series_damping,
        "flywheel_viscous": fluid.air_damping_preload[0],
        "gas_law": "expanded",
        "gas_pressure": fluid.gas_pressure,
        "gas_volume": fluid.piston_area * fluid.air_column,
        "gas_exponent": fluid.gas_exponent,
    }


def build(
    mbs: Any,
    *,
    variant: str = "complete",
    shaker: bool = False,
    device: Mapping[str, Any] | None = None,
    inputs: Mapping[str, Callable[[float], float]] | None = None,
    initial_velocities: Mapping[str, float] | None = None,
    symbolic: bool | None = None,
) -> Model:
    """Add piston and device, and if asked for their shaker, to an empty system.

    Parameters
    ----------
    mbs
        An empty `exudyn.MainSystem`; assemble it afterwards.
    variant
        "complete": filled with water; "dry": the friction of the seals alone.
    shaker
        Adds armature and coil; coordinates then are "piston" and "charge".
    device
        Parameters of the device in place of the variant's.
    inputs
        "force": time [s] -> force on the piston [N]; with shaker also "coil": voltage of the coil
        [V], 19 times the amplifier's input.
    initial_velocities
        "piston" [m/s]; with shaker also "charge" [A].
    symbolic
        As in `CreateInerter`: None compiles the laws of the device where that is possible.

    Raises
    ------
    ValueError
        An unknown variant or name.
    """
    parameters = published_device(variant) if device is None else dict(device)
    coordinates = ("piston", "charge") if shaker else ("piston",)
    drives = named("inputs", inputs, ("force", "coil") if shaker else ("force",))
    start = named("initial_velocities", initial_velocities, coordinates)

    # x > 0 is out of the cylinder, longer
    nodes = {
        name: mbs.AddNode(
            Node1D(name=name, referenceCoordinates=[0.0], initialVelocities=[start.get(name, 0.0)])
        )
        for name in coordinates
    }
    piston = nodes["piston"]
    mbs.AddObject(Mass1D(name="piston", mass=FLUID_INERTER.piston_mass, nodeNumber=piston))
    drive_coordinate(mbs, "force", piston, drives.get("force"), 1.0)

    # armature on the piston's rod; with the charge as coordinate the coil is a mass L with a damper
    # R, coupled by velocities: forward alpha_1 q', backward -alpha_2 x'
    if shaker:
        mbs.AddObject(
            ObjectGenericODE2(
                name="shaker",
                nodeNumbers=[piston, nodes["charge"]],
                massMatrix=np.diag([SHAKER.armature_mass, SHAKER.inductance]),
                stiffnessMatrix=np.diag([SHAKER.stiffness, 0.0]),
                dampingMatrix=np.array(
                    [
                        [SHAKER.damping, -SHAKER.force_constant],
                        [SHAKER.voltage_constant, SHAKER.resistance],
                    ]
                ),
            )
        )
        drive_coordinate(mbs, "coil", nodes["charge"], drives.get("coil"), 1.0)

    inerter = CreateInerter(
        mbs,
        name="device",
        itemNumbers=[None, piston],
        symbolic=symbolic,
        initialStates=flywheel_at_rest(parameters),
        **parameters,
    )
    return Model(mbs, {name: (node, 0) for name, node in nodes.items()}, {"device": inerter})


def coil_voltage(t: float) -> float:
    """A sweep from 0.5 Hz at 0.96 Hz per second, 0.35 V at the amplifier's input."""
    return SHAKER.gain * 0.35 * float(np.sin(2 * np.pi * (0.5 + 0.48 * t) * t))


def main() -> None:
    """Sweep the dry and the filled device on the shaker."""
    for variant in VARIANTS:
        SC = exu.SystemContainer()
        mbs = SC.AddSystem()
        model = build(mbs, variant=variant, shaker=True, inputs={"coil": coil_voltage})
        run = simulate(model, 4.0, step=1e-4, write_period=2e-3)
        piston, force = (np.abs(v).max() for v in (run.displacement["piston"], run.force["device"]))
        print(f"{variant}: piston up to {1e3 * piston:.2f} mm, force up to {force:.1f} N")
        print(f"    {save_picture(f'fluid_inerter_{variant}', run)}")


if __name__ == "__main__":
    main()
