"""Points between the vertices, where triangles are larger than the net's spans.

Vertices alone leave the net free over large triangles (a cylinder meshed in one strip), and it would swing there.
The points lie on curved point-normal triangles (Vlachos et al. 2001), which follow a smooth part one or two orders
closer than the facets do, and on the flat facets next to creases.
"""

import igl
import numpy as np

from meshwind.cast import Bools, Floats, Ints
from meshwind.mandrel.annulus import Annulus

ANGLE = igl.PER_VERTEX_NORMALS_WEIGHTING_TYPE_ANGLE
CREASE = np.cos(np.radians(30))
"""A corner whose vertex normal leans further than this from the facet's lies at a crease."""
FINEST = 24
"""Most points along an edge."""


def infill(annulus: Annulus, corner_uv: Floats, spans: tuple[int, int]) -> tuple[Floats, Floats]:
    """Points (k, 2) in the plane and (k, 3) in space that leave no span of the net without data.

    A triangle that is p spans across gets a lattice of p pieces an edge, without the corners.
    """
    extent = np.ptp(corner_uv, axis=1) * spans
    pieces = np.minimum(np.ceil(extent.max(axis=1)).astype(np.int64), FINEST)
    coarse = np.flatnonzero(pieces > 1)
    normals = np.asarray(igl.per_vertex_normals(annulus.vertices, annulus.faces, ANGLE))
    found = [_lattice(annulus, corner_uv, normals, coarse[pieces[coarse] == n], n) for n in np.unique(pieces[coarse])]
    if not found:
        return np.zeros((0, 2)), np.zeros((0, 3))
    return np.concatenate([f[0] for f in found]), np.concatenate([f[1] for f in found])


def _lattice(annulus: Annulus, corner_uv: Floats, normals: Floats, chosen: Ints, pieces: int) -> tuple[Floats, Floats]:
    i, j = np.meshgrid(np.arange(pieces + 1), np.arange(pieces + 1), indexing="ij")
    inside = (i + j <= pieces) & (np.maximum(np.maximum(i, j), pieces - i - j) < pieces)
    weight = np.stack([i[inside], j[inside], (pieces - i - j)[inside]], axis=1) / pieces
    faces = annulus.faces[chosen]
    corners = annulus.vertices[faces]
    points = _curved(corners, _tangent_normals(corners, normals[faces]), weight)
    uv = np.einsum("sk,mkd->msd", weight, corner_uv[chosen])
    return uv.reshape(-1, 2), points.reshape(-1, 3)


def _tangent_normals(corners: Floats, normals: Floats) -> Floats:
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
