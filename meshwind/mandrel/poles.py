"""The extreme ends of a closed part along an axis: the pole of a dome or a flat end, the lip of a hollow one."""

from dataclasses import dataclass

import igl
import numpy as np

from meshwind.cast import Floats, Ints
from meshwind.mandrel.measure import area_vectors, areas
from meshwind.mandrel.subdivide import crossing, subdivide
from meshwind.mandrel.topology import euler, patches

_CAPS = (0.01, 0.03)  # heights of the cap over the part's extent along the axis


@dataclass(frozen=True)
class Lip:
    """The rim of a cup: where the plane of the points x with x . direction = height cuts its wall."""

    direction: Floats
    height: float


def extreme(vertices: Floats, faces: Ints, direction: Floats) -> tuple[Floats, Lip | None]:
    """Middle (3,) of the part's end in `direction`, on the surface, and its lip if it is the mouth of a cup.

    The centroid of the cap goes back onto the surface along the direction, so that a dome gives its apex, a
    flat end its centre and a dished one its bottom.  Deeper than wide is a cup: its lining is no place to wind.
    """
    for share in _CAPS:
        level, points, cap = _cap(vertices, faces, direction, share)
        area = areas(points, cap)
        centre = (area[:, None] * points[cap].mean(axis=1)).sum(axis=0) / area.sum()
        hit = _shoot(vertices, faces, centre, direction) if euler(cap) == 0 or share == _CAPS[-1] else None
        if hit is not None and euler(cap) == 0:
            out = points[cap].mean(axis=1) - centre
            width = np.sqrt((area * (out**2).sum(axis=1)).sum() / area.sum())
            if (centre - hit) @ direction > width:
                return centre, Lip(direction, level)
    return (nearest(vertices, faces, centre) if hit is None else hit), None


def nearest(vertices: Floats, faces: Ints, point: Floats) -> Floats:
    """Point (3,) of the surface nearest to `point`."""
    return np.asarray(igl.point_mesh_squared_distance(point[None], vertices, faces)[2][0], dtype=np.float64)


def _cap(vertices: Floats, faces: Ints, direction: Floats, share: float) -> tuple[float, Floats, Ints]:
    """Level of the cap, its vertices and the faces of its largest patch, cut exactly at the level."""
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
    return level, points, faces[label == np.argmax(np.bincount(label, areas(points, faces)))]


def _shoot(vertices: Floats, faces: Ints, point: Floats, direction: Floats) -> Floats | None:
    """Where the line through `point` meets the surface closest to it, None where it misses."""
    normals = area_vectors(vertices, faces)
    facing = normals @ direction
    across = np.abs(facing) > 1e-9 * np.linalg.norm(normals, axis=1)
    a, b, c = (vertices[faces[across, k]] - point for k in range(3))
    # Twice the areas that the line makes with two corners each: their shares are barycentric coordinates.
    share = np.column_stack([np.cross(p, q) @ direction for p, q in ((b, c), (c, a), (a, b))])
    share /= 2.0 * facing[across][:, None]
    hits = np.flatnonzero(share.min(axis=1, initial=np.inf) > -1e-9)
    if len(hits) == 0:
        return None
    distance = np.einsum("ij,ij->i", a[hits], normals[across][hits]) / facing[across][hits]
    return np.asarray(point + distance[np.argmin(np.abs(distance))] * direction)
