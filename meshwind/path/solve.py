"""Solve a batch of taut paths on a surface."""

import numpy as np
from numpy.typing import ArrayLike

from meshwind.cast import Floats, floats, frozen, ints
from meshwind.errors import BadInputError
from meshwind.path.paths import Counters, Paths
from meshwind.path.relax import LIFTED, relax_all
from meshwind.surface.surface import Surface
from meshwind.threads import spread

TOLERANCE = 1e-10
"""Largest unbalanced force at rest, over the tension (an angle in radians)."""
ITERATIONS = 1000


def straight(start: Floats, end: Floats, particles: int) -> Floats:
    """Straight lines in the parametric plane (6.2): curves (p, particles, 2) from start to end (p, 2)."""
    t = np.linspace(0.0, 1.0, particles)[None, :, None]
    return np.asarray((1.0 - t) * start[:, None] + t * end[:, None])


def solve(
    surface: Surface,
    start: ArrayLike,
    end: ArrayLike,
    *,
    particles: int = 401,
    family: ArrayLike | None = None,
    friction: float = 0.0,
    initial: ArrayLike | None = None,
    tolerance: float = TOLERANCE,
    iterations: int = ITERATIONS,
) -> Paths:
    """Lay taut paths between fixed ends, bridging hollows where the fibre lifts off.

    start, end (p, 2): parametric end points, u unwrapped: its change is the number of revolutions (6.1).
    initial (p, particles, 2): starting curves, straight lines in (u, v) by default (6.2).  tolerance: largest
    unbalanced tangential force over the tension.  Solved in coordinates about the surface's middle, so that a
    part far from the origin loses no digits.  Returns `Paths`, each with its status and residual.
    """
    if friction != 0.0:
        raise BadInputError(f"friction {friction:g} is not supported yet; use 0")
    if not isinstance(particles, int | np.integer) or particles < 3:
        raise BadInputError(f"particles is {particles}; give a whole number, at least 3")
    first, last = floats(start, "start", -1, 2), floats(end, "end", -1, 2)
    if len(first) != len(last):
        raise BadInputError(f"{len(first)} start points but {len(last)} end points; give as many of each")
    for name, point in (("start", first), ("end", last)):
        if np.any((point[:, 1] < 0) | (point[:, 1] > 1)):
            raise BadInputError(f"a {name} point has v outside [0, 1]; v runs from rim to rim")
    curves = (
        straight(first, last, particles) if initial is None else floats(initial, "initial", len(first), particles, 2)
    )
    count = len(curves)
    sense = np.where(last[:, 0] >= first[:, 0], 1, -1) if family is None else ints(family, "family", count)
    middle = surface.control_points.reshape(-1, 3).mean(axis=0)
    net = frozen(surface.net - middle)  # read-only as everywhere: kernels compile once
    shape = (count, particles)
    X, normal, uv = np.empty((*shape, 3)), np.empty((*shape, 3)), np.array(curves)
    touching, gap, slip = np.empty(shape, np.bool_), np.zeros(shape), np.empty(shape)
    residual, status, tallies = np.empty(count), np.empty(count, np.int64), np.zeros((count, 4), np.int64)
    results = X, uv, normal, touching, gap, slip, residual, status, tallies
    setting = net, surface.periodic
    limits = surface.size, tolerance, iterations
    # a part that presses everywhere never pays for the search tree
    spread(
        relax_all, count, 1, *setting, frozen(np.empty((0, 6))), frozen(np.empty((0, 3), np.int64)), *limits, *results
    )
    lifted = np.flatnonzero(status == LIFTED)
    if len(lifted):
        boxes, levels = surface.tree
        again = tuple(np.ascontiguousarray(array[lifted]) for array in results)
        again[1][:] = curves[lifted]
        spread(relax_all, len(lifted), 1, *setting, frozen(boxes - np.tile(middle, 2)), levels, *limits, *again)
        for array, redone in zip(results, again, strict=True):
            array[lifted] = redone
    total = tallies.sum(axis=0)
    return Paths(
        surface=surface,
        points=frozen(X + middle),
        uv=frozen(uv),
        on_surface=frozen(touching),
        gap=frozen(gap),
        normal=frozen(normal),
        slip=frozen(slip),
        family=frozen(sense.astype(np.int64)),
        status=frozen(status),
        residual=frozen(residual),
        friction=friction,
        counters=Counters(*(int(total[k]) for k in range(4))),
    )
