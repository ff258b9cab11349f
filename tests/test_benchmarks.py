"""No job costs more than the counts that are kept say, on any number of threads."""

from collections.abc import Iterator

import numba
import numpy as np
import pytest
import scipy.linalg
from benchmarks.history import GROWTH, grown, kept
from benchmarks.jobs import JOBS, counts, kernels
from benchmarks.tally import counted

import meshwind as mw
from meshwind.core import threads
from meshwind.path import solver
from meshwind.surface.fitting import conjugate_gradients


@pytest.fixture
def one_thread() -> Iterator[None]:
    """Kernels on one thread alone."""
    before = numba.get_num_threads()
    numba.set_num_threads(1)
    yield
    numba.set_num_threads(before)


@pytest.mark.parametrize("job", JOBS)
def test_no_count_of_a_job_has_grown(job: str) -> None:
    more = grown({job: counts(job)}, kept())
    assert not more, f"{more}; where that is meant, run python examples/count_work.py"


def test_no_kernels_were_added() -> None:
    assert not grown({"kernels": {"table": kernels()}}, kept())


def test_every_job_is_kept() -> None:
    assert list(kept()) == ["kernels", *JOBS]
    assert all(kept()[job]["evaluations"] > 0 < kept()[job]["bytes"] for job in JOBS)


def test_growth_beyond_its_bound_is_told() -> None:
    now = {"plain": {"evaluations": 1000, "factorisations": 1}}
    assert not grown(now, now)
    assert not grown({"plain": {"evaluations": int(1000 * (1.0 + GROWTH)), "factorisations": 1}}, now)
    assert grown({"plain": {"evaluations": 1021, "factorisations": 2}}, now) == [
        "plain: evaluations 1000 -> 1021", "plain: factorisations 1 -> 2",
    ]  # fmt: skip
    assert grown({"plain": {"feet": 1}}, now) == ["plain: feet 0 -> 1"]


def solved() -> mw.Paths:
    """Paths of a barrel, some of which slide off."""
    barrel = mw.shapes.revolution(lambda z: 1.0 - 0.3 * (z - 1.0) ** 2, 0.0, 2.0)
    turns = np.linspace(0.2, 0.8, 12)
    start, end = np.zeros((12, 2)), np.stack([turns, np.ones(12)], axis=1)
    return mw.solve(barrel, start, end, particles=101)


def test_the_tally_is_what_kernels_report_and_leaves_no_trace() -> None:
    loop, factor = threads.parallel_for, scipy.linalg.cholesky_banded
    with counted() as tally:
        paths = solved()
        assert solver.parallel_for is not loop  # type: ignore[attr-defined]
    assert solver.parallel_for is threads.parallel_for is loop  # type: ignore[attr-defined]
    assert scipy.linalg.cholesky_banded is conjugate_gradients.cholesky_banded is factor  # type: ignore[attr-defined]
    assert tally["evaluations"] >= paths.counters.evaluations > 0
    assert tally["paths"] >= len(paths)


@pytest.mark.usefixtures("one_thread")
def test_threads_change_no_count() -> None:
    with counted() as alone:
        solved()
    numba.set_num_threads(2)
    with counted() as together:
        solved()
    assert dict(alone) == dict(together)
