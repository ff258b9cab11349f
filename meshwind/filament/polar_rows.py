"""Marched fibres as paths: points evenly by arc length, on curves as exact as the march itself.

Between two rows of a march lies one polynomial piece of the surface, so that u and v there are smooth: they are
interpolated by polynomials of degree 5 from their values, first and second derivatives at both rows.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from meshwind.core.cast import Floats, Ints, frozen
from meshwind.core.threads import parallel_for
from meshwind.filament.marched_points import Rows, Way, curvatures, places, spread
from meshwind.filament.polar_legs import Half
from meshwind.march.forward import Marched
from meshwind.surface.surface import Surface


@dataclass(frozen=True)
class Stretch:
    """Marched fibres (p,) on a half of the surface, to be run through as they were marched or `backwards`."""

    marched: Marched
    half: Half
    backwards: bool

    @cached_property
    def rows(self) -> Rows:
        """Their rows on the half, with curvatures."""
        rows = self.marched.rows
        first = np.cumsum([0, *(len(row) for row in rows)])
        made = Rows(frozen(first), frozen(np.concatenate(rows)), np.empty((first[-1], 3)), frozen(self.marched.slip))
        parallel_for(curvatures, len(rows), 1, self.half.surface.spline, made)
        return made

    @cached_property
    def length(self) -> Floats:
        """Length (p,) of each."""
        return self.rows.at[self.rows.first[1:] - 1, 0]


@dataclass(frozen=True)
class Evenly:
    """Paths of n points: uv (p, n, 2), where u of each begins within [0, 1), points and outward normals (p, n, 3).

    slip (p, n): that of each point, without its sign; angle (p, n): their winding angle, of no size if not asked for.
    """

    uv: Floats
    points: Floats
    normal: Floats
    slip: Floats
    angle: Floats


def evenly(surface: Surface, fibres: Sequence[Stretch], count: int, *, angles: bool = False) -> Evenly:
    """So many points along fibres of one stretch or several in a row, evenly by arc length."""
    lengths = np.stack([stretch.length for stretch in fibres], axis=1)
    end = np.cumsum(lengths, axis=1)
    begin, total = end - lengths, end[:, -1]
    wanted = total[:, None] * np.linspace(0.0, 1.0, count)
    uv, slip = np.empty((*wanted.shape, 2)), np.empty(wanted.shape)
    whole = np.floor(fibres[0].rows.at[_outer(fibres[0]), 1])
    for k, stretch in enumerate(fibres):
        way = Way(
            frozen(begin[:, k]), frozen(end[:, k]), k == len(fibres) - 1, stretch.backwards, frozen(whole),
            float(stretch.half.first), float(stretch.half.last),
        )  # fmt: skip
        parallel_for(spread, len(total), 1, stretch.rows, way, wanted, uv, slip)
    points, normal = np.empty((*wanted.shape, 3)), np.empty((*wanted.shape, 3))
    angle = np.empty(wanted.shape if angles else (0, 0))
    parallel_for(places, len(total), 1, surface.spline, uv, points, normal, angle)
    return Evenly(uv, points, normal, slip, angle)


def _outer(stretch: Stretch) -> Ints:
    """Rows (p,) with which fibres begin."""
    return np.asarray(stretch.rows.first[1:] - 1 if stretch.backwards else stretch.rows.first[:-1])
