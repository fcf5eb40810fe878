"""Configurations of a device: any that somebody may write, and those that may well be meant."""

from __future__ import annotations

import math
from typing import Any

from hypothesis import strategies as st
from inerter.core import friction_laws, gas_laws, parameters

Values = dict[str, Any]

_EDGES = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    5e-324,
    -5e-324,
    1e-300,
    1e300,
    1.7e308,
    math.inf,
    -math.inf,
    math.nan,
]


def _around(middle: float, decades: float = 2.0) -> st.SearchStrategy[float]:
    """Positive numbers, log-uniform about one."""
    return st.floats(-decades, decades).map(lambda exponent: middle * 10.0**exponent)


def _signed(size: float) -> st.SearchStrategy[float]:
    return st.floats(-size, size)


def _text(numbers: list[float]) -> str:
    return " ".join(map(repr, numbers))


@st.composite
def anything(draw: st.DrawFn) -> Values:
    """Some parameters of a device at any number at all, a law by any name."""
    known = parameters()
    names = draw(st.lists(st.sampled_from(list(known)), max_size=6, unique=True))
    values: Values = {}
    for name in names:
        bounds = [b for b in (known[name].lower, known[name].upper) if math.isfinite(b)]
        near = [math.nextafter(b, side) for b in bounds for side in (-math.inf, math.inf)]
        values[name] = draw(
            st.one_of(st.floats(1e-6, 1e6), st.floats(), st.sampled_from([*_EDGES, *bounds, *near]))
        )
    laws = st.sampled_from([*friction_laws(), "lugr", "LuGre", "none ", "dahl;"])
    if draw(st.booleans()):
        values["friction"] = draw(laws)
    if draw(st.integers(0, 4)) == 0:
        values["gas_law"] = draw(st.sampled_from([*gas_laws(), "ideal"]))
    # in the order in which the plugin reads them: of several errors every door tells the first
    order = [*known, "friction", "gas_law"]
    return {name: values[name] for name in order if name in values}


@st.composite
def friction(draw: st.DrawFn) -> Values:
    """A friction law with levels that matter beside 10 N to 1 kN."""
    law = draw(st.sampled_from(list(friction_laws())))
    if law == "none":
        return {}
    if law == "bouc_wen":
        gamma = draw(_signed(400.0))
        return {
            "friction": law,
            "bw_alpha": draw(_around(1.0, 0.5)),
            "bw_beta": abs(gamma) + draw(_around(300.0, 0.5)),
            "bw_gamma": gamma,
            "bw_exponent": draw(st.floats(1.0, 3.0)),
            "bw_stiffness": draw(_around(2e4, 0.7)),
            # at 1 nothing yields, which a load refuses
            "bw_ratio": draw(st.floats(0.0, 0.99)),
        }
    level = draw(_around(50.0, 1.0))
    values: Values = {"friction": law}
    if law == "maxwell_slip":
        for k in range(1, 1 + draw(st.integers(1, 8))):
            values[f"slip_force_{k}"] = level * draw(st.floats(0.02, 1.0))
            values[f"slip_stiffness_{k}"] = draw(_around(3e4, 0.7))
    else:
        values["coulomb_force"] = level
    values["friction_asymmetry"] = draw(_signed(0.9))
    values["friction_gradient"] = draw(_signed(10.0))
    values["friction_curvature"] = draw(_signed(100.0))
    if law in ("stribeck", "lugre", "brown_mcphee"):
        values["static_force"] = level * draw(st.floats(1.0, 3.0))
        values["stribeck_velocity"] = draw(_around(2e-2, 0.7))
    if law in ("coulomb", "stribeck"):
        values["transition_velocity"] = draw(_around(2e-2, 0.5))
    if law == "rate_state":
        values["rate_effect"] = draw(st.floats(0.0, 0.1))
        values["age_effect"] = draw(st.floats(0.0, 0.1))
        values["transition_velocity"] = draw(_around(2e-2, 0.5))
    if law in ("dahl", "lugre"):
        values["bristle_stiffness"] = draw(_around(3e4, 0.7))
    if law == "lugre":
        values["bristle_damping"] = draw(st.floats(0.0, 200.0))
    if law == "dahl":
        values["dahl_exponent"] = draw(st.sampled_from([0.5, 1.0, 1.5, 2.0]))
    return values


