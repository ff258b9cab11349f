"""A command in a process of its own: its seconds, and the memory of the largest of its processes."""

import os
import subprocess
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
    """Run a command to its end, with nothing else beside it; raises RuntimeError where it fails."""
    begin = perf_counter()
    process = subprocess.Popen(
        command, env=env, cwd=cwd, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    seconds = perf_counter() - begin
    if process.returncode not in ENDED_WELL:
        raise RuntimeError(f"{' '.join(command)} failed: {process.returncode}")
    return Cost(seconds, used.ru_utime + used.ru_stime, used.ru_maxrss * 1024.0)
