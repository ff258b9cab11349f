"""Solve a batch of taut paths on a surface."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from meshwind.core.cast import Floats, floats, frozen, ints
from meshwind.core.checks import check_switch, check_type, is_number, text, whole
from meshwind.core.defaults import PARTICLES
from meshwind.core.errors import BadInputError
from meshwind.path.asked import Asked, Options
from meshwind.path.batch import Batch
from meshwind.path.friction import Friction, friction_of
from meshwind.path.nested import solve_nested
from meshwind.path.paths import Counters, Paths
from meshwind.path.solver import Solver
from meshwind.surface.surface import Surface

TOLERANCE = 1e-10
"""Largest unbalanced force at rest, over the tension (an angle in radians)."""
ITERATIONS = 1000
STILL = 1e-9
"""Extent in u and v up to which a curve stays in one place."""
ACCURACY = 1e-5
"""Error of a length, relative, for which particles are chosen where their number is left open."""


def check_extent(surface: Surface) -> None:
    """Raise BadInputError where all of a surface is one point."""
    if not surface.size > 0.0:
        raise BadInputError("all control points lie in one place; a surface needs some extent")


def share(value: float, name: str) -> float:
    """A relative error: a finite number above 0, as kernels take it."""
    if not is_number(value) or value <= 0.0:
        raise BadInputError(f"{name} is {text(value)}; give a relative error above 0")
    return float(value)


def check_curves(curves: Floats) -> None:
    """Raise BadInputError where a curve of curves (p, k, 2) stays in one place."""
    if curves.size:
        apart = np.abs(curves[:, -1] - curves[:, 0])
        if not np.count_nonzero(np.maximum(apart[:, 0], apart[:, 1]) <= STILL):
            return
    nowhere = np.flatnonzero((np.ptp(curves, axis=1) <= STILL).all(axis=1)) if curves.shape[1] else [0]
    if len(nowhere):
        raise BadInputError(f"path {nowhere[0]} ends where it starts; give it two ends, or a curve as initial")


def straight(start: Floats, end: Floats, particles: int) -> Floats:
    """Straight lines in the parametric plane (6.2): curves (p, particles, 2) from start to end (p, 2)."""
    if particles == 2:
        ends = np.empty((len(start), 2, 2))
        ends[:, 0], ends[:, 1] = start, end
        return ends
    t = np.linspace(0.0, 1.0, particles)[None, :, None]
    return np.asarray((1.0 - t) * start[:, None] + t * end[:, None])


def solve(  # noqa: PLR0913
    surface: Surface,
    start: ArrayLike,
    end: ArrayLike,
    *,
    particles: int | None = PARTICLES,
    family: ArrayLike | None = None,
    friction: float | Friction | Callable[[Floats], Floats] | Floats = 0.0,
    initial: ArrayLike | None = None,
    bridging: bool = True,
    accuracy: float = ACCURACY,
    tolerance: float = TOLERANCE,
    iterations: int = ITERATIONS,
) -> Paths:
    """Lay taut paths between fixed ends.

    The fibre touches the surface where it presses on it and bridges hollows in a straight line.

    Parameters
    ----------
    surface : Surface
        Surface to lay the paths on.
    start, end : array_like of float, shape (p, 2)
        Parametric end points, u in turns and unwrapped: u of the end minus u of the start is the number of
        revolutions.  v is in [0, 1].
    particles : int or None, default 401
        Number of particles per path, at least 3.  None takes as many as the lengths need for `accuracy`.
    family : array_like of int, shape (p,), optional
        +1 or -1 for each path.  By default the sense of turning.
    friction : float, Friction, array_like of float or callable, default 0
        Coefficient of friction: one number, a table over u and v, or a function from points (n, 3) to coefficients
        (n,). The fibre slides from its starting curve to rest, overdamped, under constant tension, by Coulomb's law at
        every particle: one that never slips stays on its starting curve.
    initial : array_like of float, shape (p, k, 2), optional
        Starting curves in the parametric plane.  By default straight lines from start to end.
    bridging : bool, default True
        Whether the fibre can leave the surface.
    accuracy : float, default 1e-5
        Relative error of the lengths for which particles are chosen where `particles` is None.
    tolerance : float, default 1e-10
        Largest unbalanced tangential force in equilibrium, over the tension.
    iterations : int, default 1000
        Maximum number of iterations per path, at any number of particles.

    Returns
    -------
    Paths
        The paths, each with its status and residual.

    Raises
    ------
    BadInputError
        If shapes do not belong together, an end point lies outside of v in [0, 1], a path has no length, or a number
        is out of range.

    See Also
    --------
    families : End points that are spread evenly over the rims.
    drag : A path whose ends move.
    trace : A path from one end in a given direction.

    Examples
    --------
    >>> import meshwind as mw
    >>> import numpy as np
    >>> barrel = mw.shapes.revolution(lambda z: 1 - 0.3 * (z - 1) ** 2, 0.0, 2.0)
    >>> paths = mw.solve(barrel, start=[(0.0, 0.0)], end=[(0.25, 1.0)], particles=101)
    >>> bool(paths.residual[0] <= 1e-10)
    True

    A fibre that starts on a wavy curve is held there, in part, by friction:

    >>> t = np.linspace(0.0, 1.0, 101)
    >>> wavy = np.stack([0.2 * t, t + 0.03 * np.sin(2 * np.pi * t)], axis=1)
    >>> tube = mw.shapes.cylinder(radius=1.0, length=4.0)
    >>> held = mw.solve(tube, [(0.0, 0.0)], [(0.2, 1.0)], initial=[wavy], particles=101, friction=0.2)
    >>> bool(np.nanmax(held.slip) <= 0.2 + 1e-6)
    True
    """
    if particles is not None:
        particles = whole(particles, "particles", 3)
    check_type(surface, "surface", Surface, "as fit(chart) returns it")
    check_extent(surface)
    iterations = whole(iterations, "iterations", 1)
    tolerance, accuracy = share(tolerance, "tolerance"), share(accuracy, "accuracy")
    check_switch(bridging, "bridging")
    first, last = floats(start, "start", -1, 2), floats(end, "end", -1, 2)
    if len(first) != len(last):
        raise BadInputError(f"{len(first)} start points but {len(last)} end points; give as many of each")
    ends = straight(first, last, 2)
    heights = ends[..., 1]
    if heights.size and (heights.min() < 0.0 or heights.max() > 1.0):
        name = "start" if ((first[:, 1] < 0.0) | (first[:, 1] > 1.0)).any() else "end"
        raise BadInputError(f"a {name} point has v outside [0, 1]; v runs from rim to rim")
    curves = ends if initial is None else floats(initial, "initial", len(first), -1, 2)
    check_curves(curves)
    sense = np.where(last[:, 0] >= first[:, 0], 1, -1) if family is None else ints(family, "family", len(first))
    solver = Solver(surface, friction_of(surface, friction), bridging, tolerance, iterations)
    batch = solve_nested(solver, curves, particles, accuracy)
    options = Options(solver.friction, particles, bridging, accuracy, tolerance, iterations)
    given = None if initial is None else frozen(curves.copy())
    asked = Asked(solve, frozen(ends[:, 0]), frozen(ends[:, 1]), frozen(sense), given, options)
    return as_paths(solver, batch, sense, asked)


def as_paths(solver: Solver, batch: Batch, sense: ArrayLike, asked: Asked | None = None) -> Paths:
    """The public form of a solved batch, which becomes read-only, with what was asked for where that is known."""
    for array in batch:
        array.setflags(write=False)
    return Paths(
        surface=solver.surface,
        points=frozen(batch.X + solver.surface.middle),
        uv=batch.uv,
        on_surface=batch.touching,
        gap=batch.gap,
        normal=batch.normal,
        slip=batch.required,
        family=frozen(np.asarray(sense, dtype=np.int64)),
        status=batch.status,
        residual=batch.residual,
        friction=solver.friction.largest,
        counters=Counters(*batch.counters.sum(axis=0).tolist()),
        asked=asked,
    )
