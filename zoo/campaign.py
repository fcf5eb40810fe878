"""A campaign: cases one after the other on a few processes, each result kept as it comes."""

from __future__ import annotations

import json
import os
import queue
import select
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

Result = dict[str, Any]
# a case that takes longer has failed [s]
LIMIT = 600.0


def order(models: list[tuple[str, Path]], seed: int) -> Iterator[tuple[int, str, Path]]:
    """(number, package, file) for ever: packages in turn, the files of each in a random order."""
    rng = np.random.default_rng(seed)
    by_package: dict[str, list[Path]] = {}
    for package, path in models:
        by_package.setdefault(package, []).append(path)
    turns = {package: list(rng.permutation(len(paths))) for package, paths in by_package.items()}
    number = 0
    while True:
        for package, paths in by_package.items():
            yield number, package, paths[turns[package][0]]
            turns[package].append(turns[package].pop(0))
            number += 1


class Worker:
    """A process of `zoo.worker`, begun again when it dies or takes too long."""

    def __init__(self) -> None:
        self._process: subprocess.Popen[str] | None = None

    def run(self, path: Path, seed: int, number: int) -> Result:
        """The result of a case; a crash and a case without an end are results too."""
        process = self._process
        if process is None:
            process = self._process = subprocess.Popen(
                [sys.executable, "-W", "ignore", "-m", "zoo.worker"],
                stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                text=True, cwd=Path(__file__).resolve().parents[1],
                env=os.environ | {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"},
            )  # fmt: skip
        assert process.stdin is not None
        assert process.stdout is not None
        asked = {"path": str(path.resolve()), "seed": seed, "number": number}
        process.stdin.write(json.dumps(asked) + "\n")
        process.stdin.flush()
        ready, _, _ = select.select([process.stdout], [], [], LIMIT)
        line = process.stdout.readline() if ready else ""
        if line:
            return json.loads(line)
        self.close()
        if not ready:
            return {"status": "error", "reason": f"no end within {LIMIT:g} s"}
        return {"status": "crashed", "reason": f"the process died ({process.returncode})"}

    def close(self) -> None:
        """End the process."""
        if self._process is not None:
            self._process.kill()
            self._process.wait()
            self._process = None


def load(path: Path) -> list[Result]:
    """Results of an earlier campaign; a last line that was cut off is left out."""
    results = []
    for line in path.read_text().splitlines() if path.exists() else []:
        try:
            results.append(json.loads(line))
        except json.JSONDecodeError:
            break
    return results


def run(
    models: list[tuple[str, Path]],
    seed: int,
    cases: int,
    jobs: int,
    log: Path,
    show: Callable[[int, Result], None],
) -> list[Result]:
    """Go on until so many cases have run, beside those that the log holds of this seed.

    log: a line of JSON per case, written as it ends. show: told how many cases have run, and the
    newest.
    """
    earlier = load(log)
    results = [each for each in earlier if each["seed"] == seed]
    known = {each["number"] for each in results}
    empty = {each["path"] for each in results if each["status"] == "no_model"}
    count = sum(each["status"] != "no_model" for each in results)
    waiting, lock = order(models, seed), threading.Lock()
    done: queue.Queue[Result] = queue.Queue()
    stop = threading.Event()

    def work() -> None:
        worker = Worker()
        idle = 0
        while not stop.is_set():
            with lock:
                number, package, path = next(waiting)
                skipped = number in known or str(path) in empty
            idle = idle + 1 if skipped else 0
            if idle > 2 * len(models) + len(known):
                break
            if not skipped:
                found = worker.run(path, seed, number)
                done.put({"seed": seed, "number": number, "package": package, "path": str(path),
                          **found})  # fmt: skip
        worker.close()
        done.put({})

    threads = [threading.Thread(target=work, daemon=True) for _ in range(jobs)]
    for thread in threads:
        thread.start()
    # anew, as the last line may have been cut off
    log.parent.mkdir(parents=True, exist_ok=True)
    with log.open("w") as file:
        file.writelines(json.dumps(each) + "\n" for each in earlier)
        file.flush()
        alive = jobs
        while alive:
            if count >= cases:
                stop.set()
            found = done.get()
            if not found:
                alive -= 1
                continue
            if found["status"] == "no_model":
                empty.add(found["path"])
            else:
                count += 1
            results.append(found)
            file.write(json.dumps(found) + "\n")
            file.flush()
            show(count, found)
    return results
