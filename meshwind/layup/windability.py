"""Where, and in which directions, a taut fibre presses on the surface (Fig. 1.3): from its curvature alone."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from meshwind.core.brief import brief
from meshwind.core.cast import Floats, Ints, frozen
from meshwind.core.checks import check_type
from meshwind.core.vectors import TINY, unit
from meshwind.surface.evaluate import SV
from meshwind.surface.flatness import real_forms
from meshwind.surface.forms import fundamental_forms
from meshwind.surface.grid import midpoints, parameter_grid
from meshwind.surface.principal import principal
from meshwind.surface.surface import Surface

FLAT = 1e-3
"""Curvature times the part's size below which a direction counts as flat: a sag of 1e-4 of the part."""
CONVEX, SADDLE, CONCAVE = 1, 0, -1
"""Kinds of points: every tangent direction presses, some do, none does."""
_CELLS_PER_SPAN, _FEWEST_CELLS, _MOST_CELLS = 2, 16, 200
"""Cells of the grid whose middles are looked at: curvature is linear within a span, and a map needs no more."""


@dataclass(frozen=True)
class Windability:
    """The directions in which a fibre presses, at k points.  All arrays are read-only.

    Attributes
    ----------
    normal : ndarray of float, shape (k, 3)
        Outward unit normals.
    largest, smallest : ndarray of float, shape (k,)
        Principal curvatures, positive where the surface bulges outward.
    kind : ndarray of int, shape (k,)
        1 where every direction presses (convex), 0 where some do (saddle), -1 where none does (concave).
    direction : ndarray of float, shape (k, 3)
        Unit tangents in which a fibre presses hardest.
    reach : ndarray of float, shape (k,)
        Angle, in radians, up to which a fibre presses to both sides of it: pi/2 where convex, 0 where concave.
    angle : ndarray of float, shape (k,)
        Winding angle of `direction` from s_v, -pi/2 to pi/2, positive towards s_u.
    weight : ndarray of float, shape (k,)
        Area of the surface that a point stands for, over the whole.
    """

    normal: Floats
    largest: Floats
    smallest: Floats
    kind: Ints
    direction: Floats
    reach: Floats
    angle: Floats
    weight: Floats

    __repr__ = brief

    @property
    def share(self) -> Floats:
        """Share (k,) of the tangent directions that press."""
        return np.asarray(self.reach / (0.5 * np.pi))

    def area(self, kind: int) -> float:
        """Share of the surface that is CONVEX, SADDLE or CONCAVE."""
        return float(self.weight[self.kind == kind].sum())

    @property
    def untouchable(self) -> float:
        """Share of the surface that a fibre can touch in no direction."""
        return self.area(CONCAVE)

    def presses(self, angle: Floats | float) -> Floats:
        """Whether (k,) a fibre with this winding angle from s_v (radians, positive towards s_u) presses."""
        off = np.mod(np.asarray(angle) - self.angle + 0.5 * np.pi, np.pi) - 0.5 * np.pi
        return np.asarray((np.abs(off) <= self.reach) & (self.kind != CONCAVE))


def windability(surface: Surface, uv: Floats | None = None) -> Windability:
    """Find where, and in which directions, a taut fibre presses on a surface.

    Only the curvature of the surface counts: a fibre presses where its normal curvature is positive.  A hollow that is
    shallower than the surface is uncertain, or than its threshold, counts as flat.

    Parameters
    ----------
    surface : Surface
        Surface to look at.
    uv : ndarray of float, shape (k, 2), optional
        Parametric points.  By default the middles of the cells of a fine grid.

    Returns
    -------
    Windability
        Principal curvatures, the direction in which a fibre presses hardest, and the share of the directions in which
        it presses, at each point.

    Examples
    --------
    >>> import meshwind as mw
    >>> import numpy as np
    >>> elbow = mw.shapes.elbow(major=3.0, minor=1.0)
    >>> found = mw.windability(elbow, np.array([(0.0, 0.5), (0.5, 0.5)]))  # outside and inside of the bend
    >>> found.kind, found.share.round(2)
    (array([1, 0]), array([1.  , 0.61]))
    """
    check_type(surface, "surface", Surface, "as fit(chart) returns it")
    if uv is None:
        nu, nv = (int(np.clip(_CELLS_PER_SPAN * spans, _FEWEST_CELLS, _MOST_CELLS)) for spans in surface.spans)
        uv = parameter_grid(midpoints(nu), midpoints(nv))
    return of_frames(surface.frames(uv), FLAT / surface.size, (surface, uv))


def of_frames(frames: Floats, flat: float, place: tuple[Surface, Floats] | None = None) -> Windability:
    """Windability at frames (k, 6, 3); curvatures from -flat to 0, over a length, count as none.

    place: the surface and the points uv (k, 2) on it, whose hollows count only where they are real (see `flatness`).
    """
    forms = fundamental_forms(frames) if place is None else real_forms(*place, frames)
    sv = frames[:, SV]
    k1, k2, direction = principal(frames, forms)
    kind = np.where(k2 >= -flat, CONVEX, np.where(k1 <= flat, CONCAVE, SADDLE))
    # Euler: k1 cos^2 + k2 sin^2 = 0 at the angle whose tangent is sqrt(k1 / -k2)
    reach = np.arctan2(np.sqrt(np.maximum(k1, 0.0)), np.sqrt(np.maximum(-k2, 0.0)))
    reach = np.where(kind == CONVEX, 0.5 * np.pi, np.where(kind == CONCAVE, 0.0, reach))
    along = unit(sv)
    across = np.cross(along, forms.normal)  # towards s_u: s_u x s_v is outward
    angle = np.arctan2((direction * across).sum(axis=1), (direction * along).sum(axis=1))
    angle = np.mod(angle + 0.5 * np.pi, np.pi) - 0.5 * np.pi
    weight = forms.area / max(float(forms.area.sum()), TINY)
    return Windability(*map(frozen, (forms.normal, k1, k2, kind, direction, reach, angle, weight)))
