"""Solve a batch of taut paths on a surface."""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from meshwind.core.cast import Floats, floats, frozen, ints
from meshwind.core.errors import BadInputError
from meshwind.path.batch import Batch, Setting
from meshwind.path.friction import Friction, friction_of
from meshwind.path.ladder import climb
from meshwind.path.paths import Counters, Paths
from meshwind.surface.surface import Surface

TOLERANCE = 1e-10
"""Largest unbalanced force at rest, over the tension (an angle in radians)."""
ITERATIONS = 1000
ACCURACY = 1e-5
"""Error of a length, relative, for which particles are chosen where their number is left open."""


def check_extent(surface: Surface) -> None:
    """Raise BadInputError where all of a surface is one point."""
    if not surface.size > 0.0:
        raise BadInputError("all control points lie in one place; a surface needs some extent")


def check_count(value: object, name: str, least: int) -> None:
    """Raise BadInputError where a value is no whole number from `least` up."""
    if not isinstance(value, int | np.integer) or value < least:
        raise BadInputError(f"{name} is {value}; give a whole number, at least {least}")


def check_share(value: float, name: str) -> None:
    """Raise BadInputError where a value is no finite number above 0."""
    if not 0.0 < value < np.inf:
        raise BadInputError(f"{name} is {value:g}; give a relative error above 0")


def check_curves(curves: Floats) -> None:
    """Raise BadInputError where a curve of curves (p, k, 2) stays in one place."""
    nowhere = np.flatnonzero((np.ptp(curves, axis=1) <= 1e-9).all(axis=1)) if curves.shape[1] else [0]
    if len(nowhere):
        raise BadInputError(f"path {nowhere[0]} ends where it starts; give it two ends, or a curve as initial")


def straight(start: Floats, end: Floats, particles: int) -> Floats:
    """Straight lines in the parametric plane (6.2): curves (p, particles, 2) from start to end (p, 2)."""
    if particles == 2:
        return np.stack([start, end], axis=1)
    t = np.linspace(0.0, 1.0, particles)[None, :, None]
    return np.asarray((1.0 - t) * start[:, None] + t * end[:, None])


def solve(
    surface: Surface,
    start: ArrayLike,
    end: ArrayLike,
    *,
    particles: int | None = 401,
    family: ArrayLike | None = None,
    friction: "float | Friction | Callable[[Floats], Floats] | Floats" = 0.0,
    initial: ArrayLike | None = None,
    bridging: bool = True,
    accuracy: float = ACCURACY,
    tolerance: float = TOLERANCE,
    iterations: int = ITERATIONS,
) -> Paths:
    """Lay taut paths between fixed ends, bridging hollows where the fibre lifts off.

    start, end (p, 2): parametric end points, u unwrapped: its change is the number of revolutions (6.1).
    particles: of each path; None for as many as bring the lengths' relative error to `accuracy`, by its estimate.
    friction: a coefficient, a table of them over u and v, or a function of points (n, 3); it holds to the starting
    curves.  initial (p, k, 2): starting curves, straight lines in (u, v) by default (6.2).  bridging: whether the
    fibre can leave the surface.  tolerance: largest unbalanced tangential force over the tension.  iterations: most
    steps a path at any number of particles.  Returns `Paths`, each with its status and residual.
    """
    if particles is not None:
        check_count(particles, "particles", 3)
    check_extent(surface)
    check_count(iterations, "iterations", 1)
    check_share(tolerance, "tolerance")
    check_share(accuracy, "accuracy")
    first, last = floats(start, "start", -1, 2), floats(end, "end", -1, 2)
    if len(first) != len(last):
        raise BadInputError(f"{len(first)} start points but {len(last)} end points; give as many of each")
    for name, point in (("start", first), ("end", last)):
        if point.size and (point[:, 1].min() < 0.0 or point[:, 1].max() > 1.0):
            raise BadInputError(f"a {name} point has v outside [0, 1]; v runs from rim to rim")
    curves = straight(first, last, 2) if initial is None else floats(initial, "initial", len(first), -1, 2)
    check_curves(curves)
    count = len(curves)
    sense = np.where(last[:, 0] >= first[:, 0], 1, -1) if family is None else ints(family, "family", count)
    setting = Setting(surface, friction_of(surface, friction), bridging, tolerance, iterations)
    batch, holds = climb(setting, curves, particles, accuracy)
    return as_paths(setting, batch, sense, holds)


def as_paths(setting: Setting, batch: Batch, sense: ArrayLike, holds: tuple[Floats, Floats] | None = None) -> Paths:
    """The public form of a solved batch."""
    total = batch.tallies.sum(axis=0)
    turns, coefficients = holds if holds is not None else (np.zeros(len(batch)), np.zeros(len(batch)))
    return Paths(
        surface=setting.surface,
        points=frozen(batch.X + setting.surface.middle),
        uv=frozen(batch.uv),
        on_surface=frozen(batch.touching),
        gap=frozen(batch.gap),
        normal=frozen(batch.normal),
        slip=frozen(batch.slip),
        family=frozen(np.asarray(sense, dtype=np.int64)),
        status=frozen(batch.status),
        residual=frozen(batch.residual),
        friction=setting.friction.largest,
        counters=Counters(*(int(total[k]) for k in range(4))),
        holding_turns=frozen(turns),
        holding_friction=frozen(coefficients),
    )
