"""The paper's tables: tests, starting values, bounds, identified parameters.

Equations, with the names of a device's parameters in this package (SI units):

    Dahl      F = b a + k_s z + c_s v                     z' = v - k_s |v| z / F_c
    LuGre     F = b a + s0 z + s1 z' + s2 v               z' = v - s0 |v| z / g(v)
              g = F_c + (F_s - F_c) exp(-|v / v_s|^delta)
    Bouc-Wen  F = b a + c0 v + A k0 x + (1 - A) k0 z
              z' = alpha v - beta |v| z |z|^(n-1) - gamma v |z|^n

What is wrong in print, and what is done about it:

- LuGre is printed without s0 in z'. Then g is a length, not a force, and the bristle of the
  identified set slides after a metre. `lugre_printed` keeps the printed equation by
  g_standard = s0 g_printed; `lugre` takes the printed numbers as those of the standard form.
- Bouc-Wen's last term is printed without its exponent n; the identified n is 1.
- Table 2 bounds Bouc-Wen's b by 250 from both sides, while 154.36 is identified. Mended to 10, the
  lower bound of the other models.
- Table 2 starts Bouc-Wen's b (50) and k0 (0.5) outside their bounds. Moved to the nearest bound.
- Table 2 allows n from -5. Below 1 the rate of z has no bound or no unique solution at z = 0.
  Mended to 1.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

FREQUENCIES = (1.0, 2.0, 3.0, 4.0)
"""Of the tests [Hz]."""
AMPLITUDES = (10e-3, 8e-3, 6e-3, 4e-3)
"""Of the tests [m]: 10 mm at 1 Hz and 4 mm at 4 Hz are printed, those between are chosen."""

PITCH, INERTIA = 4e-3, 6.43e-5
IDEAL_INERTANCE = float((2 * np.pi / PITCH) ** 2 * INERTIA)
"""b = (2 pi / P)^2 J [kg] of Table 1."""


@dataclass(frozen=True)
class Box:
    """Where a search begins and how far it may go, shape (p,) each; `mended` says what changed."""

    start: Array
    lower: Array
    upper: Array
    mended: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class PaperModel:
    """One of the three models.

    Attributes
    ----------
    name
        The friction law.
    names, symbols
        Parameters in the order of the paper's vector: their names here and there.
    start, lower, upper
        Table 2 as printed.
    identified
        Table 3.
    """

    name: str
    title: str
    names: tuple[str, ...]
    symbols: tuple[str, ...]
    start: tuple[float, ...]
    lower: tuple[float, ...]
    upper: tuple[float, ...]
    identified: tuple[float, ...]

    def values(self, vector: Array | tuple[float, ...]) -> dict[str, float | str]:
        """A device's parameters from the paper's vector, shape (p,).

        Values at a bound that no device can have are moved by as much as it needs: a level and a
        stiffness above 0, a static force not below the Coulomb force.
        """
        found = {n: float(v) for n, v in zip(self.names, vector, strict=True)}
        for name in ("coulomb_force", "bristle_stiffness"):
            if name in found:
                found[name] = max(found[name], _LEAST)
        if "static_force" in found:
            found["static_force"] = max(found["static_force"], found["coulomb_force"])
        return {"friction": self.name, **found}

    def printed_box(self) -> Box:
        """Table 2 as printed."""
        return Box(np.array(self.start), np.array(self.lower), np.array(self.upper))

    def box(self) -> Box:
        """Table 2 with what cannot be meant mended."""
        box = self.printed_box()
        lower, mended = box.lower.copy(), []
        for i, name in enumerate(self.names):
            low = {"inertance": _LOWEST_INERTANCE, "bw_exponent": 1.0}.get(name)
            if low is not None and lower[i] != low:
                mended.append(f"lower bound of {self.symbols[i]}: {lower[i]:g} -> {low:g}")
                lower[i] = low
        start = np.clip(box.start, lower, box.upper)
        for i in np.flatnonzero(np.clip(box.start, box.lower, box.upper) != box.start):
            moved = f"-> {start[i]:g}" if start[i] != box.start[i] else "but inside the mended ones"
            mended.append(
                f"start of {self.symbols[i]}: {box.start[i]:g}, outside its bounds "
                f"[{box.lower[i]:g}, {box.upper[i]:g}], {moved}"
            )
        return Box(start, lower, box.upper, tuple(mended))


_LEAST = 1e-9
_LOWEST_INERTANCE = 10.0

MODELS: Mapping[str, PaperModel] = MappingProxyType(
    {
        "dahl": PaperModel(
            name="dahl",
            title="Dahl",
            names=("bristle_stiffness", "coulomb_force", "viscous", "inertance"),
            symbols=("k_s", "F_c", "c_s", "b"),
            start=(1e5, 1000.0, 500.0, 50.0),
            lower=(0.0, 0.0, 0.0, 10.0),
            upper=(1e9, 2000.0, 2000.0, 250.0),
            identified=(4.29e4, 62.0, 10.2, 174.0),
        ),
        "lugre": PaperModel(
            name="lugre",
            title="LuGre",
            names=(
                "bristle_stiffness", "bristle_damping", "viscous", "static_force",
                "coulomb_force", "stribeck_velocity", "stribeck_exponent", "inertance",
            ),
            symbols=("sigma_0", "sigma_1", "sigma_2", "F_s", "F_c", "v_s", "delta", "b"),
            start=(200.0, 100.0, 100.0, 10.0, 10.0, 1e-3, 1.0, 50.0),
            lower=(0.0, 0.0, 0.0, 1.0, 1.0, 1e-3, 0.1, 10.0),
            upper=(1e5, 2000.0, 2000.0, 200.0, 180.0, 0.1, 2.0, 250.0),
            identified=(149.21, 443.35, 204.38, 1.43, 1.0, 4.19e-2, 1.98, 151.51),
        ),
        "bouc_wen": PaperModel(
            name="bouc_wen",
            title="Bouc-Wen",
            names=(
                "bw_alpha", "bw_beta", "bw_gamma", "bw_exponent", "bw_ratio", "viscous",
                "bw_stiffness", "inertance",
            ),
            symbols=("alpha", "beta", "gamma", "n", "A", "c_0", "k_0", "b"),
            start=(1.0, 10.0, 10.0, 1.0, 50.0, 50.0, 0.5, 50.0),
            lower=(1.0, 1.0, 1.0, -5.0, 1.0, 1.0, 1.0, 250.0),
            upper=(50.0, 50.0, 50.0, 2.0, 1e3, 1e3, 10.0, 250.0),
            identified=(1.23, 1.61, 1.35, 1.0, 341.81, 132.0, 1.01, 154.36),
        ),
    }
)  # fmt: skip
"""The models by friction law."""

MAKERS: Mapping[str, str] = MappingProxyType(
    {
        "dahl": "Dahl",
        "lugre_printed": "LuGre, z' as printed",
        "lugre": "LuGre, standard",
        "bouc_wen": "Bouc-Wen",
    }
)
"""Devices that tests are made with, and their titles."""


def maker_values(maker: str) -> dict[str, float | str]:
    """Parameters of the device that Table 3 describes, by its name in `MAKERS`."""
    model = MODELS[maker.removesuffix("_printed")]
    values = model.values(model.identified)
    if maker == "lugre_printed":
        stiffness = float(values["bristle_stiffness"])
        for name in ("static_force", "coulomb_force"):
            values[name] = stiffness * float(values[name])
    return values
