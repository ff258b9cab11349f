"""Polygons cut into triangles: by a fan where that is a valid cut, otherwise by ears in their own plane."""

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints

_THIN = 1e-6
"""Shape of a triangle, twice its area by the sum of its squared sides, up to which another cut is sought."""
_MOST = 20_000
"""Largest polygon that is cut by ears, whose time grows with the square of the number of corners."""


def cut_polygons(points: Floats, sizes: Ints, nodes: Ints) -> tuple[Ints, int]:
    """Triangles (m, 3) of polygons, given by their sizes and the nodes of one after the other.

    A polygon of k corners gives k - 2 triangles in its sense, with all its corners: a fan about the first one if that
    covers the polygon without overlap, the other diagonal of a quadrangle if that does, otherwise ears.  Also returns
    how many polygons were cut by a fan though it overlaps, because they cross themselves.
    """
    count = np.maximum(sizes - 2, 0)
    first, place = np.cumsum(sizes) - sizes, np.cumsum(count) - count
    start = np.repeat(first, count)
    step = np.arange(count.sum()) - np.repeat(place, count)
    triangles = np.column_stack([nodes[start], nodes[start + step + 1], nodes[start + step + 2]])
    if sizes.max(initial=0) < 4:
        return triangles, 0
    poor = np.flatnonzero(~_is_good_fan(points, triangles, count) & (sizes > 3))
    four = poor[sizes[poor] == 4]
    turned = nodes[first[four][:, None] + [1, 2, 3, 0]]
    halves = np.stack([turned[:, [0, 1, 2]], turned[:, [0, 2, 3]]], axis=1)
    better = _is_good_fan(points, halves.reshape(-1, 3), np.full(len(four), 2))
    triangles[place[four[better]][:, None] + [0, 1]] = halves[better]
    left = np.setdiff1d(poor, four[better], assume_unique=True)
    crossed = _by_ears(points, (sizes[left], first[left], place[left]), nodes, triangles) if len(left) else 0
    return triangles, crossed


def _is_good_fan(points: Floats, triangles: Ints, count: Ints) -> Bools:
    """Whether the triangles of each polygon all look the same way, and none of them is without area."""
    if len(triangles) == 0:
        return np.ones(len(count), dtype=np.bool_)
    a, b, c = (points[triangles[:, k]] for k in range(3))
    along, across = b - a, c - a
    areas = np.cross(along, across)
    squares = (along**2).sum(axis=1) + (across**2).sum(axis=1) + ((c - b) ** 2).sum(axis=1)
    of = np.repeat(np.arange(len(count)), count)
    normal = np.column_stack([np.bincount(of, areas[:, axis], len(count)) for axis in range(3)])
    length = np.sqrt((normal**2).sum(axis=1))[of]
    poor = ~((areas * normal[of]).sum(axis=1) > _THIN * squares * length)
    return np.bincount(of, poor, len(count)) == 0


def _by_ears(points: Floats, polygons: tuple[Ints, Ints, Ints], nodes: Ints, triangles: Ints) -> int:
    """Cut polygons, given by sizes, first corners and places of their triangles; count those that cross themselves."""
    sizes, first, place = polygons
    begin = np.concatenate([[0], np.cumsum(sizes)])
    of = np.repeat(np.arange(len(sizes)), sizes)
    corners = nodes[np.arange(begin[-1]) - begin[of] + first[of]]
    flat, has_area, has_plane = _in_plane(points[corners], begin, of)
    fits, crossed = (sizes <= _MOST) & has_plane, has_area
    if fits.any():
        from meshwind.mesh.io.cells.ears import cut_by_ears  # compiled, and few files need it

        which = np.flatnonzero(fits)
        lengths = sizes[which]
        found = np.empty((int((lengths - 2).sum()), 3), dtype=np.int64)
        start = np.cumsum(lengths - 2) - (lengths - 2)
        crossed[which] = cut_by_ears(flat[fits[of]], np.concatenate([[0], np.cumsum(lengths)]), found, start)
        target = np.repeat(place[which] - start, lengths - 2) + np.arange(len(found))
        good = np.repeat(~crossed[which], lengths - 2)
        found += np.repeat(begin[which], lengths - 2)[:, None]
        triangles[target[good]] = corners[found[good]]
    return int(crossed.sum())


def _in_plane(corners: Floats, begin: Ints, of: Ints) -> tuple[Floats, Bools, Bools]:
    """Corners (n, 2) in the plane of each polygon, counterclockwise; whether it has an area, and a plane (p,).

    The normal is the sum over the sides (Newell); the axis nearest to it is dropped.  Coordinates are relative to the
    polygon's size.
    """
    sizes = np.diff(begin)
    about = corners - np.add.reduceat(corners, begin[:-1])[of] / sizes[of, None]
    scale = np.maximum.reduceat(np.abs(about).max(axis=1), begin[:-1])
    about /= np.where(scale > 0.0, scale, 1.0)[of, None]
    after = np.arange(1, len(of) + 1)
    after[begin[1:] - 1] = begin[:-1]
    normal = np.add.reduceat(np.cross(about, about[after]), begin[:-1])
    drop = np.abs(normal).argmax(axis=1)
    sense = np.where(normal[np.arange(len(sizes)), drop] > 0.0, 1.0, -1.0)
    row = np.arange(len(of))
    flat = np.column_stack([about[row, (drop[of] + 1) % 3] * sense[of], about[row, (drop[of] + 2) % 3]])
    spread = np.add.reduceat(np.abs(np.cross(about, about[after])).sum(axis=1), begin[:-1])
    has_area = spread > _THIN
    return flat, has_area, has_area & (np.abs(normal).max(axis=1) > _THIN * spread)
