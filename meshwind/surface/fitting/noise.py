"""How rough the mesh itself is: what no smooth surface can or should follow."""

import numpy as np
from scipy.spatial import cKDTree

from meshwind.core.cast import Floats

NEIGHBOURS = 20
"""Points of a local quadric: twice its unknowns and some."""
MOST = 2000
"""Vertices that are looked at; the median of so many is good to 3 %."""


def roughness(points: Floats) -> float:
    """Median rms distance of a vertex's neighbourhood to its own best quadric, in the mesh's units.

    Curvature is in the quadric and creases hold few vertices, so on a smooth or creased mesh this is far below
    any curvature's sagitta, and on a scan it is the scanner's noise.
    """
    count = min(NEIGHBOURS, len(points))
    if count < 10:
        return 0.0
    chosen = points[:: max(1, len(points) // MOST)]
    near = points[cKDTree(points).query(chosen, k=count)[1]]
    local = near - near.mean(axis=1, keepdims=True)
    _, size, axes = np.linalg.svd(local, full_matrices=False)
    flat = np.einsum("nkc,nac->nka", local, axes) / np.maximum(size[:, None, :1], 1e-300)
    x, y, z = np.moveaxis(flat, 2, 0)
    basis = np.stack([np.ones_like(x), x, y, x * x, x * y, y * y], axis=2)
    left, value, _ = np.linalg.svd(basis, full_matrices=False)
    left = left * (value > 1e-9 * value[:, :1])[:, None]
    rest = z - np.einsum("nkp,np->nk", left, np.einsum("nkp,nk->np", left, z))
    rms = np.sqrt((rest**2).sum(axis=1) / (count - 6)) * size[:, 0]
    return float(np.median(rms))
