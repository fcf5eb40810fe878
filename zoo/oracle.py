"""How devices move, told without the plugin and without the engine's tendons."""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np

from zoo.draw import Drawn, line_row, tendon_row


@dataclass
class Row:
    """Along one device: row J, its velocity J v, what J'v adds to the acceleration."""

    J: np.ndarray
    v: float
    bias: float


def row_of(model: mujoco.MjModel, data: mujoco.MjData, each: Drawn) -> Row:
    """Of a device at the state of `data`, whose positions and velocities are computed."""
    if each.joint is not None:
        J = np.zeros(model.nv)
        J[model.joint(each.joint).dofadr[0]] = each.gear
        return Row(J, float(J @ data.qvel), 0.0)
    if each.points is None:
        return _of_tendon(model, data, each)
    J = line_row(model, data, each.points)
    ends, speeds, rest = [], [], []
    for body, position in each.points:
        index = model.body(body).id
        end = data.xpos[index] + data.xmat[index].reshape(3, 3) @ position
        slope, change = np.zeros((3, model.nv)), np.zeros((3, model.nv))
        mujoco.mj_jac(model, data, slope, None, end, index)
        mujoco.mj_jacDot(model, data, change, None, end, index)
        ends.append(end)
        speeds.append(slope @ data.qvel)
        rest.append(change @ data.qvel)
    line, across = ends[1] - ends[0], speeds[1] - speeds[0]
    length = np.linalg.norm(line)
    unit = line / length
    v = float(unit @ across)
    bias = float(unit @ (rest[1] - rest[0]) + (across @ across - v * v) / length)
    return Row(J, v, bias)


def _of_tendon(model: mujoco.MjModel, data: mujoco.MjData, each: Drawn) -> Row:
    """By differences of the tendon's row along the motion."""
    tendon = model.tendon(each.target["tendon"]).id
    J = tendon_row(model, data, tendon)
    v = float(J @ data.qvel)
    step = 1e-6 / (1 + np.abs(data.qvel).max())
    side = mujoco.MjData(model)
    rates = []
    for sign in (-1, 1):
        side.qpos[:] = data.qpos
        side.mocap_pos[:], side.mocap_quat[:] = data.mocap_pos, data.mocap_quat
        mujoco.mj_integratePos(model, side.qpos, data.qvel, sign * step)
        mujoco.mj_kinematics(model, side)
        mujoco.mj_comPos(model, side)
        mujoco.mj_tendon(model, side)
        rates.append(tendon_row(model, side, tendon) @ data.qvel)
    return Row(J, v, float(rates[1] - rates[0]) / (2 * step))
