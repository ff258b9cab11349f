"""Poles: the points where a closed part meets its axis."""

import igl
import numpy as np

from meshwind.cast import Floats, Ints
from meshwind.mandrel.measure import area_vectors, areas
from meshwind.mandrel.subdivide import crossing, subdivide
from meshwind.mandrel.topology import patches

_CAP = 0.03  # height of the cap over the part's extent along the axis


def pole(vertices: Floats, faces: Ints, direction: Floats) -> Floats:
    """Point (3,) of the surface at its extreme end in `direction`: the middle of the cap there.

    The cap's centroid goes back onto the surface along the direction, so that a dome gives its apex, a flat
    end its centre and a hollow one its bottom.
    """
    centre = _cap_centroid(vertices, faces, direction)
    hit = _shoot(vertices, faces, centre, direction)
    return nearest(vertices, faces, centre) if hit is None else hit


def nearest(vertices: Floats, faces: Ints, point: Floats) -> Floats:
    """Point (3,) of the surface nearest to `point`."""
    return np.asarray(igl.point_mesh_squared_distance(point[None], vertices, faces)[2][0], dtype=np.float64)


def _cap_centroid(vertices: Floats, faces: Ints, direction: Floats) -> Floats:
    """Centroid of the largest patch within a few percent of the extreme end, cut exactly at its level."""
    height = vertices @ direction
    level = height.max() - _CAP * np.ptp(height)
    side = np.sign(height - level).astype(np.int64)
    faces = faces[(side[faces] > 0).any(axis=1)]
    cut = crossing(faces, side)
    low, high = cut.T
    t = (level - height[low]) / (height[high] - height[low])
    points = np.concatenate([vertices, vertices[low] + t[:, None] * (vertices[high] - vertices[low])])
    faces = subdivide(points, faces, cut, len(vertices))
    side = np.concatenate([side, np.zeros(len(cut), dtype=np.int64)])
    faces = faces[side[faces].sum(axis=1) > 0]
    area, label = areas(points, faces), patches(faces)
    area[label != np.argmax(np.bincount(label, area))] = 0.0
    return np.asarray((area[:, None] * points[faces].mean(axis=1)).sum(axis=0) / area.sum())


def _shoot(vertices: Floats, faces: Ints, point: Floats, direction: Floats) -> Floats | None:
    """Where the line through `point` meets the surface closest to it, None where it misses."""
    normals = area_vectors(vertices, faces)
    facing = normals @ direction
    scale = np.linalg.norm(normals, axis=1)
    across = np.abs(facing) > 1e-9 * scale
    a, b, c = (vertices[faces[across, k]] - point for k in range(3))
    # Twice the areas that the line makes with two corners each: their shares are barycentric coordinates.
    share = np.column_stack([np.cross(p, q) @ direction for p, q in ((b, c), (c, a), (a, b))])
    share /= 2.0 * facing[across][:, None]
    hits = np.flatnonzero(share.min(axis=1, initial=np.inf) > -1e-9)
    if len(hits) == 0:
        return None
    distance = np.einsum("ij,ij->i", a[hits], normals[across][hits]) / facing[across][hits]
    return np.asarray(point + distance[np.argmin(np.abs(distance))] * direction)
