"""Ends of a closed part along an axis: the pole of a dome or of a flat end, the lip of a hollow end."""

from dataclasses import dataclass

import igl
import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.mesh.geometry.areas_and_volumes import area_vectors, areas
from meshwind.mesh.geometry.subdivide import crossing, subdivide
from meshwind.mesh.geometry.topology import euler, patches

_CAP_HEIGHTS = (0.01, 0.03)
"""Heights of the cap over the part's extent along the axis: the usual one, and the one of a hollow or ragged end."""
_NEEDLE = 2.0
"""Height of a cap over its width above which the end is that of a needle."""
_LOWEST_CAP = 1e-5
"""Least height of a cap over the part's extent."""


@dataclass(frozen=True)
class Lip:
    """The rim of a cup: the intersection of its wall with the plane x . direction = height."""

    direction: Floats
    height: float


@dataclass(frozen=True)
class _Cap:
    """The piece of a part above a level: faces (m, 3) with points (n, 3), and the centroid (3,) of its surface."""

    level: float
    points: Floats
    faces: Ints
    centre: Floats
    width: float
    """Root-mean-square distance of the surface from its centroid, perpendicular to the direction."""


def extreme(vertices: Floats, faces: Ints, direction: Floats) -> tuple[Floats, Lip | None]:
    """Pole (3,) of the part's end in `direction`, on the surface, and its lip if the end is hollow like a cup.

    The centroid of the cap is projected onto the surface along the direction, which gives the apex of a dome, the
    centre of a flat end and the bottom of a dished one.  An end that is deeper than wide is a cup.
    """
    usual = _blunt(vertices, faces, direction)
    for share in (usual, usual * _CAP_HEIGHTS[1] / _CAP_HEIGHTS[0]):
        cap = _cap(vertices, faces, direction, share)
        ring = euler(cap.faces) == 0
        hit = _shoot(vertices, faces, cap.centre, direction) if ring or share > usual else None
        if hit is not None and ring and (cap.centre - hit) @ direction > cap.width:
            return cap.centre, Lip(direction, cap.level)
    return (nearest(vertices, faces, cap.centre) if hit is None else hit), None


def _blunt(vertices: Floats, faces: Ints, direction: Floats) -> float:
    """Height of the lower cap over the part's extent; it is reduced for a needle.

    The centroid of a cap that is far higher than wide would be projected onto the needle's flank, below its tip.
    """
    share, extent = _CAP_HEIGHTS[0], float(np.ptp(vertices @ direction))
    while share > _LOWEST_CAP and share * extent > _NEEDLE * _cap(vertices, faces, direction, share).width:
        share *= 0.25
    return share


def nearest(vertices: Floats, faces: Ints, point: Floats) -> Floats:
    """Nearest point (3,) of the surface to `point`."""
    return np.asarray(igl.point_mesh_squared_distance(point[None], vertices, faces)[2][0], dtype=np.float64)


def _cap(vertices: Floats, faces: Ints, direction: Floats, share: float) -> _Cap:
    """The largest patch above a level, which is the share of the part's extent below its top; faces are cut there."""
    height = vertices @ direction
    level = float(height.max() - share * np.ptp(height))
    side = np.sign(height - level).astype(np.int64)
    faces = faces[(side[faces] > 0).any(axis=1)]
    cut = crossing(faces, side)
    low, high = cut.T
    t = (level - height[low]) / (height[high] - height[low])
    points = np.concatenate([vertices, vertices[low] + t[:, None] * (vertices[high] - vertices[low])])
    faces = subdivide(points, faces, cut, len(vertices))
    side = np.concatenate([side, np.zeros(len(cut), dtype=np.int64)])
    faces = faces[side[faces].sum(axis=1) > 0]
    label = patches(faces)
    faces = faces[label == np.argmax(np.bincount(label, areas(points, faces)))]
    area, middle = areas(points, faces), points[faces].mean(axis=1)
    centre = (area[:, None] * middle).sum(axis=0) / area.sum()
    out = middle - centre
    out -= (out @ direction)[:, None] * direction
    return _Cap(level, points, faces, centre, float(np.sqrt((area * (out**2).sum(axis=1)).sum() / area.sum())))


def _shoot(vertices: Floats, faces: Ints, point: Floats, direction: Floats) -> Floats | None:
    """Intersection of the line through `point` with the surface that is closest to it, or None."""
    normals = area_vectors(vertices, faces)
    facing = normals @ direction
    across = np.abs(facing) > 1e-9 * np.linalg.norm(normals, axis=1)
    a, b, c = (vertices[faces[across, k]] - point for k in range(3))
    # twice the areas spanned by the line and two corners each: their shares are barycentric coordinates
    share = np.column_stack([np.cross(p, q) @ direction for p, q in ((b, c), (c, a), (a, b))])
    share /= 2.0 * facing[across][:, None]
    hits = np.flatnonzero(share.min(axis=1, initial=np.inf) > -1e-9)
    if len(hits) == 0:
        return None
    distance = np.einsum("ij,ij->i", a[hits], normals[across][hits]) / facing[across][hits]
    return np.asarray(point + distance[np.argmin(np.abs(distance))] * direction)
