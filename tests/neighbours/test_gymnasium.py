"""A device in Gymnasium environments: one alone, several in turn, several in processes."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest

gymnasium = pytest.importorskip("gymnasium")
pytestmark = pytest.mark.filterwarnings("ignore")

COUNT, STEPS = 3, 25


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> str:
    from hopping_env import leg_xml

    file = tmp_path_factory.mktemp("gymnasium") / "leg.xml"
    file.write_text(leg_xml())
    return str(file)


@pytest.fixture(scope="module")
def alone(path: str) -> np.ndarray:
    """Observations of each environment by itself, (environments, steps, 5)."""
    from hopping_env import LegEnv

    return np.array([run_alone(LegEnv(path), number) for number in range(COUNT)])


def actions() -> np.ndarray:
    return np.random.default_rng(3).uniform(-1, 1, (STEPS, COUNT, 1)).astype(np.float32)


def run_alone(env: Any, number: int) -> list[np.ndarray]:
    env.reset(seed=number)
    return [env.step(action[number])[0] for action in actions()]


def test_a_reset_starts_again_states_included(path: str, alone: np.ndarray) -> None:
    from hopping_env import LegEnv

    env = LegEnv(path)
    assert np.array_equal(run_alone(env, 1), alone[1])
    assert env.data.act.any(), "the bristle has moved"
    assert np.array_equal(run_alone(env, 0), alone[0])
    assert not np.array_equal(alone[0], alone[1])


@pytest.mark.parametrize("kind", ["SyncVectorEnv", "AsyncVectorEnv"])
def test_a_vector_is_its_environments(kind: str, path: str, alone: np.ndarray) -> None:
    from gymnasium import vector
    from hopping_env import Make

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        vectors = getattr(vector, kind)([Make(path)] * COUNT)
    try:
        vectors.reset(seed=list(range(COUNT)))
        rows = np.array([vectors.step(action)[0].copy() for action in actions()])
    finally:
        vectors.close()
    assert np.array_equal(rows.transpose(1, 0, 2), alone)


def test_the_environment_is_the_engine(path: str, alone: np.ndarray) -> None:
    """The same steps by hand."""
    import mujoco

    model = mujoco.MjModel.from_xml_path(path)
    from hopping_env import LegEnv

    env = LegEnv(path)
    env.reset(seed=0)
    data = mujoco.MjData(model)
    data.qpos[:], data.qvel[:] = env.data.qpos, env.data.qvel
    mujoco.mj_forward(model, data)
    for action, row in zip(actions(), alone[0], strict=True):
        data.ctrl[0] = action[0, 0]
        mujoco.mj_step(model, data, 5)
        assert np.array_equal(np.concatenate([data.qpos, data.qvel, data.act]), row)
