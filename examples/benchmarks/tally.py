"""Counts of work while something runs, taken where Python calls the kernels: the kernels themselves are as ever."""

import sys
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from threading import Lock
from typing import Any

import igl
import scipy.linalg
import scipy.sparse.linalg

from meshwind.core import threads
from meshwind.march.march import EVALUATIONS as MARCHED
from meshwind.march.march import Marches
from meshwind.path.batch import Batch
from meshwind.path.kernels.state import EVALUATIONS, FEET, ITERATIONS, SOLVES
from meshwind.surface.fitting import conjugate_gradients

COLUMNS = {"evaluations": EVALUATIONS, "feet": FEET, "solves": SOLVES, "iterations": ITERATIONS}
"""Counters of a path that is solved, as the kernels report them."""


class Tally(Counter[str]):
    """Counts by name.

    evaluations, feet, solves, iterations: what the kernels of paths report; paths: times that such a kernel was given a
    path; marched: evaluations of marches; items: what all other kernels were given to work through; factorisations: of
    matrices; steps: of conjugate gradients.
    """

    def __init__(self) -> None:
        super().__init__()
        self._lock = Lock()

    def add(self, **counts: int) -> None:
        """Add counts, from any thread."""
        with self._lock:
            self.update(counts)


@contextmanager
def counted() -> Iterator[Tally]:
    """Count what is worked out within, in all threads of this process."""
    tally, loop = Tally(), threads.parallel_for

    def looped(kernel: Callable[..., Any], count: int, least: int, *arguments: Any) -> None:
        batches = [each for each in arguments if isinstance(each, Batch)]
        marches = [each for each in arguments if isinstance(each, Marches)]
        if len(batches) == 1:  # two are copied from one to the other
            before = batches[0].counters.sum(axis=0)
            loop(kernel, count, least, *arguments)
            grown = batches[0].counters.sum(axis=0) - before
            tally.add(paths=count, **{name: int(grown[k]) for name, k in COLUMNS.items()})
        elif marches:
            before = marches[0].counters[:, MARCHED].sum()
            loop(kernel, count, least, *arguments)
            tally.add(marched=int(marches[0].counters[:, MARCHED].sum() - before))
        else:
            loop(kernel, count, least, *arguments)
            tally.add(items=count)

    solve = conjugate_gradients.TensorGram.solve
    counters: dict[Callable[..., Any], dict[str, int]] = {
        igl.min_quad_with_fixed: {"factorisations": 1},
        scipy.sparse.linalg.splu: {"factorisations": 1},
        scipy.linalg.cholesky_banded: {"factorisations": 1},
    }
    with ExitStack() as stack:
        stack.enter_context(replaced(loop, looped))
        for function, counts in counters.items():
            stack.enter_context(replaced(function, noted(function, tally, counts)))
        conjugate_gradients.TensorGram.solve = noted(solve, tally, {"steps": 1})  # type: ignore[method-assign]
        try:
            yield tally
        finally:
            conjugate_gradients.TensorGram.solve = solve  # type: ignore[method-assign]


def noted(function: Callable[..., Any], tally: Tally, counts: dict[str, int]) -> Callable[..., Any]:
    """A function that adds to the counts each time that it is called."""

    def counting(*arguments: Any, **options: Any) -> Any:
        tally.add(**counts)
        return function(*arguments, **options)

    return counting


@contextmanager
def replaced(old: Callable[..., Any], new: Callable[..., Any]) -> Iterator[None]:
    """Another function in the place of one, where it is at home and in all modules that import it by its name."""
    packages = {"meshwind", old.__module__.partition(".")[0]}
    _put(old, new, packages)
    try:
        yield
    finally:
        _put(new, old, packages)  # also where it was imported meanwhile


def _put(old: Callable[..., Any], new: Callable[..., Any], packages: set[str]) -> None:
    for module in [each for name, each in sys.modules.items() if name.partition(".")[0] in packages]:
        for name in [name for name, value in vars(module).items() if value is old]:
            setattr(module, name, new)
