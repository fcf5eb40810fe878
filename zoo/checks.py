"""What has to hold for devices in a model, each check a function that gives figures.

A figure is a relative error, a ratio, or a count; `LIMITS` says up to where it is right.
"""

from __future__ import annotations

import copy
import time
from collections.abc import Callable
from pathlib import Path

import mujoco
import mujoco.rollout
import numpy as np
from inerter import device_of

from zoo.draw import Case, Drawn
from zoo.models import bad
from zoo.oracle import row_of

Figures = dict[str, float]
STATE = mujoco.mjtState.mjSTATE_INTEGRATION
RK4 = mujoco.mjtIntegrator.mjINT_RK4

LIMITS: Figures = {
    # force of the inertance against b (J qacc + J'v), per size of the terms; with the file's own
    # options of the engine's solver, which may stop early
    "force": 1e-6, "force_as_in_file": 1e-3,
    # the bare model that is given the same forces moves alike, per change of velocity of the step:
    # without constraints, and where its solver answers them
    "same_forces": 1e-6, "same_in_contact": 1e-3,
    # own dense solve, where no constraint acts, per size of the accelerations
    "dense": 1e-6,
    # runs that differ from what they have to repeat bit for bit
    "copies": 0.5, "reset": 0.5, "state": 0.5, "binary": 0.5, "threads": 0.5,
    # the model saved as XML does not load, or loads without its devices
    "xml": 0.5,
    # heat that falls, or numbers that cannot be where the bare model has none
    "heat": 0.5, "diverges": 0.5,
    # speed that devices give a model at rest, per speed that it has there
    "rest": 1.0,
    # drift of the energy where it is kept, per energy that moves
    "energy": 1e-3,
    # warnings that force and acceleration did not fit
    "unfit": 0.5,
}  # fmt: skip


def same_state(bare: mujoco.MjModel, start: mujoco.MjData, model: mujoco.MjModel) -> mujoco.MjData:
    """The bare model's state in the model with devices, whose own states are 0."""
    data = mujoco.MjData(model)
    for field in ("qpos", "qvel", "mocap_pos", "mocap_quat", "eq_active", "qacc_warmstart"):
        getattr(data, field)[:] = getattr(start, field)
    for field, count in (("act", bare.na), ("ctrl", bare.nu), ("history", bare.nhistory)):
        if count:
            getattr(data, field)[:count] = getattr(start, field)[:count]
    return data


# --- forces and motion --------------------------------------------------------------------------


