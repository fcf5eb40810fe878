"""A process that runs cases: a line of JSON in, a line of JSON out.

Cases run apart from the campaign because a crash of the engine is a finding, not its end.
"""

from __future__ import annotations

import json
import os
import sys
import tempfile
import traceback
from pathlib import Path


def main() -> None:
    """Answer until the input ends."""
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    # the engine writes its log where it stands
    os.chdir(tempfile.mkdtemp(prefix="zoo_"))
    from zoo.case import run_case

    for line in sys.stdin:
        asked = json.loads(line)
        try:
            found = run_case(Path(asked["path"]), asked["seed"], asked["number"])
        except Exception:
            text = traceback.format_exc().strip().splitlines()
            found = {"status": "error", "reason": " | ".join(part.strip() for part in text[-3:])}
        answers.write(json.dumps(found) + "\n")
        answers.flush()


if __name__ == "__main__":
    main()
