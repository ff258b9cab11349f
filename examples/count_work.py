"""Count what the main jobs work out, and keep it as `benchmarks/counts.csv`.

    python examples/count_work.py

Counts do not depend on how fast a machine is, or on what else runs on it.  `tests/test_benchmarks.py` fails where one
is larger by more than 2 % than in the file; a growth that is meant is kept by writing the file anew, whose history then
shows it.  Each job prints its counts and the seconds of a core that it took, of which the compiling of kernels is to be
over before: `meshwind compile` does it.  With `--out` the table goes into another folder, and no count is kept.
"""

import argparse
from pathlib import Path
from time import process_time
from typing import Any

from benchmarks.history import grown, keep, kept
from benchmarks.jobs import JOBS, counts, kernels
from charts.record import Results


def main() -> None:
    """Run the jobs, print what has grown, and keep the counts."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, help="folder for a table, instead of keeping the counts")
    parser.add_argument("--only", choices=tuple(JOBS), action="append", help="one job, or some; none is kept then")
    given = parser.parse_args()
    now: dict[str, dict[str, int]] = {"kernels": {"table": kernels()}}
    rows: list[dict[str, Any]] = []
    for name in given.only or JOBS:
        start = process_time()
        now[name] = dict(counts(name))
        rows.append({"job": name, **now[name], "seconds of a core": round(process_time() - start, 2)})
        print(", ".join(f"{key} {value}" for key, value in rows[-1].items()), flush=True)
    for line in grown(now, kept()):
        print("grown", line)
    if given.out is not None:
        results = Results(given.out, "count_work.py", False)
        results.table("counts", rows)
        results.finish(f"{len(rows)} jobs")
    elif given.only is None:
        keep(now)


if __name__ == "__main__":
    main()