class Forces:
    """Forces, accelerations and motion of every step of a run, beside the bare model's."""

    def __init__(self, bare: mujoco.MjModel, model: mujoco.MjModel, case: Case) -> None:
        self.bare, self.model, self.case = weighted_alike(bare, model), model, case
        self.side = mujoco.MjData(self.bare)
        self.places = [device_of(model, each.name) for each in case.devices]
        self.figures: Figures = {}
        self._by_forward: dict[str, float] = {}
        self._by_step: dict[str, float] = {}
        self._inertance: dict[str, float] = {}

    def step(self, data: mujoco.MjData) -> None:
        """Take a step and compare it."""
        bare, side, h = self.bare, self.side, self.model.opt.timestep
        before = data.qvel.copy()
        for field in ("qpos", "qvel", "mocap_pos", "mocap_quat", "eq_active", "qacc_warmstart"):
            getattr(side, field)[:] = getattr(data, field)
        side.act[:] = data.act[: bare.na]
        side.ctrl[:] = data.ctrl[: bare.nu]
        side.time = data.time
        if bare.nhistory:
            side.history[:] = data.history[: bare.nhistory]
        side.qfrc_applied[:] = 0
        heat = [place.read(data.sensordata)["dissipated_energy"] for place in self.places]
        self._inertance = {
            each.name: inertance(self.model, data, each) for each in self.case.devices
        }
        shown = data
        if self.model.opt.integrator == RK4:
            # what stays in data after the step belongs to its last stage
            shown = copy.copy(data)
            mujoco.mj_forward(self.model, shown)
        mujoco.mj_step(self.model, data)
        mujoco.mj_forward(bare, side)

        rows = [row_of(bare, side, each) for each in self.case.devices]
        read = [place.read(shown.sensordata) for place in self.places]
        stepped = (data.qvel - before) / h
        # where bodies jam, and of constraints at the engine's least softness (1e-15), its solver
        # does not end at a solution, and no force fits what it leaves
        ends = shown.solver_niter.max() < self.model.opt.iterations
        ends = ends and (not side.nefc or side.efc_R.min() > 1e-14)
        pull = np.zeros(bare.nv)
        for each, row, values in zip(self.case.devices, rows, read, strict=True):
            force = float(values["total"])
            if rigid(each) and ends:
                force += self._compare(each, row, values, shown.qacc, stepped)
            pull -= row.J * force
        self._move_bare(data.qvel - before, shown.qacc, before, pull)
        for each, row, held, values in zip(self.case.devices, rows, heat, read, strict=True):
            # the damping of a LuGre bristle may give back what it has taken: the law is so
            if not each.keys.get("bristle_damping"):
                fell = held - values["dissipated_energy"]
                terms = abs(float(values["total"])) + abs(float(values.get("friction", 0)))
                rounding = 1e-14 * terms * abs(row.v) * h
                self._note("heat", float(fell > 1e-9 * (1e-12 + abs(held)) + rounding))

    def _compare(self, each: Drawn, row, values, qacc, stepped) -> float:
        """Note how well the inertance's force fits; what the step's own acceleration adds to it."""
        b = self._inertance[each.name]
        found = float(values["inertance"])
        for acceleration, noted in ((qacc, self._by_forward), (stepped, self._by_step)):
            a = float(row.J @ acceleration) + row.bias
            size = float(np.abs(row.J) @ np.abs(acceleration)) + abs(row.bias)
            floor = 1e-9 * (1 + abs(float(values["total"])) + b * float(np.abs(acceleration).max()))
            miss = abs(found - b * a) / (b * size + floor)
            noted[each.name] = max(noted.get(each.name, 0.0), miss)
        if self.model.opt.integrator == RK4:
            return 0.0
        return b * (float(row.J @ stepped) + row.bias) - found

    def _move_bare(
        self, change: np.ndarray, qacc: np.ndarray, before: np.ndarray, pull: np.ndarray
    ) -> None:
        """The bare model with the same forces, twice: its solver's own error is allowed."""
        rk4 = self.model.opt.integrator == RK4
        found = qacc if rk4 else change
        if not rk4 and any("viscous" in each.keys for each in self.case.devices):
            return  # the engine takes its damping at the end of a step, the sensor at its start
        if self.side.nefc and (not self.case.tight or (not rk4 and self._native())):
            return
        self.side.qfrc_applied[:] = pull
        other = copy.copy(self.side)
        other.qacc_warmstart[:] = 0
        answers = []
        for side in (self.side, other):
            (mujoco.mj_forward if rk4 else mujoco.mj_step)(self.bare, side)
            answers.append(side.qacc if rk4 else side.qvel - before)
        error = np.abs(answers[0] - answers[1]).max()
        miss = max(0.0, np.abs(answers[0] - found).max() - 10 * error)
        name = "same_in_contact" if self.side.nefc else "same_forces"
        self._note(name, float(miss / (np.abs(found).max() + 1e-9)))

    def _native(self) -> bool:
        """Whether the engine holds an inertance.

        Its constraints then meet another inertia: away from RK4 its own armature and a force of
        b times the acceleration move a model in contact by a few thousandths otherwise.
        """
        return any(
            self.model.actuator_gainprm[place.actuator, -1] > 0 and rigid(each)
            for place, each in zip(self.places, self.case.devices, strict=True)
        )

    def _note(self, name: str, value: float) -> None:
        self.figures[name] = max(self.figures.get(name, 0.0), value)

    def result(self) -> Figures:
        """The worst of each figure; a device's force fits one acceleration in all steps."""
        fits = [min(self._by_forward[name], self._by_step[name]) for name in self._by_forward]
        name = "force" if self.case.tight else "force_as_in_file"
        return self.figures | ({name: max(fits)} if fits else {})


