"""How much memory the machine has for a process."""

import os
import sys
from functools import cache
from pathlib import Path

_GROUPS = ("/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes")
"""Where Linux says how much a container may take, in both versions of its groups."""
_NO_MACHINE = float("inf")
"""Where nothing tells: no run is refused."""


@cache
def machine_memory() -> float:
    """Bytes of memory that the machine has, or that it allows this process if these are fewer; inf if none is told."""
    return min(_physical(), _of_group(), _allowed())


def _physical() -> float:
    """Memory of the machine."""
    if sys.platform == "win32":
        return _of_windows()
    try:
        return float(os.sysconf("SC_PHYS_PAGES")) * os.sysconf("SC_PAGE_SIZE")
    except (OSError, ValueError):
        return _NO_MACHINE


def _of_windows() -> float:
    """Memory of the machine, by Windows's MEMORYSTATUSEX: two numbers of 32 bits, and seven of 64."""
    import ctypes

    status = (ctypes.c_uint64 * 8)(ctypes.sizeof(ctypes.c_uint64) * 8)
    known = getattr(ctypes, "windll").kernel32.GlobalMemoryStatusEx(ctypes.byref(status))  # noqa: B009
    return float(status[1]) if known else _NO_MACHINE


def _of_group() -> float:
    """What a container may take."""
    limits = []
    for file in _GROUPS:
        try:
            limits.append(float(Path(file).read_text(encoding="ascii")))
        except (OSError, ValueError):  # no such group, or "max"
            continue
    return min(limits, default=_NO_MACHINE)


def _allowed() -> float:
    """What the user's shell allows."""
    try:
        import resource
    except ImportError:
        return _NO_MACHINE
    least, _ = resource.getrlimit(resource.RLIMIT_AS)
    return _NO_MACHINE if least == resource.RLIM_INFINITY else float(least)
