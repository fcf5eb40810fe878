"""The friction laws as they are compared: one level, 80 N at 0.05 m/s and above, in every law."""

from __future__ import annotations

from typing import Any

INERTANCE = 113.0
"""Of every device [kg]."""

_LEVEL = {"coulomb_force": 80.0}
_FALL = {**_LEVEL, "static_force": 120.0, "stribeck_velocity": 0.05}
_SIGN = {"transition_velocity": 0.02}
_BRISTLE = {"bristle_stiffness": 5e4}

LAWS: dict[str, dict[str, Any]] = {
    "none": {},
    "coulomb": {**_LEVEL, **_SIGN},
    "stribeck": {**_FALL, **_SIGN},
    "dahl": {**_LEVEL, **_BRISTLE},
    "lugre": {**_FALL, **_BRISTLE, "bristle_damping": 200.0},
    "bouc_wen": {"bw_stiffness": 5e4, "bw_beta": 500.0, "bw_gamma": 125.0},
    "brown_mcphee": _FALL,
    "maxwell_slip": {
        **{f"slip_stiffness_{i}": k for i, k in enumerate((2e4, 1e4, 5e3, 5e3), 1)},
        **{f"slip_force_{i}": 20.0 for i in range(1, 5)},
    },
    "rate_state": {**_LEVEL, **_SIGN},
}
"""Parameters by law; the yield deflection of the bristles is 1.6 mm."""


def parameters_of(law: str) -> dict[str, Any]:
    """What `Device` and the plugin take for an inerter with this friction."""
    return {"inertance": INERTANCE, "friction": law, **LAWS[law]}
