"""A command in a process of its own: its seconds, and the memory of the largest of its processes."""

import json
import os
import subprocess
import sys
from collections.abc import Mapping, Sequence
from time import perf_counter
from typing import NamedTuple

ENDED_WELL = (0, 3)
"""Exit statuses of runs that wrote their files."""


class Cost(NamedTuple):
    """Seconds of a command, seconds of a core that it worked, and bytes of its largest process."""

    seconds: float
    processor_seconds: float
    memory: float


def run(command: Sequence[str], env: Mapping[str, str] | None = None, cwd: str | None = None) -> Cost:
    """Run a command to its end; raises RuntimeError where it fails.

    It is started by a small process: Linux counts the memory of the process that starts another one as the other's.
    """
    words = [sys.executable, "-I", __file__, *command]
    said = subprocess.run(words, env=env, cwd=cwd, capture_output=True, text=True, check=True).stdout
    status, *cost = json.loads(said)
    if status not in ENDED_WELL:
        raise RuntimeError(f"{' '.join(command)} failed: {status}")
    return Cost(*cost)


def main() -> None:
    """Run the command that is given, and print its exit status and cost."""
    begin = perf_counter()
    process = subprocess.Popen(
        sys.argv[1:], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    seconds = perf_counter() - begin
    worked, memory = used.ru_utime + used.ru_stime, used.ru_maxrss * 1024.0
    print(json.dumps([process.returncode, seconds, worked, memory]))


if __name__ == "__main__":
    main()
