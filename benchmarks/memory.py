"""What a simulation takes of the memory.

Resident memory of a fresh process, before and after it makes many simulations and steps each once,
per simulation (Linux; the second half of them, when whatever is made once is there). A batch keeps
the state of its simulations and one mjData for each thread; a persistent batch and a program that
keeps its own data have an mjData for each simulation.
"""

from __future__ import annotations

import multiprocessing
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

import mujoco
import mujoco.batch
from inerter.benchmark.cars import jolt
from inerter.benchmark.rows import Row, aimed

from benchmarks.many import BRANCHES, CAR, NATIVE, PLUGIN, model_of

STATM = Path("/proc/self/statm")
# kind: simulations
KINDS = {"batch": 1 << 17, "persistent batch": 1 << 9, "own mjData": 1 << 9}


def run(quick: bool = False, share: float = 1.0) -> list[Row]:
    """Measure each kind of simulation in a process of its own.

    Parameters
    ----------
    quick
        Fewer variants.
    share
        Of the simulations of `KINDS`.

    Returns
    -------
    list of dict
        `question`, `variant`, `kind`, `simulations`, `bytes` of resident memory per simulation
        (None where the system does not tell), `state` (bytes of its state), `extra` (what
        `against`, the native device, takes less).
    """
    rows: list[Row] = []
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(1, mp_context=context, max_tasks_per_child=1) as pool:
        for kind, most in KINDS.items():
            count = max(2, int(share * most))
            native = None
            for variant in (NATIVE, PLUGIN) if quick else (NATIVE, PLUGIN, BRANCHES):
                found, state = pool.submit(resident, variant, kind, count).result()
                native = found if variant == NATIVE else native
                rows.append(
                    {
                        "question": "bytes of a simulation", "variant": variant, "kind": kind,
                        "simulations": count, "bytes": found, "state": state, "against": NATIVE,
                        "extra": None if found is None or native is None else found - native,
                        **aimed(0.0, None),
                    }
                )  # fmt: skip
    return rows


def resident(variant: str, kind: str, count: int) -> tuple[float | None, int]:
    """Bytes of resident memory per simulation, and of its state."""
    model = model_of(variant)
    state = 8 * mujoco.mj_stateSize(model, mujoco.mjtState.mjSTATE_FULLPHYSICS)
    kept = [_made(model, kind, count // 2)]
    before = _pages()
    kept.append(_made(model, kind, count - count // 2))
    after = _pages()
    per = None if before is None or after is None else (after - before) / (count - count // 2)
    return per, int(state)


def _made(model: mujoco.MjModel, kind: str, count: int) -> Any:
    """Simulations that have made a step."""
    if kind == "own mjData":
        datas = [mujoco.MjData(model) for _ in range(count)]
        for data in datas:
            data.qvel[:] = jolt(CAR)
            mujoco.mj_step(model, data)
        return datas
    worlds = mujoco.batch.Batch(model, count, 1, kind.startswith("persistent"))
    worlds.bind("qvel")[:] = jolt(CAR)
    worlds.step()
    return worlds


def _pages() -> int | None:
    """Resident bytes of this process, where the system tells."""
    try:
        import resource

        return int(STATM.read_text(encoding="ascii").split()[1]) * resource.getpagesize()
    except (OSError, ImportError):
        return None
