"""How a vehicle's damper may differ from a straight line: it bends, or changes along the stroke.

A damper beside the device, of a joint or a tendon, is straight; where its length goes with the
device's, the device damps in its place.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from inerter.catalogue.coordinates import COORDINATES
from inerter.catalogue.scales import Range
from inerter.diagnose.vehicle.candidate import VehicleCandidate, candidate
from inerter.diagnose.vehicle.model import BENT, VehicleModel, key
from inerter.diagnose.vehicle.parts import Suspension

if TYPE_CHECKING:
    from inerter.diagnose.vehicle.effects import Effects

_USUAL_SHARPNESS = 2.0
"""Of a knee of the damping where nobody states another."""


def _suspension(effects: Effects, device: str) -> Suspension | None:
    return next((p for p in effects.user.parts.suspensions if p.device == device), None)


def _damped(effects: Effects, device: str, model: VehicleModel) -> bool:
    """Whether a device is the damper between its wheel and its body."""
    part = _suspension(effects, device)
    if part is None or part.damper is None:
        return False
    return part.damper.kind == "device" or model.bends(device)


def bent(effects: Effects, device: str, model: VehicleModel) -> Iterator[VehicleCandidate]:
    """Damping that bends with the speed, about what is stated: gently, then more or less so.

    A damper beside the device, a joint's or a tendon's, is straight: the device damps in its place
    where their lengths go together.
    """
    part, scale = _suspension(effects, device), effects.scales[device]
    if part is None or part.damper is None or not (part.alike or part.damper.kind == "device"):
        return
    if f"{device}.damping_sharpness" in model.free:
        return
    now = effects.damping(device, model)
    shape, displaced = ["damping_knee", "damping_beyond"], ()
    if part.damper.kind != "device":
        displaced = key(part.damper.element, ("damping",))
    bent = f"{device}.damping_knee"
    known = effects.stated(bent, model)
    held: dict[str, float] = {}
    if f"{device}.bump_damping" not in model.free:
        shape.insert(0, "viscous")
        held = {"viscous": now if bent in model.free else 1.1 * now}
    if known > 0:
        beyond = effects.stated(f"{device}.damping_beyond", model)
        knees = [{**held, "damping_knee": known, "damping_beyond": beyond}]
    else:
        knees = [
            {**held, "damping_knee": r * scale.v, "damping_beyond": b}
            for r in (0.4, 1.0) for b in (0.5, 1.5)
        ]  # fmt: skip
    starts = knees
    if known > 0:
        sharp = effects.stated(f"{device}.damping_sharpness", model) or _USUAL_SHARPNESS
        shape.append("damping_sharpness")
        starts = [{**knee, "damping_sharpness": r * sharp} for knee in knees for r in (0.5, 2.0, 4)]
    sizes = {name: COORDINATES[name].range(scale.of_data) for name in shape}
    if "viscous" in shape:
        sizes["viscous"] = Range(now or scale.force / scale.v, 0.0)
    yield candidate(BENT, device, starts, sizes, (), displaced=displaced)


def along(effects: Effects, device: str, model: VehicleModel) -> Iterator[VehicleCandidate]:
    """Damping that grows or falls along the stroke."""
    if not _damped(effects, device, model) or effects.user.has_damping_curve(device):
        return
    scale = effects.scales[device]
    reach = max(scale.largest, -scale.smallest)
    most = 0.9 / reach
    yield candidate(
        "position_dependent_damping", device, [{"damping_gradient": 0.2 * most}],
        {"damping_gradient": Range(most, -most, most)}, ("damping_gradient",),
    )  # fmt: skip


def out_of_the_bend(
    effects: Effects, device: str, model: VehicleModel, width: Mapping[str, float]
) -> list[dict[str, float]]:
    """Friction for a part of what damping that bends holds back beyond its knee.

    Early in a search the bend stands for both: its knee is too low and its slope before it too
    steep. width: of the friction's sign(v).
    """
    if f"{device}.viscous" not in model.free or not model.bends(device):
        return []
    slope, knee, beyond = (
        model.values[f"{device}.{name}"] for name in ("viscous", "damping_knee", "damping_beyond")
    )
    held, after = slope * knee * (1.0 - beyond), slope * beyond
    # what friction rounds is no corner
    sharp = f"{device}.damping_sharpness"
    more = {"damping_sharpness": 4 * model.values[sharp]} if sharp in model.free else {}
    starts = []
    for share in (0.3, 0.6):
        for later in (1.0, 2.0):
            before = after + (1.0 - share) * held / (later * knee)
            starts.append({
                "coulomb_force": share * held, "viscous": before, "damping_knee": later * knee,
                "damping_beyond": after / before, **more, **width,
            })  # fmt: skip
    return starts if held > 0 else []
