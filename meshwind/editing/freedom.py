"""How the control net may move: frozen control points and symmetry."""

from collections.abc import Callable
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike
from scipy import sparse

from meshwind.core.cast import Bools, Floats
from meshwind.core.errors import BadInputError
from meshwind.editing.symmetry import Group
from meshwind.surface.surface import Surface

Frozen: TypeAlias = ArrayLike | Callable[[Floats], ArrayLike] | None
"""A mask (nu, nv) of control points, or a function from their positions (m, 3) to a mask (m,)."""


def frozen_mask(surface: Surface, frozen: Frozen) -> Bools:
    """Mask (nu, nv) of the control points that must not move; raises BadInputError for another shape."""
    shape = surface.control_points.shape[:2]
    if frozen is None:
        return np.zeros(shape, dtype=bool)
    if callable(frozen):
        given = np.asarray(frozen(surface.control_points.reshape(-1, 3)))
        wanted: tuple[int, ...] = (shape[0] * shape[1],)
    else:
        given, wanted = np.asarray(frozen), shape
    if given.shape != wanted or given.dtype != np.bool_:
        raise BadInputError(f"frozen has shape {given.shape} of {given.dtype}; give a mask of bools of shape {wanted}")
    return np.asarray(given.reshape(shape))


def free_moves(surface: Surface, frozen: Bools, group: Group | None = None) -> sparse.csr_array:
    """Orthonormal columns (3m, r) that span the allowed moves.

    group: the motions of the net that are kept.  Control points that one of them maps to each other move alike; where
    one of them is frozen, all are.
    """
    points = surface.control_points.size // 3
    if group is None or len(group.images) == 1:
        free = np.flatnonzero(np.repeat(~frozen.ravel(), 3))
        return sparse.eye_array(3 * points, format="csc")[:, free].tocsr()
    first, by = group.images.min(axis=0), group.images.argmin(axis=0)  # which point each follows, and the motion to it
    fixed = group.any_of(frozen.ravel())
    leaders = np.flatnonzero((first == np.arange(points)) & ~fixed)
    still = group.images[:, leaders] == leaders  # motions that leave a point where it is also hold its moves
    allowed = np.einsum("gk,gij->kij", still.astype(float), group.matrices) / still.sum(axis=0)[:, None, None]
    values, vectors = np.linalg.eigh(allowed)
    leader, axis = np.nonzero(values > 0.5)
    size = np.sqrt(np.bincount(first, minlength=points))
    number = np.full(points, -1)
    number[leaders] = np.arange(len(leaders))
    moving = np.flatnonzero(~fixed)
    offset = np.append(0, np.cumsum(np.bincount(leader, minlength=len(leaders))))
    rows, columns, entries = [], [], []
    for which in range(3):  # its first, second and third direction, where it has so many
        mine = number[first[moving]]
        some = which < np.diff(offset)[mine]
        point, column = moving[some], offset[mine[some]] + which
        direction = vectors[leader[column], :, axis[column]]
        moved = np.einsum("kji,kj->ki", group.matrices[by[point]], direction) / size[first[point], None]
        rows.append((3 * point[:, None] + np.arange(3)).ravel())
        columns.append(np.repeat(column, 3))
        entries.append(moved.ravel())
    place = np.concatenate(rows), np.concatenate(columns)
    return sparse.csr_array((np.concatenate(entries), place), shape=(3 * points, len(leader)))
