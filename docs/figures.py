"""Pictures of what each part of a device does, drawn from the device itself, into docs/figures.

The page builder runs this; `python docs/figures.py` does it by hand.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from inerter import Device
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray
from ride_figures import drawn_ride
from strut_figures import drawn_struts

Array = NDArray[np.float64]

FOLDER = Path(__file__).parent / "figures"
RATE = 4000.0
AMPLITUDE = 0.01
FRICTION: Mapping[str, dict[str, Any]] = {
    "coulomb": {"coulomb_force": 10},
    "stribeck": {"coulomb_force": 10, "static_force": 15, "stribeck_velocity": 0.01},
    "dahl": {"coulomb_force": 10, "bristle_stiffness": 1e4},
    "lugre": {
        "coulomb_force": 10, "static_force": 15, "stribeck_velocity": 0.01,
        "bristle_stiffness": 1e4, "bristle_damping": 40,
    },
    "bouc_wen": {"bw_stiffness": 1e4, "bw_beta": 600, "bw_gamma": 400},
    "brown_mcphee": {"coulomb_force": 10, "static_force": 15, "stribeck_velocity": 0.01},
    "rate_state": {"coulomb_force": 10, "rate_effect": 0.02, "age_effect": 0.06},
    "maxwell_slip": {
        "slip_stiffness_1": 1e4, "slip_force_1": 4, "slip_stiffness_2": 2e3, "slip_force_2": 3,
        "slip_stiffness_3": 6e2, "slip_force_3": 3,
    },
}  # fmt: skip
SERIES = {"inertance": 100, "series_stiffness": 2e5, "series_damping": 400}


def sine(frequency: float, periods: float = 2, amplitude: float = AMPLITUDE) -> tuple[Array, ...]:
    """Time, displacement, velocity, acceleration of a sine that begins at rest at its crest."""
    rate = 2 * np.pi * frequency
    t = np.arange(0, periods / frequency, 1 / RATE)
    return (
        t,
        -amplitude * np.cos(rate * t),
        amplitude * rate * np.sin(rate * t),
        amplitude * rate**2 * np.cos(rate * t),
    )


def along(device: Device, motion: Sequence[Array], state: Any = None) -> Array:
    """Force of a device along time, displacement, velocity, acceleration [N]."""
    state = np.zeros(device.nstate) if state is None else state
    x, v, a = motion[1:]
    return device.along(1 / RATE, x, v, a, state)["total"]


def settled(values: Array, frequency: float) -> Array:
    """The last period, closed."""
    return values[-round(RATE / frequency) - 1 :]


def loops(name: str, devices: Mapping[str, Device], frequency: float, amplitude: float) -> None:
    """Force over displacement and over velocity, last period of some."""
    figure = Figure(figsize=(8, 3.2), layout="constrained")
    left, right = figure.subplots(1, 2, sharey=True)
    motion = sine(frequency, 4, amplitude)
    for label, device in devices.items():
        force = settled(along(device, motion), frequency)
        left.plot(1e3 * settled(motion[1], frequency), force, label=label)
        right.plot(settled(motion[2], frequency), force)
    left.set(xlabel="displacement [mm]", ylabel="force [N]")
    right.set(xlabel="velocity [m/s]")
    if len(devices) > 1:
        # stated, for the default warns where a busy machine takes long
        left.legend(loc="best", fontsize="small")
    _save(figure, name)


def in_time(name: str, devices: Mapping[str, Device], motion: Sequence[Array]) -> None:
    """Force over time."""
    figure = Figure(figsize=(8, 2.8), layout="constrained")
    axes: Axes = figure.subplots()
    for label, device in devices.items():
        state = np.zeros(device.nstate)
        if device.nstate:
            x, v, a = (float(channel[0]) for channel in motion[1:])
            state = device.state_of_force(x, v, a, 0.0)
        axes.plot(motion[0], along(device, motion, state), label=label)
    axes.set(xlabel="time [s]", ylabel="force [N]")
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=len(devices), frameon=False)
    _save(figure, name)


# --- one function per picture or group of pictures; the gallery shows them with their code --------


def friction() -> None:
    """Friction laws, each alone, at 0.5 Hz."""
    for law, values in FRICTION.items():
        loops(law, {law: Device(friction=law, **values)}, 0.5, AMPLITUDE)


def friction_backlash() -> None:
    """Free play before a bristle."""
    devices = {
        "Dahl": Device(friction="dahl", **FRICTION["dahl"]),
        "2 mm of play before it": Device(
            friction="dahl", **FRICTION["dahl"], friction_backlash=1e-3
        ),
    }
    loops("friction_backlash", devices, 0.5, AMPLITUDE)


def memory() -> None:
    """Small strokes within a large one: one bristle drifts, Maxwell-slip closes its loops."""
    turns = np.array([0, 8, -8, 4, 0, 4, 0, 4, 3, 4, 3, 4, 8]) * 1e-3
    x = np.concatenate([np.linspace(a, b, 400) for a, b in pairwise(turns)])
    v = np.gradient(x) * RATE
    figure = Figure(figsize=(8, 3.2), layout="constrained")
    for axes, law in zip(figure.subplots(1, 2, sharey=True), ("dahl", "maxwell_slip"), strict=True):
        device = Device(friction=law, **FRICTION[law])
        force = device.along(1 / RATE, x, v, 0 * x, np.zeros(device.nstate))["total"]
        axes.plot(1e3 * x, force)
        axes.set(xlabel="displacement [mm]", title=law)
    figure.axes[0].set(ylabel="force [N]")
    _save(figure, "memory")


def friction_level() -> None:
    """A friction level that differs with direction, and along the stroke."""
    level = {"friction": "dahl", **FRICTION["dahl"]}
    devices = {
        "constant": Device(**level),
        "with direction": Device(**level, friction_asymmetry=0.3),
        "along the stroke": Device(**level, friction_gradient=40),
        "at the ends": Device(**level, friction_curvature=6e3),
    }
    loops("friction_level", devices, 0.5, AMPLITUDE)


def along_the_stroke() -> None:
    """Each quantity that can change along the stroke, by one period of 5 mm and a curve."""
    pitch: dict[str, Any] = {"curve_lower": -10e-3, "curve_upper": 10e-3}
    devices = {
        "inertance": Device(inertance=100, inertance_periods=(5e-3, 0.03, 0.0)),
        "friction level": Device(
            friction="dahl", **FRICTION["dahl"], friction_curve=(0.6, 0, 0, 0, 0.3), **pitch
        ),
        "force": Device(force_periods=(5e-3, 4.0, 0.0)),
        "damping": Device(viscous_curve=(300, 80, 60, 80, 300), **pitch),
    }
    loops("along_the_stroke", devices, 1.0, AMPLITUDE)


def force_map() -> None:
    """A force over displacement and velocity: as stated, and what of it is passive."""
    rows, columns = np.meshgrid(np.linspace(-1, 1, 9), np.linspace(-1, 1, 8), indexing="ij")
    surface: dict[str, Any] = {
        "force_map": 4 * np.sin(4 * rows) + 6 * np.tanh(4 * columns) * (1 - 1.5 * rows),
        "force_map_columns": 8, "force_map_lower": -10e-3, "force_map_upper": 10e-3,
        "force_map_speed": 0.06, "force_map_scale": 0.03,
    }  # fmt: skip
    devices = {
        "as stated": Device(**surface),
        "passive": Device(**surface, force_map_passive=1),
    }
    loops("force_map", devices, 1.0, AMPLITUDE)


def along_each_direction() -> None:
    """Friction whose level along the stroke differs between the directions."""
    level: dict[str, Any] = {"friction": "dahl", **FRICTION["dahl"]}
    level |= {"friction_periods": (5e-3, 0.2, 0.0)}
    devices = {
        "both alike": Device(**level),
        "the other flank": Device(**level, friction_back_periods=(5e-3, 0.2, 2.0)),
    }
    loops("along_each_direction", devices, 0.5, AMPLITUDE)


def load_friction() -> None:
    """Friction of what the inertance presses on."""
    devices = {
        "ideal": Device(inertance=100),
        "mu = 0.2": Device(inertance=100, load_friction=0.2),
    }
    loops("load_friction", devices, 1.0, AMPLITUDE)


def load_by_power() -> None:
    """A drive that loses more forward than backward, and one mean mu."""
    devices = {
        "forward 0.6, backward 0.2": Device(inertance=100, mu_forward=0.6, mu_backward=0.2),
        "mu = 0.4": Device(inertance=100, load_friction=0.4),
    }
    loops("load_by_power", devices, 1.0, AMPLITUDE)


def load_on_bristle() -> None:
    """The same load on friction without memory and on a bristle, which holds through a reversal."""
    memory = {"friction": "dahl", "coulomb_force": 5.0, "bristle_stiffness": 3e4}
    devices = {
        "coulomb": Device(inertance=100, friction="coulomb", coulomb_force=5.0, load_friction=0.2),
        "dahl": Device(inertance=100, **memory, load_friction=0.2),
        "dahl, no load friction": Device(inertance=100, **memory),
    }
    loops("load_on_bristle", devices, 1.0, AMPLITUDE)


def damping_and_stiffness() -> None:
    """Dampers and springs beside the inertance."""
    devices = {
        "viscous": Device(viscous=300),
        "quadratic": Device(quadratic_damping=5000),
        "stiffness": Device(stiffness=1500),
        "hardening": Device(stiffness_cubic=1.5e7),
    }
    loops("damping_and_stiffness", devices, 1.0, AMPLITUDE)


def dampers() -> None:
    """Dampers: force over speed, straight, uneven, digressive, falling, as a power."""
    bent = {"viscous": 1000, "damping_knee": 0.1, "damping_beyond": 0.2}
    brake = bent | {"damping_beyond": 0}
    devices = {
        "viscous": Device(viscous=1000),
        "damping_asymmetry 0.4": Device(viscous=1000, damping_asymmetry=0.4),
        "damping_knee 0.1, damping_beyond 0.2": Device(**bent),
        "the three, knee_back 0.25, sharpness 8": Device(
            **bent, damping_asymmetry=0.4, damping_knee_back=0.25, damping_sharpness=8
        ),
    } | {f"damping_exponent {n}": Device(**brake, damping_exponent=n) for n in (-1, 0.35)}
    figure = Figure(figsize=(8, 3.2), layout="constrained")
    axes: Axes = figure.subplots()
    speeds = np.linspace(-0.5, 0.5, 401)
    for (name, device), style in zip(devices.items(), ("-", "--") * 3, strict=True):
        force = [float(np.ravel(device.evaluate(0.0, v, 0.0, 0.0)["total"])[0]) for v in speeds]
        axes.plot(speeds, force, style, label=name)
    axes.set_xlabel("velocity [m/s]")
    axes.set_ylabel("force [N]")
    axes.legend(loc="upper left", bbox_to_anchor=(1, 1), fontsize="small")
    _save(figure, "dampers")


def at_frequencies(name: str, device: Device, strokes: Mapping[float, float], place: bool) -> None:
    """Force over displacement or over velocity, last period of sines [Hz] of amplitudes [m]."""
    figure = Figure(figsize=(8, 3.2), layout="constrained")
    axes: Axes = figure.subplots()
    for frequency, amplitude in strokes.items():
        motion = sine(frequency, 6, amplitude)
        over, force = 1e3 * motion[1] if place else motion[2], along(device, motion)
        axes.plot(settled(over, frequency), settled(force, frequency), label=f"{frequency:g} Hz")
    axes.set(xlabel="displacement [mm]" if place else "velocity [m/s]", ylabel="force [N]")
    axes.legend(loc="best", fontsize="small")
    _save(figure, name)


def damper_spring() -> None:
    """A valve behind a spring: force over velocity, the same speed at three frequencies."""
    valve = Device(
        viscous=2000, damping_knee=0.1, damping_beyond=0.25, damping_asymmetry=0.4,
        damper_stiffness=2e5,
    )  # fmt: skip
    at_frequencies("damper_spring", valve, {1.0: 0.05, 4.0: 0.0125, 12.0: 0.05 / 12}, place=False)


def branches() -> None:
    """Two viscoelastic branches beside a spring, at three frequencies: force over displacement."""
    rubber = Device(
        stiffness=500, branch_stiffness_1=2000, branch_damping_1=300, branch_stiffness_2=1000,
        branch_damping_2=20,
    )  # fmt: skip
    at_frequencies("branches", rubber, dict.fromkeys((0.2, 1.0, 5.0), AMPLITUDE), place=True)


def inertance() -> None:
    """Inertance that varies, at 1 Hz."""
    devices = {
        "constant": Device(inertance=100),
        "along the stroke": Device(inertance=100, inertance_gradient=50),
        "with speed": Device(inertance=100, inertance_speed_gradient=5),
    }
    loops("inertance", devices, 1.0, AMPLITUDE)


def series() -> None:
    """Elastic drive and free play: a start from rest at 2 Hz."""
    devices = {
        "rigid": Device(inertance=100),
        "elastic": Device(**SERIES),
        "elastic, 0.4 mm of play": Device(**SERIES, backlash=2e-4),
    }
    in_time("series", devices, sine(2.0, 3))


def clutch() -> None:
    """A clutch, a one-way clutch, a leak: a start from rest at 2 Hz."""
    devices = {
        "elastic": Device(**SERIES),
        "a clutch of 100 N": Device(**SERIES, clutch_force=100),
        "a one-way clutch": Device(**SERIES, clutch_force=1e6, clutch_asymmetry=1),
        "a leak": Device(inertance=100, leak_damping=500, leak_quadratic_damping=1e4),
    }
    in_time("clutch", devices, sine(2.0, 3))


def friction_side() -> None:
    """Friction before and behind the elastic drive."""
    soft = {"inertance": 100, "series_stiffness": 1e5, "series_damping": 1500}
    rubbing = {**soft, "friction": "coulomb", "coulomb_force": 20, "transition_velocity": 1e-3}
    devices = {
        "at the terminals": Device(**rubbing),
        "at the flywheel": Device(**rubbing, friction_side="flywheel"),
    }
    loops("friction_side", devices, 0.5, AMPLITUDE)


def end_stops() -> None:
    """End stops at 8 mm."""
    stop = Device(stop_lower=-8e-3, stop_upper=8e-3, stop_stiffness=1e4, stop_damping=5)
    rubber = stop.replace(stop_stiffness=3e3, stop_stiffness_cubic=3e9)
    loops("end_stops", {"straight": stop, "of rubber": rubber}, 1.0, AMPLITUDE)


def gas() -> None:
    """The two laws of the gas spring."""
    volume = {"gas_pressure": 1e5, "gas_area": 1e-3, "gas_volume": 2.2e-5}
    devices = {law: Device(**volume, gas_law=law) for law in ("polytropic", "expanded")}
    loops("gas", devices, 1.0, AMPLITUDE)


def fluid() -> None:
    """Fluid in a channel: inertance and losses."""
    channel = {"piston_area": 2e-3, "channel_area": 8e-5, "channel_length": 2.0}
    devices = {
        f"{viscosity:g} Pa s": Device(**channel, fluid_density=850, fluid_viscosity=viscosity)
        for viscosity in (0.0, 0.02, 0.1)
    }
    loops("fluid", devices, 1.0, AMPLITUDE)


def coil() -> None:
    """The same channel straight and wound to a coil."""
    channel = {"piston_area": 2e-3, "channel_area": 8e-5, "channel_length": 2.0}
    oil = {"fluid_density": 850, "fluid_viscosity": 0.02}
    devices = {
        "straight": Device(**channel, **oil),
        "coil of 0.3 m": Device(**channel, **oil, coil_diameter=0.3),
        "coil of 0.05 m": Device(**channel, **oil, coil_diameter=0.05),
    }
    loops("coil", devices, 1.0, AMPLITUDE)


def aging() -> None:
    """Rate-and-state friction: a step of the velocity and back, and slides after holds."""
    law = {"friction": "rate_state", "coulomb_force": 10, "rate_effect": 0.02, "age_effect": 0.04}
    device = Device(**law, age_distance=1e-4, transition_velocity=1e-6)
    figure = Figure(figsize=(9, 3), layout="constrained")
    stepped, held = figure.subplots(1, 2)
    t = np.arange(0, 3.0, 1 / RATE)
    v = np.where((t > 1) & (t < 2), 1e-2, 1e-3)
    x = np.concatenate([[0.0], np.cumsum(v[1:])]) / RATE
    stepped.plot(1e3 * x, device.along(1 / RATE, x, v, np.zeros_like(t))["total"])
    stepped.set(xlabel="displacement [mm]", ylabel="force [N]", title="1 mm/s, 10 mm/s, 1 mm/s")
    for hold in (1.0, 10.0, 100.0):
        begin = device.step(0.0, 0.0, 0.0, hold)
        slide = np.full(t.shape, 1e-3)
        told = device.along(1 / RATE, slide * t, slide, np.zeros_like(t), begin)["total"]
        held.plot(t[t < 0.6], told[t < 0.6], label=f"held for {hold:g} s")
    held.set(xlabel="time [s]", ylabel="force [N]", title="1 mm/s after a hold")
    held.legend(frameon=False)
    _save(figure, "aging")


def control() -> None:
    """A damping and an inertance that a control sets, at once and with a lag."""
    t = np.arange(0, 1.0, 1 / RATE)
    motion = t, 0.5 * t, np.full_like(t, 0.5), np.zeros_like(t)
    figure = Figure(figsize=(9, 3), layout="constrained")
    force, energy = figure.subplots(1, 2)
    for lag in (0.0, 0.05):
        bounds = {"control_lower": 50.0, "control_upper": 400.0, "control_lag": lag}
        label = f"lag {1000 * lag:g} ms"
        damper = Device(viscous=50, control="viscous", **bounds)
        command = np.where((t > 0.2) & (t < 0.6), 300.0, 0.0)
        told = damper.along(1 / RATE, *motion[1:], command=command)
        force.plot(t, told["total"], label=label)
        flywheel = Device(inertance=50, control="inertance", **bounds)
        told = flywheel.along(1 / RATE, *motion[1:], command=command)
        said = flywheel.evaluate(*motion[1:], told["states"] if lag else 0.0, command=command)
        energy.plot(t, said["stored_energy"], label=label)
    force.set(xlabel="time [s]", ylabel="force [N]", title="damper, 0.5 m/s, command 300 N s/m")
    energy.set(xlabel="time [s]", ylabel="stored energy [J]", title="inertance, 0.5 m/s: no force")
    energy.legend(frameon=False)
    _save(figure, "control")


def semi_active() -> None:
    """The ride of the how-to page, with its own code."""
    _save(drawn_ride(), "semi_active")


def strut_layouts() -> None:
    """Layouts of a strut between body (above) and wheel: k springs, c damper, I inerter."""
    _save(drawn_struts(), "strut_layouts")


GALLERY: Sequence[Callable[[], None]] = (
    friction, friction_backlash, memory, friction_level, load_friction, load_by_power,
    load_on_bristle, damping_and_stiffness, dampers, damper_spring, branches, inertance, series,
    clutch, friction_side, end_stops, gas, fluid, along_the_stroke, force_map,
    along_each_direction, coil, aging, control, semi_active, strut_layouts,
)  # fmt: skip


def draw() -> dict[str, list[str]]:
    """Every picture: their names by the function that makes them."""
    FOLDER.mkdir(exist_ok=True)
    found = {}
    for make in GALLERY:
        _drawn.clear()
        make()
        found[make.__name__] = sorted(_drawn)
    return found


_drawn: set[str] = set()


def _save(figure: Figure, name: str) -> None:
    _drawn.add(name)
    for axes in figure.axes:
        axes.grid(alpha=0.3)
        axes.spines[["top", "right"]].set_visible(False)
    with mpl.rc_context({"svg.hashsalt": "inerter"}):
        figure.savefig(FOLDER / f"{name}.svg", metadata={"Date": None})


if __name__ == "__main__":
    print(draw())
