"""Means over neighbours on the mesh, and whether a surface misses neighbouring vertices alike."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sparse

from meshwind.core.cast import Floats
from meshwind.surface.fitting.samples import Samples

ALIKE = 0.1
"""Most likeness of neighbours' distances that is taken for noise: noise shows -0.2 to 0, a missed shape up to 0.9."""


@dataclass(frozen=True)
class Neighbourhoods:
    """Means over the neighbours of each vertex, and over the facets about each facet, of an annulus's mesh."""

    samples: Samples

    @cached_property
    def _around(self) -> sparse.csr_matrix:
        faces, count = self.samples.facets.faces, len(self.samples.points)
        i, j = faces.ravel(), faces[:, [1, 2, 0]].ravel()
        near = sparse.coo_matrix((np.ones(2 * len(i)), (np.r_[i, j], np.r_[j, i])), shape=(count, count)).tocsr()
        near.data[:] = 1.0
        return sparse.diags(1.0 / np.maximum(np.asarray(near.sum(axis=1)).ravel(), 1.0)) @ near

    def mean(self, values: Floats) -> Floats:
        """Mean of values at the vertices (n, ...) over each one's neighbours."""
        return np.asarray(self._around @ values)

    def facet_mean(self, values: Floats) -> Floats:
        """Mean of values of the facets (m,) over the facets that share a vertex with each."""
        faces, count = self.samples.facets.faces, len(self.samples.points)
        total = np.bincount(faces.ravel(), np.repeat(values, 3), count)
        mean = total / np.maximum(np.bincount(faces.ravel(), minlength=count), 1)
        return np.asarray(mean[faces].mean(axis=1))


def alike(off: Floats, samples: Samples, near: Neighbourhoods) -> float:
    """Correlation of inner vertices' heights (n,) over a surface with their neighbours' means; 0 if it meets all."""
    inner = samples.trusted & ~samples.rim
    square = float((off[inner] ** 2).sum())
    return float((off * near.mean(off))[inner].sum()) / square if square > 0.0 else 0.0
