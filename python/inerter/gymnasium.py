"""Gymnasium environments whose model has devices: their controls are no actions."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np

from inerter.controls import device_controls


class WithoutDeviceControls(gymnasium.ActionWrapper):
    """An environment of Gymnasium's MuJoCo family with the actions of its motors alone.

    The devices' controls (a force beside the device) stay 0; one that sets a parameter of its
    device is an action like that of a motor. A model that is compiled after
    `inerter.without_controls` has none to begin with and needs no wrapper.

    Parameters
    ----------
    env : gymnasium.Env
        Its `unwrapped.model` is an mjModel, its action space a Box over all controls.

    Raises
    ------
    ValueError
        The action space is not one number for each control.
    """

    def __init__(self, env: gymnasium.Env) -> None:
        super().__init__(env)
        model: Any = env.unwrapped.model  # type: ignore[attr-defined]
        space = env.action_space
        if not isinstance(space, gymnasium.spaces.Box) or space.shape != (model.nu,):
            raise ValueError(
                f"the action space is {space}, the model has {model.nu} controls: take the "
                "environment before other wrappers of actions"
            )
        self._motors = np.setdiff1d(np.arange(model.nu), device_controls(model))
        self._all = np.zeros(model.nu, dtype=space.dtype)
        self.action_space = gymnasium.spaces.Box(
            space.low[self._motors], space.high[self._motors], dtype=space.dtype.type
        )

    def action(self, action: np.ndarray) -> np.ndarray:
        """The action with 0 for every device."""
        whole = self._all.copy()
        whole[self._motors] = action
        return whole
