"""Polygons cut into triangles: convex ones by a fan, others by ears in their own plane."""

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints

_REFLEX = 1e-9
"""A corner whose area is below minus this share of the polygon's is reflex."""


def cut_polygons(points: Floats, sizes: Ints, nodes: Ints) -> tuple[Ints, int]:
    """Triangles (m, 3) of polygons, given by their sizes and the nodes of one after the other.

    A polygon of k corners gives k - 2 triangles in its sense, with all its corners.  Also returns how many polygons
    could not be cut by ears, because they cross themselves, and were cut by a fan.
    """
    count = np.maximum(sizes - 2, 0)
    first = np.cumsum(sizes) - sizes
    start = np.repeat(first, count)
    step = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
    triangles = np.column_stack([nodes[start], nodes[start + step + 1], nodes[start + step + 2]])
    place, failed = np.cumsum(count) - count, 0
    reflex = _has_reflex(points, sizes, nodes)
    for polygon in np.flatnonzero(reflex & (sizes > 3)):
        corners = nodes[first[polygon] : first[polygon] + sizes[polygon]]
        ears = _ears(_in_plane(points[corners]))
        failed += ears is None
        if ears is not None:
            triangles[place[polygon] : place[polygon] + count[polygon]] = corners[ears]
    return triangles, failed


def _has_reflex(points: Floats, sizes: Ints, nodes: Ints) -> Bools:
    """Which polygons have a corner of more than half a turn, or cross themselves."""
    last = np.cumsum(sizes)
    first = last - sizes
    of = np.repeat(np.arange(len(sizes)), sizes)
    after, before = np.arange(1, len(nodes) + 1), np.arange(-1, len(nodes) - 1)
    some = sizes > 0
    after[last[some] - 1], before[first[some]] = first[some], last[some] - 1
    here = points[nodes]
    corner = np.cross(here - here[before], here[after] - here)
    base = here[first[of]] if len(of) else here
    turn = np.cross(here - base, here[after] - base)
    normal = np.column_stack([np.bincount(of, turn[:, axis], len(sizes)) for axis in range(3)])
    square = (normal**2).sum(axis=1)
    reflex = (corner * normal[of]).sum(axis=1) < -_REFLEX * square[of]
    return np.bincount(of, reflex, len(sizes)) > 0


def _in_plane(corners: Floats) -> Floats:
    """Corners (k, 2) in the polygon's own plane, counterclockwise; its normal is the sum over the sides (Newell)."""
    about = corners - corners.mean(axis=0)
    normal = np.cross(about, np.roll(about, -1, axis=0)).sum(axis=0)
    drop = int(np.argmax(np.abs(normal)))
    x, y = (drop + 1) % 3, (drop + 2) % 3
    flat = about[:, [x, y]]
    return flat if normal[drop] > 0.0 else flat * [-1.0, 1.0]


def _ears(flat: Floats) -> Ints | None:
    """Triangles (k - 2, 3) of a counterclockwise polygon, None if it crosses itself.

    Of the corners that can be cut, the one with the largest smallest angle is taken: thin triangles come last.
    """
    left = list(range(len(flat)))
    triangles = []
    while len(left) > 3:
        ring = flat[left]
        before, after = np.roll(ring, 1, axis=0), np.roll(ring, -1, axis=0)
        area = _cross(ring - before, after - ring)
        sides = ((ring - before) ** 2).sum(1) + ((after - ring) ** 2).sum(1) + ((after - before) ** 2).sum(1)
        shape = np.where(area > 0.0, area / np.where(sides > 0.0, sides, 1.0), 0.0)
        for at in np.argsort(-shape, kind="stable"):
            if not shape[at] > 0.0:
                return None
            if not _holds_any(before[at], ring[at], after[at], ring, int(at)):
                break
        else:
            return None
        triangles.append((left[at - 1], left[at], left[(at + 1) % len(left)]))
        del left[at]
    triangles.append((left[0], left[1], left[2]))
    if not _cross(flat[left[1]] - flat[left[0]], flat[left[2]] - flat[left[0]]) >= 0.0:
        return None
    return np.array(triangles, dtype=np.int64)


def _holds_any(a: Floats, b: Floats, c: Floats, ring: Floats, at: int) -> bool:
    """Whether the triangle holds a corner of the ring other than its own three, or has one on its new side."""
    inside = (_cross(b - a, ring - a) >= 0.0) & (_cross(c - b, ring - b) >= 0.0) & (_cross(a - c, ring - c) >= 0.0)
    inside[[at - 1, at, (at + 1) % len(ring)]] = False
    same = (ring == a).all(axis=1) | (ring == c).all(axis=1)  # a corner that touches another, as of a slit
    return bool((inside & ~same).any())


def _cross(a: Floats, b: Floats) -> Floats:
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])