def weighted_alike(model: mujoco.MjModel, other: mujoco.MjModel) -> mujoco.MjModel:
    """A copy of a model whose constraints are as soft, and muscles as strong, as the other's.

    The engine derives both from the inertia at the initial pose, armatures included.
    """
    twin = copy.copy(model)
    for field in (
        "body_invweight0", "dof_invweight0", "tendon_invweight0", "actuator_acc0",
        "actuator_lengthrange",
    ):  # fmt: skip
        own, given = getattr(twin, field), getattr(other, field)
        count = min(len(own), len(given))
        own[:count] = given[:count]
    return twin


def inertance(model: mujoco.MjModel, data: mujoco.MjData, each: Drawn) -> float:
    """Inertance of a device at present, which a control may set."""
    if each.keys.get("control") != "inertance":
        return float(each.keys["inertance"])
    place = device_of(model, each.name)
    command = data.ctrl[model.actuator_ctrladr[place.actuator]]
    states = [data.act[address] for address in place.act.values()]
    return place.device.commanded(float(command), states or 0.0).inertance


def rigid(each: Drawn) -> bool:
    """Whether the inertance acts at the terminals."""
    return "series_stiffness" not in each.keys


def dense(bare: mujoco.MjModel, start: mujoco.MjData, model: mujoco.MjModel, case: Case) -> Figures:
    """The acceleration of a step from a dense solve of all inertances, without constraints.

    How the bare model answers forces is asked of it by unit forces, so that this holds under every
    integrator: a = p - W F, F = rest + b a.
    """
    if not all(rigid(each) and "load_friction" not in each.keys for each in case.devices):
        return {}
    if model.opt.integrator != RK4 and any("viscous" in each.keys for each in case.devices):
        return {}
    bare = weighted_alike(bare, model)
    data = same_state(bare, start, model)
    h, before = model.opt.timestep, data.qvel.copy()
    side = mujoco.MjData(bare)

    def answer(force: np.ndarray) -> np.ndarray:
        mujoco.mj_copyData(side, bare, start)
        side.qfrc_applied[:] = force
        if model.opt.integrator == RK4:
            mujoco.mj_forward(bare, side)
            return side.qacc.copy()
        mujoco.mj_step(bare, side)
        return (side.qvel - before) / h

    free = answer(np.zeros(bare.nv))
    if side.nefc:
        return {}
    mujoco.mj_copyData(side, bare, start)
    mujoco.mj_forward(bare, side)
    rows = [row_of(bare, side, each) for each in case.devices]
    b = np.array([inertance(model, data, each) for each in case.devices])
    mujoco.mj_step(model, data)
    if model.opt.integrator == RK4:
        found = model_acceleration(bare, start, model)
    else:
        found = (data.qvel - before) / h
    read = [device_of(model, each.name).read(data.sensordata) for each in case.devices]
    rest = np.array([float(values["total"] - values["inertance"]) for values in read])
    J = np.array([row.J for row in rows])
    response = np.array([answer(row.J) - free for row in rows])
    W = J @ response.T
    p = J @ free + np.array([row.bias for row in rows])
    force = np.linalg.solve(np.eye(len(b)) + b[:, None] * W, rest + b * p)
    expected = free - response.T @ force
    size = np.abs(free).max() + np.abs(response.T * force).max() + 1e-9
    return {"dense": float(np.abs(expected - found).max() / size)}


