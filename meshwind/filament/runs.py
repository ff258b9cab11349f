"""Compiled: runs of points of one course, forwards or backwards, copied to places in another."""

from typing import NamedTuple

from meshwind.core.cast import Floats, Ints
from meshwind.core.kernel import njit


class Columns(NamedTuple):
    """What is known of the points (n,) of a course, as `Course` has it."""

    points: Floats
    normal: Floats
    angle: Floats
    slip: Floats
    kind: Ints
    path: Ints


class Runs(NamedTuple):
    """Runs of `length` (m,) points, from `first` (m,) on by `step`, and where their first points go, `at` (m,).

    circuit: that of the first run, from which on they are numbered; back: 1 if the runs are of passes back, else 0.
    """

    first: Ints
    length: Ints
    at: Ints
    step: int
    circuit: int
    back: int


class Order(NamedTuple):
    """The circuit and the pass of points (n,) in a course."""

    circuit: Ints
    passed: Ints


@njit(nogil=True, cache=True)
def copy_runs(first, last, source, runs, out, order):
    """Copy runs first to last, and number their circuits and passes."""
    for run in range(first, last):
        begin, to, circuit = runs.first[run], runs.at[run], runs.circuit + run
        for i in range(runs.length[run]):
            here, there = begin + runs.step * i, to + i
            for k in range(3):
                out.points[there, k] = source.points[here, k]
                out.normal[there, k] = source.normal[here, k]
            out.angle[there], out.slip[there] = source.angle[here], source.slip[here]
            out.kind[there], out.path[there] = source.kind[here], source.path[here]
            order.circuit[there], order.passed[there] = circuit, 2 * circuit + runs.back
