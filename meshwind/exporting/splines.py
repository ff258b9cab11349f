"""Clamped B-splines, as CAD needs them: the end knots are repeated degree + 1 times."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Floats, frozen
from meshwind.surface.evaluate import DEGREE
from meshwind.surface.surface import Surface


@dataclass(frozen=True)
class Clamped:
    """Poles (m, ...) of a cubic spline with clamped `knots` (m + 4,): the first and the last pole are its ends."""

    poles: Floats
    knots: Floats


def clamped(poles: Floats, knots: Floats, axis: int) -> Clamped:
    """The same spline on its domain, clamped exactly by knot insertion."""
    from scipy.interpolate import BSpline

    first, last = float(knots[DEGREE]), float(knots[-DEGREE - 1])
    spline = BSpline(knots, np.moveaxis(poles, axis, 0), DEGREE)
    spline = spline.insert_knot(first, DEGREE).insert_knot(last, DEGREE)
    inside = slice(DEGREE, len(spline.t) - DEGREE)
    count = len(spline.t[inside]) - DEGREE - 1
    held = np.moveaxis(spline.c[DEGREE : DEGREE + count], 0, axis)
    return Clamped(frozen(held), frozen(spline.t[inside]))


def clamped_surface(surface: Surface) -> tuple[Floats, Floats, Floats]:
    """Poles (mu, mv, 3) and clamped knots in u and in v of a surface; if it is closed, both ends are the same."""
    knots_u, knots_v = surface.knots
    along = clamped(surface.net, knots_v, 1)
    around = clamped(along.poles, knots_u, 0)
    poles = np.array(around.poles)
    if surface.periodic:
        poles[-1] = poles[0]  # equal except for rounding; CAD needs it closed exactly
    return frozen(poles), around.knots, along.knots


def curve_through(points: Floats) -> Clamped:
    """The cubic spline through points (n, 3), parametrised by chord length; coincident points count once."""
    from scipy.interpolate import make_interp_spline

    chords = np.linalg.norm(np.diff(points, axis=0), axis=1)
    kept = points[np.concatenate([[True], chords > 1e-12 * chords.sum()])]
    arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(kept, axis=0), axis=1))])
    spline = make_interp_spline(arc, kept, DEGREE)
    return Clamped(frozen(spline.c), frozen(spline.t))
