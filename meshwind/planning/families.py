"""Two families of paths that start from the same evenly spread rim points."""

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from meshwind.core.cast import Floats, Ints, frozen
from meshwind.core.errors import BadInputError
from meshwind.surface.surface import Surface

SAMPLES = 16
"""Samples of the rim's speed a span: its length and the places on it are then exact to round-off's square root."""


@dataclass(frozen=True)
class Families:
    """End points of two families of paths.

    Parameters
    ----------
    start, end : ndarray of float, shape (p, 2)
        Parametric end points, u in turns and unwrapped, v in [0, 1].
    family : ndarray of int, shape (p,)
        +1 or -1, the sense of turning; paths of family +1 come first.

    Examples
    --------
    >>> import meshwind as mw
    >>> ends = mw.families(mw.shapes.cylinder(1.0, 3.0), paths=2, revolutions=0.5)
    >>> ends.family
    array([ 1,  1, -1, -1])
    >>> (ends.end - ends.start)[:, 0]  # turns
    array([ 0.5,  0.5, -0.5, -0.5])
    """

    start: Floats
    end: Floats
    family: Ints


def families(surface: Surface, paths: int, revolutions: float) -> Families:
    """Spread the end points of two families evenly over the rims.

    The starts are spread by arc length over the start rim and the ends likewise over the end rim, for both families
    the same. Where a rim's arc length is not even in u, the ends keep the mean turn of the whole rim.

    Parameters
    ----------
    surface : Surface
        Surface that closes in u.
    paths : int
        Number of paths per family, at least 1.
    revolutions : float
        Turns of u from end to end, at least 0: +revolutions for family +1 and -revolutions for family -1.

    Returns
    -------
    Families
        End points of 2 * paths paths.

    Raises
    ------
    BadInputError
        If the surface does not close in u, or `paths` or `revolutions` is out of range.

    See Also
    --------
    read_pins : End points from a file.
    choose_revolutions : Choose the number of revolutions.

    Examples
    --------
    >>> import meshwind as mw
    >>> tube = mw.shapes.cylinder(radius=1.0, length=3.0)
    >>> ends = mw.families(tube, paths=3, revolutions=0.5)
    >>> paths = mw.solve(tube, ends.start, ends.end, family=ends.family, particles=51)
    >>> len(paths)
    6
    """
    if not surface.periodic:
        raise BadInputError("families need a surface that closes in u; give end points to `solve` instead")
    if not isinstance(paths, int | np.integer) or paths < 1:
        raise BadInputError(f"paths is {paths}; give a whole number of paths a family, at least 1")
    if not (np.isfinite(revolutions) and revolutions >= 0):
        raise BadInputError(f"revolutions is {revolutions}; give a number >= 0")
    turn = np.arange(paths) / paths
    first = places(surface, 0.0, turn)
    start = np.stack([first, np.zeros(paths)], axis=1)
    ends = [np.stack([places(surface, 1.0, turn + r), np.ones(paths)], axis=1) for r in (revolutions, -revolutions)]
    family = np.repeat([1, -1], paths)
    return Families(frozen(np.concatenate([start, start])), frozen(np.concatenate(ends)), frozen(family))


def places(surface: Surface, v: float, turn: Floats) -> Floats:
    """The u on the rim v at the given shares (n,) of its length, unwrapped, without a mean shift against u."""
    u = np.linspace(0.0, 1.0, SAMPLES * surface.spans[0] + 1)
    speed = np.linalg.norm(surface.frames(np.stack([u, np.full_like(u, v)], axis=1))[:, 1], axis=1)
    speed[-1] = speed[0]
    length = CubicSpline(u, speed, bc_type="periodic").antiderivative()
    share = length(u) / length(1.0)
    ahead = CubicSpline(u, share - u, bc_type="periodic")
    shift = float(ahead.integrate(0.0, 1.0))
    wanted = np.asarray(turn) + shift
    whole = np.floor(wanted)
    rest = wanted - whole
    at = np.interp(rest, share, u)
    for _ in range(4):  # Newton on a smooth growing function from a start good to 1e-4: quadratic
        at -= (at + ahead(at) - rest) / (1.0 + ahead(at, 1))
    return np.asarray(whole + at)
