"""Families of paths: where they start and end, and how their revolutions relate to the winding angle (6.1)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from meshwind.core.brief import brief
from meshwind.core.cast import Floats, Ints, floats, frozen
from meshwind.core.checks import check_type, is_number, whole
from meshwind.core.errors import BadInputError
from meshwind.core.parsing import shortened
from meshwind.core.vectors import TINY
from meshwind.surface.grid import mean_speeds
from meshwind.surface.rims import rim_parameters
from meshwind.surface.surface import Surface

_SPEED_SAMPLES = 32
"""Points each way over which the mean speeds of the parameters are taken."""
_STEEPEST = np.radians(80.0)
"""Winding angle from the axis, on average, past which a winding is a hoop and no longer runs from end to end."""


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

    __repr__ = brief


def families(
    surface: Surface,
    paths: int,
    revolutions: float,
    *,
    phase: float = 0.0,
    between: tuple[float, float] = (0.0, 1.0),
) -> Families:
    """Spread the end points of two families evenly over the rims, or over two level lines between them.

    The starts are spread by arc length over the start rim and the ends likewise over the end rim, for both families
    the same but for a phase. Where a rim's arc length is not even in u, the ends keep the mean turn of the whole rim.

    Parameters
    ----------
    surface : Surface
        Surface that closes in u.
    paths : int
        Number of paths per family, at least 1.
    revolutions : float
        Turns of u from end to end, at least 0: +revolutions for family +1 and -revolutions for family -1.
    phase : float, default 0
        Share of the start rim's length by which the starts of family -1 are ahead of those of family +1.
    between : tuple of float, default (0, 1)
        The v of the lines that the paths start and end on: the rims, or others for a layer over a part of the length.

    Returns
    -------
    Families
        End points of 2 * paths paths.

    Raises
    ------
    BadInputError
        If the surface does not close in u, or `paths`, `revolutions` or `between` is out of range.

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
    check_type(surface, "surface", Surface, "as fit(chart) returns it")
    if not surface.periodic:
        raise BadInputError("families need a surface that closes in u; give end points to `solve` instead")
    paths = whole(paths, "paths", 1)
    if not is_number(revolutions) or revolutions < 0:
        raise BadInputError(f"revolutions is {shortened(repr(revolutions))}; give a number >= 0")
    if not is_number(phase):
        raise BadInputError(f"phase is {shortened(repr(phase))}; give a number, a share of the start rim's length")
    low, high = floats(between, "between", 2)
    if not 0.0 <= low < high <= 1.0:
        raise BadInputError(f"between is {low:g} and {high:g}; give two values of v from 0 to 1, the smaller first")
    turn = np.arange(paths) / paths
    first = np.concatenate([turn, turn + phase])
    last = np.concatenate([turn + revolutions, turn + phase - revolutions])
    start, end = (
        np.stack([rim_parameters(surface, v, share), np.full(2 * paths, v)], axis=1)
        for v, share in ((low, first), (high, last))
    )
    return Families(frozen(start), frozen(end), frozen(np.repeat([1, -1], paths)))


def families_between(start: Floats, end: Floats) -> Families:
    """Paths between given parametric ends (p, 2): family +1 where u grows, then -1."""
    family = np.where(end[:, 0] >= start[:, 0], 1, -1)
    order = np.argsort(-family, kind="stable")
    return Families(frozen(start[order]), frozen(end[order]), frozen(family[order]))


def hoop_revolutions(surface: Surface) -> float:
    """Revolutions of a winding that is all but a hoop."""
    return float(np.tan(_STEEPEST)) * square_revolutions(surface)


def square_revolutions(surface: Surface) -> float:
    """Revolutions of a winding at 45 degrees on average, so that the two families cross square: the best angle."""
    around, along = mean_speeds(surface, _SPEED_SAMPLES)
    return along / max(around, TINY)
