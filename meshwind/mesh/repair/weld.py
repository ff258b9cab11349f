"""Welding of coincident vertices, and removal of collapsed and duplicate faces."""

import numpy as np
from scipy.spatial import cKDTree

from meshwind.core.cast import Floats, Ints
from meshwind.mesh.geometry.topology import components

WELD = 1e-7
"""Distance over the diagonal below which vertices coincide: single precision, as in binary STL, resolves no more."""


def weld(vertices: Floats, faces: Ints) -> tuple[Floats, Ints]:
    """Join vertices within the tolerance, transitively; each group takes the position of its first vertex."""
    exact = _first_of_equal(vertices)
    distinct, inverse = np.unique(exact, return_inverse=True)
    close = _close_pairs(vertices[distinct])
    if len(distinct) == len(vertices) and len(close) == 0:
        return vertices, faces
    group = components(len(distinct), close[:, 0], close[:, 1])
    representative = np.full(group.max(initial=-1) + 1, len(vertices), dtype=np.int64)
    np.minimum.at(representative, group, distinct)
    keep, renumber = np.unique(representative[group[inverse]], return_inverse=True)
    return vertices[keep], renumber[faces]


def _close_pairs(points: Floats) -> Ints:
    """Index pairs (p, 2) of points within the tolerance."""
    diagonal = float(np.linalg.norm(np.ptp(points, axis=0)))
    return np.asarray(cKDTree(points).query_pairs(WELD * diagonal, output_type="ndarray"), dtype=np.int64)


def _first_of_equal(vertices: Floats) -> Ints:
    """Lowest index (n,) of a vertex with exactly the same coordinates."""
    order = np.lexsort(vertices.T)  # stable, so that the first of a group has the lowest index
    ranked = vertices[order]
    new = np.ones(len(order), dtype=bool)
    new[1:] = (ranked[1:] != ranked[:-1]).any(axis=1)
    first = np.empty(len(order), dtype=np.int64)
    first[order] = order[np.flatnonzero(new)][np.cumsum(new) - 1]
    return first


def without_collapsed(faces: Ints) -> Ints:
    """Drop faces with a repeated vertex."""
    a, b, c = faces.T
    return np.asarray(faces[(a != b) & (b != c) & (c != a)])


def without_duplicates(faces: Ints) -> Ints:
    """Drop faces with the same three corners as an earlier one, in any order."""
    ordered = np.sort(faces, axis=1)
    order = np.lexsort(ordered.T)
    ranked = ordered[order]
    repeats = np.zeros(len(faces), dtype=bool)
    repeats[order[1:]] = (ranked[1:] == ranked[:-1]).all(axis=1)
    return np.asarray(faces[~repeats])
