"""Points between the vertices, where triangles are larger than the net's spans.

Vertices alone leave the net free over large triangles (a cylinder meshed in one strip), and it would swing there.
The points lie on curved point-normal triangles (Vlachos et al. 2001), which follow a smooth part one or two orders
closer than the facets do, and on the flat facets next to creases.
"""

from typing import TypeAlias

import igl
import numpy as np
from numba import njit
from numpy.typing import NDArray

from meshwind.core.cast import Bools, Floats, Ints

Int8s: TypeAlias = NDArray[np.int8]

ANGLE = igl.PER_VERTEX_NORMALS_WEIGHTING_TYPE_ANGLE
CREASE = np.cos(np.radians(30))
"""Cosine of the angle between vertex normal and facet normal beyond which a corner lies at a crease."""
FINEST = 64
"""Maximum number of pieces that an edge is divided into."""


def infill(corners: Floats, normals: Floats, corner_uv: Floats, pieces: Int8s) -> tuple[Floats, Floats]:
    """Points (k, 2) in the plane and (k, 3) in space that leave no span of the net without data.

    Each triangle has corners (c, 3, 3) in space, normals (c, 3, 3) there and corner_uv (c, 3, 2) in the plane.  It gets
    a lattice that divides its edges into `pieces` (c,), without the corners.
    """
    tangent = tangent_normals(corners, normals)
    found = []
    for count in np.unique(pieces):
        chosen = np.flatnonzero(pieces == count)
        found.append(_lattice(corners[chosen], tangent[chosen], corner_uv[chosen], int(count)))
    return np.concatenate([f[0] for f in found]), np.concatenate([f[1] for f in found])


@njit(nogil=True, cache=True)
def spans_across(
    first: int, last: int, faces: Ints, uv: Floats, turns: Int8s, spans: tuple[int, int], out: Int8s
) -> None:
    """Write into `out` (m,) the widths of the triangles first to last in spans, at most FINEST.

    uv (n, 2) are the vertices' parameters, turns (m, 3) the turns of u by which a triangle's corners differ from them.
    One pass over the faces: array expressions cost ten times as much, and there are few coarse triangles or none.
    """
    for m in range(first, last):
        i, j, k = faces[m, 0], faces[m, 1], faces[m, 2]
        widest = 0.0
        for axis in range(2):
            a, b, c = uv[i, axis], uv[j, axis], uv[k, axis]
            if axis == 0:
                a, b, c = a + turns[m, 0], b + turns[m, 1], c + turns[m, 2]
            widest = max(widest, (max(a, b, c) - min(a, b, c)) * spans[axis])
        out[m] = min(int(np.ceil(widest)), FINEST)


def _lattice(corners: Floats, normals: Floats, corner_uv: Floats, pieces: int) -> tuple[Floats, Floats]:
    i, j = np.meshgrid(np.arange(pieces + 1), np.arange(pieces + 1), indexing="ij")
    inside = (i + j <= pieces) & (np.maximum(np.maximum(i, j), pieces - i - j) < pieces)
    weight = np.stack([i[inside], j[inside], (pieces - i - j)[inside]], axis=1) / pieces
    points = _curved(corners, normals, weight)
    uv = np.einsum("sk,mkd->msd", weight, corner_uv)
    return uv.reshape(-1, 2), points.reshape(-1, 3)


def tangent_normals(corners: Floats, normals: Floats) -> Floats:
    """Corner normals (m, 3, 3); the facet's own wherever one of its corners lies at a crease."""
    flat = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    flat /= np.linalg.norm(flat, axis=1, keepdims=True)
    smooth: Bools = ((normals * flat[:, None]).sum(axis=2) > CREASE).all(axis=1)
    return np.asarray(np.where(smooth[:, None, None], normals, flat[:, None]))


def _curved(P: Floats, N: Floats, weight: Floats) -> Floats:
    """Cubic point-normal triangles with corners P and normals N (m, 3, 3) at barycentric weights (s, 3)."""
    edge = {}
    for a in range(3):
        for b in range(3):
            if a != b:
                rise = ((P[:, b] - P[:, a]) * N[:, a]).sum(axis=1, keepdims=True)
                edge[a, b] = (2 * P[:, a] + P[:, b] - rise * N[:, a]) / 3
    mean = sum(edge.values()) / 6
    centre = mean + (mean - P.mean(axis=1)) / 2
    w = weight.T[:, None, :, None]
    out = 6 * w[0] * w[1] * w[2] * centre[:, None]
    for a in range(3):
        out = out + w[a] ** 3 * P[:, a, None]
    for (a, b), point in edge.items():
        out = out + 3 * w[a] ** 2 * w[b] * point[:, None]
    return np.asarray(out)
