"""Parallel loops over compiled kernels, which run without the interpreter's lock.

The threads are Python's rather than the compiler's: nothing is to be initialised, loops may be started from any thread,
and kernels compile in a third of the time.  They are started once and kept, as starting two takes as long as a short
loop.  Every index is independent of the others, so the result does not depend on the number of threads.
"""

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from typing import Any, TypeVar, overload

import numba

A = TypeVar("A")
B = TypeVar("B")

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
    blocks = iter(range(0, count, size))  # each start is given to one thread

    def work() -> None:
        for k in blocks:
            kernel(k, min(k + size, count), *arguments)

    _helped(work, threads - 1)


@overload
def side_by_side(first: Callable[[], A], second: Callable[[], B], /) -> tuple[A, B]: ...
@overload
def side_by_side(*jobs: Callable[[], A]) -> tuple[A, ...]: ...
def side_by_side(*jobs: Callable[[], Any]) -> tuple[Any, ...]:
    """What each job gives: what one does between its loops, others compute through."""
    made: list[Any] = [None] * len(jobs)
    left = iter(range(len(jobs)))  # each is given to one thread

    def work() -> None:
        for k in left:
            made[k] = jobs[k]()

    _helped(work, min(numba.get_num_threads(), len(jobs)) - 1)
    return tuple(made)


def _helped(work: Callable[[], None], helpers: int) -> None:
    """Do work that helpers share; one that finds no thread free is not waited for, so that calls may be nested."""
    helps = [_threads().submit(work) for _ in range(helpers)]
    try:
        work()
    finally:
        for each in helps:
            if not each.cancel():
                each.result()


@cache
def _threads() -> ThreadPoolExecutor:
    """The threads that help: as many as may compute, as the one that calls may wait for another while these go on."""
    return ThreadPoolExecutor(numba.config.NUMBA_NUM_THREADS, "loop")


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_threads.cache_clear)  # a child has none of its parent's threads
