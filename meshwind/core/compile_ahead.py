"""Compile kernels before they are called: side by side, in processes that share what they compile.

`kernels.json` lists what the commands compile: each kernel, the types of its arguments, the kernels that it calls, and
the first command of `JOBS` that needs it.  `examples/record_kernels.py` writes it, and `tests/test_kernels.py` fails
where it no longer fits.  A kernel that is missing there is compiled when it is called, as ever.
"""

import json
import subprocess
import sys
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryFile
from threading import Condition, Thread
from time import monotonic
from typing import Any

from meshwind.core.processes import cores
from meshwind.core.progress import Progress, silent

TABLE = Path(__file__).with_name("kernels.json")
JOBS = ("wind", "friction", "continuous", "program", "redesign", "auto", "coarse")
"""What kernels are for, each with those before it; that a mesh is coarse is known too late to compile ahead for it."""
MAX_PROCESSES = 8
"""More do not help: kernels wait for those that they call."""
WORTH = 3.0
"""Seconds of compiling below which no processes are started: each needs one to import Numba."""
EVERY = 2.0
"""Seconds between two words of progress."""
UNKEPT = "unkept"
"""Answer of a process that cannot keep what it compiles."""
SAY = "compiling kernels for this machine once"


@dataclass(frozen=True)
class Kernel:
    """A line of the table: module and name, types of the arguments, numbers of the kernels called, job and seconds."""

    module: str
    name: str
    types: tuple[Any, ...]
    calls: tuple[int, ...]
    job: str
    seconds: float

    @property
    def compiled(self) -> Any:
        """The kernel itself."""
        return getattr(import_module(self.module), self.name)


_COMPLETE: set[frozenset[str]] = set()
"""Jobs of which this process has seen all kernels kept: looking takes 25 ms."""


@lru_cache
def table() -> tuple[Kernel, ...]:
    """The kernels; those that one calls come before it."""
    held = json.loads(TABLE.read_text(encoding="utf-8"))
    kinds = held["types"]
    return tuple(
        Kernel(row["module"], row["name"], tuple(kinds[k] for k in row["types"]), tuple(row["calls"]), row["job"],
               row["seconds"])
        for row in held["kernels"]
    )  # fmt: skip


def compile_ahead(jobs: Iterable[str] = JOBS, progress: Progress = silent, worth: float = WORTH) -> int:
    """Compile the kernels of some jobs that are not kept yet; returns how many these are.

    worth: seconds of compiling below which none is compiled.  A process that is killed leaves its kernel to the first
    call of it, and so does a folder that takes no more.
    """
    wanted = frozenset(jobs)
    if wanted in _COMPLETE:
        return 0
    missing = _missing(wanted)
    if not missing:
        _COMPLETE.add(wanted)
    if sum(table()[number].seconds for number in missing) >= worth and missing and where() is not None:
        _Pool(missing, progress).run(min(cores(), MAX_PROCESSES, len(missing)))
    return len(missing)


def left_out(jobs: Iterable[str] = JOBS) -> int:
    """Number of kernels of some jobs that are not kept."""
    return len(_missing(frozenset(jobs)))


def where() -> Path | None:
    """The folder that kernels are kept in or below; None where no folder for them can be written."""
    from numba.core import config

    from meshwind.core.kernel_files import folders

    package = Path(__file__).parents[1]
    for folder in folders(__file__):
        try:
            folder.mkdir(parents=True, exist_ok=True)
            TemporaryFile(dir=folder).close()
        except OSError:
            continue
        if config.CACHE_DIR:
            return Path(config.CACHE_DIR)
        return package if package in folder.parents else folder.parent
    return None


def compile_one(number: int) -> None:
    """Compile a kernel of the table into its file, unless it is there."""
    from meshwind.core.kernel_types import from_text

    kernel = table()[number]
    kernel.compiled.compile(tuple(from_text(kind) for kind in kernel.types))


