"""Seconds of a call: the least of several repeats after a warm-up, for machines that others use as well."""

from collections.abc import Callable
from time import perf_counter
from typing import TypeVar

T = TypeVar("T")

REPEATS, FEWEST = 15, 3
"""Most and fewest repeats."""
PATIENT = 0.08
"""Seconds after which no further repeat is begun, once the fewest are done."""


def timed(call: Callable[[], T]) -> tuple[float, T]:
    """Seconds of one call, and its result."""
    begin = perf_counter()
    found = call()
    return perf_counter() - begin, found


def least(call: Callable[[], object], known: float | None = None) -> float:
    """Least seconds of repeated calls; `known` is a time already measured after a warm-up."""
    best = timed(call)[0] if known is None else known
    spent = 0.0
    for k in range(REPEATS):
        if k >= FEWEST - 1 and spent > PATIENT:
            break
        seconds = timed(call)[0]
        best, spent = min(best, seconds), spent + seconds
    return best
