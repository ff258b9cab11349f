"""Curved point-normal triangles (Vlachos et al. 2001): cubics through the corners, square to the normals there.

Through the vertices of a smooth part they follow it one or two orders closer than flat facets do.
"""

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.kernel import njit
from meshwind.core.kernel_arrays import fill
from meshwind.core.threads import parallel_for
from meshwind.core.vectors import TINY

CREASE = np.cos(np.radians(30))
"""Cosine of the angle between vertex normal and facet normal beyond which a corner lies at a crease."""


def tangent_normals(corners: Floats, normals: Floats) -> tuple[Floats, Bools]:
    """Corner normals (m, 3, 3), the facet's own wherever one of its corners lies at a crease; and where (m,) none does.

    corners, normals (m, 3, 3): of the facets, and of the vertices at their corners.
    """
    flat = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    flat /= np.maximum(np.linalg.norm(flat, axis=1, keepdims=True), TINY)
    smooth: Bools = ((normals * flat[:, None]).sum(axis=2) > CREASE).all(axis=1)
    return np.where(smooth[:, None, None], normals, flat[:, None]), smooth


def curved(facet: Ints, corners: Ints, share: Floats, points: Floats, normals: Floats) -> Floats:
    """Points (k, 3) at barycentric shares (k, 3) of facets (k,) with corners (k, 3) among points (n, 3).

    normals (m, 3, 3): tangent normals of the facets.
    """
    out = np.empty((len(facet), 3))
    parallel_for(_curved, len(out), 20_000, facet, corners, share, points, normals, out)
    return out


@njit(nogil=True, cache=True)
def _curved(first, last, facet, corners, share, points, normals, out):
    """Write the points first to last."""
    edge, middle = np.empty((3, 3, 3)), np.empty(3)
    for k in range(first, last):
        fill(middle, 0.0)
        for a in range(3):
            for b in range(3):
                if a == b:
                    continue
                p, q = points[corners[k, a]], points[corners[k, b]]
                n, rise = normals[facet[k], a], 0.0
                for d in range(3):
                    rise += (q[d] - p[d]) * n[d]
                for d in range(3):
                    edge[a, b, d] = (2.0 * p[d] + q[d] - rise * n[d]) / 3.0
                    middle[d] += edge[a, b, d] / 4.0
        for d in range(3):
            total, mean = 0.0, 0.0
            for a in range(3):
                w, p = share[k, a], points[corners[k, a], d]
                total += w * w * w * p
                mean += p / 6.0
                for b in range(3):
                    if a != b:
                        total += 3.0 * w * w * share[k, b] * edge[a, b, d]
            out[k, d] = total + 6.0 * share[k, 0] * share[k, 1] * share[k, 2] * (middle[d] - mean)