@st.composite
def meant(draw: st.DrawFn) -> Values:
    """A device that may be meant for the quarter-car of the tests; every part comes and goes."""
    values = draw(friction())
    values["inertance"] = draw(_around(50.0, 1.0))
    if draw(st.booleans()):
        values |= {
            "viscous": draw(st.floats(0.0, 2e3)),
            "quadratic_damping": draw(st.floats(0.0, 1e3)),
            "damping_asymmetry": draw(st.floats(-0.999, 0.999)),
            "damping_knee": draw(st.floats(0.0, 10.0)),
            "damping_beyond": draw(st.floats(0.0, 10.0)),
            "damping_sharpness": draw(st.floats(1.0, 64.0)),
            "damping_exponent": draw(st.floats(-1.0, 1.0)),
            "damping_knee_back": draw(st.floats(0.0, 10.0)),
            "damping_beyond_back": draw(st.floats(0.0, 10.0)),
            "stiffness": draw(st.floats(0.0, 2e4)),
            "stiffness_cubic": draw(st.floats(0.0, 1e6)),
            "rest_length": draw(_signed(0.02)),
            "force_offset": draw(_signed(100.0)),
            "load_friction": draw(st.floats(0.0, 0.5)),
            "transition_velocity": values.get("transition_velocity", draw(_around(2e-2, 0.3))),
        }
    if draw(st.booleans()):
        values |= {
            "inertance_gradient": draw(_signed(2.0)),
            "inertance_curvature": draw(_signed(5.0)),
        }
        values |= {"inertance_speed_gradient": draw(st.floats(0.0, 0.5))}
        values |= {"flywheel_viscous": draw(st.floats(0.0, 200.0))}
    if draw(st.booleans()):
        rises = st.lists(_signed(0.15), min_size=2, max_size=8)
        values |= {
            "inertance_periods": _text([draw(_around(0.02, 0.5)), draw(_signed(0.1)), 1.0]),
            "force_curve": _text([100.0 * rise for rise in draw(rises)]),
            "viscous_curve": _text([50.0 + 50.0 * rise for rise in draw(rises)]),
            "curve_lower": -0.03,
            "curve_upper": draw(st.floats(-0.01, 0.05)),
        }
        if "friction" in values:
            values |= {"friction_curve": _text(draw(rises))}
    springy = values.get("viscous") and "viscous_curve" not in values and draw(st.booleans())
    if springy and values["damping_exponent"] >= 0.0:
        values["damper_stiffness"] = draw(_around(1e4, 0.7))
    if draw(st.booleans()):
        values |= {"leak_damping": draw(_around(1e3, 0.7))}
        values |= {"leak_quadratic_damping": draw(st.floats(0.0, 1e3))}
    if draw(st.booleans()):
        forces = st.lists(_signed(50.0), min_size=12, max_size=12)
        values |= {
            "force_map": _text(draw(forces)),
            "force_map_columns": draw(st.sampled_from([3, 4])),
            "force_map_lower": -0.03,
            "force_map_upper": draw(st.floats(-0.01, 0.05)),
            "force_map_speed": draw(_around(0.3, 0.5)),
            "force_map_passive": draw(st.sampled_from([0, 1])),
        }
        if draw(st.booleans()):
            values |= {"force_map_scale": draw(_around(0.05, 0.5))}
    if draw(st.booleans()):
        values |= {
            "stop_upper": draw(st.floats(5e-3, 5e-2)),
            "stop_stiffness": draw(_around(5e4, 0.5)),
        }
        values |= {
            "stop_stiffness_cubic": draw(st.floats(0.0, 1e8)),
            "stop_damping": draw(st.floats(0.0, 2.0)),
        }
    if draw(st.booleans()):
        values |= {
            "gas_pressure": draw(_around(2e5, 0.3)),
            "gas_area": draw(_around(1e-3, 0.3)),
            "gas_volume": draw(_around(5e-4, 0.3)),
            "gas_law": draw(st.sampled_from(list(gas_laws()))),
        }
    if draw(st.booleans()):
        values |= {
            "series_stiffness": draw(_around(1e5, 0.5)),
            "series_damping": draw(_around(300.0, 0.5)),
        }
        values |= {"series_hardening": draw(_signed(5.0))}
    for k in range(1, 1 + draw(st.sampled_from([0, 0, 1, 3]))):
        values[f"branch_stiffness_{k}"] = draw(_around(1e4, 0.7))
        values[f"branch_damping_{k}"] = draw(_around(300.0, 0.7))
    return values


def model_xml(actuator: str, instance: str = "", option: str = "", rest: str = "") -> str:
    """20 kg on a spring of 3e4 N/m that slide along joint x."""
    return f"""
<mujoco>
  <extension><plugin plugin="inerter.device">{instance}</plugin></extension>
  <option gravity="0 0 0" {option}/>
  <worldbody>
    <body name="mass">
      <joint name="x" type="slide" axis="1 0 0" stiffness="3e4"/>
      <geom size="0.1" mass="20" contype="0" conaffinity="0"/>
    </body>
  </worldbody>
  <actuator>{actuator}</actuator>
  {rest}
</mujoco>"""
