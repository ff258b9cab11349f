"""Compiled loops over all cores, by threads that run without the interpreter's lock.

Threads of Python rather than of the compiler: nothing to initialise, safe to call from any thread, and kernels
compile in a third of the time.  Every index is worked on alone, so the answer does not depend on the threads.
"""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numba

BLOCKS = 8
"""Blocks a thread: enough that one slow block does not leave the others idle."""


def spread(kernel: Callable[..., Any], count: int, least: int, *arguments: Any) -> None:
    """Call kernel(first, last, *arguments) over blocks of range(count), each of at least `least` indices.

    kernel must be compiled with nogil=True.  The number of threads is numba's (NUMBA_NUM_THREADS).
    """
    threads = numba.get_num_threads()
    size = max(least, -(-count // (threads * BLOCKS)))
    if threads == 1 or count <= size:
        kernel(0, count, *arguments)
        return
    with ThreadPoolExecutor(threads) as pool:
        done = [pool.submit(kernel, k, min(k + size, count), *arguments) for k in range(0, count, size)]
        for block in done:
            block.result()
