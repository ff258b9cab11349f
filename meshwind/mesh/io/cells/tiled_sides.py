"""Sides of volume cells that several smaller sides of other cells cover: inner ones, though no two are the same.

The end of a polyhedron, one polygon, may lie on the ends of several wedges.
"""

import numpy as np
from scipy.sparse import csr_array

from meshwind.core.cast import Bools, Ints
from meshwind.core.lists import spread
from meshwind.mesh.io.cells.faces import FaceList

_LARGE = 4
"""Sides of more corners are looked at; a quadrangle on two triangles is found with the skin."""
_MOST, _AT_ONCE = 100_000_000, 5_000_000
"""Pairs of a polygon and a side at one of its corners: the largest number that is looked at, and how many at once."""
_SEED = 16


def without_tiled(sides: FaceList, points: int) -> FaceList:
    """The same without polygons that smaller sides cover, and without these; points: the number of nodes.

    Sides cover a polygon if their corners are its own, and each edge is that of two of them or of one and the polygon.
    """
    if sides.sizes.max(initial=0) <= _LARGE:
        return sides
    single = np.flatnonzero(_are_single(sides, points))
    kept = sides.where(_marks(len(sides.sizes), single))
    large, small = _within(kept, points)
    covered = _covered(kept, large, small)
    used = np.isin(large, covered)
    gone = np.concatenate([single[covered], single[small[used]]])
    return sides.where(~_marks(len(sides.sizes), gone)) if len(gone) else sides


def _are_single(sides: FaceList, points: int) -> Bools:
    """Which sides are those of one cell only."""
    mixed = np.random.default_rng(_SEED).integers(-(2**63), 2**63, points)
    keys = sides.keys(mixed)
    order = np.argsort(keys)
    same = np.diff(keys[order]) == 0
    single = np.ones(len(keys), dtype=np.bool_)
    single[order[1:][same]] = False
    single[order[:-1][same]] = False
    return single


def _within(sides: FaceList, points: int) -> tuple[Ints, Ints]:
    """Pairs of a polygon and a smaller side, all of whose corners it has."""
    of = np.repeat(np.arange(len(sides.sizes)), sides.sizes)
    table = csr_array((np.ones(len(of), dtype=np.int64), (of, sides.corners)), shape=(len(sides.sizes), points))
    large = np.flatnonzero(sides.sizes > _LARGE)
    about = np.bincount(of, np.bincount(sides.corners, minlength=points)[sides.corners])[large].cumsum()
    if len(large) == 0 or about[-1] > _MOST:
        return large[:0], large[:0]
    pairs = []
    for rows in np.split(large, np.flatnonzero(np.diff(about // _AT_ONCE)) + 1):
        shared = (table[rows] @ table.T).tocoo()
        which, small = rows[shared.coords[0]], shared.coords[1].astype(np.int64)
        inside = (shared.data == sides.sizes[small]) & (sides.sizes[small] < sides.sizes[which])
        pairs.append((which[inside], small[inside]))
    return np.concatenate([pair[0] for pair in pairs]), np.concatenate([pair[1] for pair in pairs])


def _covered(sides: FaceList, large: Ints, small: Ints) -> Ints:
    """Those of the polygons whose smaller sides cover them."""
    after = sides.corners[sides.next()]
    polygons = np.unique(large)
    owner, low, high = [], [], []
    first = np.cumsum(sides.sizes) - sides.sizes
    for polygon, face in ((polygons, polygons), (large, small)):
        size = sides.sizes[face]
        at = spread(first[face], size)
        owner.append(np.repeat(polygon, size))
        low.append(np.minimum(sides.corners[at], after[at]))
        high.append(np.maximum(sides.corners[at], after[at]))
    edges = np.column_stack([np.concatenate(each) for each in (owner, low, high)])
    found, count = np.unique(edges, axis=0, return_counts=True)
    return np.setdiff1d(found[:, 0], found[count != 2, 0])


def _marks(count: int, which: Ints) -> Bools:
    marks = np.zeros(count, dtype=np.bool_)
    marks[which] = True
    return marks
