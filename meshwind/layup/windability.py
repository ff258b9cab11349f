"""Where, and in which directions, a taut fibre presses on the surface (Fig. 1.3): from its curvature alone."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Floats, Ints, frozen
from meshwind.surface.surface import Surface

FLAT = 1e-3
"""Curvature times the part's size below which a direction counts as flat: a sag of 1e-4 of the part."""
CONVEX, SADDLE, CONCAVE = 1, 0, -1


@dataclass(frozen=True)
class Windability:
    """Of k points: which directions press.  All arrays are read-only.

    normal (k, 3) outward; largest, smallest (k,) principal curvature, positive where the surface bulges outward; kind
    (k,): 1 convex (every direction presses), 0 saddle (some do), -1 concave (none does); direction (k, 3): the unit
    tangent in which a fibre presses hardest; reach (k,): a fibre presses up to this angle, in radians, to both sides
    of it: pi/2 where convex, 0 where concave; share (k,): of all directions, reach over pi/2; angle (k,): winding angle
    of `direction` from s_v, -pi/2 to pi/2, positive towards s_u; weight (k,): area of the surface that a point stands
    for, over the whole.
    """

    normal: Floats
    largest: Floats
    smallest: Floats
    kind: Ints
    direction: Floats
    reach: Floats
    angle: Floats
    weight: Floats

    @property
    def share(self) -> Floats:
        """Share (k,) of the tangent directions that press."""
        return np.asarray(self.reach / (0.5 * np.pi))

    def area(self, kind: int) -> float:
        """Share of the surface that is CONVEX, SADDLE or CONCAVE."""
        return float(self.weight[self.kind == kind].sum())

    @property
    def untouchable(self) -> float:
        """Share of the surface that no fibre can touch, whatever its direction."""
        return self.area(CONCAVE)

    def presses(self, angle: Floats | float) -> Floats:
        """Whether (k,) a fibre with this winding angle from s_v (radians, positive towards s_u) presses."""
        off = np.mod(np.asarray(angle) - self.angle + 0.5 * np.pi, np.pi) - 0.5 * np.pi
        return np.asarray((np.abs(off) <= self.reach) & (self.kind != CONCAVE))


def windability(surface: Surface, uv: Floats | None = None) -> Windability:
    """Find where, and in which directions, a taut fibre presses on a surface.

    Only the curvature of the surface counts: a fibre presses where its normal curvature is positive.

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
    if uv is None:
        nu, nv = (int(np.clip(2 * spans, 16, 200)) for spans in surface.spans)
        u, v = (np.arange(nu) + 0.5) / nu, (np.arange(nv) + 0.5) / nv
        uv = np.stack(np.meshgrid(u, v, indexing="ij"), axis=2).reshape(-1, 2)
    return of_frames(surface.frames(uv), FLAT / surface.size)


def of_frames(frames: Floats, flat: float) -> Windability:
    """Look at frames (k, 6, 3); curvatures down to -flat, over a length, count as none."""
    _, su, sv, suu, suv, svv = np.moveaxis(frames, 1, 0)
    normal, area = _unit(np.cross(su, sv))
    first = tuple((a * b).sum(axis=1) for a, b in ((su, su), (su, sv), (sv, sv)))
    second = tuple(-(bend * normal).sum(axis=1) for bend in (suu, suv, svv))
    k1, k2 = _principal(first, second, area)
    direction = _direction(first, second, k1, su, sv)
    kind = np.where(k2 >= -flat, CONVEX, np.where(k1 <= flat, CONCAVE, SADDLE))
    # Euler: k1 cos^2 + k2 sin^2 = 0 at the angle whose tangent is sqrt(k1 / -k2)
    reach = np.arctan2(np.sqrt(np.maximum(k1, 0.0)), np.sqrt(np.maximum(-k2, 0.0)))
    reach = np.where(kind == CONVEX, 0.5 * np.pi, np.where(kind == CONCAVE, 0.0, reach))
    along = _unit(sv)[0]
    across = np.cross(along, normal)  # towards s_u: s_u x s_v is outward
    angle = np.arctan2((direction * across).sum(axis=1), (direction * along).sum(axis=1))
    angle = np.mod(angle + 0.5 * np.pi, np.pi) - 0.5 * np.pi
    weight = area / max(float(area.sum()), 1e-300)
    return Windability(*map(frozen, (normal, k1, k2, kind, direction, reach, angle, weight)))


def _unit(vectors: Floats) -> tuple[Floats, Floats]:
    size = np.linalg.norm(vectors, axis=1)
    return np.divide(vectors, size[:, None], out=np.zeros_like(vectors), where=size[:, None] > 0.0), size


def _principal(first: tuple[Floats, ...], second: tuple[Floats, ...], area: Floats) -> tuple[Floats, Floats]:
    """Larger and smaller principal curvature from the two fundamental forms."""
    (e, f, g), (l, m, n) = first, second
    safe = np.where(area > 0.0, area * area, np.inf)  # a collapsed point counts as flat
    mean = 0.5 * (e * n - 2.0 * f * m + g * l) / safe
    root = np.sqrt(np.maximum(mean * mean - (l * n - m * m) / safe, 0.0))
    return mean + root, mean - root


def _direction(first: tuple[Floats, ...], second: tuple[Floats, ...], k1: Floats, su: Floats, sv: Floats) -> Floats:
    """The unit tangent (k, 3) of the larger principal curvature; along s_u where all directions are alike."""
    (e, f, g), (l, m, n) = first, second
    rows = [(m - k1 * f, k1 * e - l), (n - k1 * g, k1 * f - m)]  # either row of (II - k1 I) x = 0
    either = [a[:, None] * su + b[:, None] * sv for a, b in rows]
    size = [np.linalg.norm(tangent, axis=1) for tangent in either]
    best = np.where((size[0] >= size[1])[:, None], either[0], either[1])
    scale = (np.abs(k1) + 1e-300) * np.maximum(e, g) * np.sqrt(np.maximum(e, g))
    alike = np.maximum(*size) <= 1e-12 * scale
    return _unit(np.where(alike[:, None], su, best))[0]
