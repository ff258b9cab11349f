"""Reading of files in a separate process, bounded in time and memory.

VTK ends its process on some damaged files, and some files need all the memory there is.  The process is started with
the first file and waits for more.  It ends with this process, or when a file ends it.
"""

import atexit
import io
import json
import os
import subprocess
import sys
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from threading import Lock, Timer
from typing import Any

import numpy as np
from numpy.typing import NDArray

from meshwind.core.errors import BadInputError

DAMAGED = "damaged, cut short or of another format"
MAX_SECONDS, BYTES_PER_SECOND = 30.0, 1e5
"""Time limit of a file, and how many of its bytes extend the limit by a second."""
Arrays = dict[str, NDArray[Any]]

_lock = Lock()
_running: "list[_Reader]" = []


class _Reader:
    """Process that reads one file after the other."""

    def __init__(self) -> None:
        self.owner = os.getpid()
        # -P keeps this folder off the process's import path, where its module names could shadow others
        self.process = subprocess.Popen(
            [sys.executable, "-P", str(Path(__file__).with_name("subprocess_main.py"))],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
        )  # fmt: skip

    def read(self, work: Callable[[Path], Arrays], path: Path) -> tuple[dict[str, Any], bytes]:
        """Answer of the process.  Raises ValueError if it ended without one."""
        stdin, stdout = self.process.stdin, self.process.stdout
        assert stdin is not None and stdout is not None
        watch = Timer(MAX_SECONDS + path.stat().st_size / BYTES_PER_SECOND, self.process.kill)
        watch.start()
        try:
            stdin.write(json.dumps([work.__module__, work.__name__, str(path.absolute())]).encode() + b"\n")
            stdin.flush()
            head = json.loads(stdout.readline() or b"{}")
            packed = stdout.read(head.get("size", 0))
        except BrokenPipeError:
            head, packed = {}, b""
        finally:
            watch.cancel()
        if not head or len(packed) < head.get("size", 0):
            raise ValueError(DAMAGED)
        return head, packed

    def close(self) -> None:
        """End the process."""
        if self.owner == os.getpid():
            self.process.kill()
            self.process.communicate()


def in_subprocess(work: Callable[[Path], Arrays], path: Path) -> Arrays:
    """Call a module's function on a file in a separate process, and return its arrays by name.

    Raises BadInputError if the function does, and ValueError if it cannot read the file, takes too long or ends the
    process.
    """
    with _lock:
        if _running and (_running[0].owner != os.getpid() or _running[0].process.poll() is not None):
            stop()
        if not _running:
            _running.append(_Reader())
        with ExitStack() as failed:  # a process that was interrupted cannot read another file
            failed.callback(stop)
            head, packed = _running[0].read(work, path)
            failed.pop_all()
    if "refused" in head:
        raise BadInputError(head["refused"])
    if "failed" in head:
        raise ValueError(head["failed"])
    with np.load(io.BytesIO(packed)) as arrays:
        return dict(arrays)


def stop() -> None:
    """End the process, if there is one."""
    while _running:
        _running.pop().close()


atexit.register(stop)