def model_acceleration(
    bare: mujoco.MjModel, start: mujoco.MjData, model: mujoco.MjModel
) -> np.ndarray:
    """Qacc of the first instant."""
    data = same_state(bare, start, model)
    mujoco.mj_forward(model, data)
    return data.qacc


# --- the same run by other ways -----------------------------------------------------------------


def run(model: mujoco.MjModel, data: mujoco.MjData, steps: int) -> np.ndarray:
    """Rows of what steps leave."""
    rows = []
    for _ in range(steps):
        mujoco.mj_step(model, data)
        rows.append(np.concatenate([data.qpos, data.qvel, data.act, data.sensordata]))
    return np.array(rows)


def repeated(
    bare: mujoco.MjModel, start: mujoco.MjData, model: mujoco.MjModel, folder: Path
) -> Figures:
    """Copies, resets, states, files and threads: 0 for the same bits, 1 otherwise."""
    steps = 8

    def begun(of: mujoco.MjModel) -> mujoco.MjData:
        return same_state(bare, start, of)

    data = begun(model)
    whole = run(model, data, 2 * steps)
    half = begun(model)
    run(model, half, steps)
    copied = copy.copy(half)
    state = np.zeros(mujoco.mj_stateSize(model, STATE))
    mujoco.mj_getState(model, half, state, STATE)
    fresh = mujoco.MjData(model)
    mujoco.mj_setState(model, fresh, state, STATE)
    mujoco.mj_resetData(model, data)
    again = begun(model)
    mujoco.mj_copyData(data, model, again)
    path = folder / "model.mjb"
    mujoco.mj_saveModel(model, str(path))
    binary = mujoco.MjModel.from_binary_path(str(path))
    found = {
        "copies": run(model, copied, steps),
        "state": run(model, fresh, steps),
        "reset": run(model, data, steps),
        "binary": run(binary, begun(binary), steps),
    }
    rows = {"copies": whole[steps:], "state": whole[steps:]}
    figures = {
        name: float(not np.array_equal(rows.get(name, whole[:steps]), value, equal_nan=True))
        for name, value in found.items()
    }
    return figures | {"threads": _threads(model, begun(model), steps)}


def _threads(model: mujoco.MjModel, data: mujoco.MjData, steps: int) -> float:
    """Rollouts on two threads against one after the other."""
    full = mujoco.mjtState.mjSTATE_FULLPHYSICS
    first = np.zeros((6, mujoco.mj_stateSize(model, full)))
    mujoco.mj_getState(model, data, first[0], full)
    first[1:] = first[0]
    speeds = slice(1 + model.nq, 1 + model.nq + model.nv)
    first[:, speeds] *= np.linspace(0, 1, 6)[:, None]
    alone, _ = mujoco.rollout.rollout(model, [mujoco.MjData(model)], first, nstep=steps)
    both, _ = mujoco.rollout.rollout(
        model, [mujoco.MjData(model) for _ in range(2)], first, nstep=steps, chunk_size=1
    )
    return float(not np.array_equal(np.asarray(alone), np.asarray(both), equal_nan=True))


def saved_as_xml(spec: mujoco.MjSpec, model: mujoco.MjModel, directory: str) -> Figures:
    """Whether the spec's XML loads again, with the same devices."""
    try:
        again = mujoco.MjSpec.from_string(spec.to_xml())
        again.modelfiledir = directory
        loaded = again.compile()
    except ValueError as error:
        if "inerter" in str(error):
            return {"xml": 1.0}
        return {}  # the engine's own writer: files that it does not find again, and the like
    same = (loaded.nactuator, loaded.na) == (model.nactuator, model.na)
    return {"xml": float(not same)}


# --- energy -------------------------------------------------------------------------------------


