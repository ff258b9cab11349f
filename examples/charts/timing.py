"""Seconds of a call: the least of several repeats after a warm-up, on a machine that others use as well."""

from collections.abc import Callable
from time import perf_counter
from typing import TypeVar

T = TypeVar("T")

REPEATS = 15
"""At most; fewer where a call is long."""
SHARE = 0.08
"""Seconds that the repeats of one call may take together, once three are done."""


def timed(call: Callable[[], T]) -> tuple[float, T]:
    """Seconds of one call, and what it gave."""
    begin = perf_counter()
    found = call()
    return perf_counter() - begin, found


def least(call: Callable[[], object], known: float | None = None) -> float:
    """Least seconds of repeated calls; `known` is a time already measured after a warm-up."""
    best = timed(call)[0] if known is None else known
    spent = 0.0
    for k in range(REPEATS):
        if k >= 2 and spent > SHARE:
            break
        seconds = timed(call)[0]
        best, spent = min(best, seconds), spent + seconds
    return best
