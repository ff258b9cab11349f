"""Run a study on a Dask cluster: the same jobs, handed to its scheduler."""

from collections.abc import Iterator
from typing import Any

from meshwind.core.errors import BadInputError
from meshwind.sweep.jobs import Batch
from meshwind.sweep.work import Done, fitted, wound

SECONDS = 20
"""So long the scheduler is waited for."""
LOST = "the cluster lost its workers over it: it may need more memory than they have; try it alone"


def run_cluster(batches: list[Batch], address: str) -> Iterator[tuple[int, Done]]:
    """Give each case once, as it is done; a killed worker's jobs are run again by the scheduler."""
    try:
        from distributed import Client, KilledWorker, as_completed
    except ImportError as error:
        raise BadInputError('a cluster needs Dask: pip install "meshwind[cluster]"') from error
    try:
        client = Client(address, timeout=SECONDS, set_as_default=False)
    except (OSError, ValueError) as error:
        raise BadInputError(f"no scheduler answers at {address}: {error}; start one with `dask scheduler`") from error
    with client:
        numbers: dict[Any, int] = {}
        jobs = []
        for batch in batches:
            read = batch.read()
            if isinstance(read, str):
                yield from ((number, Done({}, {}, read)) for number in batch.cases)
                continue
            part = client.submit(fitted, *read, pure=False)
            for number, case in batch.cases.items():
                jobs.append(client.submit(wound, part, case, pure=False))
                numbers[jobs[-1].key] = number
        # what has been taken is let go of, so that the cluster does not keep it
        taken = as_completed(jobs, loop=client.loop)
        jobs.clear()
        for job in taken:
            try:
                done = job.result()
            except KilledWorker:
                done = Done({}, {}, LOST, lost=True)
            yield numbers[job.key], done
