"""Coverage: how many layers of band lie over each cell of the surface."""

from dataclasses import dataclass
from math import floor

import numpy as np

from meshwind.core.brief import brief
from meshwind.core.cast import Floats, frozen
from meshwind.core.checks import is_number, text
from meshwind.core.errors import BadInputError
from meshwind.core.kernel import njit
from meshwind.core.vectors import TINY
from meshwind.path.paths import Paths
from meshwind.surface.forms import area_elements
from meshwind.surface.grid import composite_gauss, mean_speeds, parameter_grid
from meshwind.surface.surface import Surface

_FEWEST_ROWS, _MOST_ROWS = 4, 256
"""Cells from end to end."""
_SPEED_SAMPLES = 16
"""Points each way from which the cells' shape is chosen: it need not be exact."""
_GAUSS = 4
"""Gauss nodes per span, each way: they integrate polynomials of degree 7 exactly."""
_AT_ONCE = 200_000
"""Gauss nodes that are evaluated at a time."""
_PROGRESS = 1e-12
"""Least share of a cell by which a segment goes on, so that round-off does not stop it at a wall."""


@dataclass(frozen=True)
class Coverage:
    """Layers over the cells of an (nu, nv) grid on the (u, v) rectangle, one fibre pitch wide.

    layers (nu, nv) = length of fibre over the cell x width / area of the cell, bridges counted at their feet;
    area (nu, nv) of the cells; width of the band.  Sum(layers x area) = width x total length, exactly.
    """

    layers: Floats
    area: Floats
    width: float

    __repr__ = brief

    @property
    def min(self) -> float:
        """Fewest layers over any cell."""
        return float(self.layers.min())

    @property
    def median(self) -> float:
        """Median over the cells."""
        return float(np.median(self.layers))

    @property
    def max(self) -> float:
        """Most layers over any cell."""
        return float(self.layers.max())

    def at(self, uv: Floats) -> Floats:
        """Layers at uv (n, 2), linear between the centres of the cells."""
        return between_centres(self.layers, uv)


def between_centres(cells: Floats, uv: Floats) -> Floats:
    """Values (n,) at uv (n, 2) of a table over cells (nu, nv) that close in u, linear between their centres."""
    nu, nv = cells.shape
    x = np.mod(uv[:, 0] * nu - 0.5, nu)
    y = np.clip(uv[:, 1] * nv - 0.5, 0.0, nv - 1.0)
    i, j = np.minimum(x.astype(np.int64), nu - 1), np.minimum(y.astype(np.int64), max(nv - 2, 0))
    f, g = x - i, y - j
    right, above = (i + 1) % nu, np.minimum(j + 1, nv - 1)
    here = (1.0 - f) * cells[i, j] + f * cells[right, j]
    there = (1.0 - f) * cells[i, above] + f * cells[right, above]
    return np.asarray((1.0 - g) * here + g * there)


def coverage(paths: Paths, width: float | None = None) -> Coverage:
    """Lay a band of `width` (in mesh units) along every path and count layers.

    By default the band is as wide as gives one layer per family on average.
    """
    if width is not None and not (is_number(width) and width > 0.0):
        raise BadInputError(f"band width {text(width)} is no length; give a number > 0 in the mesh's units")
    families, count = np.unique(paths.family, return_counts=True)
    steps = np.linalg.norm(np.diff(paths.points, axis=1), axis=2)
    nu = max(int(count.max(initial=0)), 1)
    nv = _rows(paths.surface, nu)
    area = cell_areas(paths.surface, nu, nv)
    length = np.zeros((nu, nv))
    add_lengths(paths.uv, steps, length)
    total = float(steps.sum())
    if width is None:
        width = len(families) * float(area.sum()) / total if total > 0.0 else 0.0
    layers = np.divide(width * length, area, out=np.zeros_like(length), where=area > 0.0)
    return Coverage(frozen(layers), frozen(area), float(width))


def _rows(surface: Surface, nu: int) -> int:
    """Rows that make cells about as long as they are wide."""
    around, along = mean_speeds(surface, _SPEED_SAMPLES)
    return int(np.clip(round(nu * along / max(around, TINY)), _FEWEST_ROWS, _MOST_ROWS))


def cell_areas(surface: Surface, nu: int, nv: int) -> Floats:
    """Areas (nu, nv) of the grid's cells by Gauss quadrature of |s_u x s_v|."""
    pieces = [-(-spans // cells) for spans, cells in zip(surface.spans, (nu, nv), strict=True)]
    (u, wu), (v, wv) = (composite_gauss(n * many, _GAUSS) for n, many in zip((nu, nv), pieces, strict=True))
    deep, wide = pieces[0] * _GAUSS, pieces[1] * _GAUSS
    out = np.empty((nu, nv))
    rows = max(1, _AT_ONCE // (deep * len(v)))
    for first in range(0, nu, rows):  # a path's pitch is a column of cells: all their frames at once would take GB
        some = slice(first * deep, min(first + rows, nu) * deep)
        element = area_elements(surface.frames(parameter_grid(u[some], v))).reshape(-1, len(v))
        patches = (wu[some, None] * element * wv).reshape(-1, deep, nv, wide)
        out[first : first + rows] = patches.sum(axis=(1, 3))
    return out


@njit(nogil=True, cache=True)
def add_lengths(uv: Floats, steps: Floats, length: Floats) -> None:
    """Add the length of every segment to the cells it passes, in the share it spends in each in (u, v)."""
    nu, nv = length.shape
    for p in range(steps.shape[0]):
        for k in range(steps.shape[1]):
            x, y = uv[p, k, 0] * nu, uv[p, k, 1] * nv
            dx, dy = uv[p, k + 1, 0] * nu - x, uv[p, k + 1, 1] * nv - y
            done = 0.0
            while done < 1.0:
                share = min(_to_wall(x, dx, done), _to_wall(y, dy, done), 1.0)
                middle = 0.5 * (done + share)
                i = floor(x + middle * dx) % nu
                j = min(max(floor(y + middle * dy), 0), nv - 1)
                length[i, j] += (share - done) * steps[p, k]
                done = share


@njit(forceinline=True, cache=True)
def _to_wall(x: float, dx: float, done: float) -> float:
    """Share of the step at which coordinate x + f dx reaches its next whole number strictly after f = done."""
    if dx == 0.0:
        return 1.0
    here = x + done * dx
    wall = floor(here + _PROGRESS) + 1.0 if dx > 0.0 else -floor(_PROGRESS - here) - 1.0
    return max((wall - x) / dx, done + _PROGRESS)
