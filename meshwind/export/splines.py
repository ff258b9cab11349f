"""B-splines as CAD writes them: clamped, so that the end knots are as often there as the degree says and once more."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Floats, frozen
from meshwind.surface.evaluate import DEGREE
from meshwind.surface.surface import Surface


@dataclass(frozen=True)
class Clamped:
    """Poles (m, ...) of a cubic spline on clamped `knots` (m + 4,): the first and the last pole lie on it."""

    poles: Floats
    knots: Floats


def clamped(poles: Floats, knots: Floats, axis: int) -> Clamped:
    """The same spline between its outermost whole spans, by inserting knots there: nothing is approximated."""
    from scipy.interpolate import BSpline

    first, last = float(knots[DEGREE]), float(knots[-DEGREE - 1])
    spline = BSpline(knots, np.moveaxis(poles, axis, 0), DEGREE)
    spline = spline.insert_knot(first, DEGREE).insert_knot(last, DEGREE)
    inside = slice(DEGREE, len(spline.t) - DEGREE)
    count = len(spline.t[inside]) - DEGREE - 1
    held = np.moveaxis(spline.c[DEGREE : DEGREE + count], 0, axis)
    return Clamped(frozen(held), frozen(spline.t[inside]))


def clamped_surface(surface: Surface) -> tuple[Floats, Floats, Floats]:
    """Poles (mu, mv, 3) and clamped knots in u and in v of a surface; where it closes, both ends are the same."""
    knots_u, knots_v = surface.knots
    along = clamped(surface.net, knots_v, 1)
    around = clamped(along.poles, knots_u, 0)
    poles = np.array(around.poles)
    if surface.periodic:
        poles[-1] = poles[0]  # equal but for rounding, and CAD wants it closed
    return frozen(poles), around.knots, along.knots


def curve_through(points: Floats) -> Clamped:
    """The cubic spline through points (n, 3), by the length of its chords; points on one another count once."""
    from scipy.interpolate import make_interp_spline

    chords = np.linalg.norm(np.diff(points, axis=0), axis=1)
    kept = points[np.concatenate([[True], chords > 1e-12 * chords.sum()])]
    arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(kept, axis=0), axis=1))])
    spline = make_interp_spline(arc, kept, DEGREE)
    return Clamped(frozen(spline.c), frozen(spline.t))
