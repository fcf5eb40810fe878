"""One case: devices drawn into one model, and all checks."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from inerter.catalogue.friction import FRICTION

from zoo import checks
from zoo.draw import INTEGRATORS, Case, Drawn, added, draw
from zoo.models import NoModelError, bad, bare, started

STEPS = 30
# what the plugin refuses for a reason that README and limits.md give
REASONS = (
    "wraps around geom",
    "may fall asleep",
    "at the same place in the initial pose",
    "do not move against each other",
    "which is all that it acts on",
)
# friction that changes its sign with the velocity
SHARP = tuple(law.name for law in FRICTION.values() if law.level and not law.memory)
# springs, which move a model at rest
SPRINGS = ("stiffness", "stop_upper", "stop_stiffness")


def run_case(path: Path, seed: int, number: int) -> dict[str, Any]:
    """Figures of a case; its status is no_model, refused, or ran.

    The same file, seed and number give the same case on the same release of NumPy and MuJoCo.
    """
    rng = np.random.default_rng([seed, number])
    result: dict[str, Any] = {"status": "ran", "figures": {}}
    warnings: list[str] = []
    mujoco.set_mju_user_warning(warnings.append)
    try:
        spec, small = bare(path)
        data = started(small, rng, int(rng.integers(0, 60)))
    except NoModelError as error:
        return {"status": "no_model", "reason": str(error)}
    case = draw(rng, spec, small, data)
    if not case.devices:
        return {"status": "no_model", "reason": "nothing in it can carry a device"}
    result |= {
        "integrator": case.integrator,
        "nv": int(small.nv),
        "devices": [{"place": each.words, "gear": each.gear, **each.keys} for each in case.devices],
    }
    try:
        whole = added(spec, case)
        model = whole.compile()
    except (ValueError, mujoco.FatalError) as error:
        text = " ".join(dict.fromkeys(str(error).split("\n")))
        good = any(reason in text for reason in REASONS)
        return result | {"status": "refused", "reason": text, "good": good}
    for each in (small, model):
        _set_options(each, case)
    warnings.clear()
    with tempfile.TemporaryDirectory() as folder:
        result["figures"] = _figures(spec, small, data, whole, model, case, Path(folder))
    said = sorted({text.strip() for text in warnings if "inerter" in text})
    # no number of rounds makes a force fit what the engine's noslip solver leaves of a constraint
    unfit = float(sum("did not fit" in text for text in warnings))
    result["figures"]["unfit"] = unfit if not model.opt.noslip_iterations else 0.0
    if said:
        result["warnings"] = said[:5]
    # what the plugin has said to be too fast or too stiff for the step may diverge
    fast = ("too stiff", "stiff for", "faster than RK4 resolves")
    if any(words in text for text in said for words in fast):
        for name in ("diverges", "rest", "energy"):
            result["figures"].pop(name, None)
    return result


def _set_options(model: mujoco.MjModel, case: Case) -> None:
    model.opt.integrator = INTEGRATORS[case.integrator]
    if case.tight:
        model.opt.tolerance, model.opt.iterations = 1e-12, 200
        model.opt.ls_iterations, model.opt.ls_tolerance = 100, 1e-6


def _figures(
    spec: mujoco.MjSpec,
    small: mujoco.MjModel,
    start: mujoco.MjData,
    whole: mujoco.MjSpec,
    model: mujoco.MjModel,
    case: Case,
    folder: Path,
) -> dict[str, float]:
    """Every figure of a case; one that runs away without devices has none."""
    before = time.perf_counter()
    side = mujoco.MjData(small)
    mujoco.mj_copyData(side, small, start)
    mujoco.mj_step(small, side, STEPS)
    fast, begun = np.abs(side.qvel).max(), np.abs(start.qvel).max()
    if bad(side) or fast > 20 * (1 + begun):
        return {}
    count = int(np.clip(1.0 / (time.perf_counter() - before) * STEPS, 6, STEPS))

    data = checks.same_state(small, start, model)
    forces = checks.Forces(small, model, case)
    # a link that turns by a tenth of a radian within a step is resolved with no device on it
    resolved = begun * small.opt.timestep < 0.1
    for _ in range(count):
        forces.step(data)
        if bad(data):
            return {"diverges": 1.0} if resolved else {}
    figures = forces.result() | {"diverges": 0.0}
    figures |= checks.dense(small, start, model, case)
    figures |= checks.repeated(small, start, model, folder)
    figures |= checks.saved_as_xml(whole, model, spec.modelfiledir)
    # RK4 takes friction explicitly: a sharp law chatters within its slope, warned of or not
    sharp = any(each.keys.get("friction") in SHARP for each in case.devices)
    if case.integrator != "RK4" or not sharp:
        names = [each.name for each in case.devices]
        figures |= checks.at_rest(small, start, lambda: _without_springs(spec, case), names)
    figures |= _kept_energy(spec, small, start, case)
    return figures | checks.cost(small, start, model)


def _changed(case: Case, change: Callable[[dict[str, Any]], dict[str, Any]]) -> Case:
    devices = [replace(each, keys=change(each.keys)) for each in case.devices]
    return replace(case, devices=devices)


def _without_springs(spec: mujoco.MjSpec, case: Case) -> tuple[mujoco.MjModel, mujoco.MjModel]:
    """The models whose devices have inertance and shafts, and damping and friction besides."""

    def changed(keys: dict[str, Any]) -> dict[str, Any]:
        still = {k: v for k, v in keys.items() if k not in SPRINGS}
        if keys.get("control") == "stiffness":
            still = {k: v for k, v in still.items() if not k.startswith("control")}
        return still

    def matter(keys: dict[str, Any]) -> dict[str, Any]:
        kept = ("inertance", "series_stiffness", "series_damping", "backlash")
        held = {k: v for k, v in keys.items() if k in kept}
        if keys.get("control") == "inertance":
            held |= {k: v for k, v in keys.items() if k.startswith("control")}
        return held

    plain = _changed(case, matter)
    models = [added(spec, each).compile() for each in (plain, _changed(case, changed))]
    for model in models:
        _set_options(model, case)
    return models[0], models[1]


def _kept_energy(
    spec: mujoco.MjSpec, small: mujoco.MjModel, start: mujoco.MjData, case: Case
) -> dict[str, float]:
    """Energy of the model without motors, constraints and losses, devices with inertance alone."""
    if any(isinstance(each, Drawn) and "tendon" in each.target for each in case.devices):
        return {}
    plain = _changed(
        case, lambda keys: {k: keys[k] for k in ("inertance", "stiffness") if k in keys}
    )
    model = added(spec, plain).compile()
    flags = mujoco.mjtDisableBit
    model.opt.disableflags |= flags.mjDSBL_CONSTRAINT | flags.mjDSBL_DAMPER
    model.opt.enableflags |= mujoco.mjtEnableBit.mjENBL_ENERGY
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4
    model.opt.density = model.opt.viscosity = 0
    model.actuator_gainprm[: small.nactuator] = 0
    model.actuator_biasprm[: small.nactuator] = 0
    model.actuator_damping[: small.nactuator] = 0
    model.dof_frictionloss[:] = 0
    model.tendon_frictionloss[:] = 0
    if small.nplugin or model.nflex or (small.actuator_plugin >= 0).any():
        return {}
    return checks.kept_energy(model, checks.same_state(small, start, model), plain)
