"""Run a study on this machine, in processes; the jobs of a process that is killed are run again."""

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

from meshwind.studies.study import Case, CaseStatus
from meshwind.studies.work import CaseGroup, Done, fit_job, wind_job
from meshwind.workflow.options import Options
from meshwind.workflow.part import Part, Source

MAX_ATTEMPTS = 3
"""Times that a job is tried whose worker is killed."""
LOST = (
    f"its worker was killed {MAX_ATTEMPTS} times: it may need more memory than there is; try it alone, or on a larger "
    "machine"
)


@dataclass(frozen=True)
class _Job:
    """A part to fit, where number is None, or a case to wind."""

    group: int
    number: int | None


@dataclass
class _Queue:
    """The jobs that are left.  Winding comes before fitting, so that few fitted parts are stored at a time."""

    groups: list[CaseGroup]
    folder: Path
    fits: deque[int]
    winds: deque[_Job] = field(default_factory=deque)
    retries: deque[_Job] = field(default_factory=deque)
    kills: Counter[_Job] = field(default_factory=Counter)

    def next(self) -> _Job | None:
        """The next job, None where there is none."""
        if self.retries:
            return self.retries.popleft()
        if self.winds:
            return self.winds.popleft()
        return _Job(self.fits.popleft(), None) if self.fits else None

    def file(self, group: int) -> Path:
        """The file that a fitted part is stored in."""
        return self.folder / f"{group}.pickle"


def run_local(groups: list[CaseGroup], processes: int) -> Iterator[tuple[int, Done]]:
    """Yield each case once, as it is done."""
    with TemporaryDirectory(prefix="meshwind-") as folder:
        queue = _Queue(groups, Path(folder), deque(range(len(groups))))
        while (yield from _run_pool(queue, processes)):
            pass


def _run_pool(queue: _Queue, processes: int) -> Generator[tuple[int, Done], None, bool]:
    """Work until all is done or a worker is killed; returns whether jobs are left.

    A killed worker breaks the pool, and which of the running jobs was its is not known: they are tried again one at
    a time, before all others.
    """
    running: dict[Future[Any], _Job] = {}
    with ProcessPoolExecutor(processes, mp_context=get_context("spawn")) as pool:
        try:
            while True:
                suspects = bool(queue.retries) or any(queue.kills[job] for job in running.values())
                while len(running) < (1 if suspects else processes):
                    job = queue.next()
                    if job is None:
                        break
                    try:
                        future, refused = _submit(pool, queue, job)
                    except BrokenProcessPool:
                        queue.retries.append(job)  # it has not started
                        raise
                    if future is None:
                        yield from refused
                    else:
                        running[future] = job
                    suspects = suspects or bool(queue.kills[job])
                if not running:
                    return False
                for future in wait(running, return_when=FIRST_COMPLETED).done:
                    result = future.result()
                    job = running.pop(future)
                    yield from _finish(queue, job, result)
        except BrokenProcessPool:
            yield from _requeue(queue, list(running.values()))
    return True


def _submit(pool: ProcessPoolExecutor, queue: _Queue, job: _Job) -> tuple[Future[Any] | None, list[tuple[int, Done]]]:
    """Start a job; where its mesh cannot be read there is none, but its cases get the reason."""
    group = queue.groups[job.group]
    if job.number is not None:
        return pool.submit(_wind_stored, str(queue.file(job.group)), group.cases[job.number]), []
    source = group.read()
    if isinstance(source, str):
        return None, [(number, Done(CaseStatus.REFUSED, source)) for number in group.cases]
    return pool.submit(_fit_and_store, str(queue.file(job.group)), source, group.options), []


def _finish(queue: _Queue, job: _Job, result: Done | str) -> Iterator[tuple[int, Done]]:
    """Take the result of a job: after a fitted part its cases can be wound, or all of them get its reason."""
    group = queue.groups[job.group]
    if isinstance(result, Done):
        if job.number is not None:
            yield job.number, result
    elif result:
        yield from ((number, Done(CaseStatus.REFUSED, result)) for number in group.cases)
    else:
        queue.winds.extend(_Job(job.group, number) for number in group.cases)


def _requeue(queue: _Queue, jobs: list[_Job]) -> Iterator[tuple[int, Done]]:
    """Try again, or give up, the jobs that ran when a worker was killed."""
    for job in jobs:
        # a job that ran alone is to blame; of several any may be, and they count half
        queue.kills[job] += 1 if len(jobs) > 1 else 2
        if queue.kills[job] <= 2 * (MAX_ATTEMPTS - 1):
            queue.retries.append(job)
            continue
        numbers = queue.groups[job.group].cases if job.number is None else [job.number]
        yield from ((number, Done(CaseStatus.LOST, LOST)) for number in numbers)


def _fit_and_store(file: str, source: Source, options: Options) -> str:
    """In a worker: fit a part and store it in a file; returns "" or the reason why there is none."""
    part = fit_job(source, options)
    if isinstance(part, str):
        return part
    half = Path(f"{file}.half")
    half.write_bytes(pickle.dumps(part))
    half.replace(file)
    return ""


def _wind_stored(file: str, case: Case) -> Done:
    """In a worker: wind a case on a stored part."""
    return wind_job(_stored_part(file), case)


@lru_cache(maxsize=1)
def _stored_part(file: str) -> Part:
    part: Part = pickle.loads(Path(file).read_bytes())
    return part
