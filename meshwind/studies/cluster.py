"""Run a study on a Dask cluster: the same jobs, given to its scheduler."""

from collections.abc import Iterator
from typing import Any

from meshwind.core.errors import BadInputError
from meshwind.studies.study import CaseStatus
from meshwind.studies.work import CaseGroup, Done, fit_job, wind_job

CONNECT_SECONDS = 20
"""Time that a scheduler has to answer."""
LOST = "its workers on the cluster were killed: it may need more memory than they have; try it alone"


def run_cluster(groups: list[CaseGroup], address: str) -> Iterator[tuple[int, Done]]:
    """Yield each case once, as it is done; the scheduler runs the jobs of a killed worker again."""
    try:
        from distributed import Client, KilledWorker, as_completed
    except ImportError as error:
        raise BadInputError('a cluster needs Dask: pip install "meshwind[cluster]"') from error
    try:
        client = Client(address, timeout=CONNECT_SECONDS, set_as_default=False)
    except (OSError, ValueError) as error:
        raise BadInputError(f"no scheduler answers at {address}: {error}; start one with `dask scheduler`") from error
    with client:
        numbers: dict[Any, int] = {}
        jobs = []
        for group in groups:
            source = group.read()
            if isinstance(source, str):
                yield from ((number, Done(CaseStatus.REFUSED, source)) for number in group.cases)
                continue
            part = client.submit(fit_job, source, group.options, pure=False)
            for number, case in group.cases.items():
                jobs.append(client.submit(wind_job, part, case, pure=False))
                numbers[jobs[-1].key] = number
        # finished jobs are released, so that the cluster does not keep their results
        finished = as_completed(jobs, loop=client.loop)
        jobs.clear()
        for job in finished:
            try:
                done = job.result()
            except KilledWorker:
                done = Done(CaseStatus.LOST, LOST)
            yield numbers[job.key], done
