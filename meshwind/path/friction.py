"""Friction of fibre on part: a number, a function of position, or a field."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np

from meshwind.core.brief import brief
from meshwind.core.cast import Floats, PicklableRecord, floats, frozen, numbers
from meshwind.core.checks import check_type, whole
from meshwind.core.errors import BadInputError
from meshwind.surface.surface import Surface

ROWS = COLUMNS = 256
"""Samples of a friction field over u and over v; between them it is bilinear."""
LARGEST = 10.0
"""No pair of materials has a coefficient above this: a larger one is a mistake of units."""
_KINDS = "a number, a table over (u, v), a function of points, or a Friction"


@dataclass(frozen=True)
class Friction(PicklableRecord):
    """Coefficients of friction over a surface.

    Parameters
    ----------
    table : ndarray of float, shape (rows, columns)
        Coefficients on an even grid over u (rows) and v (columns), bilinear in between; (1, 1) where the coefficient
        is the same everywhere.  Rows run once around a surface that closes in u, without repeating the first one, and
        otherwise from edge to edge.

    Raises
    ------
    BadInputError
        If the table is no table of finite numbers from 0 up.

    See Also
    --------
    friction_from : Friction from scattered values.

    Examples
    --------
    >>> import meshwind as mw
    >>> import numpy as np
    >>> rough = mw.Friction(np.array([[0.1, 0.3], [0.2, 0.4]]))
    >>> rough.smallest, rough.largest
    (0.1, 0.4)
    """

    table: Floats

    __repr__ = brief

    def __post_init__(self) -> None:
        table = floats(self.table, "friction", -1, -1)
        if not table.size or table.min() < 0.0:
            raise BadInputError("friction is negative or empty; give coefficients from 0 to 10")
        object.__setattr__(self, "table", frozen(table))  # the kernels are compiled for what cannot be written to

    @cached_property
    def none(self) -> bool:
        """Whether there is no friction at all."""
        return not self.table.any()

    @cached_property
    def largest(self) -> float:
        """The largest coefficient."""
        return float(self.table.max())

    @property
    def smallest(self) -> float:
        """The smallest coefficient."""
        return float(self.table.min())


def friction_from(surface: Surface, points: Floats, values: Floats, grid: int = ROWS) -> Friction:
    """Make friction from values at scattered points.

    Between the points, the nearest four are weighted by their inverse distance.

    Parameters
    ----------
    surface : Surface
        Surface that the friction is for.
    points : array_like of float, shape (n, 3)
        Points on or near the surface, in its unit.
    values : array_like of float, shape (n,)
        Coefficients of friction there, from 0 to 10.
    grid : int, default 256
        Number of rows and columns of the table over u and v.

    Returns
    -------
    Friction
        Friction for `solve`, `drag` and others.

    Raises
    ------
    BadInputError
        If shapes do not belong together or a coefficient is not from 0 to 10.

    Examples
    --------
    >>> import meshwind as mw
    >>> tube = mw.shapes.cylinder(radius=1.0, length=2.0)
    >>> rough = mw.friction_from(tube, points=[(1, 0, 0), (1, 0, 2)], values=[0.1, 0.3], grid=16)
    >>> rough.table.shape, round(rough.largest, 3)
    ((16, 16), 0.3)
    """
    from scipy.spatial import cKDTree

    check_type(surface, "surface", Surface, "as fit(chart) returns it")
    whole(grid, "grid", 2)
    tree = cKDTree(floats(points, "points", -1, 3))
    given = floats(values, "values", len(points))

    def nearby(places: Floats) -> Floats:
        far, index = tree.query(places, k=min(4, len(given)))
        far, index = far.reshape(len(places), -1), index.reshape(len(places), -1)
        weight = 1.0 / (far + 1e-9 * surface.size)
        return np.asarray((weight * given[index]).sum(axis=1) / weight.sum(axis=1))

    return friction_of(surface, nearby, grid)


def friction_of(
    surface: Surface, given: float | Friction | Callable[[Floats], Floats] | Floats, grid: int = ROWS
) -> Friction:
    """Take friction as a number, a table (rows, columns), or a function of points (n, 3) that returns (n,)."""
    if isinstance(given, Friction):
        return given
    if isinstance(given, int | float):
        return uniform(float(given))
    if callable(given):
        u = np.arange(grid) / grid if surface.periodic else np.linspace(0.0, 1.0, grid)
        places = np.stack(np.meshgrid(u, np.linspace(0.0, 1.0, grid), indexing="ij"), axis=-1).reshape(-1, 2)
        values = numbers(given(surface.points(places)), "the friction function's result", "one number a point")
        if values.shape != (len(places),):
            raise BadInputError(f"the friction function returned shape {values.shape}; return one number a point")
        table = values.reshape(grid, grid)
    else:
        table = numbers(given, "friction", _KINDS)
        table = table.reshape(1, 1) if table.ndim == 0 else floats(table, "friction", -1, -1)
        if table.shape != (1, 1) and min(table.shape) < 2:
            raise BadInputError(f"friction has shape {table.shape}; give a number or a table of at least 2 by 2")
    return _checked(table)


@cache
def uniform(coefficient: float) -> Friction:
    """The same friction all over."""
    return _checked(np.full((1, 1), coefficient))


def _checked(table: Floats) -> Friction:
    if not np.isfinite(table).all() or table.min() < 0.0 or table.max() > LARGEST:
        raise BadInputError(f"friction goes from {table.min():g} to {table.max():g}; give coefficients from 0 to 10")
    return Friction(table)
