"""`make zoo`: devices in the models that public packages bring."""

from __future__ import annotations

import argparse
import os
import sys
import time
from pathlib import Path

from zoo import campaign, report
from zoo.models import found_in

PACKAGES = Path(sys.prefix) / "zoo"


def main() -> int:
    """Run the campaign; 1 where a case has failed."""
    given = _arguments()
    folders = given.folder or [PACKAGES]
    models = found_in(folders)
    if not models:
        print(f"no MJCF file below {', '.join(map(str, folders))}; run `make zoo`", file=sys.stderr)
        return 2
    if given.only:
        models = [each for each in models if given.only in str(each[1])]
    print(f"seed {given.seed}; {len(models)} MJCF files of "
          f"{len({package for package, _ in models})} packages")  # fmt: skip
    log = given.out / "cases.jsonl"
    if given.fresh:
        log.unlink(missing_ok=True)
    begun = time.monotonic()

    def show(count: int, found: campaign.Result) -> None:
        if found["status"] == "no_model":
            return
        wrong = report.failures_of(found)
        if wrong or count % 10 == 0 or sys.stdout.isatty():
            spent = time.monotonic() - begun
            print(f"{count:5d} of {given.cases}, {spent:5.0f} s  {report.label(found)}"
                  f"{'  FAILED ' + wrong[0][:90] if wrong else ''}", flush=True)  # fmt: skip

    results = campaign.run(models, given.seed, given.cases, given.jobs, log, show)
    text = report.text(results)
    (given.out / "report.txt").write_text(text + "\n")
    print(text)
    return int(any(report.failures_of(each) for each in results))


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m zoo", description=__doc__)
    parser.add_argument("--cases", type=int, default=300, help="how many (default: 300)")
    parser.add_argument("--seed", type=int, default=1, help="of the draw (default: 1)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="processes at a time")
    parser.add_argument("--only", default="", help="only files with this in their path")
    parser.add_argument(
        "--folder", type=Path, action="append", help="MJCF files of yours in place of the packages'"
    )
    parser.add_argument("--out", type=Path, default=Path("out/zoo"), help="folder of the results")
    parser.add_argument("--fresh", action="store_true", help="do not go on from what is there")
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
