"""A fluid inerter from its geometry and its liquid."""

from __future__ import annotations

import math

import numpy as np

from inerter.core import Device
from inerter.design.fluid import cavitation, compressibility
from inerter.design.fluid.inputs import INPUTS, read_geometry, read_liquid, with_prototype
from inerter.design.fluid.losses import LAMINAR_REYNOLDS, Channel
from inerter.design.inputs import DesignError, Values, read_inputs
from inerter.design.result import Curve, Design, Figure, Panel


def design_fluid(**inputs: float | str) -> Design:
    """Inertance, losses, cavitation limit, compressibility and trapped air of a fluid inerter.

    Parameters
    ----------
    **inputs : float or str
        See `inerter.design.fluid.inputs.INPUTS`; SI units, or texts with a unit ("30 degC").

    Returns
    -------
    Design
        With a device that has the channel's geometry and liquid, with `stroke` the series
        stiffness of the liquid, with `gas_volume` the gas spring.

    Raises
    ------
    DesignError
        An input that cannot be, or a liquid that boils at rest.

    Source: inertance: Swift et al., "Design and modelling of a fluid inerter", Int. J. Control
    86(11), 2013; the rest stands in the modules of this folder.
    """
    values = with_prototype(read_inputs(INPUTS, inputs))
    geometry, liquid = read_geometry(values), read_liquid(values)
    channel = Channel(geometry, liquid, values.number("roughness"), values.number("minor_loss"))
    static = values.number("static_pressure")
    limit = cavitation.force_limit(channel, static, values.number("suction_share"))
    elastic, keys = _elasticity(values, channel)
    device = Device(**channel.keys, **keys)
    figures = (*_liquid(channel), *_losses(values, channel), *_cavitation(values, channel, limit))
    speed = values.number("speed")
    return Design(
        kind="fluid",
        inputs=values,
        figures=(*figures, *elastic),
        device=device,
        comments=_comments(channel),
        panels=(_loss_panel(channel, speed), _limit_panel(values, channel, limit)),
        notes=_notes(values, channel, limit),
    )


def _liquid(channel: Channel) -> list[Figure]:
    geometry, liquid = channel.geometry, channel.liquid
    return [
        Figure("inertance", channel.inertance, "kg", "inertance rho l A1^2 / A2"),
        Figure("fluid_mass", channel.mass, "kg", "liquid in the channel"),
        Figure("piston_area", geometry.piston_area, "m^2", "A1"),
        Figure("channel_area", geometry.channel_area, "m^2", "A2"),
        Figure("channel_length", geometry.length, "m", "l"),
        Figure("density", liquid.density, "kg/m^3", "density of the liquid"),
        Figure("viscosity", liquid.viscosity, "Pa*s", "dynamic viscosity"),
        Figure("vapour_pressure", liquid.vapour_pressure, "Pa", "vapour pressure"),
    ]


def _losses(values: Values, channel: Channel) -> list[Figure]:
    speed = values.number("speed")
    at = f"at {speed:g} m/s"
    total = float(channel.force(speed)[0])
    found = [
        Figure("reynolds", channel.reynolds(speed), "", f"Reynolds number {at}"),
        Figure("loss", total, "N", f"force of all losses {at}"),
        Figure("end_loss", channel.ends(speed), "N", f"of these, bends and ends {at}"),
        Figure(
            "pressure_loss", total / channel.geometry.piston_area, "Pa",
            f"pressure of all losses {at}",
        ),
        Figure("laminar_damping", channel.laminar_damping, "N*s/m", "of the walls, laminar"),
        Figure(
            "transition_speed", channel.transition_speed, "m/s",
            f"speed at which Re is {LAMINAR_REYNOLDS:g}",
        ),
    ]  # fmt: skip
    if channel.geometry.coil_diameter:
        factor = channel.coil_factor(speed)
        found.append(Figure("dean", channel.dean(speed), "", f"Dean number {at}"))
        found.append(
            Figure(
                "coil_factor", factor, "", f"coil's friction per straight channel's, laminar, {at}"
            )
        )
    return found


def _cavitation(values: Values, channel: Channel, limit: float) -> list[Figure]:
    amplitude = values.number("amplitude")
    return [
        Figure("cavitation_force", limit, "N", "force on the liquid at which it boils"),
        Figure(
            "cavitation_acceleration", limit / channel.inertance, "m/s^2", "of that force, at rest"
        ),
        Figure(
            "cavitation_speed", cavitation.speed_limit(channel, limit), "m/s",
            "constant speed whose losses reach that force",
        ),
        Figure(
            "cavitation_frequency", cavitation.frequency_limit(channel, limit, amplitude), "Hz",
            f"at which a motion of {1e3 * amplitude:g} mm reaches that force",
        ),
    ]  # fmt: skip


