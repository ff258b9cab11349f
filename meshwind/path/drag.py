"""Moving ends (Fig. 7.1): a fibre dragged over the surface, slowly enough to be at rest in every frame.

Each frame starts from the answer of the one before; with friction that answer is also the curve to which the next
frame's friction holds, so that the fibre remembers its way.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from meshwind.core.cast import Floats, floats
from meshwind.core.checks import check_switch, check_type, whole
from meshwind.core.errors import BadInputError
from meshwind.path.batch import Batch, fresh
from meshwind.path.friction import Friction, friction_of
from meshwind.path.kernels.coulomb import STUCK
from meshwind.path.paths import Paths
from meshwind.path.search import failing
from meshwind.path.solve import (
    ITERATIONS,
    TOLERANCE,
    as_paths,
    check_curves,
    check_extent,
    share,
    straight,
)
from meshwind.path.solver import Solver
from meshwind.surface.surface import Surface

LONGEST_STEP = 0.02
"""Largest move of an end in u or v at a time; longer ones between frames are divided."""
HALVINGS = 5
"""Times that a step is halved where the fibre does not follow."""


def drag(  # noqa: PLR0913
    surface: Surface,
    start: ArrayLike,
    end: ArrayLike,
    *,
    particles: int = 201,
    friction: float | Friction | Callable[[Floats], Floats] | Floats = 0.0,
    initial: ArrayLike | None = None,
    bridging: bool = True,
    tolerance: float = TOLERANCE,
    iterations: int = ITERATIONS,
) -> Paths:
    """Drag one fibre by its ends over the surface.

    The ends move slowly, so that the fibre is in equilibrium in every frame.  With friction each frame starts from
    where the fibre lay in the one before.

    Parameters
    ----------
    surface : Surface
        Surface to drag the fibre over.
    start, end : array_like of float, shape (f, 2)
        Parametric positions of both ends in each frame, u in turns and unwrapped, v in [0, 1].
    particles : int, default 201
        Number of particles of the path, at least 3.
    friction : float, Friction, array_like of float or callable, default 0
        Coefficient of friction, as for `solve`.
    initial : array_like of float, shape (k, 2), optional
        Curve in the parametric plane on which the fibre lies before the first frame.  By default a straight line.
    bridging : bool, default True
        Whether the fibre can leave the surface, and so jump over what is lower than it.
    tolerance : float, default 1e-10
        Largest unbalanced tangential force in equilibrium, over the tension.
    iterations : int, default 1000
        Maximum number of iterations per step.

    Returns
    -------
    Paths
        One path per frame.  A frame without equilibrium has a status other than CONVERGED, and the next one starts
        from where that one ended.

    Raises
    ------
    BadInputError
        If there are not as many positions of the start as of the end, or an argument is out of range.

    See Also
    --------
    solve : Paths between fixed ends.

    Examples
    --------
    >>> import meshwind as mw
    >>> import numpy as np
    >>> tube = mw.shapes.cylinder(radius=1.0, length=2.0)
    >>> turn = np.linspace(0.0, 0.1, 3)
    >>> frames = mw.drag(tube, start=[(0.0, 0.0)] * 3, end=np.stack([turn, np.ones(3)], axis=1), particles=51)
    >>> frames.length.round(4)
    array([2.    , 2.0245, 2.0964])
    """
    check_type(surface, "surface", Surface, "as fit(chart) returns it")
    first, last = floats(start, "start", -1, 2), floats(end, "end", -1, 2)
    if len(first) != len(last) or not len(first):
        raise BadInputError(f"{len(first)} places of the start but {len(last)} of the end; give one of each a frame")
    particles = whole(particles, "particles", 3)
    check_extent(surface)
    iterations = whole(iterations, "iterations", 1)
    tolerance = share(tolerance, "tolerance")
    check_switch(bridging, "bridging")
    solver = Solver(surface, friction_of(surface, friction), bridging, tolerance, iterations)
    curve = straight(first[:1], last[:1], 2) if initial is None else floats(initial, "initial", -1, 2)[None]
    check_curves(curve)
    state = fresh(curve, particles)
    if solver.friction.none:
        solver.relax(state, resume=False)
    else:
        solver.slide(state)
    frames = [state]
    for k in range(1, len(first)):
        frames.append(_advance(solver, frames[-1], first[k], last[k]))
    joined = Batch._make(_join(list(arrays)) for arrays in zip(*frames, strict=True))
    return as_paths(solver, joined, np.where(last[:, 0] >= first[:, 0], 1, -1))


def _join(arrays: list[Floats]) -> Floats:
    """One array of all frames; starting curves, of different lengths, are left out."""
    if len({array.shape for array in arrays}) > 1:
        return np.empty((len(arrays), 2, 2))
    return np.concatenate(arrays)


def _advance(solver: Solver, state: Batch, start: Floats, end: Floats) -> Batch:
    """The fibre at rest with its ends at `start` and `end` (2,), moved there in steps that it can follow."""
    here = np.stack([state.uv[0, 0], state.uv[0, -1]])
    goal = np.stack([start, end])
    steps = max(1, int(np.ceil(np.abs(goal - here).max() / LONGEST_STEP)))
    cost = np.zeros_like(state.counters)
    done, step, halvings = 0.0, 1.0 / steps, 0
    while done < 1.0:
        share = min(done + step, 1.0)
        trial = _moved(state, here + share * (goal - here), solver.friction.none)
        solver.relax(trial, resume=True)
        cost += trial.counters
        if failing(trial)[0] and halvings < HALVINGS:
            step, halvings = 0.5 * step, halvings + 1
            continue
        state, done = trial, share
    state.counters[:] = cost
    return state


def _moved(state: Batch, ends: Floats, smooth: bool) -> Batch:
    """A copy with new ends (2, 2), at rest nowhere yet; with friction it starts from where the fibre lies now."""
    trial = state.rows(np.zeros(1, np.int64))
    trial.counters[:] = 0
    trial.uv[0, 0], trial.uv[0, -1] = ends
    if not smooth:
        trial.anchor[0] = np.arange(trial.particles)
        trial.mode[:] = STUCK
        return trial._replace(starts=trial.uv.copy())
    return trial
