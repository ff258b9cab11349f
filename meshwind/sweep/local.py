"""Run a study on this machine: processes that take a job each, and others in the place of one that is killed."""

import pickle
from collections import Counter, deque
from collections.abc import Generator, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass, field
from functools import lru_cache
from multiprocessing import get_context
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from meshwind.mesh import Mesh
from meshwind.mesh.io.scalars import Scalars
from meshwind.options import Options
from meshwind.pipeline import Part
from meshwind.sweep.jobs import Batch
from meshwind.sweep.study import Case
from meshwind.sweep.work import Done, fitted, wound

ATTEMPTS = 3
"""A job that has lost so many workers is given up."""
LOST = (
    "its worker was killed, {} times over: it may need more memory than there is; try it alone, or on a larger machine"
)


@dataclass(frozen=True)
class _Job:
    """A part to fit, number None, or a case to wind."""

    batch: int
    number: int | None


@dataclass
class _State:
    """What is to be done yet; winding comes before fitting, so that few parts are held at a time."""

    batches: list[Batch]
    place: Path
    fits: deque[int]
    winds: deque[_Job] = field(default_factory=deque)
    again: deque[_Job] = field(default_factory=deque)
    killed: Counter[_Job] = field(default_factory=Counter)

    def next(self) -> _Job | None:
        """The next job."""
        if self.again:
            return self.again.popleft()
        if self.winds:
            return self.winds.popleft()
        return _Job(self.fits.popleft(), None) if self.fits else None

    def file(self, batch: int) -> Path:
        """Where a fitted part waits for its cases."""
        return self.place / f"{batch}.pickle"


def run_local(batches: list[Batch], processes: int) -> Iterator[tuple[int, Done]]:
    """Give each case once, as it is done."""
    with TemporaryDirectory(prefix="meshwind-") as place:
        state = _State(batches, Path(place), deque(range(len(batches))))
        while (yield from _pool(state, processes)):
            pass


def _pool(state: _State, processes: int) -> Generator[tuple[int, Done], None, bool]:
    """Work until all is done, or until a worker is killed; returns whether there is more to do.

    Which of the jobs at work killed it is not known: they are tried again one at a time, before all others.
    """
    running: dict[Future[Any], _Job] = {}
    with ProcessPoolExecutor(processes, mp_context=get_context("spawn")) as pool:
        try:
            while True:
                suspects = bool(state.again) or any(state.killed[job] for job in running.values())
                while len(running) < (1 if suspects else processes):
                    job = state.next()
                    if job is None:
                        break
                    try:
                        future, told = _submitted(pool, state, job)
                    except BrokenProcessPool:
                        state.again.append(job)  # it has not even begun
                        raise
                    if future is None:
                        yield from told
                    else:
                        running[future] = job
                    suspects = suspects or bool(state.killed[job])
                if not running:
                    return False
                for future in wait(running, return_when=FIRST_COMPLETED).done:
                    found = future.result()
                    job = running.pop(future)
                    yield from _taken(state, job, found)
        except BrokenProcessPool:
            yield from _mourned(state, list(running.values()))
    return True


def _submitted(
    pool: ProcessPoolExecutor, state: _State, job: _Job
) -> tuple[Future[Any] | None, list[tuple[int, Done]]]:
    """Start a job; where its mesh cannot be read there is none, but its cases have their reason."""
    batch = state.batches[job.batch]
    if job.number is not None:
        return pool.submit(_wound, str(state.file(job.batch)), batch.cases[job.number]), []
    read = batch.read()
    if isinstance(read, str):
        return None, [(number, Done({}, {}, read)) for number in batch.cases]
    return pool.submit(_fitted, str(state.file(job.batch)), *read), []


def _taken(state: _State, job: _Job, found: Done | str) -> Iterator[tuple[int, Done]]:
    """A job that is done: a fitted part sets its cases free, or none of them can be wound."""
    batch = state.batches[job.batch]
    if isinstance(found, Done):
        if job.number is not None:
            yield job.number, found
    elif found:
        yield from ((number, Done({}, {}, found)) for number in batch.cases)
    else:
        state.winds.extend(_Job(job.batch, number) for number in batch.cases)


def _mourned(state: _State, jobs: list[_Job]) -> Iterator[tuple[int, Done]]:
    """Jobs whose worker was killed, or a neighbour's: tried again, or given up."""
    for job in jobs:
        # one job alone is to blame; several may be bystanders
        state.killed[job] += 1 if len(jobs) > 1 else 2
        if state.killed[job] <= 2 * (ATTEMPTS - 1):
            state.again.append(job)
            continue
        numbers = state.batches[job.batch].cases if job.number is None else [job.number]
        yield from ((number, Done({}, {}, LOST.format(ATTEMPTS), lost=True)) for number in numbers)


def _fitted(file: str, mesh: Mesh, field: Scalars | None, options: Options) -> str:
    """In a worker: fit a part and keep it in a file; returns "" or why there is none."""
    part = fitted(mesh, field, options)
    if isinstance(part, str):
        return part
    half = Path(f"{file}.half")
    half.write_bytes(pickle.dumps(part))
    half.replace(file)
    return ""


def _wound(file: str, case: Case) -> Done:
    """In a worker: wind a case on a part from its file."""
    return wound(_part(file), case)


@lru_cache(maxsize=1)
def _part(file: str) -> Part:
    part: Part = pickle.loads(Path(file).read_bytes())
    return part