def _elasticity(values: Values, channel: Channel) -> tuple[list[Figure], dict[str, float | str]]:
    """Figures of compressibility and air, and the device's parameters for them."""
    area, static = channel.geometry.piston_area, values.number("static_pressure")
    exponent, stroke = values.number("gas_exponent"), values.maybe("stroke")
    modulus = compressibility.effective_modulus(
        channel.liquid.bulk_modulus, values.number("air_fraction"), static, exponent
    )
    sound = math.sqrt(modulus / channel.liquid.density)
    figures = [
        Figure("bulk_modulus", modulus, "Pa", "of the liquid with its bubbles"),
        Figure(
            "channel_resonance", sound / (2.0 * channel.geometry.length), "Hz",
            "lowest acoustic resonance of the channel, c / (2 l)",
        ),
    ]  # fmt: skip
    keys: dict[str, float | str] = {}
    total = 0.0
    if stroke is not None:
        chamber = 0.5 * area * stroke + values.number("dead_volume")
        total = compressibility.series_stiffness(modulus, area, chamber)
        keys["series_stiffness"] = total
        figures.append(Figure("series_stiffness", total, "N/m", "of the liquid in both chambers"))
    elif "dead_volume" in values.given or "air_fraction" in values.given:
        raise DesignError(
            "dead_volume or air_fraction is given, but no stroke: the liquid counts as rigid; give "
            "stroke too, or leave them out"
        )
    volume = values.maybe("gas_volume")
    if volume is not None:
        gas = compressibility.gas_stiffness(static, area, volume, exponent)
        keys |= {"gas_pressure": static, "gas_volume": volume, "gas_exponent": exponent}
        figures += [
            Figure("gas_stiffness", gas, "N/m", "of the trapped air at rest"),
            Figure(
                "gas_resonance", compressibility.frequency(gas, channel.inertance), "Hz",
                "of the inertance on the trapped air",
            ),
        ]  # fmt: skip
        total += gas if stroke is not None else 0.0
    if stroke is not None:
        found = compressibility.frequency(total, channel.inertance)
        figures.append(
            Figure("antiresonance", found, "Hz", "at which the driven piston would stand still")
        )
    return figures, keys


def _loss_panel(channel: Channel, speed: float) -> Panel:
    turn = channel.transition_speed
    speeds = np.geomspace(min(speed, turn) / 20.0, 20.0 * max(speed, turn), 121)
    turbulent = speeds[channel.reynolds(1.0) * speeds > 3000.0]
    x = speeds.tolist()
    return Panel(
        name="loss",
        title="Losses at constant speed",
        x_title="speed of the piston [m/s]",
        y_title="force [N]",
        curves=(
            Curve("walls and ends, as simulated", x, channel.force(speeds).tolist()),
            Curve("bends and ends", x, [channel.ends(v) for v in x]),
            Curve("laminar walls", x, (channel.laminar_damping * speeds).tolist(), dashed=True),
            Curve(
                "smooth turbulent walls",
                turbulent.tolist(),
                channel.blasius(turbulent).tolist(),
                dashed=True,
            ),
        ),
        log_x=True,
        log_y=True,
    )


def _limit_panel(values: Values, channel: Channel, limit: float) -> Panel:
    highest = values.number("highest_frequency")
    frequencies = np.geomspace(highest / 40.0, highest, 41)
    found = 1e3 * cavitation.amplitude_limit(channel, limit, frequencies)
    inertial = 1e3 * limit / channel.inertance / (2.0 * math.pi * frequencies) ** 2
    x = frequencies.tolist()
    return Panel(
        name="cavitation",
        title="Amplitude at which the liquid boils",
        x_title="frequency [Hz]",
        y_title="amplitude [mm]",
        curves=(
            Curve("inertance and losses", x, found.tolist()),
            Curve("inertance alone", x, inertial.tolist(), dashed=True),
        ),
        log_x=True,
        log_y=True,
    )


def _comments(channel: Channel) -> dict[str, str]:
    return {
        "channel_length": f"m; with it the inertance is {channel.inertance:.5g} kg",
        "series_stiffness": "N/m, compressible liquid in both chambers",
        "gas_pressure": "Pa, trapped air",
    }


def _notes(values: Values, channel: Channel, limit: float) -> tuple[str, ...]:
    notes = []
    stroke = values.maybe("stroke")
    if stroke is None:
        notes.append("No stroke is given: the device has a rigid liquid.")
    elif values.stated("amplitude") and 2.0 * values.number("amplitude") > stroke:
        notes.append("The amplitude is more than half of the stroke.")
    speed = values.number("speed")
    if float(channel.force(speed)[0]) >= limit:
        notes.append(f"At {speed:g} m/s the losses alone are beyond the cavitation limit.")
    if channel.geometry.coil_diameter:
        notes.append("The simulated loss is that of a straight channel: see coil_factor.")
    if values.word("liquid") != "water" and "viscosity" not in values.given:
        notes.append(
            "Properties of oils are typical values: compare with your product's data sheet."
        )
    return tuple(notes)
