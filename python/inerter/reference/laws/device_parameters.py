"""Every parameter of a device beside those of its friction law, declared once, and their checks."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .force_map import MOST_COLUMNS, MOST_ROWS, ForceMap
from .parameters import UNSET, FrictionParameters, parameter
from .stroke import flat

GAS_LAWS = ("polytropic", "expanded")
FRICTION_SIDES = ("terminals", "flywheel")
IN_SERIES = (
    "series_stiffness", "series_damping", "clutch_force", "leak_damping", "leak_quadratic_damping",
)  # fmt: skip
"""What may stand between the terminals and the flywheel."""
CONTROLS = (
    "force", "viscous", "quadratic_damping", "flywheel_viscous", "minor_loss", "coulomb_force",
    "static_force", "stiffness", "bw_stiffness", "inertance",
)  # fmt: skip
"""What a control can be: a force beside the device, or a parameter that it sets."""


@dataclass(frozen=True, kw_only=True)
class DeviceParameters(FrictionParameters):
    """All parameters of one device; SI units, every default harmless. NaN means: not given.

    Raises
    ------
    ValueError
        A parameter is outside its bounds, or parameters do not go together; the message names
        the parameter, its value and what to do.
    """

    inertance: float = parameter(0.0, "kg", "inertance b", at_least=0.0)
    inertance_gradient: float = parameter(0.0, "1/m", "relative rise of b per x")
    inertance_curvature: float = parameter(0.0, "1/m^2", "relative rise of b per x^2")
    inertance_speed_gradient: float = parameter(0.0, "s/m", "relative rise of b per |v|")
    viscous: float = parameter(0.0, "N s/m", "linear damping c", at_least=0.0)
    quadratic_damping: float = parameter(0.0, "N s^2/m^2", "quadratic damping c2", at_least=0.0)
    damping_asymmetry: float = parameter(
        0.0, "-", "relative rise of the damping while x grows", at_least=-0.999, at_most=0.999
    )
    damping_knee: float = parameter(
        0.0, "m/s", "speed at which the linear damping bends; 0: nowhere", at_least=0.0
    )
    damping_beyond: float = parameter(
        1.0, "-", "its slope beyond, relative to that below", at_least=0.0
    )
    damping_sharpness: float = parameter(
        2.0, "-", "how sharply it bends there: 2 gently, 64 a corner", at_least=1.0, at_most=64.0
    )
    damping_exponent: float = parameter(
        0.0, "-", "power of the speed beyond it of what bends", at_least=-1.0, at_most=1.0
    )
    damping_knee_back: float = parameter(
        UNSET, "m/s", "the same speed while x shrinks, damping_knee where not given", at_least=0.0
    )
    damping_beyond_back: float = parameter(
        UNSET, "-", "the same slope while x shrinks, damping_beyond where not given", at_least=0.0
    )
    damper_stiffness: float = parameter(
        0.0, "N/m", "spring in series with the dampers k_d; 0: none", at_least=0.0
    )
    stiffness: float = parameter(0.0, "N/m", "linear stiffness k")
    stiffness_cubic: float = parameter(0.0, "N/m^3", "cubic stiffness k3")
    rest_length: float = parameter(0.0, "m", "length at which the displacement is zero")
    force_offset: float = parameter(0.0, "N", "constant force f0")
    # at 1 the device locks: no force says what it accelerates by
    load_friction: float = parameter(
        0.0, "-", "friction share mu of the inertance force", at_least=0.0, at_most=1.0
    )

    mu_forward: float = parameter(
        UNSET, "-", "the same while the motion drives the flywheel", at_least=0.0
    )
    mu_backward: float = parameter(
        UNSET, "-", "the same while the flywheel drives", at_least=0.0, at_most=1.0
    )
    friction_side: str = "terminals"

    series_stiffness: float = parameter(0.0, "N/m", "spring in series k_s", at_least=0.0)
    series_damping: float = parameter(0.0, "N s/m", "damper in series c_s", at_least=0.0)
    series_hardening: float = parameter(0.0, "1/m", "relative rise of k_s per deflection")
    backlash: float = parameter(0.0, "m", "half of the free play", at_least=0.0)
    clutch_force: float = parameter(0.0, "N", "force at which a clutch slips F_c", at_least=0.0)
    clutch_asymmetry: float = parameter(
        0.0, "-", "relative rise of F_c in tension", at_least=-1.0, at_most=1.0
    )
    leak_damping: float = parameter(0.0, "N s/m", "laminar leak c_l", at_least=0.0)
    leak_quadratic_damping: float = parameter(0.0, "N s^2/m^2", "turbulent leak q_l", at_least=0.0)
    flywheel_viscous: float = parameter(0.0, "N s/m", "damping of the flywheel", at_least=0.0)

    branch_stiffness_1: float = parameter(0.0, "N/m", "spring of branch 1", at_least=0.0)
    branch_damping_1: float = parameter(0.0, "N s/m", "dashpot of branch 1", at_least=0.0)
    branch_stiffness_2: float = parameter(0.0, "N/m", "spring of branch 2", at_least=0.0)
    branch_damping_2: float = parameter(0.0, "N s/m", "dashpot of branch 2", at_least=0.0)
    branch_stiffness_3: float = parameter(0.0, "N/m", "spring of branch 3", at_least=0.0)
    branch_damping_3: float = parameter(0.0, "N s/m", "dashpot of branch 3", at_least=0.0)

    stop_lower: float = parameter(UNSET, "m", "shortest displacement before the stop")
    stop_upper: float = parameter(UNSET, "m", "longest displacement before the stop")
    stop_stiffness: float = parameter(0.0, "N/m", "stiffness of the stops", at_least=0.0)
    stop_stiffness_cubic: float = parameter(
        0.0, "N/m^3", "rise of the stops' stiffness, force per depth^3", at_least=0.0
    )
    stop_damping: float = parameter(0.0, "s/m", "damping of the stops", at_least=0.0)

    gas_law: str = "polytropic"
    gas_pressure: float = parameter(0.0, "Pa", "pressure p0 at y = 0", at_least=0.0)
    gas_area: float = parameter(UNSET, "m^2", "area A under gas; below 0 above it")
    gas_volume: float = parameter(0.0, "m^3", "volume V0 at y = 0", at_least=0.0)
    gas_exponent: float = parameter(1.4, "-", "polytropic exponent", above=0.0, at_most=5.0)

    piston_area: float = parameter(0.0, "m^2", "piston area A1", at_least=0.0)
    channel_area: float = parameter(0.0, "m^2", "channel cross-section A2", at_least=0.0)
    channel_length: float = parameter(0.0, "m", "channel length l", at_least=0.0)
    fluid_density: float = parameter(1000.0, "kg/m^3", "density rho", above=0.0)
    fluid_viscosity: float = parameter(0.0, "Pa s", "dynamic viscosity mu", at_least=0.0)
    channel_roughness: float = parameter(0.0, "m", "wall roughness", at_least=0.0)
    minor_loss: float = parameter(0.0, "-", "loss at the channel's ends K", at_least=0.0)

    curve_lower: float = parameter(UNSET, "m", "place of the first value of every curve")
    curve_upper: float = parameter(UNSET, "m", "place of the last value of every curve")

    coil_diameter: float = parameter(0.0, "m", "diameter of the channel's coil D_c", at_least=0.0)

    force_map: Any = ()
    force_map_lower: float = parameter(UNSET, "m", "place of the first row of force_map")
    force_map_upper: float = parameter(UNSET, "m", "place of the last row of force_map")
    force_map_speed: float = parameter(UNSET, "m/s", "velocity of its last column", above=0.0)
    force_map_scale: float = parameter(
        UNSET, "m/s", "columns evenly spaced in asinh(v / scale)", above=0.0
    )
    force_map_columns: float = parameter(
        UNSET, "-", "number of its columns", at_least=2.0, at_most=16.0
    )
    force_map_passive: float = parameter(
        0.0, "-", "1: without what would give energy", at_least=0.0, at_most=1.0
    )

    control: str = "force"
    control_lower: float = parameter(UNSET, "-", "smallest value that the control sets")
    control_upper: float = parameter(UNSET, "-", "largest value that the control sets")
    control_lag: float = parameter(0.0, "s", "time constant of the control's value", at_least=0.0)
    command: float = UNSET
    """What the control commands at present, in the unit of what it sets; NaN: nothing."""

    @property
    def has_series(self) -> bool:
        """Whether something stands in series with the inertance."""
        return self.series_stiffness > 0.0 or self.series_damping > 0.0 or self.has_clutch

    @property
    def has_clutch(self) -> bool:
        """Whether something slips in series with the inertance."""
        return max(self.clutch_force, self.leak_damping, self.leak_quadratic_damping) > 0.0

    @property
    def load_shares(self) -> tuple[float, float]:
        """Mu forward and backward [-]."""
        given = (self.mu_forward, self.mu_backward)
        forward, backward = (self.load_friction if np.isnan(mu) else mu for mu in given)
        return forward, backward

    @property
    def damper(self) -> tuple[Any, ...]:
        """What `parallel.damping_force` takes after the velocity."""
        forth = self.damping_knee, self.damping_beyond
        knee, beyond = self.damping_knee_back, self.damping_beyond_back
        back = forth[0] if np.isnan(knee) else knee, forth[1] if np.isnan(beyond) else beyond
        shape = forth, back, self.damping_sharpness, self.damping_exponent
        return self.viscous, self.quadratic_damping, self.damping_asymmetry, *shape

    @cached_property
    def branches(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """K_i [N/m] and C_i [N s/m] of the branches that are there, shape (n,)."""
        found = [
            (getattr(self, f"branch_stiffness_{i}"), getattr(self, f"branch_damping_{i}"))
            for i in (1, 2, 3)
        ]
        there = np.array([pair for pair in found if pair[0] > 0.0]).reshape(-1, 2)
        return there[:, 0], there[:, 1]

    @cached_property
    def surface(self) -> ForceMap | None:
        """The force over displacement and velocity; None without."""
        if not self.force_map:
            return None
        return ForceMap(
            values=self.force_map,
            lower=self.force_map_lower,
            upper=self.force_map_upper,
            speed=self.force_map_speed,
            scale=self.force_map_scale,
            columns=int(self.force_map_columns),
            passive=self.force_map_passive == 1.0,
        )

    @property
    def rubs_flywheel(self) -> bool:
        """Whether friction acts behind a series element."""
        return self.has_series and self.friction_side == "flywheel"

    def __post_init__(self) -> None:
        """Check what was given, see Raises."""
        self._check_control()
        super().__post_init__()
        self._check_side()
        self._check_branches()
        self._check_damper_spring()
        self._check_channel()
        self._check_series()
        self._check_stops()
        self._check_gas()
        self._check_along(self.friction, self.friction_asymmetry, self.viscous)
        self._check_map()

    def _check_map(self) -> None:
        values = flat(self.force_map)
        object.__setattr__(self, "force_map", values)
        needed = ("lower", "upper", "speed", "columns")
        given = [n for n in (f"force_map_{n}" for n in needed) if not np.isnan(getattr(self, n))]
        if not values:
            given += ["force_map_scale"] * (not np.isnan(self.force_map_scale))
            given += ["force_map_passive"] * (self.force_map_passive > 0.0)
            if given:
                raise ValueError(
                    f"{given[0]}: {getattr(self, given[0])} without force_map; give its values, or "
                    f"drop {given[0]}"
                )
            return
        if len(given) < 4 or not self.force_map_lower < self.force_map_upper:
            raise ValueError(
                f"force_map_lower: {self.force_map_lower} m, force_map_upper "
                f"{self.force_map_upper} m, force_map_speed {self.force_map_speed} m/s, "
                f"force_map_columns {self.force_map_columns}; give all of them, the first below "
                "the second"
            )
        rows = len(values) / self.force_map_columns
        whole = self.force_map_columns % 1.0 == 0.0 and rows % 1.0 == 0.0
        if not (whole and 2.0 <= rows <= MOST_ROWS):
            raise ValueError(
                f"force_map_columns: {self.force_map_columns} columns of {len(values)} numbers; "
                f"give 2 to {MOST_COLUMNS} columns and 2 to {MOST_ROWS} rows"
            )
        if not np.isfinite(values).all():
            raise ValueError("force_map: a number is not finite; give finite ones")
        if self.force_map_passive not in (0.0, 1.0):
            raise ValueError(f"force_map_passive: {self.force_map_passive}; give 0 or 1")

    def _check_control(self) -> None:
        if self.control not in CONTROLS:
            raise ValueError(f"control: '{self.control}' is not one of {', '.join(CONTROLS)}")
        bounds = {name: getattr(self, name) for name in ("control_lower", "control_upper")}
        given = [name for name, bound in bounds.items() if not np.isnan(bound)]
        given += ["control_lag"] * (self.control_lag > 0.0)
        if self.control == "force":
            if given:
                raise ValueError(
                    f"{given[0]}: {getattr(self, given[0])}, but control 'force' does not read it; "
                    "drop it, or name the parameter that the control sets"
                )
            return
        lower, upper = bounds.values()
        if not lower < upper:
            raise ValueError(
                f"control_lower: {lower} is not below control_upper {upper}; give both, between "
                f"which the control sets {self.control}"
            )
        declared = type(self).__dataclass_fields__[self.control]
        stated = getattr(self, self.control)
        if np.isnan(stated) or (stated == declared.default and not lower <= stated <= upper):
            begin = lower if np.isnan(stated) else float(np.clip(stated, lower, upper))
            object.__setattr__(self, self.control, begin)
        elif not lower <= stated <= upper:
            raise ValueError(
                f"{self.control}: {stated} is not from control_lower {lower} to control_upper "
                f"{upper}; give a value between them, or none"
            )
        # what holds at both bounds holds between them
        for bound in (lower, upper):
            free = {"control": "force", "control_lower": UNSET, "control_upper": UNSET}
            if bound == 0.0 and self.control in ("coulomb_force", "static_force"):
                # a clutch may be open, but no bristle goes without a level
                bound = 0.0 if self.friction in ("dahl", "lugre") else 5e-324
            replace(self, **free, control_lag=0.0, **{self.control: bound})

    def _check_branches(self) -> None:
        last = True
        for i in (1, 2, 3):
            pair = [getattr(self, f"branch_{name}_{i}") for name in ("stiffness", "damping")]
            there = pair[0] > 0.0
            if there != (pair[1] > 0.0):
                raise ValueError(
                    f"branch_stiffness_{i}: {pair[0]} N/m with branch_damping_{i} {pair[1]} N s/m "
                    "is half a branch; give both above 0, or neither"
                )
            if there and not last:
                raise ValueError(
                    f"branch_stiffness_{i}: {pair[0]} N/m comes after branch {i - 1}, which is not "
                    "there; give it too: branches are numbered from 1 without a gap"
                )
            last = there

    def _check_damper_spring(self) -> None:
        if self.damper_stiffness == 0.0:
            return
        said = f"damper_stiffness: {self.damper_stiffness} N/m"
        if self.control in ("viscous", "quadratic_damping"):
            raise ValueError(f"{said} with control '{self.control}'; drop one of the two")
        if self.viscous_curve or self.viscous_periods:
            raise ValueError(f"{said} with viscous along the stroke; drop one of the two")
        if self.viscous == 0.0:
            raise ValueError(f"{said} with viscous 0.0 N s/m; give viscous above 0")
        bends = self.damping_knee > 0.0 or self.damping_knee_back > 0.0
        if self.damping_exponent < 0.0 and bends:
            raise ValueError(
                f"{said} with damping_exponent {self.damping_exponent}; give one of at least 0"
            )

    def _check_side(self) -> None:
        if self.friction_side not in FRICTION_SIDES:
            raise ValueError(
                f"friction_side: '{self.friction_side}' is not one of {', '.join(FRICTION_SIDES)}"
            )
        for name in ("mu_forward", "mu_backward"):
            mu = getattr(self, name)
            if self.load_friction > 0.0 and not np.isnan(mu) and mu != self.load_friction:
                raise ValueError(
                    f"{name}: {mu}, but load_friction {self.load_friction} is for both directions; "
                    "give one or the other"
                )
        if self.friction_side == "flywheel" and self.load_shares[1] >= 1.0:
            raise ValueError(
                f"load_friction: {self.load_shares[1]} locks the flywheel that it acts on; give "
                "less than 1"
            )
        if self.friction == "bouc_wen" and max(self.load_shares) > 0.0:
            if self.bw_beta + self.bw_gamma <= 0.0:
                raise ValueError(
                    f"bw_beta + bw_gamma: {self.bw_beta + self.bw_gamma} never yields, so that no "
                    "load can raise where it does; give more than 0, or no load friction"
                )
            if self.bw_ratio == 1.0:
                raise ValueError(
                    f"bw_ratio: {self.bw_ratio} leaves no share that yields, so that no load can "
                    "raise where it does; give less than 1, or no load friction"
                )

    def _check_series(self) -> None:
        if self.series_stiffness == 0.0:
            for name, unit in (("series_hardening", "1/m"), ("backlash", "m")):
                if getattr(self, name) != 0.0:
                    raise ValueError(
                        f"{name}: {getattr(self, name)} {unit} needs series_stiffness > 0; "
                        f"give series_stiffness, or drop {name}"
                    )
        self._check_clutch()
        if self.has_series and self.inertance == 0.0 and self.channel_area == 0.0:
            given = next(name for name in IN_SERIES if getattr(self, name) > 0.0)
            raise ValueError(
                f"{given}: {getattr(self, given)} stands in series with an inertance of 0 kg; "
                f"give inertance > 0, or drop {given}"
            )

    def _check_clutch(self) -> None:
        if self.clutch_asymmetry != 0.0 and self.clutch_force == 0.0:
            raise ValueError(f"clutch_asymmetry: {self.clutch_asymmetry} needs clutch_force > 0")
        if self.has_clutch and self.backlash > 0.0:
            raise ValueError(f"backlash: {self.backlash} m beside what slips; drop one of the two")
        leaks = self.series_stiffness * max(self.leak_damping, self.leak_quadratic_damping) > 0.0
        if self.clutch_force > 0.0 and self.series_damping == 0.0 and not leaks:
            raise ValueError(f"clutch_force: {self.clutch_force} N needs series_damping > 0")

    def _check_stops(self) -> None:
        there = [n for n in ("stop_lower", "stop_upper") if not np.isnan(getattr(self, n))]
        if there and self.stop_stiffness == 0.0:
            raise ValueError(
                f"{there[0]}: {getattr(self, there[0])} m needs stop_stiffness > 0; "
                f"give stop_stiffness, or drop {there[0]}"
            )
        for name in ("stop_stiffness", "stop_stiffness_cubic", "stop_damping"):
            if not there and getattr(self, name) > 0.0:
                raise ValueError(
                    f"{name}: {getattr(self, name)} without a stop; give stop_lower or stop_upper"
                )
        if self.stop_lower >= self.stop_upper:
            raise ValueError(
                f"stop_lower: {self.stop_lower} m is not below stop_upper {self.stop_upper} m; "
                "exchange them"
            )

    def _check_gas(self) -> None:
        if self.gas_law not in GAS_LAWS:
            raise ValueError(f"gas_law: '{self.gas_law}' is not one of {', '.join(GAS_LAWS)}")
        if self.gas_pressure == 0.0:
            unused = {
                "gas_law": self.gas_law != "polytropic",
                "gas_area": not np.isnan(self.gas_area) and self.gas_area != 0.0,
                "gas_volume": self.gas_volume != 0.0,
                "gas_exponent": self.gas_exponent != 1.4,
            }
            for name, given in unused.items():
                if given:
                    raise ValueError(
                        f"{name}: {getattr(self, name)} without a gas spring; give gas_pressure > 0"
                    )
            return
        area = self.piston_area if np.isnan(self.gas_area) else self.gas_area
        for name, value in (("gas_area", area), ("gas_volume", self.gas_volume)):
            if value == 0.0:
                raise ValueError(
                    f"{name}: the gas spring (gas_pressure {self.gas_pressure} Pa) needs one that "
                    "is not 0"
                )

    def _check_channel(self) -> None:
        geometry = ("piston_area", "channel_area", "channel_length")
        losses = ("fluid_viscosity", "minor_loss", "channel_roughness", "coil_diameter")
        wanted = [n for n in (*geometry[1:], *losses) if getattr(self, n) > 0.0]
        # the piston may also be there for the gas alone
        if self.piston_area > 0.0 and self.gas_pressure == 0.0:
            wanted.append("piston_area")
        if not wanted:
            return
        missing = [name for name in geometry if getattr(self, name) == 0.0]
        if missing:
            raise ValueError(
                f"{missing[0]}: 0 leaves the channel ({wanted[0]} {getattr(self, wanted[0])}) "
                f"incomplete; give {' and '.join(missing)}"
            )
        if 0.0 < self.coil_diameter <= np.sqrt(4.0 * self.channel_area / np.pi):
            raise ValueError(
                f"coil_diameter: {self.coil_diameter} m is not above the channel's own diameter; "
                "give a larger one, or 0 for a straight channel"
            )
        if self.inertance > 0.0:
            raise ValueError(
                f"inertance: {self.inertance} kg, but the channel's geometry states one too; "
                "give one of them"
            )
