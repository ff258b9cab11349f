"""Loops on kept threads: every index once, nested calls end, errors arrive, and a forked child has its own."""

import multiprocessing
import os
import threading

import numba
import numpy as np
import pytest

from meshwind.core.kernel import njit
from meshwind.core.threads import parallel_for, side_by_side

MANY = 1000


@njit(nogil=True)
def _count(first: int, last: int, out: np.ndarray) -> None:
    for k in range(first, last):
        out[k] += k


def counted(_: int = 0) -> float:
    """The sum of a loop that adds each index to a place of its own."""
    out = np.zeros(MANY)
    parallel_for(_count, MANY, 10, out)
    assert np.array_equal(out, np.arange(MANY))
    return float(out.sum())


def test_each_index_is_done_once() -> None:
    assert counted() == MANY * (MANY - 1) / 2


def test_jobs_may_hold_loops_and_jobs() -> None:
    # deeper than there are threads: nobody may wait for a thread that waits
    def job(depth: int) -> float:
        if depth == 0:
            return counted()
        return sum(side_by_side(*(lambda: job(depth - 1) for _ in range(3))))

    assert job(4) == 3**4 * counted()


def test_results_come_in_the_order_of_the_jobs() -> None:
    assert side_by_side(*(lambda k=k: k * k for k in range(20))) == tuple(k * k for k in range(20))


def test_an_error_arrives_whoever_meets_it() -> None:
    def fails() -> None:
        raise ValueError("no")

    for jobs in ((fails, counted), (counted, fails)):
        with pytest.raises(ValueError, match="no"):
            side_by_side(*jobs)
    assert side_by_side(counted, counted) == (counted(), counted())


def helpers() -> int:
    """Kept threads after a loop."""
    counted()
    return sum(thread.name.startswith("loop") for thread in threading.enumerate())


@pytest.mark.skipif(not hasattr(os, "fork"), reason="only there are processes forked")
def test_a_forked_child_has_threads_of_its_own() -> None:
    here = helpers()
    with multiprocessing.get_context("fork").Pool(1) as pool:
        there = pool.apply_async(helpers).get(60)
    assert (there > 0) == (here > 0) == (numba.get_num_threads() > 1)