def at_rest(
    bare: mujoco.MjModel,
    start: mujoco.MjData,
    make: Callable[[], tuple[mujoco.MjModel, mujoco.MjModel]],
    names: list[str],
) -> Figures:
    """Speed after some steps of a model that stands still without its devices, per speed there.

    Two answers of `make`: the devices as inertances alone, and without springs, which would move
    the model. A constraint of the engine is the softer the less inertia it meets, so a model that
    rests in its limits first comes to rest anew with the inertances; one that balances falls on.
    """
    still = mujoco.MjData(bare)
    mujoco.mj_copyData(still, bare, start)
    settle = int(np.clip(1.5 / bare.opt.timestep, 100, 800))
    mujoco.mj_step(bare, still, settle)
    slow = np.abs(still.qvel).max()
    if bad(still) or slow > 1e-2:
        return {}
    plain, model = (weighted_alike(each, bare) for each in make())
    heavy = same_state(bare, still, plain)
    mujoco.mj_step(plain, heavy, settle)
    data = same_state(bare, heavy, model)
    for name in names:
        given, taken = (device_of(each, name).act for each in (plain, model))
        for state, address in given.items():
            data.act[taken[state]] = heavy.act[address]
    moving, fast = float(np.abs(heavy.qvel).max()), 0.0
    for _ in range(60):
        for each, run in ((bare, still), (plain, heavy), (model, data)):
            mujoco.mj_step(each, run)
        slow = max(slow, *(float(np.abs(run.qvel).max()) for run in (still, heavy)))
        fast = max(fast, float(np.abs(data.qvel).max()))
    return {"rest": max(fast / (3 * slow + 1e-3), moving / 1e-2), "rest_speed": fast}


def kept_energy(model: mujoco.MjModel, data: mujoco.MjData, case: Case) -> Figures:
    """Drift of all energy where nothing takes any, as steps get shorter; RK4 keeps its order."""
    start = np.zeros(mujoco.mj_stateSize(model, STATE))
    mujoco.mj_getState(model, data, start, STATE)
    places = [device_of(model, each.name) for each in case.devices]
    drifts = []
    h = min(model.opt.timestep, 2e-3)
    for divide in (3, 12, 48):
        model.opt.timestep = h / divide
        mujoco.mj_setState(model, data, start, STATE)
        energies, moving = [], []
        for _ in range(15 * divide):
            mujoco.mj_forward(model, data)
            held = sum(
                float(place.read(data.sensordata)["stored_energy"])
                - (0.5 * _native_inertance(model, place.actuator) * _speed(model, data, place) ** 2)
                for place in places
            )
            energies.append(float(data.energy.sum()) + held)
            moving.append(float(data.energy[1]))
            mujoco.mj_step(model, data)
            if bad(data):
                return {}
        drifts.append(np.ptp(energies) / (np.max(moving) + np.ptp(moving) + 1e-9))
        # where the drift is the integrator's own it falls with the step
        if len(drifts) > 1 and not drifts[-1] > 0.2 * drifts[-2]:
            return {"energy": 0.0}
    return {"energy": float(drifts[-1])}


def _native_inertance(model: mujoco.MjModel, actuator: int) -> float:
    return float(model.actuator_armature[actuator])


def _speed(model: mujoco.MjModel, data: mujoco.MjData, place) -> float:
    return float(data.actuator_velocity[model.actuator_outadr[place.actuator]])


# --- cost ---------------------------------------------------------------------------------------


def cost(bare: mujoco.MjModel, start: mujoco.MjData, model: mujoco.MjModel) -> Figures:
    """Time of a step over the bare model's, the least of some turns side by side."""
    turns = 5
    least = [np.inf, np.inf]
    pairs = [(bare, start), (model, same_state(bare, start, model))]
    for _ in range(turns):
        for which, (each, begun) in enumerate(pairs):
            data = mujoco.MjData(each)
            mujoco.mj_copyData(data, each, begun)
            before = time.perf_counter()
            mujoco.mj_step(each, data, 20)
            least[which] = min(least[which], time.perf_counter() - before)
    return {"cost": least[1] / least[0], "bare_us": least[0] / 20 * 1e6}