def _missing(jobs: frozenset[str]) -> list[int]:
    """Numbers of the kernels without a file.  Those that one calls are looked for only where it has none itself."""
    from numba.core.registry import cpu_target

    from meshwind.core.kernel_types import from_text

    codegen, kernels = cpu_target.target_context.codegen(), table()
    wanted = [number for number, kernel in enumerate(kernels) if kernel.job in jobs]
    called = {number for kernel in kernels for number in kernel.calls if kernel.job in jobs}
    left, seen, missing = [number for number in wanted if number not in called], set[int](), []
    while left:
        number = left.pop()
        kernel = kernels[number]
        if number in seen:
            continue
        seen.add(number)
        with suppress(AttributeError, ImportError):  # the table is of other sources
            if not kernel.compiled._cache.holds(tuple(from_text(kind) for kind in kernel.types), codegen):
                missing.append(number)
                left.extend(kernel.calls)
    return sorted(missing)


class _Pool:
    """Kernels that wait for those that they call, and processes that compile them."""

    def __init__(self, numbers: list[int], progress: Progress) -> None:
        self.waiting, self.undone, self.total = set(numbers), set(numbers), len(numbers)
        self.progress, self.change, self.serving = progress, Condition(), 0
        self.urgency = _urgency(numbers)

    def run(self, processes: int) -> None:
        """Compile all of them, or as many as the processes live to."""
        workers = [_Worker() for _ in range(processes)]
        self.serving = processes
        self.progress(f"{SAY}, 0 of {self.total}")
        told, said = monotonic(), 0
        try:
            for worker in workers:
                Thread(target=self._serve, args=(worker,), daemon=True).start()
            with self.change:
                while self.serving:
                    done = self.total - len(self.undone)
                    if done > said and monotonic() - told >= EVERY:
                        told, said = monotonic(), done
                        self.progress(f"{SAY}, {done} of {self.total}")
                    self.change.wait(EVERY)
        finally:
            for worker in workers:
                worker.close()

    def _serve(self, worker: "_Worker") -> None:
        """Give a process one kernel after the other until none is left or it has ended."""
        alive = True
        while alive and (number := self._next()) is not None:
            alive = worker.compile(number)
            with self.change:
                self.undone.discard(number)  # one whose process has ended is no longer waited for either
                self.change.notify_all()
        with self.change:
            self.serving -= 1
            self.change.notify_all()

    def _next(self) -> int | None:
        """The kernel that the most work waits for, once all that it calls is compiled; None where none is left."""
        with self.change:
            while self.waiting:
                ready = [k for k in self.waiting if not self.undone.intersection(table()[k].calls)]
                if ready:
                    best = max(ready, key=self.urgency.__getitem__)
                    self.waiting.discard(best)
                    return best
                self.change.wait(EVERY)
        return None


def _urgency(numbers: list[int]) -> dict[int, float]:
    """Seconds of each kernel and of the longest chain of those that wait for it."""
    after = dict.fromkeys(numbers, 0.0)
    for number in reversed(numbers):
        whole = after[number] = after[number] + table()[number].seconds
        for called in table()[number].calls:
            if called in after:
                after[called] = max(after[called], whole)
    return after


class _Worker:
    """A process that compiles the kernels whose numbers it reads, and answers each with a line."""

    def __init__(self) -> None:
        code = f"import sys; sys.path[:] = {sys.path!r}; from meshwind.core.compile_ahead import work; work()"
        self.process = subprocess.Popen(
            [sys.executable, "-c", code], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
        )

    def compile(self, number: int) -> bool:
        """Have a kernel compiled; returns whether the process lives."""
        stdin, stdout = self.process.stdin, self.process.stdout
        assert stdin is not None and stdout is not None
        with suppress(OSError, ValueError):
            stdin.write(f"{number}\n".encode())
            stdin.flush()
            return stdout.readline().strip() not in (b"", UNKEPT.encode())
        return False

    def close(self) -> None:
        """End the process."""
        self.process.kill()
        self.process.wait()
        for stream in (self.process.stdin, self.process.stdout):
            if stream is not None:
                with suppress(OSError):
                    stream.close()


def work() -> None:
    """In a process of its own: compile the kernels whose numbers come in, until there are no more."""
    import gc
    import signal

    from numba.core.errors import NumbaError

    from meshwind.core.kernel_files import is_kept

    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the process that started it ends it
    gc.disable()  # the compiler makes hundreds of thousands of objects that stay
    for line in sys.stdin:
        with suppress(NumbaError, AttributeError, ImportError):  # what does not fit is compiled when it is called
            compile_one(int(line))
        print(line.strip() if is_kept() else UNKEPT, flush=True)  # noqa: T201
