"""Removal of faces without height by edge flips, which move no vertex and open no gap."""

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.mesh.geometry.areas_and_volumes import areas, edge_lengths
from meshwind.mesh.geometry.topology import edges

FLAT = 1e-6
"""Least height of a face over the diagonal."""
_MAX_ROUNDS = 20
"""Maximum number of rounds of flips."""


def heights(vertices: Floats, faces: Ints) -> Floats:
    """Height (m,) of each face over its longest edge."""
    return np.asarray(2.0 * areas(vertices, faces) / edge_lengths(vertices, faces).max(axis=1))


def without_slivers(vertices: Floats, faces: Ints, diagonal: float) -> tuple[Ints, int]:
    """Flip or, at the boundary, drop faces without height; also returns their number.

    Faces must be oriented and manifold, and remain so, but for vertices where a dropped face leaves two fans.
    """
    flat = heights(vertices, faces) < FLAT * diagonal
    count = int(flat.sum())
    for _ in range(_MAX_ROUNDS):
        if not flat.any():
            break
        changed = _round(vertices, faces, flat)
        if changed is None:
            break
        faces = changed
        flat = heights(vertices, faces) < FLAT * diagonal
    return faces, count


def _round(vertices: Floats, faces: Ints, flat: Bools) -> Ints | None:
    """Flip as many flat faces as do not touch each other; None if none can be flipped."""
    found = edges(faces)
    at = found.of_face.ravel()
    face = np.flatnonzero(flat)
    half = 3 * face + edge_lengths(vertices, faces[face]).argmax(axis=1)
    edge = at[half]
    single = found.count[edge] == 1
    other = _opposite(at, half)
    apex, far = faces[face, (half + 2) % 3], faces[other // 3, (other + 2) % 3]
    span = int(faces.max()) + 1
    wanted = np.minimum(apex, far) * span + np.maximum(apex, far)
    taken = np.isin(wanted, found.ends[:, 0] * span + found.ends[:, 1]) | (apex == far)
    flips = np.flatnonzero(~single & ~taken)
    flips = flips[_independent(face[flips], other[flips] // 3, wanted[flips], len(faces))]
    drops = face[single]
    if len(flips) + len(drops) == 0:
        return None
    one, two = face[flips], other[flips] // 3
    start, end = faces[one, half[flips] % 3], faces[one, (half[flips] + 1) % 3]
    result = faces.copy()
    result[one] = np.column_stack([apex[flips], start, far[flips]])
    result[two] = np.column_stack([far[flips], end, apex[flips]])
    return np.delete(result, np.setdiff1d(drops, np.concatenate([one, two])), axis=0)


def _opposite(at: Ints, half: Ints) -> Ints:
    """The opposite half-edge of each given one; itself at the boundary."""
    low = np.full(at.max() + 1, len(at))
    high = np.full(at.max() + 1, -1)
    np.minimum.at(low, at, np.arange(len(at)))
    np.maximum.at(high, at, np.arange(len(at)))
    return np.where(half == high[at[half]], low[at[half]], high[at[half]])


def _independent(one: Ints, two: Ints, edge: Ints, faces: int) -> Bools:
    """Mask of flips that share no face and no new edge with an earlier one."""
    turn = np.arange(len(one))
    first = np.full(faces, len(one))
    np.minimum.at(first, one, turn)
    np.minimum.at(first, two, turn)
    new = np.zeros(len(one), dtype=bool)
    new[np.unique(edge, return_index=True)[1]] = True
    return np.asarray((first[one] == turn) & (first[two] == turn) & new)
