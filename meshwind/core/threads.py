"""Parallel loops over compiled kernels, which run without the interpreter's lock.

The threads are Python's rather than the compiler's: nothing is to be initialised, loops may be started from any thread,
and kernels compile in a third of the time.  Every index is independent of the others, so the result does not depend on
the number of threads.
"""

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any, TypeVar

import numba

T = TypeVar("T")

BLOCKS = 8
"""Blocks per thread: enough that one slow block does not leave the other threads idle."""


def parallel_for(kernel: Callable[..., Any], count: int, least: int, *arguments: Any) -> None:
    """Call kernel(first, last, *arguments) over blocks of range(count), each of at least `least` indices.

    kernel must be compiled with nogil=True.  The number of threads is that of Numba (NUMBA_NUM_THREADS).
    """
    threads = numba.get_num_threads() if count > least else 1
    size = max(least, -(-count // (threads * BLOCKS)))
    if threads == 1 or count <= size:
        kernel(0, count, *arguments)
        return
    with ThreadPoolExecutor(threads) as pool:
        done = [pool.submit(kernel, k, min(k + size, count), *arguments) for k in range(0, count, size)]
        for block in done:
            block.result()


def side_by_side(call: Callable[..., T], jobs: Sequence[tuple[Any, ...]]) -> list[T]:
    """What call(*job) gives for each job: what one does between its loops, others march through."""
    with ThreadPoolExecutor(min(numba.get_num_threads(), len(jobs))) as pool:
        return list(pool.map(call, *zip(*jobs, strict=True)))
