"""The roughness of the mesh itself, which no smooth surface can or should follow."""

import numpy as np
from scipy.spatial import cKDTree

from meshwind.core.cast import Floats

UNKNOWNS = 6
"""Coefficients of a quadric z = a + b x + c y + d x^2 + e x y + f y^2."""
NEIGHBOURS, LEAST = 20, 10
"""Number of points that a local quadric is fitted to, more than three times its unknowns; and the least number."""
MOST = 2000
"""Maximum number of vertices taken; the median of so many is good to 3 %."""
RANK = 1e-9
"""Singular values below this share of the largest are 0: the points lie on a curve."""
TINY = 1e-300
"""Keeps a quotient finite where the points coincide."""


def roughness(points: Floats) -> float:
    """Median rms distance of a vertex's neighbourhood to its own best quadric, in the mesh's units.

    The quadric follows curvature and few vertices lie at creases, so that on a smooth or creased mesh this is far below
    the sagitta of any curvature, and on a scan it is the scanner's noise.
    """
    count = min(NEIGHBOURS, len(points))
    if count < LEAST:
        return 0.0
    chosen = points[:: max(1, len(points) // MOST)]
    near = points[cKDTree(points).query(chosen, k=count)[1]]
    local = near - near.mean(axis=1, keepdims=True)
    _, size, axes = np.linalg.svd(local, full_matrices=False)
    flat = np.einsum("nkc,nac->nka", local, axes) / np.maximum(size[:, None, :1], TINY)
    x, y, z = np.moveaxis(flat, 2, 0)
    basis = np.stack([np.ones_like(x), x, y, x * x, x * y, y * y], axis=2)
    left, value, _ = np.linalg.svd(basis, full_matrices=False)
    left = left * (value > RANK * value[:, :1])[:, None]
    residual = z - np.einsum("nkp,np->nk", left, np.einsum("nkp,nk->np", left, z))
    rms = np.sqrt((residual**2).sum(axis=1) / (count - UNKNOWNS)) * size[:, 0]
    return float(np.median(rms))
